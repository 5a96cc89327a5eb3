//! The trajectory-tracking law of Section V, the baseline: y = (p, ψ) follows a reference in time.
//!
//! The same lift and lower with p⁽⁶⁾ = p_ref⁽⁶⁾ − Σ kⱼ (p − p_ref)⁽ʲ⁾ (10.1).
//! Relative degrees are {6, 6, 6, 2}.

use model::{Command, Disturbance, OutOfRange, Real, Series, State, Vehicle, Yaw};
use nalgebra::Vector3;

use crate::error::Refused;
use crate::law::approach::{Approach, Pace};
use crate::law::gains::{self, GainError};
use crate::law::lift::{Lift, lift};
use crate::law::lower::lower;
use crate::law::margins::Margins;
use crate::law::solution::{Answer, Solution, dot};
use crate::law::{Ahead, Law};
use crate::path::PositionSeries;
use crate::ranges::BANDWIDTH;

/// Gains of the tracking law, low order first.
///
/// ```
/// use controller::TrackGains;
///
/// assert!(TrackGains::spread(0.8_f32)?.check().is_ok());
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackGains<T> {
    /// Of the errors of p1, p2, p3 and their derivatives to order 5.
    pub position: [[T; 6]; 3],
    /// Of the errors of ψ, ψ̇.
    pub yaw: [T; 2],
}

impl<T: Real> TrackGains<T> {
    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> TrackGains<U> {
        TrackGains { position: self.position.map(|row| row.map(T::cast)), yaw: self.yaw.map(T::cast) }
    }

    /// Spread poles to fly with: −1 to −6 times `bandwidth` (1/s), and −2, −3 times it for the
    /// yaw.
    ///
    /// # Errors
    /// `bandwidth` is out of its [range](crate::ranges::BANDWIDTH).
    pub fn spread(bandwidth: T) -> Result<Self, OutOfRange<T>> {
        BANDWIDTH.check(bandwidth)?;
        Ok(Self { position: [gains::spread(bandwidth, 1); 3], yaw: gains::spread(bandwidth, 2) })
    }

    /// `Ok` if every closed loop is stable.
    ///
    /// # Errors
    /// The first output whose loop is not.
    pub fn check(&self) -> Result<(), GainError<T>> {
        for (output, k) in (1..).zip(&self.position) {
            gains::check::<_, 6, 7>(output, k, T::zero())?;
        }
        gains::check::<_, 2, 3>(4, &self.yaw, T::zero())
    }
}

/// A reference for the payload and the yaw, as Taylor series in time about now.
///
/// ```
/// use controller::{Reference, Series};
///
/// // At rest at (0, 0, −10 m), and there the circle of 5 m radius at 1 m/s as it passes (0, 5 m).
/// let position = [0.0_f32, 0.0, -10.0].map(Series::constant);
/// let hover = Reference { position, yaw: Series::constant(0.0) };
/// let circle = Reference::circle(5.0, -10.0, 0.2, 0.0);
/// assert_eq!(circle.position.map(|p| p.derivative(1)), [1.0, 0.0, 0.0]);
/// assert_eq!(hover.position[2].value(), circle.position[2].value());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference<T> {
    /// p_ref in N, m, orders 0 to 6.
    pub position: PositionSeries<T>,
    /// ψ_ref, rad, orders 0 to 2.
    pub yaw: Series<T, 3>,
}

impl<T: Real> Reference<T> {
    /// Section V's circle, y_ref = (r sin a, r cos a, p3, 0) at phase a (rad) with ȧ = `rate`,
    /// rad/s.
    pub fn circle(radius: T, p3: T, rate: T, phase: T) -> Self {
        let (sin, cos) = phase.sin_cos();
        let rate_2 = rate * rate;
        let (rate_3, rate_4) = (rate_2 * rate, rate_2 * rate_2);
        // The derivatives of (sin, cos) go round: each is the rate times the one a quarter turn on.
        let powers = [T::one(), rate, -rate_2, -rate_3, rate_4, rate_4 * rate, -(rate_3 * rate_3)];
        let wave = |even: T, odd: T| {
            let [p0, p1, p2, p3, p4, p5, p6] = powers;
            let [even, odd] = [radius * even, radius * odd];
            Series::from_derivatives([p0 * even, p1 * odd, p2 * even, p3 * odd, p4 * even, p5 * odd, p6 * even])
        };
        Self { position: [wave(sin, cos), wave(cos, -sin), Series::constant(p3)], yaw: Series::constant(T::zero()) }
    }

    /// The same reference about the instant `dt` later, by its truncated series.
    #[inline]
    pub fn shift(&self, dt: T) -> Self {
        Self { position: self.position.map(|p| p.shift(dt)), yaw: self.yaw.shift(dt) }
    }
}

/// The tracked outputs and their derivatives; the reference is not subtracted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrackXi<T> {
    /// p to p⁽⁵⁾ in N, a row for each of p1, p2, p3; m/sᵏ.
    pub position: [[T; 6]; 3],
    /// ψ, ψ̇; rad, rad/s.
    pub yaw: [T; 2],
}

