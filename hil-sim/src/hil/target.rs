//! The conversation with a target.

use std::time::{Duration, Instant};

use autopilot::{Setting, Settings};
use controller::{Command, Margins, Measured, Mode, Request, State, Uav, Vector3};
use link::dialect::*;
use link::{Home, MavMessage};
use rig::{Refused, parameter, run};

use super::instruments::Instruments;
use super::line::Line;
use super::{Emulator, Endpoint, HOME, HilError, Options, Pace, Station, Statistics, Wire, mission};
use crate::describe::mission::home;
use crate::describe::parameters::parameters;
use crate::describe::scenario::{ControllerSpec, Law, Scenario};
use crate::fly::pilot::{Answers, Decision, Observed, Telemetry};
use crate::world::Reading;

/// How its first state finds the vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Begin {
    /// As any other.
    Begun,
    /// On the path, with this ζ.
    On([f64; 4]),
    /// On the ground, until it has found that it is.
    Standing,
}

/// Navigation that has not begun after so long, s, has nothing to begin with.
const BEGINS_S: f64 = 10.0;

/// A flight by the clock on the wall that falls further behind goes on from there.
const MOST_BEHIND: Duration = Duration::from_millis(100);

/// A target that is ready to fly.
pub struct Target {
    line: Line,
    sequence: u32,
    period: Duration,
    begin: Begin,
    /// Where on the earth N has its origin.
    home: Home,
    /// What it finds its state from, where it does, and what they say in this period.
    instruments: Option<Instruments>,
    said: Vec<MavMessage>,
    /// What was asked for last.
    request: Request,
    /// It has landed, and is disarmed.
    is_down: bool,
    /// Its mission has ended, and it lands unasked.
    lands: bool,
    reference_rate: f64,
    /// Largest thrust, and largest torques.
    limits: (f32, [f32; 3]),
    zeta: [f64; 4],
    /// Control periods a second, and from one logged sample to the next.
    rate_hz: f64,
    log_every: u64,
    command: Option<LOAD_COMMAND_DATA>,
    epoch: Instant,
    /// When the last command came to a flight that a station commands.
    heard: Instant,
    failure: Option<HilError>,
    /// The last answer.
    decision: Option<Decision>,
}

impl Target {
    /// Connects, and makes sure that the other end speaks this dialect.
    ///
    /// # Errors
    /// Whatever keeps it from it, within the patience.
    pub fn connect(endpoint: Endpoint, emulator: Option<Emulator>, options: Options) -> Result<Self, HilError> {
        Self::greeted(Line::open(endpoint, emulator, options)?)
    }

    /// Starts `emulator`'s image and connects to it.
    ///
    /// # Errors
    /// As [`Target::connect`].
    pub fn emulated(emulator: Emulator, options: Options) -> Result<Self, HilError> {
        Self::connect(emulator.endpoint(), Some(emulator), options)
    }

    /// Speaks over a line that is open already; `endpoint` names it, and is where it is opened
    /// again.
    ///
    /// # Errors
    /// As [`Target::connect`].
    pub fn over(endpoint: Endpoint, wire: Box<dyn Wire>, options: Options) -> Result<Self, HilError> {
        Self::greeted(Line::over(endpoint, wire, options))
    }

    /// The first exchange, with errors that tell what may be wrong.
    fn greeted(line: Line) -> Result<Self, HilError> {
        let mut target = Self {
            line,
            sequence: 0,
            period: Duration::ZERO,
            begin: Begin::Begun,
            home: home(HOME).expect("it is a place"),
            instruments: None,
            said: Vec::new(),
            request: Request::Idle,
            is_down: false,
            lands: false,
            reference_rate: 0.0,
            limits: (0.0, [0.0; 3]),
            zeta: [0.0; 4],
            rate_hz: 0.0,
            log_every: 1,
            command: None,
            epoch: Instant::now(),
            heard: Instant::now(),
            failure: None,
            decision: None,
        };
        let begun = Instant::now();
        match target.parameter("LINK_DIALECT") {
            Ok(theirs) if theirs == link::FINGERPRINT as f32 => Ok(target),
            Ok(theirs) => Err(HilError::Dialect { theirs: theirs as u32, ours: link::FINGERPRINT }),
            Err(HilError::Lost { endpoint, .. }) => {
                let (waited, bytes) = (begun.elapsed(), target.line.received_bytes());
                Err(match bytes {
                    0 => HilError::Silent { endpoint, waited },
                    _ => HilError::Unintelligible { endpoint, bytes, waited },
                })
            }
            Err(error) => Err(error),
        }
    }

