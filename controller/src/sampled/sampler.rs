//! What stands between a law in continuous time and a computer: the compensator's ζ, the look
//! ahead, the actuators' model and the disturbance observers, stepped once a control period.
//!
//! Thrust and torque are held between samples, so a law evaluated at the sample acts half a period
//! late, and every error is first order in the period. Here it is evaluated for the middle of the
//! coming hold, at the state and ζ predicted from what is being applied, which makes it second
//! order. A known latency and a known rotor lag are absorbed by the same prediction, which looks
//! that much further: (11.1) to (11.4).

use model::{
    Command, Disturbance, OutOfRange, Real, State, Uav, Vehicle,
    dynamics::{Model, across, advance, turn},
};
use nalgebra::Vector3;

use crate::error::Refused;
use crate::law::compensator::{continuing, propagate};
use crate::law::lift::lift;
use crate::law::solution::Solution;
use crate::law::{Ahead, Law};
use crate::ranges::{LATENCY, MAX_THRUST, PERIOD, ROTOR_LAG};
use crate::sampled::actuator::{Actuation, ActuatorLimits, Actuators};
use crate::sampled::observer::{Observer, ObserverParams};

/// When the law is called and when its command acts.
///
/// ```
/// use controller::Sampling;
///
/// // 500 Hz, states 10 ms old when their command begins to act, motors of 30 ms.
/// let sampling = Sampling { latency: 0.01, rotor_lag: 0.03, ..Sampling::every(0.002_f32) };
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling<T> {
    /// Control period h, s.
    pub period: T,
    /// Known time from the state's sample to its command's start, s, at most
    /// [`MAX_DELAY`](crate::MAX_DELAY) periods.
    pub latency: T,
    /// Known time constant of the rotors' first-order lag, s.
    pub rotor_lag: T,
    /// Evaluate the law for when its command acts: `latency` + `rotor_lag` + h/2 ahead. Off, it is
    /// evaluated at the sample.
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
        PERIOD.check(self.period)?;
        LATENCY.check(self.latency)?;
        ROTOR_LAG.check(self.rotor_lag)
    }

    /// Half a period where the law looks ahead.
    pub(crate) fn half_hold(&self) -> T {
        if self.look_ahead { self.period * T::lit(0.5) } else { T::zero() }
    }

    /// From the sample to when the law is evaluated for.
    pub(crate) fn horizon(&self) -> T {
        if self.look_ahead { self.latency + self.rotor_lag + self.half_hold() } else { T::zero() }
    }
}

/// Time constant with which thrust and torque pass from what was applied before a take-over to the
/// law's, s.
const TAKE_OVER: f64 = 0.05;

/// What a sampled law remembers, whatever law it is: ζ, the commands on their way, the observers.
/// It is lent to one law at a time.
#[derive(Clone, Debug)]
pub struct Sampler<T, A = ActuatorLimits<T>> {
    memory: Memory<T>,
    actuation: A,
}

#[derive(Clone, Debug)]
struct Memory<T> {
    vehicle: Vehicle<T>,
    period: T,
    half_hold: T,
    horizon: T,
    /// ζ when the coming command begins to act: `horizon` − `half_hold` after the sample. What lies
    /// between needs no prediction, since the compensator is the law's own.
    zeta: [T; 4],
    u_zeta: T,
    /// The next command's step against what is being applied is to fade.
    is_softening: bool,
    /// What is left of such a step.
    bump: Command<T>,
    /// What a period leaves of it.
    fade: T,
    /// The last command's thrust was not what the actuators could apply.
    is_saturated: bool,
    /// The last command before its limits.
    asked: Command<T>,
    actuators: Actuators<T>,
    observer: Observer<T>,
}

impl<T: Real> Sampler<T> {
    /// At hover (ζ = 0), without limits or observers.
    pub(crate) fn new(vehicle: Vehicle<T>, sampling: &Sampling<T>) -> Result<Self, OutOfRange<T>> {
        sampling.check()?;
        let Sampling { period, latency, rotor_lag, .. } = *sampling;
        let horizon = sampling.horizon();
        let hover = Command::of_thrust(vehicle.hover_thrust());
        let memory = Memory {
            vehicle,
            period,
            half_hold: sampling.half_hold(),
            horizon,
            zeta: [T::zero(); 4],
            u_zeta: T::zero(),
            is_softening: false,
            bump: Command::zero(),
            fade: (-period / T::lit(TAKE_OVER)).exp(),
            is_saturated: false,
            asked: hover,
            actuators: Actuators::new(period, latency, rotor_lag, horizon, hover)?,
            observer: Observer::new(&vehicle, &ObserverParams::off(), period)?,
        };
        Ok(Self { memory, actuation: ActuatorLimits::none() })
    }
}

impl<T: Real, A: Actuation<T>> Sampler<T, A> {
    /// The same memory with another actuation, which must be able to hover.
    pub(crate) fn with_actuation<B: Actuation<T>>(self, actuation: B) -> Result<Sampler<T, B>, OutOfRange<T>> {
        actuation.check()?;
        let hover = self.memory.vehicle.hover_thrust();
        let (least, largest) = (actuation.least_thrust(), actuation.largest_thrust());
        OutOfRange::within("min_thrust", least, T::zero(), hover)?;
        OutOfRange::within("max_thrust", largest, hover, T::lit(MAX_THRUST.max))?;
        Ok(Sampler { memory: self.memory, actuation })
    }

