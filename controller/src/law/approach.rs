//! Joining a path from afar: the path starts where the payload is, and slides home.
//!
//! When it is joined the payload, at velocity V, is at p₀ + D, p₀ a point of the curve. The law
//! then follows the curve displaced by
//!
//! ```text
//! S((t − T_b)/T) (D + V T_b/2) + V E(t),   E˙ = S(t/T_b),   E(T_b) = 0       (13.1)
//! S(x) = 1 − I_x(7, 7),   S′ = −12012 x⁶ (1 − x)⁶                             (13.2)
//! ```
//!
//! (I: the regularized incomplete beta function) which starts where the payload is and as fast as
//! it is, brakes within T_b and then slides home within T. S falls from 1 to 0 with six derivatives
//! zero at either end, so the displacement asks for no step in thrust or torque. Speed along the
//! curve, from rest, and yaw, from where it is, go to the path's along with the slide. T_b and T
//! are the shortest times for which brake and slide, each, keep the limits on acceleration, tilt,
//! rod angle and thrust, and the slide the one on speed; where it is the snap that limits a brake,
//! it takes somewhat longer. The displacement is rigid, so this works for any path, in metres, and
//! meets no singularity of the curve's functions on the way.

use model::{OutOfRange, Real, Series, State, Vehicle, Yaw};
use nalgebra::Vector3;

use crate::error::Refused;
use crate::path::PositionSeries;
use crate::path::{Outputs, Path};
use crate::ranges::{
    APPROACH_ACCELERATION, APPROACH_MAX_THRUST, APPROACH_MIN_THRUST, APPROACH_ROD_ANGLE, APPROACH_SPEED,
    APPROACH_TILT,
};

/// max |S′|, |S″|, |S‴| and |S⁗| of the profile over x ∈ [0, 1].
const PEAKS: [f64; 4] = [2.932_617_187_5, 13.176_705_784, 140.765_625, 1_341.111_326];

/// Shortest brake or slide, s: speed and yaw are blended in even where there is no distance to
/// cover.
const SHORTEST: f64 = 3.0;

/// What an approach may ask of the vehicle, on top of the path itself.
///
/// ```
/// use controller::{ApproachLimits, Vehicle, VehicleParams};
///
/// let hurried = ApproachLimits { speed: 5.0, acceleration: 2.5, ..ApproachLimits::gentle() };
/// assert!(hurried.pace(&Vehicle::new(VehicleParams::<f32>::paper())?).is_ok());
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ApproachLimits<T> {
    /// Speed of the slide, m/s.
    pub speed: T,
    /// Acceleration of the slide, m/s².
    pub acceleration: T,
    /// Tilt of the thrust, rad.
    pub tilt: T,
    /// Angle of the rod from the vertical, rad.
    pub rod_angle: T,
    /// Least total thrust, a share of the hover thrust, below 1.
    pub min_thrust: T,
    /// Largest total thrust, a share of the hover thrust, above 1.
    pub max_thrust: T,
}

impl<T: Real> ApproachLimits<T> {
    /// 3 m/s, 1.5 m/s², 20° of tilt and rod angle, thrust within ±30 % of hover.
    #[must_use]
    pub fn gentle() -> Self {
        Self {
            speed: APPROACH_SPEED.default(),
            acceleration: APPROACH_ACCELERATION.default(),
            tilt: APPROACH_TILT.default(),
            rod_angle: APPROACH_ROD_ANGLE.default(),
            min_thrust: APPROACH_MIN_THRUST.default(),
            max_thrust: APPROACH_MAX_THRUST.default(),
        }
    }

    /// The same in another scalar, rounded to nearest. Host-side use.
    pub fn cast<U: Real>(&self) -> ApproachLimits<U> {
        ApproachLimits {
            speed: self.speed.cast(),
            acceleration: self.acceleration.cast(),
            tilt: self.tilt.cast(),
            rod_angle: self.rod_angle.cast(),
            min_thrust: self.min_thrust.cast(),
            max_thrust: self.max_thrust.cast(),
        }
    }

