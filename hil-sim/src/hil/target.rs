//! The conversation with a target.

use std::collections::VecDeque;
use std::io::ErrorKind;
use std::time::{Duration, Instant};

use autopilot::{Parameter, Parameters};
use controller::State;
use controller::envelope::Margins;
use link::dialect::*;
use link::{Decoder, Encoder, MavMessage};

use super::{Emulator, Endpoint, HilError, Wire};
use crate::pilot::{Answers, Decision};
use crate::plant::Input;
use crate::scenario::{ControllerSpec, Law, Scenario};

/// Who sets the pace of a flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// Each state is a control step of the target, as fast as both can.
    Lockstep,
    /// The target's own timer; states are sent as time goes by, and its latest command is used.
    RealTime,
}

/// How to speak with a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Who sets the pace.
    pub pace: Pace,
    /// Without an answer for this long the target is lost.
    pub patience: Duration,
    /// Without an answer for this long the question is sent again.
    pub retry: Duration,
    /// Ask for ξ, ν and the margins of each step: more to send, and needed for the deviation of ξ.
    pub telemetry: bool,
}

impl Default for Options {
    /// Lockstep with telemetry, 5 s of patience.
    fn default() -> Self {
        Self {
            pace: Pace::Lockstep,
            patience: Duration::from_secs(5),
            retry: Duration::from_millis(50),
            telemetry: true,
        }
    }
}

/// What the link and the target did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statistics {
    /// From each state's sending to its command's arrival, s.
    pub latencies_s: Vec<f64>,
    /// Counts of the target's cycle counter, each step.
    pub cycles: Vec<u32>,
    /// Questions that had to be sent again.
    pub repeats: u64,
    /// Frames from the target that could not be used.
    pub bad_frames: u64,
    /// Times the line was down and came back.
    pub reconnections: u64,
    /// Real time: periods in which no command came.
    pub late: u64,
    /// Bits of `LOAD_FAULT` that stood in any answer.
    pub faults: u16,
    /// What the target had to say.
    pub texts: Vec<String>,
}

impl Statistics {
    /// The latency that the share `p` of all answers kept, s; 0 if there was none.
    #[must_use]
    pub fn latency_s(&self, p: f64) -> f64 {
        let mut sorted = self.latencies_s.clone();
        sorted.sort_by(f64::total_cmp);
        let last = sorted.len().saturating_sub(1);
        sorted.get((p * last as f64).round() as usize).copied().unwrap_or_default()
    }
}

/// A read of fewer bytes is the beginning of a frame, and the next should find more.
const GATHER: usize = 32;

/// A target that is ready to fly.
pub struct Target {
    endpoint: Endpoint,
    wire: Box<dyn Wire>,
    emulator: Option<Emulator>,
    options: Options,
    decoder: Decoder,
    encoder: Encoder,
    inbox: VecDeque<MavMessage>,
    received_bytes: u64,
    statistics: Statistics,
    sequence: u32,
    period: Duration,
    start: Option<[f64; 4]>,
    reference_rate: f64,
    limits: [f32; 2],
    zeta: [f64; 4],
    integral: [f64; 3],
    command: Option<LOAD_COMMAND_DATA>,
    epoch: Instant,
    failure: Option<HilError>,
}

impl Target {
    /// Connects, and makes sure that the other end speaks this dialect.
    ///
    /// # Errors
    /// Whatever keeps it from it, within the patience.
    pub fn connect(endpoint: Endpoint, emulator: Option<Emulator>, options: Options) -> Result<Self, HilError> {
        let mut emulator = emulator;
        let wire = open(&endpoint, emulator.as_mut(), options.patience)?;
        let mut target = Self::on_wire(endpoint, wire, emulator, options);
        target.greet()?;
        Ok(target)
    }

    /// Starts `emulator`'s image and connects to it.
    ///
    /// # Errors
    /// As [`Target::connect`].
    pub fn emulated(emulator: Emulator, options: Options) -> Result<Self, HilError> {
        Self::connect(emulator.endpoint(), Some(emulator), options)
    }

