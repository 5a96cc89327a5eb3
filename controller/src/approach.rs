//! Joining a path from afar: the path starts where the payload is, and slides home.
//!
//! At engagement the payload, at velocity V, is at p₀ + D, p₀ a point of the curve. The law then follows the curve displaced by
//!
//! ```text
//! S((t − T_b)/T) (D + V T_b/2) + V E(t),   E˙ = S(t/T_b),   E(T_b) = 0
//! S(x) = 1 − I_x(7, 7),   S′ = −12012 x⁶ (1 − x)⁶      (I the regularized incomplete beta function)
//! ```
//!
//! which starts where the payload is and as fast as it is, brakes within T_b and then slides home within T. S falls from 1 to 0 with six derivatives zero
//! at either end, so the displacement asks for no step in thrust or torque. Speed along the curve, from rest, and yaw, from where it is,
//! go to the path's along with the slide. T_b and T are the shortest times for which brake and slide, each, keep the limits on acceleration, tilt, rod angle and
//! thrust, and the slide the one on speed. The displacement is rigid, so this works for any path, in metres, and meets no singularity of the curve's
//! functions on the way.

use nalgebra::Vector3;

use crate::analytic::Analytic;
use crate::error::OutOfRange;
use crate::lift::PositionSeries;
use crate::path::{Outputs, Path};
use crate::scalar::Real;
use crate::series::Series;
use crate::state::State;
use crate::vehicle::Vehicle;
use crate::yaw::Yaw;

/// max |S′|, |S″|, |S‴| and |S⁗| of the profile over x ∈ [0, 1].
const PEAKS: [f64; 4] = [2.932_617_187_5, 13.176_705_784, 140.765_625, 1_341.111_326];

/// The speed and the yaw need time even where the distance needs none, s.
const SHORTEST: f64 = 3.0;

/// What an approach may ask of the vehicle, on top of the path itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ApproachLimits<T> {
    /// Speed of the slide, m/s.
    pub speed: T,
    /// Acceleration of the slide, m/s².
    pub acceleration: T,
    /// Tilt of the thrust, rad, up to 1.2.
    pub tilt: T,
    /// Angle of the rod from the vertical, rad, up to 1.2.
    pub rod_angle: T,
    /// Least total thrust, N, below the hover thrust.
    pub min_thrust: T,
    /// Largest total thrust, N, above the hover thrust.
    pub max_thrust: T,
}

impl<T: Real> ApproachLimits<T> {
    /// 3 m/s, 1.5 m/s², 20° of tilt and rod angle, thrust within ±30 % of hover.
    pub fn gentle(vehicle: &Vehicle<T>) -> Self {
        let hover = vehicle.hover_thrust();
        Self {
            speed: T::lit(3.0),
            acceleration: T::lit(1.5),
            tilt: T::lit(0.35),
            rod_angle: T::lit(0.35),
            min_thrust: hover * T::lit(0.7),
            max_thrust: hover * T::lit(1.3),
        }
    }

    /// The limits as the payload's derivatives have them; an error names the limit that is out of range.
    ///
    /// An acceleration a of the payload needs a rod angle of atan(a/(g − a)) at most, and a tilt of as much with a + (m_Q/M)(L/g) p⁗ for a:
    /// half of the tilt is for either.
    pub fn pace(&self, vehicle: &Vehicle<T>) -> Result<Pace<T>, OutOfRange<T>> {
        let hover = vehicle.hover_thrust();
        OutOfRange::check("speed", self.speed, 0.01, 100.0)?;
        OutOfRange::check("acceleration", self.acceleration, 0.01, 100.0)?;
        OutOfRange::check("tilt", self.tilt, 0.01, 1.2)?;
        OutOfRange::check("rod_angle", self.rod_angle, 0.01, 1.2)?;
        OutOfRange::within("min_thrust", self.min_thrust, T::zero(), hover * T::lit(0.999))?;
        OutOfRange::within("max_thrust", self.max_thrust, hover * T::lit(1.001), T::lit(1e6))?;

        let params = vehicle.params();
        let gravity = params.gravity;
        let per_mass = vehicle.per_total_mass;
        let leaning = |angle: T| {
            let (sin, cos) = angle.sin_cos();
            gravity * sin / (sin + cos)
        };
        let tilting = leaning(self.tilt) * T::lit(0.5);
        let acceleration = self
            .acceleration
            .min(leaning(self.rod_angle))
            .min(tilting)
            .min(self.max_thrust * per_mass - gravity)
            .min(gravity - self.min_thrust * per_mass);
        let swing = params.uav_mass * per_mass * params.rod_length / gravity;
        Ok(Pace { speed: self.speed, acceleration, snap: tilting / swing })
    }
}

