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
//! v0 + v1 p1/a, and has the yaw 0.2 p1 if that is left out. `"route"` leads through `points`, see
//! [`RouteSpec`].
//!
//! `speed` (m/s along ρ) is a number, a formula, or `{ max = 3.0, acceleration = 1.0 }`, slower
//! where the curve bends. `yaw` (rad) is a number (0 if left out), a formula, `"tangent"`, or
//! `{ x = 0.0, y = 0.0 }`, nose to a vertical line. `constants` names numbers for the formulas.

mod curve;
mod fields;
mod profile;
mod route;
mod witnessed;

pub use curve::{CurveSpec, HARMONICS, Surfaces};
pub use fields::parse_path;
pub use profile::{ProfiledPath, ProfiledSpec, SpeedSpec, YawSpec};
pub use route::{RouteSpec, SharedTable};

use controller::{OutOfRange, Path, Real, Vector3, Vehicle};
use rig::{AnyPath, Shape, parameter};
use std::sync::OnceLock;

use crate::describe::formula::Formula;
use crate::study::check::{self, Lap, Limits, Refusal, Report, Steady};
use witness::law::{Evaluation, Operating, OutputGains, Singular, WitnessPath};
use witness::plant::distance_to_circle;

/// A path of any kind, chosen at run time, as the law takes it.
pub type FlownPath<T> = AnyPath<T, Surfaces, Formula, HARMONICS, SharedTable<T>>;

/// A path as described by a user, validated.
#[derive(Clone, Debug)]
pub struct PathSpec {
    /// What was described.
    pub kind: PathKind,
    /// The path walked once, when first asked for.
    lap: OnceLock<Result<Lap, Refusal>>,
}

/// What a path is.
#[derive(Clone, Debug, PartialEq)]
pub enum PathKind {
    /// A curve with a speed and a yaw.
    Profiled(ProfiledSpec),
    /// A route.
    Route(RouteSpec),
}

impl PartialEq for PathSpec {
    fn eq(&self, other: &Self) -> bool {
        self.kind == other.kind
    }
}

impl Default for PathSpec {
    /// The circle of the parameters' defaults.
    fn default() -> Self {
        let curve = CurveSpec::Numbers(Box::default());
        let profiled = ProfiledSpec { curve, speed: SpeedSpec::Constant(1.0), yaw: YawSpec::Fixed(0.0) };
        Self { kind: PathKind::Profiled(profiled), lap: OnceLock::new() }
    }
}

impl PathSpec {
    /// A path of this kind.
    ///
    /// # Errors
    /// [`OutOfRange`] if the controller refuses a number of it.
    pub fn new(kind: PathKind) -> Result<Self, OutOfRange<f64>> {
        let path = Self { kind, lap: OnceLock::new() };
        path.build::<f64>()?;
        Ok(path)
    }

    /// The path as the law takes it.
    ///
    /// # Errors
    /// [`OutOfRange`] if rounding to `T` takes a parameter out of range.
    pub fn build<T: Real>(&self) -> Result<FlownPath<T>, OutOfRange<T>> {
        Ok(match &self.kind {
            PathKind::Profiled(spec) => AnyPath::Profiled(spec.build()?),
            PathKind::Route(spec) => AnyPath::Route(spec.build()?),
        })
    }

    /// The route, if it is one.
    #[must_use]
    pub fn route(&self) -> Option<&RouteSpec> {
        match &self.kind {
            PathKind::Profiled(_) => None,
            PathKind::Route(route) => Some(route),
        }
    }

    /// The shape of a curve by numbers, with the value of each of its parameters.
    fn shape(&self) -> Option<(Shape, impl Fn(rig::Parameter) -> f64 + '_)> {
        match &self.kind {
            PathKind::Profiled(spec) => spec.curve.shape(),
            PathKind::Route(_) => None,
        }
    }

    /// Radius (m), p3 (m) and speed (m/s along ρ) of the paper's circle at constant speed.
    #[must_use]
    pub fn circle(&self) -> Option<[f64; 3]> {
        match (self.shape()?, &self.kind) {
            ((Shape::Circle, number), PathKind::Profiled(ProfiledSpec { speed: SpeedSpec::Constant(speed), .. })) => {
                Some([number(parameter!("PATH_RADIUS")), number(parameter!("PATH_P3")), *speed])
            }
            _ => None,
        }
    }

