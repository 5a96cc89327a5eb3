//! Gains of a scenario, from poles or as they are, with the paper's as defaults.

use controller::{GainError, Gains, Pole, TrackGains, place};
use serde::Deserialize;

use crate::describe::input::Invalid;

/// A pole in a file, 1/s.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(untagged, expecting = "a pole is a number, or [re, im] for a complex pair")]
pub(super) enum PoleField {
    Real(f64),
    Pair([f64; 2]),
}

/// How a file gives K and K̃.
pub(super) struct GainFields {
    pub poles: Option<Vec<Vec<PoleField>>>,
    pub k: Option<Vec<Vec<f64>>>,
    pub integral: [f64; 3],
}

/// Fig. 3: double poles at −2 for the surfaces, at −1 for speed and yaw.
const FOLLOW_POLES: [(f64, usize); 4] = [(-2.0, 6), (-2.0, 6), (-1.0, 5), (-1.0, 2)];
/// Section V's baseline in Fig. 3.
const TRACK_POLES: [(f64, usize); 4] = [(-1.5, 6), (-1.5, 6), (-1.5, 6), (-1.0, 2)];

pub(super) fn follow(fields: GainFields) -> Result<Gains<f64>, Invalid> {
    let rows = Rows::of(fields.poles, fields.k, FOLLOW_POLES)?;
    let gains = Gains {
        k1: rows.gains(0)?,
        k2: rows.gains(1)?,
        k3: rows.gains(2)?,
        k4: rows.gains(3)?,
        integral: fields.integral,
    };
    gains.check().map_err(|error| rows.locate(error))?;
    Ok(gains)
}

pub(super) fn track(fields: GainFields) -> Result<TrackGains<f64>, Invalid> {
    if fields.integral != [0.0; 3] {
        return Err(Invalid::new("controller.k_integral", "the tracking law has no integral action"));
    }
    let rows = Rows::of(fields.poles, fields.k, TRACK_POLES)?;
    let gains = TrackGains { position: [rows.gains(0)?, rows.gains(1)?, rows.gains(2)?], yaw: rows.gains(3)? };
    gains.check().map_err(|error| rows.locate(error))?;
    Ok(gains)
}

/// One row for each of the four outputs.
enum Rows {
    Poles(Vec<Vec<Pole<f64>>>),
    Gains(Vec<Vec<f64>>),
}

impl Rows {
    fn of(
        poles: Option<Vec<Vec<PoleField>>>,
        k: Option<Vec<Vec<f64>>>,
        default: [(f64, usize); 4],
    ) -> Result<Self, Invalid> {
        let rows = match (poles, k) {
            (Some(_), Some(_)) => {
                return Err(Invalid::new("controller.k", "the gains follow from poles: give either poles or k"));
            }
            (Some(poles), None) => {
                Self::Poles(poles.iter().map(|row| row.iter().map(|&pole| Pole::from(pole)).collect()).collect())
            }
            (None, Some(k)) => Self::Gains(k),
            (None, None) => Self::Poles(default.map(|(pole, count)| vec![Pole::Real(pole); count]).to_vec()),
        };
        let outputs = match &rows {
            Self::Poles(rows) => rows.len(),
            Self::Gains(rows) => rows.len(),
        };
        if outputs == 4 {
            Ok(rows)
        } else {
            Err(Invalid::new(rows.name(), format_args!("{outputs} rows where the four outputs need 4")))
        }
    }

    fn name(&self) -> &'static str {
        match self {
            Self::Poles(_) => "controller.poles",
            Self::Gains(_) => "controller.k",
        }
    }

    fn gains<const R: usize>(&self, output: usize) -> Result<[f64; R], Invalid> {
        let field = || format!("{}[{output}]", self.name());
        match self {
            Self::Poles(rows) => place(&rows[output]).map_err(|error| Invalid::new(field(), error)),
            Self::Gains(rows) => rows[output].as_slice().try_into().map_err(|_| {
                let given = rows[output].len();
                Invalid::new(field(), format_args!("{given} gains where the relative degree needs {R}"))
            }),
        }
    }

    /// The field that a refusal by the controller is about.
    fn locate(&self, error: GainError<f64>) -> Invalid {
        let field = match error {
            GainError::NotHurwitz { output } => format!("{}[{}]", self.name(), output - 1),
            GainError::Integral { output, .. } => format!("controller.k_integral[{}]", output - 1),
            GainError::PoleCount { .. } | GainError::UnstablePole { .. } | GainError::PoleTooFast { .. } => {
                self.name().to_owned()
            }
        };
        Invalid::new(field, error)
    }
}

impl From<PoleField> for Pole<f64> {
    fn from(pole: PoleField) -> Self {
        match pole {
            PoleField::Real(re) => Self::Real(re),
            PoleField::Pair([re, im]) => Self::Pair { re, im },
        }
    }
}
