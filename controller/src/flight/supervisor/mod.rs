//! The law, supervised: modes, envelope, faults, and a command for every input.

mod edges;
mod flying;
mod senses;

use model::{Channel, Command, Disturbance, OutOfRange, Real, State, Uav};
use nalgebra::Vector3;

use crate::error::Refused;
use crate::flight::cable::Cable;
use crate::flight::envelope::{Envelope, EnvelopeParams};
use crate::flight::footing::Footing;
use crate::flight::landing::Landing;
use crate::flight::mode::{Fault, Measured, Mode, Output, Policy, Request};
use crate::flight::motion::Motion;
use crate::flight::payload::Payload;
use crate::flight::turning::Stuck;
use crate::law::Law;
use crate::law::approach::{ApproachLimits, Pace};
use crate::law::hold::Hold;
use crate::law::margins::Margin;
use crate::law::solution::{Answer, Solution};
use crate::sampled::actuator::{Actuation, ActuatorLimits};
use crate::sampled::controller::Controller;
use crate::sampled::sampler::Sampler;
use senses::Doubt;

/// A law, supervised: it answers every input. It owns the sampled memory and lends it to the law,
/// or to hold.
///
/// ```text
///          arm         hold, follow           risen            follow, calm           path reached
///   OFF ────────▶ IDLE ────────────▶ TAKE-OFF ───────▶ HOLD ────────────────▶ JOIN ────────────────▶ FOLLOW
///    ▲              └─ with no navigation of its own ──▶▲ ▲                    │                       │
///    │                                                  │ └────────────────────┴───────────────────────┘
///    │                                                  │    hold asked for; a margin beyond its limit; an answer
///    │                                                  │    not finite; the payload lost; the cable slack
///    │        land, from any in flight                  │
///    ├─ landed ── LAND ─────────────────────────────────┤ hold or follow asked for
///    │                                                  │
///    │           FAULT ─────────────────────────────────┘ a good state again, unless the rotors were cut
///    │             ▲ no good state for longer than [`Policy::coast`], from any in flight:
///    │             │ rotors cut, or sinking level, as [`Policy::lost`] says
///    └─ off, from anywhere
/// ```
///
/// What a request, the flight and the state's absence lead to, from each mode. The tests read this
/// table and try every field. *Load unseen* is a state missing for longer than [`Policy::coast`]
/// while the UAV's own navigation is there, or one that contradicts it; *no state* the absence of
/// both:
///
/// | mode    | `Off` | `Idle` | `Follow` | `Hold`  | `Land` | risen | path reached | margin beyond | payload lost | cable slack | landed | caught | load unseen | no state | none for long |
/// |---------|-------|--------|----------|---------|--------|-------|--------------|---------------|--------------|-------------|--------|--------|-------------|----------|---------------|
/// | Off     | Off   | Idle   | Idle     | Idle    | Off    |       |              |               |              |             |        |        | Off         | Off      | Off           |
/// | Idle    | Off   | Idle   | Hold     | Hold    | Off    |       |              |               |              |             |        |        | Idle        | Idle     | Idle          |
/// | TakeOff | Off   | Hold   | TakeOff  | TakeOff | Land   | Hold  |              |               |              | TakeOff     |        |        | TakeOff     | TakeOff  | Fault         |
/// | Join    | Off   | Hold   | Join     | Hold    | Land   |       | Follow       | Hold          | Hold         | Hold        |        |        | Hold        | Join     | Fault         |
/// | Follow  | Off   | Hold   | Follow   | Hold    | Land   |       |              | Hold          | Hold         | Hold        |        |        | Hold        | Follow   | Fault         |
/// | Hold    | Off   | Hold   | Join     | Hold    | Land   |       |              | Hold          |              | Hold        |        |        | Hold        | Hold     | Fault         |
/// | Land    | Off   | Hold   | Hold     | Hold    | Land   |       |              | Land          |              | Land        | Off    | Hold   | Land        | Land     | Fault         |
/// | Fault   | Off   | Hold   | Hold     | Hold    | Hold   |       |              | Hold          |              | Hold        |        |        | Hold        | Fault    | Fault         |
///
/// With the UAV's own navigation ([`Measured::uav`]) idle leads to take-off rather than to hold.
/// Without it a rod beyond the envelope, as that of a vehicle which stands beside its load, leaves
/// it idle, with the margin as its fault.
/// Hold, landing and take-off fly the UAV itself and take the cable for a pull; without that
/// navigation they take it for taut. A landing sets the load down, goes aside, and sets the UAV
/// down beside it; without that navigation it keeps the cable taut and flies the UAV around the
/// load, an arc of the cable's length, to the ground. Rotors go off once the UAV itself stands,
/// which shows by its not turning when it is asked to. One that is carried and does not stand hangs
/// from its cable, since the load has been *caught*: it holds until something else is asked for.
///
/// From hold the path is joined at once if follow has just been asked for, the vehicle is inside
/// its envelope and the load does not fall, and otherwise after [`Policy::calm`]. A fault whose
/// rotors were cut is left by off alone. A payload that is lost keeps the vehicle in hold, until
/// the cable has pulled for three seconds as it did before the loss.
///
/// Whatever bits come in, the command that goes out is finite and within the limits, its fault is
/// typed, and nothing that came in stays: the next good state is flown on.
// In this order: what every step on the path needs comes before what is large or of other modes.
#[derive(Clone, Debug)]
#[repr(C)]
pub struct Supervisor<T, L, A = ActuatorLimits<T>> {
    mode: Mode,
    request: Request,
    fault: Option<Fault>,
    /// The last command was the law's.
    is_by_law: bool,
    /// Time without a good state, and of calm in hold, s.
    blind: T,
    calm: T,
    envelope: Envelope<T>,
    cable: Cable<T>,
    payload: Payload<T>,
    landing: Landing<T>,
    footing: Footing<T>,
    sampler: Sampler<T, A>,
    law: L,
    policy: Policy<T>,
    pace: Pace<T>,
    hold: Hold<T>,
    /// The torque, N·m, by which hold makes good a steady one.
    trim: Vector3<T>,
    /// p3 of the UAV when the last take-off, hold or landing began, m.
    from: T,
    motion: Motion<T>,
    /// Of the attitude, and of body and rod the rates.
    stuck: [Stuck<T>; 3],
}