    /// Speaks over a line that is open already; `endpoint` names it, and is where it is opened again.
    ///
    /// # Errors
    /// As [`Target::connect`].
    pub fn over(endpoint: Endpoint, wire: Box<dyn Wire>, options: Options) -> Result<Self, HilError> {
        let mut target = Self::on_wire(endpoint, wire, None, options);
        target.greet()?;
        Ok(target)
    }

    fn on_wire(endpoint: Endpoint, wire: Box<dyn Wire>, emulator: Option<Emulator>, options: Options) -> Self {
        Self {
            endpoint,
            wire,
            emulator,
            options,
            decoder: Decoder::new(),
            encoder: Encoder::new(link::STATION),
            inbox: VecDeque::new(),
            received_bytes: 0,
            statistics: Statistics::default(),
            sequence: 0,
            period: Duration::ZERO,
            start: None,
            reference_rate: 0.0,
            limits: [0.0; 2],
            zeta: [0.0; 4],
            integral: [0.0; 3],
            command: None,
            epoch: Instant::now(),
            failure: None,
        }
    }

    /// What the link and the target did since the last [`prepare`](Self::prepare).
    #[must_use]
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// Counts of the target's cycle counter for one instruction, where an emulator counts them.
    #[must_use]
    pub fn counts_per_instruction(&self) -> Option<f64> {
        self.emulator.as_ref().and_then(Emulator::counts_per_instruction)
    }

    /// Process number of its emulator.
    #[must_use]
    pub fn emulator_id(&self) -> Option<u32> {
        self.emulator.as_ref().map(Emulator::id)
    }

    /// Why it stopped answering, once it has.
    pub fn take_failure(&mut self) -> Option<HilError> {
        self.failure.take()
    }

    /// Sets the target up for `scenario` and arms it.
    ///
    /// # Errors
    /// The scenario can't be flown there, or the target or the line fails.
    pub fn prepare(&mut self, scenario: &Scenario) -> Result<(), HilError> {
        let ControllerSpec { law, rate_hz, .. } = &scenario.controller;
        self.statistics = Statistics::default();
        self.period = Duration::from_secs_f64(1.0 / rate_hz);
        self.reference_rate = match law {
            Law::Track { reference, .. } => reference.rate,
            Law::Follow { .. } => 0.0,
        };
        let mut parameters = super::parameters(&scenario.controller)?;
        let simulate = if self.options.pace == Pace::Lockstep { 1.0 } else { 2.0 };
        parameters.set(Parameter::Simulate, simulate);
        parameters.set(Parameter::TelemetryEvery, f32::from(u8::from(self.options.telemetry)));
        self.limits = [parameters.get(Parameter::ThrustMax), parameters.get(Parameter::TorqueMax)];
        self.arm(false)?;
        self.configure(&parameters)?;
        self.arm(true)?;
        (self.zeta, self.integral) = ([0.0; 4], [0.0; 3]);
        (self.start, self.command) = (None, None);
        self.epoch = Instant::now();
        Ok(())
    }

    /// Rotors off.
    ///
    /// # Errors
    /// The line's.
    pub fn disarm(&mut self) -> Result<(), HilError> {
        self.arm(false)
    }

    /// A parameter's value.
    ///
    /// # Errors
    /// The line's.
    pub fn parameter(&mut self, name: &str) -> Result<f32, HilError> {
        let request = MavMessage::PARAM_REQUEST_READ(PARAM_REQUEST_READ_DATA {
            param_index: -1,
            target_system: link::CONTROLLER.0,
            target_component: link::CONTROLLER.1,
            param_id: link::name(name),
        });
        self.ask(&request, |message| named_value(message, name))
    }

    /// Sets a parameter and makes sure of it.
    ///
    /// # Errors
    /// [`HilError::Parameter`] if the target keeps another value; the line's.
    pub fn set_parameter(&mut self, name: &str, value: f32) -> Result<(), HilError> {
        let request = MavMessage::PARAM_SET(PARAM_SET_DATA {
            param_value: value,
            target_system: link::CONTROLLER.0,
            target_component: link::CONTROLLER.1,
            param_id: link::name(name),
            param_type: MavParamType::MAV_PARAM_TYPE_REAL32 as u8,
        });
        let kept = self.ask(&request, |message| named_value(message, name))?;
        if kept.to_bits() == value.to_bits() {
            return Ok(());
        }
        let reason = self.statistics.texts.last().cloned().unwrap_or_default();
        Err(HilError::Parameter { name: name.to_owned(), wanted: value, kept, reason })
    }

