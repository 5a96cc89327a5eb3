//! The columns of a flight's log that a calibration reads.

use controller::{Matrix3, Vector3};

use crate::report::log::{self, ReadError};

/// One sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// s.
    pub t_s: f64,
    /// Body to N.
    pub attitude: Matrix3<f64>,
    /// Accelerometer's reading, body axes, m/s².
    pub specific_force: Vector3<f64>,
    /// Thrust commanded, N.
    pub thrust: f64,
    /// Of the UAV in N, m and m/s.
    pub uav_position: Vector3<f64>,
    /// m/s.
    pub uav_velocity: Vector3<f64>,
    /// Of the load in N, m and m/s.
    pub position: Vector3<f64>,
    /// m/s.
    pub velocity: Vector3<f64>,
}

/// A log that can't be calibrated from.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LogError {
    /// It can't be read, or lacks a column.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Too little of it has all numbers.
    #[error("{0} lines with all the numbers needed; at least {FEWEST} are needed")]
    Short(usize),
}

/// Ten seconds at 50 Hz.
const FEWEST: usize = 500;

/// In this order.
const COLUMNS: [&str; 20] = [
    "att_w", "att_x", "att_y", "att_z", "f1", "f2", "f3", "thrust", "uav_p1", "uav_p2", "uav_p3", "uav_v1", "uav_v2",
    "uav_v3", "p1", "p2", "p3", "v1", "v2", "v3",
];

/// Reads a log of `hil-sim run`, CSV or ULog, or one with columns of these names. Lines that lack a
/// number are passed over.
///
/// # Errors
/// [`LogError`] names the column that is missing, or says how short it is.
pub fn read(bytes: &[u8]) -> Result<Vec<Sample>, LogError> {
    let rows = log::read(bytes, COLUMNS)?;
    let whole = rows.into_iter().filter(|(t_s, numbers)| t_s.is_finite() && numbers.iter().all(|x| x.is_finite()));
    let samples: Vec<Sample> = whole.map(|(t_s, numbers)| sample(t_s, &numbers)).collect();
    if samples.len() < FEWEST { Err(LogError::Short(samples.len())) } else { Ok(samples) }
}

fn sample(t_s: f64, n: &[f64; COLUMNS.len()]) -> Sample {
    let vector = |at: usize| Vector3::new(n[at], n[at + 1], n[at + 2]);
    let q = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(n[0], n[1], n[2], n[3]));
    let rotation = q.to_rotation_matrix();
    Sample {
        t_s,
        attitude: Matrix3::from_column_slice(rotation.matrix().as_slice()),
        specific_force: vector(4),
        thrust: n[7],
        uav_position: vector(8),
        uav_velocity: vector(11),
        position: vector(14),
        velocity: vector(17),
    }
}
