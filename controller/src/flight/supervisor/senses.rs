//! What is measured: what of it is believed, and what is flown on where a part is missing.

use model::dynamics::turn;
use model::{Channel, Command, Real, State, Uav};
use nalgebra::{Matrix3, Vector3};

use super::Supervisor;
use crate::flight::cable::Watching;
use crate::flight::mode::{Fault, Lost, Measured, Mode, Output};
use crate::flight::motion::{Off, Standing};
use crate::flight::turning::{angle, mend};
use crate::law::Law;
use crate::sampled::actuator::Actuation;

/// What is not to be believed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Doubt {
    /// The UAV: load and rod tell where it is.
    Uav,
    /// The load, or where it hangs.
    Load,
}

impl<T: Real, L: Law<T>, A: Actuation<T>> Supervisor<T, L, A> {
    /// Takes in the UAV, and carries on what of its position or velocity stands still though the other
    /// does not.
    #[inline]
    pub(super) fn see_uav(&mut self, uav: &Uav<T>, specific: Option<&Vector3<T>>) -> Option<Uav<T>> {
        self.motion.see_uav(uav);
        self.motion.standing().map(|standing| self.carry_on(uav, standing, specific))
    }

    #[cold]
    #[inline(never)]
    fn carry_on(&self, uav: &Uav<T>, standing: Standing, specific: Option<&Vector3<T>>) -> Uav<T> {
        match standing {
            Standing::Position => Uav { position: uav.position + self.motion.led(), ..*uav },
            Standing::Velocity => Uav { velocity: self.carried_velocity(&uav.attitude, specific), ..*uav },
        }
    }

    /// The UAV in flight with what is missing of its position and velocity: the one is where the other
    /// leads, and that is where the forces do.
    #[cold]
    #[inline(never)]
    pub(super) fn fill(&mut self, uav: &Uav<T>, specific: Option<&Vector3<T>>) -> Option<Uav<T>> {
        let is_flying = !matches!(self.mode, Mode::Off | Mode::Idle | Mode::Fault);
        if !(is_flying && self.motion.has_uav()) {
            return None;
        }
        let mut uav = *uav;
        let is_lost = uav.check() == Err(Channel::UavPosition);
        if is_lost {
            uav.position = Vector3::zeros();
        }
        if uav.check() == Err(Channel::UavVelocity) {
            uav.velocity = self.carried_velocity(&uav.attitude, specific);
        }
        uav.check().ok()?;
        if is_lost {
            uav.position = self.motion.carry(&uav.velocity);
        } else {
            self.motion.see_uav(&uav);
        }
        Some(uav)
    }

    /// The UAV's velocity by the forces on it, m/s.
    fn carried_velocity(&self, attitude: &Matrix3<T>, specific: Option<&Vector3<T>>) -> Vector3<T> {
        let thrust = self.sampler.applied().thrust;
        self.cable.carried(self.sampler.vehicle(), attitude, thrust, specific)
    }

    /// Where the UAV has come to since its navigation was lost, if a slack cable does not tell.
    #[cold]
    #[inline(never)]
    pub(super) fn lost_uav(&mut self, state: &State<T>, specific: Option<&Vector3<T>>) -> Option<Uav<T>> {
        let is_flying = !matches!(self.mode, Mode::Off | Mode::Idle | Mode::Fault);
        if !is_flying || self.is_hung() || self.landing.is_by_rod() {
            return None;
        }
        let State { attitude, body_rate, .. } = *state;
        let velocity = self.carried_velocity(&attitude, specific);
        let position = self.motion.carry(&velocity);
        Some(Uav { position, velocity, attitude, body_rate })
    }

    /// What of load and UAV is not to be believed in flight: a load where it can't hang from the UAV, or
    /// what does not move as its velocity says. Where both have jumped, what they are measured from
    /// has moved.
    #[inline]
    pub(super) fn doubt(&mut self, state: &State<T>, uav: Option<&Uav<T>>) -> Option<Doubt> {
        let uav = uav?;
        self.motion.see_load(state);
        let off = self.motion.off();
        if matches!(self.mode, Mode::Off | Mode::Idle) {
            None
        } else if off.uav && !off.load && !off.rod && self.is_hung() {
            Some(Doubt::Uav)
        } else {
            self.is_contradicted(&off, state, uav).then_some(Doubt::Load)
        }
    }

    /// The UAV by load and rod, where its own navigation is wrong; but for the velocity if it is the
    /// position that stands still, since that is true of a slack cable, too.
    #[cold]
    #[inline(never)]
    pub(super) fn of_load(&self, state: &State<T>, velocity: Option<Vector3<T>>) -> Uav<T> {
        let of_load = Uav::of(state, self.sampler.vehicle());
        match (self.motion.standing(), velocity) {
            (Some(Standing::Position), Some(velocity)) => Uav { velocity, ..of_load },
            _ => of_load,
        }
    }