    /// The path walked once, a curve round, a route to its end; at the first call.
    ///
    /// # Errors
    /// [`Refusal`] with the place where it is not closed, smooth and regular.
    pub fn lap(&self) -> Result<&Lap, Refusal> {
        let walked = self.lap.get_or_init(|| match &self.kind {
            PathKind::Profiled(spec) => {
                let mut path = self.searched(spec.hint())?;
                let start = check::walk::find(&mut path, spec.hint())?;
                check::walk::walk(&mut path, start)
            }
            PathKind::Route(spec) => check::route::walk(&mut spec.built()?, spec.waypoints(), spec.is_closed()),
        });
        walked.as_ref().map_err(|refusal| *refusal)
    }

    /// Whether and how it can be flown, see [`check`](mod@check).
    ///
    /// # Errors
    /// [`Refusal`] with the place where it can't.
    pub fn check(&self, vehicle: &Vehicle<f64>, limits: &Limits) -> Result<Report, Refusal> {
        match &self.kind {
            PathKind::Profiled(spec) => {
                let lap = self.lap()?.clone();
                check::check(&mut self.searched(spec.hint())?, lap, vehicle, limits)
            }
            PathKind::Route(spec) => {
                check::route::check(&mut spec.built()?, spec.waypoints(), spec.is_closed(), vehicle, limits)
            }
        }
    }

    /// The vehicle's state and ζ at the start of the [lap](Self::lap), with all outputs and their
    /// derivatives zero; where the path is a route that starts from a stop, at rest there.
    ///
    /// # Errors
    /// [`Refusal`] if there is no such motion.
    pub fn steady(&self, vehicle: &Vehicle<f64>) -> Result<Steady, Refusal> {
        let lap = self.lap()?;
        let place = lap.at(0.0);
        let mut path = self.searched(place.position)?;
        if self.route().is_some_and(RouteSpec::starts_at_rest) {
            return check::rest_at(&mut path, vehicle, place);
        }
        check::steady_at(&mut path, vehicle, place)
    }

    /// The path in f64, with its nearest point searched for `position`.
    fn searched(&self, position: Vector3<f64>) -> Result<FlownPath<f64>, Refusal> {
        let mut path = self.build::<f64>().map_err(|_| undefined(position))?;
        while !path.search(&position) {}
        Ok(path)
    }

    /// d_C, m: distance of a point of N from the curve. Of a curve that does not close, at the foot
    /// that is reached from the point; NaN where no curve is found.
    #[must_use]
    pub fn distance(&self, position: [f64; 3]) -> f64 {
        if let Some((Shape::Circle, number)) = self.shape() {
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

    /// The curve as `points` + 1 points of N, m, the last of a closed one equal to the first; none
    /// where it is not a curve.
    #[must_use]
    pub fn outline(&self, points: usize) -> Vec<[f64; 3]> {
        let Ok(lap) = self.lap() else { return Vec::new() };
        let last = if lap.is_closed() { lap.at(0.0) } else { lap.at(lap.length()) };
        let along = (0..points).map(|i| lap.at(lap.length() * i as f64 / points as f64));
        along.chain([last]).map(|place| place.position.into()).collect()
    }

    /// The path-following law by the witness, for this path's own formulas or splines.
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
        let [p1, p2, p3, ..] = *at.x;
        match &self.kind {
            PathKind::Profiled(spec) => witness::law::follow(at, spec, gains, integral_gains, integral),
            PathKind::Route(spec) => {
                witness::law::follow(at, &spec.witness([p1, p2, p3]), gains, integral_gains, integral)
            }
        }
    }

    /// (∇h1 × ∇h2)·ρ at a point of N, by this path's own formulas or splines.
    #[must_use]
    pub fn determinant(&self, position: [f64; 3]) -> f64 {
        match &self.kind {
            PathKind::Profiled(spec) => determinant(spec, position),
            PathKind::Route(spec) => determinant(&spec.witness(position), position),
        }
    }
}

fn undefined(position: Vector3<f64>) -> Refusal {
    check::Reason::Undefined.at(check::Place::of_curve(position, 0.0))
}

fn determinant(path: &impl WitnessPath, position: [f64; 3]) -> f64 {
    use witness::jet::{Dual, cross, dot};
    let [h1, h2] = path.surfaces(std::array::from_fn(|axis| Dual::<f64, 3>::variable(position[axis], axis)));
    dot(cross(h1.parts, h2.parts), path.tangent(position))
}
