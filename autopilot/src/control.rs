//! The control side: modes, the law's step, and what happens when there is no state or no usable command.
//!
//! ```text
//!            arm                first good state            state missing or refused,
//!   OFF ───────────▶ READY ──────────────────▶ FLYING ◀──────────────▶ HOLD     law's answer not finite
//!    ▲                                            ▲     good state       │
//!    └── disarm, from anywhere                    └─────────── SAFE ◀────┘ after HOLD_TIME
//! ```
//!
//! OFF and READY turn no rotor. HOLD repeats the last command; SAFE is the configured thrust without torque. From either the
//! law takes over again without a bump in thrust.

use controller::{Command, Real, State, Vector3};
use link::dialect::{
    LOAD_COMMAND_DATA, LOAD_COUNTERS_DATA, LOAD_STATE_DATA, LOAD_TELEMETRY_DATA, LoadAction, LoadFault, LoadMode,
};

use crate::law::{Law, SetupRefused, Step};
use crate::mixer::Mixer;
use crate::parameters::{Parameter, Parameters};

/// Beyond this a number in a state is an error, in whatever unit: 100 km, and far more than any rate.
const LARGEST: f32 = 1e5;
/// How far |q|² and RᵀR may be from 1. A float's rounding is a hundred times smaller, an estimator's drift should be.
const UNIT_TOLERANCE: f32 = 1e-2;

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
    /// Steps of the law.
    pub steps: u32,
    /// Control steps that ended after their period.
    pub overruns: u32,
    /// Control periods without a new state.
    pub missed: u32,
    /// States refused.
    pub refused: u32,
    /// Answers of the law that were not finite.
    pub law_faults: u32,
    /// Most counts of the core's timer that a control step took.
    pub worst_cycles: u32,
}

/// The outcome of one control step.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// For the link. Its `rotor` is what the law wants.
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
    mode: LoadMode,
    law: Option<Law>,
    mixer: Mixer,
    /// Control periods without a usable state or command.
    held: u32,
    applied: Command<f32>,
    /// Newest state that has come in flight and was not used yet.
    inbox: Option<LOAD_STATE_DATA>,
    newest_usec: Option<u64>,
    last: Option<Answer>,
    overrun: bool,
    until_telemetry: u32,
}

const NO_COMMAND: Command<f32> = Command { thrust: 0.0, torque: Vector3::new(0.0, 0.0, 0.0) };