    /// The limits as the payload's derivatives have them.
    ///
    /// An acceleration a of the payload needs a rod angle of atan(a/(g − a)) at most, and a tilt of
    /// as much with a + (m_Q/M)(L/g) p⁗ for a: half of the tilt is for either (13.6).
    ///
    /// # Errors
    /// The limit that is out of its [range](crate::ranges).
    pub fn pace(&self, vehicle: &Vehicle<T>) -> Result<Pace<T>, OutOfRange<T>> {
        APPROACH_SPEED.check(self.speed)?;
        APPROACH_ACCELERATION.check(self.acceleration)?;
        APPROACH_TILT.check(self.tilt)?;
        APPROACH_ROD_ANGLE.check(self.rod_angle)?;
        APPROACH_MIN_THRUST.check(self.min_thrust)?;
        APPROACH_MAX_THRUST.check(self.max_thrust)?;

        let params = vehicle.params();
        let gravity = params.gravity;
        let leaning = |angle: T| {
            let (sin, cos) = angle.sin_cos();
            gravity * sin / (sin + cos)
        };
        let tilting = leaning(self.tilt) * T::lit(0.5);
        let acceleration = self
            .acceleration
            .min(leaning(self.rod_angle))
            .min(tilting)
            .min((self.max_thrust - T::one()) * gravity)
            .min((T::one() - self.min_thrust) * gravity);
        let swing = params.uav_mass * vehicle.per_total_mass() * params.rod_length / gravity;
        let snap = tilting / swing;
        let [peak_1, peak_2, peak_3, peak_4] = PEAKS.map(T::lit);
        let squared = |x: T| x * x;
        Ok(Pace {
            brake: [squared(peak_1 / acceleration), squared(peak_3 / (snap * T::lit(SHORTEST))), T::zero()],
            slide: [squared(peak_1 / self.speed), squared(peak_2 / acceleration), squared(peak_4 / snap)],
        })
    }
}

/// How fast the payload may be moved by an approach: [`ApproachLimits::pace`].
///
/// The time T for a motion of size x (a speed to lose, a distance to go) has T² ≥ a x², T⁴ ≥ b
/// x² and T⁸ ≥ c x² (13.7).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace<T> {
    /// a, b, c of the brake: by acceleration, and by snap, of whose three factors T one is taken
    /// for [`SHORTEST`].
    brake: [T; 3],
    /// a, b, c of the slide: by speed, acceleration and snap.
    slide: [T; 3],
}

/// The time T, s, for a motion of size |`x`|, at least [`SHORTEST`].
#[inline(never)]
fn duration<T: Real>([a, b, c]: &[T; 3], x: &Vector3<T>) -> T {
    let squared = x.dot(x);
    let fourth = (*b * squared).max((*c * squared).sqrt());
    T::lit(SHORTEST * SHORTEST).max(*a * squared).max(fourth.sqrt()).sqrt()
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
    /// 0 − v_d and ψ_d − ψ when the path was joined.
    speed: T,
    yaw: T,
    elapsed: T,
    /// T_b and T, s.
    braking: T,
    sliding: T,
    is_active: bool,
}

