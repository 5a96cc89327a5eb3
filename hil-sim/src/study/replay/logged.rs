//! What a replay takes from a log: the UAV's motion, and what else there is.

use controller::{Command, Matrix3, Vector3};
use nalgebra::{Quaternion, UnitQuaternion};

use super::ReplayError;
use super::series::{Between, Series};
use crate::report::log::{MOTORS, OUTPUTS, ReadError};

/// Least and most length of a pulse, µs.
const PULSE: [f64; 2] = [1000.0, 2000.0];

/// A log's columns.
pub struct Logged {
    /// Of the UAV in N.
    uav: Series<6>,
    attitude: Series<4>,
    body_rate: Series<3>,
    specific_force: Option<Series<3>>,
    /// Of the payload in N.
    load: Option<Series<6>>,
    thrust: Option<Series<1>>,
    torque: Option<Series<3>>,
    /// What is not in the log, and what can't be said without it.
    pub unsaid: Vec<String>,
}

/// The UAV at an instant.
pub struct UavMotion {
    /// In N, m.
    pub position: Vector3<f64>,
    /// In N, m/s.
    pub velocity: Vector3<f64>,
    /// R, body to N.
    pub attitude: Matrix3<f64>,
    /// ω in body axes, rad/s.
    pub body_rate: Vector3<f64>,
}

fn all<const N: usize>(row: &[f64; N]) -> bool {
    row.iter().all(|number| number.is_finite())
}

/// An attitude that is not known yet is logged as zeros.
fn is_attitude(q: &[f64; 4]) -> bool {
    (0.5..2.0).contains(&q.iter().map(|part| part * part).sum::<f64>())
}

fn any<const N: usize>(row: &[f64; N]) -> bool {
    row.iter().any(|number| number.is_finite())
}

/// The mean of `shares` that are numbers.
fn mean(shares: impl Iterator<Item = f64>) -> [f64; 1] {
    let (sum, count) = shares.filter(|share| share.is_finite()).fold((0.0, 0.0), |(s, n), x| (s + x, n + 1.0));
    [sum / count]
}

/// Of two that say the same, the one that says it more often.
fn denser<const N: usize>(one: Option<Series<N>>, other: Option<Series<N>>) -> Option<Series<N>> {
    match (one, other) {
        (Some(one), Some(other)) => Some(if other.len() > one.len() { other } else { one }),
        (one, other) => one.or(other),
    }
}

impl Logged {
    /// Reads a log; `full_thrust` is what all rotors give together at most, N, for logs that have
    /// shares of it.
    ///
    /// # Errors
    /// [`ReplayError`] for what is no log, or lacks how the UAV moves.
    pub fn read(bytes: &[u8], full_thrust: Option<f64>) -> Result<Self, ReplayError> {
        let uav = Series::read(bytes, ["uav_p1", "uav_p2", "uav_p3", "uav_v1", "uav_v2", "uav_v3"], all)?;
        let attitude = Series::read(bytes, ["att_w", "att_x", "att_y", "att_z"], is_attitude)?;
        let body_rate = denser(
            Series::read(bytes, ["omega1", "omega2", "omega3"], all)?,
            Series::read(bytes, ["raw_omega1", "raw_omega2", "raw_omega3"], all)?,
        );
        let specific_force = denser(
            Series::read(bytes, ["f1", "f2", "f3"], all)?,
            Series::read(bytes, ["raw_f1", "raw_f2", "raw_f3"], all)?,
        );
        let load = Series::read(bytes, ["p1", "p2", "p3", "v1", "v2", "v3"], all)?;
        let torque = Series::read(bytes, ["torque1", "torque2", "torque3"], all)?;
        let (thrust, scale) = thrust(bytes, full_thrust)?;

        let lacks: Vec<&str> = [
            (uav.is_none(), "uav_p1 … uav_p3, uav_v1 … uav_v3 (PX4: vehicle_local_position)"),
            (attitude.is_none(), "att_w … att_z (PX4: vehicle_attitude)"),
            (body_rate.is_none(), "omega1 … omega3 (PX4: vehicle_angular_velocity or sensor_combined)"),
        ]
        .into_iter()
        .filter_map(|(lacks, what)| lacks.then_some(what))
        .collect();
        let (Some(uav), Some(attitude), Some(body_rate)) = (uav, attitude, body_rate) else {
            return Err(ReplayError::Motion(lacks.join("; ")));
        };
        if specific_force.is_none() && load.is_none() {
            return Err(ReplayError::Load);
        }
        let missing = [
            (
                specific_force.is_none(),
                "no f1 … f3 (PX4: vehicle_acceleration or sensor_combined): the estimator is not replayed, and the law is given the logged load",
            ),
            (
                load.is_none(),
                "no p1 … p3, v1 … v3 of the load: how far the estimate is off is not said, and d_C is that of the estimate",
            ),
            (
                thrust.is_none() && scale,
                "thrust is logged as a share: without --full-thrust the estimator learns nothing from it, nor is thrust compared",
            ),
            (
                thrust.is_none() && !scale,
                "no thrust (PX4: vehicle_thrust_setpoint, actuator_motors or actuator_outputs): the estimator learns nothing from it, nor is thrust compared",
            ),
            (torque.is_none(), "no torque1 … torque3 in N m: torque is not compared"),
        ];
        let unsaid = missing.into_iter().filter(|(is, _)| *is).map(|(_, what)| what.to_owned()).collect();
        Ok(Self { uav, attitude, body_rate, specific_force, load, thrust, torque, unsaid })
    }

