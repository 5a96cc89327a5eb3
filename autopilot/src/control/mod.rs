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
//! control period steps the supervisor (`controller::Supervisor`, which has the modes' table) on
//! the newest state: a missing one is passed on as absent; the supervisor goes on by its model,
//! then sinks or cuts. What the pilot asks for ([`Autopilot::request`]) lasts until disarming.

mod arming;
mod mission;
mod step;
mod words;

use mission::Underway;

pub use arming::ArmRefused;
pub use mission::MissionState;
pub use words::{Absence, Answer, Boot, Counters, Drive, Notice};

use controller::{Actuation as _, Fault, Margin, Mode, Request, State, Uav};
use link::dialect::{LOAD_COUNTERS_DATA, LOAD_STATE_DATA, MavLandedState, MavMissionResult};
use rig::{Output, Rig, parameter};

use crate::epoch::Epoch;
use crate::estimate::Estimator;
use crate::failsafe::{Failsafe, Loss};
use crate::mission::{Flown, Kind, Memory, Mission, Refusal};
use crate::seen::Navigation;
use crate::settings::{Setting, Settings};
use crate::store::{Flash, Store};

/// The flight program's control side.
#[derive(Debug)]
pub struct Autopilot {
    settings: Settings,
    boot: Boot,
    counters: Counters,
    /// While armed.
    rig: Option<Rig<f32, Flown>>,
    mission: Mission,
    is_home_told: bool,
    underway: Underway,
    request: Request,
    /// Newest state that has come in flight and was not used yet.
    inbox: Option<LOAD_STATE_DATA>,
    navigation: Navigation,
    /// While `EST_LOAD` is on; forgotten with each change of a parameter.
    estimator: Option<Estimator>,
    /// The estimator goes by fixes, and misses them.
    misses_fix: bool,
    /// The UAV's own navigation was there at the last control period.
    navigates: bool,
    /// The UAV as it was known then, from that or from the load's state.
    uav: Option<Uav<f32>>,
    /// The vehicle is known to stand on the ground.
    stands: bool,
    epoch: Epoch,
    /// The load as it was known last.
    load: Option<State<f32>>,
    /// The last state that has come, and what was wrong with those since the last control period.
    newest: Option<State<f32>>,
    newest_uav: Option<Uav<f32>>,
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
    /// [`arming::PRESSED`].
    kill: bool,
    kill_pin: u8,
    /// Steps until the fence is looked at again, and whether it was kept then.
    until_fence: u8,
    keeps_fence: bool,
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
            mission: Mission::none(),
            is_home_told: false,
            underway: Underway::default(),
            request: Request::Idle,
            inbox: None,
            navigation: Navigation::new(),
            estimator: None,
            misses_fix: false,
            navigates: false,
            uav: None,
            stands: false,
            epoch: Epoch::default(),
            load: None,
            newest: None,
            newest_uav: None,
            refused: None,
            absence: None,
            fault: None,
            since_state_s: f32::INFINITY,
            blind_s: 0.0,
            apart_s: [0.0; 2],
            failsafe: Failsafe::default(),
            kill: false,
            kill_pin: 0,
            until_fence: 0,
            keeps_fence: true,
            notice: (0, Notice::Nothing),
            last: None,
            overrun: false,
            until_telemetry: 0,
        }
    }

    /// With memory for missions.
    #[must_use]
    pub fn with_memory<const KNOTS: usize>(mut self, memory: &'static mut Memory<KNOTS>) -> Self {
        self.mission.lend(memory);
        self
    }

    /// Takes the mission and the fence that `store` has kept.
    ///
    /// # Errors
    /// One of them makes no route or fence any more, or the route does not keep the fence's margin:
    /// both are kept, and arming is refused as it would have been without a reset.
    pub fn recall<F: Flash>(&mut self, store: &Store<F>) -> Result<(), Refusal> {
        Kind::ALL.into_iter().for_each(|kind| self.mission.recall(kind, store.items(kind)));
        match self.mission.lay(&self.settings) {
            // The home may come later.
            Err(refusal) if refusal.result != MavMissionResult::MAV_MISSION_ERROR => Err(refusal),
            _ => Ok(()),
        }
    }

    /// The parameters.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The parameters, to be changed; `None` when armed.
    pub fn settings_mut(&mut self) -> Option<&mut Settings> {
        if self.is_armed() {
            return None;
        }
        self.estimator = None;
        Some(&mut self.settings)
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

    /// The UAV as it was known at the last control period.
    #[must_use]
    pub fn uav(&self) -> Option<&Uav<f32>> {
        self.uav.as_ref()
    }

    /// The thrust of the last command, of what the rotors give at most.
    pub(crate) fn throttle(&self) -> f32 {
        self.rig.as_ref().map_or(0.0, |rig| rig.output().command.thrust / rig.actuators().largest_thrust())
    }

    fn note(&mut self, notice: Notice) {
        self.notice = (self.notice.0.wrapping_add(1), notice);
    }

    /// A ground station lives.
    pub fn hear_station(&mut self) {
        self.failsafe.hear_station();
    }

    /// What the UAV's own navigation has to say, beside the states.
    pub(crate) fn navigation_mut(&mut self) -> &mut Navigation {
        &mut self.navigation
    }

    /// The battery has so much left, %.
    pub fn hear_battery(&mut self, number: u8, percent: i8) {
        self.failsafe.hear_battery(number, percent);
    }

    /// What the battery has left, %, if that is known.
    pub(crate) fn battery(&self) -> Option<i8> {
        self.failsafe.battery()
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
}
