//! The law, supervised: modes, envelope, faults, and a command for every input.

use model::{Channel, Command, Disturbance, OutOfRange, Real, State, Uav, is_within};
use nalgebra::Vector3;

use crate::error::Refused;
use crate::flight::cable::{Cable, SHORTENED, Watching};
use crate::flight::envelope::{Envelope, EnvelopeParams, Standing};
use crate::flight::footing::{Carried, Footing};
use crate::flight::landing::{Aim, Landing};
use crate::flight::mode::{Fault, Lost, Measured, Mode, Output, Policy, Request};
use crate::flight::motion::Motion;
use crate::flight::payload::Payload;
use crate::flight::turning::{LED, mended};
use crate::law::Law;
use crate::law::approach::{ApproachLimits, Pace};
use crate::law::hold::Hold;
use crate::law::margins::{Margin, Margins};
use crate::law::solution::{Answer, Solution};
use crate::sampled::actuator::{Actuation, ActuatorLimits};
use crate::sampled::controller::Controller;
use crate::sampled::sampler::Sampler;

/// With more vertical acceleration than this, m/s², the load is falling or swings high. Hold, which
/// stops both as hard as the rotors can, goes first: the path would be joined by as much of a dip,
/// m.
const JOINING: f64 = 0.5;
/// So far above its target, m, a landing UAV may stand already, and does not go aside.
const CARRIED: f64 = 0.3;
/// Time, s, over which hold takes up the torque that is observed.
const TRIMMED: f64 = 1.0;
/// Calm enough to join the path: speed, m/s, swing, 1/s, and cosine of the tilt (18°).
const CALM_SPEED: f64 = 1.0;
const CALM_SWING: f64 = 0.3;
const CALM_TILT: f64 = 0.95;

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
    /// Time without a good state, without attitude or body rate, and of calm in hold, s.
    blind: T,
    unturned: T,
    calm: T,
    envelope: Envelope<T>,
    motion: Motion<T>,
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
            cable: Cable::new(&vehicle, period, most_along),
            payload: Payload::new(&vehicle, policy.payload_lost),
            landing: Landing::begin(),
            footing: Footing::none(),
            trim: Vector3::zeros(),
            from: T::zero(),
            blind: T::zero(),
            unturned: T::zero(),
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
        let fault = match measured.state {
            None => Fault::NoState,
            Some(state) => match state.check() {
                Ok(()) => match self.believe(state, uav) {
                    Ok(uav) => {
                        self.unturned = T::zero();
                        return self.with_load(state, uav, measured.specific_force);
                    }
                    Err(fault) => fault,
                },
                Err(channel) => {
                    if let Some(output) = self.mended(state, channel, &measured) {
                        return output;
                    }
                    Fault::State(channel)
                }
            },
        };
        self.blind += self.sampler.period();
        if let Some(output) = self.carried(fault, uav, measured.specific_force) {
            return output;
        }
        if self.fault != Some(Fault::Caught) {
            self.fault = Some(fault);
        }
        match uav {
            Some(uav) => self.without_load(uav, measured.specific_force),
            None => self.without_state(),
        }
    }

    /// The UAV's own navigation, unless the load's is to be believed rather. Where both have jumped
    /// what they are measured from has moved.
    ///
    /// # Errors
    /// The load is measured in flight where it can't hang from the UAV, or does not move as its
    /// velocity says.
    #[inline]
    fn believe<'a>(&mut self, state: &State<T>, uav: Option<&'a Uav<T>>) -> Result<Option<&'a Uav<T>>, Fault> {
        let Some(uav) = uav else { return Ok(None) };
        if matches!(self.mode, Mode::Off | Mode::Idle) {
            return Ok(Some(uav));
        }
        match self.motion.is_off(state, uav) {
            [false, true] if self.is_hung() => return Ok(None),
            [true, false] => return Err(Fault::Contradiction),
            _ => {}
        }
        let line = state.position - uav.position;
        if self.cable.is_contradicted(self.sampler.vehicle(), &line, &state.rod) {
            // Nor was the last state one to carry on.
            self.blind = self.blind.max(self.policy.coast);
            return Err(Fault::Contradiction);
        }
        Ok(Some(uav))
    }

    /// Whether load and UAV are a cable's length apart, in flight.
    fn is_hung(&self) -> bool {
        let is_flying = matches!(self.mode, Mode::Join | Mode::Follow | Mode::Hold | Mode::Land);
        is_flying && !self.cable.is_slack() && !self.landing.is_set_down()
    }

    /// Whether the model can say what has become of the last state: not for long, and only with a
    /// cable that pulls.
    fn may_carry(&self) -> bool {
        self.is_hung() && self.blind <= self.policy.coast
    }

    /// A step on what the model makes of the last state. Its `fault` is this step's alone: states
    /// may come at a lower rate than commands.
    #[cold]
    fn carried(&mut self, fault: Fault, uav: Option<&Uav<T>>, specific: Option<Vector3<T>>) -> Option<Output<T>> {
        let state = self.may_carry().then(|| self.sampler.carry()).filter(|state| state.check().is_ok())?;
        let velocity = self.now(&state, uav).velocity;
        let thrust = self.sampler.applied().thrust;
        self.cable.sample(self.sampler.vehicle(), &velocity, &state.attitude, thrust, specific);
        self.change_mode(Some(&state), uav);
        let output = self.fly(&state, uav);
        Some(Output { fault: output.fault.or(Some(fault)), ..output })
    }

    /// A step on a state of which attitude or body rate is missing, from the other of them. It is
    /// good enough for hold.
    #[cold]
    fn mended(&mut self, state: &State<T>, channel: Channel, measured: &Measured<'_, T>) -> Option<Output<T>> {
        let (fault, period) = (Fault::State(channel), self.sampler.period());
        self.unturned += period;
        let may_lead = channel == Channel::BodyRate || self.unturned <= T::lit(LED);
        if matches!(self.mode, Mode::Off | Mode::Idle | Mode::Fault) || self.blind > T::zero() || !may_lead {
            return None;
        }
        let state = mended(state, channel, &self.sampler.carry(), period)?;
        let uav = measured.uav.map(|uav| Uav { attitude: state.attitude, body_rate: state.body_rate, ..*uav });
        let uav = self.believe(&state, uav.as_ref().filter(|uav| uav.check().is_ok())).ok()?;
        if self.unturned > self.policy.coast && matches!(self.mode, Mode::Join | Mode::Follow) {
            self.enter_hold(&self.now(&state, uav), Some(fault));
        }
        self.calm = T::zero();
        let output = self.with_load(&state, uav, measured.specific_force);
        Some(Output { fault: output.fault.or(Some(fault)), ..output })
    }

    /// A step on a good state.
    #[inline]
    fn with_load(&mut self, state: &State<T>, uav: Option<&Uav<T>>, specific: Option<Vector3<T>>) -> Output<T> {
        let length = self.sampler.vehicle().params().rod_length;
        let velocity = match uav {
            Some(uav) => uav.velocity,
            None => state.velocity - state.rod_rate * length,
        };
        if self.blind > T::zero() {
            if !self.may_carry() {
                self.sampler.resume(state);
                self.cable.resume(&velocity);
            }
            self.blind = T::zero();
        }
        let thrust = self.sampler.applied().thrust;
        self.cable.sample(self.sampler.vehicle(), &velocity, &state.attitude, thrust, specific);
        if let Some(uav) = uav {
            let line = state.position - uav.position;
            self.cable.watch(self.sampler.vehicle(), Some(line), self.watching());
        }
        self.change_mode(Some(state), uav);
        match self.mode {
            // In fault with a good state: the rotors were cut.
            Mode::Off | Mode::Fault => self.ground(Some(state), T::zero()),
            Mode::Idle => self.ground(Some(state), self.sampler.actuation().least_thrust()),
            _ => self.fly(state, uav),
        }
    }

    /// A step on the UAV alone.
    #[cold]
    fn without_load(&mut self, uav: &Uav<T>, specific: Option<Vector3<T>>) -> Output<T> {
        let thrust = self.sampler.applied().thrust;
        self.cable.sample(self.sampler.vehicle(), &uav.velocity, &uav.attitude, thrust, specific);
        self.cable.watch(self.sampler.vehicle(), None, self.watching());
        if matches!(self.mode, Mode::Join | Mode::Follow) {
            self.enter_hold(uav, None);
        }
        self.change_mode(None, Some(uav));
        match self.mode {
            Mode::Off | Mode::Fault => self.ground(None, T::zero()),
            Mode::Idle => self.ground(None, self.sampler.actuation().least_thrust()),
            _ => self.hold(None, uav, None),
        }
    }

    /// How the cable is looked at in the mode that there is.
    fn watching(&self) -> Watching {
        match self.mode {
            Mode::Off | Mode::Idle | Mode::TakeOff => Watching::Not,
            Mode::Land => Watching::Against,
            _ => Watching::Learning,
        }
    }

    /// Forgets what was known of cable and payload, at `state` under `thrust`.
    #[inline(never)]
    fn begin(&mut self, state: &State<T>, thrust: T) {
        self.motion.forget();
        self.cable.begin(self.sampler.vehicle(), state, thrust);
        self.payload.leave();
        self.trim = Vector3::zeros();
    }

    /// By the law, or by hold.
    #[inline]
    fn fly(&mut self, state: &State<T>, uav: Option<&Uav<T>>) -> Output<T> {
        let is_slack = self.cable.is_slack() || self.landing.is_set_down() || self.mode == Mode::TakeOff;
        let known = is_slack.then(|| self.sampler.freeze(state));
        self.sampler.sample(state);
        if let Some(known) = known {
            self.sampler.keep(known);
            return self.fly_slack(state, uav);
        }
        if matches!(self.mode, Mode::Join | Mode::Follow) {
            self.follow(state, uav)
        } else {
            self.hold_at(state, uav)
        }
    }

    /// With a cable that does not pull no law flies, and the observers keep what they know.
    #[cold]
    fn fly_slack(&mut self, state: &State<T>, uav: Option<&Uav<T>>) -> Output<T> {
        if matches!(self.mode, Mode::Join | Mode::Follow) {
            self.enter_hold(&self.now(state, uav), Some(Fault::Slack));
        }
        self.hold_at(state, uav)
    }

    /// The UAV by its own navigation, or from `state` with a taut cable.
    #[inline(never)]
    fn now(&self, state: &State<T>, uav: Option<&Uav<T>>) -> Uav<T> {
        uav.copied().unwrap_or_else(|| Uav::of(state, self.sampler.vehicle()))
    }

    #[inline(never)]
    fn hold_at(&mut self, state: &State<T>, uav: Option<&Uav<T>>) -> Output<T> {
        let now = self.now(state, uav);
        let aim = if uav.is_none() { self.around(state) } else { None };
        self.hold(Some(state), &now, aim.as_ref())
    }

    /// Where the rod is all that tells of the UAV: what to fly once a landing has set down the
    /// load.
    #[inline(never)]
    fn around(&mut self, state: &State<T>) -> Option<Aim<T>> {
        let vehicle = self.sampler.vehicle();
        self.cable.average(vehicle, self.watching());
        if self.mode != Mode::Land {
            return None;
        }
        let known = (self.sampler.applied().thrust, self.cable.down(vehicle), &self.cable.pull(vehicle));
        self.landing.around(vehicle, state, known, self.policy.descent, self.sampler.period())
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

    /// The edges that requests and good states open: the table's rows.
    #[inline]
    fn change_mode(&mut self, state: Option<&State<T>>, uav: Option<&Uav<T>>) {
        if (self.mode, self.request) != (Mode::Follow, Request::Follow) {
            self.look_for_edge(state, uav);
        }
    }

    #[inline(never)]
    fn look_for_edge(&mut self, state: Option<&State<T>>, uav: Option<&Uav<T>>) {
        let to = match (self.mode, self.request) {
            (Mode::Off, Request::Off | Request::Land) => Mode::Off,
            (Mode::Off, _) => Mode::Idle,
            (Mode::Idle, Request::Off | Request::Idle) => Mode::Idle,
            (Mode::Idle, Request::Land) => Mode::Off,
            (Mode::Idle, _) if uav.is_some() => Mode::TakeOff,
            (Mode::Idle, _) if state.is_some_and(|state| !self.may_lift(state)) => Mode::Idle,
            (Mode::Idle, _) => Mode::Hold,
            (Mode::Hold, Request::Land) if self.fault == Some(Fault::Caught) => Mode::Hold,
            (Mode::TakeOff | Mode::Join | Mode::Follow | Mode::Hold | Mode::Land, Request::Land) => Mode::Land,
            (Mode::TakeOff, Request::Follow | Request::Hold) if !self.has_risen(uav) => Mode::TakeOff,
            (Mode::Join, Request::Follow) if self.law.approach().is_active() => Mode::Join,
            (Mode::Join | Mode::Follow, Request::Follow) => Mode::Follow,
            (Mode::Hold, Request::Follow) if state.is_some() && self.may_follow() => Mode::Join,
            (Mode::Fault, _) if self.policy.lost == Lost::Cut => Mode::Fault,
            _ => Mode::Hold,
        };
        if to == self.mode {
            return;
        }
        match (to, state, uav) {
            (Mode::Join, Some(state), _) => self.join(state, uav),
            (Mode::TakeOff | Mode::Hold | Mode::Land, _, Some(uav)) => self.change_to(to, uav),
            (Mode::TakeOff | Mode::Hold | Mode::Land, Some(state), None) => {
                self.change_to(to, &self.now(state, None));
            }
            _ => self.mode = to,
        }
    }

    #[inline(never)]
    fn change_to(&mut self, mode: Mode, uav: &Uav<T>) {
        if self.mode == Mode::TakeOff {
            // What pulls now is the usual.
            self.cable.learn();
        }
        // A landing goes on from where hold has settled.
        let goes_on = (self.mode, mode) == (Mode::Hold, Mode::Land) && self.hold.has_settled(uav);
        if !goes_on {
            self.enter_hold(uav, None);
        }
        self.mode = mode;
        self.from = uav.position.z;
    }

    /// Without the UAV's own navigation nothing rises but what hangs by a rod that can be flown: a
    /// vehicle that stands beside its load is told why it stays there.
    #[cold]
    fn may_lift(&mut self, state: &State<T>) -> bool {
        let vehicle = self.sampler.vehicle();
        let margins = Margins::of_motion(vehicle, state, vehicle.hover_thrust());
        let standing = self.envelope.assess(&margins, T::one());
        if let Standing::Beyond(margin) = standing {
            self.fault = Some(Fault::Margin(margin));
        }
        !matches!(standing, Standing::Beyond(_))
    }

    /// Whether a take-off is over.
    #[cold]
    fn has_risen(&self, uav: Option<&Uav<T>>) -> bool {
        let enough = self.sampler.vehicle().params().rod_length + self.policy.clear;
        uav.is_some_and(|uav| self.from - uav.position.z > enough)
    }

    /// Joins the path, if the vehicle is where the law can fly it.
    #[cold]
    fn join(&mut self, state: &State<T>, uav: Option<&Uav<T>>) {
        let [acceleration, ..] = self.sampler.continued(state);
        if acceleration.abs() > T::lit(JOINING) || self.standing(state) != Standing::Inside {
            return;
        }
        match self.law.join(state, &self.pace) {
            Ok(()) => {
                self.sampler.carry_on(state);
                self.mode = Mode::Join;
            }
            Err(Refused::Searching) => {}
            Err(_) => self.enter_hold(&self.now(state, uav), Some(Fault::NoPath)),
        }
    }

    /// How the vehicle stands in the envelope under what is being applied; the path's margins are
    /// the law's to say.
    #[inline(never)]
    fn standing(&self, sampled: &State<T>) -> Standing {
        let margins = Margins::of_motion(self.sampler.vehicle(), sampled, self.sampler.applied().thrust);
        self.envelope.assess(&margins, T::one())
    }

    fn may_follow(&self) -> bool {
        self.fault != Some(Fault::PayloadLost)
            && !self.cable.is_slack()
            && self.calm >= self.policy.calm
            && (self.policy.resume || self.fault.is_none())
    }

    #[inline(never)]
    fn enter_hold(&mut self, uav: &Uav<T>, fault: Option<Fault>) {
        self.hold = Hold::from(self.sampler.vehicle(), uav, &self.sampler.swing());
        self.cable.yield_to(self.sampler.most_along());
        self.sampler.leave();
        self.mode = Mode::Hold;
        self.calm = T::zero();
        self.payload.leave();
        self.landing = Landing::begin();
        self.footing = Footing::none();
        self.fault = fault.or(self.fault);
    }

    /// The law's command for when it acts, if its answer can be flown; hold's, if not.
    // Apart, and so is hold: neither needs the other's stack.
    #[inline(never)]
    fn follow(&mut self, state: &State<T>, uav: Option<&Uav<T>>) -> Output<T> {
        self.sampler.ask(&mut self.law);
        let answer = self.law.answer();
        let standing = self.envelope.assess(&answer.margins, self.law.approach().path_det());
        let fault = if let Standing::Beyond(margin) = standing {
            Some(Fault::Margin(margin))
        } else if !answer.is_finite() {
            Some(Fault::NotFinite)
        } else if self.payload.is_lost(self.sampler.weight(), self.cable.usual(), self.sampler.period()) {
            Some(Fault::PayloadLost)
        } else {
            None
        };
        if fault.is_some() {
            self.enter_hold(&self.now(state, uav), fault);
            return self.hold_at(state, uav);
        }
        let command = self.sampler.accept(&mut self.law);
        self.is_by_law = true;
        let warning = if let Standing::Warning(margin) = standing { Some(margin) } else { None };
        self.output(command, warning)
    }

    /// Hold's command for when it acts, from the UAV and what is known of the rod now; it goes for
    /// `aim` where there is one.
    #[inline(never)]
    fn hold(&mut self, state: Option<&State<T>>, now: &Uav<T>, aim: Option<&Aim<T>>) -> Output<T> {
        let period = self.sampler.period();
        let (aimed, pull, swing, velocity) = if let Some(&Aim { uav, target, velocity, pull }) = aim {
            self.hold.aim(target, velocity);
            (uav, pull, None, velocity)
        } else {
            let velocity = self.wanted_velocity(state, now);
            let is_taut = state.is_some_and(|state| self.hangs(&(state.position - now.position)));
            if is_taut && self.sampler.has_bounced() {
                self.cable.yield_to(self.sampler.most_along());
            }
            let swing = is_taut.then(|| self.sampler.swing());
            (*now, self.cable.pull(self.sampler.vehicle()), swing, velocity)
        };
        let vehicle = self.sampler.vehicle();
        let uav = self.sampler.look_ahead(&aimed, &pull);
        let mut wanted = self.hold.step(vehicle, &uav, &pull, swing.as_ref(), &velocity, period);
        self.trim -= (self.trim + self.sampler.torque()) * (period / T::lit(TRIMMED)).min(T::one());
        wanted.torque += self.trim;
        if self.mode == Mode::Land {
            let may_hang = state.is_none_or(|state| self.may_hang(&(state.position - now.position)));
            match self.footing.feel(self.hold.left_above(now), now.body_rate.z, may_hang, period) {
                Carried::Flying => self.hold.turn(self.footing.turn()),
                Carried::Standing => {
                    self.mode = Mode::Off;
                    self.request = Request::Off;
                    return self.ground(state, T::zero());
                }
                Carried::Hanging => self.enter_hold(now, Some(Fault::Caught)),
            }
        }
        let is_calm = state.is_some_and(|state| {
            is_within(&state.velocity, T::lit(CALM_SPEED * CALM_SPEED))
                && is_within(&state.rod_rate, T::lit(CALM_SWING * CALM_SWING))
                && state.attitude.m33 > T::lit(CALM_TILT)
        });
        self.calm = if is_calm { self.calm + period } else { T::zero() };
        if self.fault == Some(Fault::PayloadLost) {
            self.look_for_load();
        }
        if self.request == Request::Follow && self.calm >= self.policy.calm && self.cable.is_slack() {
            // Nothing else keeps it from the path.
            self.fault = self.fault.or(Some(Fault::Slack));
        }
        let warning = match state.map(|state| self.standing(state)) {
            None | Some(Standing::Inside) => None,
            Some(Standing::Warning(margin) | Standing::Beyond(margin)) => Some(margin),
        };
        let command = self.sampler.commit(&wanted, T::zero(), T::zero());
        self.output(command, warning)
    }

    /// What pulls as it did was unloaded, not lost: the path may be joined again.
    #[cold]
    fn look_for_load(&mut self) {
        let [_, now] = self.cable.down(self.sampler.vehicle());
        if self.payload.is_back(now, self.sampler.period()) {
            self.fault = Some(Fault::Slack);
        }
    }

    /// Whether the load hangs from a taut cable, by the `line` to it, m.
    fn hangs(&self, line: &Vector3<T>) -> bool {
        !self.cable.is_slack() && self.is_stretched(line)
    }

    /// Whether the UAV may hang from its load, by the `line` to it, m.
    fn may_hang(&self, line: &Vector3<T>) -> bool {
        line.z < T::zero() && self.is_stretched(line)
    }

    /// Whether the cable may pull, by the `line` to the load, m.
    fn is_stretched(&self, line: &Vector3<T>) -> bool {
        let near = self.sampler.vehicle().params().rod_length * T::lit(SHORTENED);
        !is_within(line, near * near)
    }

    /// The velocity that hold goes for: none, or that of a take-off or landing.
    #[inline(never)]
    fn wanted_velocity(&mut self, state: Option<&State<T>>, now: &Uav<T>) -> Vector3<T> {
        match self.mode {
            Mode::Land => {
                let (is_slack, period) = (self.cable.is_slack(), self.sampler.period());
                let is_carried = self.hold.left_above(now) > T::lit(CARRIED);
                let load = state.map(|state| state.position);
                let room = self.sampler.vehicle().params().rod_length;
                let Policy { descent, aside, .. } = self.policy;
                self.landing.velocity(load, now, (is_slack, is_carried), (descent, aside, room), period)
            }
            Mode::TakeOff => Vector3::new(T::zero(), T::zero(), -self.policy.rise),
            _ => Vector3::zeros(),
        }
    }

    /// A step without a good state.
    #[cold]
    fn without_state(&mut self) -> Output<T> {
        let command = match self.mode {
            Mode::Off => Command::zero(),
            Mode::Idle => Command::of_thrust(self.sampler.actuation().least_thrust()),
            Mode::TakeOff | Mode::Join | Mode::Follow | Mode::Hold | Mode::Land
                if self.blind <= self.policy.coast =>
            {
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
}
