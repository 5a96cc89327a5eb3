//! Reference vectors, computed in binary128 and rounded to f64; `golden/` holds the files. SI
//! units, angles in rad.

use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::path::Path;

/// Gains of the four outputs, low order first.
pub type Gains = Vec<Vec<f64>>;

/// A file of vectors.
#[derive(Debug, Deserialize)]
pub struct File<M, V> {
    /// What holds for all of them.
    pub meta: M,
    /// The vectors.
    pub vectors: Vec<V>,
}

/// The gains used throughout a file of law evaluations.
#[derive(Debug, Deserialize)]
pub struct LawMeta {
    /// Gains of Fig. 3.
    pub gains_fig3: Gains,
    /// Gains of Figs 5 and 6.
    pub gains_fig56: Gains,
    /// Gains of the tracking law.
    pub gains_track: Gains,
    /// Diagonal of K̃, the integral gains of Figs 5 and 6.
    #[serde(rename = "Ktilde")]
    pub integral_gains: [f64; 3],
}

/// (m_L, m_Q, J1, J2, J3, L, g).
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct Vehicle([f64; 7]);

impl Vehicle {
    /// m_L, kg.
    #[must_use]
    pub fn payload_mass(&self) -> f64 {
        self.0[0]
    }
    /// m_Q, kg.
    #[must_use]
    pub fn uav_mass(&self) -> f64 {
        self.0[1]
    }
    /// Diagonal of J, kg·m².
    #[must_use]
    pub fn inertia(&self) -> [f64; 3] {
        [self.0[2], self.0[3], self.0[4]]
    }
    /// L, m.
    #[must_use]
    pub fn rod_length(&self) -> f64 {
        self.0[5]
    }
    /// g, m/s².
    #[must_use]
    pub fn gravity(&self) -> f64 {
        self.0[6]
    }
}

/// One evaluation of the path-following law.
#[derive(Debug, Deserialize)]
pub struct Follow {
    /// `wide` or `near` the path.
    pub regime: String,
    /// The paper's 16 coordinates.
    pub x: [f64; 16],
    /// ζ.
    pub zeta: [f64; 4],
    /// The vehicle.
    pub par: Vehicle,
    /// The path's parameters, in the order of the file's description.
    pub path: Vec<f64>,
    /// ξ̃.
    #[serde(rename = "xint")]
    pub integral: [f64; 3],
    /// det Ā.
    #[serde(rename = "det_A")]
    pub det_a: f64,
    /// ξ.
    pub xi: [f64; 19],
    /// b̄.
    pub b: [f64; 4],
    /// Ā by rows.
    #[serde(rename = "A")]
    pub a: [[f64; 4]; 4],
    /// T, N.
    #[serde(rename = "T")]
    pub thrust: f64,
    /// ν with the gains of Fig. 3.
    pub nu_fig3: [f64; 4],
    /// ū = (u_ζ, τ) with the gains of Fig. 3.
    pub ubar_fig3: [f64; 4],
    /// ν with the gains of Figs 5 and 6, without integral action.
    pub nu_fig56: [f64; 4],
    /// ū with the gains of Figs 5 and 6, without integral action.
    pub ubar_fig56: [f64; 4],
    /// ν with the gains of Figs 5 and 6 and integral action.
    pub nu_fig56_int: [f64; 4],
    /// ū with the gains of Figs 5 and 6 and integral action.
    pub ubar_fig56_int: [f64; 4],
}

/// One evaluation of the tracking law, y_ref = (5 sin t, 5 cos t, −10, 0).
#[derive(Debug, Deserialize)]
pub struct Track {
    /// `wide` or `near` the path.
    pub regime: String,
    /// The paper's 16 coordinates.
    pub x: [f64; 16],
    /// ζ.
    pub zeta: [f64; 4],
    /// The vehicle.
    pub par: Vehicle,
    /// Time, s.
    pub t: f64,
    /// p1, p2, p3 with five derivatives each, ψ, ψ̇; the reference is not subtracted.
    pub xi: [f64; 20],
    /// b̄.
    pub b: [f64; 4],
    /// Ā by rows.
    #[serde(rename = "A")]
    pub a: [[f64; 4]; 4],
    /// T, N.
    #[serde(rename = "T")]
    pub thrust: f64,
    /// ν.
    pub nu: [f64; 4],
    /// ū = (u_ζ, τ).
    pub ubar: [f64; 4],
}

/// One evaluation of the model (2.8).
#[derive(Debug, Deserialize)]
pub struct Plant {
    /// The paper's 16 coordinates.
    pub x: [f64; 16],
    /// The vehicle.
    pub par: Vehicle,
    /// (T, τ).
    pub u: [f64; 4],
    /// ẋ.
    pub xdot: [f64; 16],
    /// f(x).
    pub f: [f64; 16],
    /// G(x) by rows.
    #[serde(rename = "G")]
    pub g: [[f64; 4]; 16],
}

/// A closed loop in continuous time, integrated with a relative tolerance of 1e-9.
#[derive(Debug, Deserialize)]
pub struct Trajectory {
    /// `circle`, `ellipse` or `track`.
    pub kind: String,
    /// The path's parameters.
    pub path: Vec<f64>,
    /// The vehicle the law is told.
    pub par_controller: Vehicle,
    /// The vehicle that flies.
    pub par_plant: Vehicle,
    /// K.
    pub gains: Gains,
    /// Diagonal of K̃, if there is integral action.
    #[serde(rename = "Ktilde")]
    pub integral_gains: Option<[f64; 3]>,
    /// Times, s.
    pub t: Vec<f64>,
    /// States.
    pub x: Vec<[f64; 16]>,
    /// ζ.
    pub zeta: Vec<[f64; 4]>,
    /// ξ̃ (zero where the law has none to integrate).
    #[serde(rename = "xint")]
    pub integral: Vec<[f64; 3]>,
    /// (T, τ).
    pub u: Vec<[f64; 4]>,
}

/// Path-following vectors of `circle`, `ellipse` or `bent`.
#[must_use]
pub fn follow(path: &str) -> File<LawMeta, Follow> {
    load(path)
}

/// Tracking vectors.
#[must_use]
pub fn track() -> File<LawMeta, Track> {
    load("track")
}

/// Plant vectors.
#[must_use]
pub fn plant() -> Vec<Plant> {
    load::<File<serde::de::IgnoredAny, Plant>>("plant").vectors
}

/// Closed loops by name.
#[must_use]
pub fn trajectories() -> BTreeMap<String, Trajectory> {
    load("trajectories")
}

/// The gains as one array per output, 0 above its relative degree.
#[must_use]
pub fn padded(gains: &Gains) -> [[f64; 6]; 4] {
    let mut rows = [[0.0; 6]; 4];
    for (row, given) in rows.iter_mut().zip(gains) {
        row[..given.len()].copy_from_slice(given);
    }
    rows
}

/// ‖a − b‖/‖b‖, with Euclidean norms; NaN if either is not finite, so that it passes no
/// bound.
#[must_use]
pub fn relative_error(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len(), "vectors of different lengths");
    let norm = |v: &mut dyn Iterator<Item = f64>| v.map(|x| x * x).sum::<f64>().sqrt();
    let difference = norm(&mut a.iter().zip(b).map(|(a, b)| a - b));
    difference / norm(&mut b.iter().copied())
}

fn load<T: DeserializeOwned>(name: &str) -> T {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("golden/{name}.json"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
