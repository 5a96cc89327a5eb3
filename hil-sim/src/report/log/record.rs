//! What is logged of one instant. The only place that knows how a flight keeps its samples.

use controller::{Command, Margins, State, Vector3};

use crate::describe::scenario::{Law, Scenario};
use crate::fly::batch::Outcome;
use crate::fly::flight::Moment;
use crate::fly::pilot::{Decision, Telemetry};
use crate::fly::sample::{Contact, Sample, Seen};
use crate::world::Bodies;

/// One logged instant of a flight.
#[derive(Clone, Copy, Debug)]
pub struct Record {
    /// s.
    pub t_s: f64,
    /// As it is, not as it is read.
    pub state: State<f64>,
    /// The UAV's position in N, m.
    pub uav_position: Vector3<f64>,
    /// The UAV's velocity in N, m/s.
    pub uav_velocity: Vector3<f64>,
    /// d_C, m, where it was taken.
    pub distance_m: Option<f64>,
    /// What the pilot answered; none while an obstacle holds the vehicle, and none at the end.
    pub decision: Option<Decision>,
    /// What an estimator held, where there is one.
    pub seen: Option<Seen>,
    /// Cable and ground, where there are any.
    pub contact: Option<Contact>,
    /// Of a replay: thrust and torque that the log has.
    pub logged: Option<Command<f64>>,
    /// Errors of speed (m/s) and yaw (rad), of a law that follows a path.
    pub errors: Option<[f64; 2]>,
}

impl Record {
    /// A sample of a flight of `scenario`.
    #[must_use]
    pub fn new(
        scenario: &Scenario,
        t_s: f64,
        state: State<f64>,
        [uav_position, uav_velocity]: [Vector3<f64>; 2],
        distance_m: Option<f64>,
        decision: Option<Decision>,
    ) -> Self {
        let follows = matches!(scenario.controller.law, Law::Follow { .. });
        // ξ holds h1 … h1⁽⁵⁾, h2 … h2⁽⁵⁾, h3 …, h4.
        let errors = |Telemetry { xi, .. }: Telemetry| [xi[12], xi[17]];
        Self {
            t_s,
            uav_position,
            uav_velocity,
            state,
            distance_m,
            errors: decision.and_then(|decision| decision.telemetry).filter(|_| follows).map(errors),
            decision,
            seen: None,
            contact: None,
            logged: None,
        }
    }

    /// The log of a flight.
    #[must_use]
    pub fn of_flight(Outcome { scenario, flight, .. }: &Outcome) -> Vec<Self> {
        flight.log.iter().map(|sample| Self::of_sample(scenario, sample)).collect()
    }

    /// One sample of such a log.
    #[must_use]
    pub fn of_sample(scenario: &Scenario, sample: &Sample) -> Self {
        let state = State::from_paper(&sample.x);
        let uav = [sample.uav_position, sample.uav_velocity];
        Self {
            seen: sample.seen,
            contact: sample.contact,
            logged: sample.logged,
            ..Self::new(scenario, sample.t_s, state, uav, Some(sample.distance_m), sample.decision)
        }
    }

    /// What a watcher of a flight of `scenario` sees.
    #[must_use]
    pub fn of_moment(scenario: &Scenario, moment: &Moment<'_>) -> Self {
        let Bodies { uav_position, uav_velocity, .. } = moment.body.bodies();
        let uav = [uav_position, uav_velocity];
        Self {
            seen: moment.sight.and_then(Seen::of),
            contact: Contact::of(moment.body),
            ..Self::new(scenario, moment.t_s, *moment.state, uav, moment.distance_m, moment.decision.copied())
        }
    }

    /// How far the law was from its singularities.
    #[must_use]
    pub fn margins(&self) -> Option<Margins<f64>> {
        self.decision.and_then(|decision| decision.margins)
    }

    /// Where the law's answer came from.
    #[must_use]
    pub fn law(&self) -> Option<Telemetry> {
        self.decision.and_then(|decision| decision.telemetry)
    }
}
