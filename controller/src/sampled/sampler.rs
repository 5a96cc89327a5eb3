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
    dynamics::{Model, across, advance, lambda, pass, turn},
};
use nalgebra::Vector3;

use crate::error::Refused;
use crate::law::compensator::{continuing, propagate};
use crate::law::hold::Swing;
use crate::law::lift::lift;
use crate::law::solution::Answer;
use crate::law::{Ahead, Law};
use crate::ranges::MAX_THRUST;
use crate::sampled::actuator::{Actuation, ActuatorLimits, Actuators};
use crate::sampled::bounce::{Bounce, Seen, slowest};
use crate::sampled::observer::{Observer, ObserverParams};
use crate::sampled::weight::Weight;
use crate::sampling::Sampling;

/// Time constant with which thrust and torque pass from what was applied before a take-over to the
/// law's, s.
const TAKE_OVER: f64 = 0.05;
/// What is left of the step when it counts as passed, N and N·m: less than thrust is rounded to.
const FADED: f64 = 1e-9;

/// What a sampled law remembers, whatever law it is: ζ, the commands on their way, the observers.
/// It is lent to one law at a time.
#[derive(Clone, Debug)]
pub struct Sampler<T, A = ActuatorLimits<T>> {
    memory: Memory<T>,
    actuation: A,
}

// In this order: an instruction reaches a kilobyte from a pointer, and what every step needs comes
// before what is large.
#[derive(Clone, Debug)]
#[repr(C)]
struct Memory<T> {
    /// As it was told, and with all mass as it is implied.
    vehicle: Vehicle<T>,
    weighed: Vehicle<T>,
    weight: Weight<T>,
    bounce: Bounce<T>,
    period: T,
    half_hold: T,
    /// What of the horizon comes after the commands in flight.
    rest: T,
    /// The last state, sampled or carried.
    last: State<T>,
    /// Where the coming command acts, as seen from there.
    ahead: Ahead<T>,
    /// The disturbance at the horizon, where there are commands in flight.
    expected: Option<Disturbance<T>>,
    /// ζ when the coming command begins to act: `horizon` − `half_hold` after the sample. What lies
    /// between needs no prediction, since the compensator is the law's own.
    zeta: [T; 4],
    u_zeta: T,
    bump: Bump<T>,
    /// What a period leaves of it.
    fade: T,
    /// The last command's thrust was not what the actuators could apply.
    is_saturated: bool,
    /// The last command before its limits.
    asked: Command<T>,
    observer: Observer<T>,
    actuators: Actuators<T>,
}

/// A command's step against what was applied before the law took over, which fades.
#[derive(Clone, Copy, Debug)]
enum Bump<T> {
    None,
    /// The next command's step is to.
    Coming,
    /// What is left.
    Fading(Command<T>),
}

