//! The law, supervised: modes, envelope, faults, and a command for every input.
//!
//! ```text
//!          arm         hold, follow          follow, calm            path reached
//!   OFF ────────▶ IDLE ────────────▶ HOLD ────────────────▶ JOIN ────────────────▶ FOLLOW
//!    ▲                                ▲ ▲                     │                      │
//!    │                                │ └─────────────────────┴──────────────────────┘
//!    │                                │    hold asked for; a margin beyond its limit;
//!    │        land, from any in flight│    an answer not finite; the payload lost
//!    ├─ landed ── LAND ───────────────┤ hold or follow asked for
//!    │                                │
//!    │           FAULT ───────────────┘ a good state again, unless the rotors were cut
//!    │             ▲ no good state for longer than [`Policy::coast`], from any in flight:
//!    │             │ rotors cut, or sinking level, as [`Policy::lost`] says
//!    └─ off, from anywhere
//! ```
//!
//! What a request, the flight and the state's absence lead to, from each mode, at the next step. The tests read this table and try every field:
//!
//! | mode   | `Off` | `Idle` | `Follow` | `Hold` | `Land` | path reached | margin beyond | payload lost | landed | no state | none for long |
//! |--------|-------|--------|----------|--------|--------|--------------|---------------|--------------|--------|----------|---------------|
//! | Off    | Off   | Idle   | Idle     | Idle   | Off    |              |               |              |        | Off      | Off           |
//! | Idle   | Off   | Idle   | Hold     | Hold   | Off    |              |               |              |        | Idle     | Idle          |
//! | Join   | Off   | Hold   | Join     | Hold   | Land   | Follow       | Hold          | Hold         |        | Join     | Fault         |
//! | Follow | Off   | Hold   | Follow   | Hold   | Land   |              | Hold          | Hold         |        | Follow   | Fault         |
//! | Hold   | Off   | Hold   | Join     | Hold   | Land   |              | Hold          |              |        | Hold     | Fault         |
//! | Land   | Off   | Hold   | Hold     | Hold   | Land   |              | Land          |              | Off    | Land     | Fault         |
//! | Fault  | Off   | Hold   | Hold     | Hold   | Hold   |              | Hold          |              |        | Fault    | Fault         |
//!
//! From hold the path is joined at once if follow has just been asked for and the vehicle is inside its envelope, and otherwise after
//! [`Policy::calm`]. A fault whose rotors were cut is left by off alone.
//!
//! Whatever bits come in, the command that goes out is finite and within the limits, its fault is typed, and nothing that came in stays: the
//! next good state is flown on.

use model::{Channel, Command, Disturbance, OutOfRange, Real, State, Yaw, dynamics::lambda, is_within};

use crate::flight::approach::{ApproachLimits, Pace};
use crate::flight::envelope::{Envelope, EnvelopeParams, Margin, Margins, Standing};
use crate::law::follow::{Follower, Solution, Xi};
use crate::law::hold::Hold;
use crate::path::Path;
use crate::sampled::actuator::{Actuation, ActuatorLimits};
use crate::sampled::sampler::Ahead;
use nalgebra::Vector3;

/// What the vehicle is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
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
pub enum Fault {
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
    /// For how long it has to have been, s.
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
            coast: T::lit(0.1),
            lost: Lost::Sink(T::lit(0.9)),
            resume: true,
            calm: T::one(),
            descent: T::lit(0.5),
            payload_lost: T::lit(0.3),
        }
    }
}

