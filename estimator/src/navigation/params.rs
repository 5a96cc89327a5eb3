//! What the navigation filter is told, checked once.

use model::{OutOfRange, Real, Vector3};

use crate::lever::within;

/// Levers and noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NavigationParams<T> {
    /// Period of the steps h, s, 10⁻³ to 0.01.
    pub period: T,
    /// g, m/s², 0.1 to 30.
    pub gravity: T,
    /// Where the IMU sits, from the UAV's centre of mass, body axes, m, each within ±2.
    pub imu: Vector3<T>,
    /// Where the antenna sits, likewise.
    pub antenna: Vector3<T>,
    /// Magnetic declination, rad: where a level compass points, from n1 toward n2, within ±π.
    pub declination: T,
    /// Noise.
    pub noise: NavigationNoise<T>,
}

/// Standard deviations, and square roots of spectral densities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NavigationNoise<T> {
    /// Accelerometer **in flight**, m/s²/√Hz, 10⁻⁴ to 1.
    pub accelerometer: T,
    /// Gyro, rad/s/√Hz, 10⁻⁶ to 0.1.
    pub gyro: T,
    /// Walk of the gyro's bias, rad/s/√s, 10⁻⁸ to 0.01.
    pub gyro_walk: T,
    /// Walk of the accelerometer's bias, m/s²/√s, 10⁻⁷ to 0.1.
    pub accelerometer_walk: T,
    /// Least deviation of a fix's position that is believed, horizontal and down, m, 10⁻³ to 100: a
    /// receiver's stated accuracy leaves out the slow part of its error.
    pub position: [T; 2],
    /// The same of its velocity, m/s, 10⁻³ to 10.
    pub velocity: [T; 2],
    /// Heading, rad, 10⁻³ to 3: more than its noise, since its error hardly changes.
    pub heading: T,
    /// Height of the barometer, m, 0.01 to 100: likewise, for pressure wanders by decimetres in
    /// seconds.
    pub barometer: T,
    /// Time over which the barometer's offset follows the fixes, s, 1 to 10⁴.
    pub barometer_time: T,
    /// At the start: tilt and heading, rad, 10⁻³ to 3.
    pub start_tilt: T,
    /// rad.
    pub start_heading: T,
    /// Gyro's bias, rad/s, 10⁻⁵ to 1.
    pub start_gyro: T,
    /// Accelerometer's bias, m/s², 10⁻⁴ to 10.
    pub start_accelerometer: T,
}

impl<T: Real> Default for NavigationNoise<T> {
    /// A MEMS IMU in flight, and an RTK receiver whose slow error is some 8 mm.
    fn default() -> Self {
        Self {
            accelerometer: T::lit(0.015),
            gyro: T::lit(7e-4),
            gyro_walk: T::lit(2e-5),
            accelerometer_walk: T::lit(3e-4),
            position: [T::lit(0.012), T::lit(0.019)],
            velocity: [T::lit(0.03), T::lit(0.05)],
            heading: T::lit(0.5),
            barometer: T::lit(3.0),
            barometer_time: T::lit(2.0),
            start_tilt: T::lit(0.02),
            start_heading: T::lit(0.1),
            start_gyro: T::lit(0.005),
            start_accelerometer: T::lit(0.03),
        }
    }
}

impl<T: Real> NavigationNoise<T> {
    /// Every deviation times `factor`; times stay.
    #[must_use]
    pub fn times(self, factor: T) -> Self {
        Self {
            accelerometer: self.accelerometer * factor,
            gyro: self.gyro * factor,
            gyro_walk: self.gyro_walk * factor,
            accelerometer_walk: self.accelerometer_walk * factor,
            position: self.position.map(|deviation| deviation * factor),
            velocity: self.velocity.map(|deviation| deviation * factor),
            heading: self.heading * factor,
            barometer: self.barometer * factor,
            start_tilt: self.start_tilt * factor,
            start_heading: self.start_heading * factor,
            start_gyro: self.start_gyro * factor,
            start_accelerometer: self.start_accelerometer * factor,
            ..self
        }
    }

    fn check(&self) -> Result<(), OutOfRange<T>> {
        OutOfRange::check("noise.accelerometer", self.accelerometer, 1e-4, 1.0)?;
        OutOfRange::check("noise.gyro", self.gyro, 1e-6, 0.1)?;
        OutOfRange::check("noise.gyro_walk", self.gyro_walk, 1e-8, 0.01)?;
        OutOfRange::check("noise.accelerometer_walk", self.accelerometer_walk, 1e-7, 0.1)?;
        for (field, deviations, most) in
            [("noise.position", self.position, 100.0), ("noise.velocity", self.velocity, 10.0)]
        {
            deviations.into_iter().try_for_each(|deviation| OutOfRange::check(field, deviation, 1e-3, most))?;
        }
        OutOfRange::check("noise.heading", self.heading, 1e-3, 3.0)?;
        OutOfRange::check("noise.barometer", self.barometer, 0.01, 100.0)?;
        OutOfRange::check("noise.barometer_time", self.barometer_time, 1.0, 1e4)?;
        OutOfRange::check("noise.start_tilt", self.start_tilt, 1e-3, 3.0)?;
        OutOfRange::check("noise.start_heading", self.start_heading, 1e-3, 3.0)?;
        OutOfRange::check("noise.start_gyro", self.start_gyro, 1e-5, 1.0)?;
        OutOfRange::check("noise.start_accelerometer", self.start_accelerometer, 1e-4, 10.0)
    }
}

impl<T: Real> NavigationParams<T> {
    /// Steps of `period` s, all sensors at the centre of mass.
    pub fn every(period: T) -> Self {
        Self {
            period,
            gravity: T::lit(9.81),
            imu: Vector3::zeros(),
            antenna: Vector3::zeros(),
            declination: T::zero(),
            noise: NavigationNoise::default(),
        }
    }

    pub(super) fn check(&self) -> Result<(), OutOfRange<T>> {
        OutOfRange::check("period", self.period, 1e-3, 0.01)?;
        OutOfRange::check("gravity", self.gravity, 0.1, 30.0)?;
        within("imu", &self.imu)?;
        within("antenna", &self.antenna)?;
        OutOfRange::check("declination", self.declination, -3.15, 3.15)?;
        self.noise.check()
    }
}
