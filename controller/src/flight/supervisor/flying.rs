//! A step in flight: by the law, or by hold.

use model::{Real, State, Uav, is_within};
use nalgebra::Vector3;

use super::Supervisor;
use crate::flight::cable::SHORTENED;
use crate::flight::envelope::Standing;
use crate::flight::footing::Carried;
use crate::flight::landing::Aim;
use crate::flight::mode::{Fault, Mode, Output, Policy, Request};
use crate::law::Law;
use crate::sampled::actuator::Actuation;

/// So far above its target, m, a landing UAV may stand already, and does not go aside.
const CARRIED: f64 = 0.3;
/// Time, s, over which hold takes up the torque that is observed.
const TRIMMED: f64 = 1.0;
/// Calm enough to join the path: speed, m/s, swing, 1/s, and cosine of the tilt (18°).
const CALM_SPEED: f64 = 1.0;
const CALM_SWING: f64 = 0.3;
const CALM_TILT: f64 = 0.95;

impl<T: Real, L: Law<T>, A: Actuation<T>> Supervisor<T, L, A> {
    /// By the law, or by hold.
    #[inline(always)]
    pub(super) fn fly(&mut self, state: &State<T>, uav: Option<&Uav<T>>) -> Output<T> {
        let is_slack = self.cable.is_slack() || self.landing.is_set_down() || self.mode == Mode::TakeOff;
        let known = is_slack.then(|| self.sampler.freeze(state));
        self.sampler.sample(state);
        if let Some(known) = known {
            self.sampler.keep(known);
            return self.fly_slack(state, uav);
        }
        if matches!(self.mode, Mode::Join | Mode::Follow)
            && let Some(output) = self.follow(state, uav)
        {
            return output;
        }
        self.hold_at(state, uav)
    }

    /// To hold, from the law.
    #[cold]
    #[inline(never)]
    pub(super) fn fall_back(&mut self, state: &State<T>, uav: Option<&Uav<T>>, fault: Fault) {
        self.enter_hold(&self.now(state, uav), Some(fault));
    }

    /// With a cable that does not pull no law flies, and the observers keep what they know.
    #[cold]
    fn fly_slack(&mut self, state: &State<T>, uav: Option<&Uav<T>>) -> Output<T> {
        if matches!(self.mode, Mode::Join | Mode::Follow) {
            self.fall_back(state, uav, Fault::Slack);
        }
        self.cable.hasten();
        self.hold_at(state, uav)
    }

    #[inline(never)]
    fn hold_at(&mut self, state: &State<T>, uav: Option<&Uav<T>>) -> Output<T> {
        let now = self.now(state, uav);
        let aim = if uav.is_none() { self.around(state) } else { None };
        self.hold(Some(state), &now, aim.as_ref())
    }

    /// Where the rod is all that tells of the UAV: what to fly once a landing has set down the
    /// load.
    #[inline(never)]
    fn around(&mut self, state: &State<T>) -> Option<Aim<T>> {
        let vehicle = self.sampler.vehicle();
        self.cable.average(vehicle, self.watching());
        if self.mode != Mode::Land {
            return None;
        }
        let known = (self.sampler.applied().thrust, self.cable.down(vehicle), &self.cable.pull(vehicle));
        self.landing.around(vehicle, state, known, self.policy.descent, self.sampler.period())
    }

    /// The law's command for when it acts, if its answer can be flown; to hold, if not.
    // Apart, and so is hold: neither needs the other's stack.
    #[inline(never)]
    fn follow(&mut self, state: &State<T>, uav: Option<&Uav<T>>) -> Option<Output<T>> {
        self.sampler.ask(&mut self.law);
        let answer = self.law.answer();
        let standing = self.envelope.assess(&answer.margins, self.law.approach().path_det());
        let fault = if let Standing::Beyond(margin) = standing {
            Some(Fault::Margin(margin))
        } else if !answer.is_finite() {
            Some(Fault::NotFinite)
        } else if self.payload.is_lost(self.sampler.weight(), self.cable.usual(), self.sampler.period()) {
            Some(Fault::PayloadLost)
        } else {
            None
        };
        if let Some(fault) = fault {
            self.fall_back(state, uav, fault);
            return None;
        }
        let command = self.sampler.accept(&mut self.law);
        self.is_by_law = true;
        let warning = if let Standing::Warning(margin) = standing { Some(margin) } else { None };
        Some(self.output(command, warning))
    }

