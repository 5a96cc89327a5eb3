//! What the model leaves out, and the observers that find it.
//!
//! Nothing in the law corrects ζ1 = v̇3: wind, a wrong mass or a weak rotor make it miss by
//! decimetres. Extended by an unknown specific force d on the payload, an unknown acceleration δ of
//! the rod's direction and an unknown torque, the model is
//!
//! ```text
//! v̇ = g e3 + d + λ q,   q̈ = κ b3 + c λ q + δ,   κ (b3·q) = −(|q̇|² + c λ + δ·q)
//! J ω̇ = J ω × ω + τ + τ_d                                                     (12.1)
//! ```
//!
//! which can stand for wind on either body, wrong masses and wrong thrust alike. Seen from a moving
//! payload none of these is constant, so d and δ are estimated together with their rates, by three
//! states per axis. A torque mostly originates on the vehicle; two states suffice:
//!
//! ```text
//! v̂˙ = model + d̂ + 3 o e,   d̂˙ = r̂ + 3 o² e,   r̂˙ = o³ e,   e = v − v̂
//! ω̂˙ = model + J⁻¹ τ̂ + 2 o e,   τ̂˙ = J o² e,   e = ω − ω̂           (12.3)
//! ```
//!
//! discretized with gains for poles at e^(−o h), (12.4), near which they are (12.5). A force that
//! grows steadily is followed without lag. Along the rod d and δ act alike, so δ̂ is kept
//! orthogonal to q.

use model::{Disturbance, OutOfRange, Real, State, Vehicle};
use nalgebra::Vector3;

use crate::ranges::{PAYLOAD_BANDWIDTH, PAYLOAD_BOUND, ROD_BANDWIDTH, ROD_BOUND, TORQUE_BANDWIDTH, TORQUE_BOUND};

/// Observer bandwidths o, rad/s, and the bounds of what they may find. A bandwidth of zero switches
/// an observer off.
///
/// ```
/// use controller::ObserverParams;
///
/// // As a rule; and slower where the state is noisy, with nothing to be found of torque.
/// let usual = ObserverParams::with_bandwidth(8.0_f32);
/// let calm = ObserverParams { torque_bandwidth: 0.0, ..ObserverParams::with_bandwidth(4.0_f32) };
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObserverParams<T> {
    /// Of d̂, rad/s.
    pub payload_bandwidth: T,
    /// Of δ̂, rad/s.
    pub rod_bandwidth: T,
    /// Of τ̂_d, rad/s.
    pub torque_bandwidth: T,
    /// Bound of |d̂|, m/s².
    pub payload_bound: T,
    /// Bound of |δ̂|, 1/s².
    pub rod_bound: T,
    /// Bound of |τ̂_d|, N·m.
    pub torque_bound: T,
}

impl<T: Real> ObserverParams<T> {
    /// All off.
    #[must_use]
    pub fn off() -> Self {
        Self::with_bandwidth(T::zero())
    }

    /// The same `bandwidth`, rad/s, for all three, with bounds of 1.5 g, 1 g/m and 1 N·m.
    pub fn with_bandwidth(bandwidth: T) -> Self {
        Self {
            payload_bandwidth: bandwidth,
            rod_bandwidth: bandwidth,
            torque_bandwidth: bandwidth,
            payload_bound: PAYLOAD_BOUND.default(),
            rod_bound: ROD_BOUND.default(),
            torque_bound: TORQUE_BOUND.default(),
        }
    }

    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> ObserverParams<U> {
        ObserverParams {
            payload_bandwidth: self.payload_bandwidth.cast(),
            rod_bandwidth: self.rod_bandwidth.cast(),
            torque_bandwidth: self.torque_bandwidth.cast(),
            payload_bound: self.payload_bound.cast(),
            rod_bound: self.rod_bound.cast(),
            torque_bound: self.torque_bound.cast(),
        }
    }

    fn check(&self) -> Result<(), OutOfRange<T>> {
        PAYLOAD_BANDWIDTH.check(self.payload_bandwidth)?;
        ROD_BANDWIDTH.check(self.rod_bandwidth)?;
        TORQUE_BANDWIDTH.check(self.torque_bandwidth)?;
        PAYLOAD_BOUND.check(self.payload_bound)?;
        ROD_BOUND.check(self.rod_bound)?;
        TORQUE_BOUND.check(self.torque_bound)
    }
}

/// One observer: a velocity's prediction, and the gains that correct it, the disturbance and, of a
/// force, its rate.
#[derive(Clone, Copy, Debug)]
struct Channel<T> {
    velocity_gain: T,
    disturbance_gain: T,
    rate_gain: T,
    bound_squared: T,
    /// The velocity predicted with the first half of the running period's trapezoid.
    predicted: Vector3<T>,
}

impl<T: Real> Channel<T> {
    /// Of a disturbance that grows, by the gains (12.4), 1 − p³, (3/2) (1 − p)² (1 + p)/h and (1 −
    /// p)³/h² with p = e^(−o h).
    fn growing(bandwidth: T, bound: T, period: T) -> Self {
        let pole = (-bandwidth * period).exp();
        let gap = (T::one() - pole) / period;
        let square = gap * gap * period;
        Self {
            velocity_gain: T::one() - pole * pole * pole,
            disturbance_gain: square * (T::one() + pole) * T::lit(1.5),
            rate_gain: square * gap,
            ..Self::steady(bandwidth, bound, period)
        }
    }

