//! Arming and its refusals, disarming, and the kill switches.

use controller::{Actuation as _, Request, State};
use rig::{Rig, SetupError, parameter};

use super::{Absence, Autopilot, Drive, Notice, Underway};
use crate::epoch::Epoch;
use crate::estimate::Unseen;
use crate::failsafe::Loss;
use crate::mission::{Flown, NoRig, Refusal};
use crate::report;
use crate::settings::Setting;

/// Arming needs a state no older than this, s.
const FRESH_S: f32 = 0.5;
/// The kill pin counts when it is high for so many control steps in a row: no spike stops a flight.
const PRESSED: u8 = 3;

/// Why it is not armed.
#[derive(Clone, Debug, PartialEq)]
pub enum ArmRefused {
    /// The parameters make no controller.
    Setup(SetupError<f32>),
    /// The mission is to be flown, and can't be; or there is a fence that can't be kept.
    Mission(Refusal),
    /// Load, UAV or cable is too near the fence.
    Fence,
    /// Limits and rotors give no more than this share of the hover thrust.
    Weak(f32),
    /// There has been no good state just now.
    NoState,
    /// The estimator knows none, for this reason.
    Unseen(Unseen),
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
        !matches!(self, Self::Setup(_) | Self::Mission(_) | Self::Weak(_))
    }
}

impl core::fmt::Display for ArmRefused {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Setup(error) => error.fmt(f),
            Self::Mission(refusal) => refusal.fmt(f),
            Self::Fence => f.write_str("not armed: too near the fence, or outside"),
            Self::Weak(share) => write!(f, "not armed: {share:.2} of hover is all (ARM_THRUST)"),
            Self::NoState => f.write_str("not armed: no good state just now"),
            Self::Unseen(Unseen::Fix) => f.write_str("not armed: waits for a fix of the receiver"),
            Self::Unseen(unseen) => write!(f, "not armed: {}", report::unseen_text(*unseen)),
            Self::Slow(apart, most) => write!(f, "not armed: states {apart:.2} s apart, POL_COAST {most}"),
            Self::Killed => f.write_str("not armed: the kill switch is on"),
            Self::Lost(Loss::Station) => f.write_str("not armed: ground station lost"),
            Self::Lost(Loss::Stick) => f.write_str("not armed: stick or radio lost"),
            Self::Lost(Loss::Battery) => f.write_str("not armed: battery below FS_BAT_PCT"),
        }
    }
}

impl core::error::Error for ArmRefused {}

impl Autopilot {
    /// Makes the controller of the parameters as they are, to be started by the next good state.
    /// Armed already, it does nothing.
    ///
    /// # Errors
    /// Why not; it stays disarmed.
    pub fn arm(&mut self) -> Result<(), ArmRefused> {
        if !self.is_armed() {
            if self.is_killed() {
                return Err(ArmRefused::Killed);
            }
            if let Some(loss) = Loss::ALL.into_iter().find(|loss| self.failsafe.is_lost(*loss, &self.settings)) {
                return Err(ArmRefused::Lost(loss));
            }
            self.make_estimator().map_err(|error| ArmRefused::Setup(error.into()))?;
            if self.drive() == Drive::Flight && self.since_state_s > FRESH_S {
                return Err(match self.absence {
                    Some(Absence::Unseen(unseen)) => ArmRefused::Unseen(unseen),
                    _ => ArmRefused::NoState,
                });
            }
            let most = self.settings.rig().get(parameter!("POL_COAST"));
            // One gap is no rate.
            let apart_s = self.apart_s[0].min(self.apart_s[1]);
            if self.drive() == Drive::Flight && apart_s > most {
                return Err(ArmRefused::Slow(apart_s, most));
            }
            self.find_home();
            self.mission.lay_fence().map_err(ArmRefused::Mission)?;
            if self.drive() == Drive::Lockstep {
                // No time goes by without a state: the last may be of another flight.
                self.load = None;
            }
            let stands = self.is_to_stand();
            if !self.stays_in_fence(stands) {
                return Err(ArmRefused::Fence);
            }
            if let Some(estimator) = &mut self.estimator {
                estimator.restart(&self.settings, stands).map_err(|error| ArmRefused::Setup(error.into()))?;
            }
            let rig = self.make_rig()?;
            let share = rig.actuators().largest_thrust() / rig.vehicle().hover_thrust();
            if share < self.settings.get(Setting::ARMING_THRUST) {
                self.mission.take_back(rig);
                return Err(ArmRefused::Weak(share));
            }
            self.rig = Some(rig);
            self.underway = Underway::default();
            self.inbox = None;
            self.epoch = Epoch::default();
            (self.newest, self.newest_uav) = (None, None);
            (self.until_fence, self.keeps_fence) = (0, true);
            self.blind_s = 0.0;
            self.last = None;
            self.until_telemetry = 0;
        }
        Ok(())
    }

    /// Whether it is to be armed on the ground.
    fn is_to_stand(&self) -> bool {
        self.request == Request::Idle || self.stands
    }

    /// Whether the vehicle keeps the fence, as far as it is seen just now.
    fn stays_in_fence(&self, stands: bool) -> bool {
        let now = self.load.as_ref().filter(|_| self.since_state_s <= FRESH_S);
        let Some(State { position, rod, .. }) = now else { return true };
        let above = position - rod * self.settings.rig().get(parameter!("VEH_ROD"));
        let uav = self.uav.map_or(above, |uav| uav.position);
        self.mission.keeps_fence(&[*position, uav], stands, &self.settings)
    }

    fn make_rig(&mut self) -> Result<Rig<f32, Flown>, ArmRefused> {
        let parameters = self.settings.rig();
        if parameters.is_route() && !parameters.is_on(parameter!("CTL_LAW")) {
            return self.mission.rig(&self.settings).map_err(|why| match why {
                NoRig::Mission(refusal) => ArmRefused::Mission(refusal),
                NoRig::Setup(error) => ArmRefused::Setup(error),
            });
        }
        let path = rig::path(parameters).map_err(|error| ArmRefused::Setup(error.into()))?;
        Rig::on(path, parameters).map_err(ArmRefused::Setup)
    }

    /// Rotors off. What was asked for is forgotten.
    pub fn disarm(&mut self) {
        self.stands &= !self.is_flying();
        if let Some(rig) = self.rig.take() {
            self.mission.take_back(rig);
            self.mission.begin_again();
        }
        self.fault = None;
        self.request = Request::Idle;
        self.last = None;
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

    /// Whether nothing of the moment keeps it from being armed.
    pub(crate) fn is_ready(&self) -> bool {
        let is_lost = Loss::ALL.into_iter().any(|loss| self.failsafe.is_lost(loss, &self.settings));
        let is_well_placed = self.is_armed() || self.stays_in_fence(self.is_to_stand());
        self.since_state_s <= FRESH_S && !self.is_killed() && !is_lost && is_well_placed
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
}
