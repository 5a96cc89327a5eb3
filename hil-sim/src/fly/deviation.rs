//! How far two runs of the same law in different scalars lie apart.
//!
//! Of each quantity the largest ‖Δ‖ over the flight is divided by the largest ‖·‖ of the f64
//! twin, or by a natural size where that is larger: on the steady motion ξ and ζ are zero, and
//! rounding relative to zero says nothing. Time is counted in units of the pendulum's √(L/g): so
//! counted, an output and its derivatives have the same unit and fit into one norm.

use serde::Serialize;

use crate::describe::scenario::{ControllerSpec, Law};
use crate::fly::pilot::Decision;

/// Largest relative deviations over a flight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Deviation {
    /// Of T; natural size: hover thrust.
    pub thrust: f64,
    /// Of τ; natural size: J1 g/L, which turns the body as fast as the payload swings.
    pub torque: f64,
    /// Of ζ; natural size: g.
    pub zeta: f64,
    /// Of ξ; natural size: one unit of the output.
    pub xi: f64,
}

impl Deviation {
    /// The largest of the four; NaN if any is.
    #[must_use]
    pub fn max(&self) -> f64 {
        [self.torque, self.zeta, self.xi].into_iter().fold(self.thrust, larger)
    }
}

/// The larger, or NaN if one is: a NaN must not vanish in a maximum.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// One quantity's largest deviation and largest size so far.
#[derive(Clone, Copy, Debug, Default)]
struct Quantity {
    deviation: f64,
    size: f64,
}

impl Quantity {
    fn push<const N: usize>(&mut self, value: &[f64; N], twin: &[f64; N], weights: &[f64; N]) {
        let (mut difference, mut size) = (0.0, 0.0);
        for ((value, twin), weight) in value.iter().zip(twin).zip(weights) {
            difference += (weight * (value - twin)).powi(2);
            size += (weight * twin).powi(2);
        }
        self.deviation = larger(self.deviation, difference.sqrt());
        self.size = larger(self.size, size.sqrt());
    }
}

/// Collects deviations over a flight.
#[derive(Clone, Debug)]
pub struct Deviations {
    thrust: Quantity,
    torque: Quantity,
    zeta: Quantity,
    xi: Quantity,
    zeta_weights: [f64; 4],
    xi_weights: [f64; 20],
}

impl Deviations {
    /// For flights of the controller that `spec` describes.
    #[must_use]
    pub fn new(spec: &ControllerSpec) -> Self {
        let vehicle = &spec.vehicle;
        let time = (vehicle.rod_length / vehicle.gravity).sqrt();
        let degrees: [usize; 4] = match spec.law {
            Law::Follow { .. } => [6, 6, 5, 2],
            Law::Track { .. } => [6, 6, 6, 2],
        };
        let mut xi_weights = [0.0; 20];
        let orders = degrees.into_iter().flat_map(|degree| 0..degree);
        for (weight, order) in xi_weights.iter_mut().zip(orders) {
            *weight = time.powi(order as i32);
        }
        let natural = |size| Quantity { deviation: 0.0, size };
        Self {
            thrust: natural((vehicle.payload_mass + vehicle.uav_mass) * vehicle.gravity),
            torque: natural(vehicle.inertia[0] * vehicle.gravity / vehicle.rod_length),
            zeta: natural(vehicle.gravity),
            xi: natural(1.0),
            zeta_weights: [0, 1, 2, 3].map(|order| time.powi(order)),
            xi_weights,
        }
    }

    /// Adds one sample: the pilot's answer and its twin's; ξ where both are known.
    pub fn push(&mut self, pilot: &Decision, twin: &Decision) {
        self.thrust.push(&[pilot.command.thrust], &[twin.command.thrust], &[1.0]);
        self.torque.push(&pilot.command.torque.into(), &twin.command.torque.into(), &[1.0; 3]);
        self.zeta.push(&pilot.zeta, &twin.zeta, &self.zeta_weights);
        if let (Some(pilot), Some(twin)) = (&pilot.telemetry, &twin.telemetry) {
            self.xi.push(&pilot.xi, &twin.xi, &self.xi_weights);
        }
    }

    /// The largest deviations, relative.
    #[must_use]
    pub fn finish(&self) -> Deviation {
        let relative = |quantity: &Quantity| quantity.deviation / quantity.size;
        Deviation {
            thrust: relative(&self.thrust),
            torque: relative(&self.torque),
            zeta: relative(&self.zeta),
            xi: relative(&self.xi),
        }
    }
}
