//! Actuators that apply what is logged, whatever the law asks for: what its memory goes on from
//! (observers, latency, lag, ζ) is then what was flown.

use controller::{Actuation, Command, OutOfRange};
use rig::Actuators;
use std::cell::Cell;

/// Up to this share of the thrust (of torque: about a metre from the centre) a command counts as
/// the one that was flown: what rounding and the lines between a log's rows make of it is no limit
/// that the law was held to.
const SAME: f32 = 1e-3;

/// The scenario's own actuators with a log in front of them.
#[derive(Clone, Debug)]
pub struct Flown {
    actuators: Actuators<f32>,
    logged: Cell<Option<Command<f32>>>,
    asked: Cell<Option<Command<f32>>>,
}

impl Flown {
    /// With nothing logged: what is asked for is applied.
    pub fn new(actuators: Actuators<f32>) -> Self {
        Self { actuators, logged: Cell::new(None), asked: Cell::new(None) }
    }

    /// From now on `logged` is what is applied, up to a torque that is no number.
    pub fn set(&self, logged: Option<&Command<f64>>) {
        self.logged.set(logged.map(Command::cast));
        self.asked.set(None);
    }

    /// What was asked for since, within what the actuators give.
    pub fn asked(&self) -> Option<Command<f64>> {
        self.asked.get().map(|command| command.cast())
    }
}

impl Actuation<f32> for Flown {
    fn check(&self) -> Result<(), OutOfRange<f32>> {
        self.actuators.check()
    }

    fn apply(&self, command: &Command<f32>) -> Command<f32> {
        let asked = self.actuators.apply(command);
        self.asked.set(Some(asked));
        let Some(Command { thrust, torque }) = self.logged.get().filter(|logged| logged.thrust.is_finite()) else {
            return asked;
        };
        let has_torque = torque.iter().all(|axis| axis.is_finite());
        let logged = Command { thrust, torque: if has_torque { torque } else { asked.torque } };
        let apart = logged.torque - asked.torque;
        let most = SAME * asked.thrust.abs().max(logged.thrust.abs());
        let is_same = (logged.thrust - asked.thrust).abs() <= most && apart.dot(&apart).sqrt() <= most;
        if is_same { asked } else { logged }
    }

    fn least_thrust(&self) -> f32 {
        self.actuators.least_thrust()
    }

    fn largest_thrust(&self) -> f32 {
        self.actuators.largest_thrust()
    }
}
