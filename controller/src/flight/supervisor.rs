//! The law, supervised: modes, envelope, faults, and a command for every input.

use model::{Channel, Command, Disturbance, OutOfRange, Real, State, is_within};

use crate::error::Refused;
use crate::flight::approach::{ApproachLimits, Pace};
use crate::flight::envelope::{Envelope, EnvelopeParams, Standing};
use crate::law::hold::Hold;
use crate::law::margins::{Margin, Margins};
use crate::law::solution::Solution;
use crate::law::{Ahead, Law};
use crate::ranges::{CALM, COAST, DESCENT, PAYLOAD_LOST, SINK};
use crate::sampled::actuator::{Actuation, ActuatorLimits};
use crate::sampled::controller::Controller;
use crate::sampled::sampler::Sampler;
use nalgebra::Vector3;

/// Below this share of the hover thrust the vehicle is falling: hold, which stops a fall as hard as the rotors can, goes first.
const JOINING_THRUST: f64 = 0.75;
/// How long the payload must seem lost, s: longer than a swing's or a gust's unloading.
const UNLOADED: f64 = 0.5;
/// How far above its target the ground must keep a landing vehicle, m: more than hold lags in any descent.
const GROUNDED: f64 = 1.5;
/// Calm enough to join the path: speed, m/s, swing, 1/s, and cosine of the tilt (18°).
const CALM_SPEED: f64 = 1.0;
const CALM_SWING: f64 = 0.3;
const CALM_TILT: f64 = 0.95;

/// What the vehicle is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Mode {
    /// Rotors off.
    Off,
    /// Armed, at least thrust.
    Idle,
    /// On the way to the path.
    Join,
    /// On the path.
    Follow,
    /// At rest, or coming to it.
    Hold,
    /// Sinking at [`Policy::descent`].
    Land,
    /// No state to fly on.
    Fault,
}

/// What the pilot wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Request {
    /// Rotors off, at once.
    Off,
    /// Armed on the ground; in flight the same as [`Hold`](Self::Hold).
    Idle,
    /// Along the path.
    Follow,
    /// Stop where it is.
    Hold,
    /// Sink, and switch off on the ground.
    Land,
}

/// Why the vehicle is not doing what was asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Fault {
    /// There was no state.
    NoState,
    /// This part of the state is not a number, or out of any range.
    State(Channel),
    /// This margin is beyond its limit.
    Margin(Margin),
    /// The law's answer was not finite.
    NotFinite,
    /// No point of the path was found from here.
    NoPath,
    /// The payload is gone.
    PayloadLost,
}

/// What to do without a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lost<T> {
    /// Cut the rotors; only [`Request::Off`] leaves the fault.
    Cut,
    /// Sink with this share of the hover thrust, 0 to 1, and no torque; a good state again leads to hold.
    Sink(T),
}

/// What is done when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Policy<T> {
    /// How long the last command goes on without a good state, s.
    pub coast: T,
    /// What comes after that.
    pub lost: Lost<T>,
    /// Whether hold goes back to the path by itself when [`Request::Follow`] still stands, and the vehicle has been calm.
    pub resume: bool,
    /// How long the vehicle must have been calm before it rejoins, s.
    pub calm: T,
    /// Speed of a landing, m/s.
    pub descent: T,
    /// Share of the payload's mass below which it counts as lost.
    pub payload_lost: T,
}

impl<T: Real> Default for Policy<T> {
    /// 0.1 s, then sinking at 90 % of the hover thrust; back to the path after a calm second; landing at 0.5 m/s; lost below 30 %.
    fn default() -> Self {
        Self {
            coast: COAST.default(),
            lost: Lost::Sink(SINK.default()),
            resume: true,
            calm: CALM.default(),
            descent: DESCENT.default(),
            payload_lost: PAYLOAD_LOST.default(),
        }
    }
}

