//! What stands between a law in continuous time and a computer: the compensator's ζ, the look ahead, the actuators' model
//! and the disturbance observers, stepped once a control period.
//!
//! Thrust and torque are held between samples, so a law evaluated at the sample acts half a period late, and every error is first order
//! in the period. Here it is evaluated for the middle of the coming hold, at the state and ζ predicted from what is being applied, which
//! makes it second order. A known latency and a known rotor lag are absorbed by the same prediction: it looks that much further.

use model::{
    Command, Disturbance, OutOfRange, Real, State, Vehicle,
    dynamics::{Model, across, advance, turn},
};
use nalgebra::Vector3;

use crate::law::compensator::{continuing, propagate};
use crate::law::lift::lift;
use crate::sampled::actuator::{Actuation, ActuatorLimits, Actuators};
use crate::sampled::observer::{Observer, ObserverParams};

/// When the law is called and when its command acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling<T> {
    /// Control period h, s, 10⁻⁴ to 0.2.
    pub period: T,
    /// Known time from the state's sample to its command's start, s, at most [`MAX_DELAY`](crate::sampled::actuator::MAX_DELAY) periods.
    pub latency: T,
    /// Known time constant of the rotors' first-order lag, s, 0 to 0.5.
    pub rotor_lag: T,
    /// Evaluate the law for when its command acts: `latency` + `rotor_lag` + h/2 ahead. Off, it is evaluated at the sample.
    pub look_ahead: bool,
}

impl<T: Real> Sampling<T> {
    /// Every `period` s, no latency, no lag, looking ahead.
    pub fn every(period: T) -> Self {
        Self { period, latency: T::zero(), rotor_lag: T::zero(), look_ahead: true }
    }

    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Sampling<U> {
        Sampling {
            period: self.period.cast(),
            latency: self.latency.cast(),
            rotor_lag: self.rotor_lag.cast(),
            look_ahead: self.look_ahead,
        }
    }

    fn check(&self) -> Result<(), OutOfRange<T>> {
        OutOfRange::check("period", self.period, 1e-4, 0.2)?;
        OutOfRange::check("latency", self.latency, 0.0, 0.5)?;
        OutOfRange::check("rotor_lag", self.rotor_lag, 0.0, 0.5)
    }

    /// Half a period where the law looks ahead.
    fn half_hold(&self) -> T {
        if self.look_ahead { self.period * T::lit(0.5) } else { T::zero() }
    }

    /// From the sample to when the law is evaluated for.
    fn horizon(&self) -> T {
        if self.look_ahead { self.latency + self.rotor_lag + self.half_hold() } else { T::zero() }
    }
}

/// Time constant with which thrust and torque pass from what was applied before a take-over to the law's, s.
const TAKE_OVER: f64 = 0.05;

/// Where a law is to be evaluated: state and ζ at the instant its command acts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ahead<T> {
    pub(crate) state: State<T>,
    pub(crate) zeta: [T; 4],
}

/// The memory of a sampled law.
#[derive(Clone, Debug)]
pub struct Sampler<T, A = ActuatorLimits<T>> {
    vehicle: Vehicle<T>,
    period: T,
    half_hold: T,
    horizon: T,
    /// ζ when the coming command begins to act: `horizon` − `half_hold` after the sample. What lies between needs no
    /// prediction, since the compensator is the law's own.
    zeta: [T; 4],
    u_zeta: T,
    /// The next command's step against what is being applied is to fade.
    is_softening: bool,
    /// What is left of such a step.
    bump: Command<T>,
    /// What a period leaves of it.
    fade: T,
    actuation: A,
    /// The last command's thrust was not what the actuators could apply.
    is_saturated: bool,
    actuators: Actuators<T>,
    observer: Observer<T>,
}

