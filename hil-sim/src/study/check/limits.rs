//! What a vehicle may be asked to do, with sane defaults for what is not stated.

use controller::Vehicle;
use serde::Deserialize;
use serde::de::Deserializer;

use crate::describe::input::{Invalid, join, read, within};

/// What a vehicle may be asked to do on its path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Least and largest thrust, N.
    pub thrust: [f64; 2],
    /// Largest angle of the rod from straight down, rad.
    pub rod_angle: f64,
    /// Largest angle of b3 from straight down, rad.
    pub tilt: f64,
    /// Largest body rate |ω|, rad/s.
    pub body_rate: f64,
    /// Largest torque about any body axis, N·m.
    pub torque: f64,
    /// Least tension of the rod as a part of the payload's weight.
    pub tension: f64,
}

/// Limits in a file; angles in degrees, as pilots have them.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct LimitFields {
    min_thrust: Option<f64>,
    max_thrust: Option<f64>,
    rod_angle_deg: Option<f64>,
    tilt_deg: Option<f64>,
    body_rate: Option<f64>,
    torque: Option<f64>,
    tension: Option<f64>,
}

/// Parts of the hover thrust.
const THRUST: [f64; 2] = [0.2, 2.0];
/// rad.
const ANGLE: f64 = std::f64::consts::FRAC_PI_4;
/// rad/s.
const BODY_RATE: f64 = 4.0;
/// Torque per hover thrust, m: a tenth of it shifted by 0.34 m, 1 N·m for the paper's vehicle.
const TORQUE_ARM: f64 = 0.034;
/// Part of the payload's weight.
const TENSION: f64 = 0.2;

impl Limits {
    /// The defaults for a vehicle: thrust 0.2 to 2 times hover, rod and tilt 45°, 4 rad/s, per axis
    /// a torque of 0.034 m times the hover thrust, and a tension of 0.2 of the payload's weight.
    #[must_use]
    pub fn of(vehicle: &Vehicle<f64>) -> Self {
        let hover = vehicle.hover_thrust();
        Self {
            thrust: THRUST.map(|part| part * hover),
            rod_angle: ANGLE,
            tilt: ANGLE,
            body_rate: BODY_RATE,
            torque: TORQUE_ARM * hover,
            tension: TENSION,
        }
    }

    /// The limits in `value`, the field `at`: `min_thrust`, `max_thrust` (N), `rod_angle_deg`,
    /// `tilt_deg`, `body_rate` (rad/s), `torque` (N·m), `tension`; what is left out is as in
    /// [`of`](Self::of).
    ///
    /// # Errors
    /// [`Invalid`] for an unknown field or one out of range.
    pub fn read<'de>(at: &str, value: impl Deserializer<'de>, vehicle: &Vehicle<f64>) -> Result<Self, Invalid> {
        let fields: LimitFields = read(at, value)?;
        let default = Self::of(vehicle);
        let get = |name: &str, value: Option<f64>, default: f64, largest: f64| match value {
            Some(value) => within(&join(at, name), value, 0.0..=largest),
            None => Ok(default),
        };
        let angle = |name: &str, value: Option<f64>, default: f64| {
            get(name, value, default.to_degrees(), 90.0).map(f64::to_radians)
        };
        let max = get("max_thrust", fields.max_thrust, default.thrust[1], 1e6)?;
        Ok(Self {
            thrust: [get("min_thrust", fields.min_thrust, default.thrust[0].min(max), max)?, max],
            rod_angle: angle("rod_angle_deg", fields.rod_angle_deg, default.rod_angle)?,
            tilt: angle("tilt_deg", fields.tilt_deg, default.tilt)?,
            body_rate: get("body_rate", fields.body_rate, default.body_rate, 1e3)?,
            torque: get("torque", fields.torque, default.torque, 1e6)?,
            tension: get("tension", fields.tension, default.tension, 1.0)?,
        })
    }
}
