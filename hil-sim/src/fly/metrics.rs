//! What a flight is judged by, measured at every sample.

use serde::{Deserialize, Serialize};

use crate::describe::scenario::{Law, Scenario};
use crate::fly::pilot::Decision;
use crate::fly::stops::Stops;
use crate::fly::touchdown::Touchdown;
use controller::{State, Vector3};

/// d_C below which a flight counts as settled, m.
pub const SETTLED_M: f64 = 0.05;

/// The numbers of one flight; one that does not apply is absent. The reference numbers have the
/// same form.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Results {
    /// First time d_C is below 5 cm, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub first_below_s: Option<f64>,
    /// Time from which d_C stays below 5 cm, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub settle_s: Option<f64>,
    /// ∫‖u − u_hover‖dt with u = (T, τ) as numbers in N and N·m; N·s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub effort_n_s: Option<f64>,
    /// Largest ‖u‖.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_u: Option<f64>,
    /// Least T, N.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min_thrust_n: Option<f64>,
    /// Largest ‖τ‖, N·m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub peak_torque_nm: Option<f64>,
    /// Largest d_C from the release by the obstacle on, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dc_max_after_release_m: Option<f64>,
    /// Largest d_C in the steady time, m; in the whole flight where none is stated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dc_max_m: Option<f64>,
    /// Root mean square of d_C over the same time, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dc_rms_m: Option<f64>,
    /// Largest distance of the payload from a route's stop when it was slowest there, m, over the
    /// stops at which it rested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stop_error_m: Option<f64>,
    /// Largest change of T from one period to the next, as a share of it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub thrust_step_max: Option<f64>,
    /// Mean of √(p1² + p2²) − radius over the steady time, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady_radius_error_m: Option<f64>,
    /// Mean of p3 − d2 over the steady time, m; positive is lower.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady_p3_error_m: Option<f64>,
    /// Mean of ρ·v − v_d over the steady time, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady_speed_error_m_s: Option<f64>,
    /// Largest magnitude of the radius error in the steady time, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady_radius_error_max_m: Option<f64>,
    /// Largest magnitude of the p3 error in the steady time, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady_p3_error_max_m: Option<f64>,
    /// Fastest touch of the UAV on the ground, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub uav_touchdown_m_s: Option<f64>,
    /// Fastest touch of the payload on the ground, m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_touchdown_m_s: Option<f64>,
    /// Level distance of the payload from where it was when a landing was asked for, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub load_place_m: Option<f64>,
}

/// Mean and largest magnitude.
#[derive(Clone, Copy, Debug, Default)]
struct Spread {
    sum: f64,
    count: u64,
    max: f64,
}

impl Spread {
    fn push(&mut self, value: f64) {
        self.sum += value;
        self.count += 1;
        self.max = self.max.max(value.abs());
    }

    fn mean(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }

    fn max(&self) -> Option<f64> {
        (self.count > 0).then_some(self.max)
    }
}

/// Collects [`Results`] over a flight.
pub struct Metrics<'a> {
    law: &'a Law,
    hover_thrust: f64,
    released_s: Option<f64>,
    steady_from_s: Option<f64>,
    period: f64,
    first_below_s: Option<f64>,
    last_above: bool,
    settle_s: f64,
    effort: f64,
    peak_u: f64,
    min_thrust: f64,
    peak_torque: f64,
    last_thrust: Option<f64>,
    thrust_step: f64,
    stops: Stops,
    dc_after_release: Option<f64>,
    distance: Spread,
    distance_squared: Spread,
    radius: Spread,
    p3: Spread,
    speed: Spread,
    touchdown: Touchdown,
}

impl<'a> Metrics<'a> {
    /// For a flight of `scenario`.
    #[must_use]
    pub fn new(scenario: &'a Scenario) -> Self {
        Self {
            law: &scenario.controller.law,
            hover_thrust: scenario.vehicle.total_mass() * scenario.vehicle.gravity,
            released_s: scenario.obstacle.map(|obstacle| obstacle.at_s + obstacle.hold_s),
            steady_from_s: scenario.steady_from_s,
            period: 1.0 / scenario.controller.rate_hz,
            first_below_s: None,
            last_above: false,
            settle_s: 0.0,
            effort: 0.0,
            peak_u: 0.0,
            min_thrust: f64::INFINITY,
            peak_torque: 0.0,
            last_thrust: None,
            thrust_step: 0.0,
            stops: Stops::of(&scenario.controller.law),
            dc_after_release: None,
            distance: Spread::default(),
            distance_squared: Spread::default(),
            radius: Spread::default(),
            p3: Spread::default(),
            speed: Spread::default(),
            touchdown: Touchdown::default(),
        }
    }

