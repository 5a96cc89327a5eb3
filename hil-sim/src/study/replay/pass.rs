//! One pass through a log: the flight loop with the log in the world's place.

use controller::{Command, Request, State, Uav, Vector3};

use super::agreement::Agreement;
use super::filter::{Filter, Found};
use super::flown::Flown;
use super::logged::{Logged, UavMotion};
use crate::describe::input::Invalid;
use crate::describe::parameters::without_path;
use crate::describe::scenario::{Requests, Scenario};
use crate::fly::flight::End;
use crate::fly::metrics::Metrics;
use crate::fly::pilot::{Answers, Decision, Pilot};
use crate::fly::run::Flight;
use crate::fly::sample::Sample;
use crate::world::{Bodies, Reading};

/// Estimator and law of a scenario on their way through a log.
pub struct Pass<'a> {
    scenario: &'a Scenario,
    logged: &'a Logged,
    /// The log's time at the first period, s.
    from: f64,
    period: f64,
    filter: Filter,
    pilot: Pilot<f32, Flown>,
    /// The law is given the estimate.
    is_estimated: bool,
    /// UAV and load move apart: the law is told the UAV's own motion, too.
    is_apart: bool,
    has_begun: bool,
    zeta: [f64; 4],
}

/// A log's instant, with what the filter makes of it.
struct Instant {
    uav: Option<UavMotion>,
    specific_force: Option<Vector3<f64>>,
    /// The state as it is logged.
    truth: Option<State<f64>>,
    found: Option<Found>,
}

impl<'a> Pass<'a> {
    /// Of `scenario` through `logged`, beginning at `from` of its seconds.
    ///
    /// # Errors
    /// [`Invalid`] for a number that controller or filter refuse.
    pub fn new(scenario: &'a Scenario, logged: &'a Logged, from: f64) -> Result<Self, Invalid> {
        let period = 1.0 / scenario.controller.rate_hz;
        let parameters = without_path(&scenario.controller).map_err(|error| Invalid::new("controller", error))?;
        let begun = if scenario.standing { 0.0 } else { hover(scenario) };
        let has_force = logged.specific_force(from, period).is_some();
        Ok(Self {
            scenario,
            logged,
            from,
            period,
            filter: Filter::new(scenario, logged.thrust(from).unwrap_or(begun))?,
            pilot: Pilot::with_actuation(&scenario.controller, &parameters, Flown::new)?,
            is_estimated: !logged.has_load() || scenario.estimator.is_some() && has_force,
            is_apart: scenario.cable.is_some() || scenario.ground.is_some(),
            has_begun: false,
            zeta: scenario.controller.zeta,
        })
    }

    /// To its end.
    pub fn fly(mut self) -> Flight {
        let (scenario, logged) = (self.scenario, self.logged);
        let (steps, log_every) = (scenario.steps(), scenario.log_every());
        let held = scenario.obstacle.map(|o| scenario.periods(o.at_s)..scenario.periods(o.at_s + o.hold_s));
        let mut requests = Requests::of(scenario);
        let mut metrics = Metrics::new(scenario);
        let mut agreement = Agreement::default();
        // A log may be one long gap: what it has no rows for takes no memory.
        let mut log = Vec::new();
        for step in 0..=steps {
            let t_s = step as f64 * self.period;
            if held.as_ref().is_some_and(|held| held.start == step) {
                (self.has_begun, self.zeta) = (false, [0.0; 4]);
            }
            let is_held = held.as_ref().is_some_and(|held| held.contains(&step));
            let (request, factor) = requests.at(step);
            if let Some(factor) = factor {
                self.pilot.set_speed_factor(factor);
            }
            let instant = self.see(self.from + t_s);
            let command = logged.command(self.from + t_s);
            let decision = if is_held { None } else { self.answer(&instant, command.as_ref(), request, t_s) };
            let Instant { uav, truth, found, .. } = instant;
            agreement.push(decision.map(|decision| decision.command).zip(command), truth.zip(found));
            // In a gap of the log there is nothing to show.
            let Some((uav, shown)) = uav.zip(truth.or(found.map(|found| found.state))) else { continue };
            let distance_m = scenario.controller.law.distance(shown.position.into());
            metrics.push(t_s, Some(distance_m), &shown, decision.as_ref());
            if step.is_multiple_of(log_every) || step == steps {
                log.push(Sample {
                    t_s,
                    x: shown.to_paper(),
                    uav_position: uav.position,
                    uav_velocity: uav.velocity,
                    distance_m,
                    decision,
                    seen: found.map(|found| found.seen),
                    contact: None,
                    logged: command,
                });
            }
        }
        Flight {
            results: metrics.finish(),
            log,
            deviation: None,
            end: End::Complete,
            times_real_time: f64::NAN,
            times_real_time_with_twin: f64::NAN,
            replayed: Some(agreement.finish(self.is_estimated, &logged.unsaid)),
        }
    }