/// How fast the payload may be moved by an approach: [`ApproachLimits::pace`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace<T> {
    /// m/s.
    speed: T,
    /// m/s².
    acceleration: T,
    /// m/s⁴.
    snap: T,
}

impl<T: Real> Pace<T> {
    /// The shortest time, s, to brake from `speed`.
    fn braking(&self, speed: T) -> T {
        let [peak_1, _, peak_3, _] = PEAKS.map(T::lit);
        (peak_1 * speed / self.acceleration).max(cube_root(peak_3 * speed / self.snap))
    }

    /// The shortest time, s, to slide over `distance`.
    fn sliding(&self, distance: T) -> T {
        let [peak_1, peak_2, _, peak_4] = PEAKS.map(T::lit);
        (peak_1 * distance / self.speed)
            .max((peak_2 * distance / self.acceleration).sqrt())
            .max((peak_4 * distance / self.snap).sqrt().sqrt())
    }
}

/// x^(1/3), or 1 for less: Newton's steps from 1 + √x come down to it from above, by a third each at first, until rounding ends the descent: fewer than
/// 50 of them for any f32, once an approach.
fn cube_root<T: Real>(x: T) -> T {
    let third = T::lit(1.0 / 3.0);
    let x = x.max(T::one());
    let mut root = T::one() + x.sqrt();
    loop {
        let next = root - (root - x / (root * root)) * third;
        if next < root {
            root = next;
        } else {
            return root;
        }
    }
}

/// A slide under way, or none.
#[derive(Clone, Copy, Debug)]
pub struct Approach<T> {
    /// D + V T_b/2, m.
    displacement: Vector3<T>,
    /// V, m/s.
    velocity: Vector3<T>,
    /// (∇h1 × ∇h2)·ρ at p₀.
    path_det: T,
    /// v_d − 0 and ψ − ψ_d at engagement.
    speed: T,
    yaw: T,
    elapsed: T,
    /// T_b and T, s.
    braking: T,
    sliding: T,
}

impl<T: Real> Approach<T> {
    /// None: the path itself.
    pub fn none() -> Self {
        let zero = T::zero();
        Self {
            displacement: Vector3::zeros(),
            velocity: Vector3::zeros(),
            path_det: T::one(),
            speed: zero,
            yaw: zero,
            elapsed: zero,
            braking: zero,
            sliding: zero,
        }
    }

    /// None, at `position`: the path searches it, and its determinant there is what others are compared with.
    pub(crate) fn at<P: Path<T> + ?Sized>(path: &mut P, position: &Vector3<T>) -> Self {
        path.engage(position);
        let outputs = at_rest(path, position);
        Self { path_det: determinant(&outputs), ..Self::none() }
    }

    /// From `state`. `None` if no point of the path is found: the search is Newton's on h1 = h2 = 0 with steps of least length, at most 50
    /// of them.
    pub(crate) fn start<P: Path<T> + ?Sized>(path: &mut P, pace: &Pace<T>, state: &State<T>) -> Option<Self> {
        let State { position, velocity, .. } = state;
        path.engage(position);
        let nearest = nearest_point(path, position)?;
        path.engage(&nearest);
        let outputs = at_rest(path, &nearest);
        let shortest = T::lit(SHORTEST);
        let braking = pace.braking(length(velocity)).max(shortest);
        let displacement = position - nearest + velocity * (braking * T::lit(0.5));
        let sliding = pace.sliding(length(&displacement)).max(shortest);
        Some(Self {
            displacement,
            velocity: *velocity,
            path_det: determinant(&outputs),
            speed: outputs.speed_error.value(),
            yaw: (Yaw::of(state).angle - outputs.yaw.value()).wrap_angle(),
            elapsed: T::zero(),
            sliding,
            braking,
        })
    }

    fn duration(&self) -> T {
        self.braking + self.sliding
    }

    /// Whether the path is still displaced.
    pub fn is_active(&self) -> bool {
        self.elapsed < self.duration()
    }

    /// The determinant (∇h1 × ∇h2)·ρ of the path's 3×3 system at the point that was joined; 1 if none was.
    pub fn path_det(&self) -> T {
        self.path_det
    }

    /// Time left, s.
    pub fn remaining(&self) -> T {
        (self.duration() - self.elapsed).max(T::zero())
    }

    /// One control period on.
    #[inline]
    pub(crate) fn advance(&mut self, period: T) {
        if self.is_active() {
            self.elapsed += period;
        }
    }