impl Autopilot {
    /// Not armed, with all parameters at their defaults.
    #[must_use]
    pub fn new(boot: Boot) -> Self {
        let parameters = Parameters::default();
        Self {
            mixer: Mixer::new(&parameters),
            parameters,
            boot,
            counters: Counters::default(),
            mode: LoadMode::LOAD_MODE_OFF,
            law: None,
            held: 0,
            applied: NO_COMMAND,
            inbox: None,
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

    /// What it does with its rotors.
    #[must_use]
    pub fn mode(&self) -> LoadMode {
        self.mode
    }

    /// Whether rotors may turn.
    #[must_use]
    pub fn is_armed(&self) -> bool {
        self.mode != LoadMode::LOAD_MODE_OFF
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
            self.mixer = Mixer::new(&self.parameters);
            self.mode = LoadMode::LOAD_MODE_READY;
            self.applied = NO_COMMAND;
            self.inbox = None;
            self.newest_usec = None;
            self.last = None;
            self.held = 0;
            self.until_telemetry = 0;
        }
        Ok(())
    }

    /// Rotors off.
    pub fn disarm(&mut self) {
        self.mode = LoadMode::LOAD_MODE_OFF;
        self.law = None;
        self.applied = NO_COMMAND;
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

    /// Notes what the step just made cost.
    pub fn note_cost(&mut self, answer: &mut Answer, cycles: u32) {
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
        let Counters { steps, overruns, missed, refused, law_faults, worst_cycles } = self.counters;
        LOAD_COUNTERS_DATA {
            steps,
            overruns,
            missed,
            refused,
            law_faults,
            worst_cycles,
            bad_frames: 0,
            lost_bytes: 0,
            watchdog_resets: self.boot.watchdog_resets,
            core_hz: self.boot.core_hz,
        }
    }

    fn out_of_step(&mut self, frame: &LOAD_STATE_DATA) -> Answer {
        let command = LOAD_COMMAND_DATA {
            time_usec: frame.time_usec,
            sequence: frame.sequence,
            faults: self.standing_faults() | LoadFault::LOAD_FAULT_SEQUENCE,
            mode: self.mode,
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
        let mut step = None;
        if self.is_armed() {
            step = frame.and_then(|frame| self.fly(frame, &mut faults));
            if frame.is_none() {
                self.counters.missed = self.counters.missed.wrapping_add(1);
                faults |= LoadFault::LOAD_FAULT_NO_STATE;
            }
            match &step {
                Some(step) => {
                    self.mode = LoadMode::LOAD_MODE_FLYING;
                    self.held = 0;
                    self.applied = self.limit(&step.command, &mut faults);
                }
                None => self.hold(),
            }
        }
        let (rotor, limited) = if self.is_turning() { self.mixer.mix(&self.applied) } else { ([0.0; 4], false) };
        faults.set(LoadFault::LOAD_FAULT_LIMITED, limited || faults.contains(LoadFault::LOAD_FAULT_LIMITED));
        let command = LOAD_COMMAND_DATA {
            time_usec: frame.map_or(0, |frame| frame.time_usec),
            sequence: frame.map_or(0, |frame| frame.sequence),
            thrust: self.applied.thrust,
            torque: self.applied.torque.into(),
            zeta: if step.is_some() { self.law.as_ref().map(Law::zeta).unwrap_or_default() } else { [0.0; 4] },
            u_zeta: step.as_ref().map_or(0.0, |step| step.u_zeta),
            rotor,
            cycles: 0,
            faults,
            mode: self.mode,
        };
        let outputs = if self.drive() == Drive::Flight { rotor } else { [0.0; 4] };
        let telemetry = step.and_then(|step| self.telemetry(command.sequence, &step));
        Answer { command, telemetry, outputs }
    }

    fn is_turning(&self) -> bool {
        !matches!(self.mode, LoadMode::LOAD_MODE_OFF | LoadMode::LOAD_MODE_READY)
    }

    /// The law's step on a good state; `None` if the state or the law's answer can't be used.
    fn fly(&mut self, frame: &LOAD_STATE_DATA, faults: &mut LoadFault) -> Option<Step> {
        let state = link::state_of(frame);
        if !is_plausible(&state) || !frame.reference_phase.is_finite() || !frame.zeta.iter().all(|z| z.is_finite()) {
            self.counters.refused = self.counters.refused.wrapping_add(1);
            *faults |= LoadFault::LOAD_FAULT_BAD_STATE;
            return None;
        }
        let turning = self.is_turning();
        let law = self.law.as_mut()?;
        if frame.action == LoadAction::LOAD_ACTION_START {
            law.start(&state, frame.zeta);
        } else if self.mode != LoadMode::LOAD_MODE_FLYING || frame.action == LoadAction::LOAD_ACTION_ENGAGE {
            let hover = Command { thrust: law.hover_thrust(), torque: Vector3::zeros() };
            law.engage(&state, if turning { self.applied } else { hover });
        }
        let step = law.step(&state, frame.reference_phase);
        self.counters.steps = self.counters.steps.wrapping_add(1);
        // ζ is the law's memory: once it is no number, neither is any later command.
        if step.is_finite() && law.zeta().iter().all(|z| z.is_finite()) {
            return Some(step);
        }
        self.counters.law_faults = self.counters.law_faults.wrapping_add(1);
        *faults |= LoadFault::LOAD_FAULT_LAW;
        None
    }

    /// Nothing usable this period.
    fn hold(&mut self) {
        if !self.is_turning() || self.mode == LoadMode::LOAD_MODE_SAFE {
            return;
        }
        // Rounded to whole periods.
        if (self.held as f32 + 0.5) * self.period_s() < self.parameters.get(Parameter::HoldTime) {
            self.held = self.held.saturating_add(1);
            self.mode = LoadMode::LOAD_MODE_HOLD;
        } else {
            self.mode = LoadMode::LOAD_MODE_SAFE;
            let safe = Command { thrust: self.parameters.get(Parameter::SafeThrust), torque: Vector3::zeros() };
            self.applied = self.limit(&safe, &mut LoadFault::empty());
        }
    }

    fn limit(&self, command: &Command<f32>, faults: &mut LoadFault) -> Command<f32> {
        let largest = self.parameters.get(Parameter::ThrustMax);
        let least = self.parameters.get(Parameter::ThrustMin).min(largest);
        let torque = self.parameters.get(Parameter::TorqueMax);
        let limited = Command {
            thrust: Real::clamp(command.thrust, least, largest),
            torque: command.torque.map(|axis| Real::clamp(axis, -torque, torque)),
        };
        faults.set(LoadFault::LOAD_FAULT_LIMITED, limited != *command);
        limited
    }

    fn telemetry(&mut self, sequence: u32, step: &Step) -> Option<LOAD_TELEMETRY_DATA> {
        let every = self.parameters.get(Parameter::TelemetryEvery) as u32;
        if every == 0 || self.until_telemetry > 0 {
            self.until_telemetry = self.until_telemetry.saturating_sub(1);
            return None;
        }
        self.until_telemetry = every - 1;
        let margins = &step.margins;
        Some(LOAD_TELEMETRY_DATA {
            sequence,
            xi: step.xi,
            nu: step.nu,
            integral: self.law.as_ref().map(Law::integral).unwrap_or_default(),
            q3: margins.q3,
            q_b3: margins.q_b3,
            specific_force: margins.lambda,
            kappa: margins.kappa,
            path_det: margins.path_det,
            reach: margins.reach,
            cos_phi_squared: margins.cos_phi_squared,
        })
    }
}

/// Finite and of a size that can be, with a rod of unit length and a rotation for attitude.
fn is_plausible(state: &State<f32>) -> bool {
    let within = |numbers: &[f32]| numbers.iter().all(|x| x.abs() <= LARGEST);
    let sized = [&state.position, &state.velocity, &state.rod_rate, &state.body_rate]
        .iter()
        .all(|vector| within(vector.as_slice()));
    let near = |x: f32, one: f32| (x - one).abs() <= UNIT_TOLERANCE;
    let [b1, b2, b3] = [0, 1, 2].map(|i| Vector3::from(state.attitude.column(i)));
    sized
        && near(state.rod.dot(&state.rod), 1.0)
        && near(b1.dot(&b1), 1.0)
        && near(b2.dot(&b2), 1.0)
        && near(b3.dot(&b3), 1.0)
        && near(b1.dot(&b2), 0.0)
        // Right-handed, and orthogonal to both: the triple product is 1.
        && near(b1.cross(&b2).dot(&b3), 1.0)
}
