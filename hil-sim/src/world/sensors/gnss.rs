//! A satellite receiver: position and velocity at a rate, late, with errors that are partly slow.
//!
//! ```text
//! position = antenna + white + slow,   slow: first-order Markov of deviation σ_s and time τ_s
//! velocity = antenna's + white
//! ```
//!
//! each component by itself, horizontal and down apart. What the receiver states of its accuracy is
//! the white and slow deviations together, as of the kind of solution that it has: RTK fixed, float
//! (`float` is when), or plain (Misra and Enge, *Global Positioning System*, 2nd ed., ch. 5 and 7
//! for the orders of magnitude).

use controller::{State, Vector3};
use serde::Deserialize;
use std::collections::VecDeque;

use super::super::check;
use super::Window;
use crate::describe::input::{Invalid, all_within, join};
use crate::world::random::Stream;

/// Receivers and what they solve for.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum GnssPart {
    /// Any RTK receiver with a fixed solution: 7 mm white and 8 mm slow, 1.6 times as much down.
    Rtk,
    /// Any receiver without corrections: 0.9 m slow and 0.15 m white, 1.6 times as much down.
    Plain,
    /// u-blox ZED-F9P with corrections, UBX-17051259: 0.01 m + 1 ppm CEP, velocity 0.05 m/s.
    ZedF9pRtk,
    /// u-blox ZED-F9P alone: 1.5 m CEP.
    ZedF9p,
    /// u-blox NEO-M9N, UBX-19014285: 2 m CEP, velocity 0.05 m/s.
    NeoM9n,
}

/// A receiver; what is left out is its part's.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, from = "GnssFields")]
pub struct Gnss {
    /// Fixes a second, 0.1 to 50.
    pub rate_hz: f64,
    /// From the fix's time to its coming, s, 0 to 0.3.
    pub delay_s: f64,
    /// What the delay is beyond what is told, s, within ±0.1.
    pub untold_delay_s: f64,
    /// White, horizontal and down, m, 0 to 100.
    pub position_noise: [f64; 2],
    /// White, m/s, 0 to 10.
    pub velocity_noise: [f64; 2],
    /// Slow, m, 0 to 100.
    pub slow: [f64; 2],
    /// Its time, s, 1 to 10⁴.
    pub slow_time_s: f64,
    /// When there is no fix.
    pub drop_out: Option<Window>,
    /// When an RTK receiver has a float solution: errors and stated accuracy thirty times as large.
    pub float: Option<Window>,
    /// The antenna from the centre of mass, body axes, m, each within ±2.
    pub lever: [f64; 3],
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct GnssFields {
    part: Option<GnssPart>,
    rate_hz: Option<f64>,
    delay_s: Option<f64>,
    #[serde(default)]
    untold_delay_s: f64,
    position_noise: Option<[f64; 2]>,
    velocity_noise: Option<[f64; 2]>,
    slow: Option<[f64; 2]>,
    slow_time_s: Option<f64>,
    drop_out: Option<Window>,
    float: Option<Window>,
    #[serde(default)]
    lever: [f64; 3],
}

impl From<GnssFields> for Gnss {
    fn from(fields: GnssFields) -> Self {
        let base = Self::of(fields.part.unwrap_or(GnssPart::Rtk));
        Self {
            rate_hz: fields.rate_hz.unwrap_or(base.rate_hz),
            delay_s: fields.delay_s.unwrap_or(base.delay_s),
            untold_delay_s: fields.untold_delay_s,
            position_noise: fields.position_noise.unwrap_or(base.position_noise),
            velocity_noise: fields.velocity_noise.unwrap_or(base.velocity_noise),
            slow: fields.slow.unwrap_or(base.slow),
            slow_time_s: fields.slow_time_s.unwrap_or(base.slow_time_s),
            drop_out: fields.drop_out,
            float: fields.float,
            lever: fields.lever,
        }
    }
}

/// The deviation of one component of a horizontal error whose median is 1 (CEP).
const PER_CEP: f64 = 0.8493;
/// Down against horizontal.
const DOWN: f64 = 1.6;
/// A float solution's errors against a fixed one's.
const FLOAT: f64 = 30.0;
/// Only carrier phases are better than this, m.
const PHASES_M: f64 = 0.05;

impl Gnss {
    /// A part at 10 Hz, 100 ms late.
    #[must_use]
    pub fn of(part: GnssPart) -> Self {
        let both = |across: f64| [across, across * DOWN];
        let (white, slow, slow_time_s, velocity) = match part {
            GnssPart::Rtk => (0.007, 0.008, 60.0, [0.03, 0.05]),
            GnssPart::Plain => (0.15, 0.9, 100.0, [0.05, 0.08]),
            GnssPart::ZedF9pRtk => (0.7 * 0.01 * PER_CEP, 0.7 * 0.01 * PER_CEP, 60.0, both(0.05)),
            GnssPart::ZedF9p => (0.15, 1.5 * PER_CEP, 100.0, both(0.05)),
            GnssPart::NeoM9n => (0.2, 2.0 * PER_CEP, 100.0, both(0.05)),
        };
        Self {
            rate_hz: 10.0,
            delay_s: 0.1,
            untold_delay_s: 0.0,
            position_noise: both(white),
            velocity_noise: velocity,
            slow: both(slow),
            slow_time_s,
            drop_out: None,
            float: None,
            lever: [0.0; 3],
        }
    }

