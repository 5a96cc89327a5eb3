//! A mission under way: what its end leads to, pause and continue, speed, and the item that comes
//! next.

use controller::{Mode, Request, State, Vector3};
use link::Home;
use rig::parameter;

use super::{Autopilot, Notice};
use crate::estimate::{Source, params};
use crate::failsafe::wanted;
use crate::mission::{DEGREES, Flown, Item, Kind, Mission, Progress};
use crate::settings::{Setting, Settings};

/// How a flight along a mission stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Underway {
    /// What the route's speed is multiplied by, when it is not paused.
    factor: f32,
    is_paused: bool,
    has_begun: bool,
}

impl Default for Underway {
    fn default() -> Self {
        Self { factor: 1.0, is_paused: false, has_begun: false }
    }
}

/// What becomes of a mission, as MISSION_STATE has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MissionState {
    /// There is none.
    None,
    /// It has not begun.
    NotStarted,
    /// It is flown.
    Active,
    /// It has begun, and is not being flown.
    Paused,
    /// The load rests at its end.
    Complete,
}

/// The fence is checked every so many steps: a check costs about as much as a step.
const FENCE_EVERY: u8 = 9;

const NO_ROUTE: &str = "no route is flown";

impl Autopilot {
    /// The mission that is kept.
    #[must_use]
    pub fn mission(&self) -> &Mission {
        &self.mission
    }

    /// How far along it the load is, in flight.
    #[must_use]
    pub fn progress(&self) -> Option<Progress> {
        self.mission.progress(self.rig.as_ref()?)
    }

    /// What becomes of the mission.
    #[must_use]
    pub fn mission_state(&self) -> MissionState {
        let progress = self.progress();
        let is_flown = matches!(self.mode(), Mode::Join | Mode::Follow) && !self.underway.is_paused;
        match progress {
            _ if self.mission.items(Kind::Mission).is_empty() => MissionState::None,
            Some(Progress { is_complete: true, .. }) => MissionState::Complete,
            Some(_) if is_flown => MissionState::Active,
            Some(_) if self.underway.has_begun => MissionState::Paused,
            _ => MissionState::NotStarted,
        }
    }

    /// The mission, to be changed; `None` when armed.
    pub(crate) fn mission_mut(&mut self) -> Option<(&mut Mission, &Settings)> {
        if self.is_armed() { None } else { Some((&mut self.mission, &self.settings)) }
    }