/// The tracking law at `state`, ζ and a known disturbance as they are.
pub fn track<T: Real>(
    vehicle: &Vehicle<T>,
    gains: &TrackGains<T>,
    reference: &Reference<T>,
    state: &State<T>,
    zeta: &[T; 4],
    disturbance: &Disturbance<T>,
) -> Solution<T, TrackXi<T>> {
    let lift = lift(vehicle, state, zeta, disturbance);
    let (answer, xi) = answer(vehicle, gains, reference, state, &lift, disturbance);
    answer.with(xi)
}

/// The law's answer to what was lifted, and ξ.
#[inline(always)]
fn answer<T: Real>(
    vehicle: &Vehicle<T>,
    gains: &TrackGains<T>,
    reference: &Reference<T>,
    state: &State<T>,
    lift: &Lift<T>,
    disturbance: &Disturbance<T>,
) -> (Answer<T>, TrackXi<T>) {
    let yaw = Yaw::of(state);

    let [x, y, z] = &reference.position;
    let [k1, k2, k3] = &gains.position;
    let [p1, p2, p3] = &lift.position;
    let wanted = |k: &[T; 6], p: &Series<T, 7>, reference: &Series<T, 7>| {
        let error = derivatives(&(*p - *reference));
        reference.derivative(6) - dot(k, &error)
    };
    let position_6 = Vector3::new(wanted(k1, p1, x), wanted(k2, p2, y), wanted(k3, p3, z));
    let yaw_error = [(yaw.angle - reference.yaw.value()).wrap_angle(), yaw.rate - reference.yaw.derivative(1)];
    let yaw_2 = reference.yaw.derivative(2) - dot(&gains.yaw, &yaw_error);

    let answer = Answer {
        command: Command {
            thrust: lift.thrust(vehicle),
            torque: lower(vehicle, state, lift, &yaw, &position_6, yaw_2, &disturbance.torque),
        },
        u_zeta: position_6.z,
        nu: [position_6.x, position_6.y, position_6.z, yaw_2],
        margins: Margins {
            q3: state.rod.z,
            q_b3: lift.b3_rod,
            lambda: lift.lambda[0],
            kappa: lift.kappa,
            path_det: T::one(),
            reach: T::one(),
            cos_phi_squared: yaw.cos_phi_squared,
        },
    };
    (answer, TrackXi { position: [p1, p2, p3].map(derivatives), yaw: [yaw.angle, yaw.rate] })
}

/// Derivatives 0 to 5.
#[inline]
fn derivatives<T: Real>(p: &Series<T, 7>) -> [T; 6] {
    core::array::from_fn(|k| p.derivative(k))
}

/// The tracking law with its memory.
#[derive(Clone, Debug)]
pub struct Track<T> {
    gains: TrackGains<T>,
    reference: Reference<T>,
    answer: Answer<T>,
    xi: TrackXi<T>,
    approach: Approach<T>,
}

impl<T: Real> Track<T> {
    /// With `gains` that are found stable, and the origin for a reference.
    ///
    /// # Errors
    /// The first output whose loop is not stable.
    pub(crate) fn new(gains: TrackGains<T>) -> Result<Self, GainError<T>> {
        gains.check()?;
        let zero = T::zero();
        let reference = Reference { position: [Series::constant(zero); 3], yaw: Series::constant(zero) };
        let (answer, xi) = (Answer::none(), TrackXi::default());
        Ok(Self { gains, reference, answer, xi, approach: Approach::none() })
    }

    /// Sets the reference about the coming sample. Call it every period before the step.
    #[inline]
    pub fn set_reference(&mut self, reference: &Reference<T>) {
        self.reference = *reference;
    }
}

impl<T: Real> Law<T> for Track<T> {
    type Xi = TrackXi<T>;

    #[inline(always)]
    fn evaluate(&mut self, vehicle: &Vehicle<T>, ahead: &Ahead<T>, disturbance: &Disturbance<T>) {
        let Ahead { state, zeta, horizon } = ahead;
        let mut reference = self.reference.shift(*horizon);
        let mut lift = lift(vehicle, state, zeta, disturbance);
        if let Some(fading) = self.approach.leave(*horizon, &mut lift.position) {
            self.approach.fade_yaw(&fading, &mut reference.yaw);
        }
        (self.answer, self.xi) = answer(vehicle, &self.gains, &reference, state, &lift, disturbance);
    }

    #[inline(always)]
    fn answer(&self) -> &Answer<T> {
        &self.answer
    }

    fn solution(&self) -> Solution<T, TrackXi<T>> {
        self.answer.with(self.xi)
    }

    #[inline(always)]
    fn accept(&mut self, period: T, _is_saturated: bool) {
        self.approach.advance(period);
    }

    fn restart(&mut self, _: &State<T>) {
        self.approach = Approach::none();
    }

    /// The reference is displaced to where the payload is and as fast as it is, and slides home, as
    /// a path does.
    fn join(&mut self, state: &State<T>, pace: &Pace<T>) -> Result<(), Refused> {
        let Reference { position: [x, y, z], yaw } = &self.reference;
        let position = Vector3::new(x.value(), y.value(), z.value());
        let velocity = Vector3::new(x.derivative(1), y.derivative(1), z.derivative(1));
        let yaw = (yaw.value() - Yaw::of(state).angle).wrap_angle();
        self.approach = Approach::over(pace, state.position - position, state.velocity - velocity, yaw);
        Ok(())
    }

    #[inline(always)]
    fn approach(&self) -> &Approach<T> {
        &self.approach
    }
}