    fn configure(&mut self, parameters: &Parameters) -> Result<(), HilError> {
        for (entry, value) in parameters.iter() {
            if entry.min < entry.max {
                self.set_parameter(entry.name, value)?;
            }
        }
        Ok(())
    }

    fn arm(&mut self, on: bool) -> Result<(), HilError> {
        let command = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM as u16;
        let request = MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            param1: f32::from(u8::from(on)),
            command,
            target_system: link::CONTROLLER.0,
            target_component: link::CONTROLLER.1,
            ..COMMAND_LONG_DATA::DEFAULT
        });
        let result = self.ask(&request, |message| match message {
            MavMessage::COMMAND_ACK(ack) if ack.command == command => Some(ack.result),
            _ => None,
        })?;
        if result == MavResult::MAV_RESULT_ACCEPTED as u8 {
            return Ok(());
        }
        Err(HilError::NotArmed(self.statistics.texts.last().cloned().unwrap_or_default()))
    }

    /// The first exchange, with errors that tell what may be wrong.
    fn greet(&mut self) -> Result<(), HilError> {
        let begun = Instant::now();
        match self.parameter("LINK_DIALECT") {
            Ok(theirs) if theirs == link::FINGERPRINT as f32 => Ok(()),
            Ok(theirs) => Err(HilError::Dialect { theirs: theirs as u32, ours: link::FINGERPRINT }),
            Err(HilError::Lost { endpoint, .. }) => {
                let (waited, bytes) = (begun.elapsed(), self.received_bytes);
                Err(match bytes {
                    0 => HilError::Silent { endpoint, waited },
                    _ => HilError::Unintelligible { endpoint, bytes, waited },
                })
            }
            Err(error) => Err(error),
        }
    }

    /// Sends `question`, again and again if need be, until `answer` finds one or the patience ends.
    fn ask<T>(&mut self, question: &MavMessage, answer: impl Fn(&MavMessage) -> Option<T>) -> Result<T, HilError> {
        let begun = Instant::now();
        let mut sent = 0;
        while begun.elapsed() < self.options.patience {
            self.transmit(question)?;
            sent += 1;
            let until = Instant::now() + self.options.retry;
            loop {
                while let Some(message) = self.inbox.pop_front() {
                    if let Some(found) = answer(&message) {
                        self.statistics.repeats += u64::from(sent - 1);
                        return Ok(found);
                    }
                    self.note(&message);
                }
                let left = until.saturating_duration_since(Instant::now());
                if left.is_zero() {
                    break;
                }
                self.receive(left)?;
            }
        }
        if let Some(emulator) = &mut self.emulator {
            emulator.check()?;
        }
        Err(HilError::Lost { endpoint: self.endpoint.clone(), waited: begun.elapsed(), sent })
    }

    /// What comes unasked.
    fn note(&mut self, message: &MavMessage) {
        match message {
            MavMessage::STATUSTEXT(text) => self.statistics.texts.push(link::text_of(&*text.text).to_owned()),
            MavMessage::LOAD_TELEMETRY(telemetry) => self.integral = telemetry.integral.map(f64::from),
            _ => {}
        }
    }

    fn transmit(&mut self, message: &MavMessage) -> Result<(), HilError> {
        let frame = self.encoder.frame(message);
        match self.wire.write_all(frame.bytes()) {
            Ok(()) => Ok(()),
            Err(error) => self.mend(error),
        }
    }

    /// Reads what has come, waiting for `patience` at most.
    fn receive(&mut self, patience: Duration) -> Result<(), HilError> {
        let mut bytes = [0; 1024];
        // A socket refuses to wait for no time at all.
        let read =
            self.wire.set_patience(patience.max(Duration::from_millis(1))).and_then(|()| self.wire.read(&mut bytes));
        match read {
            Ok(0) => self.mend(ErrorKind::UnexpectedEof.into()),
            Ok(count) => {
                self.received_bytes += count as u64;
                if count < GATHER {
                    // An emulator sends bytes one by one; waking for each costs more than waiting for some.
                    std::thread::sleep(Duration::from_micros(20));
                }
                let (inbox, statistics) = (&mut self.inbox, &mut self.statistics);
                for &byte in &bytes[..count] {
                    self.decoder.push(byte, |received| match received {
                        Ok(message) => inbox.push_back(message),
                        Err(_) => statistics.bad_frames += 1,
                    });
                }
                Ok(())
            }
            Err(error)
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) =>
            {
                Ok(())
            }
            Err(error) => self.mend(error),
        }
    }

    /// The line is down: opens it again.
    fn mend(&mut self, source: std::io::Error) -> Result<(), HilError> {
        let begun = Instant::now();
        match open(&self.endpoint, self.emulator.as_mut(), self.options.patience) {
            Ok(wire) => {
                self.wire = wire;
                self.decoder.reset();
                self.statistics.reconnections += 1;
                Ok(())
            }
            Err(error @ HilError::EmulatorDied { .. }) => Err(error),
            Err(_) => Err(HilError::Down { endpoint: self.endpoint.clone(), waited: begun.elapsed(), source }),
        }
    }

    fn frame(&mut self, state: &State<f64>, t_s: f64) -> LOAD_STATE_DATA {
        self.sequence = self.sequence.wrapping_add(1);
        let mut frame = link::state_frame(&state.cast());
        // A millionth of a second finer than any control period; 0 would be no time.
        frame.time_usec = (t_s * 1e6).round() as u64 + 1;
        frame.sequence = self.sequence;
        frame.reference_phase = ((self.reference_rate * t_s) % std::f64::consts::TAU) as f32;
        if let Some(zeta) = self.start.take() {
            frame.action = LoadAction::LOAD_ACTION_START;
            frame.zeta = zeta.map(|z| z as f32);
            self.zeta = frame.zeta.map(f64::from);
            self.integral = [0.0; 3];
        }
        frame
    }

    fn lockstep(&mut self, state: &State<f64>, t_s: f64) -> Result<Decision, HilError> {
        let frame = self.frame(state, t_s);
        let sequence = frame.sequence;
        let telemetry = std::cell::Cell::new(None);
        let begun = Instant::now();
        let command = self.ask(&MavMessage::LOAD_STATE(frame), |message| match message {
            MavMessage::LOAD_TELEMETRY(data) if data.sequence == sequence => {
                telemetry.set(Some(data.clone()));
                None
            }
            MavMessage::LOAD_COMMAND(data) if data.sequence == sequence => Some(data.clone()),
            _ => None,
        })?;
        self.statistics.latencies_s.push(begun.elapsed().as_secs_f64());
        self.decide(&command, telemetry.take().as_ref())
    }

    fn real_time(&mut self, state: &State<f64>, t_s: f64) -> Result<Decision, HilError> {
        let frame = self.frame(state, t_s);
        let due = self.epoch + Duration::from_secs_f64(t_s);
        let begun = Instant::now();
        let first = self.command.is_none();
        let sequence = frame.sequence;
        let question = MavMessage::LOAD_STATE(frame);
        // The first command is waited for; then what has come by the end of the period is what there is.
        let (mut fresh, mut telemetry) = (None, None);
        let give_up = if first { begun + self.options.patience } else { due + self.period };
        self.transmit(&question)?;
        loop {
            while let Some(message) = self.inbox.pop_front() {
                match message {
                    MavMessage::LOAD_COMMAND(data) if data.sequence != 0 => {
                        if data.sequence == sequence {
                            self.statistics.latencies_s.push(begun.elapsed().as_secs_f64());
                        }
                        fresh = Some(data);
                    }
                    MavMessage::LOAD_TELEMETRY(data) => telemetry = Some(data),
                    other => self.note(&other),
                }
            }
            if first && fresh.is_some() {
                self.epoch = Instant::now();
                break;
            }
            let left = give_up.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            self.receive(left)?;
        }
        if fresh.is_none() {
            self.statistics.late += 1;
        }
        let quiet_for = self.statistics.latencies_s.len();
        let command = fresh.or_else(|| self.command.clone()).ok_or_else(|| HilError::Lost {
            endpoint: self.endpoint.clone(),
            waited: begun.elapsed(),
            sent: u32::try_from(quiet_for).unwrap_or(u32::MAX),
        })?;
        self.command = Some(command.clone());
        self.decide(&command, telemetry.as_ref())
    }

    /// What a command says, once it is found to be one.
    fn decide(
        &mut self,
        command: &LOAD_COMMAND_DATA,
        telemetry: Option<&LOAD_TELEMETRY_DATA>,
    ) -> Result<Decision, HilError> {
        let sequence = command.sequence;
        if command.faults.contains(LoadFault::LOAD_FAULT_SEQUENCE)
            || command.faults.contains(LoadFault::LOAD_FAULT_NOT_ARMED)
        {
            return Err(HilError::OutOfStep { sequence });
        }
        let [most, torque] = self.limits;
        let allowed = (0.0..=most).contains(&command.thrust)
            && command.torque.iter().all(|axis| axis.abs() <= torque)
            && command.rotor.iter().all(|duty| (0.0..=1.0).contains(duty))
            && command.zeta.iter().all(|z| z.is_finite());
        if !allowed {
            return Err(HilError::BadCommand { sequence, command: format!("{command:?}") });
        }
        self.statistics.faults |= command.faults.bits();
        self.statistics.cycles.push(command.cycles);
        // The answer has ζ and ξ̃ at the hold's end; a decision has them at its start.
        let (zeta, integral) = (self.zeta, self.integral);
        self.zeta = command.zeta.map(f64::from);
        let mut decision = Decision {
            input: Input { thrust: command.thrust.into(), torque: command.torque.map(f64::from) },
            zeta,
            integral,
            xi: [f64::NAN; 20],
            nu: [f64::NAN; 4],
            margins: no_margins(),
        };
        if let Some(data) = telemetry {
            self.integral = data.integral.map(f64::from);
            decision.xi = data.xi.map(f64::from);
            decision.nu = data.nu.map(f64::from);
            decision.margins = Margins {
                q3: data.q3.into(),
                q_b3: data.q_b3.into(),
                lambda: data.specific_force.into(),
                kappa: data.kappa.into(),
                path_det: data.path_det.into(),
                reach: data.reach.into(),
                cos_phi_squared: data.cos_phi_squared.into(),
            };
        }
        Ok(decision)
    }
}

