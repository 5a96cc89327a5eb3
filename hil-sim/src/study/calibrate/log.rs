//! The columns of a flight's log that a calibration reads.

use controller::{Matrix3, Vector3};

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
    /// It is no CSV.
    #[error("{0}")]
    Csv(String),
    /// A column is missing.
    #[error("no column `{0}`: a log of `hil-sim run` with [estimator] has it, in SI units")]
    Missing(&'static str),
    /// Too little of it has all numbers.
    #[error("{0} lines with all the numbers needed; at least {FEWEST} are needed")]
    Short(usize),
}

/// Ten seconds at 50 Hz.
const FEWEST: usize = 500;

/// In this order.
const COLUMNS: [&str; 21] = [
    "t_s", "att_w", "att_x", "att_y", "att_z", "f1", "f2", "f3", "thrust", "uav_p1", "uav_p2", "uav_p3", "uav_v1",
    "uav_v2", "uav_v3", "p1", "p2", "p3", "v1", "v2", "v3",
];

/// Reads a log of `hil-sim run`, or one with columns of these names. Lines that lack a number are
/// passed over.
///
/// # Errors
/// [`LogError`] names the column that is missing, or says how short it is.
pub fn read(text: &str) -> Result<Vec<Sample>, LogError> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let header = reader.headers().map_err(|error| LogError::Csv(error.to_string()))?.clone();
    let mut places = [0; COLUMNS.len()];
    for (place, name) in places.iter_mut().zip(COLUMNS) {
        *place = header.iter().position(|column| column.trim() == name).ok_or(LogError::Missing(name))?;
    }
    let mut samples = Vec::new();
    for line in reader.records() {
        let line = line.map_err(|error| LogError::Csv(error.to_string()))?;
        let numbers = places.map(|place| line.get(place).and_then(|cell| cell.trim().parse::<f64>().ok()));
        let numbers: Option<Vec<f64>> = numbers.into_iter().map(|x| x.filter(|x| x.is_finite())).collect();
        if let Some(numbers) = numbers {
            samples.push(sample(&numbers));
        }
    }
    if samples.len() < FEWEST { Err(LogError::Short(samples.len())) } else { Ok(samples) }
}

fn sample(n: &[f64]) -> Sample {
    let vector = |at: usize| Vector3::new(n[at], n[at + 1], n[at + 2]);
    let q = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(n[1], n[2], n[3], n[4]));
    let rotation = q.to_rotation_matrix();
    Sample {
        t_s: n[0],
        attitude: Matrix3::from_column_slice(rotation.matrix().as_slice()),
        specific_force: vector(5),
        thrust: n[8],
        uav_position: vector(9),
        uav_velocity: vector(12),
        position: vector(15),
        velocity: vector(18),
    }
}
