//! The control side: when the law is stepped, on which state, and what becomes of its command.
//!
//! ```text
//!         arm                first good state
//!   OFF ───────▶ OFF, armed ──────────────────▶ IDLE, TAKE-OFF, JOIN, FOLLOW, HOLD, LAND, FAULT: the supervisor's
//!    ▲                                                          │
//!    └──────────── landed; or disarm, from anywhere ────────────┘
//! ```
//!
//! Where nothing was asked for, or to idle, or where the state says that it stands, the first good
//! state finds a vehicle on the ground, whose rotors turn at their least thrust. Where more was, it
//! finds one in flight, which is taken over from hover thrust and does that. From there on every
//! control period steps the supervisor (`controller::Supervisor`, which has the modes' table) on the
//! newest state: a missing one is passed on as absent; the supervisor goes on by its model, then
//! sinks or cuts. What the pilot asks for ([`Autopilot::request`]) lasts until disarming.

use controller::{Actuation as _, Command, Fault, Margin, Mode, Request, State};
use link::dialect::{
    LOAD_COMMAND_DATA, LOAD_COUNTERS_DATA, LOAD_STATE_DATA, LOAD_TELEMETRY_DATA, LoadAction, LoadFault, LoadSeen,
    MavLandedState,
};

use rig::{Output, Rig, SetupError, parameter};

use crate::epoch::Epoch;
use crate::failsafe::{Failsafe, Loss};
use crate::report;
use crate::seen::{Navigation, Seen};
use crate::settings::{Setting, Settings};

/// Arming needs a state no older than this, s.
const FRESH_S: f32 = 0.5;
/// The kill pin counts when it is high for so many control steps in a row: no spike stops a flight.
const PRESSED: u8 = 3;

/// What drives the control step, and whether the rotors do as they are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// The timer, with the latest state; rotors on.
    Flight,
    /// Each state frame; rotors off, since the vehicle is a simulated one.
    Lockstep,
    /// The timer, with the latest state; rotors off.
    RealTime,
}

/// What the board found out when it started.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Boot {
    /// The watchdog caused the reset.
    pub by_watchdog: bool,
    /// Watchdog resets since power-on.
    pub watchdog_resets: u32,
    /// The crystal did not start.
    pub internal_clock: bool,
    /// Core clock, Hz.
    pub core_hz: u32,
}

/// What happened since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Control steps on a good state.
    pub steps: u32,
    /// Control steps that ended after their period.
    pub overruns: u32,
    /// Control periods without a new state.
    pub missed: u32,
    /// States refused.
    pub refused: u32,
    /// Times a fault ended the law's flight.
    pub fallbacks: u32,
    /// Most counts of the core's timer that a control step took.
    pub worst_cycles: u32,
}

/// Why it is not armed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ArmRefused {
    /// The parameters make no controller.
    Setup(SetupError<f32>),
    /// Limits and rotors give no more than this share of the hover thrust.
    Weak(f32),
    /// There has been no good state just now.
    NoState,
    /// Good states come this far apart, s, which is longer than `POL_COAST`, s.
    Slow(f32, f32),
    /// A kill switch is on.
    Killed,
    /// This is lost.
    Lost(Loss),
}

impl ArmRefused {
    /// Whether it may be armed as it is set up, but not now.
    pub(crate) fn is_for_now(&self) -> bool {
        !matches!(self, Self::Setup(_) | Self::Weak(_))
    }
}

impl core::fmt::Display for ArmRefused {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Setup(error) => error.fmt(f),
            Self::Weak(share) => write!(f, "not armed: {share:.2} of hover is all (ARM_THRUST)"),
            Self::NoState => f.write_str("not armed: no good state just now"),
            Self::Slow(apart, most) => write!(f, "not armed: states {apart:.2} s apart, POL_COAST {most}"),
            Self::Killed => f.write_str("not armed: the kill switch is on"),
            Self::Lost(Loss::Station) => f.write_str("not armed: ground station lost"),
            Self::Lost(Loss::Stick) => f.write_str("not armed: stick or radio lost"),
            Self::Lost(Loss::Battery) => f.write_str("not armed: battery below FS_BAT_PCT"),
        }
    }
}

impl core::error::Error for ArmRefused {}