impl<T: Real, L: Law<T>, A: Actuation<T>> Supervisor<T, L, A> {
    /// Supervises `controller`, rotors off.
    ///
    /// # Errors
    /// The parameter that is out of its [range](crate::ranges).
    pub fn new(
        controller: Controller<T, L, A>,
        envelope: EnvelopeParams<T>,
        approach: ApproachLimits<T>,
        policy: Policy<T>,
    ) -> Result<Self, OutOfRange<T>> {
        let (law, sampler) = controller.into_parts();
        let (vehicle, period, most_along) = (*sampler.vehicle(), sampler.period(), sampler.most_along());
        let pace = approach.pace(&vehicle)?;
        policy.check()?;
        Ok(Self {
            hold: Hold::from(&vehicle, &Uav::of(sampler.state(), &vehicle), &sampler.swing()),
            sampler,
            law,
            envelope: Envelope::new(&vehicle, &envelope)?,
            pace,
            policy,
            mode: Mode::Off,
            request: Request::Off,
            fault: None,
            is_by_law: false,
            motion: Motion::new(period),
            stuck: [Stuck::none(); 3],
            cable: Cable::new(&vehicle, period, most_along),
            payload: Payload::new(&vehicle, policy.payload_lost),
            landing: Landing::begin(),
            footing: Footing::none(),
            trim: Vector3::zeros(),
            from: T::zero(),
            blind: T::zero(),
            calm: T::zero(),
        })
    }

    /// The mode as of the last step.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The law's solution of the last step, if the law flew it: the command before limits, and the
    /// numbers behind it.
    pub fn solution(&self) -> Option<Solution<T, L::Xi>> {
        self.is_by_law.then(|| self.law.solution())
    }

    /// The same without ξ.
    #[inline]
    pub fn answer(&self) -> Option<&Answer<T>> {
        self.is_by_law.then(|| self.law.answer())
    }

    /// The law that is supervised.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// The law, for what may be changed of it in flight: a reference, a path's own settings.
    pub fn law_mut(&mut self) -> &mut L {
        &mut self.law
    }

    /// The law alone.
    pub fn into_law(self) -> L {
        self.law
    }

    /// The sampled memory.
    pub fn sampler(&self) -> &Sampler<T, A> {
        &self.sampler
    }

    /// The disturbances found up to the last sample, beyond the vehicle as it was told.
    pub fn disturbance(&self) -> Disturbance<T> {
        self.sampler.disturbance()
    }

    /// Takes over a flying vehicle, to which `applied` has been applied until now: from
    /// [`Mode::Off`] to [`Mode::Hold`].
    ///
    /// # Errors
    /// A part of `state` or of `applied` is no number or out of any range; nothing has changed.
    pub fn take_over(&mut self, state: &State<T>, applied: Command<T>) -> Result<(), Refused> {
        let applied = if applied.is_finite() { self.sampler.actuation().apply(&applied) } else { applied };
        self.sampler.take_over(state, applied)?;
        self.request = Request::Hold;
        self.fault = None;
        self.begin(state, applied.thrust);
        self.enter_hold(&Uav::of(state, self.sampler.vehicle()), None);
        Ok(())
    }

    /// Starts on the path, from a stated ζ: [`Mode::Follow`] without an approach.
    ///
    /// # Errors
    /// A part of `state` or of `zeta` is no number or out of any range; nothing has changed.
    pub fn start(&mut self, state: &State<T>, zeta: [T; 4]) -> Result<(), Refused> {
        self.sampler.start(state, zeta)?;
        self.law.restart(state);
        self.begin(state, self.sampler.applied().thrust);
        self.request = Request::Follow;
        self.fault = None;
        self.mode = Mode::Follow;
        Ok(())
    }