impl<T: Real> Approach<T> {
    /// None: the path itself.
    #[must_use]
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
            is_active: false,
        }
    }

    /// None, at `position`: the path is searched for its nearest point, and later determinants are
    /// compared with the one there.
    pub(crate) fn at<P: Path<T> + ?Sized>(path: &mut P, position: &Vector3<T>) -> Self {
        while !path.search(position) {}
        Self { path_det: step_to(path, &at_rest(position)).2, ..Self::none() }
    }

    /// Begins at `state`, if the path has been searched and a point of it is found; v_d is flown
    /// times `factor`.
    pub(crate) fn join<P: Path<T> + ?Sized>(
        &mut self,
        path: &mut P,
        pace: &Pace<T>,
        state: &State<T>,
        factor: T,
    ) -> Result<(), Refused> {
        let State { position, velocity, .. } = state;
        if !path.search(position) {
            return Err(Refused::Searching);
        }
        let Nearest { point, outputs, path_det } = nearest(path, position).ok_or(Refused::NoPath)?;
        let yaw = (outputs.yaw.value() - Yaw::of(state).angle).wrap_angle();
        *self = Self {
            path_det,
            speed: outputs.speed_error.value() * factor,
            ..Self::over(pace, position - point, *velocity, yaw)
        };
        Ok(())
    }

    /// Begins `displacement` (m) away, moving at `velocity` (m/s) as seen from where it leads to,
    /// with `yaw` (rad) to turn.
    pub(crate) fn over(pace: &Pace<T>, displacement: Vector3<T>, velocity: Vector3<T>, yaw: T) -> Self {
        let braking = duration(&pace.brake, &velocity);
        let displacement = displacement + velocity * (braking * T::lit(0.5));
        let sliding = duration(&pace.slide, &displacement);
        Self { displacement, velocity, yaw, braking, sliding, is_active: true, ..Self::none() }
    }

    fn duration(&self) -> T {
        self.braking + self.sliding
    }

    /// Whether the path is still displaced.
    pub fn is_active(&self) -> bool {
        self.is_active
    }

    /// The determinant (∇h1 × ∇h2)·ρ of the path's 3×3 system at the point that was joined; 1 if
    /// none was.
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
        if self.is_active {
            self.elapsed += period;
            self.is_active = self.elapsed < self.duration();
        }
    }

    /// Takes the displacement of `ahead` s from now out of `position`, if there is one then, and
    /// returns what [`fade`](Self::fade) needs.
    #[inline(always)]
    pub(crate) fn leave(&self, ahead: T, position: &mut PositionSeries<T>) -> Option<Fading<T>> {
        if self.is_active { self.slide(self.elapsed + ahead, position) } else { None }
    }

    // Out of line: a step on the path does not need it.
    #[inline(never)]
    fn slide(&self, elapsed: T, position: &mut PositionSeries<T>) -> Option<Fading<T>> {
        if elapsed >= self.duration() {
            return None;
        }
        let is_braking = elapsed < self.braking;
        let (since, duration) =
            if is_braking { (elapsed, self.braking) } else { (elapsed - self.braking, self.sliding) };
        let (mut s, area) = profile(since, duration);
        if is_braking {
            let e: Series<T, 7> = s.truncate::<6>().integrate(-area);
            displace(position, &e, &self.velocity);
            // The slide has yet to begin, and its S is 1; once it has begun, E is 0.
            s = Series::constant(T::one());
        }
        displace(position, &s, &self.displacement);
        Some(Fading(s))
    }

    /// Brings speed and yaw to where they are while the displacement is.
    pub(crate) fn fade(&self, fading: &Fading<T>, outputs: &mut Outputs<T>) {
        outputs.speed_error.subtract(&fading.0, self.speed);
        self.fade_yaw(fading, &mut outputs.yaw);
    }

    /// Brings a yaw to where it is while the displacement is.
    pub(crate) fn fade_yaw(&self, fading: &Fading<T>, yaw: &mut Series<T, 3>) {
        yaw.subtract(&fading.0, self.yaw);
    }
}

/// Takes `series` times `along` away.
#[inline(never)]
fn displace<T: Real>(position: &mut PositionSeries<T>, series: &Series<T, 7>, along: &Vector3<T>) {
    for (coordinate, &along) in position.iter_mut().zip(along) {
        coordinate.subtract(series, along);
    }
}

/// S of the slide, from 1 to 0.
pub(crate) struct Fading<T>(Series<T, 7>);