impl<T: Real> Policy<T> {
    fn check(&self) -> Result<(), OutOfRange<T>> {
        OutOfRange::check("coast", self.coast, 0.0, 10.0)?;
        OutOfRange::check("calm", self.calm, 0.0, 100.0)?;
        OutOfRange::check("descent", self.descent, 0.01, 10.0)?;
        OutOfRange::check("payload_lost", self.payload_lost, -1.0, 0.95)?;
        match self.lost {
            Lost::Cut => Ok(()),
            Lost::Sink(share) => OutOfRange::check("lost", share, 0.0, 1.0),
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

/// A path-following controller that answers every input.
#[derive(Clone, Debug)]
pub struct Supervisor<T, P, A = ActuatorLimits<T>> {
    follower: Follower<T, P, A>,
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

impl<T: Real, P: Path<T>, A: Actuation<T>> Supervisor<T, P, A> {
    /// Rotors off. An error names the parameter that is out of range.
    pub fn new(
        follower: Follower<T, P, A>,
        envelope: &EnvelopeParams<T>,
        approach: ApproachLimits<T>,
        policy: Policy<T>,
    ) -> Result<Self, OutOfRange<T>> {
        let vehicle = *follower.vehicle();
        let pace = approach.pace(&vehicle)?;
        policy.check()?;
        let params = vehicle.params();
        let least_mass = (params.uav_mass + params.payload_mass * policy.payload_lost) / vehicle.total_mass();
        Ok(Self {
            follower,
            envelope: Envelope::new(&vehicle, envelope)?,
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

    /// The law's own answer in the last step, where it was flown: what [`Output::command`] was before the limits, and what it came from.
    pub fn solution(&self) -> Option<&Solution<T, Xi<T>>> {
        self.is_by_law.then(|| self.follower.solution())
    }

    /// The law that is supervised.
    pub fn follower(&self) -> &Follower<T, P, A> {
        &self.follower
    }

    /// Takes over a flying vehicle, to which `applied` has been applied until now: from [`Mode::Off`] to [`Mode::Hold`].
    pub fn take_over(&mut self, state: &State<T>, applied: Command<T>) {
        if state.check().is_ok() && applied.is_finite() {
            let sampler = self.follower.sampler();
            let applied = sampler.actuation().apply(&applied);
            sampler.take_over(state, applied);
            self.request = Request::Hold;
            self.fault = None;
            self.enter_hold(state, None);
        }
    }

    /// Starts on the path, from a stated ζ: [`Mode::Follow`] without an approach. Of numbers that are none, nothing is started.
    pub fn start(&mut self, state: &State<T>, zeta: [T; 4]) {
        if state.check().is_ok() && zeta.iter().all(|z| z.is_finite()) {
            self.follower.start(state, zeta);
            self.request = Request::Follow;
            self.fault = None;
            self.mode = Mode::Follow;
        }
    }

    /// Changes what the actuators can apply, in flight too.
    pub fn set_actuation(&mut self, actuation: A) -> Result<(), OutOfRange<T>> {
        self.follower.set_actuation(actuation)
    }

    /// The command for the coming hold. Call once every period, with the state sampled now and what the pilot wants.
    #[inline]
    pub fn step(&mut self, sampled: &State<T>, request: Request) -> Output<T> {
        if request != self.request {
            self.request = request;
            self.fault = None;
            self.calm = self.policy.calm;
        }
        if request == Request::Off {
            self.mode = Mode::Off;
        }
        self.is_by_law = false;
        match sampled.check() {
            Err(channel) => {
                let command = self.without_state(channel);
                self.output(command, None)
            }
            Ok(()) => {
                if self.blind > T::zero() {
                    self.blind = T::zero();
                    self.follower.sampler().resume(sampled);
                }
                self.change_mode(sampled);
                match self.mode {
                    // In fault with a good state: the rotors were cut.
                    Mode::Off | Mode::Fault => self.ground(sampled, T::zero()),
                    Mode::Idle => self.ground(sampled, self.follower.actuation().least_thrust()),
                    Mode::Join | Mode::Follow | Mode::Hold | Mode::Land => self.fly(sampled),
                }
            }
        }
    }

    /// By the law, or by hold.
    #[inline]
    fn fly(&mut self, sampled: &State<T>) -> Output<T> {
        let ahead = self.follower.sampler().sample(sampled);
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
        let command = Command { thrust, torque: Vector3::zeros() };
        self.follower.sampler().take_over(sampled, command);
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
            (Mode::Join, Request::Follow) if self.follower.approach().is_active() => Mode::Join,
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
        let least = self.follower.vehicle().hover_thrust() * T::lit(ENGAGING_THRUST);
        let falling = self.follower.sampler().applied().thrust < least;
        if !falling && self.standing(sampled) == Standing::Inside {
            if self.follower.rejoin(sampled, &self.pace) {
                self.mode = Mode::Join;
            } else {
                self.enter_hold(sampled, Some(Fault::NoPath));
            }
        }
    }

    /// How the vehicle stands in the envelope under what is being applied; the path's margins are the law's to say.
    #[inline(never)]
    fn standing(&mut self, sampled: &State<T>) -> Standing {
        let thrust = self.follower.sampler().applied().thrust;
        let vehicle = self.follower.vehicle();
        let b3: Vector3<T> = sampled.attitude.column(2).into();
        let margins = Margins {
            q3: sampled.rod.z,
            q_b3: b3.dot(&sampled.rod),
            lambda: lambda(vehicle, sampled, thrust),
            kappa: thrust * vehicle.kappa_per_thrust(),
            path_det: T::one(),
            reach: T::one(),
            cos_phi_squared: Yaw::of(sampled).cos_phi_squared,
        };
        self.envelope.assess(&margins, T::one())
    }

    fn may_follow(&self) -> bool {
        self.fault != Some(Fault::PayloadLost)
            && self.calm >= self.policy.calm
            && (self.policy.resume || self.fault.is_none())
    }

    #[cold]
    fn enter_hold(&mut self, sampled: &State<T>, fault: Option<Fault>) {
        self.hold = Hold::from(self.follower.vehicle(), sampled);
        self.follower.sampler().soften();
        self.mode = Mode::Hold;
        self.calm = T::zero();
        self.unloaded = T::zero();
        self.fault = fault.or(self.fault);
    }

    /// The law's command for when it acts, if its answer can be flown; hold's, if not.
    // Apart, and so is hold: neither needs the other's stack.
    #[inline(never)]
    fn follow(&mut self, sampled: &State<T>, ahead: &Ahead<T>) -> Output<T> {
        self.follower.evaluate(ahead);
        let solution = self.follower.solution();
        let standing = self.envelope.assess(&solution.margins, self.follower.approach().path_det());
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
        let command = self.follower.accept();
        self.is_by_law = true;
        let warning = if let Standing::Warning(margin) = standing { Some(margin) } else { None };
        self.output(command, warning)
    }

    /// Hold's command for when it acts, at `state`, from what is `sampled` now.
    #[cold]
    fn hold(&mut self, sampled: &State<T>, state: &State<T>) -> Output<T> {
        let period = self.follower.sampler().period();
        let (vehicle, disturbance) = (self.follower.vehicle(), self.follower.disturbance());
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
        let command = self.follower.sampler().commit(wanted, T::zero(), T::zero());
        self.output(command, warning)
    }

    /// The command of a step without a good state.
    #[cold]
    fn without_state(&mut self, channel: Channel) -> Command<T> {
        self.fault = Some(Fault::State(channel));
        let hover = self.follower.vehicle().hover_thrust();
        let sampler = self.follower.sampler();
        self.blind += sampler.period();
        let level = |thrust| Command { thrust, torque: Vector3::zeros() };
        match self.mode {
            Mode::Off => Command::zero(),
            Mode::Idle => level(sampler.actuation().least_thrust()),
            Mode::Join | Mode::Follow | Mode::Hold | Mode::Land if self.blind <= self.policy.coast => sampler.coast(),
            _ => {
                self.mode = Mode::Fault;
                match self.policy.lost {
                    Lost::Cut => Command::zero(),
                    Lost::Sink(share) => sampler.send(&level(hover * share)),
                }
            }
        }
    }

    /// Whether the payload's mass has been implied to be next to nothing for a while: M = M₀ λ/(λ + d·q), both sides negative.
    #[inline]
    fn payload_is_lost(&mut self, ahead: &Ahead<T>) -> bool {
        let lambda = self.follower.solution().margins.lambda;
        let along = self.follower.disturbance().payload.dot(&ahead.state.rod);
        let lost = lambda > self.least_mass * (lambda + along);
        self.unloaded = if lost { self.unloaded + self.follower.sampler().period() } else { T::zero() };
        self.unloaded > T::lit(UNLOADED)
    }

    /// What is known of disturbances.
    pub fn disturbance(&self) -> &Disturbance<T> {
        self.follower.disturbance()
    }
}

/// Below this share of the hover thrust the vehicle falls, which hold ends sooner than the law.
const ENGAGING_THRUST: f64 = 0.75;
/// How long the payload has to seem lost, s.
const UNLOADED: f64 = 0.5;
/// How far above its target the ground must keep a landing vehicle, m.
const GROUNDED: f64 = 1.5;
/// Calm enough to join the path: speed, m/s, swing, 1/s, and cosine of the tilt.
const CALM_SPEED: f64 = 1.0;
const CALM_SWING: f64 = 0.3;
const CALM_TILT: f64 = 0.95;
