//! What the payload filter is told, checked once.

use model::{OutOfRange, Real, Vector3, VehicleParams};

use super::state::ERRORS;
use crate::drag::Drag;
use crate::lever::within;

/// The vehicle, its air, its noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PayloadParams<T> {
    /// Period of the steps h, s, 10⁻³ to 0.01.
    pub period: T,
    /// m_Q, kg, 0.01 to 1000.
    pub uav_mass: T,
    /// m₀, kg, 0.001 to 1000: the payload's mass as far as it is known. The filter looks for the
    /// true one, 0.3 to 3.5 of it.
    pub payload_mass: T,
    /// L, m, 0.05 to 100, from the hook to the payload's centre of mass. **The filter can't find
    /// it**: an error of 2 % is one of the payload's height.
    pub cable_length: T,
    /// g, m/s², 0.1 to 30.
    pub gravity: T,
    /// Drag of the UAV.
    pub uav_drag: Drag<T>,
    /// Drag of the payload.
    pub payload_drag: Drag<T>,
    /// Where the cable hangs, from the UAV's centre of mass, body axes, m, each within ±2.
    pub hook: Vector3<T>,
    /// Where the accelerometer sits, from the UAV's centre of mass, body axes, m, each within ±2.
    pub imu: Vector3<T>,
    /// Noise.
    pub noise: PayloadNoise<T>,
}

/// How uncertain what is. Standard deviations, and square roots of spectral densities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PayloadNoise<T> {
    /// N_a, of the accelerometer **in flight**, m/s²/√Hz, 10⁻⁴ to 1. Three times too small doubles
    /// the rod's error.
    pub accelerometer: T,
    /// Of the rod's acceleration beyond that, 1/s²/√Hz, 10⁻⁵ to 1.
    pub rod: T,
    /// Of the thrust model across the thrust's axis and along it, over 40 ms, m/s², 10⁻³ to 10.
    pub lateral: T,
    /// Along it, m/s², likewise.
    pub axial: T,
    /// Wind, m/s, 0.1 to 50, and its time, s, 1 to 10⁴.
    pub wind: T,
    /// s.
    pub wind_time: T,
    /// Specific force on the payload that drag doesn't explain, m/s², 10⁻³ to 10, and its time, s,
    /// 1 to 10⁴.
    pub residual: T,
    /// s.
    pub residual_time: T,
    /// Lateral offset of the thrust model (tilt of the thrust's axis, bias of the accelerometer) at
    /// the start, m/s², 10⁻⁴ to 10.
    pub offset: T,
    /// Its walk, m/s²/√s, 10⁻⁶ to 1.
    pub offset_walk: T,
    /// Thrust scale at the start, 10⁻³ to 0.5.
    pub thrust: T,
    /// Mass ratio at the start, 10⁻³ to 1.
    pub mass: T,
    /// Walk of both, 1/√s, 10⁻⁶ to 0.1.
    pub scale_walk: T,
    /// Rod at the start, rad, 0.01 to 1, and its rate, 1/s, 0.01 to 10. **Too sure a start loses
    /// rods**.
    pub start_rod: T,
    /// 1/s.
    pub start_rate: T,
}

impl<T: Real> Default for PayloadNoise<T> {
    /// A multirotor of some kilograms with a MEMS accelerometer on soft mounts.
    fn default() -> Self {
        Self {
            accelerometer: T::lit(0.015),
            rod: T::lit(0.002),
            lateral: T::lit(0.05),
            axial: T::lit(0.3),
            wind: T::lit(4.0),
            wind_time: T::lit(200.0),
            residual: T::lit(0.04),
            residual_time: T::lit(30.0),
            offset: T::lit(0.02),
            offset_walk: T::lit(3e-4),
            thrust: T::lit(0.08),
            mass: T::lit(0.4),
            scale_walk: T::lit(1e-3),
            start_rod: T::lit(0.4),
            start_rate: T::lit(0.8),
        }
    }
}

