//! The parameter protocol: values out, values in.

use core::fmt::Write;

use link::MavMessage;
use link::dialect::*;
use rig::Refused;

use super::{Next, status, warning};
use crate::control::{Autopilot, Drive};
use crate::report::Text;
use crate::settings::{Setting, Settings};

/// A parameter's current value.
pub fn value(settings: &Settings, index: usize) -> Option<MavMessage> {
    let (entry, value) = settings.at(index)?;
    Some(MavMessage::PARAM_VALUE(PARAM_VALUE_DATA {
        param_value: value,
        param_count: Settings::COUNT as u16,
        param_index: index as u16,
        param_id: link::name(entry.name.as_str()),
        param_type: MavParamType::MAV_PARAM_TYPE_REAL32 as u8,
    }))
}

/// Answers a request for one.
pub fn read(request: &PARAM_REQUEST_READ_DATA, autopilot: &Autopilot) -> MavMessage {
    let index = usize::try_from(request.param_index).ok();
    index
        .or_else(|| Settings::index(link::text_of(&*request.param_id)))
        .and_then(|index| value(autopilot.settings(), index))
        .unwrap_or_else(|| warning(Refused::<f32>::Unknown))
}

/// Sets one, and answers with what it is then.
pub fn set(request: &PARAM_SET_DATA, autopilot: &mut Autopilot, send: &mut impl FnMut(MavMessage)) -> Next {
    let name = link::text_of(&*request.param_id);
    let Some(index) = Settings::index(name) else {
        send(about("no such parameter", name));
        return Next::Nothing;
    };
    let is_flight = autopilot.drive() == Drive::Flight;
    let mut next = Next::Nothing;
    match autopilot.settings_mut() {
        None => send(about("not while armed", name)),
        Some(settings) => {
            match number(request).and_then(|value| settings.set_at(index, value).map_err(Unset::Refused)) {
                Ok(()) if is_flight && index != Setting::DRIVE.index() => next = Next::Store(index),
                Ok(()) => {}
                Err(Unset::Type) => send(about("type not known", name)),
                Err(Unset::Refused(refused)) => send(warning(refused)),
            }
        }
    }
    value(autopilot.settings(), index).into_iter().for_each(send);
    next
}

enum Unset {
    Type,
    Refused(Refused<f32>),
}

/// The value in a PARAM_SET. All parameters are floats. A sender who takes one for an integer
/// writes it either as the integer's own bytes or as the float that equals it. The bytes of an
/// integer of less than 2²³, read as a float, are far below any float that equals one.
fn number(request: &PARAM_SET_DATA) -> Result<f32, Unset> {
    const REAL: u8 = MavParamType::MAV_PARAM_TYPE_REAL32 as u8;
    let value = request.param_value;
    let bytes = value.to_bits();
    let [byte, ..] = bytes.to_le_bytes();
    let short = bytes as u16;
    let integer = match request.param_type {
        REAL => return Ok(value),
        1 => byte.into(),
        2 => byte.cast_signed().into(),
        3 => short.into(),
        4 => short.cast_signed().into(),
        5 => i64::from(bytes),
        6 => bytes.cast_signed().into(),
        _ => return Err(Unset::Type),
    };
    let is_float = value.is_normal() && value as i32 as f32 == value;
    Ok(if is_float { value } else { integer as f32 })
}

fn about(reason: &str, name: &str) -> MavMessage {
    let mut text = Text::new();
    // Both fit.
    let _ = write!(text, "{reason}: {name}");
    status(MavSeverity::MAV_SEVERITY_WARNING, &text)
}