/// S(t/`duration`) about t = `elapsed`, from 0 to `duration`, as a series in time, and ∫S from t to
/// `duration`.
#[inline(never)]
fn profile<T: Real>(elapsed: T, duration: T) -> (Series<T, 7>, T) {
    // The recurrence divides by x (1 − x). Near an end, where S and its derivatives hardly move, x
    // is taken a little inside.
    const END: f64 = 1e-6;
    let half = T::lit(0.5);
    let rate = T::one() / duration;
    let x = (elapsed * rate).clamp(T::lit(END), T::lit(1.0 - END));
    let y = T::one() - x;
    let xy = x * y;
    let cube = xy * xy * xy;
    let sixth = cube * cube;

    // The slope f = −12012 (x y)⁶ has x y f′ = 6 (x y)′ f; x y is a quadratic of time, so each
    // coefficient follows from the two before (13.3).
    let per_xy = T::one() / xy;
    let first = (y - x) * rate * per_xy;
    let second = -(rate * rate) * per_xy;
    let (mut before, mut last) = (T::zero(), sixth * (T::lit(-12012.0) * rate));
    let mut s = [last; 7];
    for (s, [by_first, by_second]) in s.iter_mut().skip(2).zip(RECURRENCE) {
        *s = T::lit(by_first) * first * last + T::lit(by_second) * second * before;
        (before, last) = (last, *s);
    }

    // The value by the finite sum of I_y(7, 7) = y⁷ Σ_{j<7} C(6 + j, j) xʲ.
    let sum = [924.0, 462.0, 210.0, 84.0, 28.0, 7.0, 1.0].iter().fold(T::zero(), |sum, &c| sum * x + T::lit(c));
    let y2 = y * y;
    let [value, ..] = &mut s;
    *value = y2 * y2 * y2 * y * sum;
    let area = ((y - half) * *value + T::lit(858.0) * sixth * xy) * duration;
    (Series(s), area)
}

/// (8 − k)/k and (15 − k) (k − 2)/(k (k − 1)), k from 2 to 6: the weights of the two preceding
/// coefficients in the k-th coefficient of S.
const RECURRENCE: [[f64; 2]; 5] =
    [[3.0, 0.0], [5.0 / 3.0, 2.0], [1.0, 11.0 / 6.0], [3.0 / 5.0, 3.0 / 2.0], [1.0 / 3.0, 6.0 / 5.0]];

/// A payload at rest at `point`.
fn at_rest<T: Real>(point: &Vector3<T>) -> PositionSeries<T> {
    [point.x, point.y, point.z].map(Series::constant)
}

/// A point of a path.
struct Nearest<T> {
    point: Vector3<T>,
    /// The outputs there, for a payload at rest.
    outputs: Outputs<T>,
    /// (∇h1 × ∇h2)·ρ.
    path_det: T,
}

/// Most steps of the search for a point of the path.
const SEARCH_STEPS: usize = 50;
/// A step longer than this, m, is cut: far from the curve its functions may be strongly curved.
const LONGEST_STEP: f64 = 5.0;
/// A point is on the curve when the last step was shorter than this, m: what f32 resolves at a
/// hundred metres.
const CLOSE: f64 = 1e-4;
/// The step, m, along each axis where the functions are stationary, as at a circle's centre: any
/// direction will do.
const ANY_STEP: f64 = 0.1;

/// A point of the path near `position`: Newton's search on h1 = h2 = 0, across the tangent.
fn nearest<T: Real, P: Path<T> + ?Sized>(path: &mut P, position: &Vector3<T>) -> Option<Nearest<T>> {
    let (longest, close) = (T::lit(LONGEST_STEP), T::lit(CLOSE));
    let mut at = at_rest(position);
    for _ in 0..SEARCH_STEPS {
        let (outputs, step, path_det) = step_to(path, &at);
        let squared = step.dot(&step);
        let step = if squared.is_finite() {
            step * (longest / squared.max(longest * longest).sqrt())
        } else {
            Vector3::repeat(T::lit(ANY_STEP))
        };
        for (coordinate, &step) in at.iter_mut().zip(&step) {
            *coordinate = *coordinate - step;
        }
        if squared < close * close {
            let [x, y, z] = &at;
            return Some(Nearest { point: Vector3::new(x.value(), y.value(), z.value()), outputs, path_det });
        }
    }
    None
}