/// Something that has happened and that the pilot must hear of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notice {
    /// Nothing yet.
    Nothing,
    /// The pilot's switch, or the board's, has stopped the rotors.
    Killed,
    /// Too long without a state: the rotors have stopped.
    Blind,
    /// This is lost, and the configured action taken.
    Lost(Loss),
}

/// What was wrong with the last control period's state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Absence {
    /// None came.
    Missing,
    /// What came was from another time.
    Stale,
    /// What came was the last one again, to the last bit, which in flight no measurement is.
    Frozen,
    /// It was no state.
    Bad,
}

/// The outcome of one control step.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// For the link. Its `rotor` is what the law wants, though the vehicle may be a simulated one.
    pub command: LOAD_COMMAND_DATA,
    /// For the link, when it is its turn.
    pub telemetry: Option<LOAD_TELEMETRY_DATA>,
    /// What the rotors get, from 0 to 1: zero when not armed, and when the vehicle is a simulated
    /// one.
    pub outputs: [f32; 4],
}

/// The flight program's control side.
#[derive(Clone, Debug)]
pub struct Autopilot {
    settings: Settings,
    boot: Boot,
    counters: Counters,
    /// While armed.
    rig: Option<Rig<f32>>,
    request: Request,
    /// Newest state that has come in flight and was not used yet.
    inbox: Option<LOAD_STATE_DATA>,
    navigation: Navigation,
    /// The UAV's own navigation was there at the last control period.
    navigates: bool,
    /// The vehicle is known to stand on the ground.
    stands: bool,
    epoch: Epoch,
    /// The last state that has come, and what was wrong with those since the last control period.
    newest: Option<State<f32>>,
    refused: Option<Absence>,
    /// What the last control period lacked.
    absence: Option<Absence>,
    /// The fault that stands: not one of a state that the model has stood in for.
    fault: Option<Fault>,
    /// Time since the last good state, and in which rotors turned without one, s.
    since_state_s: f32,
    blind_s: f32,
    /// Times without a state between the last three good ones, s.
    apart_s: [f32; 2],
    failsafe: Failsafe,
    /// The pilot's kill switch is on; and for how many steps the board's has been, up to
    /// [`PRESSED`].
    kill: bool,
    kill_pin: u8,
    /// The last notice, and how many there have been.
    notice: (u32, Notice),
    last: Option<Answer>,
    overrun: bool,
    until_telemetry: u32,
}

impl Autopilot {
    /// Not armed, with all parameters at their defaults.
    #[must_use]
    pub fn new(boot: Boot) -> Self {
        Self::with(Settings::default(), boot)
    }

    /// Not armed, with these `settings`.
    #[must_use]
    pub fn with(settings: Settings, boot: Boot) -> Self {
        Self {
            settings,
            boot,
            counters: Counters::default(),
            rig: None,
            request: Request::Idle,
            inbox: None,
            navigation: Navigation::new(),
            navigates: false,
            stands: false,
            epoch: Epoch::default(),
            newest: None,
            refused: None,
            absence: None,
            fault: None,
            since_state_s: f32::INFINITY,
            blind_s: 0.0,
            apart_s: [0.0; 2],
            failsafe: Failsafe::default(),
            kill: false,
            kill_pin: 0,
            notice: (0, Notice::Nothing),
            last: None,
            overrun: false,
            until_telemetry: 0,
        }
    }

    /// The parameters.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The parameters, to be changed; `None` when armed.
    pub fn settings_mut(&mut self) -> Option<&mut Settings> {
        if self.is_armed() { None } else { Some(&mut self.settings) }
    }

    /// What drives the control step.
    #[must_use]
    pub fn drive(&self) -> Drive {
        match self.settings.get(Setting::DRIVE) as u8 {
            1 => Drive::Lockstep,
            2 => Drive::RealTime,
            _ => Drive::Flight,
        }
    }

    /// The control period, s.
    #[must_use]
    pub fn period_s(&self) -> f32 {
        self.settings.rig().get(parameter!("CTL_PERIOD"))
    }

