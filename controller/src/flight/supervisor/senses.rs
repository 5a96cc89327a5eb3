//! What is measured: what of it is believed, and what is flown on where a part is missing.

use model::{Channel, Command, Real, State, Uav};
use nalgebra::Vector3;

use super::Supervisor;
use crate::flight::cable::Watching;
use crate::flight::mode::{Fault, Lost, Measured, Mode, Output};
use crate::flight::turning::{LED, angle, mend};
use crate::law::Law;
use crate::sampled::actuator::Actuation;

impl<T: Real, L: Law<T>, A: Actuation<T>> Supervisor<T, L, A> {
    /// The UAV's own navigation, unless the load's is to be believed rather. Where both have jumped
    /// what they are measured from has moved.
    ///
    /// # Errors
    /// The load is measured in flight where it can't hang from the UAV, or does not move as its
    /// velocity says.
    #[inline]
    pub(super) fn believe<'a>(
        &mut self,
        state: &State<T>,
        uav: Option<&'a Uav<T>>,
    ) -> Result<Option<&'a Uav<T>>, Fault> {
        let Some(uav) = uav else { return Ok(None) };
        let [load_is_off, uav_is_off] = self.is_off(state, uav);
        if load_is_off { Err(Fault::Contradiction) } else { Ok(Some(uav).filter(|_| !uav_is_off)) }
    }

    /// Whether load and UAV are measured where they can't be.
    #[inline(never)]
    fn is_off(&mut self, state: &State<T>, uav: &Uav<T>) -> [bool; 2] {
        if matches!(self.mode, Mode::Off | Mode::Idle) {
            return [false; 2];
        }
        let [load_is_off, uav_is_off] = self.motion.is_off(state, uav);
        if uav_is_off && !load_is_off && self.is_hung() {
            return [false, true];
        }
        let line = state.position - uav.position;
        // A take-off does not fly by the load, which an estimate may only just have found.
        let is_alone_off = load_is_off && !uav_is_off && self.mode != Mode::TakeOff;
        let is_off = is_alone_off || self.cable.is_contradicted(self.sampler.vehicle(), &line, &state.rod);
        if is_off {
            // Nor was the last state one to carry on.
            self.blind = self.blind.max(self.policy.coast);
        }
        [is_off, false]
    }

    /// Whether a rate stands still while what it is of turns.
    ///
    /// # Errors
    /// The rate that is to be left out.
    #[inline]
    pub(super) fn check_rates(&mut self, state: &State<T>) -> Result<(), Channel> {
        let (last, [body, rod]) = (self.sampler.state(), &self.stuck);
        // Tilted: a yaw alone does not fall.
        let has_turned = || state.attitude.m32 != last.attitude.m32 || state.attitude.m31 != last.attitude.m31;
        let has_swung = || state.rod.x != last.rod.x || state.rod.y != last.rod.y;
        if body.is_due(&state.body_rate, &last.body_rate, has_turned)
            || rod.is_due(&state.rod_rate, &last.rod_rate, has_swung)
        {
            self.watch_rates(state)
        } else {
            Ok(())
        }
    }

    #[cold]
    #[inline(never)]
    fn watch_rates(&mut self, state: &State<T>) -> Result<(), Channel> {
        let (last, period, [body, rod]) = (self.sampler.state(), self.sampler.period(), &mut self.stuck);
        let turned = angle(&last.attitude, &state.attitude);
        let channel = if body.watch(&state.body_rate, &last.body_rate, &turned, period) {
            Channel::BodyRate
        } else if rod.watch(&state.rod_rate, &last.rod_rate, &(state.rod - last.rod), period) {
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
        let state = self.may_carry().then(|| self.sampler.carry()).filter(|state| state.check().is_ok())?;
        let velocity = self.now(&state, uav).velocity;
        let thrust = self.sampler.applied().thrust;
        self.cable.sample(self.sampler.vehicle(), &velocity, &state.attitude, thrust, specific);
        self.change_mode(Some(&state), uav);
        let output = self.fly(&state, uav);
        Some(Output { fault: output.fault.or(Some(fault)), ..output })
    }

    /// A step on a state of which attitude or body rate is missing for longer, from the other of
    /// them and the last step's. It is good enough for hold.
    #[cold]
    #[inline(never)]
    pub(super) fn mended(&mut self, fault: Fault, measured: &Measured<'_, T>) -> Option<Output<T>> {
        let Fault::State(channel @ (Channel::Attitude | Channel::BodyRate)) = fault else { return None };
        let mut state = *measured.state?;
        if !self.mend(&mut state, channel) {
            return None;
        }
        let uav = measured.uav.map(|uav| Uav { attitude: state.attitude, body_rate: state.body_rate, ..*uav });
        let uav = self.believe(&state, uav.as_ref().filter(|uav| uav.check().is_ok())).ok()?;
        if matches!(self.mode, Mode::Join | Mode::Follow) {
            self.enter_hold(&self.now(&state, uav), Some(fault));
        }
        self.blind = self.blind.min(self.policy.coast);
        self.calm = T::zero();
        let now = self.now(&state, uav);
        let thrust = self.sampler.applied().thrust;
        self.cable.sample(self.sampler.vehicle(), &now.velocity, &now.attitude, thrust, measured.specific_force);
        self.change_mode(Some(&state), uav);
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
        if missing == Channel::Attitude {
            self.led += period;
        }
        let is_flying = !matches!(self.mode, Mode::Off | Mode::Idle | Mode::Fault);
        // The last step was good, carried or mended itself.
        let is_known = self.blind <= self.policy.coast + period * T::lit(1.5);
        if !(is_flying && is_known && self.led <= T::lit(LED)) {
            return false;
        }
        mend(state, missing, &self.sampler.carry(), period);
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
        let length = self.sampler.vehicle().params().rod_length;
        let velocity = match uav {
            Some(uav) => uav.velocity,
            None => state.velocity - state.rod_rate * length,
        };
        if self.blind > T::zero() {
            if !self.may_carry() {
                self.sampler.resume(state);
                self.cable.resume(&velocity);
            }
            (self.blind, self.led) = (T::zero(), T::zero());
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
