//! Random numbers whose values are the same on every machine and in every order of flights.
//!
//! Each purpose of each flight has a ChaCha stream of its own, so a gust does not depend on whether
//! a sensor is noisy. Logarithms come from libm, whose last bit does not depend on the platform.

use controller::Vector3;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

/// What a stream is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u64)]
pub enum Purpose {
    /// Drawing a flight's start and parameters.
    Draw = 1,
    /// Gusts.
    Gust = 2,
    /// Sensors.
    Sensor = 3,
    /// The control loop's timing.
    Timing = 4,
    /// Inertial measurement unit.
    Imu = 5,
    /// Satellite receiver.
    Gnss = 6,
    /// Barometer.
    Barometer = 7,
    /// Magnetometer.
    Magnetometer = 8,
    /// Rotor speeds.
    Esc = 9,
    /// Motion capture.
    Mocap = 10,
    /// What an estimator is told at its start.
    Told = 11,
}

/// A seeded stream of random numbers.
#[derive(Clone, Debug)]
pub struct Stream {
    source: ChaCha8Rng,
    /// The second of the last pair of normal numbers.
    spare: Option<f64>,
}

impl Stream {
    /// The stream of one `purpose` in flight `run` of the batch with this `seed`.
    #[must_use]
    pub fn new(seed: u64, run: u64, purpose: Purpose) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&run.to_le_bytes());
        let mut source = ChaCha8Rng::from_seed(key);
        source.set_stream(purpose as u64);
        Self { source, spare: None }
    }

    /// Uniform in [0, 1), in steps of 2⁻⁵³.
    pub fn unit(&mut self) -> f64 {
        (self.source.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// Uniform in [`low`, `high`).
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Each component uniform in ±`half`.
    pub fn cube(&mut self, half: f64) -> Vector3<f64> {
        let [x, y, z] = [(); 3].map(|()| self.uniform(-half, half));
        Vector3::new(x, y, z)
    }

    /// Uniform in the unit ball, by rejection.
    pub fn ball(&mut self) -> Vector3<f64> {
        loop {
            let point = self.cube(1.0);
            if point.dot(&point) <= 1.0 {
                return point;
            }
        }
    }

    /// Standard normal, by Marsaglia's polar method.
    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        loop {
            let (x, y) = (self.uniform(-1.0, 1.0), self.uniform(-1.0, 1.0));
            let s = x * x + y * y;
            if s < 1.0 && s > 0.0 {
                let scale = (-2.0 * libm::log(s) / s).sqrt();
                self.spare = Some(y * scale);
                return x * scale;
            }
        }
    }

    /// Three independent standard normals.
    pub fn normals(&mut self) -> Vector3<f64> {
        let [x, y, z] = [(); 3].map(|()| self.normal());
        Vector3::new(x, y, z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_have_the_moments_of_the_normal_distribution() {
        let mut stream = Stream::new(7, 0, Purpose::Sensor);
        let count = 200_000;
        let (mut sums, mut beyond) = ([0.0; 4], 0);
        for _ in 0..count {
            let x = stream.normal();
            for (sum, power) in sums.iter_mut().zip(1..) {
                *sum += x.powi(power) / f64::from(count);
            }
            beyond += i32::from(x.abs() > 2.0);
        }
        let [mean, square, cube, fourth] = sums;
        // Five standard errors: √(1, 2, 15, 96)/√count, and of a share of 4.55 %.
        assert!(mean.abs() < 0.0112 && (square - 1.0).abs() < 0.0159, "{mean} {square}");
        assert!(cube.abs() < 0.0434 && (fourth - 3.0).abs() < 0.11, "{cube} {fourth}");
        let share = f64::from(beyond) / f64::from(count);
        assert!((share - 0.0455).abs() < 0.0024, "{share}");
    }

    #[test]
    fn streams_of_runs_and_purposes_differ_and_repeat() {
        let first = |seed, run, purpose| Stream::new(seed, run, purpose).unit();
        let values = [
            first(1, 1, Purpose::Gust),
            first(1, 1, Purpose::Sensor),
            first(1, 2, Purpose::Gust),
            first(2, 1, Purpose::Gust),
        ];
        for (i, a) in values.iter().enumerate() {
            assert!(values[..i].iter().all(|b| a != b), "{values:?}");
        }
        assert_eq!(values[0], first(1, 1, Purpose::Gust));
    }
}