    /// What the vehicle is doing.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.rig.as_ref().map_or(Mode::Off, |rig| rig.output().mode)
    }

    /// Why it is not doing what was asked for: the last fault since something else was.
    #[must_use]
    pub fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// Whether rotors may turn.
    #[must_use]
    pub fn is_armed(&self) -> bool {
        self.rig.is_some()
    }

    /// Whether it flies, or falls.
    #[must_use]
    pub fn is_flying(&self) -> bool {
        !matches!(self.mode(), Mode::Off | Mode::Idle)
    }

    /// Whether it is on the ground, as far as is known.
    #[must_use]
    pub(crate) fn landed_state(&self) -> MavLandedState {
        match self.mode() {
            Mode::Off | Mode::Idle if self.stands => MavLandedState::MAV_LANDED_STATE_ON_GROUND,
            Mode::Off | Mode::Idle => MavLandedState::MAV_LANDED_STATE_UNDEFINED,
            Mode::TakeOff => MavLandedState::MAV_LANDED_STATE_TAKEOFF,
            Mode::Land => MavLandedState::MAV_LANDED_STATE_LANDING,
            _ => MavLandedState::MAV_LANDED_STATE_IN_AIR,
        }
    }

    /// What the last control period's state lacked.
    #[must_use]
    pub fn absence(&self) -> Option<Absence> {
        self.absence
    }

    /// The margin for which it holds instead of following, where nothing else keeps it from that.
    #[must_use]
    pub fn waits_for(&self) -> Option<Margin> {
        let Output { mode, fault, warning, .. } = *self.rig.as_ref()?.output();
        let waits = mode == Mode::Hold && fault.is_none() && self.request == Request::Follow;
        warning.filter(|_| waits)
    }

    /// What was asked for last.
    #[must_use]
    pub fn requested(&self) -> Request {
        if self.is_armed() || self.request != Request::Idle { self.request } else { Request::Off }
    }

    /// How many notices there have been, and the last one.
    #[must_use]
    pub fn notice(&self) -> (u32, Notice) {
        self.notice
    }

    fn note(&mut self, notice: Notice) {
        self.notice = (self.notice.0.wrapping_add(1), notice);
    }

    /// A ground station lives.
    pub fn hear_station(&mut self) {
        self.failsafe.hear_station();
    }

    /// The pilot's stick or radio lives; with its kill switch on, the rotors stop.
    pub fn hear_stick(&mut self, kill: bool) {
        self.failsafe.hear_stick();
        self.kill = kill;
        self.obey_kill();
    }

    /// Whether the board's kill pin is high, with which the rotors stop. To be called before each
    /// control step.
    pub fn sense_kill_pin(&mut self, is_high: bool) {
        self.kill_pin = if is_high { (self.kill_pin + 1).min(PRESSED) } else { 0 };
        self.obey_kill();
    }

    fn is_killed(&self) -> bool {
        self.kill || self.kill_pin >= PRESSED
    }

    fn obey_kill(&mut self) {
        if self.is_killed() && self.is_armed() {
            self.disarm();
            self.note(Notice::Killed);
        }
    }

    /// What the UAV's own navigation has to say, beside the states.
    pub(crate) fn navigation_mut(&mut self) -> &mut Navigation {
        &mut self.navigation
    }

    /// The battery has so much left, %.
    pub fn hear_battery(&mut self, percent: i8) {
        self.failsafe.hear_battery(percent);
    }

    /// Asks for something, now or for after arming.
    pub fn request(&mut self, request: Request) {
        self.request = request;
    }

    /// Takes off, to hold.
    ///
    /// # Errors
    /// Why not now.
    pub fn take_off(&mut self) -> Result<(), &'static str> {
        match self.mode() {
            Mode::TakeOff => Ok(()),
            Mode::Idle if self.navigates => {
                self.request(Request::Hold);
                Ok(())
            }
            Mode::Idle => Err("take-off needs the UAV's own position"),
            Mode::Off => Err("to take off, arm on the ground first"),
            _ => Err("in flight already"),
        }
    }

    /// Lands where it is; on the ground it stops its rotors.
    ///
    /// # Errors
    /// Why not now.
    pub fn land(&mut self) -> Result<(), &'static str> {
        if self.mode() == Mode::Off {
            return Err("not in flight");
        }
        self.request(Request::Land);
        Ok(())
    }

    /// What the board found out when it started.
    #[must_use]
    pub fn boot(&self) -> Boot {
        self.boot
    }

    /// What happened since the start.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Makes the controller of the parameters as they are, to be started by the next good state.
    /// Armed already, it does nothing.
    ///
    /// # Errors
    /// Why not; it stays disarmed.
    pub fn arm(&mut self) -> Result<(), ArmRefused> {
        if !self.is_armed() {
            let rig = Rig::new(self.settings.rig()).map_err(ArmRefused::Setup)?;
            let share = rig.actuators().largest_thrust() / rig.vehicle().hover_thrust();
            if share < self.settings.get(Setting::ARMING_THRUST) {
                return Err(ArmRefused::Weak(share));
            }
            if self.is_killed() {
                return Err(ArmRefused::Killed);
            }
            if let Some(loss) = Loss::ALL.into_iter().find(|loss| self.failsafe.is_lost(*loss, &self.settings)) {
                return Err(ArmRefused::Lost(loss));
            }
            if self.drive() == Drive::Flight && self.since_state_s > FRESH_S {
                return Err(ArmRefused::NoState);
            }
            let most = self.settings.rig().get(parameter!("POL_COAST"));
            // One gap is no rate.
            let apart_s = self.apart_s[0].min(self.apart_s[1]);
            if self.drive() == Drive::Flight && apart_s > most {
                return Err(ArmRefused::Slow(apart_s, most));
            }
            self.rig = Some(rig);
            self.inbox = None;
            self.epoch = Epoch::default();
            self.newest = None;
            self.blind_s = 0.0;
            self.last = None;
            self.until_telemetry = 0;
        }
        Ok(())
    }

    /// Rotors off. What was asked for is forgotten.
    pub fn disarm(&mut self) {
        self.stands &= !self.is_flying();
        self.rig = None;
        self.fault = None;
        self.request = Request::Idle;
        self.last = None;
    }

    /// A state for the coming control period: flight and real time. One from another time than the
    /// last, earlier or seconds later, is refused; but for the third in a row that agree on
    /// another, which is that of a clock that has restarted. Of a real vehicle in flight so is one
    /// that is the last again: an estimator that has stopped. A simulated one can be at rest to the
    /// bit.
    pub fn receive(&mut self, frame: &LOAD_STATE_DATA) {
        if !self.epoch.accept(frame.time_usec) {
            self.counters.refused = self.counters.refused.wrapping_add(1);
            self.refused = Some(Absence::Stale);
            return;
        }
        let mut frame = frame.clone();
        let state = Seen::of(&frame).state;
        if state.is_some() {
            let is_again = self.newest == state && self.drive() == Drive::Flight && self.is_flying();
            self.newest = state;
            if is_again {
                frame.seen |= LoadSeen::LOAD_SEEN_NO_LOAD;
                self.counters.refused = self.counters.refused.wrapping_add(1);
                self.refused = Some(Absence::Frozen);
            }
        }
        self.inbox = Some(frame);
    }

    /// A control period by the timer: flight and real time.
    pub fn tick(&mut self) -> Answer {
        let frame = self.inbox.take();
        let period_s = self.period_s();
        self.navigation.pass(period_s);
        for (loss, wanted) in self.failsafe.advance(period_s, &self.settings).into_iter().flatten() {
            self.lose(loss, wanted);
        }
        self.control(frame.as_ref())
    }

    /// A control period by a state frame: lockstep. The same sequence number again gets the same
    /// answer again.
    pub fn lockstep(&mut self, frame: &LOAD_STATE_DATA) -> Answer {
        if let Some(last) = &self.last {
            let ahead = frame.sequence.wrapping_sub(last.command.sequence);
            if ahead == 0 {
                return last.clone();
            }
            if ahead != 1 && frame.action == LoadAction::LOAD_ACTION_CONTINUE {
                return self.out_of_step(frame);
            }
        } else if self.is_armed() && frame.action == LoadAction::LOAD_ACTION_CONTINUE {
            // Armed and never started: after a reset, say, that the sender has not noticed.
            return self.out_of_step(frame);
        }
        let answer = self.control(Some(frame));
        self.last = Some(answer.clone());
        answer
    }

    /// Notes what the step just made cost. An answer given again has its cost already.
    pub fn note_cost(&mut self, answer: &mut Answer, cycles: u32) {
        if answer.command.cycles > 0 {
            return;
        }
        self.counters.worst_cycles = self.counters.worst_cycles.max(cycles);
        answer.command.cycles = cycles;
        if let Some(last) = self.last.as_mut().filter(|last| last.command.sequence == answer.command.sequence) {
            last.command.cycles = cycles;
        }
    }

    /// Notes that the step just made ended after its period.
    pub fn note_overrun(&mut self) {
        self.counters.overruns = self.counters.overruns.wrapping_add(1);
        self.overrun = true;
    }

    /// All counters, for the link; the frames' and bytes' are the server's and the board's to fill
    /// in.
    #[must_use]
    pub fn counters_message(&self) -> LOAD_COUNTERS_DATA {
        let Counters { steps, overruns, missed, refused, fallbacks, worst_cycles } = self.counters;
        LOAD_COUNTERS_DATA {
            steps,
            overruns,
            missed,
            refused,
            fallbacks,
            worst_cycles,
            bad_frames: 0,
            lost_bytes: 0,
            watchdog_resets: self.boot.watchdog_resets,
            core_hz: self.boot.core_hz,
        }
    }

    /// Does what is configured for a loss; a landing is not called off for it.
    fn lose(&mut self, loss: Loss, wanted: Option<Request>) {
        if !self.is_armed() {
            return;
        }
        self.note(Notice::Lost(loss));
        if let Some(wanted) = wanted
            && self.request != Request::Land
            && self.is_flying()
        {
            self.request(wanted);
        }
    }

    fn out_of_step(&self, frame: &LOAD_STATE_DATA) -> Answer {
        self.nothing(Some(frame), self.standing_faults() | LoadFault::LOAD_FAULT_SEQUENCE)
    }

    /// An answer without a command.
    fn nothing(&self, frame: Option<&LOAD_STATE_DATA>, faults: LoadFault) -> Answer {
        let command = LOAD_COMMAND_DATA {
            time_usec: frame.map_or(0, |frame| frame.time_usec),
            sequence: frame.map_or(0, |frame| frame.sequence),
            faults,
            mode: report::mode(self.mode()),
            ..LOAD_COMMAND_DATA::DEFAULT
        };
        Answer { command, telemetry: None, outputs: [0.0; 4] }
    }

    /// Faults that stand whatever the state is.
    fn standing_faults(&self) -> LoadFault {
        let mut faults = LoadFault::empty();
        faults.set(LoadFault::LOAD_FAULT_NOT_ARMED, !self.is_armed());
        faults.set(LoadFault::LOAD_FAULT_OVERRUN, self.overrun);
        faults.set(LoadFault::LOAD_FAULT_WATCHDOG, self.boot.by_watchdog);
        faults.set(LoadFault::LOAD_FAULT_INTERNAL_CLOCK, self.boot.internal_clock);
        faults | self.failsafe.bits()
    }

    fn control(&mut self, frame: Option<&LOAD_STATE_DATA>) -> Answer {
        let mut faults = self.standing_faults();
        self.overrun = false;
        let seen = match frame {
            Some(frame) if may_start(frame) => Seen::of(frame),
            Some(_) => Seen::bad(),
            None => Seen::default(),
        };
        // In lockstep the same frames have the same answers, whatever comes between them.
        let seen = if self.drive() == Drive::Lockstep { seen } else { seen.or(&self.navigation) };
        let good = seen.good();
        self.navigates = seen.uav().is_some();
        let refused = self.refused.take();
        self.absence = match good {
            Some(_) => None,
            None if seen.is_bad => Some(Absence::Bad),
            None => refused.or(Some(Absence::Missing)),
        };
        let period_s = self.period_s();
        if good.is_some() {
            let apart_s = if self.since_state_s.is_finite() { self.since_state_s } else { 0.0 };
            self.apart_s = [self.apart_s[1], apart_s];
        }
        self.since_state_s = if good.is_some() { 0.0 } else { self.since_state_s + period_s };
        let Some(rig) = &mut self.rig else { return self.nothing(frame, faults) };
        match self.absence {
            None => self.counters.steps = self.counters.steps.wrapping_add(1),
            Some(Absence::Bad) => {
                self.counters.refused = self.counters.refused.wrapping_add(1);
                faults |= LoadFault::LOAD_FAULT_BAD_STATE;
            }
            Some(_) => {
                self.counters.missed = self.counters.missed.wrapping_add(1);
                faults |= LoadFault::LOAD_FAULT_NO_STATE;
            }
        }
        faults.set(LoadFault::LOAD_FAULT_STALE_STATE, refused.is_some());
        if let (Some(frame), Some(state)) = (frame, good) {
            if frame.action == LoadAction::LOAD_ACTION_START {
                self.request = Request::Follow;
            }
            begin(rig, frame, state, self.request);
        }
        let integral = rig.integral();
        let before = rig.mode();
        let phase = frame.map_or(0.0, |frame| frame.reference_phase);
        let mut measured = seen.measured();
        if before == Mode::Off && good.is_none() {
            // Whether it stands or flies, the first good state says.
            measured.uav = None;
        }
        let Output { command, mode, fault, limited, .. } = *rig.step(measured, self.request, phase);
        let is_away = matches!(self.absence, Some(Absence::Missing | Absence::Frozen));
        let is_in_flight = !matches!(mode, Mode::Off | Mode::Idle | Mode::Fault);
        if !(is_away && is_in_flight && self.since_state_s <= self.settings.rig().get(parameter!("POL_COAST"))) {
            self.fault = fault;
        }
        let has_fallen_back = is_flying(before) && self.request == Request::Follow && !is_flying(mode);
        self.counters.fallbacks = self.counters.fallbacks.wrapping_add(u32::from(has_fallen_back));

        faults |= fault.map_or(LoadFault::empty(), report::fault);
        faults.set(LoadFault::LOAD_FAULT_LIMITED, limited);
        let u_zeta = rig.u_zeta();
        let zeta = u_zeta.map_or([0.0; 4], |_| rig.zeta().map(report::number));
        let rotor = rig.duties();
        let mut answer = self.nothing(frame, faults);
        answer.command = LOAD_COMMAND_DATA {
            thrust: command.thrust,
            torque: command.torque.into(),
            zeta,
            u_zeta: u_zeta.unwrap_or(0.0),
            rotor,
            ..answer.command
        };
        if self.drive() == Drive::Flight {
            answer.outputs = rotor;
        }
        if let (Some(frame), Some(state)) = (frame, good)
            && (self.is_telemetry_s_turn() || frame.telemetry != 0)
        {
            answer.telemetry = self.rig.as_ref().map(|rig| report::telemetry(frame.sequence, rig, state, integral));
        }
        let is_down = mode == Mode::Off && (good.is_some() || before != Mode::Off);
        self.stands = mode == Mode::Idle || is_down || mode == Mode::Off && self.stands;
        if is_down {
            self.disarm();
        }
        self.end_blindness(mode, period_s);
        answer
    }

    /// Stops the rotors where they have turned for too long without a state, or in fault.
    fn end_blindness(&mut self, mode: Mode, period_s: f32) {
        let is_blind = mode == Mode::Fault || mode == Mode::Idle && self.absence.is_some();
        self.blind_s = if is_blind { self.blind_s + period_s } else { 0.0 };
        if self.blind_s > self.settings.get(Setting::BLIND_TIMEOUT) {
            self.disarm();
            self.note(Notice::Blind);
        }
    }

    /// Counts a step, and says whether it is one of every `TLM_EVERY`.
    fn is_telemetry_s_turn(&mut self) -> bool {
        let every = self.settings.get(Setting::TELEMETRY_EVERY) as u32;
        let is_turn = every > 0 && self.until_telemetry == 0;
        self.until_telemetry = if is_turn { every - 1 } else { self.until_telemetry.saturating_sub(1) };
        is_turn
    }
}

