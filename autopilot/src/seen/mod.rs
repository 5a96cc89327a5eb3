//! What is known of the vehicle at a control period: the load's state, and the UAV by its own
//! navigation, from one LOAD_STATE, from MAVLink's own messages beside it, or from what an
//! estimator makes of those.

mod instruments;
mod navigation;

pub use navigation::Navigation;

use controller::{Measured, State, Uav, Vector3};
use link::dialect::{LOAD_STATE_DATA, LoadSeen};

/// All that is seen at a control period.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    /// The load's state, if it is one.
    pub state: Option<State<f32>>,
    /// A state has come that is none.
    pub is_bad: bool,
    /// The UAV's own navigation, if it is told.
    pub uav: Option<Uav<f32>>,
    specific_force: Option<Vector3<f32>>,
}

impl Seen {
    /// In a frame.
    pub fn of(frame: &LOAD_STATE_DATA) -> Self {
        let is_none = frame.seen.contains(LoadSeen::LOAD_SEEN_NO_LOAD) || frame.position.iter().all(|p| p.is_nan());
        let state = (!is_none).then(|| link::state_of(frame));
        let is_bad = state.is_some_and(|state| state.check().is_err());
        Self { state, is_bad, uav: link::uav_of(frame), specific_force: link::specific_force_of(frame) }
    }

    /// What can't be used.
    pub fn bad() -> Self {
        Self { is_bad: true, ..Self::default() }
    }

    /// The state, if it is a good one.
    pub fn good(&self) -> Option<&State<f32>> {
        self.state.as_ref().filter(|_| !self.is_bad)
    }

    /// The UAV, if its navigation is a good one.
    pub fn uav(&self) -> Option<&Uav<f32>> {
        self.uav.as_ref().filter(|uav| uav.check().is_ok())
    }

    /// With what `navigation` has where this has nothing.
    pub fn or(self, navigation: &Navigation) -> Self {
        let specific_force = self.specific_force.or_else(|| navigation.specific_force());
        Self { uav: self.uav.or_else(|| navigation.uav()), specific_force, ..self }
    }

    /// With what an estimator has found where this has nothing.
    pub fn or_found(self, state: Option<State<f32>>, uav: &Uav<f32>, specific_force: &Vector3<f32>) -> Self {
        Self {
            state: self.state.or(state),
            uav: self.uav.or(Some(*uav)),
            specific_force: self.specific_force.or(Some(*specific_force)),
            ..self
        }
    }

    /// For the controller.
    pub fn measured(&self) -> Measured<'_, f32> {
        Measured { state: self.state.as_ref(), uav: self.uav.as_ref(), specific_force: self.specific_force }
    }
}