    /// Whether the load is measured where it can't be.
    #[inline(never)]
    fn is_contradicted(&mut self, off: &Off, state: &State<T>, uav: &Uav<T>) -> bool {
        let line = state.position - uav.position;
        // A take-off does not fly by the load, which an estimate may only just have found.
        let is_alone_off = (off.load || off.rod) && !off.uav && self.mode != Mode::TakeOff;
        let is_off = is_alone_off || self.cable.is_contradicted(self.sampler.vehicle(), &line, &state.rod);
        if is_off {
            // Nor was the last state one to carry on.
            self.blind = self.blind.max(self.policy.coast);
        }
        is_off
    }

    /// Whether an attitude stands still while the body turns, or a rate while what it is of does.
    ///
    /// # Errors
    /// What is to be left out.
    #[inline]
    pub(super) fn check_turning(&mut self, state: &State<T>) -> Result<(), Channel> {
        let (now, last) = (state, self.sampler.state());
        // Tilted: a yaw alone does not fall.
        let tilts = || now.attitude.m32 != last.attitude.m32 || now.attitude.m31 != last.attitude.m31;
        let spins = || now.body_rate.x != last.body_rate.x || now.body_rate.y != last.body_rate.y;
        let swings = || now.rod.x != last.rod.x || now.rod.y != last.rod.y;
        // Something stands still though something else moves, or was left out last time.
        if self.blind > T::zero()
            || now.attitude.m32 == last.attitude.m32 && spins()
            || now.body_rate.x == last.body_rate.x && tilts()
            || now.rod_rate.x == last.rod_rate.x && swings()
        {
            self.watch_turning(state)
        } else {
            Ok(())
        }
    }

    #[cold]
    #[inline(never)]
    fn watch_turning(&mut self, now: &State<T>) -> Result<(), Channel> {
        let (last, period, [attitude, body, rod]) = (self.sampler.state(), self.sampler.period(), &mut self.stuck);
        let turned = angle(&last.attitude, &now.attitude);
        let channel = if attitude.watch_attitude(&now.attitude, &last.attitude, &now.body_rate, period) {
            Channel::Attitude
        } else if body.watch_rate(&now.body_rate, &last.body_rate, &turned, period) {
            Channel::BodyRate
        } else if rod.watch_rate(&now.rod_rate, &last.rod_rate, &(now.rod - last.rod), period) {
            Channel::RodRate
        } else {
            return Ok(());
        };
        // Nor was the last state one to carry on.
        self.blind = self.blind.max(self.policy.coast);
        Err(channel)
    }

    /// Whether load and UAV are a cable's length apart, in flight.
    fn is_hung(&self) -> bool {
        let is_flying = matches!(self.mode, Mode::Join | Mode::Follow | Mode::Hold | Mode::Land);
        is_flying && !self.cable.is_slack() && !self.landing.is_set_down()
    }

    /// Whether the model can say what has become of the last state: not for long, and only with a
    /// cable that pulls.
    fn may_carry(&self) -> bool {
        self.is_hung() && self.blind <= self.policy.coast
    }

    /// A step on what the model makes of the last state. Its `fault` is this step's alone: states
    /// may come at a lower rate than commands.
    #[cold]
    #[inline(never)]
    pub(super) fn carried(
        &mut self,
        fault: Fault,
        uav: Option<&Uav<T>>,
        specific: Option<Vector3<T>>,
    ) -> Option<Output<T>> {
        if !self.may_carry() {
            return None;
        }
        let state = self.sampler.carry();
        state.check().ok()?;
        let velocity = self.uav_velocity(&state, uav);
        let thrust = self.sampler.applied().thrust;
        self.cable.sample(self.sampler.vehicle(), &velocity, &state.attitude, thrust, specific);
        self.change_mode(Some(&state), uav);
        let output = self.fly(&state, uav);
        Some(Output { fault: output.fault.or(Some(fault)), ..output })
    }

    /// A step on a state of which a part is missing or wrong and found from the rest. It is good
    /// enough for hold.
    #[cold]
    #[inline(never)]
    pub(super) fn mended(
        &mut self,
        fault: Fault,
        measured: &Measured<'_, T>,
        uav: Option<&Uav<T>>,
    ) -> Option<Output<T>> {
        let mut state = *measured.state?;
        let mut uav = uav.copied();
        match fault {
            // From the other of the two, and the last step's.
            Fault::State(channel @ (Channel::Attitude | Channel::BodyRate)) => {
                if !self.mend(&mut state, channel) {
                    return None;
                }
                let State { attitude, body_rate, .. } = state;
                uav = measured.uav.map(|uav| Uav { attitude, body_rate, ..*uav }).filter(|uav| uav.check().is_ok());
                match self.doubt(&state, uav.as_ref()) {
                    None => {}
                    Some(Doubt::Uav) => uav = Some(self.of_load(&state, uav.map(|uav| uav.velocity))),
                    Some(Doubt::Load) => return None,
                }
            }
            Fault::Contradiction if self.is_hung() => {
                let length = self.sampler.vehicle().params().rod_length;
                state = self.motion.mended(&state, uav.as_ref()?, length).filter(|state| state.check().is_ok())?;
                self.fault = Some(fault);
            }
            _ => return None,
        }
        let uav = uav.as_ref();
        if matches!(self.mode, Mode::Join | Mode::Follow) {
            self.fall_back(&state, uav, fault);
        }
        self.blind = self.blind.min(self.policy.coast);
        self.calm = T::zero();
        let now = self.now(&state, uav);
        let thrust = self.sampler.applied().thrust;
        self.cable.sample(self.sampler.vehicle(), &now.velocity, &now.attitude, thrust, measured.specific_force);
        self.cable.watch(self.sampler.vehicle(), None, self.watching());
        self.take_edge(None, Some(&now));
        let known = self.sampler.freeze(&state);
        self.sampler.sample(&state);
        self.sampler.keep(known);
        let output = self.hold(Some(&state), &now, None);
        Some(Output { fault: output.fault.or(Some(fault)), ..output })
    }

