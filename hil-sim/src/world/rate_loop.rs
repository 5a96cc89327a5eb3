//! An autopilot's own rate loop, where one flies between law and rotors.
//!
//! `rate_hz` times a second it turns the error of body rate into the torque that would remove it
//! with the loop's time constant about each axis, τ = J ((ω_sp − ω)/T_i) + ω × J ω. Limits and the
//! rotors' lag come after it.

use controller::Vector3;
use serde::Deserialize;

use super::check;
use crate::describe::input::Invalid;

/// A rate loop.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct RateLoop {
    /// How often it runs, Hz, 50 to 10000.
    pub rate_hz: f64,
    /// T_i about the body axes, s, 0.005 to 5.
    pub time_constant_s: [f64; 3],
}

impl Default for RateLoop {
    /// A common autopilot's.
    fn default() -> Self {
        Self { rate_hz: 1000.0, time_constant_s: [0.03; 3] }
    }
}

impl RateLoop {
    pub(super) fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "rate_hz", self.rate_hz, 50.0, 1e4)?;
        for (axis, time) in self.time_constant_s.into_iter().enumerate() {
            check(at, &format!("time_constant_s[{axis}]"), time, 0.005, 5.0)?;
        }
        Ok(())
    }

    /// Torque of a body of this `inertia` that turns at `rate` and is told `wanted`, rad/s.
    pub(super) fn torque(&self, inertia: &[f64; 3], rate: &Vector3<f64>, wanted: &Vector3<f64>) -> Vector3<f64> {
        let inertia = Vector3::from(*inertia);
        let acceleration = (wanted - rate).component_div(&Vector3::from(self.time_constant_s));
        inertia.component_mul(&acceleration) + rate.cross(&inertia.component_mul(rate))
    }
}
