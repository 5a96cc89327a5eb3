//! The control side: when the law is stepped, on which state, and what becomes of its command.
//!
//! ```text
//!         arm                first good state
//!   OFF ───────▶ OFF, armed ──────────────────▶ IDLE, JOIN, FOLLOW, HOLD, LAND, FAULT: the supervisor's
//!    ▲                                                          │
//!    └──────────── landed; or disarm, from anywhere ────────────┘
//! ```
//!
//! Where nothing was asked for, or to idle, the first good state finds a vehicle on the ground, whose rotors turn at their least thrust.
//! Where more was, it finds one in flight, which is taken over from hover thrust and does that. From there on every control period steps
//! the supervisor (`controller::flight::supervisor`, which has the modes' table) on what there is: a state that is missing is one that is no
//! number, and it knows what to do then. What the pilot asks for ([`Autopilot::request`]) lasts until disarming. The tracking law has a
//! guard of its own instead, and knows OFF, FOLLOW and FAULT alone.

use controller::{Command, Fault, Mode, Request, State, Vector3};
use link::dialect::{
    LOAD_COMMAND_DATA, LOAD_COUNTERS_DATA, LOAD_STATE_DATA, LOAD_TELEMETRY_DATA, LoadAction, LoadFault,
};

use crate::law::{Law, SetupRefused, Step};
use crate::parameters::{Parameter, Parameters};
use crate::report;

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

/// The outcome of one control step.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// For the link. Its `rotor` is what the law wants, though the vehicle may be a simulated one.
    pub command: LOAD_COMMAND_DATA,
    /// For the link, when it is its turn.
    pub telemetry: Option<LOAD_TELEMETRY_DATA>,
    /// What the rotors get, from 0 to 1: zero when not armed, and when the vehicle is a simulated one.
    pub outputs: [f32; 4],
}

/// The flight program's control side.
#[derive(Clone, Debug)]
pub struct Autopilot {
    parameters: Parameters,
    boot: Boot,
    counters: Counters,
    /// Of the last step.
    mode: Mode,
    fault: Option<Fault>,
    /// While armed.
    law: Option<Law>,
    request: Request,
    applied: Command<f32>,
    /// Newest state that has come in flight and was not used yet.
    inbox: Option<LOAD_STATE_DATA>,
    /// The last control period had no state.
    blind: bool,
    newest_usec: Option<u64>,
    last: Option<Answer>,
    overrun: bool,
    until_telemetry: u32,
}

impl Autopilot {
    /// Not armed, with all parameters at their defaults.
    #[must_use]
    pub fn new(boot: Boot) -> Self {
        Self {
            parameters: Parameters::default(),
            boot,
            counters: Counters::default(),
            mode: Mode::Off,
            fault: None,
            law: None,
            request: Request::Idle,
            applied: Command::zero(),
            inbox: None,
            blind: false,
            newest_usec: None,
            last: None,
            overrun: false,
            until_telemetry: 0,
        }
    }

    /// The parameters.
    #[must_use]
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The parameters, to be changed; `None` when armed.
    pub fn parameters_mut(&mut self) -> Option<&mut Parameters> {
        if self.is_armed() { None } else { Some(&mut self.parameters) }
    }

    /// What drives the control step.
    #[must_use]
    pub fn drive(&self) -> Drive {
        match self.parameters.get(Parameter::Simulate) {
            mode if mode >= 1.5 => Drive::RealTime,
            mode if mode >= 0.5 => Drive::Lockstep,
            _ => Drive::Flight,
        }
    }

    /// The control period, s.
    #[must_use]
    pub fn period_s(&self) -> f32 {
        self.parameters.get(Parameter::Period)
    }

    /// What the vehicle is doing.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// Why it is not doing what was asked for: the last fault since something else was.
    #[must_use]
    pub fn fault(&self) -> Option<Fault> {
        self.fault
    }

    /// Whether rotors may turn.
    #[must_use]
    pub fn is_armed(&self) -> bool {
        self.law.is_some()
    }

    /// Whether the last control period had no state.
    #[must_use]
    pub fn is_blind(&self) -> bool {
        self.blind
    }

