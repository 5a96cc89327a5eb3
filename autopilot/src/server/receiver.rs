//! What the satellite receiver that is heard says, for ground stations to show: told on as
//! GPS_RAW_INT, twice a second. None was heard: no receiver; it has fallen silent: no fix.

use link::MavMessage;
use link::dialect::{GPS_INPUT_DATA, GPS_RAW_INT_DATA};

/// From one message to the next, ns.
const EVERY_NS: u64 = 500_000_000;
/// A receiver that is silent for so long, ns, gives no fix: none is slower than 1 Hz.
const SILENT_NS: u64 = 1_500_000_000;
/// GPS_FIX_TYPE: of no receiver, and of one without a fix.
const NO_RECEIVER: u8 = 0;
const NO_FIX: u8 = 1;
/// Bits of GPS_INPUT.ignore_flags.
const NO_ALTITUDE: u16 = 1;
const NO_LEVEL_DILUTION: u16 = 2;
const NO_VERTICAL_DILUTION: u16 = 4;
const NO_LEVEL_VELOCITY: u16 = 8;
const NO_SPEED_ACCURACY: u16 = 32;
const NO_LEVEL_ACCURACY: u16 = 64;
const NO_VERTICAL_ACCURACY: u16 = 128;

/// Nothing is known but what a receiver has.
const fn unknown(fix_type: u8) -> GPS_RAW_INT_DATA {
    GPS_RAW_INT_DATA {
        fix_type,
        eph: u16::MAX,
        epv: u16::MAX,
        vel: u16::MAX,
        cog: u16::MAX,
        satellites_visible: u8::MAX,
        ..GPS_RAW_INT_DATA::DEFAULT
    }
}

/// The receiver's last word.
#[derive(Clone, Debug)]
pub struct Receiver {
    /// With the time at which it was heard, ns.
    said: Option<(GPS_RAW_INT_DATA, u64)>,
    due_ns: u64,
}

impl Receiver {
    pub const fn new() -> Self {
        Self { said: None, due_ns: 0 }
    }

    pub fn hear_raw(&mut self, message: &GPS_RAW_INT_DATA, time_ns: u64) {
        self.said = Some((message.clone(), time_ns));
    }

    pub fn hear_input(&mut self, message: &GPS_INPUT_DATA, time_ns: u64) {
        let has = |bit: u16| message.ignore_flags & bit == 0;
        // Where a number does not fit, the cast takes the nearest that does.
        let hundredths = |bit, number: f32| if has(bit) { (number * 100.0) as u16 } else { u16::MAX };
        let mm = |bit, metres: f32| if has(bit) { (metres * 1e3) as u32 } else { 0 };
        let speed = controller::Real::sqrt(message.vn * message.vn + message.ve * message.ve);
        let course = controller::Real::atan2(message.ve, message.vn).to_degrees();
        let course = if course < 0.0 { course + 360.0 } else { course };
        self.said = Some((
            GPS_RAW_INT_DATA {
                time_usec: message.time_usec,
                fix_type: message.fix_type,
                lat: message.lat,
                lon: message.lon,
                alt: if has(NO_ALTITUDE) { (message.alt * 1e3) as i32 } else { 0 },
                eph: hundredths(NO_LEVEL_DILUTION, message.hdop),
                epv: hundredths(NO_VERTICAL_DILUTION, message.vdop),
                vel: hundredths(NO_LEVEL_VELOCITY, speed),
                cog: hundredths(NO_LEVEL_VELOCITY, course),
                satellites_visible: message.satellites_visible,
                h_acc: mm(NO_LEVEL_ACCURACY, message.horiz_accuracy),
                v_acc: mm(NO_VERTICAL_ACCURACY, message.vert_accuracy),
                vel_acc: mm(NO_SPEED_ACCURACY, message.speed_accuracy),
                yaw: message.yaw,
                ..GPS_RAW_INT_DATA::DEFAULT
            },
            time_ns,
        ));
    }

    /// What there is to tell of it, when it is time to.
    pub fn news(&mut self, time_ns: u64) -> Option<MavMessage> {
        if time_ns < self.due_ns {
            return None;
        }
        self.due_ns = time_ns + EVERY_NS;
        Some(MavMessage::GPS_RAW_INT(match &self.said {
            None => unknown(NO_RECEIVER),
            Some((_, heard_ns)) if time_ns.saturating_sub(*heard_ns) > SILENT_NS => unknown(NO_FIX),
            Some((said, _)) => said.clone(),
        }))
    }
}