impl<T: Real> Policy<T> {
    fn check(&self) -> Result<(), OutOfRange<T>> {
        COAST.check(self.coast)?;
        CALM.check(self.calm)?;
        DESCENT.check(self.descent)?;
        PAYLOAD_LOST.check(self.payload_lost)?;
        match self.lost {
            Lost::Cut => Ok(()),
            Lost::Sink(share) => SINK.check(share),
        }
    }
}

/// What a step answers; what the law had to say to it is in [`Supervisor::solution`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Output<T> {
    /// Finite and within the limits; nothing at all in [`Mode::Off`].
    pub command: Command<T>,
    /// The mode it was made in.
    pub mode: Mode,
    /// The last fault since a request changed.
    pub fault: Option<Fault>,
    /// A margin past its warning.
    pub warning: Option<Margin>,
}

/// A law, supervised: it answers every input. It owns the sampled memory and lends it to the law, or to hold.
///
/// ```text
///          arm         hold, follow          follow, calm            path reached
///   OFF ────────▶ IDLE ────────────▶ HOLD ────────────────▶ JOIN ────────────────▶ FOLLOW
///    ▲                                ▲ ▲                     │                      │
///    │                                │ └─────────────────────┴──────────────────────┘
///    │                                │    hold asked for; a margin beyond its limit;
///    │        land, from any in flight│    an answer not finite; the payload lost
///    ├─ landed ── LAND ───────────────┤ hold or follow asked for
///    │                                │
///    │           FAULT ───────────────┘ a good state again, unless the rotors were cut
///    │             ▲ no good state for longer than [`Policy::coast`], from any in flight:
///    │             │ rotors cut, or sinking level, as [`Policy::lost`] says
///    └─ off, from anywhere
/// ```
///
/// What a request, the flight and the state's absence lead to, from each mode, at the next step. The tests read this table and try every field:
///
/// | mode   | `Off` | `Idle` | `Follow` | `Hold` | `Land` | path reached | margin beyond | payload lost | landed | no state | none for long |
/// |--------|-------|--------|----------|--------|--------|--------------|---------------|--------------|--------|----------|---------------|
/// | Off    | Off   | Idle   | Idle     | Idle   | Off    |              |               |              |        | Off      | Off           |
/// | Idle   | Off   | Idle   | Hold     | Hold   | Off    |              |               |              |        | Idle     | Idle          |
/// | Join   | Off   | Hold   | Join     | Hold   | Land   | Follow       | Hold          | Hold         |        | Join     | Fault         |
/// | Follow | Off   | Hold   | Follow   | Hold   | Land   |              | Hold          | Hold         |        | Follow   | Fault         |
/// | Hold   | Off   | Hold   | Join     | Hold   | Land   |              | Hold          |              |        | Hold     | Fault         |
/// | Land   | Off   | Hold   | Hold     | Hold   | Land   |              | Land          |              | Off    | Land     | Fault         |
/// | Fault  | Off   | Hold   | Hold     | Hold   | Hold   |              | Hold          |              |        | Fault    | Fault         |
///
/// From hold the path is joined at once if follow has just been asked for and the vehicle is inside its envelope, and otherwise after
/// [`Policy::calm`]. A fault whose rotors were cut is left by off alone.
///
/// Whatever bits come in, the command that goes out is finite and within the limits, its fault is typed, and nothing that came in stays: the
/// next good state is flown on.
#[derive(Clone, Debug)]
pub struct Supervisor<T, L, A = ActuatorLimits<T>> {
    sampler: Sampler<T, A>,
    law: L,
    envelope: Envelope<T>,
    pace: Pace<T>,
    policy: Policy<T>,
    /// Share of all mass that is left when the payload counts as lost.
    least_mass: T,
    mode: Mode,
    request: Request,
    fault: Option<Fault>,
    /// The last command was the law's.
    is_by_law: bool,
    hold: Hold<T>,
    /// Time without a good state, of calm in hold, and without payload, s.
    blind: T,
    calm: T,
    unloaded: T,
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
        let vehicle = *sampler.vehicle();
        let pace = approach.pace(&vehicle)?;
        policy.check()?;
        let params = vehicle.params();
        let least_mass = (params.uav_mass + params.payload_mass * policy.payload_lost) / vehicle.total_mass();
        Ok(Self {
            sampler,
            law,
            envelope: Envelope::new(&vehicle, &envelope)?,
            pace,
            policy,
            least_mass,
            mode: Mode::Off,
            request: Request::Off,
            fault: None,
            is_by_law: false,
            hold: Hold::from(&vehicle, &State::at_rest(Vector3::zeros())),
            blind: T::zero(),
            calm: T::zero(),
            unloaded: T::zero(),
        })
    }

    /// The mode as of the last step.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The law's solution of the last step, if the law flew it: the command before limits, and the numbers behind it.
    pub fn solution(&self) -> Option<&Solution<T, L::Xi>> {
        self.is_by_law.then(|| self.law.solution())
    }

    /// The law that is supervised.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// The law, for what may be changed of it in flight: a reference, a path's own settings.
    pub fn law_mut(&mut self) -> &mut L {
        &mut self.law
    }

    /// The sampled memory.
    pub fn sampler(&self) -> &Sampler<T, A> {
        &self.sampler
    }

    /// The disturbances found up to the last sample.
    pub fn disturbance(&self) -> &Disturbance<T> {
        self.sampler.disturbance()
    }

    /// Takes over a flying vehicle, to which `applied` has been applied until now: from [`Mode::Off`] to [`Mode::Hold`].
    ///
    /// # Errors
    /// A part of `state` or of `applied` is no number or out of any range; nothing has changed.
    pub fn take_over(&mut self, state: &State<T>, applied: Command<T>) -> Result<(), Refused> {
        let applied = if applied.is_finite() { self.sampler.actuation().apply(&applied) } else { applied };
        self.sampler.take_over(state, applied)?;
        self.request = Request::Hold;
        self.fault = None;
        self.enter_hold(state, None);
        Ok(())
    }

    /// Starts on the path, from a stated ζ: [`Mode::Follow`] without an approach.
    ///
    /// # Errors
    /// A part of `state` or of `zeta` is no number or out of any range; nothing has changed.
    pub fn start(&mut self, state: &State<T>, zeta: [T; 4]) -> Result<(), Refused> {
        self.sampler.start(state, zeta)?;
        self.law.restart(state);
        self.request = Request::Follow;
        self.fault = None;
        self.mode = Mode::Follow;
        Ok(())
    }

    /// Changes what the actuators can apply, in flight too: less than hover's thrust may then be the truth.
    ///
    /// # Errors
    /// A parameter of `actuation` is out of range; nothing has changed.
    pub fn set_actuation(&mut self, actuation: A) -> Result<(), OutOfRange<T>> {
        self.sampler.set_actuation(actuation)
    }

    /// The command for the coming hold. Call once every period, with the state sampled now, if there is one, and what the pilot
    /// wants.
    #[inline]
    pub fn step(&mut self, sampled: Option<&State<T>>, request: Request) -> Output<T> {
        if request != self.request {
            self.request = request;
            self.fault = None;
            self.calm = self.policy.calm;
        }
        if request == Request::Off {
            self.mode = Mode::Off;
        }
        self.is_by_law = false;
        let sampled = match sampled {
            None => return self.without_state(Fault::NoState),
            Some(sampled) => match sampled.check() {
                Err(channel) => return self.without_state(Fault::State(channel)),
                Ok(()) => sampled,
            },
        };
        if self.blind > T::zero() {
            self.blind = T::zero();
            self.sampler.resume(sampled);
        }
        self.change_mode(sampled);
        match self.mode {
            // In fault with a good state: the rotors were cut.
            Mode::Off | Mode::Fault => self.ground(sampled, T::zero()),
            Mode::Idle => self.ground(sampled, self.sampler.actuation().least_thrust()),
            Mode::Join | Mode::Follow | Mode::Hold | Mode::Land => self.fly(sampled),
        }
    }

    /// By the law, or by hold.
    #[inline]
    fn fly(&mut self, sampled: &State<T>) -> Output<T> {
        let ahead = self.sampler.sample(sampled);
        if matches!(self.mode, Mode::Join | Mode::Follow) {
            self.follow(sampled, &ahead)
        } else {
            self.hold(sampled, &ahead.state)
        }
    }

    /// `command` in the mode, and with the fault, that there is now.
    fn output(&self, command: Command<T>, warning: Option<Margin>) -> Output<T> {
        Output { command, mode: self.mode, fault: self.fault, warning }
    }

    /// On the ground: no law, no torque.
    #[cold]
    fn ground(&mut self, sampled: &State<T>, thrust: T) -> Output<T> {
        let command = Command::of_thrust(thrust);
        self.sampler.stand(sampled, command);
        self.output(command, None)
    }

    /// The edges that requests and good states open: the table's rows.
    fn change_mode(&mut self, sampled: &State<T>) {
        let to = match (self.mode, self.request) {
            (Mode::Off, Request::Off | Request::Land) => Mode::Off,
            (Mode::Off, _) => Mode::Idle,
            (Mode::Idle, Request::Off | Request::Idle) => Mode::Idle,
            (Mode::Idle, Request::Land) => Mode::Off,
            (Mode::Idle, _) => Mode::Hold,
            (Mode::Join | Mode::Follow | Mode::Hold | Mode::Land, Request::Land) => Mode::Land,
            (Mode::Join, Request::Follow) if self.law.approach().is_active() => Mode::Join,
            (Mode::Join | Mode::Follow, Request::Follow) => Mode::Follow,
            (Mode::Hold, Request::Follow) if self.may_follow() => Mode::Join,
            (Mode::Fault, _) if self.policy.lost == Lost::Cut => Mode::Fault,
            _ => Mode::Hold,
        };
        if to == self.mode {
            return;
        }
        match to {
            Mode::Join => self.join(sampled),
            Mode::Hold | Mode::Land => {
                self.enter_hold(sampled, None);
                self.mode = to;
            }
            _ => self.mode = to,
        }
    }

    /// Joins the path, if the vehicle is where the law can fly it.
    #[cold]
    fn join(&mut self, sampled: &State<T>) {
        let falling = self.sampler.applied().thrust < self.sampler.vehicle().hover_thrust() * T::lit(JOINING_THRUST);
        if falling || self.standing(sampled) != Standing::Inside {
            return;
        }
        match self.law.join(sampled, &self.pace) {
            Ok(()) => {
                self.sampler.carry_on(sampled);
                self.mode = Mode::Join;
            }
            Err(Refused::Searching) => {}
            Err(_) => self.enter_hold(sampled, Some(Fault::NoPath)),
        }
    }

    /// How the vehicle stands in the envelope under what is being applied; the path's margins are the law's to say.
    #[inline(never)]
    fn standing(&self, sampled: &State<T>) -> Standing {
        let margins = Margins::of_motion(self.sampler.vehicle(), sampled, self.sampler.applied().thrust);
        self.envelope.assess(&margins, T::one())
    }

    fn may_follow(&self) -> bool {
        self.fault != Some(Fault::PayloadLost)
            && self.calm >= self.policy.calm
            && (self.policy.resume || self.fault.is_none())
    }

    #[cold]
    fn enter_hold(&mut self, sampled: &State<T>, fault: Option<Fault>) {
        self.hold = Hold::from(self.sampler.vehicle(), sampled);
        self.sampler.soften();
        self.mode = Mode::Hold;
        self.calm = T::zero();
        self.unloaded = T::zero();
        self.fault = fault.or(self.fault);
    }

    /// The law's command for when it acts, if its answer can be flown; hold's, if not.
    // Apart, and so is hold: neither needs the other's stack.
    #[inline(never)]
    fn follow(&mut self, sampled: &State<T>, ahead: &Ahead<T>) -> Output<T> {
        self.sampler.ask(&mut self.law, ahead);
        let solution = self.law.solution();
        let standing = self.envelope.assess(&solution.margins, self.law.approach().path_det());
        let fault = if let Standing::Beyond(margin) = standing {
            Some(Fault::Margin(margin))
        } else if !solution.is_finite() {
            Some(Fault::NotFinite)
        } else if self.payload_is_lost(ahead) {
            Some(Fault::PayloadLost)
        } else {
            None
        };
        if fault.is_some() {
            self.enter_hold(sampled, fault);
            return self.hold(sampled, &ahead.state);
        }
        let command = self.sampler.accept(&mut self.law);
        self.is_by_law = true;
        let warning = if let Standing::Warning(margin) = standing { Some(margin) } else { None };
        self.output(command, warning)
    }

    /// Hold's command for when it acts, at `state`, from what is `sampled` now.
    #[cold]
    fn hold(&mut self, sampled: &State<T>, state: &State<T>) -> Output<T> {
        let period = self.sampler.period();
        let (vehicle, disturbance) = (self.sampler.vehicle(), self.sampler.disturbance());
        let descent = if self.mode == Mode::Land { self.policy.descent } else { T::zero() };
        let wanted = self.hold.step(vehicle, state, disturbance, descent, period);
        if self.mode == Mode::Land && self.hold.left_above(vehicle, sampled) > T::lit(GROUNDED) {
            self.mode = Mode::Off;
            self.request = Request::Off;
            return self.ground(sampled, T::zero());
        }
        let is_calm = is_within(&sampled.velocity, T::lit(CALM_SPEED * CALM_SPEED))
            && is_within(&sampled.rod_rate, T::lit(CALM_SWING * CALM_SWING))
            && sampled.attitude.m33 > T::lit(CALM_TILT);
        self.calm = if is_calm { self.calm + period } else { T::zero() };
        let warning = match self.standing(sampled) {
            Standing::Inside => None,
            Standing::Warning(margin) | Standing::Beyond(margin) => Some(margin),
        };
        let command = self.sampler.commit(wanted, T::zero(), T::zero());
        self.output(command, warning)
    }

    /// A step without a good state.
    #[cold]
    fn without_state(&mut self, fault: Fault) -> Output<T> {
        self.fault = Some(fault);
        self.blind += self.sampler.period();
        let command = match self.mode {
            Mode::Off => Command::zero(),
            Mode::Idle => Command::of_thrust(self.sampler.actuation().least_thrust()),
            Mode::Join | Mode::Follow | Mode::Hold | Mode::Land if self.blind <= self.policy.coast => {
                self.sampler.coast()
            }
            _ => {
                self.mode = Mode::Fault;
                match self.policy.lost {
                    Lost::Cut => Command::zero(),
                    Lost::Sink(share) => {
                        let hover = self.sampler.vehicle().hover_thrust();
                        self.sampler.send(&Command::of_thrust(hover * share))
                    }
                }
            }
        };
        self.output(command, None)
    }

    /// Whether the payload's mass has been implied to be next to nothing for a while: M = M₀ λ/(λ + d·q), both sides negative.
    #[inline]
    fn payload_is_lost(&mut self, ahead: &Ahead<T>) -> bool {
        let lambda = self.law.solution().margins.lambda;
        let along = self.sampler.disturbance().payload.dot(&ahead.state.rod);
        let lost = lambda > self.least_mass * (lambda + along);
        self.unloaded = if lost { self.unloaded + self.sampler.period() } else { T::zero() };
        self.unloaded > T::lit(UNLOADED)
    }
}