    /// S of the slide and E of the brake, about `elapsed` s.
    #[inline]
    fn profiles(&self, elapsed: T) -> (Series<T, 7>, Series<T, 7>) {
        let (slide, _) = profile(elapsed - self.braking, self.sliding);
        let (brake, area) = profile(elapsed, self.braking);
        // E: its derivative is the brake's S.
        let Series([b0, b1, b2, b3, b4, b5, _]) = brake;
        let [c2, c3, c4, c5, c6] = [2.0, 3.0, 4.0, 5.0, 6.0].map(|n| T::lit(1.0 / n));
        (slide, Series([-area, b0, b1 * c2, b2 * c3, b3 * c4, b4 * c5, b5 * c6]))
    }

    /// `path` as displaced `ahead` s from now.
    #[inline]
    pub(crate) fn displace<'a, P: ?Sized>(&'a self, path: &'a mut P, ahead: T) -> Displaced<'a, T, P> {
        Displaced { path, approach: self, elapsed: self.elapsed + ahead }
    }
}

/// S(t/`duration`) about t = `elapsed` as a series in time, and ∫S from t to `duration`. S is 1 before and 0 after.
#[inline]
fn profile<T: Real>(elapsed: T, duration: T) -> (Series<T, 7>, T) {
    let zero = T::zero();
    let half = T::lit(0.5);
    let rate = T::one() / duration;
    let x = (elapsed * rate).clamp(T::zero(), T::one());
    let y = T::one() - x;
    let xy = x * y;
    // The slope by the power of a quadratic, the value by the finite sum of I_y(7, 7) = y⁷ Σ_{j<7} C(6 + j, j) xʲ.
    let quadratic = Series([xy, (y - x) * rate, -(rate * rate), zero, zero, zero]);
    let sixth = (quadratic.square() * quadratic).square();
    let Series([s0, s1, s2, s3, s4, s5]) = sixth * (T::lit(-12012.0) * rate);
    let sum = [924.0, 462.0, 210.0, 84.0, 28.0, 7.0, 1.0].iter().fold(zero, |sum, &c| sum * x + T::lit(c));
    let y2 = y * y;
    let value = y2 * y2 * y2 * y * sum;
    let area = ((y - half) * value + T::lit(858.0) * sixth.value() * xy) * duration;
    let [c2, c3, c4, c5, c6] = [2.0, 3.0, 4.0, 5.0, 6.0].map(|n| T::lit(1.0 / n));
    (Series([value, s0, s1 * c2, s2 * c3, s3 * c4, s4 * c5, s5 * c6]), area)
}

#[inline]
fn length<T: Real>(v: &Vector3<T>) -> T {
    v.dot(v).sqrt()
}

/// A path displaced by a slide.
pub(crate) struct Displaced<'a, T, P: ?Sized> {
    path: &'a mut P,
    approach: &'a Approach<T>,
    elapsed: T,
}

impl<T: Real, P: Path<T> + ?Sized> Path<T> for Displaced<'_, T, P> {
    #[inline(always)]
    fn outputs(&mut self, position: &PositionSeries<T>) -> Outputs<T> {
        let Approach { displacement, velocity, speed, yaw, braking, sliding, .. } = self.approach;
        let under_way = self.elapsed < *braking + *sliding;
        let mut home = *position;
        let mut fading = Series::constant(T::zero());
        if under_way {
            let (slide, brake) = self.approach.profiles(self.elapsed);
            for ((coordinate, &d), &v) in home.iter_mut().zip(displacement).zip(velocity) {
                *coordinate = *coordinate - slide * d - brake * v;
            }
            fading = slide;
        }
        let mut outputs = self.path.outputs(&home);
        if under_way {
            outputs.speed_error = outputs.speed_error - fading.truncate() * *speed;
            outputs.yaw += fading.truncate() * *yaw;
        }
        outputs
    }
}

/// The outputs for a payload at rest. Apart from the law's own evaluation, which is inlined into the step.
#[inline(never)]
fn at_rest<T: Real, P: Path<T> + ?Sized>(path: &mut P, point: &Vector3<T>) -> Outputs<T> {
    path.outputs(&[point.x, point.y, point.z].map(Series::constant))
}

/// (∇h1 × ∇h2)·ρ.
fn determinant<T: Real>(outputs: &Outputs<T>) -> T {
    let [g1, g2] = &outputs.gradients;
    g1.cross(g2).dot(&outputs.tangent)
}

