//! Turbulence of the Dryden form, MIL-F-8785C (1980), 3.7.2 and 3.7.3.2, at low altitude (below 300
//! m).
//!
//! At height h and with the mean wind W at 6 m, in feet as there,
//!
//! ```text
//! σ_w = 0.1 W,   σ_u = σ_v = σ_w/(0.177 + 0.000823 h)^0.4
//! L_w = h,       L_u = L_v = h/(0.177 + 0.000823 h)^1.2
//! H_u = σ_u √(2 T_u) 1/(1 + T_u s),   H_{v,w} = σ √T (1 + √3 T s)/(1 + T s)²,   T = L/V
//! ```
//!
//! from white noise of unit intensity; u along the mean wind, w vertical, v across. Air frozen but
//! for its transport passes the vehicle at V, the mean wind relative to it; V is taken constant,
//! and no less than 1 m/s. Both bodies, some metres apart, meet the same gust: the scales are tens
//! of metres.
//!
//! The filters are stepped by their exact transition, and start from their stationary distribution.
//! H_{v,w} is √3 x₁ + (1 − √3) x₂ with x₁ = 1/(1 + T s), x₂ = x₁/(1 + T s); with the
//! noise's intensity σ² T, x₁ and x₂ have the covariance σ² (½, ¼; ¼, ¼).

use controller::Vector3;
use serde::Deserialize;

use super::check;
use crate::describe::input::Invalid;
use crate::world::random::Stream;

/// Metres in a foot.
const FOOT: f64 = 0.3048;

/// Turbulence of a mean wind.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Gusts {
    /// W, mean wind speed 6 m (20 ft) above ground, m/s, 0 to 50: it sets the intensity.
    pub speed_at_6m: f64,
    /// h, m above ground, 3 (10 ft) to 300; 10 if left out.
    #[serde(default = "ten_metres")]
    pub height: f64,
}

fn ten_metres() -> f64 {
    10.0
}

impl Gusts {
    pub(super) fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "speed_at_6m", self.speed_at_6m, 0.0, 50.0)?;
        check(at, "height", self.height, 3.0, 300.0)
    }

    /// (σ_u, σ_w), m/s.
    #[must_use]
    pub fn intensities(&self) -> (f64, f64) {
        let vertical = 0.1 * self.speed_at_6m;
        (vertical / libm::pow(self.shape(), 0.4), vertical)
    }

    /// (L_u, L_w), m.
    #[must_use]
    pub fn lengths(&self) -> (f64, f64) {
        (self.height / libm::pow(self.shape(), 1.2), self.height)
    }

    fn shape(&self) -> f64 {
        0.177 + 0.000_823 * self.height / FOOT
    }
}

/// x₁, x₂ of one axis and their exact transition over a period.
#[derive(Clone, Copy, Debug)]
struct Axis {
    x: [f64; 2],
    /// e^(−h/T) and h/T.
    decay: f64,
    ratio: f64,
    /// Cholesky factor of the transition's noise: rows (a, 0), (b, c).
    noise: [f64; 3],
    output: [f64; 2],
}

impl Axis {
    fn new(deviation: f64, time: f64, period: f64, output: [f64; 2], stream: &mut Stream) -> Self {
        let variance = deviation * deviation;
        let ratio = period / time;
        let decay = libm::exp(-ratio);
        // Q = P − Φ P Φᵀ with Φ = e^(−r) (1, 0; r, 1) and P = σ² (½, ¼; ¼, ¼).
        let kept = decay * decay;
        let q11 = variance * 0.5 * (1.0 - kept);
        let q12 = variance * (0.25 - kept * (0.25 + 0.5 * ratio));
        let q22 = variance * (0.25 - kept * (0.25 + 0.5 * ratio + 0.5 * ratio * ratio));
        let mut axis = Self { x: [0.0; 2], decay, ratio, noise: cholesky(q11, q12, q22), output };
        axis.x = drawn(&cholesky(0.5 * variance, 0.25 * variance, 0.25 * variance), stream.normals_of());
        axis
    }

    #[inline]
    fn step(&mut self, normals: [f64; 2]) -> f64 {
        let [n1, n2] = drawn(&self.noise, normals);
        let [x1, x2] = self.x;
        self.x = [self.decay * x1 + n1, self.decay * (x2 + self.ratio * x1) + n2];
        self.value()
    }

    fn value(&self) -> f64 {
        self.output[0] * self.x[0] + self.output[1] * self.x[1]
    }
}

/// What a covariance's lower factor makes of standard `normals`.
#[inline]
fn drawn([a, b, c]: &[f64; 3], [n1, n2]: [f64; 2]) -> [f64; 2] {
    [a * n1, b * n1 + c * n2]
}

/// The lower factor of a covariance; a variance that rounding made negative counts as zero.
fn cholesky(q11: f64, q12: f64, q22: f64) -> [f64; 3] {
    let a = q11.sqrt();
    if a == 0.0 {
        return [0.0; 3];
    }
    let b = q12 / a;
    [a, b, (q22 - b * b).max(0.0).sqrt()]
}