    /// Gives a `state` in flight the attitude or body rate that is missing, and says whether it is
    /// whole then.
    #[inline(never)]
    fn mend(&mut self, state: &mut State<T>, missing: Channel) -> bool {
        let period = self.sampler.period();
        let is_flying = !matches!(self.mode, Mode::Off | Mode::Idle | Mode::Fault);
        // The last step was good, carried or mended itself.
        let is_known = self.blind <= self.policy.coast + period * T::lit(1.5);
        if !(is_flying && is_known) {
            return false;
        }
        mend(state, missing, &self.sampler.carry(), period);
        if missing == Channel::Attitude {
            // Of one that stands still this shows late.
            let [attitude, ..] = &mut self.stuck;
            (state.attitude, _) = turn(&state.attitude, &attitude.take_lag(), &Vector3::zeros(), T::one());
        }
        state.check().is_ok()
    }

    /// A step on a good state.
    #[inline]
    pub(super) fn with_load(
        &mut self,
        state: &State<T>,
        uav: Option<&Uav<T>>,
        specific: Option<Vector3<T>>,
    ) -> Output<T> {
        let velocity = self.uav_velocity(state, uav);
        if self.blind > T::zero() {
            if !self.may_carry() {
                self.sampler.resume(state);
                self.cable.resume(&velocity);
            }
            self.blind = T::zero();
        }
        let thrust = self.sampler.applied().thrust;
        self.cable.sample(self.sampler.vehicle(), &velocity, &state.attitude, thrust, specific);
        if let Some(uav) = uav {
            let line = state.position - uav.position;
            self.cable.watch(self.sampler.vehicle(), Some(line), self.watching());
        }
        self.change_mode(Some(state), uav);
        match self.mode {
            // In fault with a good state: the rotors were cut.
            Mode::Off | Mode::Fault => self.ground(Some(state), T::zero()),
            Mode::Idle => self.ground(Some(state), self.sampler.actuation().least_thrust()),
            _ => self.fly(state, uav),
        }
    }

    /// The UAV's velocity, m/s, by its own navigation, or from `state` with a taut cable.
    #[inline]
    fn uav_velocity(&self, state: &State<T>, uav: Option<&Uav<T>>) -> Vector3<T> {
        let length = self.sampler.vehicle().params().rod_length;
        uav.map_or_else(|| state.velocity - state.rod_rate * length, |uav| uav.velocity)
    }

    /// A step on the UAV alone.
    #[cold]
    pub(super) fn without_load(&mut self, uav: &Uav<T>, specific: Option<Vector3<T>>) -> Output<T> {
        let thrust = self.sampler.applied().thrust;
        self.cable.sample(self.sampler.vehicle(), &uav.velocity, &uav.attitude, thrust, specific);
        self.cable.watch(self.sampler.vehicle(), None, self.watching());
        if matches!(self.mode, Mode::Join | Mode::Follow) {
            self.enter_hold(uav, None);
        }
        self.change_mode(None, Some(uav));
        match self.mode {
            Mode::Off | Mode::Fault => self.ground(None, T::zero()),
            Mode::Idle => self.ground(None, self.sampler.actuation().least_thrust()),
            mode => {
                // On the ground, and near it, something else turns it.
                if mode == Mode::Hold {
                    self.sampler.sample_body(&uav.body_rate);
                }
                self.hold(None, uav, None)
            }
        }
    }

    /// How the cable is looked at in the mode that there is.
    pub(super) fn watching(&self) -> Watching {
        match self.mode {
            Mode::Off | Mode::Idle | Mode::TakeOff => Watching::Not,
            Mode::Land => Watching::Against,
            _ => Watching::Learning,
        }
    }

    /// A step without a good state.
    #[cold]
    pub(super) fn without_state(&mut self) -> Output<T> {
        let command = match self.mode {
            Mode::Off => Command::zero(),
            Mode::Idle => Command::of_thrust(self.sampler.actuation().least_thrust()),
            Mode::TakeOff | Mode::Join | Mode::Follow | Mode::Hold | Mode::Land
                if self.blind <= self.policy.coast =>
            {
                self.sampler.coast()
            }
            _ => {
                self.mode = Mode::Fault;
                match self.policy.lost {
                    Lost::Cut => Command::zero(),
                    Lost::Sink(share) => {
                        let hover = self.sampler.vehicle().hover_thrust();
                        self.sampler.send(&Command::of_thrust(hover * share))
                    }
                }
            }
        };
        self.output(command, None)
    }
}
