//! Barometer, magnetometer and rotor speed: one number or vector each, with a rate, a constant
//! error and white noise.
//!
//! ```text
//! height  = −p3 + offset + slow + white              slow: first-order Markov, pressure of weather and of the rotors' wash
//! field   = Rᵀ (cos I cos D, cos I sin D, sin I) + hard iron + white         of the field's strength
//! thrust  = Σ k_f Ω²  by the ESC's speeds, with a relative error a reading; k_f as it was measured on a bench
//! ```

use controller::{Matrix3, Vector3};
use serde::Deserialize;

use super::super::check;
use crate::describe::input::Invalid;
use crate::world::random::Stream;

/// A barometer as a height; left out, the noise of a Bosch BMP388 (BST-BMP388-DS001: 1.2 Pa, 0.1 m)
/// and the slow error of ±8 Pa, 0.66 m.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Barometer {
    /// Readings a second, 1 to 200.
    pub rate_hz: f64,
    /// White, m, 0 to 100.
    pub noise: f64,
    /// Deviation of the constant error, m, 0 to 1000.
    pub offset: f64,
    /// Deviation of the slow error, m, 0 to 100.
    pub slow: f64,
    /// Its time, s, 1 to 10⁴.
    pub slow_time_s: f64,
}

impl Default for Barometer {
    fn default() -> Self {
        Self { rate_hz: 25.0, noise: 0.1, offset: 5.0, slow: 0.66, slow_time_s: 120.0 }
    }
}

/// A magnetometer; left out, that of a Bosch BMM150-like part after calibration: 1 % noise and 3 %
/// hard iron of the field.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Magnetometer {
    /// Readings a second, 1 to 200.
    pub rate_hz: f64,
    /// White, of the field's strength, 0 to 1.
    pub noise: f64,
    /// Deviation of the constant error an axis, of the field's strength, 0 to 1.
    pub hard_iron: f64,
    /// I, rad, down, within ±1.5.
    pub inclination: f64,
    /// D, rad, from n1 to n2, within ±3.15.
    pub declination: f64,
}

impl Default for Magnetometer {
    fn default() -> Self {
        Self { rate_hz: 20.0, noise: 0.01, hard_iron: 0.02, inclination: 1.1, declination: 0.0 }
    }
}

/// Speeds of the rotors by their controllers; left out, 1 % of thrust.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Esc {
    /// Deviation of a reading, of the thrust, 0 to 0.5.
    pub noise: f64,
}

impl Default for Esc {
    fn default() -> Self {
        Self { noise: 0.01 }
    }
}

impl Barometer {
    pub(super) fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "rate_hz", self.rate_hz, 1.0, 200.0)?;
        check(at, "noise", self.noise, 0.0, 100.0)?;
        check(at, "offset", self.offset, 0.0, 1000.0)?;
        check(at, "slow", self.slow, 0.0, 100.0)?;
        check(at, "slow_time_s", self.slow_time_s, 1.0, 1e4)
    }
}

impl Magnetometer {
    pub(super) fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "rate_hz", self.rate_hz, 1.0, 200.0)?;
        check(at, "noise", self.noise, 0.0, 1.0)?;
        check(at, "hard_iron", self.hard_iron, 0.0, 1.0)?;
        check(at, "inclination", self.inclination, -1.5, 1.5)?;
        check(at, "declination", self.declination, -3.15, 3.15)
    }
}

impl Esc {
    pub(super) fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "noise", self.noise, 0.0, 0.5)
    }

    /// The thrust that the speeds stand for, N.
    pub(super) fn read(&self, thrust: f64, stream: &mut Stream) -> f64 {
        thrust * (1.0 + stream.normal() * self.noise)
    }
}

/// A barometer at work.
#[derive(Clone, Debug)]
pub(super) struct BarometerModel {
    barometer: Barometer,
    stream: Stream,
    offset: f64,
    slow: f64,
}

impl BarometerModel {
    pub(super) fn new(barometer: Barometer, mut stream: Stream) -> Self {
        let (offset, slow) = (stream.normal() * barometer.offset, stream.normal() * barometer.slow);
        Self { barometer, stream, offset, slow }
    }

    pub(super) fn rate_hz(&self) -> f64 {
        self.barometer.rate_hz
    }

    pub(super) fn read(&mut self, place: &Vector3<f64>) -> f64 {
        let Barometer { rate_hz, noise, slow, slow_time_s, .. } = self.barometer;
        let kept = libm::exp(-1.0 / (rate_hz * slow_time_s));
        self.slow = self.slow * kept + self.stream.normal() * slow * (1.0 - kept * kept).sqrt();
        -place.z + self.offset + self.slow + self.stream.normal() * noise
    }
}

/// A magnetometer at work.
#[derive(Clone, Debug)]
pub(super) struct MagnetometerModel {
    magnetometer: Magnetometer,
    stream: Stream,
    hard_iron: Vector3<f64>,
}

impl MagnetometerModel {
    pub(super) fn new(magnetometer: Magnetometer, mut stream: Stream) -> Self {
        let hard_iron = stream.normals() * magnetometer.hard_iron;
        Self { magnetometer, stream, hard_iron }
    }

    pub(super) fn rate_hz(&self) -> f64 {
        self.magnetometer.rate_hz
    }

    pub(super) fn read(&mut self, attitude: &Matrix3<f64>) -> Vector3<f64> {
        let Magnetometer { noise, inclination, declination, .. } = self.magnetometer;
        let level = libm::cos(inclination);
        let field =
            Vector3::new(level * libm::cos(declination), level * libm::sin(declination), libm::sin(inclination));
        attitude.transpose() * field + self.hard_iron + self.stream.normals() * noise
    }
}
