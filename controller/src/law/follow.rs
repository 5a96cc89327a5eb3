//! The path-following law, (5.3) to (5.8), with the paper's integral action (5.4).
//!
//! State, ζ → [lift](mod@crate::law::lift) → outputs along the [path](crate::path) → ν → one
//! 3×3 system → [lower](mod@crate::law::lower) → u_ζ, τ. Relative degrees are {6, 6, 5, 2}: ξ
//! has 19 numbers.

use model::{Disturbance, OutOfRange, Real, State, Vehicle, Yaw};

use crate::error::Refused;
use crate::law::approach::{Approach, Pace};
use crate::law::gains::{self, GainError};
use crate::law::lift::{Lift, lift};
use crate::law::lower::lower;
use crate::law::margins::Margins;
use crate::law::solution::{Answer, Solution, dot};
use crate::law::speed_factor::SpeedFactor;
use crate::law::{Ahead, Law};
use crate::path::{Outputs, Path};
use crate::ranges::BANDWIDTH;
use crate::sampling::Sampling;

/// The gains of (5.3), low order first: ν = −K ξ − (K̃ ξ̃, 0).
///
/// ```
/// use controller::Gains;
///
/// // Poles to fly with, and integral action on height.
/// let gains = Gains { integral: [0.0, 100.0, 0.0], ..Gains::spread(1.0_f32)? };
/// assert!(gains.check().is_ok());
///
/// // Too much of it is no stable loop, and is refused.
/// assert!(Gains { integral: [0.0, 1e5, 0.0], ..gains }.check().is_err());
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains<T> {
    /// Of h1, ḣ1, …, h1⁽⁵⁾.
    pub k1: [T; 6],
    /// Of h2, ḣ2, …, h2⁽⁵⁾.
    pub k2: [T; 6],
    /// Of h3, …, h3⁽⁴⁾.
    pub k3: [T; 5],
    /// Of h4, ḣ4.
    pub k4: [T; 2],
    /// Of ∫h1, ∫h2, ∫h3; zeros switch integral action off.
    pub integral: [T; 3],
}

impl<T: Real> Gains<T> {
    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Gains<U> {
        Gains {
            k1: self.k1.map(T::cast),
            k2: self.k2.map(T::cast),
            k3: self.k3.map(T::cast),
            k4: self.k4.map(T::cast),
            integral: self.integral.map(T::cast),
        }
    }

    /// Spread poles to fly with, without integral action: −1, −2, … times `bandwidth` (1/s) for h1,
    /// h2 and h3, and −2, −3 times it for the yaw.
    ///
    /// # Errors
    /// `bandwidth` is out of its [range](crate::ranges::BANDWIDTH).
    pub fn spread(bandwidth: T) -> Result<Self, OutOfRange<T>> {
        BANDWIDTH.check(bandwidth)?;
        let k = gains::spread(bandwidth, 1);
        Ok(Self {
            k1: k,
            k2: k,
            k3: gains::spread(bandwidth, 1),
            k4: gains::spread(bandwidth, 2),
            integral: [T::zero(); 3],
        })
    }

    /// The same of Taylor coefficients in the place of derivatives: times k!.
    fn of_coefficients(mut self) -> Self {
        for k in [&mut self.k1[..], &mut self.k2, &mut self.k3, &mut self.k4] {
            k.iter_mut().zip(T::FACTORIAL).for_each(|(k, factorial)| *k *= factorial);
        }
        self
    }

    /// `Ok` if every closed loop is stable, integral action included.
    ///
    /// # Errors
    /// The first output whose loop is not.
    pub fn check(&self) -> Result<(), GainError<T>> {
        gains::check::<_, 6, 7>(1, &self.k1, self.integral[0])?;
        gains::check::<_, 6, 7>(2, &self.k2, self.integral[1])?;
        gains::check::<_, 5, 6>(3, &self.k3, self.integral[2])?;
        gains::check::<_, 2, 3>(4, &self.k4, T::zero())
    }
}

