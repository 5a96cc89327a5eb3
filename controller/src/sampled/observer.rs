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

use model::{Disturbance, OutOfRange, Real, State, Vehicle, VehicleParams};
use nalgebra::Vector3;

use crate::ranges::{
    ALONG_BANDWIDTH, CABLE_STIFFNESS, PAYLOAD_BANDWIDTH, PAYLOAD_BOUND, ROD_BANDWIDTH, ROD_BOUND, TORQUE_BANDWIDTH,
    TORQUE_LEVER,
};

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
    /// Of d̂, rad/s; behind a told latency it is more (12.9), and so is δ̂'s.
    pub payload_bandwidth: T,
    /// Of d̂ along the rod, rad/s, where it is less; 0: the same.
    pub along_bandwidth: T,
    /// EA of an elastic cable, N, along which the bandwidth is then no more than (12.8); 0: it does
    /// not stretch.
    pub cable_stiffness: T,
    /// Of δ̂, rad/s.
    pub rod_bandwidth: T,
    /// Of τ̂_d, rad/s.
    pub torque_bandwidth: T,
    /// Bound of |d̂|, m/s².
    pub payload_bound: T,
    /// Bound of |δ̂|, 1/s².
    pub rod_bound: T,
    /// Bound of |τ̂_d|, as the lever, m, at which it is the hover thrust's.
    pub torque_lever: T,
}

impl<T: Real> ObserverParams<T> {
    /// All off.
    #[must_use]
    pub fn off() -> Self {
        Self::with_bandwidth(T::zero())
    }

    /// The same `bandwidth`, rad/s, for all three, with bounds of 1.5 g, 1 g/m and a
    /// tenth of a metre of hover thrust.
    pub fn with_bandwidth(bandwidth: T) -> Self {
        Self {
            payload_bandwidth: bandwidth,
            along_bandwidth: ALONG_BANDWIDTH.default(),
            cable_stiffness: CABLE_STIFFNESS.default(),
            rod_bandwidth: bandwidth,
            torque_bandwidth: bandwidth,
            payload_bound: PAYLOAD_BOUND.default(),
            rod_bound: ROD_BOUND.default(),
            torque_lever: TORQUE_LEVER.default(),
        }
    }

    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> ObserverParams<U> {
        ObserverParams {
            payload_bandwidth: self.payload_bandwidth.cast(),
            along_bandwidth: self.along_bandwidth.cast(),
            cable_stiffness: self.cable_stiffness.cast(),
            rod_bandwidth: self.rod_bandwidth.cast(),
            torque_bandwidth: self.torque_bandwidth.cast(),
            payload_bound: self.payload_bound.cast(),
            rod_bound: self.rod_bound.cast(),
            torque_lever: self.torque_lever.cast(),
        }
    }

    pub(crate) fn check(&self) -> Result<(), OutOfRange<T>> {
        PAYLOAD_BANDWIDTH.check(self.payload_bandwidth)?;
        ALONG_BANDWIDTH.check(self.along_bandwidth)?;
        CABLE_STIFFNESS.check(self.cable_stiffness)?;
        ROD_BANDWIDTH.check(self.rod_bandwidth)?;
        TORQUE_BANDWIDTH.check(self.torque_bandwidth)?;
        PAYLOAD_BOUND.check(self.payload_bound)?;
        ROD_BOUND.check(self.rod_bound)?;
        TORQUE_LEVER.check(self.torque_lever)
    }

    /// With forces observed as much faster as a told `latency`, s, asks for (12.9).
    pub(crate) fn behind(&self, latency: T) -> Self {
        let faster = |bandwidth: T| {
            let late = (bandwidth * latency).min(T::lit(LATE));
            let square = late * late;
            let root = (T::one() + square / T::lit(12.0)).sqrt();
            bandwidth * (late * T::lit(0.5) + root) / (T::one() - square / T::lit(6.0))
        };
        Self { payload_bandwidth: faster(self.payload_bandwidth), rod_bandwidth: faster(self.rod_bandwidth), ..*self }
    }

    /// The bandwidth along the rod, rad/s.
    fn along(&self, vehicle: &Vehicle<T>) -> T {
        let told = if self.along_bandwidth > T::zero() { self.along_bandwidth } else { self.payload_bandwidth };
        told.min(self.payload_bandwidth).min(self.most_along(vehicle))
    }