    /// Where on the earth N has its origin.
    ///
    /// # Errors
    /// Not while armed: what is flown is counted from it.
    pub(crate) fn set_home(&mut self, home: Home) -> Result<(), &'static str> {
        if self.mission.home() != Some(&home) {
            let (mission, settings) = self.mission_mut().ok_or("home: not while armed")?;
            mission.set_home(Some(home), settings);
            self.navigation.instruments_mut().set_home(&home);
            // What it has found is counted from another place.
            self.estimator = None;
        }
        self.is_home_told = true;
        Ok(())
    }

    /// Where none was told, home is where navigation of our own counts from, the first fix; there
    /// is none where another's navigation has its own origin. Returns whether one was found.
    pub(crate) fn find_home(&mut self) -> bool {
        let is_own = matches!(params::source(&self.settings), Some(Source::Sensors));
        let found = self.navigation.instruments_mut().origin().filter(|_| is_own);
        if self.is_home_told || self.is_armed() || self.mission.home() == found.as_ref() {
            return false;
        }
        self.mission.set_home(found, &self.settings);
        found.is_some()
    }

    /// Where on the earth the UAV is, for a home there.
    ///
    /// # Errors
    /// It is not known, or not what N would then be counted from.
    pub(crate) fn here(&self) -> Result<Home, &'static str> {
        if !matches!(params::source(&self.settings), Some(Source::Sensors)) {
            return Err("home: N is counted from another origin");
        }
        let (Some(home), Some(uav)) = (self.mission.home(), &self.uav) else {
            return Err("home: no position now");
        };
        let [x, y, z] = uav.position.into();
        let [latitude, longitude] = home.place([x, y]).map(|steps| f64::from(steps) * DEGREES);
        Ok(Home { latitude, longitude, altitude: home.altitude - f64::from(z) })
    }

    /// Flies the mission, from the ground or from the air.
    ///
    /// # Errors
    /// Why not now.
    pub(crate) fn start_mission(&mut self) -> Result<(), &'static str> {
        if self.progress().is_none() {
            return Err("mission: arm with PATH_KIND route first");
        }
        if self.mode() == Mode::Idle && !self.navigates {
            return Err("take-off needs the UAV's own position");
        }
        self.follow()
    }

    /// Joins the path from where the vehicle is, and follows it.
    ///
    /// # Errors
    /// The straight way to a route does not keep the fence's margin.
    pub(crate) fn follow(&mut self) -> Result<(), &'static str> {
        match self.way_breach() {
            None => {
                self.request(Request::Follow);
                Ok(())
            }
            Some("the load") => Err("way to the route: the load too near the fence"),
            Some("the UAV") => Err("way to the route: the UAV too near the fence"),
            Some(_) => Err("way to the route: the cable too near the fence"),
        }
    }

    /// What does not keep the fence's margin on the straight way to where the route is joined, from
    /// the air or from above where the vehicle stands.
    fn way_breach(&self) -> Option<&'static str> {
        if matches!(self.mode(), Mode::Join | Mode::Follow) {
            return None;
        }
        let Flown::Route(route) = self.rig.as_ref()?.following()?.path() else { return None };
        let State { position, rod, .. } = self.load.as_ref()?;
        let rig = self.settings.rig();
        let up = Vector3::new(0.0, 0.0, -rig.get(parameter!("VEH_ROD")));
        let from = if self.mode() == Mode::Idle {
            let risen = position - Vector3::new(0.0, 0.0, rig.get(parameter!("POL_CLEAR")));
            [risen, risen + up]
        } else {
            let above = self.navigation.uav().map_or(position + rod * up.z, |uav| uav.position);
            [*position, above]
        };
        self.mission.way_breach(&from, &[route.point(), route.point() + up], &self.settings)
    }

    /// The same by a command's number, of which −1 is the item that is current.
    ///
    /// # Errors
    /// Why not now, or that there is no such item.
    pub(crate) fn set_current_item_by(&mut self, number: f32) -> Result<(), &'static str> {
        let item = if number == -1.0 { f32::from(self.current_item()) } else { number };
        if (0.0..=f32::from(u16::MAX)).contains(&item) {
            self.set_current_item(item as u16)
        } else {
            Err("mission: no such item")
        }
    }

    /// Has the mission go on with the legs since the stop before `item`.
    ///
    /// # Errors
    /// Why not now.
    pub(crate) fn set_current_item(&mut self, item: u16) -> Result<(), &'static str> {
        if matches!(self.mode(), Mode::Join | Mode::Follow) {
            return Err("mission: hold first, then another item");
        }
        self.mission.set_current(item, self.rig.as_mut())
    }

    /// Comes to rest on the path, or goes on: from a pause, or else from a stop.
    ///
    /// # Errors
    /// Why not now.
    pub(crate) fn pause(&mut self, is_paused: bool) -> Result<(), &'static str> {
        let factor = if is_paused { 0.0 } else { self.underway.factor };
        let law = self.rig.as_mut().and_then(rig::Rig::following_mut).ok_or("no path is followed")?;
        if is_paused != self.underway.is_paused {
            law.set_speed_factor(factor);
            self.underway.is_paused = is_paused;
        } else if !is_paused && law.rests() && !law.go_on() && self.mission.lands() {
            self.request(Request::Land);
        }
        Ok(())
    }

    /// Flies the route at `speed`, m/s, from now on, where its leg allows that. −1 leaves it as it
    /// is, −2 has it flown as it is laid.
    ///
    /// # Errors
    /// Why not now.
    pub(crate) fn change_speed(&mut self, speed: f32) -> Result<(), &'static str> {
        let next = self.progress().ok_or(NO_ROUTE)?.passed;
        let most = self.mission.speed_to(next).ok_or(NO_ROUTE)?;
        let factor = match speed {
            -1.0 => return Ok(()),
            -2.0 => 1.0,
            speed => speed / most,
        };
        // What the vehicle can do was found out for the leg's own.
        if factor > 1.0 {
            return Err("speed: above that of the route's leg");
        }
        if factor.is_nan() || factor <= 0.0 {
            return Err("speed: above 0; to rest, pause");
        }
        self.underway.factor = factor;
        if !self.underway.is_paused
            && let Some(law) = self.rig.as_mut().and_then(rig::Rig::following_mut)
        {
            law.set_speed_factor(factor);
        }
        Ok(())
    }

    /// After each step: a mission that ends on the ground lands when it has rested at its end.
    pub(super) fn end_mission(&mut self, mode: Mode) {
        let Some(law) = self.rig.as_ref().and_then(rig::Rig::following) else { return };
        let Flown::Route(_) = law.path() else { return };
        let is_over = mode == Mode::Follow && law.is_over();
        self.underway.has_begun |= mode == Mode::Follow;
        if self.mission.lands() && is_over && self.request == Request::Follow {
            self.request(Request::Land);
        }
    }

    /// Every so many steps: has load, UAV or cable come too near the fence, it does what is
    /// configured. Where the load is not known, the UAV alone is looked at.
    pub(super) fn watch_fence(&mut self, load: Option<Vector3<f32>>, mode: Mode) {
        let is_watched = matches!(mode, Mode::TakeOff | Mode::Join | Mode::Follow | Mode::Hold);
        let uav = self.uav.map(|uav| uav.position).filter(|_| is_watched && self.until_fence == 0);
        let Some(uav) = uav else {
            self.until_fence = self.until_fence.saturating_sub(1);
            return;
        };
        self.until_fence = FENCE_EVERY;
        let rises = mode == Mode::TakeOff;
        let keeps = self.mission.keeps_fence(&[load.unwrap_or(uav), uav], rises, &self.settings);
        if self.keeps_fence && !keeps {
            self.note(Notice::Fence);
            if let Some(wanted) = wanted(Setting::FENCE_ACTION, &self.settings)
                && self.request != Request::Land
            {
                // Hold is where a take-off ends, and does not end it sooner.
                self.request(if rises { Request::Land } else { wanted });
            }
        }
        // That the UAV is back says nothing of the load.
        self.keeps_fence = keeps && (self.keeps_fence || load.is_some());
    }

    /// The item that the load is on its way to, or is at; before a flight, the one that it begins
    /// with.
    #[must_use]
    pub(crate) fn current_item(&self) -> u16 {
        let next = self.progress().map_or_else(|| self.before_run(), |progress| progress.passed);
        self.mission.item_of(next).unwrap_or_default()
    }

    /// How many waypoints lie before the run that is flown, or that is to be.
    pub(crate) fn before_run(&self) -> usize {
        self.mission.before_run(self.rig.as_ref())
    }

    /// An item that is kept.
    #[must_use]
    pub(crate) fn item(&self, kind: Kind, seq: u16) -> Option<&Item> {
        self.mission.items(kind).get(usize::from(seq))
    }
}
