//! An inertial measurement unit on a vibrating frame.
//!
//! The accelerometer gives the mean specific force of its place over a control period, f = Rᵀ(Δv/h
//! − g e3) with R of the period's middle, the gyro the newest rate; both with
//!
//! ```text
//! reading = clip((1 + scale) M (true + vibration) + bias + noise),   bias: constant + random walk
//! noise: white, deviation N/√h;   M: small random rotation
//! vibration: Σ A_k (T/T_hover) sin(k φ),  φ̇ = 2π f_hover √(T/T_hover),  k = 1, 2
//! ```
//!
//! Vibration is sampled `sample_hz` times a second and averaged over the period, so lines of the
//! rotors alias as they do in a driver that averages (IEEE Std 952 and 1293 for the terms of noise;
//! a rotor's imbalance is a line at its speed, growing with its square, which thrust is).

use controller::{Matrix3, State, Vector3};
use serde::Deserialize;

use super::super::check;
use crate::describe::input::{Invalid, all_within, join};
use crate::world::random::Stream;

/// Standard gravity, m/s²: data sheets count in it.
const STANDARD_GRAVITY: f64 = 9.80665;

/// Parts, by their data sheets' typical figures **at rest**. In flight the accelerometer is some
/// ten times as noisy.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum ImuPart {
    /// Bosch BMI088, BST-BMI088-DS001: 160 to 190 µg/√Hz, ±20 mg; 0.014 °/s/√Hz, ±1 °/s; ±24 g,
    /// ±2000 °/s.
    Bmi088,
    /// TDK `InvenSense` ICM-42688-P, DS-000347: 65 to 70 µg/√Hz, ±20 mg; 0.0028 °/s/√Hz, ±0.5 °/s;
    /// ±16 g, ±2000 °/s.
    Icm42688P,
    /// TDK `InvenSense` MPU-6000, PS-MPU-6000A: 400 µg/√Hz, ±50 to 80 mg; 0.005 °/s/√Hz, ±20 °/s
    /// (calibrated at rest: ±1); ±16 g, ±2000 °/s.
    Mpu6000,
}