    /// What the `vehicle`'s bounce on its cable allows along the rod, rad/s (12.8).
    fn most_along(&self, vehicle: &Vehicle<T>) -> T {
        let VehicleParams { payload_mass, uav_mass, rod_length, .. } = *vehicle.params();
        if self.cable_stiffness > T::zero() {
            let stiffness = self.cable_stiffness / rod_length;
            (stiffness * (T::one() / payload_mass + T::one() / uav_mass)).sqrt() * T::lit(BOUNCE_SHARE)
        } else {
            T::lit(PAYLOAD_BANDWIDTH.max)
        }
    }
}

/// o times the latency, up to which (12.9) is followed: a third more of o.
const LATE: f64 = 0.5;

/// Bandwidth along the rod over the frequency of a bounce on the cable, at most.
const BOUNCE_SHARE: f64 = 0.1;
/// By how much the bandwidth along the rod grows while no bounce is seen, in half of the slowest.
const HASTENED: f64 = 1.2;

/// What an innovation is multiplied by to correct a velocity, the disturbance and, of a force, its
/// rate.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Gains<T> {
    velocity: T,
    disturbance: T,
    rate: T,
}

impl<T: Real> Gains<T> {
    /// Of a disturbance that grows, (12.4): 1 − p³, (3/2) (1 − p)² (1 + p)/h and (1 − p)³/h² with p
    /// = e^(−o h).
    fn growing(bandwidth: T, period: T) -> Self {
        let pole = (-bandwidth * period).exp();
        let gap = (T::one() - pole) / period;
        let square = gap * gap * period;
        Self {
            velocity: T::one() - pole * pole * pole,
            disturbance: square * (T::one() + pole) * T::lit(1.5),
            rate: square * gap,
        }
    }

    /// Of one that stays: 1 − p² and (1 − p)²/h.
    fn steady(bandwidth: T, period: T) -> Self {
        let pole = (-bandwidth * period).exp();
        let gap = T::one() - pole;
        Self { velocity: gap * (T::one() + pole), disturbance: gap * gap / period, rate: T::zero() }
    }

    fn minus(&self, other: &Self) -> Self {
        Self {
            velocity: self.velocity - other.velocity,
            disturbance: self.disturbance - other.disturbance,
            rate: self.rate - other.rate,
        }
    }
}

/// One observer: a velocity's prediction, and what corrects it.
#[derive(Clone, Copy, Debug)]
struct Channel<T> {
    gains: Gains<T>,
    period: T,
    bound_squared: T,
    /// The velocity predicted with the first half of the running period's trapezoid.
    predicted: Vector3<T>,
}

impl<T: Real> Channel<T> {
    fn new(gains: Gains<T>, bound: T, period: T) -> Self {
        Self { gains, period, bound_squared: bound * bound, predicted: Vector3::zeros() }
    }

    /// Ends the running period with the acceleration just `before` the sample, corrects the
    /// velocity by what was `measured`, and begins the next with the one just `after` it. Returns
    /// the innovation.
    #[inline]
    fn correct(&mut self, measured: &Vector3<T>, before: &Vector3<T>, after: &Vector3<T>) -> Vector3<T> {
        let half_period = self.period * T::lit(0.5);
        let predicted = self.predicted + before * half_period;
        let innovation = measured - predicted;
        self.predicted = predicted + innovation * self.gains.velocity + after * half_period;
        innovation
    }

