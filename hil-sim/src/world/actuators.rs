//! What becomes of a command on its way to the vehicle: link latency, saturation, rotor lag, wrong
//! thrust scale.
//!
//! A command acts `latency_s` after it is given, any fraction of a control period included, and
//! then through the rotors' first-order lag, u̇ = (u_commanded − u)/τ, solved exactly. Saturation
//! stands before the lag (rotors cannot be told more), the scale after it (air density, battery,
//! worn propellers): thrust = s · u. With a [rate loop](RateLoop) what is given is thrust and body
//! rate, and the torque is the loop's.

use controller::{Command, Vector3};
use serde::Deserialize;
use std::collections::VecDeque;

use super::body::Body;
use super::check;
use super::rate_loop::RateLoop;
use super::rotors::Rotors;
use super::sensors::Window;
use crate::describe::input::{Invalid, join, within};

/// The actuators of a flight.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Actuators {
    /// τ of thrust and torque, s, 0 (none) to 0.5.
    pub lag_s: f64,
    /// From sample to act, s, 0 to 0.5.
    pub latency_s: f64,
    /// What the vehicle gets of the thrust commanded, 0.1 to 2.
    pub thrust_scale: f64,
    /// Least and largest thrust that the rotors can be told, N; none if left out.
    pub thrust_range: Option<[f64; 2]>,
    /// Largest torque about each body axis, N·m; none if left out.
    pub max_torque: Option<[f64; 3]>,
    /// The rotors, each with its limits; ideal ones if left out.
    pub rotors: Option<Rotors>,
    /// The autopilot's own rate loop, which the law then gives its setpoints; none if left out.
    pub rate_loop: Option<RateLoop>,
    /// A time in which there is less thrust to be had: a sagging battery. The law is not told.
    pub sag: Option<Sag>,
}

/// Less thrust for a while.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Sag {
    /// Largest thrust that can be had, N, 0 to 100000.
    pub max_thrust: f64,
    /// When.
    pub during: Window,
}

impl Default for Actuators {
    /// Ideal.
    fn default() -> Self {
        Self {
            lag_s: 0.0,
            latency_s: 0.0,
            thrust_scale: 1.0,
            thrust_range: None,
            max_torque: None,
            rotors: None,
            rate_loop: None,
            sag: None,
        }
    }
}

impl Actuators {
    /// Checks every range; `at` is the table's name.
    ///
    /// # Errors
    /// [`Invalid`] names the field.
    pub fn check(&self, at: &str) -> Result<(), Invalid> {
        check(at, "lag_s", self.lag_s, 0.0, 0.5)?;
        check(at, "latency_s", self.latency_s, 0.0, 0.5)?;
        check(at, "thrust_scale", self.thrust_scale, 0.1, 2.0)?;
        if let Some([low, high]) = self.thrust_range {
            check(at, "thrust_range[0]", low, 0.0, 1e5)?;
            check(at, "thrust_range[1]", high, low, 1e5)?;
        }
        if let Some(torque) = self.max_torque {
            for (axis, limit) in torque.into_iter().enumerate() {
                within(&join(at, &format!("max_torque[{axis}]")), limit, 0.0..=1e5)?;
            }
        }
        if let Some(sag) = &self.sag {
            let at = join(at, "sag");
            check(&at, "max_thrust", sag.max_thrust, 0.0, 1e5)?;
            sag.during.check(&join(&at, "during"))?;
        }
        self.rate_loop.map_or(Ok(()), |rate_loop| rate_loop.check(&join(at, "rate_loop")))?;
        self.rotors.map_or(Ok(()), |rotors| rotors.check(&join(at, "rotors")))
    }

    /// The most thrust that the vehicle gets for good where no more than `told` is commanded, N.
    #[must_use]
    pub fn most_thrust(&self, told: f64) -> f64 {
        let range = self.thrust_range.map_or(f64::INFINITY, |[_, high]| high);
        let rotors = self.rotors.map_or(f64::INFINITY, |rotors| 4.0 * rotors.max_thrust);
        self.thrust_scale * told.min(range).min(rotors)
    }

    /// What rotors told `command` at `t_s` are able to take of it.
    fn saturate(&self, t_s: f64, command: &Command<f64>) -> Command<f64> {
        let most = self.sag.filter(|sag| sag.during.contains(t_s)).map_or(f64::INFINITY, |sag| sag.max_thrust);
        let thrust =
            self.thrust_range.map_or(command.thrust, |[low, high]| command.thrust.clamp(low, high)).min(most);
        let torque = self.max_torque.map_or(command.torque, |limit| {
            let limit = Vector3::from(limit);
            command.torque.zip_map(&limit, |torque, limit| torque.clamp(-limit, limit))
        });
        let command = Command { thrust, torque };
        self.rotors.map_or(command, |rotors| rotors.limit(&command))
    }
}

