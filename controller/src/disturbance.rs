//! What the model leaves out, and the observers that find it.
//!
//! The law stands on model (1), in which nothing corrects ζ1 = v̇3: wind, a wrong mass or a weak rotor make it miss by decimetres.
//! Extended by an unknown specific force d on the payload, an unknown acceleration δ of the rod's direction and an
//! unknown torque, all slow, the model is
//!
//! ```text
//! v̇ = g e3 + d + λ q,   q̈ = κ b3 + c λ q + δ,   κ (b3·q) = −(|q̇|² + c λ + δ·q),   J ω̇ = J ω × ω + τ + τ_d
//! ```
//!
//! which can stand for wind on either body, wrong masses and wrong thrust alike. Each is found by a linear observer of two states an
//! axis, v̂˙ = model + d̂ + 2 o (v − v̂), d̂˙ = o² (v − v̂), discretized with both poles at e^(−o h). Along the rod d and δ
//! act alike, so δ̂ is kept orthogonal to q.

use nalgebra::Vector3;

use crate::error::OutOfRange;
use crate::model::Acceleration;
use crate::scalar::Real;
use crate::state::State;
use crate::vehicle::Vehicle;

/// Unmodelled effects, held constant over a Taylor series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disturbance<T> {
    /// d, specific force on the payload in N, m/s².
    pub payload: Vector3<T>,
    /// δ, acceleration of the rod's direction in N, 1/s².
    pub rod: Vector3<T>,
    /// Torque on the UAV in body axes, N·m.
    pub torque: Vector3<T>,
}

impl<T: Real> Disturbance<T> {
    /// None: the paper's model.
    pub fn none() -> Self {
        Self { payload: Vector3::zeros(), rod: Vector3::zeros(), torque: Vector3::zeros() }
    }

    /// Force on the payload in N (frame), N (newton): m_L d.
    pub fn payload_force(&self, vehicle: &Vehicle<T>) -> Vector3<T> {
        self.payload * vehicle.params().payload_mass
    }

    /// Force on the UAV in N (frame), N (newton): m_Q (d − L δ), since δ = (F_L/m_L − F_Q/m_Q)/L.
    pub fn uav_force(&self, vehicle: &Vehicle<T>) -> Vector3<T> {
        let params = vehicle.params();
        (self.payload - self.rod * params.rod_length) * params.uav_mass
    }

    /// The payload mass, kg, that would explain d in still air, with `lambda` (m/s²) the payload's specific force along
    /// `rod` without d: the rod's tension is shared as M λ, so M = M₀ λ/(λ + d·q).
    pub fn implied_payload_mass(&self, vehicle: &Vehicle<T>, rod: &Vector3<T>, lambda: T) -> T {
        let total = vehicle.total_mass() * lambda / (lambda + self.payload.dot(rod));
        (total - vehicle.params().uav_mass).max(T::zero())
    }
}

/// Observer bandwidths o, rad/s, and the bounds of what they may find. A bandwidth of zero switches an observer off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObserverParams<T> {
    /// Of d̂, rad/s.
    pub payload_bandwidth: T,
    /// Of δ̂, rad/s.
    pub rod_bandwidth: T,
    /// Of τ̂_d, rad/s.
    pub torque_bandwidth: T,
    /// Bound of each component of d̂, m/s².
    pub payload_bound: T,
    /// Bound of each component of δ̂, 1/s².
    pub rod_bound: T,
    /// Bound of each component of τ̂_d, N·m.
    pub torque_bound: T,
}

impl<T: Real> ObserverParams<T> {
    /// All off.
    pub fn off() -> Self {
        Self::with_bandwidth(T::zero())
    }

    /// The same `bandwidth`, rad/s, for all three, with bounds of 1.5 g, 1 g/m and 1 N·m.
    pub fn with_bandwidth(bandwidth: T) -> Self {
        Self {
            payload_bandwidth: bandwidth,
            rod_bandwidth: bandwidth,
            torque_bandwidth: bandwidth,
            payload_bound: T::lit(15.0),
            rod_bound: T::lit(10.0),
            torque_bound: T::one(),
        }
    }

    fn check(&self) -> Result<(), OutOfRange<T>> {
        OutOfRange::check("payload_bandwidth", self.payload_bandwidth, 0.0, 100.0)?;
        OutOfRange::check("rod_bandwidth", self.rod_bandwidth, 0.0, 100.0)?;
        OutOfRange::check("torque_bandwidth", self.torque_bandwidth, 0.0, 100.0)?;
        OutOfRange::check("payload_bound", self.payload_bound, 0.0, 1e3)?;
        OutOfRange::check("rod_bound", self.rod_bound, 0.0, 1e3)?;
        OutOfRange::check("torque_bound", self.torque_bound, 0.0, 1e3)
    }
}

