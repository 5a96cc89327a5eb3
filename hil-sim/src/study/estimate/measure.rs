//! How far an estimate is from the truth over a flight.

use controller::Vector3;

use crate::describe::scenario::Scenario;
use crate::fly::flight::Moment;
use crate::fly::judge::JUDGED;

/// Sums over the last quarter, and what became of the rod.
#[derive(Clone, Debug, Default)]
pub(super) struct Errors {
    judged_from_s: f64,
    rod_length: f64,
    payload_mass: f64,
    pub(super) count: u32,
    /// Squares: of the rod's direction (rad²), its rate, and the UAV's position and velocity.
    pub(super) rod: f64,
    pub(super) rate: f64,
    pub(super) position: f64,
    pub(super) velocity: f64,
    pub(super) nees_rod: f64,
    pub(super) nees_rate: f64,
    /// Largest after 20 s, rad.
    pub(super) rod_worst: f64,
    /// From when on the rod's error is below 2°, s.
    pub(super) found_s: f64,
    pub(super) mass: f64,
    pub(super) thrust_scale: f64,
    pub(super) thrust_step: f64,
    thrust: Option<f64>,
}

/// Time given to the filter before its worst counts, s.
const GIVEN_S: f64 = 20.0;

impl Errors {
    pub(super) fn new(scenario: &Scenario) -> Self {
        Self {
            judged_from_s: (1.0 - JUDGED) * scenario.duration_s,
            rod_length: scenario.vehicle.rod_length,
            payload_mass: scenario.controller.vehicle.payload_mass,
            ..Self::default()
        }
    }

    pub(super) fn push(&mut self, moment: &Moment<'_>) {
        let is_judged = moment.t_s >= self.judged_from_s;
        let Some(decision) = moment.decision else { return };
        let thrust = decision.command.thrust;
        if let Some(before) = self.thrust.replace(thrust)
            && is_judged
        {
            self.thrust_step = self.thrust_step.max((thrust - before).abs() / before.abs().max(1.0));
        }
        let Some((sight, estimate)) = moment.sight.and_then(|sight| Some((sight, sight.estimate()?))) else { return };
        let (truth, found) = (moment.state, estimate.state.cast::<f64>());
        let rod = truth.rod - found.rod;
        let off = rod.dot(&rod).sqrt();
        if off > 2.0_f64.to_radians() {
            self.found_s = moment.t_s;
        }
        if moment.t_s > GIVEN_S {
            self.rod_worst = self.rod_worst.max(off);
        }
        if !is_judged {
            return;
        }
        let square = |v: &Vector3<f64>| v.dot(v);
        let rate = truth.rod_rate - found.rod_rate;
        let place = |state: &controller::State<f64>| state.position - state.rod * self.rod_length;
        let moving = |state: &controller::State<f64>| state.velocity - state.rod_rate * self.rod_length;
        let p = sight.payload().covariance();
        self.count += 1;
        self.rod += off * off;
        self.rate += square(&rate);
        self.position += square(&(place(truth) - place(&found)));
        self.velocity += square(&(moving(truth) - moving(&found)));
        self.nees_rod += nees([rod.x, rod.y], [p[0][0], p[0][1], p[1][1]]);
        self.nees_rate += nees([rate.x, rate.y], [p[2][2], p[2][3], p[3][3]]);
        let nominal = sight.payload().nominal();
        self.mass = self.payload_mass * (1.0 + f64::from(nominal.mass_ratio));
        self.thrust_scale = f64::from(nominal.thrust_scale);
    }
}

/// e·P⁻¹e/2.
fn nees([x, y]: [f64; 2], covariance: [f32; 3]) -> f64 {
    let [a, b, c] = covariance.map(f64::from);
    (c * x * x - 2.0 * b * x * y + a * y * y) / (a * c - b * b) / 2.0
}