impl<T: Real> Sampler<T> {
    /// At hover (ζ = 0), without limits or observers.
    pub(crate) fn new(vehicle: Vehicle<T>, sampling: &Sampling<T>) -> Result<Self, OutOfRange<T>> {
        sampling.check()?;
        let Sampling { period, latency, rotor_lag, .. } = *sampling;
        let horizon = sampling.horizon();
        let hover = Command { thrust: vehicle.hover_thrust(), torque: Vector3::zeros() };
        Ok(Self {
            vehicle,
            period,
            half_hold: sampling.half_hold(),
            horizon,
            zeta: [T::zero(); 4],
            u_zeta: T::zero(),
            is_softening: false,
            bump: Command::zero(),
            fade: (-period / T::lit(TAKE_OVER)).exp(),
            actuation: ActuatorLimits::none(),
            is_saturated: false,
            actuators: Actuators::new(period, latency, rotor_lag, horizon, hover)?,
            observer: Observer::new(&vehicle, &ObserverParams::off(), period)?,
        })
    }
}

impl<T: Real, A: Actuation<T>> Sampler<T, A> {
    /// The same memory with another actuation.
    pub(crate) fn with_actuation<B: Actuation<T>>(self, actuation: B) -> Result<Sampler<T, B>, OutOfRange<T>> {
        actuation.check()?;
        let Self {
            vehicle,
            period,
            half_hold,
            horizon,
            zeta,
            u_zeta,
            is_softening,
            bump,
            fade,
            is_saturated,
            actuators,
            observer,
            ..
        } = self;
        Ok(Sampler {
            vehicle,
            period,
            half_hold,
            horizon,
            zeta,
            u_zeta,
            is_softening,
            bump,
            fade,
            actuation,
            is_saturated,
            actuators,
            observer,
        })
    }

    pub(crate) fn set_actuation(&mut self, actuation: A) -> Result<(), OutOfRange<T>> {
        actuation.check()?;
        self.actuation = actuation;
        Ok(())
    }

    pub(crate) fn set_observer(&mut self, params: &ObserverParams<T>) -> Result<(), OutOfRange<T>> {
        self.observer = Observer::new(&self.vehicle, params, self.period)?;
        Ok(())
    }

    /// Starts from a stated ζ; until the first command the thrust is (9) and the torque zero.
    pub(crate) fn start(&mut self, state: &State<T>, zeta: [T; 4]) {
        let thrust = lift(&self.vehicle, state, &zeta, &Disturbance::none()).thrust(&self.vehicle);
        // At a singularity (9) says nothing, and what can't be applied was not.
        let thrust = if thrust.is_finite() { thrust } else { self.vehicle.hover_thrust() };
        let applied = self.actuation.apply(&Command { thrust, torque: Vector3::zeros() });
        self.reset(state, applied);
        self.zeta = zeta;
        self.u_zeta = T::zero();
        self.is_softening = false;
        self.bump = Command::zero();
    }

    /// Takes over from whatever applied `applied` until now, with the ζ that continues it and nothing known of disturbances.
    pub(crate) fn take_over(&mut self, state: &State<T>, applied: Command<T>) {
        self.reset(state, applied);
        self.carry_on(state);
    }

    /// Continues what is being applied, with the ζ that does. The first command's step against it fades.
    #[inline(never)]
    pub(crate) fn carry_on(&mut self, state: &State<T>) {
        let thrust = self.actuators.applied().thrust;
        self.zeta = continuing(&self.vehicle, state, thrust, self.observer.estimate());
        self.u_zeta = T::zero();
        self.soften();
    }

    /// Has the next command's step against what is being applied fade.
    pub(crate) fn soften(&mut self) {
        self.is_softening = true;
    }

    /// Lets a period pass without a usable state: the last command goes on.
    pub(crate) fn coast(&mut self) -> Command<T> {
        self.zeta = propagate(&self.zeta, self.u_zeta, self.period);
        let last = self.actuators.sent(0);
        self.send(&last)
    }

    /// Limits and sends a command that is no law's.
    #[inline(never)]
    pub(crate) fn send(&mut self, command: &Command<T>) -> Command<T> {
        let applied = self.actuation.apply(command);
        self.actuators.push(applied);
        applied
    }

