//! What a log keeps of a control period.

use controller::{Command, Vector3};
use estimator::Validity;

use super::pilot::Decision;
use super::sight::Sight;
use crate::world::Body;

/// One sample of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// s.
    pub t_s: f64,
    /// The paper's 16 coordinates.
    pub x: [f64; 16],
    /// Of the UAV in N, m.
    pub uav_position: Vector3<f64>,
    /// Of the UAV in N, m/s.
    pub uav_velocity: Vector3<f64>,
    /// d_C, m; NaN where no path is the scenario's to follow.
    pub distance_m: f64,
    /// What the pilot answered; none while an obstacle holds the vehicle, and none at the end.
    pub decision: Option<Decision>,
    /// What an estimator held, where there is one.
    pub seen: Option<Seen>,
    /// Cable and ground, where there are any.
    pub contact: Option<Contact>,
    /// Of a replay: thrust and torque that the log has.
    pub logged: Option<Command<f64>>,
}

/// What an estimator held at a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// Accelerometer's reading in body axes, m/s².
    pub specific_force: Vector3<f64>,
    /// Of the payload in N, m.
    pub position: Vector3<f64>,
    /// q, from the UAV to the payload.
    pub rod: Vector3<f64>,
    /// Standard deviation of q, rad: of both axes together.
    pub rod_deviation: f64,
    /// Standard deviation of the UAV's level position by the navigation filter, m: of both axes
    /// together; none where navigation is not the estimator's own.
    pub position_deviation: Option<f64>,
    /// What the rod is worth.
    pub validity: Validity,
}

impl Seen {
    /// What `sight` holds, once it has answered.
    #[must_use]
    pub fn of(sight: &Sight) -> Option<Self> {
        let estimate = sight.estimate()?;
        Some(Self {
            specific_force: sight.specific_force(),
            position: estimate.state.position.map(f64::from),
            rod: estimate.state.rod.map(f64::from),
            rod_deviation: estimate.health.rod_deviation.into(),
            position_deviation: Some(sight.navigation().health().position_deviation.into()),
            validity: estimate.health.validity,
        })
    }
}

/// Where a cable may be slack and bodies may stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contact {
    /// The cable pulls.
    pub is_taut: bool,
    /// Whether the payload, and whether the UAV, is on the ground.
    pub touching: [bool; 2],
}

impl Contact {
    /// Of a body on a cable; one on a rod has none.
    #[must_use]
    pub fn of(body: &Body) -> Option<Self> {
        match body {
            Body::Rod(_) => None,
            Body::Cable(_) => Some(Self { is_taut: body.is_taut(), touching: body.touching() }),
        }
    }
}