/// What the vehicle is told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// Its rotors.
    Wrench(Command<f64>),
    /// Its rate loop.
    Rates {
        /// N.
        thrust: f64,
        /// In body axes, rad/s.
        body_rate: Vector3<f64>,
    },
}

/// Orders under way, the rate loop, and the rotors.
#[derive(Clone, Debug)]
pub struct ActuatorModel {
    actuators: Actuators,
    /// What is yet to come, with the time at which it acts, s.
    line: VecDeque<(f64, Order)>,
    /// What acts now.
    order: Order,
    /// When the rate loop runs next, s.
    loop_at_s: f64,
    /// What the rotors are told now, and what they give.
    target: Command<f64>,
    given: Command<f64>,
    decay: Decay,
}

/// Times closer than this are the same, s: far below any period, far above the rounding of a day's
/// seconds.
const INSTANT: f64 = 1e-9;

impl ActuatorModel {
    /// `actuators` that have given `command` for long.
    #[must_use]
    pub fn new(actuators: Actuators, command: Command<f64>) -> Self {
        let target = actuators.saturate(0.0, &command);
        let order = match actuators.rate_loop {
            Some(_) => Order::Rates { thrust: command.thrust, body_rate: Vector3::zeros() },
            None => Order::Wrench(command),
        };
        let decay = Decay { lag_s: actuators.lag_s, step_s: 0.0, over_half: 1.0, over_step: 1.0 };
        Self { actuators, line: VecDeque::new(), order, loop_at_s: 0.0, target, given: target, decay }
    }

    /// Takes an order at `t_s`.
    #[inline]
    pub fn push(&mut self, t_s: f64, order: Order) {
        self.line.push_back((t_s + self.actuators.latency_s, order));
    }

    /// From `t_s`, when the vehicle moves as `body`, to when the rotors are next told otherwise, or
    /// to `end_s`: the length of that piece.
    pub fn piece(&mut self, t_s: f64, end_s: f64, body: &Body) -> f64 {
        let mut next_s = end_s;
        while let Some((at_s, order)) = self.line.front() {
            if *at_s > t_s + INSTANT {
                next_s = *at_s;
                break;
            }
            self.order = *order;
            if let Order::Wrench(command) = order {
                self.target = self.actuators.saturate(*at_s, command);
            }
            self.line.pop_front();
        }
        if let (Some(rate_loop), Order::Rates { thrust, body_rate }) = (self.actuators.rate_loop, self.order) {
            if self.loop_at_s <= t_s + INSTANT {
                let torque = rate_loop.torque(&body.vehicle().inertia, &body.bodies().body_rate, &body_rate);
                self.target = self.actuators.saturate(t_s, &Command { thrust, torque });
                self.loop_at_s = t_s + 1.0 / rate_loop.rate_hz;
            }
            next_s = next_s.min(self.loop_at_s);
        }
        if next_s < end_s - INSTANT { next_s - t_s } else { end_s - t_s }
    }

    /// Before steps of this length, s, at whose ends and middles [`at`](Self::at) is mostly asked.
    #[inline]
    pub fn prepare(&mut self, step_s: f64) {
        self.decay.prepare(step_s);
    }

    /// What acts on the vehicle `dt` s after the piece's start at `t_s`.
    #[inline]
    #[must_use]
    pub fn at(&self, t_s: f64, dt: f64) -> Command<f64> {
        let mut command = self.lagging(dt);
        if let Some(rotors) = &self.actuators.rotors {
            command = rotors.fail(t_s + dt, &command);
        }
        command.thrust *= self.actuators.thrust_scale;
        command
    }

    /// What the rotors give by their speeds, at the coefficients they are told to have.
    #[must_use]
    pub fn given(&self) -> &Command<f64> {
        &self.given
    }

    /// Ends a piece of `dt` s.
    #[inline]
    pub fn pass(&mut self, dt: f64) {
        self.given = self.lagging(dt);
    }

    #[inline]
    fn lagging(&self, dt: f64) -> Command<f64> {
        if self.actuators.lag_s == 0.0 {
            return self.target;
        }
        if dt == 0.0 {
            return self.given;
        }
        let kept = self.decay.over(dt);
        Command {
            thrust: self.target.thrust + (self.given.thrust - self.target.thrust) * kept,
            torque: self.target.torque + (self.given.torque - self.target.torque) * kept,
        }
    }
}

/// What a lag leaves of a distance after a time, at hand for a step and for half of one: most steps
/// of a flight are alike.
#[derive(Clone, Debug)]
struct Decay {
    lag_s: f64,
    step_s: f64,
    over_half: f64,
    over_step: f64,
}

impl Decay {
    #[inline]
    fn prepare(&mut self, step_s: f64) {
        if step_s != self.step_s && self.lag_s > 0.0 {
            let [over_half, over_step] = [0.5 * step_s, step_s].map(|dt| decay(dt / self.lag_s));
            *self = Self { step_s, over_half, over_step, ..*self };
        }
    }