    /// The same with N's origin at `home` on the earth, for receivers and ground stations.
    #[must_use]
    pub fn at(self, home: Home) -> Self {
        Self { home, ..self }
    }

    /// What the link and the target did since the last [`prepare`](Self::prepare).
    #[must_use]
    pub fn statistics(&self) -> &Statistics {
        &self.line.statistics
    }

    /// Counts of the target's cycle counter for one instruction, where an emulator counts them.
    #[must_use]
    pub fn counts_per_instruction(&self) -> Option<f64> {
        self.line.emulator().and_then(Emulator::counts_per_instruction)
    }

    /// Process number of its emulator.
    #[must_use]
    pub fn emulator_id(&self) -> Option<u32> {
        self.line.emulator().map(Emulator::id)
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
        self.set_up(scenario, false)?;
        if self.instruments.is_some() && !scenario.standing {
            // It is armed in flight, with a load that hangs.
            self.ask_for(Request::Hold)?;
            self.request = Request::Hold;
        }
        self.arm(true)
    }

    /// Sets the target up for `scenario` and leaves it to `station`, which arms it and asks for
    /// modes. Flights go by the clock on the wall.
    ///
    /// # Errors
    /// The scenario can't be flown there, or the target or the line fails.
    pub fn leave_to(&mut self, station: Station, scenario: &Scenario) -> Result<(), HilError> {
        self.set_up(scenario, true)?;
        // Whatever the station sets them to.
        self.limits = (f32::MAX, [f32::MAX; 3]);
        self.line.station = Some(station);
        Ok(())
    }

    fn set_up(&mut self, scenario: &Scenario, is_commanded: bool) -> Result<(), HilError> {
        let ControllerSpec { law, rate_hz, rate_loop_s, .. } = &scenario.controller;
        if rate_loop_s.is_some() {
            return Err(HilError::Unsupported("actuators.rate_loop: the target commands rotors".into()));
        }
        self.line.statistics = Statistics::default();
        self.period = Duration::from_secs_f64(1.0 / rate_hz);
        self.reference_rate = match law {
            Law::Track { reference, .. } => reference.rate,
            Law::Follow { .. } => 0.0,
        };
        let parameters = parameters(&scenario.controller)?.cast::<f32>();
        self.limits = (parameters.get(parameter!("LIM_T_MAX")), parameters.run(run!("LIM_TAU_1" to "LIM_TAU_3")));
        let mut settings = Settings::from(parameters);
        let simulate = if self.line.options().pace == Pace::Lockstep { 1.0 } else { 2.0 };
        let unsupported = |refused: Refused<f32>| HilError::Unsupported(refused.to_string());
        settings.set(Setting::DRIVE, simulate).map_err(unsupported)?;
        self.instruments = Instruments::of(scenario, self.home, &mut settings)?;
        self.said.clear();
        if !is_commanded {
            // What the vehicle can give has been compared with what its path asks for.
            settings.set(Setting::ARMING_THRUST, 1.0).map_err(unsupported)?;
            // With the states that ask for it.
            settings.set(Setting::TELEMETRY_EVERY, 0.0).map_err(unsupported)?;
        }
        self.arm(false)?;
        if is_commanded || self.instruments.is_some() {
            self.set_home(self.home)?;
        }
        if let Some(route) = law.route() {
            mission::set_pace(route, &mut settings).map_err(unsupported)?;
            self.configure(&settings)?;
            let items = mission::items(route)?;
            self.upload(&if is_commanded { mission::on_earth(&items, self.home) } else { items })?;
        } else {
            self.configure(&settings)?;
        }
        (self.rate_hz, self.log_every) = (*rate_hz, scenario.log_every());
        let begin = if scenario.standing { Begin::Standing } else { Begin::Begun };
        (self.zeta, self.begin, self.command) = ([0.0; 4], begin, None);
        (self.request, self.is_down, self.lands) = (Request::Idle, false, false);
        (self.epoch, self.heard) = (Instant::now(), Instant::now());
        Ok(())
    }

