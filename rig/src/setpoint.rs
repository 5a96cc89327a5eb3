//! `INN_*`: what an inner loop of body rates is asked for, where an autopilot has one of its own
//! between this law and the rotors.
//!
//! The law's torque τ is to give the angular acceleration ω̇ = J⁻¹ (τ + τ_d − ω × J ω). A
//! rate loop that reaches its setpoint with the time constant T_i about axis i gives it if asked,
//! the known latency δ from now, for
//!
//! ```text
//! ω_sp,i = ω_i + (δ + T_i) ω̇_i
//! ```
//!
//! since ω_i has by then gone on by δ ω̇_i. The lag of the motors below such a loop is the loop's
//! own to make good: the law is not to be told of it.
//!
//! Each axis has its own time constant: yaw, by the rotors' drag, is mostly many times slower than
//! roll and pitch.

use controller::{Real, Vector3, dynamics::turning};

use crate::entry::Entry;
use crate::parameters::Parameters;
use crate::rig::Rig;
use crate::{parameter, run};

const TIME_CONSTANT: (f64, f64) = (0.0, 5.0);

pub(crate) const ENTRIES: &[Entry<f64>] = &[
    Entry::real("INN_T_1", "time_constant[0]", "s", 0.03, TIME_CONSTANT, "Inner rate loop's time constant about b1."),
    Entry::real("INN_T_2", "time_constant[1]", "s", 0.03, TIME_CONSTANT, "Inner rate loop's time constant about b2."),
    Entry::real("INN_T_3", "time_constant[2]", "s", 0.03, TIME_CONSTANT, "Inner rate loop's time constant about b3."),
];

/// What an inner loop is asked for, in body axes. Thrust is the command's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateSetpoint<T> {
    /// ω̇ under the command and the torque that was found to disturb, rad/s².
    pub angular_acceleration: Vector3<T>,
    /// ω_sp, rad/s.
    pub body_rate: Vector3<T>,
}

/// δ + T_i, s.
pub(crate) fn time_constants<T: Real>(parameters: &Parameters<T>) -> Vector3<T> {
    let latency = parameters.get(parameter!("CTL_LATENCY"));
    Vector3::from(parameters.run(run!("INN_T_1" to "INN_T_3"))).map(|time| latency + time)
}

impl<T: Real, P: controller::Path<T>, A: controller::Actuation<T>> Rig<T, P, A> {
    /// The last step's command as an inner rate loop's setpoint, at the
    /// [body rate](controller::Measured::body_rate) it was made on, rad/s. Where none is known it
    /// is to stop turning.
    #[must_use]
    pub fn rate_setpoint(&self, body_rate: Option<Vector3<T>>) -> RateSetpoint<T> {
        let Some(body_rate) = body_rate else {
            return RateSetpoint { angular_acceleration: Vector3::zeros(), body_rate: Vector3::zeros() };
        };
        let (torque, disturbing) = (&self.output().command.torque, &self.disturbance().torque);
        let acceleration = turning(self.vehicle(), &body_rate, torque, disturbing);
        RateSetpoint {
            angular_acceleration: acceleration,
            body_rate: body_rate + acceleration.component_mul(self.time_constants()),
        }
    }
}