    pub(super) fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "rate_hz", self.rate_hz, 0.1, 50.0)?;
        check(at, "delay_s", self.delay_s, 0.0, 0.3)?;
        check(at, "untold_delay_s", self.untold_delay_s, -0.1, 0.1)?;
        for (name, values, most) in [
            ("position_noise", self.position_noise, 100.0),
            ("velocity_noise", self.velocity_noise, 10.0),
            ("slow", self.slow, 100.0),
        ] {
            for (index, value) in values.into_iter().enumerate() {
                check(at, &format!("{name}[{index}]"), value, 0.0, most)?;
            }
        }
        check(at, "slow_time_s", self.slow_time_s, 1.0, 1e4)?;
        for (name, window) in [("drop_out", &self.drop_out), ("float", &self.float)] {
            if let Some(window) = window {
                window.check(&join(at, name))?;
            }
        }
        all_within(&join(at, "lever"), self.lever, 2.0).map(|_| ())
    }
}

/// What a fix is solved from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solution {
    /// Code alone.
    Plain,
    /// Carrier phases with ambiguities as real numbers.
    Float,
    /// Carrier phases with their whole numbers of waves.
    Fixed,
}

/// A fix that comes now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixReading {
    /// Antenna in N, m.
    pub position: Vector3<f64>,
    /// m/s.
    pub velocity: Vector3<f64>,
    /// What the receiver states, horizontal and down, m and m/s.
    pub position_accuracy: [f64; 2],
    /// m/s.
    pub velocity_accuracy: [f64; 2],
    /// Its age as told, s.
    pub age: f64,
    /// What it was solved from.
    pub solution: Solution,
}

/// A receiver at work.
#[derive(Clone, Debug)]
pub(super) struct GnssModel {
    gnss: Gnss,
    stream: Stream,
    slow: Vector3<f64>,
    next_s: f64,
    line: VecDeque<(f64, FixReading)>,
}

impl GnssModel {
    pub(super) fn new(gnss: Gnss, mut stream: Stream) -> Self {
        let slow = scaled(&stream.normals(), gnss.slow);
        Self { gnss, stream, slow, next_s: 0.0, line: VecDeque::new() }
    }

    /// The fix that comes at `t_s`, if one does; another may be taken of the UAV's place and
    /// velocity.
    pub(super) fn read(
        &mut self,
        t_s: f64,
        state: &State<f64>,
        place: &Vector3<f64>,
        velocity: &Vector3<f64>,
    ) -> Option<FixReading> {
        const INSTANT: f64 = 1e-9;
        let gnss = self.gnss;
        if t_s > self.next_s - INSTANT {
            self.next_s += 1.0 / gnss.rate_hz;
            let kept = libm::exp(-1.0 / (gnss.rate_hz * gnss.slow_time_s));
            let fresh = (1.0 - kept * kept).sqrt();
            self.slow = self.slow * kept + scaled(&self.stream.normals(), gnss.slow) * fresh;
            let is_float = gnss.float.is_some_and(|window| window.contains(t_s));
            let factor = if is_float { FLOAT } else { 1.0 };
            let accuracy = [0, 1].map(|i| gnss.position_noise[i].hypot(gnss.slow[i]));
            let lever = Vector3::from(gnss.lever);
            let white = scaled(&self.stream.normals(), gnss.position_noise);
            let reading = FixReading {
                position: place + state.attitude * lever + (self.slow + white) * factor,
                velocity: velocity
                    + state.attitude * state.body_rate.cross(&lever)
                    + scaled(&self.stream.normals(), gnss.velocity_noise),
                position_accuracy: accuracy.map(|accuracy| factor * accuracy),
                velocity_accuracy: gnss.velocity_noise,
                age: gnss.delay_s,
                solution: match accuracy[0] < PHASES_M {
                    false => Solution::Plain,
                    true if is_float => Solution::Float,
                    true => Solution::Fixed,
                },
            };
            if !gnss.drop_out.is_some_and(|window| window.contains(t_s)) {
                self.line.push_back((t_s + gnss.delay_s + gnss.untold_delay_s, reading));
            }
        }
        if self.line.front().is_some_and(|(comes_s, _)| t_s > comes_s - INSTANT) {
            self.line.pop_front().map(|(_, reading)| reading)
        } else {
            None
        }
    }
}

/// Each component times its deviation.
fn scaled(v: &Vector3<f64>, [across, down]: [f64; 2]) -> Vector3<f64> {
    Vector3::new(v.x * across, v.y * across, v.z * down)
}
