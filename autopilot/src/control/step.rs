//! A control period: from the states that have come to the command.

use controller::{Command, Fault, Mode, Request, State, Uav};
use estimator::OutOfRange;
use link::dialect::{LOAD_COMMAND_DATA, LOAD_STATE_DATA, LoadAction, LoadFault, LoadSeen};
use rig::{Output, parameter};

use super::{Absence, Answer, Autopilot, Drive, Notice};
use crate::estimate::{Estimator, Found, Unseen, params};
use crate::report;
use crate::seen::Seen;
use crate::settings::Setting;

/// A load nearer to its UAV than this share of the cable does not hang from it.
const SLACK: f32 = 0.9;

impl Autopilot {
    /// A state for the coming control period: flight and real time. One from another time than the
    /// last, earlier or seconds later, is refused; but for the third in a row that agree on
    /// another, which is that of a clock that has restarted. Of a real vehicle in flight so is one
    /// that is the last again, the load's or the UAV's: an estimator that has stopped. A simulated
    /// one can be at rest to the bit.
    pub fn receive(&mut self, frame: &LOAD_STATE_DATA) {
        if !self.epoch.accept(frame.time_usec) {
            self.counters.refused = self.counters.refused.wrapping_add(1);
            self.refused = Some(Absence::Stale);
            return;
        }
        let mut frame = frame.clone();
        let Seen { state, uav, .. } = Seen::of(&frame);
        let may_freeze = self.drive() == Drive::Flight && self.is_flying();
        if uav.is_some() {
            let is_again = self.newest_uav == uav;
            self.newest_uav = uav;
            if is_again && may_freeze {
                frame.seen.remove(LoadSeen::LOAD_SEEN_UAV);
            }
        }
        if state.is_some() {
            let is_again = self.newest == state;
            self.newest = state;
            if is_again && may_freeze {
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
        self.pass();
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
        if params::source(&self.settings).is_some() {
            self.pass();
        }
        let answer = self.control(Some(frame));
        self.last = Some(answer.clone());
        answer
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
        let refused = self.refused.take();
        let seen = self.look(frame, refused);
        faults.set(LoadFault::LOAD_FAULT_NO_FIX, self.watch_fixes());
        let good = seen.good();
        if self.rig.is_none() {
            return self.nothing(frame, faults);
        }
        faults |= self.counters.take(self.absence);
        faults.set(LoadFault::LOAD_FAULT_STALE_STATE, refused.is_some());
        if let Some(state) = good {
            self.begin(state, seen.uav(), frame);
        }
        let Some(rig) = &mut self.rig else { return self.nothing(frame, faults) };
        let (integral, before) = (rig.integral(), rig.mode());
        let phase = frame.map_or(0.0, |frame| frame.reference_phase);
        let mut measured = seen.measured();
        if before == Mode::Off && good.is_none() {
            // Whether it stands or flies, the first good state says.
            measured.uav = None;
        }
        let Output { mode, fault, limited, .. } = *rig.step(measured, self.request, phase);
        self.judge(fault, before, mode);
        faults |= fault.map_or(LoadFault::empty(), report::fault);
        faults.set(LoadFault::LOAD_FAULT_LIMITED, limited);
        let mut answer = self.answer(frame, faults);
        if let Some(state) = good
            && (self.is_telemetry_s_turn() || frame.is_some_and(|frame| frame.telemetry != 0))
        {
            let sequence = answer.command.sequence;
            answer.telemetry = self.rig.as_ref().map(|rig| report::telemetry(sequence, rig, state, integral));
        }
        self.end_mission(mode);
        self.watch_fence(good.map(|state| state.position), mode);
        let is_down = mode == Mode::Off && (good.is_some() || before != Mode::Off);
        self.stands = mode == Mode::Idle || is_down || mode == Mode::Off && self.stands;
        if is_down {
            self.disarm();
        }
        self.end_blindness(mode);
        answer
    }

    /// What is seen by a frame and what is known beside it; and since when and why the load is not.
    fn look(&mut self, frame: Option<&LOAD_STATE_DATA>, refused: Option<Absence>) -> Seen {
        let seen = match frame {
            Some(frame) if may_start(frame) => Seen::of(frame),
            Some(_) => Seen::bad(),
            None => Seen::default(),
        };
        let (seen, unseen) = self.see(seen);
        let good = seen.good();
        self.navigates = seen.uav().is_some();
        let length = self.settings.rig().get(parameter!("VEH_ROD"));
        self.uav = seen.uav().copied().or_else(|| good.map(|state| above(state, length)));
        self.absence = match good {
            Some(_) => None,
            None if seen.is_bad => Some(Absence::Bad),
            None => refused.or(unseen.map(Absence::Unseen)).or(Some(Absence::Missing)),
        };
        if let Some(state) = good {
            self.load = Some(*state);
            let apart_s = if self.since_state_s.is_finite() { self.since_state_s } else { 0.0 };
            self.apart_s = [self.apart_s[1], apart_s];
        }
        self.since_state_s = if good.is_some() { 0.0 } else { self.since_state_s + self.period_s() };
        seen
    }

    /// What a good state does to what is asked for, and to the controller's memory, before the step
    /// on it.
    fn begin(&mut self, state: &State<f32>, uav: Option<&Uav<f32>>, frame: Option<&LOAD_STATE_DATA>) {
        let (action, zeta) =
            frame.map_or((LoadAction::LOAD_ACTION_CONTINUE, [0.0; 4]), |frame| (frame.action, frame.zeta));
        if action == LoadAction::LOAD_ACTION_START {
            self.request = Request::Follow;
        }
        let Some(rig) = &mut self.rig else { return };
        let length = rig.vehicle().params().rod_length;
        let is_slack = uav.is_some_and(|uav| {
            let line = state.position - uav.position;
            line.dot(&line) < (SLACK * length) * (SLACK * length)
        });
        // What stands is not taken over in flight, whatever was asked for.
        let request = if self.stands || is_slack { Request::Idle } else { self.request };
        let is_off = rig.mode() == Mode::Off;
        let hover = Command::of_thrust(rig.vehicle().hover_thrust());
        let applied = if is_off { hover } else { rig.output().command };
        // A good state and finite numbers are not refused; if they were, the law would be as it
        // was.
        let begun = match action {
            LoadAction::LOAD_ACTION_START => rig.start(state, zeta),
            LoadAction::LOAD_ACTION_ENGAGE => rig.take_over(state, applied),
            LoadAction::LOAD_ACTION_CONTINUE if is_off && request != Request::Idle => rig.take_over(state, applied),
            LoadAction::LOAD_ACTION_CONTINUE | LoadAction::LOAD_ACTION_STAND => Ok(()),
        };
        debug_assert!(begun.is_ok(), "{begun:?}");
    }

    /// Keeps what is wrong after a step from one mode to the next, and counts falls from the law.
    fn judge(&mut self, fault: Option<Fault>, before: Mode, mode: Mode) {
        let is_away = matches!(self.absence, Some(Absence::Missing | Absence::Frozen | Absence::Unseen(_)));
        // To an estimator the load is out of sight whenever it stands, and back in sight when it
        // hangs.
        let is_nothing_wrong = fault == Some(Fault::NoState)
            && match self.absence {
                Some(Absence::Unseen(Unseen::Rod(_))) => !matches!(mode, Mode::Join | Mode::Follow | Mode::Hold),
                Some(_) => false,
                None => self.estimator.is_some(),
            };
        let is_in_flight = !matches!(mode, Mode::Off | Mode::Idle | Mode::Fault);
        if !(is_away && is_in_flight && self.since_state_s <= self.settings.rig().get(parameter!("POL_COAST"))) {
            self.fault = fault.filter(|_| !is_nothing_wrong);
        }
        let has_fallen_back = is_flying(before) && self.request == Request::Follow && !is_flying(mode);
        self.counters.fallbacks = self.counters.fallbacks.wrapping_add(u32::from(has_fallen_back));
    }

    /// The answer after a step.
    fn answer(&self, frame: Option<&LOAD_STATE_DATA>, faults: LoadFault) -> Answer {
        let mut answer = self.nothing(frame, faults);
        let Some(rig) = &self.rig else { return answer };
        let Command { thrust, torque } = rig.output().command;
        let u_zeta = rig.u_zeta();
        let zeta = u_zeta.map_or([0.0; 4], |_| rig.zeta().map(report::number));
        let (torque, u_zeta, rotor) = (torque.into(), u_zeta.unwrap_or(0.0), rig.duties());
        answer.command = LOAD_COMMAND_DATA { thrust, torque, zeta, u_zeta, rotor, ..answer.command };
        if self.drive() == Drive::Flight {
            answer.outputs = rotor;
        }
        answer
    }

    /// The UAV moves on, and the estimator is there if it is to be.
    fn pass(&mut self) {
        let gravity = self.settings.rig().get(parameter!("VEH_G"));
        self.navigation.pass(self.period_s(), gravity);
        // One that can't be made is none, and arming says why.
        let _ = self.make_estimator();
    }

    /// Makes the estimator that the parameters describe.
    pub(super) fn make_estimator(&mut self) -> Result<(), OutOfRange<f32>> {
        if self.estimator.is_none() {
            self.estimator = Estimator::new(&self.settings)?;
        }
        Ok(())
    }

    /// What is seen by a frame, with what else is known of the UAV and, by an estimator, of the
    /// load; and why that is not known. In lockstep without an estimator the same frames have the
    /// same answers, whatever comes between them.
    fn see(&mut self, seen: Seen) -> (Seen, Option<Unseen>) {
        let thrust = self.rig.as_ref().map(|rig| rig.applied().thrust);
        // Whether it stands or flies, the first state says, though nothing is known of the rod.
        let begins = self.mode() == Mode::Off;
        let is_lockstep = self.drive() == Drive::Lockstep;
        match &mut self.estimator {
            Some(estimator) => match estimator.step(&self.settings, &mut self.navigation, thrust) {
                Ok(Found { state, uav, specific_force, unseen }) => {
                    let state = (begins || unseen.is_none()).then_some(state);
                    (seen.or_found(state, &uav, &specific_force), unseen)
                }
                Err(unseen) => (seen.or(&self.navigation), Some(unseen)),
            },
            None if is_lockstep => (seen, None),
            None => (seen.or(&self.navigation), None),
        }
    }

    /// Whether fixes are missing; in flight, the pilot hears when they begin to and when they come
    /// again.
    fn watch_fixes(&mut self) -> bool {
        let misses = self.estimator.as_ref().is_some_and(Estimator::misses_fix);
        if self.is_armed() && misses != self.misses_fix {
            self.note(if misses { Notice::Drifts } else { Notice::Fixed });
        }
        self.misses_fix = misses;
        misses
    }

    /// Stops the rotors where they have turned for too long without a state, or in fault.
    fn end_blindness(&mut self, mode: Mode) {
        let is_lost = self.absence.is_some_and(|absence| !matches!(absence, Absence::Unseen(Unseen::Rod(_))));
        let is_blind = mode == Mode::Fault || mode == Mode::Idle && is_lost;
        self.blind_s = if is_blind { self.blind_s + self.period_s() } else { 0.0 };
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

/// Whether the frame has a finite ζ, if it is one to start with.
fn may_start(frame: &LOAD_STATE_DATA) -> bool {
    frame.action != LoadAction::LOAD_ACTION_START || frame.zeta.iter().all(|z| z.is_finite())
}

/// The UAV of a load on a taut cable.
fn above(state: &State<f32>, length: f32) -> Uav<f32> {
    let State { position, velocity, rod, rod_rate, attitude, body_rate } = *state;
    Uav { position: position - rod * length, velocity: velocity - rod_rate * length, attitude, body_rate }
}

/// Whether the law flies.
fn is_flying(mode: Mode) -> bool {
    matches!(mode, Mode::Join | Mode::Follow)
}
