//! What happens when somebody is not heard any more: the ground station, the pilot's stick; and
//! when the battery is low.

use controller::Request;
use link::dialect::LoadFault;

use crate::settings::{Setting, Settings};

/// Something that may be lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loss {
    /// The ground station's heartbeat.
    Station,
    /// The pilot's stick or radio.
    Stick,
    /// The battery's charge.
    Battery,
}

impl Loss {
    pub(crate) const ALL: [Self; 3] = [Self::Station, Self::Stick, Self::Battery];

    /// Its bit.
    fn bit(self) -> LoadFault {
        match self {
            Self::Station => LoadFault::LOAD_FAULT_STATION_LOST,
            Self::Stick => LoadFault::LOAD_FAULT_STICK_LOST,
            Self::Battery => LoadFault::LOAD_FAULT_BATTERY,
        }
    }

    fn action(self) -> Setting {
        match self {
            Self::Station => Setting::STATION_ACTION,
            Self::Stick => Setting::STICK_ACTION,
            Self::Battery => Setting::BATTERY_ACTION,
        }
    }
}

/// A sender that is expected to go on once it has begun.
#[derive(Clone, Copy, Debug, Default)]
struct Sender {
    /// Time since it was heard, s; none before it was.
    silent_s: Option<f32>,
}

impl Sender {
    fn is_lost(self, timeout_s: f32) -> bool {
        timeout_s > 0.0 && self.silent_s.is_some_and(|silent_s| silent_s > timeout_s)
    }
}

/// Batteries that are told apart; the last stands for all further ones.
const BATTERIES: usize = 4;

/// Who was heard when.
#[derive(Clone, Copy, Debug, Default)]
pub struct Failsafe {
    station: Sender,
    stick: Sender,
    /// What is left in each battery, %.
    batteries: [Option<i8>; BATTERIES],
    /// What was lost at the last step.
    lost: [bool; 3],
}

/// What is asked for where something goes wrong, by the setting that says it.
pub fn wanted(action: Setting, settings: &Settings) -> Option<Request> {
    match settings.get(action) as u8 {
        1 => Some(Request::Hold),
        2 => Some(Request::Land),
        _ => None,
    }
}

impl Failsafe {
    /// A ground station's heartbeat.
    pub fn hear_station(&mut self) {
        self.station.silent_s = Some(0.0);
    }

    /// The pilot's stick or radio.
    pub fn hear_stick(&mut self) {
        self.stick.silent_s = Some(0.0);
    }

    /// The battery of this number has so much left, %.
    pub fn hear_battery(&mut self, number: u8, percent: i8) {
        let index = usize::from(number).min(BATTERIES - 1);
        if let Some(battery) = self.batteries.get_mut(index) {
            *battery = Some(percent);
        }
    }

    /// What the emptiest battery has left, %, if that is known.
    pub fn battery(&self) -> Option<i8> {
        self.batteries.into_iter().flatten().min()
    }

    /// Whether it is lost now.
    pub fn is_lost(&self, loss: Loss, settings: &Settings) -> bool {
        match loss {
            Loss::Station => self.station.is_lost(settings.get(Setting::STATION_TIMEOUT)),
            Loss::Stick => self.stick.is_lost(settings.get(Setting::STICK_TIMEOUT)),
            Loss::Battery => {
                self.battery().is_some_and(|percent| f32::from(percent) < settings.get(Setting::BATTERY_LEAST))
            }
        }
    }

    /// A control period goes by. Returns what has just been lost, each with what is then wanted if
    /// anything.
    pub fn advance(&mut self, period_s: f32, settings: &Settings) -> [Option<(Loss, Option<Request>)>; 3] {
        for sender in [&mut self.station, &mut self.stick] {
            sender.silent_s = sender.silent_s.map(|silent_s| silent_s + period_s);
        }
        let now = Loss::ALL.map(|loss| self.is_lost(loss, settings));
        let before = core::mem::replace(&mut self.lost, now);
        let mut edges = self.lost.into_iter().zip(before).map(|(now, before)| now && !before);
        Loss::ALL.map(|loss| edges.next().unwrap_or(false).then_some((loss, wanted(loss.action(), settings))))
    }

    /// The bits of what is lost.
    pub fn bits(&self) -> LoadFault {
        let bits = Loss::ALL.into_iter().zip(self.lost).filter(|(_, lost)| *lost).map(|(loss, _)| loss.bit());
        bits.fold(LoadFault::empty(), |all, bit| all | bit)
    }
}