    /// The log at `t_s` of its seconds.
    fn see(&mut self, t_s: f64) -> Instant {
        let (logged, period) = (self.logged, self.period);
        let uav = logged.uav(t_s);
        let specific_force = logged.specific_force(t_s, period);
        let truth = uav.as_ref().zip(logged.load(t_s)).map(|(uav, load)| state(uav, load));
        // What acted over the period that ends now.
        let thrust = logged.thrust(t_s - period).or_else(|| logged.thrust(t_s));
        let found = uav.as_ref().zip(specific_force).map(|(uav, force)| self.filter.step(uav, force, thrust));
        Instant { uav, specific_force, truth, found }
    }

    /// What the law says, once it has begun, where `logged` is what is then applied; in a gap of
    /// the log it flies on its model.
    fn answer(
        &mut self,
        instant: &Instant,
        logged: Option<&Command<f64>>,
        request: Request,
        t_s: f64,
    ) -> Option<Decision> {
        let Instant { uav, specific_force, truth, found } = instant;
        let found = found.as_ref().filter(|_| self.is_estimated);
        let given = if self.is_estimated { found.map(|found| found.state) } else { *truth };
        let is_first = !self.has_begun;
        if is_first {
            let state = given.as_ref()?;
            if !self.scenario.standing {
                self.begin(state);
            }
            self.has_begun = true;
        }
        let uav = uav.as_ref().filter(|_| self.is_apart || self.is_estimated);
        let reading = Reading {
            comes: given.is_some(),
            state: given.unwrap_or_else(|| State::at_rest(Vector3::zeros())),
            sees_load: is_first || found.is_none_or(|found| found.is_known),
            uav: uav.map(|&UavMotion { position, velocity, attitude, body_rate }| Uav {
                position,
                velocity,
                attitude,
                body_rate,
            }),
            specific_force: uav.and(*specific_force),
            aboard: None,
        };
        self.pilot.actuation().set(logged);
        let decision = *self.pilot.step(&reading, request, t_s)?;
        // Not what was applied, but what the law would have.
        let command = self.pilot.actuation().asked().unwrap_or(decision.command);
        Some(Decision { command, ..decision })
    }

    /// Starts the law: as the scenario says at the start of its own flight, and elsewhere by taking
    /// over from what is logged.
    fn begin(&mut self, state: &State<f64>) {
        let is_start = self.from < self.period;
        if is_start && !self.scenario.take_over {
            return self.pilot.start(state, self.zeta);
        }
        let logged = self.logged.command(self.from).filter(|_| !is_start);
        let mut applied = logged.unwrap_or(Command { thrust: hover(self.scenario), torque: Vector3::zeros() });
        if !applied.torque.iter().all(|axis| axis.is_finite()) {
            applied.torque = Vector3::zeros();
        }
        self.pilot.take_over(state, &applied);
    }
}

/// The thrust that the controller takes for a hover, N.
fn hover(scenario: &Scenario) -> f64 {
    let told = &scenario.controller.vehicle;
    (told.payload_mass + told.uav_mass) * told.gravity
}

fn state(uav: &UavMotion, [position, velocity]: [Vector3<f64>; 2]) -> State<f64> {
    let bodies = Bodies {
        position,
        velocity,
        uav_position: uav.position,
        uav_velocity: uav.velocity,
        attitude: uav.attitude,
        body_rate: uav.body_rate,
    };
    bodies.state()
}