    /// Starts on the path from where the vehicle flies, to which `applied` has been applied until
    /// now: [`Mode::Follow`] without an approach, and without a bump.
    ///
    /// # Errors
    /// As [`take_over`](Self::take_over).
    pub fn start_from(&mut self, state: &State<T>, applied: Command<T>) -> Result<(), Refused> {
        self.take_over(state, applied)?;
        self.law.restart(state);
        self.request = Request::Follow;
        self.mode = Mode::Follow;
        Ok(())
    }

    /// Changes what the actuators can apply, in flight too: less than hover's thrust may then be
    /// the truth.
    ///
    /// # Errors
    /// A parameter of `actuation` is out of range; nothing has changed.
    pub fn set_actuation(&mut self, actuation: A) -> Result<(), OutOfRange<T>> {
        self.sampler.set_actuation(actuation)
    }

    /// The command for the coming hold. Call once every period, with what is measured now, a state
    /// if there is one or all of [`Measured`], and what the pilot wants. Where the load is not
    /// known but the UAV is, hold flies that after [`Policy::coast`].
    #[inline]
    pub fn step<'a>(&mut self, measured: impl Into<Measured<'a, T>>, request: Request) -> Output<T> {
        let measured = measured.into();
        if request != self.request {
            self.request = request;
            self.fault = None;
            self.calm = self.policy.calm;
        }
        if request == Request::Off {
            self.mode = Mode::Off;
        }
        self.is_by_law = false;
        self.motion.pass();
        let uav = measured.uav.filter(|uav| uav.check().is_ok());
        // Where it is not as measured.
        let mut found = uav.and_then(|uav| self.see_uav(uav, measured.specific_force.as_ref()));
        let fault = match measured.state {
            None => Fault::NoState,
            Some(state) => match state.check().and_then(|()| self.check_turning(state)) {
                Err(channel) => Fault::State(channel),
                Ok(()) => {
                    let doubt = self.doubt(state, found.as_ref().or(uav));
                    if doubt != Some(Doubt::Load) {
                        if doubt.is_some() {
                            let velocity = found.as_ref().or(uav).map(|uav| uav.velocity);
                            found = Some(self.of_load(state, velocity));
                        } else if uav.is_none() && self.motion.has_uav() {
                            found = self.lost_uav(state, measured.specific_force.as_ref());
                        }
                        return self.with_load(state, found.as_ref().or(uav), measured.specific_force);
                    }
                    Fault::Contradiction
                }
            },
        };
        let uav = found.as_ref().or(uav);
        self.blind += self.sampler.period();
        if let Some(output) = self.carried(fault, uav, measured.specific_force) {
            return output;
        }
        if let Some(output) = self.mended(fault, &measured, uav) {
            return output;
        }
        if self.fault != Some(Fault::Caught) {
            self.fault = Some(fault);
        }
        let filled = measured.uav.filter(|_| uav.is_none());
        let filled = filled.and_then(|uav| self.fill(uav, measured.specific_force.as_ref()));
        // Of an attitude that stands still the UAV has no other.
        let has_attitude = |uav: &&Uav<T>| {
            fault != Fault::State(Channel::Attitude)
                || measured.state.is_none_or(|state| state.attitude != uav.attitude)
        };
        match uav.or(filled.as_ref()).filter(has_attitude) {
            Some(uav) => self.without_load(uav, measured.specific_force),
            None => self.without_state(),
        }
    }

    /// Forgets what was known of cable and payload, at `state` under `thrust`.
    #[inline(never)]
    fn begin(&mut self, state: &State<T>, thrust: T) {
        self.motion.forget();
        self.stuck = [Stuck::none(); 3];
        self.cable.begin(self.sampler.vehicle(), state, thrust);
        self.payload.leave();
        self.trim = Vector3::zeros();
    }

    /// The UAV by its own navigation, or from `state` with a taut cable.
    #[inline(never)]
    fn now(&self, state: &State<T>, uav: Option<&Uav<T>>) -> Uav<T> {
        uav.copied().unwrap_or_else(|| Uav::of(state, self.sampler.vehicle()))
    }

    /// `command` in the mode, and with the fault, that there is now.
    fn output(&self, command: Command<T>, warning: Option<Margin>) -> Output<T> {
        Output { command, mode: self.mode, fault: self.fault, warning }
    }

    /// On the ground: no law, no torque.
    #[inline(never)]
    fn ground(&mut self, state: Option<&State<T>>, thrust: T) -> Output<T> {
        let command = Command::of_thrust(thrust);
        match state {
            Some(state) => {
                self.sampler.stand(state, command);
                self.begin(state, thrust);
            }
            None => self.sampler.rest(command),
        }
        self.output(command, None)
    }
}