    /// The time for which all of the UAV's motion is there, s.
    pub fn span(&self) -> [f64; 2] {
        let spans = [self.uav.span(), self.attitude.span(), self.body_rate.span()];
        spans.into_iter().fold([f64::NEG_INFINITY, f64::INFINITY], |[from, to], [a, b]| [from.max(a), to.min(b)])
    }

    /// Whether the log has the load.
    pub fn has_load(&self) -> bool {
        self.load.is_some()
    }

    /// The UAV at `t_s`, unless the log has a gap there.
    pub fn uav(&self, t_s: f64) -> Option<UavMotion> {
        let [position, velocity] = split(self.uav.motion(t_s)?);
        let Between { from, to, share, .. } = self.attitude.around(t_s)?;
        let [from, to] =
            [from, to].map(|[w, x, y, z]| UnitQuaternion::from_quaternion(Quaternion::new(*w, *x, *y, *z)));
        let attitude = if share == 0.0 { from } else { from.try_slerp(&to, share, 1e-9).unwrap_or(from) };
        let attitude = Matrix3::from_column_slice(attitude.to_rotation_matrix().matrix().as_slice());
        Some(UavMotion { position, velocity, attitude, body_rate: self.body_rate.at(t_s)?.into() })
    }

    /// Position and velocity of the load at `t_s`.
    pub fn load(&self, t_s: f64) -> Option<[Vector3<f64>; 2]> {
        self.load.as_ref()?.motion(t_s).map(split)
    }

    /// Mean of the accelerometer's readings over the `period` that ends at `t_s`, m/s².
    pub fn specific_force(&self, t_s: f64, period: f64) -> Option<Vector3<f64>> {
        self.specific_force.as_ref()?.mean(t_s, period).map(Vector3::from)
    }

    /// Thrust commanded at `t_s`, N.
    pub fn thrust(&self, t_s: f64) -> Option<f64> {
        self.thrust.as_ref()?.at(t_s).map(|[thrust]| thrust)
    }

    /// What was commanded at `t_s`; a torque that the log lacks is no number.
    pub fn command(&self, t_s: f64) -> Option<Command<f64>> {
        let torque = self.torque.as_ref().and_then(|torque| torque.at(t_s)).unwrap_or([f64::NAN; 3]);
        Some(Command { thrust: self.thrust(t_s)?, torque: torque.into() })
    }
}

/// Thrust in N, and whether the log has it as a share.
fn thrust(bytes: &[u8], full_thrust: Option<f64>) -> Result<(Option<Series<1>>, bool), ReadError> {
    if let Some(thrust) = Series::read(bytes, ["thrust"], all)? {
        return Ok((Some(thrust), false));
    }
    let setpoint = Series::read(bytes, ["thrust_share3"], all)?.map(|series| series.map(|[along_b3]| [-along_b3]));
    let motors = Series::read(bytes, MOTORS, any)?.map(|series| series.map(|shares| mean(shares.iter().copied())));
    let outputs = Series::read(bytes, OUTPUTS, |row| row.iter().any(|pulse| *pulse > 0.0))?.map(|series| {
        let [least, most] = PULSE;
        let share = |pulse: &f64| ((pulse - least) / (most - least)).max(0.0);
        series.map(|pulses| mean(pulses.iter().filter(|pulse| **pulse > 0.0).map(share)))
    });
    let share = setpoint.or(motors).or(outputs);
    let is_share = share.is_some();
    Ok((share.zip(full_thrust).map(|(share, full)| share.map(|[share]| [share * full])), is_share))
}

fn split([x, y, z, u, v, w]: [f64; 6]) -> [Vector3<f64>; 2] {
    [Vector3::new(x, y, z), Vector3::new(u, v, w)]
}