/// One observer: a velocity's prediction, and the gains that correct it and the disturbance.
#[derive(Clone, Copy, Debug)]
struct Channel<T> {
    /// 1 − p² with both poles at p = e^(−o h).
    velocity_gain: T,
    /// (1 − p)²/h, times the inertia where the disturbance is a torque.
    disturbance_gain: Vector3<T>,
    bound: T,
    /// The velocity predicted up to the middle of the running period's trapezoid.
    predicted: Vector3<T>,
}

impl<T: Real> Channel<T> {
    fn new(bandwidth: T, bound: T, period: T, inertia: Vector3<T>) -> Self {
        let pole = (-bandwidth * period).exp();
        let gap = T::one() - pole;
        Self {
            velocity_gain: gap * (T::one() + pole),
            disturbance_gain: inertia * (gap * gap / period),
            bound,
            predicted: Vector3::zeros(),
        }
    }

    /// Ends the period that began at the last [`predict`](Self::predict): corrects velocity and `disturbance` by what
    /// was measured.
    #[inline]
    fn correct(
        &mut self,
        measured: &Vector3<T>,
        acceleration: &Vector3<T>,
        half_period: T,
        disturbance: &mut Vector3<T>,
    ) {
        let predicted = self.predicted + acceleration * half_period;
        let innovation = measured - predicted;
        let found = *disturbance + innovation.component_mul(&self.disturbance_gain);
        *disturbance = found.map(|x| x.clamp(-self.bound, self.bound));
        self.predicted = predicted + innovation * self.velocity_gain;
    }

    /// Begins the next period.
    #[inline]
    fn predict(&mut self, acceleration: &Vector3<T>, half_period: T) {
        self.predicted += acceleration * half_period;
    }
}

/// The three observers and their estimate.
#[derive(Clone, Copy, Debug)]
pub struct Observer<T> {
    payload: Channel<T>,
    rod: Channel<T>,
    body: Channel<T>,
    half_period: T,
    estimate: Disturbance<T>,
}

impl<T: Real> Observer<T> {
    pub(crate) fn new(vehicle: &Vehicle<T>, params: &ObserverParams<T>, period: T) -> Result<Self, OutOfRange<T>> {
        params.check()?;
        let ones = Vector3::repeat(T::one());
        Ok(Self {
            payload: Channel::new(params.payload_bandwidth, params.payload_bound, period, ones),
            rod: Channel::new(params.rod_bandwidth, params.rod_bound, period, ones),
            body: Channel::new(params.torque_bandwidth, params.torque_bound, period, vehicle.inertia),
            half_period: period * T::lit(0.5),
            estimate: Disturbance::none(),
        })
    }

    /// Forgets every estimate; the velocities are those of `state`, and its period begins with `acceleration`.
    pub(crate) fn reset(&mut self, state: &State<T>, acceleration: &Acceleration<T>) {
        self.estimate = Disturbance::none();
        self.payload.predicted = state.velocity;
        self.rod.predicted = state.rod_rate;
        self.body.predicted = state.body_rate;
        self.predict(acceleration);
    }

    /// What has been found up to now.
    pub fn estimate(&self) -> &Disturbance<T> {
        &self.estimate
    }

    /// Ends a period with the measured `state` and the model's `acceleration` there, under what was applied until now.
    #[inline]
    pub(crate) fn correct(&mut self, state: &State<T>, acceleration: &Acceleration<T>) {
        let half_period = self.half_period;
        let Disturbance { payload, rod, torque } = &mut self.estimate;
        self.payload.correct(&state.velocity, &acceleration.payload, half_period, payload);
        self.rod.correct(&state.rod_rate, &acceleration.rod, half_period, rod);
        self.body.correct(&state.body_rate, &acceleration.body, half_period, torque);
        *rod -= state.rod * state.rod.dot(rod);
    }

    /// Begins a period with the model's `acceleration` under what is applied from now on.
    #[inline]
    pub(crate) fn predict(&mut self, acceleration: &Acceleration<T>) {
        self.payload.predict(&acceleration.payload, self.half_period);
        self.rod.predict(&acceleration.rod, self.half_period);
        self.body.predict(&acceleration.body, self.half_period);
    }
}