    /// Of one that stays, by 1 − p² and (1 − p)²/h.
    fn steady(bandwidth: T, bound: T, period: T) -> Self {
        let pole = (-bandwidth * period).exp();
        let gap = T::one() - pole;
        Self {
            velocity_gain: gap * (T::one() + pole),
            disturbance_gain: gap * gap / period,
            rate_gain: T::zero(),
            bound_squared: bound * bound,
            predicted: Vector3::zeros(),
        }
    }

    /// Ends the running period with the acceleration just `before` the sample, corrects the
    /// velocity by what was `measured`, and begins the next with the one just `after` it. Returns
    /// the innovation.
    #[inline]
    fn correct(
        &mut self,
        measured: &Vector3<T>,
        before: &Vector3<T>,
        after: &Vector3<T>,
        half_period: T,
    ) -> Vector3<T> {
        let predicted = self.predicted + before * half_period;
        let innovation = measured - predicted;
        self.predicted = predicted + innovation * self.velocity_gain + after * half_period;
        innovation
    }

    /// [Corrects](Self::correct) the velocity, a force and its `rate`, and moves the force on by a
    /// `period`.
    #[inline]
    fn grow(
        &mut self,
        measured: &Vector3<T>,
        before: &Vector3<T>,
        after: &Vector3<T>,
        period: T,
        disturbance: &mut Vector3<T>,
        rate: &mut Vector3<T>,
    ) {
        let innovation = self.correct(measured, before, after, period * T::lit(0.5));
        let found = *rate + innovation * self.rate_gain;
        let is_taken = self.take(innovation * self.disturbance_gain + found * period, disturbance);
        *rate = if is_taken { found } else { Vector3::zeros() };
    }

    /// Corrects a `disturbance`, unless it would leave its bound.
    #[inline]
    fn take(&self, correction: Vector3<T>, disturbance: &mut Vector3<T>) -> bool {
        let found = *disturbance + correction;
        let is_within = found.dot(&found) <= self.bound_squared;
        if is_within {
            *disturbance = found;
        }
        is_within
    }
}

/// The three observers and their estimate.
#[derive(Clone, Copy, Debug)]
pub struct Observer<T> {
    payload: Channel<T>,
    rod: Channel<T>,
    body: Channel<T>,
    inertia: Vector3<T>,
    period: T,
    estimate: Disturbance<T>,
}

impl<T: Real> Observer<T> {
    pub(crate) fn new(vehicle: &Vehicle<T>, params: &ObserverParams<T>, period: T) -> Result<Self, OutOfRange<T>> {
        params.check()?;
        Ok(Self {
            payload: Channel::growing(params.payload_bandwidth, params.payload_bound, period),
            rod: Channel::growing(params.rod_bandwidth, params.rod_bound, period),
            body: Channel::steady(params.torque_bandwidth, params.torque_bound, period),
            inertia: *vehicle.inertia(),
            period,
            estimate: Disturbance::none(),
        })
    }

    /// Forgets every estimate, and starts from `state`.
    pub(crate) fn reset(&mut self, state: &State<T>) {
        self.estimate = Disturbance::none();
        self.restart(state);
    }

    /// Starts from `state`, with the estimates as they are. The half period's acceleration that
    /// this leaves out is gone within the observers' time, and below a hundredth of an m/s².
    #[inline(never)]
    pub(crate) fn restart(&mut self, state: &State<T>) {
        self.payload.predicted = state.velocity;
        self.rod.predicted = state.rod_rate;
        self.body.predicted = state.body_rate;
    }

    /// Takes `estimate` for what has been found.
    pub(crate) fn keep(&mut self, estimate: Disturbance<T>) {
        self.estimate = estimate;
    }

    /// What has been found up to now, as of the next sample.
    pub fn estimate(&self) -> &Disturbance<T> {
        &self.estimate
    }

    /// Corrects d̂ by the sampled payload's `velocity`. `before`: the model's acceleration just
    /// before the sample; `after`: just after it.
    ///
    /// Commands step at samples, and the model is affine in them. The last sample's `after` could
    /// not know its step, so this sample's `before` makes it good: the trapezoid over the last
    /// period has both of its ends. So it is with δ̂ and τ̂_d.
    #[inline]
    pub(crate) fn correct_payload(&mut self, velocity: &Vector3<T>, before: &Vector3<T>, after: &Vector3<T>) {
        let Disturbance { payload, payload_rate, .. } = &mut self.estimate;
        self.payload.grow(velocity, before, after, self.period, payload, payload_rate);
    }

    /// Corrects δ̂ by the sampled `rod` and its `rate`.
    #[inline]
    pub(crate) fn correct_rod(
        &mut self,
        rod: &Vector3<T>,
        rate: &Vector3<T>,
        before: &Vector3<T>,
        after: &Vector3<T>,
    ) {
        let Disturbance { rod: delta, rod_rate: delta_1, .. } = &mut self.estimate;
        self.rod.grow(rate, before, after, self.period, delta, delta_1);
        *delta -= rod * rod.dot(delta);
        *delta_1 -= rod * rod.dot(delta_1);
    }

    /// Corrects τ̂_d by the sampled `body_rate`.
    #[inline]
    pub(crate) fn correct_body(&mut self, body_rate: &Vector3<T>, before: &Vector3<T>, after: &Vector3<T>) {
        let missed = self.body.correct(body_rate, before, after, self.period * T::lit(0.5));
        let correction = missed.component_mul(&self.inertia) * self.body.disturbance_gain;
        self.body.take(correction, &mut self.estimate.torque);
    }
}