impl<T: Real> PayloadNoise<T> {
    /// Standard deviations of the twelve errors at the start.
    pub(super) fn start(&self) -> [T; ERRORS] {
        let Self { start_rod: q, start_rate: w, wind, residual, offset, thrust, mass, .. } = *self;
        [q, q, w, w, wind, wind, residual, residual, offset, offset, thrust, mass]
    }

    /// The same, with these deviations of the rod (rad) and its rate (1/s) at the start.
    #[must_use]
    pub fn starting(self, rod: T, rate: T) -> Self {
        Self { start_rod: rod, start_rate: rate, ..self }
    }

    /// Every deviation times `factor`; times stay, and so does how sure the start is.
    #[must_use]
    pub fn times(self, factor: T) -> Self {
        Self {
            accelerometer: self.accelerometer * factor,
            rod: self.rod * factor,
            lateral: self.lateral * factor,
            axial: self.axial * factor,
            wind: self.wind * factor,
            residual: self.residual * factor,
            offset: self.offset * factor,
            offset_walk: self.offset_walk * factor,
            thrust: self.thrust * factor,
            mass: self.mass * factor,
            scale_walk: self.scale_walk * factor,
            ..self
        }
    }

    fn check(&self) -> Result<(), OutOfRange<T>> {
        OutOfRange::check("noise.accelerometer", self.accelerometer, 1e-4, 1.0)?;
        OutOfRange::check("noise.rod", self.rod, 1e-5, 1.0)?;
        OutOfRange::check("noise.lateral", self.lateral, 1e-3, 10.0)?;
        OutOfRange::check("noise.axial", self.axial, 1e-3, 10.0)?;
        OutOfRange::check("noise.wind", self.wind, 0.1, 50.0)?;
        OutOfRange::check("noise.wind_time", self.wind_time, 1.0, 1e4)?;
        OutOfRange::check("noise.residual", self.residual, 1e-3, 10.0)?;
        OutOfRange::check("noise.residual_time", self.residual_time, 1.0, 1e4)?;
        OutOfRange::check("noise.offset", self.offset, 1e-4, 10.0)?;
        OutOfRange::check("noise.offset_walk", self.offset_walk, 1e-6, 1.0)?;
        OutOfRange::check("noise.thrust", self.thrust, 1e-3, 0.5)?;
        OutOfRange::check("noise.mass", self.mass, 1e-3, 1.5)?;
        OutOfRange::check("noise.scale_walk", self.scale_walk, 1e-6, 0.1)?;
        OutOfRange::check("noise.start_rod", self.start_rod, 0.01, 1.5)?;
        OutOfRange::check("noise.start_rate", self.start_rate, 0.01, 10.0)
    }
}

impl<T: Real> PayloadParams<T> {
    /// The vehicle that a law is told, with steps of `period` s: hook and accelerometer at its
    /// centre of mass, no drag.
    pub fn of(vehicle: &VehicleParams<T>, period: T) -> Self {
        let still = Drag { linear: T::zero(), quadratic: T::zero() };
        Self {
            period,
            uav_mass: vehicle.uav_mass,
            payload_mass: vehicle.payload_mass,
            cable_length: vehicle.rod_length,
            gravity: vehicle.gravity,
            uav_drag: still,
            payload_drag: still,
            hook: Vector3::zeros(),
            imu: Vector3::zeros(),
            noise: PayloadNoise::default(),
        }
    }

    pub(super) fn check(&self) -> Result<(), OutOfRange<T>> {
        OutOfRange::check("period", self.period, 1e-3, 0.01)?;
        OutOfRange::check("uav_mass", self.uav_mass, 1e-2, 1e3)?;
        OutOfRange::check("payload_mass", self.payload_mass, 1e-3, 1e3)?;
        OutOfRange::check("cable_length", self.cable_length, 0.05, 100.0)?;
        OutOfRange::check("gravity", self.gravity, 0.1, 30.0)?;
        self.uav_drag.check("uav_drag")?;
        self.payload_drag.check("payload_drag")?;
        within("hook", &self.hook)?;
        within("imu", &self.imu)?;
        self.noise.check()
    }
}
