//! What a log keeps of a control period.

use controller::Vector3;

use super::pilot::Decision;

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
    /// d_C, m.
    pub distance_m: f64,
    /// What the pilot answered; none while an obstacle holds the vehicle, and none at the end.
    pub decision: Option<Decision>,
    /// Accelerometer's reading in body axes, m/s², where an estimator has one.
    pub specific_force: Option<Vector3<f64>>,
}