    /// What acts up to this sample, as far as is known.
    pub(crate) fn applied(&self) -> &Command<T> {
        self.actuators.applied()
    }

    pub(crate) fn actuation(&self) -> &A {
        &self.actuation
    }

    /// The last command's thrust was not what the actuators could apply.
    pub(crate) fn is_saturated(&self) -> bool {
        self.is_saturated
    }

    /// After periods without a usable state: the observers start from `state`, with their estimates.
    pub(crate) fn resume(&mut self, state: &State<T>) {
        self.observer.restart(state);
    }

    fn reset(&mut self, state: &State<T>, applied: Command<T>) {
        self.actuators.reset(applied);
        self.observer.reset(state);
    }

    /// Ends a period with the state sampled now: corrects the observers and looks ahead.
    #[inline]
    pub(crate) fn sample(&mut self, sampled: &State<T>) -> Ahead<T> {
        let (dt, observer, actuators) = (self.horizon, &mut self.observer, &self.actuators);
        let (applied, step, drift) = (actuators.applied(), actuators.step(), actuators.drift());
        let State { position, velocity, rod, rod_rate, attitude, body_rate } = sampled;
        let model = Model::at(&self.vehicle, sampled);

        let (left, per_newton) = model.payload(applied.thrust, &observer.estimate().payload);
        observer.correct_payload(velocity, &(left + per_newton * step.thrust), &left);
        let (position, velocity) = advance(position, velocity, &(left + per_newton * drift.thrust), dt);

        let (left, per_newton) = model.rod(applied.thrust, &observer.estimate().rod);
        observer.correct_rod(rod, rod_rate, &(left + per_newton * step.thrust), &left);
        let (rod, rod_rate) = across(advance(rod, rod_rate, &(left + per_newton * drift.thrust), dt));

        let (left, per_newton_metre) = model.body(&applied.torque, &observer.estimate().torque);
        observer.correct_body(body_rate, &(left + per_newton_metre.component_mul(&step.torque)), &left);
        let mean = left + per_newton_metre.component_mul(&drift.torque);
        let (attitude, body_rate) = turn(attitude, body_rate, &mean, dt);

        let state = State { position, velocity, rod, rod_rate, attitude, body_rate };
        Ahead { state, zeta: propagate(&self.zeta, self.u_zeta, self.half_hold) }
    }

    /// Begins a period: limits `command`, sends it, and moves ζ over the coming hold by `u_zeta`.
    ///
    /// Where the limit changes the thrust, ζ1 moves by what (9) makes of the difference with `alignment` = (q·e3)(q·b3), so that the compensator stands for the motion
    /// that the applied thrust gives.
    #[inline(never)]
    pub(crate) fn commit(&mut self, command: Command<T>, u_zeta: T, alignment: T) -> Command<T> {
        if self.is_softening {
            self.is_softening = false;
            self.bump = self.actuators.applied().minus(&command);
        }
        let smooth = command.plus(&self.bump);
        self.bump = self.bump.times(self.fade);
        let applied = self.send(&smooth);
        self.is_saturated = applied.thrust != smooth.thrust;
        self.zeta = propagate(&self.zeta, u_zeta, self.period);
        let missing = command.thrust - applied.thrust;
        self.zeta[0] += missing * alignment * self.vehicle.per_total_mass();
        self.u_zeta = u_zeta;
        applied
    }

    /// ζ when the next command begins to act.
    pub(crate) fn zeta(&self) -> &[T; 4] {
        &self.zeta
    }

    pub(crate) fn disturbance(&self) -> &Disturbance<T> {
        self.observer.estimate()
    }

    pub(crate) fn vehicle(&self) -> &Vehicle<T> {
        &self.vehicle
    }

    pub(crate) fn period(&self) -> T {
        self.period
    }

    pub(crate) fn horizon(&self) -> T {
        self.horizon
    }
}