/// An IMU; what is left out is a part's, or that of a MEMS IMU in flight.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, from = "ImuFields")]
pub struct Imu {
    /// m/s²/√Hz, 0 to 1.
    pub accelerometer_noise: f64,
    /// rad/s/√Hz, 0 to 0.1.
    pub gyro_noise: f64,
    /// Deviation of the constant bias, m/s², 0 to 5.
    pub accelerometer_bias: f64,
    /// rad/s, 0 to 1.
    pub gyro_bias: f64,
    /// Random walk of the biases, m/s²/√s and rad/s/√s, 0 to 0.1.
    pub accelerometer_walk: f64,
    /// rad/s/√s.
    pub gyro_walk: f64,
    /// Deviation of the scale factors, 0 to 0.1.
    pub scale: f64,
    /// Deviation of the axes' misalignment, rad, 0 to 0.1.
    pub misalignment: f64,
    /// Amplitudes at hover of the lines at one and two times the rotors' speed, m/s², 0 to 200.
    pub vibration: [f64; 2],
    /// The rotors' speed at hover, Hz, 5 to 500.
    pub hover_hz: f64,
    /// Samples of the accelerometer in a second, 100 to 32000.
    pub sample_hz: f64,
    /// Largest reading, m/s², 10 to 2000.
    pub range: f64,
    /// From the centre of mass, body axes, m, each within ±2.
    pub lever: [f64; 3],
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ImuFields {
    part: Option<ImuPart>,
    accelerometer_noise: Option<f64>,
    gyro_noise: Option<f64>,
    accelerometer_bias: Option<f64>,
    gyro_bias: Option<f64>,
    accelerometer_walk: Option<f64>,
    gyro_walk: Option<f64>,
    scale: Option<f64>,
    misalignment: Option<f64>,
    vibration: Option<[f64; 2]>,
    hover_hz: Option<f64>,
    sample_hz: Option<f64>,
    range: Option<f64>,
    lever: Option<[f64; 3]>,
}

impl From<ImuFields> for Imu {
    fn from(fields: ImuFields) -> Self {
        let base = fields.part.map_or_else(Self::in_flight, Self::of);
        Self {
            accelerometer_noise: fields.accelerometer_noise.unwrap_or(base.accelerometer_noise),
            gyro_noise: fields.gyro_noise.unwrap_or(base.gyro_noise),
            accelerometer_bias: fields.accelerometer_bias.unwrap_or(base.accelerometer_bias),
            gyro_bias: fields.gyro_bias.unwrap_or(base.gyro_bias),
            accelerometer_walk: fields.accelerometer_walk.unwrap_or(base.accelerometer_walk),
            gyro_walk: fields.gyro_walk.unwrap_or(base.gyro_walk),
            scale: fields.scale.unwrap_or(base.scale),
            misalignment: fields.misalignment.unwrap_or(base.misalignment),
            vibration: fields.vibration.unwrap_or(base.vibration),
            hover_hz: fields.hover_hz.unwrap_or(base.hover_hz),
            sample_hz: fields.sample_hz.unwrap_or(base.sample_hz),
            range: fields.range.unwrap_or(base.range),
            lever: fields.lever.unwrap_or(base.lever),
        }
    }
}

impl Imu {
    /// A MEMS IMU on a flying multirotor: 0.3 m/s² a sample of 2 ms, biases after calibration.
    #[must_use]
    pub fn in_flight() -> Self {
        Self {
            accelerometer_noise: 0.015,
            gyro_noise: 7e-4,
            accelerometer_bias: 0.03,
            gyro_bias: 0.003,
            accelerometer_walk: 3e-4,
            gyro_walk: 2e-5,
            scale: 0.0,
            misalignment: 0.0,
            vibration: [0.0; 2],
            hover_hz: 90.0,
            sample_hz: 2000.0,
            range: 16.0 * STANDARD_GRAVITY,
            lever: [0.0; 3],
        }
    }

    /// A part at rest.
    #[must_use]
    pub fn of(part: ImuPart) -> Self {
        let micro_g = STANDARD_GRAVITY * 1e-6;
        let degree = 1.0_f64.to_radians();
        let (noise, bias, gyro, drift, range) = match part {
            ImuPart::Bmi088 => (175.0, 20e-3, 0.014, 1.0, 24.0),
            ImuPart::Icm42688P => (70.0, 20e-3, 0.0028, 0.5, 16.0),
            ImuPart::Mpu6000 => (400.0, 50e-3, 0.005, 1.0, 16.0),
        };
        Self {
            accelerometer_noise: noise * micro_g,
            gyro_noise: gyro * degree,
            accelerometer_bias: bias * STANDARD_GRAVITY,
            gyro_bias: drift * degree,
            scale: 0.005,
            misalignment: 0.005,
            range: range * STANDARD_GRAVITY,
            ..Self::in_flight()
        }
    }

    pub(super) fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "accelerometer_noise", self.accelerometer_noise, 0.0, 1.0)?;
        check(at, "gyro_noise", self.gyro_noise, 0.0, 0.1)?;
        check(at, "accelerometer_bias", self.accelerometer_bias, 0.0, 5.0)?;
        check(at, "gyro_bias", self.gyro_bias, 0.0, 1.0)?;
        check(at, "accelerometer_walk", self.accelerometer_walk, 0.0, 0.1)?;
        check(at, "gyro_walk", self.gyro_walk, 0.0, 0.1)?;
        check(at, "scale", self.scale, 0.0, 0.1)?;
        check(at, "misalignment", self.misalignment, 0.0, 0.1)?;
        for (index, amplitude) in self.vibration.into_iter().enumerate() {
            check(at, &format!("vibration[{index}]"), amplitude, 0.0, 200.0)?;
        }
        check(at, "hover_hz", self.hover_hz, 5.0, 500.0)?;
        check(at, "sample_hz", self.sample_hz, 100.0, 32_000.0)?;
        check(at, "range", self.range, 10.0, 2000.0)?;
        all_within(&join(at, "lever"), self.lever, 2.0).map(|_| ())
    }
}

