//! Random numbers whose values are the same on every machine and in every order of flights.
//!
//! Each purpose of each flight has a stream of its own, so a gust does not depend on whether a
//! sensor is noisy: xoshiro256++ from a start that ChaCha draws. Logarithms come from libm, whose
//! last bit does not depend on the platform.

use std::sync::LazyLock;

use controller::Vector3;
use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

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
    /// Directions of a search for failures.
    Hunt = 12,
}

/// A seeded stream of random numbers.
#[derive(Clone, Debug)]
pub struct Stream {
    source: Xoshiro256PlusPlus,
    layers: &'static Ziggurat,
}

impl Stream {
    /// The stream of one `purpose` in flight `run` of the batch with this `seed`.
    #[must_use]
    pub fn new(seed: u64, run: u64, purpose: Purpose) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        key[8..16].copy_from_slice(&run.to_le_bytes());
        let mut start = ChaCha8Rng::from_seed(key);
        start.set_stream(purpose as u64);
        Self { source: Xoshiro256PlusPlus::from_rng(&mut start), layers: Ziggurat::shared() }
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

    /// Standard normal.
    pub fn normal(&mut self) -> f64 {
        let (layer, x, is_beyond) = self.layers.place(self.source.next_u64());
        if is_beyond { self.beside(layer, x) } else { x }
    }

    /// `N` independent standard normals: the same as one by one.
    #[inline]
    pub fn normals_of<const N: usize>(&mut self) -> [f64; N] {
        let mut all = [[0.0; N]];
        self.fill(&mut all);
        let [all] = all;
        all
    }

    /// Fills `all` with independent standard normals: the same as one by one.
    #[inline]
    pub fn fill<const N: usize>(&mut self, all: &mut [[f64; N]]) {
        // Mostly all lie below the layers above: the source then stays in registers.
        let mut source = self.source.clone();
        for some in all {
            for normal in some {
                let (layer, x, is_beyond) = self.layers.place(source.next_u64());
                *normal = x;
                if is_beyond {
                    self.source = source;
                    *normal = self.beside(layer, x);
                    source = self.source.clone();
                }
            }
        }
        self.source = source;
    }

    /// What becomes of an `x` in its layer, but not below the layer above: one of 80.
    #[cold]
    #[inline(never)]
    fn beside(&mut self, layer: usize, x: f64) -> f64 {
        if layer == 0 {
            return self.tail().copysign(x);
        }
        let Ziggurat { density, .. } = self.layers;
        let height = density[layer] + self.unit() * (density[layer + 1] - density[layer]);
        if height < bell(x) { x } else { self.normal() }
    }

    /// A normal number beyond [`TAIL`], by Marsaglia's method.
    fn tail(&mut self) -> f64 {
        loop {
            let beyond = -libm::log(1.0 - self.unit()) / TAIL;
            if -2.0 * libm::log(1.0 - self.unit()) >= beyond * beyond {
                return TAIL + beyond;
            }
        }
    }

    /// Three independent standard normals.
    #[inline]
    pub fn normals(&mut self) -> Vector3<f64> {
        let [x, y, z] = self.normals_of();
        Vector3::new(x, y, z)
    }
}

/// e^(−x²/2).
fn bell(x: f64) -> f64 {
    libm::exp(-0.5 * x * x)
}

/// Layers of equal area under e^(−x²/2), x > 0.
const LAYERS: usize = 256;
/// Where the tail begins, which is part of the lowest layer.
const TAIL: f64 = 3.654_152_885_361_009;

/// Marsaglia's and Tsang's ziggurat (Journal of Statistical Software 5(8), 2000): `LAYERS` of equal
/// area. It is of our own because a crate's takes logarithms from the platform.
#[derive(Debug)]
struct Ziggurat {
    /// Half width of each layer, and 0 above the last.
    width: [f64; LAYERS + 1],
    /// The same in steps of 2⁻⁵².
    step: [f64; LAYERS + 1],
    /// e^(−x²/2) at each width.
    density: [f64; LAYERS + 1],
}

impl Ziggurat {
    /// The layer from the lowest bits, the place in it from the 53 highest, and whether that is
    /// not below the layer above.
    #[inline]
    fn place(&self, bits: u64) -> (usize, f64, bool) {
        let layer = (bits & 0xff) as usize;
        let x = (bits.cast_signed() >> 11) as f64 * self.step[layer];
        (layer, x, x.abs() >= self.width[layer + 1])
    }

    fn shared() -> &'static Self {
        static SHARED: LazyLock<Ziggurat> = LazyLock::new(Ziggurat::new);
        &SHARED
    }

    fn new() -> Self {
        // The rectangle below the tail's start, and the tail.
        let area = TAIL * bell(TAIL) + (0.5 * std::f64::consts::PI).sqrt() * libm::erfc(TAIL * 0.5_f64.sqrt());
        let mut width = [0.0; LAYERS + 1];
        // As wide as if the lowest layer were a rectangle: what is beyond the tail's start is tail.
        width[0] = area / bell(TAIL);
        width[1] = TAIL;
        for layer in 2..LAYERS {
            let below = width[layer - 1];
            width[layer] = (-2.0 * libm::log(bell(below) + area / below)).sqrt();
        }
        Self { width, step: width.map(|width| width / (1_u64 << 52) as f64), density: width.map(bell) }
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

    /// Shares beyond limits in the layers, at the tail's start and in the tail, on either side.
    #[test]
    fn normals_are_as_frequent_as_the_error_function_says() {
        let mut stream = Stream::new(8, 0, Purpose::Sensor);
        let count = 2_000_000;
        let limits = [0.0, 0.1, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, TAIL, 4.0];
        let mut beyond = [[0.0; 2]; 11];
        for _ in 0..count {
            let x = stream.normal();
            for (counts, limit) in beyond.iter_mut().zip(limits) {
                counts[usize::from(x < 0.0)] += f64::from(u8::from(x.abs() > limit));
            }
        }
        for (counts, limit) in beyond.into_iter().zip(limits) {
            let share = 0.5 * libm::erfc(limit * 0.5_f64.sqrt());
            let expected = share * f64::from(count);
            // Five standard errors of a count.
            let bound = 5.0 * (expected * (1.0 - share)).sqrt();
            assert!(counts.iter().all(|count| (count - expected).abs() < bound), "{limit}: {counts:?}, {expected}");
        }
    }

    #[test]
    fn layers_have_one_area() {
        let Ziggurat { width, density, .. } = Ziggurat::new();
        let area = width[1] * (density[2] - density[1]);
        for layer in 1..LAYERS {
            let this = width[layer] * (density[layer + 1] - density[layer]);
            // The tail's start has sixteen digits, and each layer hands on its rounding.
            assert!((this / area - 1.0).abs() < 1e-9, "{layer}: {this} {area}");
        }
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
