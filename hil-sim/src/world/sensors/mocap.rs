//! Motion capture of UAV and load: places with white noise, the UAV's attitude with a white
//! rotation, late.

use controller::{Matrix3, State, Vector3};
use serde::Deserialize;
use std::collections::VecDeque;

use super::super::check;
use crate::describe::input::Invalid;
use crate::world::random::Stream;

/// A motion capture system; left out, 1 mm and 0.2° at 200 Hz, 10 ms late.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Mocap {
    /// Frames a second, 1 to 1000.
    pub rate_hz: f64,
    /// From a frame to its coming, s, 0 to 0.3.
    pub delay_s: f64,
    /// White, an axis, m, 10⁻⁵ to 10.
    pub noise: f64,
    /// White, an axis, rad, 10⁻⁵ to 1.
    pub attitude_noise: f64,
    /// Whether it sees the load.
    pub load: bool,
}

impl Default for Mocap {
    fn default() -> Self {
        Self { rate_hz: 200.0, delay_s: 0.01, noise: 0.001, attitude_noise: 0.2_f64.to_radians(), load: true }
    }
}

impl Mocap {
    pub(super) fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "rate_hz", self.rate_hz, 1.0, 1000.0)?;
        check(at, "delay_s", self.delay_s, 0.0, 0.3)?;
        check(at, "noise", self.noise, 1e-5, 10.0)?;
        check(at, "attitude_noise", self.attitude_noise, 1e-5, 1.0)
    }
}

/// A frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseReading {
    /// Of the UAV's centre of mass in N, m.
    pub position: Vector3<f64>,
    /// Body to N.
    pub attitude: Matrix3<f64>,
    /// Of the load in N, m, where it is seen.
    pub load: Option<Vector3<f64>>,
    /// Age, s.
    pub age: f64,
}

/// A system at work.
#[derive(Clone, Debug)]
pub(super) struct MocapModel {
    mocap: Mocap,
    stream: Stream,
    next_s: f64,
    line: VecDeque<(f64, PoseReading)>,
}

impl MocapModel {
    pub(super) fn new(mocap: Mocap, stream: Stream) -> Self {
        Self { mocap, stream, next_s: 0.0, line: VecDeque::new() }
    }

    pub(super) fn read(&mut self, t_s: f64, state: &State<f64>, place: &Vector3<f64>) -> Option<PoseReading> {
        const INSTANT: f64 = 1e-9;
        if t_s > self.next_s - INSTANT {
            self.next_s += 1.0 / self.mocap.rate_hz;
            let turn = self.stream.normals() * self.mocap.attitude_noise;
            let columns = [0, 1, 2].map(|i| {
                let b: Vector3<f64> = state.attitude.column(i).into();
                let turned = b + turn.cross(&b);
                turned / turned.dot(&turned).sqrt()
            });
            let mut placed = |place: &Vector3<f64>| place + self.stream.normals() * self.mocap.noise;
            let reading = PoseReading {
                position: placed(place),
                attitude: Matrix3::from_columns(&columns),
                load: self.mocap.load.then(|| placed(&state.position)),
                age: self.mocap.delay_s,
            };
            self.line.push_back((t_s + self.mocap.delay_s, reading));
        }
        if self.line.front().is_some_and(|(comes_s, _)| t_s > comes_s - INSTANT) {
            self.line.pop_front().map(|(_, reading)| reading)
        } else {
            None
        }
    }
}