/// The outputs and their derivatives (the normal form's coordinates), 19 numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Xi<T> {
    /// h1, …, h1⁽⁵⁾.
    pub h1: [T; 6],
    /// h2, …, h2⁽⁵⁾.
    pub h2: [T; 6],
    /// h3 = ρ·v − v_d, …, h3⁽⁴⁾, m/s¹⁺ᵏ.
    pub h3: [T; 5],
    /// h4 = ψ − ψ_d in (−π, π], and ḣ4; rad, rad/s.
    pub h4: [T; 2],
}

impl<T: Real> Xi<T> {
    /// From the path's outputs and the error of the yaw.
    fn of(outputs: &Outputs<T>, h4: [T; 2]) -> Self {
        let [s1, s2] = &outputs.surfaces;
        Self {
            h1: core::array::from_fn(|k| s1.derivative(k)),
            h2: core::array::from_fn(|k| s2.derivative(k)),
            h3: core::array::from_fn(|k| outputs.speed_error.derivative(k)),
            h4,
        }
    }
}

/// h4 and ḣ4.
#[inline(always)]
fn yaw_error<T: Real>(yaw: &Yaw<T>, outputs: &Outputs<T>) -> [T; 2] {
    [(yaw.angle - outputs.yaw.value()).wrap_angle(), yaw.rate - outputs.yaw.derivative(1)]
}

/// The path-following law at `state`, ζ, the integrals ξ̃ = ∫(h1, h2, h3) and a known disturbance
/// as they are, without looking ahead.
pub fn follow<T: Real, P: Path<T> + ?Sized>(
    vehicle: &Vehicle<T>,
    path: &mut P,
    gains: &Gains<T>,
    state: &State<T>,
    zeta: &[T; 4],
    integral: &[T; 3],
    disturbance: &Disturbance<T>,
) -> Solution<T, Xi<T>> {
    let lift = lift(vehicle, state, zeta, disturbance);
    let outputs = path.outputs(&lift.position);
    let yaw = Yaw::of(state);
    let xi = Xi::of(&outputs, yaw_error(&yaw, &outputs));
    let mut answer = Answer::none();
    answer.nu = nu(gains, integral, &xi);
    answer.lower(vehicle, state, disturbance, &lift, &yaw, &outputs);
    answer.with(xi)
}

/// ν of (5.3).
#[inline(always)]
fn nu<T: Real>(gains: &Gains<T>, integral: &[T; 3], xi: &Xi<T>) -> [T; 4] {
    [
        -(dot(&gains.k1, &xi.h1) + gains.integral[0] * integral[0]),
        -(dot(&gains.k2, &xi.h2) + gains.integral[1] * integral[1]),
        -(dot(&gains.k3, &xi.h3) + gains.integral[2] * integral[2]),
        -dot(&gains.k4, &xi.h4),
    ]
}

impl<T: Real> Answer<T> {
    /// The command and u_ζ that give ν, and the margins. Each number is written where it stays, so
    /// that none is copied.
    #[inline(always)]
    fn lower(
        &mut self,
        vehicle: &Vehicle<T>,
        state: &State<T>,
        disturbance: &Disturbance<T>,
        lift: &Lift<T>,
        yaw: &Yaw<T>,
        outputs: &Outputs<T>,
    ) {
        // ν − χ is what p⁽⁶⁾ has to give (5.5).
        let [s1, s2] = &outputs.surfaces;
        let [nu1, nu2, nu3, nu4] = self.nu;
        let (position_6, path_det) =
            outputs.solve([nu1 - s1.derivative(6), nu2 - s2.derivative(6), nu3 - outputs.speed_error.derivative(5)]);
        let yaw_2 = nu4 + outputs.yaw.derivative(2);
        self.u_zeta = position_6.z;
        self.margins = Margins {
            q3: state.rod.z,
            q_b3: lift.b3_rod,
            lambda: lift.lambda[0],
            kappa: lift.kappa,
            path_det,
            reach: outputs.reach_margin,
            cos_phi_squared: yaw.cos_phi_squared,
        };
        self.command.thrust = lift.thrust(vehicle);
        self.command.torque = lower(vehicle, state, lift, yaw, &position_6, yaw_2, &disturbance.torque);
    }
}