/// A point of the path near `position`.
fn nearest_point<T: Real, P: Path<T> + ?Sized>(path: &mut P, position: &Vector3<T>) -> Option<Vector3<T>> {
    const STEPS: usize = 50;
    // A step longer than this is cut: far from the curve its functions may be strongly curved.
    let longest = T::lit(5.0);
    // On the curve to within what f32 resolves at a hundred metres.
    let close = T::lit(1e-4);
    let mut point = *position;
    for taken in 0..STEPS {
        let outputs = at_rest(path, &point);
        let [h1, h2] = outputs.surfaces.map(|h| h.value());
        let [g1, g2] = &outputs.gradients;
        let (a, b, c) = (g1.dot(g1), g1.dot(g2), g2.dot(g2));
        let determinant = a * c - b * b;
        let mut step = (g1 * (c * h1 - b * h2) + g2 * (a * h2 - b * h1)) / determinant;
        let length = step.dot(&step).sqrt();
        if !length.is_finite() {
            if taken > 0 {
                return None;
            }
            // Where the functions are stationary, as at a circle's centre, any direction is as good as another.
            point += Vector3::repeat(T::lit(0.1));
            continue;
        }
        if length > longest {
            step *= longest / length;
        }
        point -= step;
        if length < close {
            return Some(point);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vehicle::VehicleParams;

    #[test]
    fn profile_falls_from_one_to_zero_with_six_flat_derivatives() {
        for (elapsed, value) in [(0.0, 1.0), (2.0, 0.5), (4.0, 0.0), (5.0, 0.0)] {
            let (profile, area) = profile(elapsed, 4.0_f64);
            assert!((profile.value() - value).abs() < 1e-12, "{elapsed}");
            assert!(elapsed > 0.0 || (area - 2.0).abs() < 1e-12, "{area}");
            assert!(elapsed < 4.0 || area == 0.0, "{area}");
        }
        for elapsed in [0.0, 4.0, 5.0] {
            for k in 1..=6 {
                assert!(profile(elapsed, 4.0_f64).0.derivative(k).abs() < 1e-12, "{elapsed} {k}");
            }
        }
    }

    #[test]
    fn profile_series_predicts_the_profile_and_its_integral() {
        for i in 1..40 {
            let (elapsed, dt) = (0.1 * f64::from(i), 0.01);
            let (now, area) = profile(elapsed, 4.0_f64);
            let (then, area_then) = profile(elapsed + dt, 4.0);
            // The seventh term: |S⁽⁷⁾| ≤ 7.9e6/T⁷, over 7!.
            let bound = 7.9e6 / 4.0_f64.powi(7) * dt.powi(7) / 5040.0 + 1e-14;
            assert!((now.shift(dt).value() - then.value()).abs() <= bound, "{elapsed}");
            let integral: f64 = now.0.iter().zip(1..).map(|(c, k)| c * dt.powi(k) / f64::from(k)).sum();
            assert!((area - area_then - integral).abs() <= bound * dt + 1e-14, "{elapsed}");
        }
    }

    #[test]
    fn peaks_are_the_profile_s() {
        let mut found = [0.0_f64; 4];
        for i in 0..=100_000 {
            let (profile, _) = profile(f64::from(i) * 1e-5, 1.0);
            for (found, k) in found.iter_mut().zip(1..) {
                *found = found.max(profile.derivative(k).abs());
            }
        }
        for (found, stated) in found.iter().zip(PEAKS) {
            assert!((found / stated - 1.0).abs() < 1e-6, "{found} against {stated}");
        }
    }

    #[test]
    fn cube_roots_are_reached_from_above() {
        for x in [0.0, 0.5, 1.0, 27.0, 55.0, 1e3, 1e6, 1e30] {
            let (root, exact): (f64, f64) = (cube_root(x), libm::cbrt(x.max(1.0)));
            assert!((root / exact - 1.0).abs() < 1e-15, "{x}: {root}");
        }
    }

    #[test]
    fn durations_keep_speed_and_acceleration() {
        let vehicle = Vehicle::new(VehicleParams::<f64>::default()).unwrap();
        let limits = ApproachLimits::gentle(&vehicle);
        let pace = limits.pace(&vehicle).unwrap();
        for size in [0.1, 1.0, 20.0, 50.0] {
            let sliding = pace.sliding(size);
            let braking = pace.braking(size);
            let slack = 1.0 + 1e-12;
            assert!(PEAKS[0] * size / sliding <= limits.speed * slack);
            assert!(PEAKS[1] * size / sliding.powi(2) <= limits.acceleration * slack);
            assert!(PEAKS[0] * size / braking <= limits.acceleration * slack);
        }
    }
}