    /// The command for the hold that begins at `t_s`, from what is measured then, of a target that
    /// is asked for `request`. Once it has landed, that is none.
    ///
    /// # Errors
    /// The target's, or the line's.
    pub fn fly(&mut self, measured: &Measured<'_, f64>, request: Request, t_s: f64) -> Result<Decision, HilError> {
        if self.line.station.is_some() {
            return self.commanded(measured, t_s);
        }
        let asks_itself = matches!(self.begin, Begin::On(_)) && request == Request::Follow;
        if self.request != request && !asks_itself && !self.is_down {
            self.ask_for(request)?;
        }
        self.request = request;
        let decision = match self.line.options().pace {
            _ if self.is_down => return Ok(Decision::off()),
            Pace::Lockstep => self.lockstep(measured, t_s),
            Pace::RealTime => self.real_time(measured, t_s),
        }?;
        if self.begin == Begin::Standing && self.instruments.is_some() && t_s > BEGINS_S {
            return Err(HilError::Refused("navigation has not begun: no fix, or no heading".into()));
        }
        self.is_down = decision.mode == Mode::Off && self.begin != Begin::Standing;
        self.lands |= decision.mode == Mode::Land && request == Request::Follow;
        Ok(decision)
    }

    /// Asks for a mode.
    fn ask_for(&mut self, request: Request) -> Result<(), HilError> {
        let mode = match request {
            Request::Follow => LoadMode::LOAD_MODE_FOLLOW,
            Request::Hold => LoadMode::LOAD_MODE_HOLD,
            Request::Land => LoadMode::LOAD_MODE_LAND,
            _ => LoadMode::LOAD_MODE_IDLE,
        };
        let param1 = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED as u8;
        self.ordered(MavCmd::MAV_CMD_DO_SET_MODE, [param1.into(), mode as u32 as f32])
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
        self.line.ask(&[request], |message| named_value(message, name))
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
        let kept = self.line.ask(&[request], |message| named_value(message, name))?;
        if kept.to_bits() == value.to_bits() {
            return Ok(());
        }
        let reason = self.line.statistics.texts.last().cloned().unwrap_or_default();
        Err(HilError::Parameter { name: name.to_owned(), wanted: value, kept, reason })
    }

    /// Tells where on the earth N has its origin.
    fn set_home(&mut self, home: Home) -> Result<(), HilError> {
        let steps = |degrees: f64| (degrees * 1e7).round() as i32;
        let question = MavMessage::SET_GPS_GLOBAL_ORIGIN(SET_GPS_GLOBAL_ORIGIN_DATA {
            latitude: steps(home.latitude),
            longitude: steps(home.longitude),
            altitude: (home.altitude * 1e3).round() as i32,
            target_system: link::CONTROLLER.0,
            time_usec: 0,
        });
        self.line.ask(&[question], |message| matches!(message, MavMessage::GPS_GLOBAL_ORIGIN(_)).then_some(()))
    }

    fn configure(&mut self, settings: &Settings) -> Result<(), HilError> {
        for (entry, value) in settings.iter() {
            if entry.min < entry.max {
                self.set_parameter(entry.name.as_str(), value)?;
            }
        }
        Ok(())
    }

    /// Has the target keep `items` as its mission, in place of what it has.
    fn upload(&mut self, items: &[MISSION_ITEM_INT_DATA]) -> Result<(), HilError> {
        // What the target wants next: an item, or nothing more.
        let wanted = |message: &MavMessage, next: u16| match message {
            MavMessage::MISSION_REQUEST_INT(request) if request.seq == next => Some(None),
            MavMessage::MISSION_ACK(ack) => Some(Some(ack.mavtype)),
            _ => None,
        };
        let (target_system, target_component) = link::CONTROLLER;
        let count = items.len() as u16;
        let mut question = MavMessage::MISSION_COUNT(MISSION_COUNT_DATA {
            count,
            target_system,
            target_component,
            ..MISSION_COUNT_DATA::DEFAULT
        });
        for (next, item) in (0..).zip(items) {
            if let Some(result) = self.line.ask(&[question], |message| wanted(message, next))? {
                return self.kept(result);
            }
            question = MavMessage::MISSION_ITEM_INT(item.clone());
        }
        match self.line.ask(&[question], |message| wanted(message, count))? {
            Some(result) => self.kept(result),
            None => Ok(()),
        }
    }