/// How long integral action waits after the thrust was limited, s: five time constants of a pole at
/// −1.
const RECOVERY: f64 = 5.0;

/// Speed below which the payload rests, m/s.
const AT_REST: f64 = 0.01;

/// The path-following law with its memory.
// In this order: what every step needs comes before what may be large.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Follow<T, P> {
    /// As they act: those of h1, h2 and h3 are raised by (11.5), and all are of Taylor
    /// coefficients.
    gains: Gains<T>,
    integral: [T; 3],
    /// The last outputs, error of yaw and answer, kept where they were made.
    outputs: Outputs<T>,
    yaw_error: [T; 2],
    answer: Answer<T>,
    /// Time since the thrust was limited, s.
    unsaturated: T,
    approach: Approach<T>,
    speed_factor: SpeedFactor<T>,
    /// How long the payload has rested at the path's stop, s.
    rested: T,
    path: P,
}

impl<T: Real, P: Path<T>> Follow<T, P> {
    /// On `path` with `gains` that are found stable. ξ̃ is kept for the sample and the law acts
    /// half a hold later: ξ̃ + h · half.
    ///
    /// # Errors
    /// The first output whose loop is not stable.
    pub(crate) fn new(path: P, mut gains: Gains<T>, sampling: &Sampling<T>) -> Result<Self, GainError<T>> {
        gains.check()?;
        let lead = sampling.half_hold();
        gains.k1[0] += gains.integral[0] * lead;
        gains.k2[0] += gains.integral[1] * lead;
        gains.k3[0] += gains.integral[2] * lead;
        Ok(Self {
            path,
            gains: gains.of_coefficients(),
            integral: [T::zero(); 3],
            outputs: Outputs::none(),
            yaw_error: [T::zero(); 2],
            answer: Answer::none(),
            unsaturated: T::lit(RECOVERY),
            approach: Approach::none(),
            speed_factor: SpeedFactor::one(sampling.period, sampling.horizon()),
            rested: T::zero(),
        })
    }

    /// The path.
    pub fn path(&self) -> &P {
        &self.path
    }

    /// The path, for what may be changed of it in flight.
    pub fn path_mut(&mut self) -> &mut P {
        &mut self.path
    }

    /// ξ̃ = ∫(h1, h2, h3) up to the next sample.
    pub fn integral(&self) -> &[T; 3] {
        &self.integral
    }

    /// Has the path flown at `factor` times its speed, smoothly from the factor that is flown: 0
    /// stops, less goes back, at most 2 either way. NaN changes nothing.
    pub fn set_speed_factor(&mut self, factor: T) {
        self.speed_factor.wish(factor);
    }

    /// The factor of the path's speed now.
    pub fn speed_factor(&self) -> T {
        self.speed_factor.value()
    }

    /// Goes on from the path's stop where the payload rests. `false`, and nothing changed, if it
    /// does not or nothing comes after.
    #[cold]
    pub fn go_on(&mut self) -> bool {
        let goes_on = self.rested > T::zero() && self.path.go_on();
        if goes_on {
            self.speed_factor.restart();
            self.rested = T::zero();
        }
        goes_on
    }

    /// Counts how long the payload has rested at the path's stop, and goes on when that is long
    /// enough.
    #[inline(always)]
    fn rest(&mut self, period: T) {
        let Some(dwell) = self.path.dwell() else { return };
        let Outputs { prescribed, speed_error, .. } = &self.outputs;
        let is_at_rest = [prescribed, speed_error].iter().all(|speed| speed.value().abs() < T::lit(AT_REST));
        self.rested = if is_at_rest { self.rested + period } else { T::zero() };
        if self.rested > dwell {
            self.go_on();
        }
    }

