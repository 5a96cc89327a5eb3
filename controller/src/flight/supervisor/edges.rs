//! The edges between modes, as [`Supervisor`]'s table has them.

use model::{Real, State, Uav};

use super::Supervisor;
use crate::error::Refused;
use crate::flight::envelope::Standing;
use crate::flight::footing::Footing;
use crate::flight::landing::Landing;
use crate::flight::mode::{Fault, Lost, Mode, Request};
use crate::law::Law;
use crate::law::hold::Hold;
use crate::law::margins::Margins;
use crate::sampled::actuator::Actuation;

/// With more vertical acceleration than this, m/s², the load is falling or swings high. Hold, which
/// stops both as hard as the rotors can, goes first: the path would be joined by as much of a dip,
/// m.
const JOINING: f64 = 0.5;
impl<T: Real, L: Law<T>, A: Actuation<T>> Supervisor<T, L, A> {
    /// The edges that requests and good states open: the table's rows.
    #[inline]
    pub(super) fn change_mode(&mut self, state: Option<&State<T>>, uav: Option<&Uav<T>>) {
        if (self.mode, self.request) != (Mode::Follow, Request::Follow)
            && self.take_edge(state, uav)
            && let Some(state) = state
        {
            self.join(state, uav);
        }
    }

    /// The same but for the one to the path: whether that is open.
    #[inline(never)]
    pub(super) fn take_edge(&mut self, state: Option<&State<T>>, uav: Option<&Uav<T>>) -> bool {
        let to = match (self.mode, self.request) {
            (Mode::Off, Request::Off | Request::Land) => Mode::Off,
            (Mode::Off, _) => Mode::Idle,
            (Mode::Idle, Request::Off | Request::Idle) => Mode::Idle,
            (Mode::Idle, Request::Land) => Mode::Off,
            (Mode::Idle, _) if uav.is_some() => Mode::TakeOff,
            (Mode::Idle, _) if state.is_some_and(|state| !self.may_lift(state)) => Mode::Idle,
            (Mode::Idle, _) => Mode::Hold,
            (Mode::Hold, Request::Land) if self.fault == Some(Fault::Caught) => Mode::Hold,
            (Mode::TakeOff | Mode::Join | Mode::Follow | Mode::Hold | Mode::Land, Request::Land) => Mode::Land,
            (Mode::TakeOff, Request::Follow | Request::Hold) if !self.has_risen(uav) => Mode::TakeOff,
            (Mode::Join, Request::Follow) if self.law.approach().is_active() => Mode::Join,
            (Mode::Join | Mode::Follow, Request::Follow) => Mode::Follow,
            (Mode::Hold, Request::Follow) if state.is_some() && self.may_follow() => Mode::Join,
            (Mode::Fault, _) if self.policy.lost == Lost::Cut => Mode::Fault,
            _ => Mode::Hold,
        };
        if to == self.mode {
            return false;
        }
        match (to, state, uav) {
            (Mode::Join, ..) => return true,
            (Mode::TakeOff | Mode::Hold | Mode::Land, _, Some(uav)) => self.change_to(to, uav),
            (Mode::TakeOff | Mode::Hold | Mode::Land, Some(state), None) => {
                self.change_to(to, &self.now(state, None));
            }
            _ => self.mode = to,
        }
        false
    }

    #[inline(never)]
    fn change_to(&mut self, mode: Mode, uav: &Uav<T>) {
        if self.mode == Mode::TakeOff {
            // What pulls now is the usual.
            self.cable.learn();
        }
        // A landing goes on from where hold has settled.
        let goes_on = (self.mode, mode) == (Mode::Hold, Mode::Land) && self.hold.has_settled(uav);
        if !goes_on {
            self.enter_hold(uav, None);
        }
        self.mode = mode;
        self.from = uav.position.z;
    }

    /// Without the UAV's own navigation nothing rises but what hangs by a rod that can be flown: a
    /// vehicle that stands beside its load is told why it stays there.
    #[cold]
    fn may_lift(&mut self, state: &State<T>) -> bool {
        let vehicle = self.sampler.vehicle();
        let margins = Margins::of_motion(vehicle, state, vehicle.hover_thrust());
        let standing = self.envelope.assess(&margins, T::one());
        if let Standing::Beyond(margin) = standing {
            self.fault = Some(Fault::Margin(margin));
        }
        !matches!(standing, Standing::Beyond(_))
    }

    /// Whether a take-off is over.
    #[cold]
    fn has_risen(&self, uav: Option<&Uav<T>>) -> bool {
        let enough = self.sampler.vehicle().params().rod_length + self.policy.clear;
        uav.is_some_and(|uav| self.from - uav.position.z > enough)
    }

    /// Joins the path, if the vehicle is where the law can fly it.
    #[cold]
    fn join(&mut self, state: &State<T>, uav: Option<&Uav<T>>) {
        let [acceleration, ..] = self.sampler.continued(state);
        if acceleration.abs() > T::lit(JOINING) || self.standing(state) != Standing::Inside {
            return;
        }
        match self.law.join(state, &self.pace) {
            Ok(()) => {
                self.sampler.join(state);
                self.mode = Mode::Join;
            }
            Err(Refused::Searching) => {}
            Err(_) => self.fall_back(state, uav, Fault::NoPath),
        }
    }

    /// How the vehicle stands in the envelope under what is being applied; the path's margins are
    /// the law's to say.
    #[inline(never)]
    pub(super) fn standing(&self, sampled: &State<T>) -> Standing {
        let margins = Margins::of_motion(self.sampler.vehicle(), sampled, self.sampler.applied().thrust);
        self.envelope.assess(&margins, T::one())
    }

    fn may_follow(&self) -> bool {
        self.fault != Some(Fault::PayloadLost)
            && !self.cable.is_slack()
            && self.calm >= self.policy.calm
            && (self.policy.resume || self.fault.is_none())
    }

    #[inline(never)]
    pub(super) fn enter_hold(&mut self, uav: &Uav<T>, fault: Option<Fault>) {
        self.hold = Hold::from(self.sampler.vehicle(), uav, &self.sampler.swing());
        self.cable.yield_to(self.sampler.most_along());
        self.sampler.leave();
        self.mode = Mode::Hold;
        self.calm = T::zero();
        self.payload.leave();
        self.landing = Landing::begin();
        self.footing = Footing::none();
        self.fault = fault.or(self.fault);
    }
}