/// The outputs at `position`, the step across the tangent from the path's linearized functions to
/// there, m, and (∇h1 × ∇h2)·ρ.
// Apart: a step on the path has its own, without what is known only here.
#[inline(never)]
fn step_to<T: Real, P: Path<T> + ?Sized>(path: &mut P, position: &PositionSeries<T>) -> (Outputs<T>, Vector3<T>, T) {
    let outputs = path.outputs(position);
    let [h1, h2] = &outputs.surfaces;
    let (step, path_det) = outputs.solve([h1.value(), h2.value(), T::zero()]);
    (outputs, step, path_det)
}

#[cfg(test)]
mod tests {
    use super::*;
    use model::VehicleParams;

    #[test]
    fn profile_falls_from_one_to_zero_with_six_flat_derivatives() {
        // Of a slide of 4 s. Its ends are taken a millionth of it inside, where S has hardly begun:
        // 1716 (1e-6)⁷ from its end.
        for (elapsed, value) in [(0.0, 1.0), (2.0, 0.5), (4.0, 0.0), (5.0, 0.0)] {
            let (profile, area) = profile(elapsed, 4.0_f64);
            assert!((profile.value() - value).abs() < 1e-12, "{elapsed}");
            assert!(elapsed > 0.0 || (area - 2.0).abs() < 5e-6, "{area}");
            assert!(elapsed < 4.0 || area.abs() < 1e-12, "{area}");
        }
        // The last of them is next to zero rather than zero, by 12012 · 6! · 1e-6 as |S⁽⁶⁾| has
        // peaks of 2e5, all over 4⁶.
        for elapsed in [0.0, 4.0, 5.0] {
            for k in 1..=6 {
                assert!(profile(elapsed, 4.0_f64).0.derivative(k).abs() < 3e-3, "{elapsed} {k}");
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
    fn durations_keep_speed_and_acceleration() {
        let vehicle = Vehicle::new(VehicleParams::<f64>::paper()).unwrap();
        let limits = ApproachLimits::gentle();
        let pace = limits.pace(&vehicle).unwrap();
        let snap = largest_snap(&vehicle, &limits);
        for size in [0.1, 1.0, 20.0, 50.0] {
            let along = Vector3::new(0.0, 0.6 * size, 0.8 * size);
            let (sliding, braking) = (duration(&pace.slide, &along), duration(&pace.brake, &along));
            let slack = 1.0 + 1e-12;
            assert!(PEAKS[0] * size / sliding <= limits.speed * slack);
            assert!(PEAKS[1] * size / sliding.powi(2) <= limits.acceleration * slack);
            assert!(PEAKS[3] * size / sliding.powi(4) <= snap * slack);
            assert!(PEAKS[0] * size / braking <= limits.acceleration * slack);
            assert!(PEAKS[2] * size / braking.powi(3) <= snap * slack);
        }
    }

    /// The largest snap: half of the acceleration that the tilt allows, g/(1 + cot), over the
    /// swing's (m_Q/M)(L/g).
    fn largest_snap(vehicle: &Vehicle<f64>, limits: &ApproachLimits<f64>) -> f64 {
        let params = vehicle.params();
        let lean = 1.0 / (1.0 + 1.0 / libm::tan(limits.tilt));
        0.5 * params.gravity * lean * vehicle.total_mass() * params.gravity / (params.uav_mass * params.rod_length)
    }
}