/// Gusts under way.
#[derive(Clone, Debug)]
pub struct Dryden {
    axes: [Axis; 3],
    /// Horizontal unit vector along the mean wind.
    along: [f64; 2],
    stream: Stream,
}

impl Dryden {
    /// Turbulence of `wind` (mean, m/s in N), stepped every `period` s.
    #[must_use]
    pub fn new(gusts: &Gusts, wind: &Vector3<f64>, period: f64, mut stream: Stream) -> Self {
        let speed = (wind.x * wind.x + wind.y * wind.y).sqrt();
        let along = if speed > 0.0 { [wind.x / speed, wind.y / speed] } else { [1.0, 0.0] };
        let passing = speed.max(1.0);
        let ((sigma_u, sigma_w), (length_u, length_w)) = (gusts.intensities(), gusts.lengths());
        let root_3 = 3.0_f64.sqrt();
        // x₁ has the variance σ²/2.
        let first_order = [2.0_f64.sqrt(), 0.0];
        let second_order = [root_3, 1.0 - root_3];
        let axes = [
            Axis::new(sigma_u, length_u / passing, period, first_order, &mut stream),
            Axis::new(sigma_u, length_u / passing, period, second_order, &mut stream),
            Axis::new(sigma_w, length_w / passing, period, second_order, &mut stream),
        ];
        Self { axes, along, stream }
    }

    /// The gust over the coming period, m/s in N.
    pub fn step(&mut self) -> Vector3<f64> {
        let [u1, u2, v1, v2, w1, w2] = self.stream.normals_of();
        let [of_u, of_v, of_w] = &mut self.axes;
        let (u, v, w) = (of_u.step([u1, u2]), of_v.step([v1, v2]), of_w.step([w1, w2]));
        let [x, y] = self.along;
        Vector3::new(x * u - y * v, y * u + x * v, w)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::random::Purpose;

    const GUSTS: Gusts = Gusts { speed_at_6m: 5.0, height: 10.0 };

    fn dryden(run: u64, period: f64) -> Dryden {
        Dryden::new(&GUSTS, &Vector3::new(5.0, 0.0, 0.0), period, Stream::new(3, run, Purpose::Gust))
    }

    /// The standard's numbers, by hand: h = 32.81 ft gives 0.2040 in brackets.
    #[test]
    fn intensities_and_lengths_are_the_standards() {
        let ((sigma_u, sigma_w), (length_u, length_w)) = (GUSTS.intensities(), GUSTS.lengths());
        assert!((sigma_w - 0.5).abs() < 1e-12 && (sigma_u - 0.944).abs() < 1e-3, "{sigma_u} {sigma_w}");
        assert!((length_u - 67.4).abs() < 0.1 && length_w == 10.0, "{length_u} {length_w}");
    }

    /// Over many starts and after a while the variances are σ², whatever the step.
    #[test]
    fn gusts_are_stationary_with_the_intensities() {
        let (sigma_u, sigma_w) = GUSTS.intensities();
        let runs = 4000;
        for (period, steps) in [(0.002, 50), (0.5, 7)] {
            let mut squares = Vector3::zeros();
            for run in 0..runs {
                let mut gusts = dryden(run, period);
                let last = (0..steps).map(|_| gusts.step()).last().unwrap_or_default();
                squares += last.component_mul(&last) / runs as f64;
            }
            for (square, sigma) in squares.iter().zip([sigma_u, sigma_u, sigma_w]) {
                // Five standard errors of a variance from 4,000 values: 5 √(2/4000).
                assert!((square / (sigma * sigma) - 1.0).abs() < 0.112, "{square} {sigma} at {period}");
            }
        }
    }

    /// Correlation over a time t: e^(−t/T) along, e^(−t/T) (1 − t/2T) across, the Dryden form's.
    #[test]
    fn correlations_fall_as_the_form_says() {
        let (sigma_u, _) = GUSTS.intensities();
        let time = GUSTS.lengths().0 / 5.0;
        let (period, steps, runs) = (time / 20.0, 20, 20_000);
        let mut sums = [0.0; 2];
        for run in 0..runs {
            let mut gusts = dryden(run, period);
            let first = gusts.step();
            let last = (0..steps).map(|_| gusts.step()).last().unwrap_or_default();
            sums[0] += first.x * last.x / runs as f64;
            sums[1] += first.y * last.y / runs as f64;
        }
        let [along, across] = sums.map(|sum| sum / (sigma_u * sigma_u));
        let expected = (-1.0_f64).exp();
        // Five standard errors of a correlation from 20,000 pairs: about 5/√20000.
        assert!((along - expected).abs() < 0.036, "{along} against {expected}");
        assert!((across - 0.5 * expected).abs() < 0.036, "{across} against {}", 0.5 * expected);
    }
}