/// What the unit reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImuReading {
    /// Newest, body axes, rad/s.
    pub body_rate: Vector3<f64>,
    /// Mean over the period, body axes, m/s².
    pub specific_force: Vector3<f64>,
}

/// A unit at work.
#[derive(Clone, Debug)]
pub(super) struct ImuModel {
    imu: Imu,
    stream: Stream,
    accelerometer_bias: Vector3<f64>,
    gyro_bias: Vector3<f64>,
    /// (1 + scale) M of accelerometer and gyro.
    gains: [Matrix3<f64>; 2],
    /// φ of the vibration, turns, and each axis's own phases.
    turns: f64,
    phases: [Vector3<f64>; 2],
    before: Option<(Vector3<f64>, Matrix3<f64>)>,
}

impl ImuModel {
    pub(super) fn new(imu: Imu, mut stream: Stream) -> Self {
        let accelerometer_bias = stream.normals() * imu.accelerometer_bias;
        let gyro_bias = stream.normals() * imu.gyro_bias;
        let gains = [(); 2].map(|()| {
            let (scale, off) = (stream.normals() * imu.scale, stream.normals() * imu.misalignment);
            Matrix3::new(1.0 + scale.x, -off.z, off.y, off.z, 1.0 + scale.y, -off.x, -off.y, off.x, 1.0 + scale.z)
        });
        let phases = [(); 2].map(|()| Vector3::from_fn(|_, _| stream.unit()));
        Self { imu, stream, accelerometer_bias, gyro_bias, gains, turns: 0.0, phases, before: None }
    }

    /// Reads at the end of a `period` of flight: the body's `state`, the velocity of its centre of
    /// mass in N, and its thrust as a share of hover's.
    pub(super) fn read(
        &mut self,
        state: &State<f64>,
        uav_velocity: &Vector3<f64>,
        gravity: f64,
        thrust_share: f64,
        period: f64,
    ) -> ImuReading {
        let lever = Vector3::from(self.imu.lever);
        let velocity = uav_velocity + state.attitude * state.body_rate.cross(&lever);
        let (before, attitude) =
            self.before.replace((velocity, state.attitude)).unwrap_or((velocity, state.attitude));
        let mut force = (velocity - before) / period;
        force.z -= gravity;
        let middle = (attitude + state.attitude) * 0.5;
        let force = middle.transpose() * force + self.vibrate(thrust_share, period);
        let root = period.sqrt();
        self.accelerometer_bias += self.stream.normals() * (self.imu.accelerometer_walk * root);
        self.gyro_bias += self.stream.normals() * (self.imu.gyro_walk * root);
        let [accelerometer, gyro] = self.gains;
        let force = accelerometer * force
            + self.accelerometer_bias
            + self.stream.normals() * (self.imu.accelerometer_noise / root);
        let rate = gyro * state.body_rate + self.gyro_bias + self.stream.normals() * (self.imu.gyro_noise / root);
        ImuReading { body_rate: rate, specific_force: force.map(|f| f.clamp(-self.imu.range, self.imu.range)) }
    }

    /// Mean over the period of the samples of the rotors' lines.
    fn vibrate(&mut self, thrust_share: f64, period: f64) -> Vector3<f64> {
        if self.imu.vibration == [0.0; 2] {
            return Vector3::zeros();
        }
        let samples = (self.imu.sample_hz * period).round().max(1.0);
        let step = self.imu.hover_hz * thrust_share.max(0.0).sqrt() * period / samples;
        let mut sum = Vector3::zeros();
        for _ in 0..samples as u32 {
            self.turns = (self.turns + step).fract();
            for ((k, amplitude), phases) in (1..).zip(self.imu.vibration).zip(&self.phases) {
                sum += phases
                    .map(|phase| amplitude * libm::sin(core::f64::consts::TAU * (f64::from(k) * self.turns + phase)));
            }
        }
        sum * (thrust_share / samples)
    }
}