    /// [Corrects](Self::correct) the velocity, a force and its `rate`, with other gains in a
    /// direction that stands `apart`, and moves the force on by a period.
    #[inline]
    fn grow(
        &mut self,
        measured: &Vector3<T>,
        before: &Vector3<T>,
        after: &Vector3<T>,
        disturbance: &mut Vector3<T>,
        rate: &mut Vector3<T>,
        apart: Option<(&Gains<T>, &Vector3<T>)>,
    ) {
        let innovation = self.correct(measured, before, after);
        let mut found = *rate + innovation * self.gains.rate;
        let mut correction = innovation * self.gains.disturbance;
        if let Some((more, direction)) = apart {
            let part = direction * direction.dot(&innovation);
            self.predicted += part * more.velocity;
            correction += part * more.disturbance;
            found += part * more.rate;
        }
        let is_taken = self.take(correction + found * self.period, disturbance);
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

/// The observer of d̂ along the rod.
#[derive(Clone, Copy, Debug)]
struct Along<T> {
    /// What its gains have over those across, where they are not the same.
    more: Option<Gains<T>>,
    bandwidth: T,
    /// What an elastic cable allows, rad/s.
    most: T,
}

impl<T: Real> Along<T> {
    fn new(bandwidth: T, most: T, across: &Gains<T>, period: T) -> Self {
        let more = Gains::growing(bandwidth, period).minus(across);
        Self { more: Some(more).filter(|more| more.velocity != T::zero()), bandwidth, most }
    }
}

/// The three observers and their estimate.
#[derive(Clone, Copy, Debug)]
pub struct Observer<T> {
    payload: Channel<T>,
    rod: Channel<T>,
    body: Channel<T>,
    /// Along the rod, and as it was told.
    along: Along<T>,
    told_along: Along<T>,
    inertia: Vector3<T>,
    estimate: Disturbance<T>,
}

impl<T: Real> Observer<T> {
    pub(crate) fn new(vehicle: &Vehicle<T>, params: &ObserverParams<T>, period: T) -> Self {
        let across = Gains::growing(params.payload_bandwidth, period);
        let along = Along::new(params.along(vehicle), params.most_along(vehicle), &across, period);
        let rod = Gains::growing(params.rod_bandwidth, period);
        let torque = Gains::steady(params.torque_bandwidth, period);
        Self {
            payload: Channel::new(across, params.payload_bound, period),
            rod: Channel::new(rod, params.rod_bound, period),
            body: Channel::new(torque, params.torque_lever * vehicle.hover_thrust(), period),
            along,
            told_along: along,
            inertia: *vehicle.inertia(),
            estimate: Disturbance::none(),
        }
    }

    /// The bandwidth, rad/s, that an elastic cable allows along itself.
    pub(crate) fn most_along(&self) -> T {
        self.along.most
    }

    /// From now on no faster along the `rod` than a `bounce` on the cable, rad/s, allows;
    /// starting with what is usual `along` it, m/s².
    #[cold]
    pub(crate) fn yield_to(&mut self, bounce: T, rod: &Vector3<T>, along: T) {
        self.along.most = self.along.most.min(bounce * T::lit(BOUNCE_SHARE));
        self.slow(bounce, rod, along);
    }

    /// The same for now, to be [hastened](Self::hasten).
    #[cold]
    pub(crate) fn slow(&mut self, bounce: T, rod: &Vector3<T>, along: T) {
        let Disturbance { payload, payload_rate, .. } = &mut self.estimate;
        *payload += rod * (along - rod.dot(payload));
        *payload_rate -= rod * rod.dot(payload_rate);
        self.set_along(self.along.bandwidth.min(bounce * T::lit(BOUNCE_SHARE)));
    }

    /// A step faster along the rod, up to what was told and what has been seen allows.
    pub(crate) fn hasten(&mut self) {
        let most = self.told_along.bandwidth.min(self.along.most);
        if self.along.bandwidth < most {
            self.set_along((self.along.bandwidth * T::lit(HASTENED)).min(most));
        }
    }

    fn set_along(&mut self, bandwidth: T) {
        let Channel { gains, period, .. } = &self.payload;
        self.along = Along::new(bandwidth, self.along.most, gains, *period);
    }

    /// Forgets every estimate, and starts from `state`.
    pub(crate) fn reset(&mut self, state: &State<T>) {
        self.estimate = Disturbance::none();
        self.along = self.told_along;
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

    /// Corrects d̂ by the sampled `rod` and payload's `velocity`. `before`: the model's
    /// acceleration just before the sample; `after`: just after it.
    ///
    /// Commands step at samples, and the model is affine in them. The last sample's `after` could
    /// not know its step, so this sample's `before` makes it good: the trapezoid over the last
    /// period has both of its ends. So it is with δ̂ and τ̂_d.
    #[inline]
    pub(crate) fn correct_payload(
        &mut self,
        rod: &Vector3<T>,
        velocity: &Vector3<T>,
        before: &Vector3<T>,
        after: &Vector3<T>,
    ) {
        let Disturbance { payload, payload_rate, .. } = &mut self.estimate;
        let apart = self.along.more.as_ref().map(|gains| (gains, rod));
        self.payload.grow(velocity, before, after, payload, payload_rate, apart);
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
        self.rod.grow(rate, before, after, delta, delta_1, None);
        *delta -= rod * rod.dot(delta);
        *delta_1 -= rod * rod.dot(delta_1);
    }

    /// Corrects τ̂_d by the sampled `body_rate`.
    #[inline]
    pub(crate) fn correct_body(&mut self, body_rate: &Vector3<T>, before: &Vector3<T>, after: &Vector3<T>) {
        let missed = self.body.correct(body_rate, before, after);
        let correction = missed.component_mul(&self.inertia) * self.body.gains.disturbance;
        self.body.take(correction, &mut self.estimate.torque);
    }
}