/// What a good state does to the controller's memory before the step on it.
fn begin(rig: &mut Rig<f32>, frame: &LOAD_STATE_DATA, state: &State<f32>, request: Request) {
    let is_off = rig.mode() == Mode::Off;
    let hover = Command::of_thrust(rig.vehicle().hover_thrust());
    let applied = if is_off { hover } else { rig.output().command };
    // A good state and finite numbers are not refused; if they were, the law would be as it was.
    let begun = match frame.action {
        LoadAction::LOAD_ACTION_START => rig.start(state, frame.zeta),
        LoadAction::LOAD_ACTION_ENGAGE => rig.take_over(state, applied),
        LoadAction::LOAD_ACTION_CONTINUE if is_off && request != Request::Idle => rig.take_over(state, applied),
        LoadAction::LOAD_ACTION_CONTINUE | LoadAction::LOAD_ACTION_STAND => Ok(()),
    };
    debug_assert!(begun.is_ok(), "{begun:?}");
}

/// Whether the frame has a finite ζ, if it is one to start with.
fn may_start(frame: &LOAD_STATE_DATA) -> bool {
    frame.action != LoadAction::LOAD_ACTION_START || frame.zeta.iter().all(|z| z.is_finite())
}

/// Whether the law flies.
fn is_flying(mode: Mode) -> bool {
    matches!(mode, Mode::Join | Mode::Follow)
}