    /// Whether a mission was taken.
    fn kept(&self, result: u8) -> Result<(), HilError> {
        if result == MavMissionResult::MAV_MISSION_ACCEPTED as u8 {
            return Ok(());
        }
        Err(HilError::Refused(self.line.statistics.texts.last().cloned().unwrap_or_default()))
    }

    fn arm(&mut self, on: bool) -> Result<(), HilError> {
        // In flight too.
        let force = if on { 0.0 } else { 21196.0 };
        self.ordered(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, [f32::from(u8::from(on)), force])
    }

    /// A command, accepted.
    fn ordered(&mut self, command: MavCmd, [param1, param2]: [f32; 2]) -> Result<(), HilError> {
        let command = command as u16;
        let request = MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
            param1,
            param2,
            command,
            target_system: link::CONTROLLER.0,
            target_component: link::CONTROLLER.1,
            ..COMMAND_LONG_DATA::DEFAULT
        });
        let result = self.line.ask(&[request], |message| match message {
            MavMessage::COMMAND_ACK(ack) if ack.command == command => Some(ack.result),
            _ => None,
        })?;
        if result == MavResult::MAV_RESULT_ACCEPTED as u8 {
            return Ok(());
        }
        Err(HilError::Refused(self.line.statistics.texts.last().cloned().unwrap_or_default()))
    }

    fn frame(&mut self, measured: &Measured<'_, f64>, t_s: f64) -> LOAD_STATE_DATA {
        self.sequence = self.sequence.wrapping_add(1);
        let (state, uav) = (measured.state.map(State::cast), measured.uav.map(Uav::cast));
        let specific_force = measured.specific_force.map(|force| force.map(|x| x as f32));
        let mut frame = link::measured_frame(&Measured { state: state.as_ref(), uav: uav.as_ref(), specific_force });
        frame.time_usec = stamp(t_s);
        frame.sequence = self.sequence;
        let is_logged = ((t_s * self.rate_hz).round() as u64).is_multiple_of(self.log_every);
        frame.telemetry = u8::from(is_logged && self.line.options().telemetry);
        frame.reference_phase = ((self.reference_rate * t_s) % std::f64::consts::TAU) as f32;
        match self.begin {
            Begin::Begun => {}
            Begin::Standing => frame.action = LoadAction::LOAD_ACTION_STAND,
            Begin::On(zeta) => {
                frame.action = LoadAction::LOAD_ACTION_START;
                frame.zeta = zeta.map(|z| z as f32);
                self.zeta = frame.zeta.map(f64::from);
                self.begin = Begin::Begun;
            }
        }
        frame
    }

    /// What is said in this period: by the instruments, and `frame`, which ends it.
    fn words(&mut self, frame: LOAD_STATE_DATA) -> Vec<MavMessage> {
        let mut words = std::mem::take(&mut self.said);
        words.push(MavMessage::LOAD_STATE(frame));
        words
    }

    fn lockstep(&mut self, measured: &Measured<'_, f64>, t_s: f64) -> Result<Decision, HilError> {
        let frame = self.frame(measured, t_s);
        let sequence = frame.sequence;
        let is_asked = frame.telemetry != 0;
        let telemetry = std::cell::Cell::new(None);
        let begun = Instant::now();
        let words = self.words(frame);
        let command = self.line.ask(&words, |message| match message {
            MavMessage::LOAD_TELEMETRY(data) if data.sequence == sequence => {
                telemetry.set(Some(data.clone()));
                None
            }
            MavMessage::LOAD_COMMAND(data) if data.sequence == sequence => Some(data.clone()),
            _ => None,
        })?;
        self.line.statistics.latencies_s.push(begun.elapsed().as_secs_f64());
        let telemetry = telemetry.take();
        // Of a period without a state there is none.
        let has_state = !command.faults.intersects(LoadFault::LOAD_FAULT_NO_STATE | LoadFault::LOAD_FAULT_BAD_STATE);
        self.line.statistics.telemetry_lost += u64::from(is_asked && has_state && telemetry.is_none());
        self.decide(&command, telemetry.as_ref())
    }

    fn real_time(&mut self, measured: &Measured<'_, f64>, t_s: f64) -> Result<Decision, HilError> {
        let frame = self.frame(measured, t_s);
        let due = self.epoch + Duration::from_secs_f64(t_s);
        let begun = Instant::now();
        let first = self.command.is_none();
        if !first {
            let behind_s = begun.saturating_duration_since(due).as_secs_f64();
            self.line.statistics.behind_s = self.line.statistics.behind_s.max(behind_s);
        }
        let sequence = frame.sequence;
        let question = self.words(frame);
        // The first command is waited for; then what has come by the end of the period is what
        // there is.
        let (mut fresh, mut telemetry) = (None, None);
        let give_up = if first { begun + self.line.options().patience } else { due + self.period };
        self.line.transmit(&question)?;
        loop {
            while let Some(message) = self.line.next() {
                match message {
                    MavMessage::LOAD_COMMAND(data) if data.sequence != 0 => {
                        if data.sequence == sequence {
                            self.line.statistics.latencies_s.push(begun.elapsed().as_secs_f64());
                        }
                        fresh = Some(data);
                    }
                    MavMessage::LOAD_TELEMETRY(data) => telemetry = Some(data),
                    other => self.line.note(&other),
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
            self.line.receive(left)?;
        }
        if fresh.is_none() {
            self.line.statistics.late += 1;
        }
        let command = fresh.or_else(|| self.command.clone()).ok_or_else(|| self.line.lost(begun, 1))?;
        self.command = Some(command.clone());
        let telemetry = telemetry.filter(|data| data.sequence == command.sequence);
        self.decide(&command, telemetry.as_ref())
    }

    /// A period of a flight that a station commands. What the target says is passed on to it until
    /// the period is over.
    fn commanded(&mut self, measured: &Measured<'_, f64>, t_s: f64) -> Result<Decision, HilError> {
        let begun = Instant::now();
        let behind = begun.saturating_duration_since(self.epoch + Duration::from_secs_f64(t_s));
        self.line.statistics.behind_s = self.line.statistics.behind_s.max(behind.as_secs_f64());
        if behind > MOST_BEHIND {
            // Time that has been lost is not made up for.
            self.epoch += behind;
        }
        let due = self.epoch + Duration::from_secs_f64(t_s) + self.period;
        self.line.relay()?;
        let decision = if self.line.options().pace == Pace::Lockstep {
            Some(self.lockstep(measured, t_s)?)
        } else {
            let frame = self.frame(measured, t_s);
            let words = self.words(frame);
            self.line.transmit(&words)?;
            None
        };
        let mut fresh = None;
        let mut is_over = false;
        loop {
            while let Some(message) = self.line.next() {
                match message {
                    MavMessage::LOAD_COMMAND(data) => {
                        self.line.statistics.latencies_s.push(begun.elapsed().as_secs_f64());
                        fresh = Some(data);
                    }
                    other => self.line.note(&other),
                }
            }
            // However late it is, what has come is read once.
            if is_over {
                break;
            }
            let left = due.saturating_duration_since(Instant::now());
            is_over = left.is_zero();
            self.line.receive(left)?;
        }
        if let Some(decision) = decision {
            return Ok(decision);
        }
        if let Some(command) = fresh {
            self.heard = Instant::now();
            let decision = self.decide(&command, None);
            self.command = Some(command);
            return decision;
        }
        self.line.statistics.late += 1;
        if self.heard.elapsed() > self.line.options().patience {
            return Err(self.line.lost(self.heard, 1));
        }
        self.command.clone().map_or_else(|| Ok(Decision::off()), |command| self.decide(&command, None))
    }

    /// What a command says, once it is found to be one.
    fn decide(
        &mut self,
        command: &LOAD_COMMAND_DATA,
        telemetry: Option<&LOAD_TELEMETRY_DATA>,
    ) -> Result<Decision, HilError> {
        let sequence = command.sequence;
        if self.line.station.is_some() && command.mode == LoadMode::LOAD_MODE_OFF {
            // Armed since the last state, it has to be told how it finds the vehicle.
            if command.faults.contains(LoadFault::LOAD_FAULT_SEQUENCE) {
                self.begin = Begin::Standing;
            }
            self.line.statistics.cycles.push(command.cycles);
            return Ok(Decision::off());
        }
        if self.begin == Begin::Standing && command.mode != LoadMode::LOAD_MODE_OFF {
            self.begin = Begin::Begun;
        }
        if command.faults.contains(LoadFault::LOAD_FAULT_SEQUENCE)
            || command.faults.contains(LoadFault::LOAD_FAULT_NOT_ARMED)
        {
            return Err(HilError::OutOfStep { sequence });
        }
        let (most, torques) = self.limits;
        let allowed = (0.0..=most).contains(&command.thrust)
            && command.torque.iter().zip(torques).all(|(axis, most)| axis.abs() <= most)
            && command.rotor.iter().all(|duty| (0.0..=1.0).contains(duty))
            && command.zeta.iter().all(|z| z.is_finite());
        if !allowed {
            return Err(HilError::BadCommand { sequence, command: format!("{command:?}") });
        }
        self.line.statistics.faults |= command.faults.bits();
        self.line.statistics.cycles.push(command.cycles);
        // The answer has ζ at the hold's end; a decision has it at its start.
        let zeta = std::mem::replace(&mut self.zeta, command.zeta.map(f64::from));
        let margins = telemetry.map(|data| Margins {
            q3: data.q3.into(),
            q_b3: data.q_b3.into(),
            lambda: data.specific_force.into(),
            kappa: data.kappa.into(),
            path_det: data.path_det.into(),
            reach: data.reach.into(),
            cos_phi_squared: data.cos_phi_squared.into(),
        });
        let telemetry = telemetry.map(|data| Telemetry {
            integral: data.integral.map(f64::from),
            xi: data.xi.map(f64::from),
            nu: data.nu.map(f64::from),
            observed: Observed {
                payload_force: data.payload_force.map(f64::from),
                uav_force: data.uav_force.map(f64::from),
                torque: data.uav_torque.map(f64::from),
                payload_mass: data.payload_mass.into(),
            },
        });
        Ok(Decision {
            command: Command { thrust: command.thrust.into(), torque: Vector3::from(command.torque).map(f64::from) },
            body_rate: None,
            zeta,
            mode: mode(command.mode),
            fault: None,
            margins,
            telemetry,
        })
    }
}

impl Answers for Target {
    fn start(&mut self, _: &State<f64>, zeta: [f64; 4]) {
        self.begin = Begin::On(zeta);
    }

    fn take_over(&mut self, _: &State<f64>, _: &Command<f64>) {
        self.begin = Begin::On([0.0; 4]);
    }

    fn lands(&self) -> bool {
        self.lands
    }

    fn is_commanded(&self) -> bool {
        self.line.station.is_some()
    }

    fn finds_its_state(&self) -> bool {
        self.instruments.is_some()
    }

    fn step(&mut self, read: &Reading, request: Request, t_s: f64) -> Option<&Decision> {
        let Reading { comes, state, sees_load, uav, specific_force, aboard } = read;
        let all = Measured { state: sees_load.then_some(state), uav: uav.as_ref(), specific_force: *specific_force };
        let measured = match (&mut self.instruments, aboard) {
            (Some(instruments), Some(aboard)) => {
                self.said = instruments.say(aboard, t_s, stamp(t_s));
                None.into()
            }
            _ if *comes => all,
            _ => None.into(),
        };
        match self.fly(&measured, request, t_s) {
            Ok(decision) => Some(self.decision.insert(decision)),
            Err(error) => {
                self.failure = Some(error);
                None
            }
        }
    }
}

/// A time on the link, µs: a millionth of a second is finer than any control period; 0 would be no
/// time.
fn stamp(t_s: f64) -> u64 {
    (t_s * 1e6).round() as u64 + 1
}

/// What the target says that it is doing.
fn mode(mode: LoadMode) -> Mode {
    match mode {
        LoadMode::LOAD_MODE_OFF => Mode::Off,
        LoadMode::LOAD_MODE_IDLE => Mode::Idle,
        LoadMode::LOAD_MODE_TAKEOFF => Mode::TakeOff,
        LoadMode::LOAD_MODE_ENGAGE => Mode::Join,
        LoadMode::LOAD_MODE_FOLLOW => Mode::Follow,
        LoadMode::LOAD_MODE_HOLD => Mode::Hold,
        LoadMode::LOAD_MODE_LAND => Mode::Land,
        LoadMode::LOAD_MODE_FAULT => Mode::Fault,
    }
}

fn named_value(message: &MavMessage, name: &str) -> Option<f32> {
    match message {
        MavMessage::PARAM_VALUE(value) if link::text_of(&*value.param_id) == name => Some(value.param_value),
        _ => None,
    }
}