    #[inline]
    fn over(&self, dt: f64) -> f64 {
        if dt == self.step_s {
            self.over_step
        } else if dt == 0.5 * self.step_s {
            self.over_half
        } else {
            decay(dt / self.lag_s)
        }
    }
}

/// e^(−x), x ≥ 0. Over a short step of a lag by its series, whose next term is below rounding: x⁹/9!
/// < 4e-17.
#[inline]
fn decay(x: f64) -> f64 {
    /// 1/k! from the last term down.
    const PER_FACTORIAL: [f64; 9] =
        [1.0 / 40320.0, 1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0];
    if x > 0.0625 {
        return libm::exp(-x);
    }
    PER_FACTORIAL.into_iter().fold(0.0, |sum, term| term - x * sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use controller::State;
    use witness::plant::VehicleParameters;

    fn hovering() -> Body {
        Body::new(VehicleParameters::default(), None, None, &State::at_rest(Vector3::zeros()))
    }

    fn thrust(thrust: f64) -> Command<f64> {
        Command { thrust, torque: Vector3::zeros() }
    }

    #[test]
    fn a_decay_is_the_exponential() {
        for i in 0..=2000 {
            let x = f64::from(i) * 1e-4;
            let exact = libm::exp(-x);
            // An ulp of either.
            assert!((decay(x) - exact).abs() <= 2.0 * f64::EPSILON, "{x}: {} {exact}", decay(x));
        }
    }

    #[test]
    fn a_command_acts_after_the_latency_and_approaches_with_the_lag() {
        let actuators = Actuators { lag_s: 0.05, latency_s: 0.005, thrust_scale: 0.5, ..Actuators::default() };
        let mut model = ActuatorModel::new(actuators, thrust(10.0));
        model.push(0.0, Order::Wrench(thrust(20.0)));
        let body = hovering();
        // Two periods of 2 ms before it acts, then in the midst of the third.
        for (start, pieces) in [(0.0, &[0.002][..]), (0.002, &[0.002]), (0.004, &[0.001, 0.001])] {
            let mut t = start;
            for wanted in pieces {
                let piece = model.piece(t, start + 0.002, &body);
                assert!((piece - wanted).abs() < 1e-12, "{piece} {wanted}");
                model.pass(piece);
                t += piece;
            }
        }
        let expected = 0.5 * (20.0 - 10.0 * (-0.001_f64 / 0.05).exp());
        assert!((model.at(0.0, 0.0).thrust - expected).abs() < 1e-12);
        assert!((model.at(0.0, 10.0).thrust - 10.0).abs() < 1e-12, "half of what is commanded in the end");
    }

    #[test]
    fn a_sag_takes_thrust_in_its_window() {
        let sag = Some(Sag { max_thrust: 20.0, during: Window { at_s: 1.0, for_s: 2.0 } });
        let mut model = ActuatorModel::new(Actuators { sag, ..Actuators::default() }, thrust(30.0));
        for (t_s, wanted) in [(0.9, 30.0), (1.0, 20.0), (2.9, 20.0), (3.0, 30.0)] {
            model.push(t_s, Order::Wrench(thrust(30.0)));
            model.piece(t_s, t_s + 0.002, &hovering());
            assert_eq!(model.at(t_s, 0.0).thrust, wanted, "{t_s}");
        }
    }

    #[test]
    fn saturation_stands_before_the_lag() {
        let actuators =
            Actuators { thrust_range: Some([3.0, 60.0]), max_torque: Some([1.0, 2.0, 3.0]), ..Actuators::default() };
        let mut model = ActuatorModel::new(actuators, thrust(30.0));
        model.push(0.0, Order::Wrench(Command { thrust: 100.0, torque: Vector3::new(-5.0, 5.0, 0.5) }));
        model.piece(0.0, 0.002, &hovering());
        assert_eq!(model.at(0.0, 0.0), Command { thrust: 60.0, torque: Vector3::new(-1.0, 2.0, 0.5) });
    }

    #[test]
    fn a_rate_loop_runs_by_its_own_clock() {
        let rate_loop = Some(RateLoop { rate_hz: 500.0, time_constant_s: [0.03, 0.03, 0.1] });
        let mut model = ActuatorModel::new(Actuators { rate_loop, ..Actuators::default() }, thrust(30.0));
        let body_rate = Vector3::new(0.3, 0.0, -0.5);
        model.push(0.0, Order::Rates { thrust: 31.0, body_rate });
        let (mut t_s, body) = (0.0, hovering());
        for _ in 0..5 {
            let piece = model.piece(t_s, 0.01, &body);
            assert!((piece - 0.002).abs() < 1e-12, "{piece}");
            t_s += piece;
        }
        let [j1, _, j3] = body.vehicle().inertia;
        let Command { thrust, torque } = model.at(0.0, 0.0);
        assert_eq!(thrust, 31.0);
        assert!((torque - Vector3::new(j1 * 0.3 / 0.03, 0.0, -j3 * 0.5 / 0.1)).amax() < 1e-12, "{torque}");
    }
}
