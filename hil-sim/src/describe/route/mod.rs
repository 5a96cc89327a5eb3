//! Paths described by a user: a curve of any kind, with a speed and a yaw along it, for the law,
//! the witness and the eye.
//!
//! [`parse_path`] is the one place where a description, from a scenario file or from a line of
//! JSON, becomes a path.
//!
//! `kind` is one of the controller's curves, with the fields that [`Shape::fields`] gives it; or
//! `"fourier"`, with `center`, `cos`, `sin` and `reference` as `hil-sim fit` writes them; or
//! `"implicit"`, with the [formulas](crate::describe::formula) `h1` and `h2`. The yaw of an
//! `"ellipse"` is along the tangent if it is left out. `"bent"` takes `v0` and `v1` for the speed
//! v0 + v1 p1/a, and has the yaw 0.2 p1 if that is left out.
//!
//! `speed` (m/s along ρ) is a number, a formula, or `{ max = 3.0, acceleration = 1.0 }`, slower
//! where the curve bends. `yaw` (rad) is a number (0 if left out), a formula, `"tangent"`, or
//! `{ x = 0.0, y = 0.0 }`, nose to a vertical line. `constants` names numbers for the formulas.

mod curve;
mod fields;
mod profile;
mod witnessed;

pub use curve::{CurveSpec, HARMONICS, Surfaces};
pub use fields::parse_path;
pub use profile::{SpeedSpec, YawSpec};

use controller::Profiled;
use controller::{OutOfRange, Path, Real, Vector3, Vehicle};
use rig::{AnyPath, Shape, parameter};
use std::sync::OnceLock;

use crate::describe::formula::Formula;
use crate::study::check::{self, Lap, Limits, Refusal, Report, Steady};
use witness::law::{Evaluation, Operating, OutputGains, Singular};
use witness::plant::distance_to_circle;

/// A path of any kind, chosen at run time, as the law takes it.
pub type Route<T> = AnyPath<T, Surfaces, Formula, HARMONICS>;

/// A path as described by a user, validated.
#[derive(Clone, Debug)]
pub struct PathSpec {
    /// The curve.
    pub curve: CurveSpec,
    /// v_d.
    pub speed: SpeedSpec,
    /// ψ_d.
    pub yaw: YawSpec,
    /// The curve walked once round, when first asked for.
    lap: OnceLock<Result<Lap, Refusal>>,
}

impl PartialEq for PathSpec {
    fn eq(&self, other: &Self) -> bool {
        (&self.curve, &self.speed, &self.yaw) == (&other.curve, &other.speed, &other.yaw)
    }
}

impl PathSpec {
    /// A path from its parts.
    ///
    /// # Errors
    /// [`OutOfRange`] if the controller refuses a parameter.
    pub fn new(curve: CurveSpec, speed: SpeedSpec, yaw: YawSpec) -> Result<Self, OutOfRange<f64>> {
        let path = Self { curve, speed, yaw, lap: OnceLock::new() };
        path.build::<f64>()?;
        Ok(path)
    }

    /// The path as the law takes it.
    ///
    /// # Errors
    /// [`OutOfRange`] if rounding to `T` takes a parameter out of range.
    pub fn build<T: Real>(&self) -> Result<Route<T>, OutOfRange<T>> {
        Ok(Profiled { curve: self.curve.build()?, speed: self.speed.build()?, yaw: self.yaw.build()? })
    }

    /// Radius (m), p3 (m) and speed (m/s along ρ) of the paper's circle at constant speed.
    #[must_use]
    pub fn circle(&self) -> Option<[f64; 3]> {
        match (self.curve.shape()?, &self.speed) {
            ((Shape::Circle, number), SpeedSpec::Constant(speed)) => {
                Some([number(parameter!("PATH_RADIUS")), number(parameter!("PATH_P3")), *speed])
            }
            _ => None,
        }
    }

    /// The curve walked once round, at the first call.
    ///
    /// # Errors
    /// [`Refusal`] with the place where it is not closed, smooth and regular.
    pub fn lap(&self) -> Result<&Lap, Refusal> {
        let walked = self.lap.get_or_init(|| {
            let mut path = self.searched(self.hint())?;
            let start = check::walk::find(&mut path, self.hint())?;
            check::walk::walk(&mut path, start)
        });
        walked.as_ref().map_err(|refusal| *refusal)
    }

    /// Whether and how it can be flown, see [`check`](mod@check).
    ///
    /// # Errors
    /// [`Refusal`] with the place where it can't.
    pub fn check(&self, vehicle: &Vehicle<f64>, limits: &Limits) -> Result<Report, Refusal> {
        let mut path = self.searched(self.hint())?;
        check::check(&mut path, vehicle, limits, self.hint())
    }

    /// The vehicle's state and ζ at the start of the [lap](Self::lap), with all outputs and their
    /// derivatives zero.
    ///
    /// # Errors
    /// [`Refusal`] if there is no such motion.
    pub fn steady(&self, vehicle: &Vehicle<f64>) -> Result<Steady, Refusal> {
        let place = self.lap()?.at(0.0);
        check::steady_at(&mut self.searched(place.position)?, vehicle, place)
    }

    /// The path in f64, with its nearest point searched for `position`.
    fn searched(&self, position: Vector3<f64>) -> Result<Route<f64>, Refusal> {
        let undefined = || check::Reason::Undefined.at(check::Place { position, arc: 0.0 });
        let mut path = self.build::<f64>().map_err(|_| undefined())?;
        path.search(&position);
        Ok(path)
    }

    /// d_C, m: distance of a point of N from the curve. Of a curve that does not close, at the foot
    /// that is reached from the point; NaN where no curve is found.
    #[must_use]
    pub fn distance(&self, position: [f64; 3]) -> f64 {
        if let Some((Shape::Circle, number)) = self.curve.shape() {
            return distance_to_circle(position, number(parameter!("PATH_RADIUS")), number(parameter!("PATH_P3")));
        }
        match self.lap() {
            Ok(lap) => lap.nearest(position.into()).distance,
            Err(_) => self
                .searched(position.into())
                .ok()
                .and_then(|mut path| check::probe::local_distance(&mut path, position.into()))
                .unwrap_or(f64::NAN),
        }
    }

    /// The curve as `points` + 1 points of N, m, the last equal to the first; `None` where it is
    /// not a curve.
    #[must_use]
    pub fn outline(&self, points: usize) -> Vec<[f64; 3]> {
        let Ok(lap) = self.lap() else { return Vec::new() };
        (0..=points).map(|i| lap.at(lap.length() * i as f64 / points as f64).position.into()).collect()
    }

    /// The path-following law by the witness, for this path's formulas.
    ///
    /// # Errors
    /// [`Singular`] where the law has no value.
    pub fn witness(
        &self,
        at: Operating<'_>,
        gains: &OutputGains,
        integral_gains: &[f64; 3],
        integral: &[f64; 3],
    ) -> Result<Evaluation<19>, Singular> {
        witness::law::follow(at, self, gains, integral_gains, integral)
    }

    /// (∇h1 × ∇h2)·ρ at a point of N, by this path's formulas.
    #[must_use]
    pub fn determinant(&self, position: [f64; 3]) -> f64 {
        use witness::jet::{Dual, cross, dot};
        use witness::law::WitnessPath;
        let [h1, h2] = self.surfaces(std::array::from_fn(|axis| Dual::<f64, 3>::variable(position[axis], axis)));
        let normal = cross(h1.parts, h2.parts);
        self.direction() * dot(normal, normal).sqrt()
    }
}