impl Answers for Target {
    fn start(&mut self, _: &State<f64>, zeta: [f64; 4]) {
        self.start = Some(zeta);
    }

    fn step(&mut self, state: &State<f64>, t_s: f64) -> Option<Decision> {
        let answer = match self.options.pace {
            Pace::Lockstep => self.lockstep(state, t_s),
            Pace::RealTime => self.real_time(state, t_s),
        };
        answer.map_err(|error| self.failure = Some(error)).ok()
    }
}

/// Where no telemetry came.
fn no_margins() -> Margins<f64> {
    let none = f64::NAN;
    Margins { q3: none, q_b3: none, lambda: none, kappa: none, path_det: none, reach: none, cos_phi_squared: none }
}

fn named_value(message: &MavMessage, name: &str) -> Option<f32> {
    match message {
        MavMessage::PARAM_VALUE(value) if link::text_of(&*value.param_id) == name => Some(value.param_value),
        _ => None,
    }
}

/// Opens the line, waiting for its other end to be there.
fn open(endpoint: &Endpoint, emulator: Option<&mut Emulator>, patience: Duration) -> Result<Box<dyn Wire>, HilError> {
    let begun = Instant::now();
    let mut emulator = emulator;
    loop {
        if let Some(emulator) = &mut emulator {
            emulator.check()?;
        }
        match endpoint.open() {
            Err(_) if begun.elapsed() < patience && emulator.is_some() => {
                std::thread::sleep(Duration::from_millis(20));
            }
            done => return done,
        }
    }
}