impl<T: Real> Sampler<T> {
    /// At hover (ζ = 0), without limits or observers.
    pub(crate) fn new(vehicle: Vehicle<T>, sampling: &Sampling<T>) -> Result<Self, OutOfRange<T>> {
        sampling.check()?;
        let Sampling { period, latency, rotor_lag, .. } = *sampling;
        let horizon = sampling.horizon();
        let last = State::at_rest(Vector3::zeros());
        let hover = Command::of_thrust(vehicle.hover_thrust());
        let actuators = Actuators::new(period, latency, rotor_lag, horizon, hover)?;
        let memory = Memory {
            vehicle,
            weighed: vehicle,
            weight: Weight::told(),
            bounce: Bounce::none(&vehicle),
            period,
            half_hold: sampling.half_hold(),
            rest: if sampling.look_ahead { horizon - actuators.latency(period) } else { T::zero() },
            last,
            ahead: Ahead { state: last, zeta: [T::zero(); 4], horizon },
            expected: (sampling.look_ahead && actuators.is_late()).then(Disturbance::none),
            zeta: [T::zero(); 4],
            u_zeta: T::zero(),
            bump: Bump::None,
            fade: (-period / T::lit(TAKE_OVER)).exp(),
            is_saturated: false,
            asked: hover,
            actuators,
            observer: Observer::new(&vehicle, &ObserverParams::off(), period),
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
        params.check()?;
        let Memory { vehicle, period, actuators, expected, observer, .. } = &mut self.memory;
        // What is not looked ahead over is no latency to the law.
        let latency = if expected.is_some() { actuators.latency(*period) } else { T::zero() };
        *observer = Observer::new(vehicle, &params.behind(latency), *period);
        Ok(())
    }

    /// Asks `law` for its answer where its command acts.
    #[inline(always)]
    pub(crate) fn ask<L: Law<T>>(&self, law: &mut L) {
        let Memory { weighed, observer, expected, ahead, .. } = &self.memory;
        law.evaluate(weighed, ahead, expected.as_ref().unwrap_or(observer.estimate()));
    }

    /// Flies the answer of `law`: limits and sends its command, and moves on by a period.
    #[inline(always)]
    pub(crate) fn accept<L: Law<T>>(&mut self, law: &mut L) -> Command<T> {
        let Answer { command, u_zeta, margins, .. } = law.answer();
        self.weigh(margins.lambda);
        let applied = self.commit(command, *u_zeta, margins.q3 * margins.q_b3);
        law.accept(self.memory.period, self.memory.is_saturated);
        applied
    }

    /// Learns from λ without d what everything weighs, and flies on that.
    #[inline(always)]
    fn weigh(&mut self, lambda: T) {
        let Memory { vehicle, weighed, weight, bounce, observer, last, period, .. } = &mut self.memory;
        let was_known = weight.is_known();
        let share = weight.learn(lambda, observer.estimate().payload.dot(&last.rod), *period);
        weighed.weigh(vehicle, share);
        let is_found = weight.is_known() && !was_known;
        if bounce.look(weight.implied(), *period) {
            self.see_bounce(lambda);
        }
        if is_found {
            self.unburden();
        }
    }

    /// Whether a bounce on the cable has just been seen by what is not the law's: the observers
    /// then follow it no more.
    #[cold]
    #[inline(never)]
    pub(crate) fn has_bounced(&mut self) -> bool {
        let Memory { weighed, weight, bounce, observer, last, actuators, period, .. } = &mut self.memory;
        let lambda = lambda(weighed, last, actuators.applied().thrust);
        let implied = weight.imply(lambda, observer.estimate().payload.dot(&last.rod));
        bounce.look(implied, *period) && self.see_bounce(lambda)
    }

    /// What there is to be seen of a bounce on the cable. After one the observers are no faster along
    /// the rod than it allows, and begin at its mean. Whether there was one.
    #[cold]
    #[inline(never)]
    fn see_bounce(&mut self, lambda: T) -> bool {
        let Memory { vehicle, weight, bounce, observer, last, .. } = &mut self.memory;
        match bounce.see(vehicle) {
            Seen::Crossing => {}
            Seen::Calm => observer.hasten(),
            Seen::Bounce(frequency) => {
                observer.yield_to(frequency, &last.rod, weight.along(bounce.mean(), lambda));
                return true;
            }
        }
        false
    }

    /// What everything weighs has just been found: the observers need not hold it up any more. Held
    /// up twice, a load of twice the mass that was told would be thrown up by as much as it weighs.
    #[cold]
    #[inline(never)]
    fn unburden(&mut self) {
        let Memory { vehicle, weighed, last, actuators, observer, .. } = &mut self.memory;
        let thrust = actuators.applied().thrust;
        let mut known = *observer.estimate();
        known.payload += last.rod * (lambda(vehicle, last, thrust) - lambda(weighed, last, thrust));
        observer.keep(known);
    }

    /// Starts from a stated ζ; until the first command the thrust is (3.5) and the torque zero.
    pub(crate) fn start(&mut self, state: &State<T>, zeta: [T; 4]) -> Result<(), Refused> {
        state.check().map_err(Refused::State)?;
        if !zeta.iter().all(|z| z.is_finite()) {
            return Err(Refused::Zeta);
        }
        let vehicle = &self.memory.vehicle;
        let thrust = lift(vehicle, state, &zeta, &Disturbance::none()).thrust(vehicle);
        // At a singularity (3.5) has no value, and what can't be applied was not applied.
        let thrust = if thrust.is_finite() { thrust } else { vehicle.hover_thrust() };
        let applied = self.actuation.apply(&Command::of_thrust(thrust));
        self.reset(state, applied);
        self.memory.zeta = zeta;
        self.memory.u_zeta = T::zero();
        self.memory.bump = Bump::None;
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
        self.memory.zeta = self.continued(state);
        self.memory.u_zeta = T::zero();
        self.soften();
    }

    /// A law begins to fly. Along the rod it starts from the usual, where hold has found that, and
    /// follows slowly until no bounce on the cable has been seen for a while: it would have grown too
    /// large by then.
    #[cold]
    #[inline(never)]
    pub(crate) fn join(&mut self, state: &State<T>) {
        let Memory { vehicle, weighed, weight, bounce, observer, last, actuators, .. } = &mut self.memory;
        if bounce.has_mean() {
            let lambda = lambda(weighed, last, actuators.applied().thrust);
            observer.slow(slowest(vehicle), &last.rod, weight.along(bounce.mean(), lambda));
        }
        self.carry_on(state);
    }

    /// No law flies any more: the next command's step fades, and what was not learnt yet is
    /// forgotten.
    pub(crate) fn leave(&mut self) {
        self.memory.weight.leave();
        self.soften();
    }

    /// The ζ (11.8) that continues what is being applied.
    #[inline(never)]
    pub(crate) fn continued(&self, state: &State<T>) -> [T; 4] {
        let Memory { weighed, observer, actuators, .. } = &self.memory;
        continuing(weighed, state, actuators.arriving().thrust, observer.estimate())
    }

    /// Has the next command's step against what is being applied fade.
    fn soften(&mut self) {
        self.memory.bump = Bump::Coming;
    }

    /// The bandwidth, rad/s, that the cable allows along itself.
    pub(crate) fn most_along(&self) -> T {
        self.memory.observer.most_along()
    }

    /// What everything weighs.
    #[inline]
    pub(crate) fn weight(&self) -> &Weight<T> {
        &self.memory.weight
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
        self.memory.actuators.push(&applied);
        applied
    }

    /// What acts up to this sample, as far as is known.
    pub fn applied(&self) -> &Command<T> {
        self.memory.actuators.applied()
    }

    /// Whether the last command was more than the actuators could apply.
    pub fn is_limited(&self) -> bool {
        let (sent, asked) = (self.memory.actuators.sent(0), &self.memory.asked);
        // One by one: together they would be compared to the end.
        sent.thrust != asked.thrust
            || sent.torque.x != asked.torque.x
            || sent.torque.y != asked.torque.y
            || sent.torque.z != asked.torque.z
    }

    /// What turns commands into thrust and torque.
    pub fn actuation(&self) -> &A {
        &self.actuation
    }

    /// After periods without a usable state: the observers start from `state`, with their
    /// estimates.
    pub(crate) fn resume(&mut self, state: &State<T>) {
        self.memory.observer.restart(state);
        // What was implied before may have been of a slack cable, or of a rod that was not known.
        self.memory.bounce = Bounce::none(&self.memory.vehicle);
    }

    /// The state now by the model, where none was sampled: what the last one has become in a
    /// period under what acted.
    #[cold]
    pub(crate) fn carry(&self) -> State<T> {
        let Memory { weighed, period, last, actuators, observer, .. } = &self.memory;
        let (mut state, mut known) = (*last, *observer.estimate());
        pass(weighed, &mut state, &mut known, &actuators.mean(), *period);
        state
    }

    fn reset(&mut self, state: &State<T>, applied: Command<T>) {
        self.memory.last = *state;
        (self.memory.weighed, self.memory.weight) = (self.memory.vehicle, Weight::told());
        self.memory.bounce = Bounce::none(&self.memory.vehicle);
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

    /// Corrects the torque alone, by the `body_rate` of a UAV whose load is not known.
    #[cold]
    pub(crate) fn sample_body(&mut self, body_rate: &Vector3<T>) {
        let Memory { weighed, last, observer, actuators, .. } = &mut self.memory;
        let turned = State { body_rate: *body_rate, ..*last };
        let (after, per_newton_metre) =
            Model::at(weighed, &turned).body(&actuators.applied().torque, &observer.estimate().torque);
        let before = after + per_newton_metre.component_mul(&actuators.step().torque);
        observer.correct_body(body_rate, &before, &after);
    }

    /// The torque found, N·m, in body axes.
    pub(crate) fn torque(&self) -> &Vector3<T> {
        &self.memory.observer.estimate().torque
    }

    /// What hangs from the UAV, as it was sampled last.
    pub(crate) fn swing(&self) -> Swing<T> {
        let Memory { vehicle, last, observer, .. } = &self.memory;
        Swing::of(vehicle, last, &observer.estimate().payload)
    }

    /// Moves the UAV to where its command acts: its own position and velocity, after the time that
    /// attitude and body rate look `ahead`.
    pub(crate) fn look_ahead(&self, uav: &mut Uav<T>, force: &Vector3<T>) {
        let mut acting = *self.memory.actuators.applied();
        for index in 0..self.memory.actuators.legs() {
            let (time, mean) = self.leg(index, &mut acting);
            self.pass_uav(uav, force, &mean, time);
        }
    }

    /// A leg's time, s, and the mean of what acts in it. The last goes on to where the law's answer
    /// is for, under what acts when the coming command begins to.
    #[inline(never)]
    fn leg(&self, index: usize, acting: &mut Command<T>) -> (T, Command<T>) {
        let Memory { period, rest, actuators, .. } = &self.memory;
        let (periods, sum) = actuators.leg(index, acting);
        let (flown, given) = (periods * *period, sum.times(*period));
        let rest = if index + 1 < actuators.legs() { T::zero() } else { *rest };
        let coming = actuators.arriving().plus(actuators.drift());
        let time = flown + rest;
        let mean = if time > T::zero() { given.plus(&coming.times(rest)).times(T::one() / time) } else { coming };
        (time, mean)
    }

    /// Moves the UAV by `dt` under a held `command` and what pulls at it, m/s².
    #[inline(never)]
    fn pass_uav(&self, uav: &mut Uav<T>, force: &Vector3<T>, command: &Command<T>, dt: T) {
        let Memory { vehicle, observer, .. } = &self.memory;
        let (halfway, _) = turn(&uav.attitude, &uav.body_rate, &Vector3::zeros(), dt * T::lit(0.5));
        let b3: Vector3<T> = halfway.column(2).into();
        let mut acceleration = force - b3 * (command.thrust / vehicle.params().uav_mass);
        acceleration.z += vehicle.params().gravity;
        (uav.position, uav.velocity) = advance(&uav.position, &uav.velocity, &acceleration, dt);
        let torque = command.torque + observer.estimate().torque;
        let inertia = vehicle.inertia();
        let spin = (inertia.component_mul(&uav.body_rate).cross(&uav.body_rate) + torque)
            .component_mul(vehicle.inverse_inertia());
        (uav.attitude, uav.body_rate) = turn(&uav.attitude, &uav.body_rate, &spin, dt);
    }

    /// Ends a period with the state sampled now: corrects the observers and looks ahead.
    #[inline(never)]
    pub(crate) fn sample(&mut self, sampled: &State<T>) {
        let Memory { weighed, last, ahead, rest, observer, actuators, zeta, u_zeta, half_hold, .. } =
            &mut self.memory;
        remember(last, sampled);
        let (dt, applied, step, drift) = (*rest, actuators.applied(), actuators.step(), actuators.drift());
        let State { position, velocity, rod, rod_rate, attitude, body_rate } = sampled;
        let (model, to) = (Model::at(weighed, sampled), &mut ahead.state);

        let (after, per_newton) = model.payload(applied.thrust, &observer.estimate().payload);
        observer.correct_payload(rod, velocity, &(after + rod * (per_newton * step.thrust)), &after);
        (to.position, to.velocity) = advance(position, velocity, &(after + rod * (per_newton * drift.thrust)), dt);

        let (after, per_newton) = model.rod(applied.thrust, &observer.estimate().rod);
        observer.correct_rod(rod, rod_rate, &(after + per_newton * step.thrust), &after);
        (to.rod, to.rod_rate) = across(advance(rod, rod_rate, &(after + per_newton * drift.thrust), dt));

        let (after, per_newton_metre) = model.body(&applied.torque, &observer.estimate().torque);
        observer.correct_body(body_rate, &(after + per_newton_metre.component_mul(&step.torque)), &after);
        let mean = after + per_newton_metre.component_mul(&drift.torque);
        (to.attitude, to.body_rate) = turn(attitude, body_rate, &mean, dt);

        ahead.zeta = propagate(zeta, *u_zeta, *half_hold);
        if self.memory.expected.is_some() {
            self.fly_through(sampled);
        }
    }

    /// The state ahead, through the commands in flight: the model, and the disturbances at their
    /// rates, in a fixed number of steps (11.10).
    #[cold]
    fn fly_through(&mut self, sampled: &State<T>) {
        let (mut known, mut acting) = (*self.memory.observer.estimate(), *self.memory.actuators.applied());
        self.memory.ahead.state = *sampled;
        for index in 0..self.memory.actuators.legs() {
            let (time, mean) = self.leg(index, &mut acting);
            let Memory { weighed, ahead, .. } = &mut self.memory;
            pass(weighed, &mut ahead.state, &mut known, &mean, time);
        }
        self.memory.expected = Some(known);
    }

    /// Begins a period: limits `command`, sends it, and moves ζ over the coming hold by `u_zeta`.
    ///
    /// If the limit changed the thrust, ζ1 is corrected by (11.7) so that it is the vertical
    /// acceleration under the thrust actually applied; not for a step that fades, by which the next
    /// command would be off again. `alignment` = (q·e3)(q·b3).
    #[inline(never)]
    pub(crate) fn commit(&mut self, command: &Command<T>, u_zeta: T, alignment: T) -> Command<T> {
        self.memory.asked = if let Bump::None = self.memory.bump { *command } else { self.smoothed(command) };
        let Memory { actuators, asked, is_saturated, .. } = &mut self.memory;
        let led = actuators.led(asked);
        let wanted = led.as_ref().unwrap_or(asked);
        let applied = self.actuation.apply(wanted);
        let acting = actuators.unled(&applied).thrust;
        *is_saturated = applied.thrust != wanted.thrust;
        actuators.push(&applied);
        self.memory.zeta = propagate(&self.memory.zeta, u_zeta, self.memory.period);
        let missing = self.memory.asked.thrust - acting;
        self.memory.zeta[0] += missing * alignment * self.memory.weighed.per_total_mass();
        self.memory.u_zeta = u_zeta;
        applied
    }

    /// `command` with what is left of its step against what was applied before.
    #[cold]
    fn smoothed(&mut self, command: &Command<T>) -> Command<T> {
        let Memory { bump, fade, actuators, .. } = &mut self.memory;
        let left = match *bump {
            Bump::None => return *command,
            Bump::Coming => actuators.arriving().minus(command),
            Bump::Fading(left) => left,
        };
        let next = left.times(*fade);
        *bump = if next.is_below(T::lit(FADED)) { Bump::None } else { Bump::Fading(next) };
        command.plus(&left)
    }

    /// ζ when the next command begins to act (the next sample, without latency and lag).
    pub fn zeta(&self) -> &[T; 4] {
        &self.memory.zeta
    }

    /// The disturbances found up to the last sample, beyond the vehicle as it was told.
    pub fn disturbance(&self) -> Disturbance<T> {
        let Memory { vehicle, weighed, last, actuators, observer, .. } = &self.memory;
        let thrust = actuators.applied().thrust;
        let mut found = *observer.estimate();
        found.payload += last.rod * (lambda(weighed, last, thrust) - lambda(vehicle, last, thrust));
        found
    }

    /// The payload's mass, kg, that would explain the force along the rod in still air (12.6).
    pub fn payload_mass(&self) -> T {
        let Memory { vehicle, last, actuators, .. } = &self.memory;
        let lambda = lambda(vehicle, last, actuators.applied().thrust);
        self.disturbance().implied_payload_mass(vehicle, &last.rod, lambda)
    }

    /// The last state, sampled or by the model.
    pub fn state(&self) -> &State<T> {
        &self.memory.last
    }

    /// The vehicle as it was told.
    pub fn vehicle(&self) -> &Vehicle<T> {
        &self.memory.vehicle
    }

    /// The control period, s.
    pub fn period(&self) -> T {
        self.memory.period
    }
}

/// Copies a state vector by vector: as a block it would be copied by a call, at three times the
/// cost, and in the caller number by number.
#[inline(never)]
fn remember<T: Real>(last: &mut State<T>, state: &State<T>) {
    last.position = state.position;
    last.velocity = state.velocity;
    last.rod = state.rod;
    last.rod_rate = state.rod_rate;
    last.attitude = state.attitude;
    last.body_rate = state.body_rate;
}