    /// Hold's command for when it acts, from the UAV and what is known of the rod now; it goes for
    /// `aim` where there is one.
    #[inline(never)]
    pub(super) fn hold(&mut self, state: Option<&State<T>>, now: &Uav<T>, aim: Option<&Aim<T>>) -> Output<T> {
        let period = self.sampler.period();
        let mut uav = aim.map_or(*now, |aim| aim.uav);
        let (pull, swing, velocity) = if let Some(&Aim { target, velocity, pull, .. }) = aim {
            self.hold.aim(target, velocity);
            (pull, None, velocity)
        } else {
            let velocity = self.wanted_velocity(state, now);
            let is_taut = state.is_some_and(|state| self.hangs(&(state.position - now.position)));
            if is_taut && self.sampler.has_bounced() {
                self.cable.yield_to(self.sampler.most_along());
            }
            let swing = is_taut.then(|| self.sampler.swing());
            (self.cable.pull(self.sampler.vehicle()), swing, velocity)
        };
        let vehicle = self.sampler.vehicle();
        self.sampler.look_ahead(&mut uav, &pull);
        let mut wanted = self.hold.step(vehicle, &uav, &pull, swing.as_ref(), &velocity, period);
        self.trim -= (self.trim + self.sampler.torque()) * (period / T::lit(TRIMMED)).min(T::one());
        wanted.torque += self.trim;
        if self.mode == Mode::Land {
            let may_hang = state.is_none_or(|state| self.may_hang(&(state.position - now.position)));
            match self.footing.feel(self.hold.left_above(now), now.body_rate.z, may_hang, period) {
                Carried::Flying => self.hold.turn(self.footing.turn()),
                Carried::Standing => {
                    self.mode = Mode::Off;
                    self.request = Request::Off;
                    return self.ground(state, T::zero());
                }
                Carried::Hanging => self.enter_hold(now, Some(Fault::Caught)),
            }
        }
        let is_calm = state.is_some_and(|state| {
            is_within(&state.velocity, T::lit(CALM_SPEED * CALM_SPEED))
                && is_within(&state.rod_rate, T::lit(CALM_SWING * CALM_SWING))
                && state.attitude.m33 > T::lit(CALM_TILT)
        });
        self.calm = if is_calm { self.calm + period } else { T::zero() };
        if self.fault == Some(Fault::PayloadLost) {
            self.look_for_load();
        }
        if self.request == Request::Follow && self.calm >= self.policy.calm && self.cable.is_slack() {
            // Nothing else keeps it from the path.
            self.fault = self.fault.or(Some(Fault::Slack));
        }
        let warning = match state.map(|state| self.standing(state)) {
            None | Some(Standing::Inside) => None,
            Some(Standing::Warning(margin) | Standing::Beyond(margin)) => Some(margin),
        };
        let command = self.sampler.commit(&wanted, T::zero(), T::zero());
        self.output(command, warning)
    }

    /// What pulls as it did was unloaded, not lost: the path may be joined again.
    #[cold]
    fn look_for_load(&mut self) {
        let [_, now] = self.cable.down(self.sampler.vehicle());
        if self.payload.is_back(now, self.sampler.period()) {
            self.fault = Some(Fault::Slack);
        }
    }

    /// Whether the load hangs from a taut cable, by the `line` to it, m.
    fn hangs(&self, line: &Vector3<T>) -> bool {
        !self.cable.is_slack() && self.is_stretched(line)
    }

    /// Whether the UAV may hang from its load, by the `line` to it, m.
    fn may_hang(&self, line: &Vector3<T>) -> bool {
        line.z < T::zero() && self.is_stretched(line)
    }

    /// Whether the cable may pull, by the `line` to the load, m.
    fn is_stretched(&self, line: &Vector3<T>) -> bool {
        let near = self.sampler.vehicle().params().rod_length * T::lit(SHORTENED);
        !is_within(line, near * near)
    }

    /// The velocity that hold goes for: none, or that of a take-off or landing.
    #[inline(never)]
    fn wanted_velocity(&mut self, state: Option<&State<T>>, now: &Uav<T>) -> Vector3<T> {
        match self.mode {
            Mode::Land => {
                let (is_slack, period) = (self.cable.is_slack(), self.sampler.period());
                let is_carried = self.hold.left_above(now) > T::lit(CARRIED);
                let load = state.map(|state| state.position);
                let room = self.sampler.vehicle().params().rod_length;
                let Policy { descent, aside, .. } = self.policy;
                self.landing.velocity(load, now, (is_slack, is_carried), (descent, aside, room), period)
            }
            Mode::TakeOff => Vector3::new(T::zero(), T::zero(), -self.policy.rise),
            _ => Vector3::zeros(),
        }
    }
}