    /// Whether the payload is at rest at the path's stop.
    pub fn rests(&self) -> bool {
        self.rested > T::zero()
    }

    /// Whether it has rested for as long as it is to where nothing comes after.
    pub fn is_over(&self) -> bool {
        // Elsewhere it would have gone on.
        self.path.dwell().is_some_and(|dwell| self.rested > dwell)
    }

    /// The path alone.
    pub fn into_path(self) -> P {
        self.path
    }

    /// Clears the integrals and the memory of limits, as in a law just made.
    fn reset_integrals(&mut self) {
        self.integral = [T::zero(); 3];
        self.unsaturated = T::lit(RECOVERY);
    }
}

impl<T: Real, P: Path<T>> Law<T> for Follow<T, P> {
    type Xi = Xi<T>;

    #[inline(always)]
    fn evaluate(&mut self, vehicle: &Vehicle<T>, ahead: &Ahead<T>, disturbance: &Disturbance<T>) {
        let Ahead { state, zeta, horizon } = ahead;
        let mut lift = lift(vehicle, state, zeta, disturbance);
        let fading = self.approach.leave(*horizon, &mut lift.position);
        let outputs = &mut self.outputs;
        self.path.evaluate(&lift.position, outputs);
        if let Some(fading) = fading {
            self.approach.fade(&fading, outputs);
        }
        self.speed_factor.apply(outputs);
        let yaw = Yaw::of(state);
        self.yaw_error = yaw_error(&yaw, outputs);
        let ([s1, s2], s3) = (&outputs.surfaces, &outputs.speed_error);
        let coefficients = Xi { h1: s1.truncate().0, h2: s2.truncate().0, h3: s3.truncate().0, h4: self.yaw_error };
        self.answer.nu = nu(&self.gains, &self.integral, &coefficients);
        self.answer.lower(vehicle, state, disturbance, &lift, &yaw, outputs);
    }

    #[inline(always)]
    fn answer(&self) -> &Answer<T> {
        &self.answer
    }

    fn solution(&self) -> Solution<T, Xi<T>> {
        self.answer.with(Xi::of(&self.outputs, self.yaw_error))
    }

    #[inline(always)]
    fn accept(&mut self, period: T, is_saturated: bool) {
        self.approach.advance(period);
        self.rest(period);
        if let Some(is_backward) = self.speed_factor.advance(!self.approach.is_active()) {
            let has_own = self.path.set_backward(is_backward);
            self.speed_factor.turned(has_own);
        }
        // At the actuators' limit the integrals would wind up, and afterwards they would take the
        // way back for a steady error.
        self.unsaturated = if is_saturated { T::zero() } else { self.unsaturated + period };
        if self.unsaturated >= T::lit(RECOVERY) {
            let Outputs { surfaces: [h1, h2], speed_error, .. } = &self.outputs;
            for (integral, h) in self.integral.iter_mut().zip([h1.value(), h2.value(), speed_error.value()]) {
                *integral += period * h;
            }
        }
    }

    fn restart(&mut self, state: &State<T>) {
        self.reset_integrals();
        self.approach = Approach::at(&mut self.path, &state.position);
        if self.path.dwell().is_some() {
            // What leads to a stop began at one.
            self.speed_factor.restart();
        }
    }

    fn join(&mut self, state: &State<T>, pace: &Pace<T>) -> Result<(), Refused> {
        if self.path.dwell().is_some() {
            // Its place stands still until it is joined, so that the payload goes straight there,
            // and no leg is flown beside it.
            self.speed_factor.wait();
        }
        self.approach.join(&mut self.path, pace, state, self.speed_factor.effective())?;
        self.reset_integrals();
        Ok(())
    }

    #[inline(always)]
    fn approach(&self) -> &Approach<T> {
        &self.approach
    }
}