    /// Changes what the actuators can apply, in flight too, where less than hover's thrust may be
    /// the truth.
    pub(crate) fn set_actuation(&mut self, actuation: A) -> Result<(), OutOfRange<T>> {
        actuation.check()?;
        self.actuation = actuation;
        Ok(())
    }

    pub(crate) fn set_observer(&mut self, params: &ObserverParams<T>) -> Result<(), OutOfRange<T>> {
        self.memory.observer = Observer::new(&self.memory.vehicle, params, self.memory.period)?;
        Ok(())
    }

    /// Asks `law` for its answer where its command acts.
    #[inline(always)]
    pub(crate) fn ask<L: Law<T>>(&self, law: &mut L, ahead: &Ahead<T>) {
        law.evaluate(&self.memory.vehicle, ahead, self.memory.observer.estimate());
    }

    /// Flies the answer of `law`: limits and sends its command, and moves on by a period.
    #[inline(always)]
    pub(crate) fn accept<L: Law<T>>(&mut self, law: &mut L) -> Command<T> {
        let Solution { command, u_zeta, margins, .. } = law.solution();
        let applied = self.commit(*command, *u_zeta, margins.q3 * margins.q_b3);
        law.accept(self.memory.period, self.memory.is_saturated);
        applied
    }

    /// Starts from a stated ζ; until the first command the thrust is (3.5) and the torque zero.
    pub(crate) fn start(&mut self, state: &State<T>, zeta: [T; 4]) -> Result<(), Refused> {
        state.check().map_err(Refused::State)?;
        if !zeta.iter().all(|z| z.is_finite()) {
            return Err(Refused::Zeta);
        }
        let thrust = lift(&self.memory.vehicle, state, &zeta, &Disturbance::none()).thrust(&self.memory.vehicle);
        // At a singularity (3.5) has no value, and what can't be applied was not applied.
        let thrust = if thrust.is_finite() { thrust } else { self.memory.vehicle.hover_thrust() };
        let applied = self.actuation.apply(&Command::of_thrust(thrust));
        self.reset(state, applied);
        self.memory.zeta = zeta;
        self.memory.u_zeta = T::zero();
        self.memory.is_softening = false;
        self.memory.bump = Command::zero();
        Ok(())
    }

    /// Takes over from whatever applied `applied` until now, with the ζ (11.8) that continues it
    /// and nothing known of disturbances.
    pub(crate) fn take_over(&mut self, state: &State<T>, applied: Command<T>) -> Result<(), Refused> {
        state.check().map_err(Refused::State)?;
        if !applied.is_finite() {
            return Err(Refused::Applied);
        }
        self.stand(state, applied);
        Ok(())
    }

    /// The same on a good state, with what the actuators apply.
    pub(crate) fn stand(&mut self, state: &State<T>, applied: Command<T>) {
        self.reset(state, applied);
        self.carry_on(state);
    }

    /// `applied` has been applied for long, wherever the vehicle is.
    pub(crate) fn rest(&mut self, applied: Command<T>) {
        self.memory.actuators.reset(applied);
    }

    /// Continues what is being applied, with the ζ that does. The first command's step against it
    /// fades.
    #[inline(never)]
    pub(crate) fn carry_on(&mut self, state: &State<T>) {
        let thrust = self.memory.actuators.applied().thrust;
        self.memory.zeta = continuing(&self.memory.vehicle, state, thrust, self.memory.observer.estimate());
        self.memory.u_zeta = T::zero();
        self.soften();
    }

    /// Has the next command's step against what is being applied fade.
    pub(crate) fn soften(&mut self) {
        self.memory.is_softening = true;
    }

    /// Lets a period pass without a usable state: the last command goes on.
    pub(crate) fn coast(&mut self) -> Command<T> {
        self.memory.zeta = propagate(&self.memory.zeta, self.memory.u_zeta, self.memory.period);
        let last = self.memory.actuators.sent(0);
        self.send(&last)
    }

    /// Limits and sends a command that does not come from a law.
    #[inline(never)]
    pub(crate) fn send(&mut self, command: &Command<T>) -> Command<T> {
        let applied = self.actuation.apply(command);
        self.memory.actuators.push(applied);
        applied
    }

    /// What acts up to this sample, as far as is known.
    pub fn applied(&self) -> &Command<T> {
        self.memory.actuators.applied()
    }

    /// Whether the last command was more than the actuators could apply.
    pub fn is_limited(&self) -> bool {
        self.memory.actuators.sent(0) != self.memory.asked
    }

    /// What turns commands into thrust and torque.
    pub fn actuation(&self) -> &A {
        &self.actuation
    }

    /// After periods without a usable state: the observers start from `state`, with their
    /// estimates.
    pub(crate) fn resume(&mut self, state: &State<T>) {
        self.memory.observer.restart(state);
    }