    /// Takes how both bodies came to the ground so far.
    pub fn touch(&mut self, touchdown: &Touchdown) {
        self.touchdown = *touchdown;
    }

    /// Adds the `state` at `t` (s), d_C (m) from the curve if there is one to follow, and what the
    /// pilot made of it.
    pub fn push(&mut self, t: f64, distance: Option<f64>, state: &State<f64>, decision: Option<&Decision>) {
        match distance {
            Some(distance) => self.push_course(t, distance, state),
            None => self.last_above = true,
        }
        // Not across an obstacle, after which the law begins anew.
        let last_thrust = self.last_thrust.take();
        if let Some(decision) = decision {
            let thrust = decision.command.thrust;
            let torque = decision.command.torque.iter().map(|axis| axis * axis).sum::<f64>().sqrt();
            self.effort += (thrust - self.hover_thrust).hypot(torque) * self.period;
            self.peak_u = self.peak_u.max(thrust.hypot(torque));
            self.min_thrust = self.min_thrust.min(thrust);
            self.peak_torque = self.peak_torque.max(torque);
            if let Some(last) = last_thrust.filter(|last| *last > 0.0) {
                self.thrust_step = self.thrust_step.max((thrust / last - 1.0).abs());
            }
            self.last_thrust = Some(thrust);
        }
    }

    fn push_course(&mut self, t: f64, distance: f64, state: &State<f64>) {
        // Comparisons that a NaN fails: a flight that ends as none has not settled.
        if distance < SETTLED_M {
            self.first_below_s.get_or_insert(t);
            if self.last_above {
                self.settle_s = t;
            }
            self.last_above = false;
        } else {
            self.last_above = true;
        }
        // Sample times are whole periods up to rounding.
        let reached = |from: Option<f64>| from.is_some_and(|from| t > from - 0.5 * self.period);
        if reached(self.released_s) {
            self.dc_after_release = Some(self.dc_after_release.unwrap_or(0.0).max(distance));
        }
        self.stops.push(&state.position, &state.velocity);
        if self.steady_from_s.is_none() || reached(self.steady_from_s) {
            self.distance.push(distance);
            self.distance_squared.push(distance * distance);
        }
        if reached(self.steady_from_s)
            && let Some(circle) = self.law.circle()
        {
            let [radius, p3, speed] = circle_errors(&state.position, &state.velocity, circle);
            self.radius.push(radius);
            self.p3.push(p3);
            self.speed.push(speed);
        }
    }

    /// The results.
    #[must_use]
    pub fn finish(&self) -> Results {
        Results {
            first_below_s: self.first_below_s,
            settle_s: (!self.last_above).then_some(self.settle_s),
            effort_n_s: Some(self.effort),
            peak_u: Some(self.peak_u),
            min_thrust_n: Some(self.min_thrust),
            peak_torque_nm: Some(self.peak_torque),
            dc_max_after_release_m: self.dc_after_release,
            dc_max_m: self.distance.max(),
            dc_rms_m: self.distance_squared.mean().map(f64::sqrt),
            stop_error_m: self.stops.error(),
            thrust_step_max: Some(self.thrust_step),
            steady_radius_error_m: self.radius.mean(),
            steady_p3_error_m: self.p3.mean(),
            steady_speed_error_m_s: self.speed.mean(),
            steady_radius_error_max_m: self.radius.max(),
            steady_p3_error_max_m: self.p3.max(),
            uav_touchdown_m_s: self.touchdown.uav_m_s,
            load_touchdown_m_s: self.touchdown.load_m_s,
            load_place_m: self.touchdown.load_place_m,
        }
    }
}

/// Errors of radius (m), p3 (m) and speed along (−p2, p1, 0)/r (m/s), against those of `circle`
/// ([`Law::circle`]).
#[must_use]
pub fn circle_errors(p: &Vector3<f64>, v: &Vector3<f64>, [radius, height, speed]: [f64; 3]) -> [f64; 3] {
    let from_axis = p.x.hypot(p.y);
    [from_axis - radius, p.z - height, (p.x * v.y - p.y * v.x) / from_axis - speed]
}