    /// Asks for something, now or for after arming. `false` if the law does not know it: tracking only follows.
    pub fn request(&mut self, request: Request) -> bool {
        let known = request == Request::Follow || !self.parameters.is_on(Parameter::Law);
        if known {
            self.request = request;
        }
        known
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

    /// Makes the law of the parameters as they are, and waits for a state to start it with. Armed already, it does nothing.
    ///
    /// # Errors
    /// The parameters make no law; it stays disarmed.
    pub fn arm(&mut self) -> Result<(), SetupRefused> {
        if !self.is_armed() {
            self.law = Some(Law::new(&self.parameters)?);
            self.inbox = None;
            self.newest_usec = None;
            self.last = None;
            self.until_telemetry = 0;
        }
        Ok(())
    }

    /// Rotors off. What was asked for is forgotten.
    pub fn disarm(&mut self) {
        self.law = None;
        self.mode = Mode::Off;
        self.fault = None;
        self.request = Request::Idle;
        self.last = None;
    }

    /// A state for the coming control period: flight and real time. A frame that is not newer than the last one is refused.
    pub fn receive(&mut self, frame: &LOAD_STATE_DATA) {
        if self.newest_usec.is_some_and(|newest| frame.time_usec <= newest) {
            self.counters.refused = self.counters.refused.wrapping_add(1);
        } else {
            self.newest_usec = Some(frame.time_usec);
            self.inbox = Some(frame.clone());
        }
    }

    /// A control period by the timer: flight and real time.
    pub fn tick(&mut self) -> Answer {
        let frame = self.inbox.take();
        self.control(frame.as_ref())
    }

    /// A control period by a state frame: lockstep. The same sequence number again gets the same answer again.
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

    /// All counters, for the link; the frames' and bytes' are the server's and the board's to fill in.
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

    fn out_of_step(&self, frame: &LOAD_STATE_DATA) -> Answer {
        self.nothing(Some(frame), self.standing_faults() | LoadFault::LOAD_FAULT_SEQUENCE)
    }

    /// An answer without a command.
    fn nothing(&self, frame: Option<&LOAD_STATE_DATA>, faults: LoadFault) -> Answer {
        let command = LOAD_COMMAND_DATA {
            time_usec: frame.map_or(0, |frame| frame.time_usec),
            sequence: frame.map_or(0, |frame| frame.sequence),
            faults,
            mode: report::mode(self.mode),
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
        faults
    }

    fn control(&mut self, frame: Option<&LOAD_STATE_DATA>) -> Answer {
        let mut faults = self.standing_faults();
        self.overrun = false;
        self.blind = frame.is_none();
        let Some(law) = &mut self.law else { return self.nothing(frame, faults) };
        let state = match frame {
            Some(frame) if frame.zeta.iter().all(|z| z.is_finite()) => link::state_of(frame),
            _ => State::at_rest(Vector3::repeat(f32::NAN)),
        };
        let is_good = state.check().is_ok();
        match frame {
            None => {
                self.counters.missed = self.counters.missed.wrapping_add(1);
                faults |= LoadFault::LOAD_FAULT_NO_STATE;
            }
            Some(_) if !is_good => {
                self.counters.refused = self.counters.refused.wrapping_add(1);
                faults |= LoadFault::LOAD_FAULT_BAD_STATE;
            }
            Some(frame) => {
                self.counters.steps = self.counters.steps.wrapping_add(1);
                if frame.action == LoadAction::LOAD_ACTION_START {
                    self.request = Request::Follow;
                }
                begin(law, frame, &state, self.request, &self.applied);
            }
        }
        let integral = law.integral();
        let was_flying = is_flying(law.mode());
        let step = law.step(&state, self.request, frame.map_or(0.0, |frame| frame.reference_phase));
        let has_fallen_back = was_flying && self.request == Request::Follow && !is_flying(step.mode);
        self.counters.fallbacks = self.counters.fallbacks.wrapping_add(u32::from(has_fallen_back));
        (self.mode, self.fault, self.applied) = (step.mode, step.fault, step.command);

        let rotor = law.actuators().duties(&step.command);
        let mut answer = self.answer(frame, faults, &step, rotor);
        if is_good {
            let is_asked_for = frame.is_some_and(|frame| frame.telemetry != 0);
            if self.is_telemetry_s_turn() || is_asked_for {
                answer.telemetry = self
                    .law
                    .as_ref()
                    .map(|law| report::telemetry(answer.command.sequence, law, &state, integral, &step));
            }
            if step.mode == Mode::Off {
                // The supervisor has landed.
                self.disarm();
            }
        }
        answer
    }

    /// What a `step` says to the link and the rotors.
    fn answer(&self, frame: Option<&LOAD_STATE_DATA>, faults: LoadFault, step: &Step, rotor: [f32; 4]) -> Answer {
        let mut faults = faults | step.fault.map_or(LoadFault::empty(), report::fault);
        faults.set(LoadFault::LOAD_FAULT_LIMITED, step.answer.is_some_and(|answer| answer.limited));
        let (zeta, u_zeta) = step.answer.map_or(([0.0; 4], 0.0), |answer| (answer.zeta, answer.u_zeta));
        let Answer { command, .. } = self.nothing(frame, faults);
        let command = LOAD_COMMAND_DATA {
            thrust: step.command.thrust,
            torque: step.command.torque.into(),
            zeta: zeta.map(report::number),
            u_zeta,
            rotor,
            ..command
        };
        let outputs = if self.drive() == Drive::Flight { rotor } else { [0.0; 4] };
        Answer { command, telemetry: None, outputs }
    }

    /// Counts a step, and says whether it is one of every `TLM_EVERY`.
    fn is_telemetry_s_turn(&mut self) -> bool {
        let every = self.parameters.get(Parameter::TelemetryEvery) as u32;
        let is_turn = every > 0 && self.until_telemetry == 0;
        self.until_telemetry = if is_turn { every - 1 } else { self.until_telemetry.saturating_sub(1) };
        is_turn
    }
}

/// What a good state does to the law's memory before the step on it; `applied` was the last command.
fn begin(law: &mut Law, frame: &LOAD_STATE_DATA, state: &State<f32>, request: Request, applied: &Command<f32>) {
    let is_off = law.mode() == Mode::Off;
    let hover = Command { thrust: law.vehicle().hover_thrust(), torque: Vector3::zeros() };
    let applied = if is_off { hover } else { *applied };
    match frame.action {
        LoadAction::LOAD_ACTION_START => law.start(state, frame.zeta),
        LoadAction::LOAD_ACTION_ENGAGE => law.take_over(state, applied),
        LoadAction::LOAD_ACTION_CONTINUE if is_off && request != Request::Idle => law.take_over(state, applied),
        LoadAction::LOAD_ACTION_CONTINUE => {}
    }
}

/// Whether the law flies.
fn is_flying(mode: Mode) -> bool {
    matches!(mode, Mode::Join | Mode::Follow)
}