    fn reset(&mut self, state: &State<T>, applied: Command<T>) {
        self.memory.actuators.reset(applied);
        self.memory.observer.reset(state);
    }

    /// Before a sample with a cable that does not pull, of which the observers can make nothing:
    /// what they know, to be
    /// [kept](Self::keep) after it.
    #[cold]
    pub(crate) fn freeze(&mut self, sampled: &State<T>) -> Disturbance<T> {
        self.memory.observer.restart(sampled);
        *self.memory.observer.estimate()
    }

    #[cold]
    pub(crate) fn keep(&mut self, known: Disturbance<T>) {
        self.memory.observer.keep(known);
    }

    /// The UAV where its command acts: its own position and velocity, after the time that attitude
    /// and body rate look `ahead`.
    pub(crate) fn look_ahead(&self, uav: &Uav<T>, force: &Vector3<T>) -> Uav<T> {
        let Memory { vehicle, horizon, actuators, observer, .. } = &self.memory;
        let applied = actuators.applied();
        let b3: Vector3<T> = uav.attitude.column(2).into();
        let mut acceleration = force - b3 * (applied.thrust / vehicle.params().uav_mass);
        acceleration.z += vehicle.params().gravity;
        let (position, velocity) = advance(&uav.position, &uav.velocity, &acceleration, *horizon);
        let torque = applied.torque + observer.estimate().torque;
        let inertia = vehicle.inertia();
        let spin = (inertia.component_mul(&uav.body_rate).cross(&uav.body_rate) + torque)
            .component_mul(vehicle.inverse_inertia());
        let (attitude, body_rate) = turn(&uav.attitude, &uav.body_rate, &spin, *horizon);
        Uav { position, velocity, attitude, body_rate }
    }

    /// Ends a period with the state sampled now: corrects the observers and looks ahead.
    #[inline]
    pub(crate) fn sample(&mut self, sampled: &State<T>) -> Ahead<T> {
        let (dt, observer, actuators) = (self.memory.horizon, &mut self.memory.observer, &self.memory.actuators);
        let (applied, step, drift) = (actuators.applied(), actuators.step(), actuators.drift());
        let State { position, velocity, rod, rod_rate, attitude, body_rate } = sampled;
        let model = Model::at(&self.memory.vehicle, sampled);

        let (after, per_newton) = model.payload(applied.thrust, &observer.estimate().payload);
        observer.correct_payload(velocity, &(after + per_newton * step.thrust), &after);
        let (position, velocity) = advance(position, velocity, &(after + per_newton * drift.thrust), dt);

        let (after, per_newton) = model.rod(applied.thrust, &observer.estimate().rod);
        observer.correct_rod(rod, rod_rate, &(after + per_newton * step.thrust), &after);
        let (rod, rod_rate) = across(advance(rod, rod_rate, &(after + per_newton * drift.thrust), dt));

        let (after, per_newton_metre) = model.body(&applied.torque, &observer.estimate().torque);
        observer.correct_body(body_rate, &(after + per_newton_metre.component_mul(&step.torque)), &after);
        let mean = after + per_newton_metre.component_mul(&drift.torque);
        let (attitude, body_rate) = turn(attitude, body_rate, &mean, dt);

        let state = State { position, velocity, rod, rod_rate, attitude, body_rate };
        Ahead { state, horizon: dt, zeta: propagate(&self.memory.zeta, self.memory.u_zeta, self.memory.half_hold) }
    }

    /// Begins a period: limits `command`, sends it, and moves ζ over the coming hold by `u_zeta`.
    ///
    /// If the limit changed the thrust, ζ1 is corrected by (11.7) so that it is the vertical
    /// acceleration under the thrust actually applied. `alignment` = (q·e3)(q·b3).
    #[inline(never)]
    pub(crate) fn commit(&mut self, command: Command<T>, u_zeta: T, alignment: T) -> Command<T> {
        if self.memory.is_softening {
            self.memory.is_softening = false;
            self.memory.bump = self.memory.actuators.applied().minus(&command);
        }
        let smooth = command.plus(&self.memory.bump);
        self.memory.bump = self.memory.bump.times(self.memory.fade);
        let applied = self.send(&smooth);
        self.memory.is_saturated = applied.thrust != smooth.thrust;
        self.memory.asked = smooth;
        self.memory.zeta = propagate(&self.memory.zeta, u_zeta, self.memory.period);
        let missing = command.thrust - applied.thrust;
        self.memory.zeta[0] += missing * alignment * self.memory.vehicle.per_total_mass();
        self.memory.u_zeta = u_zeta;
        applied
    }

    /// ζ when the next command begins to act (the next sample, without latency and lag).
    pub fn zeta(&self) -> &[T; 4] {
        &self.memory.zeta
    }

    /// The disturbances found up to the last sample.
    pub fn disturbance(&self) -> &Disturbance<T> {
        self.memory.observer.estimate()
    }

    /// The vehicle as the law knows it.
    pub fn vehicle(&self) -> &Vehicle<T> {
        &self.memory.vehicle
    }

    /// The control period, s.
    pub fn period(&self) -> T {
        self.memory.period
    }
}
