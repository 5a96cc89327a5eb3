//! One law evaluation for one JSON object: the law, checkable from any other program.
//!
//! The state is taken as it is, without prediction. `"f32"` and `"f64"` are the controller's source
//! in either scalar; the state is converted from the paper's coordinates in f64, then rounded.
//! `"witness"` is the law by Lie derivatives.

use controller::{Disturbance, Gains, Margins, Path, Real, State, TrackGains, Vehicle, VehicleParams, follow, track};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::json::Unique;
use crate::describe::course::{PathSpec, ReferenceSpec, parse_path, parse_reference};
use crate::describe::input::{Invalid, all_within, read, within};
use witness::law::{Evaluation, Operating};
use witness::plant::{self, VehicleParameters};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Request {
    law: LawName,
    arithmetic: Arithmetic,
    vehicle: VehicleFields,
    path: Option<Value>,
    reference: Option<Value>,
    time: Option<f64>,
    x: [f64; 16],
    zeta: [f64; 4],
    #[serde(default)]
    integral: [f64; 3],
    gains: Value,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum LawName {
    Follow,
    Track,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Arithmetic {
    F32,
    F64,
    Witness,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct VehicleFields {
    payload_mass: f64,
    uav_mass: f64,
    rod_length: f64,
    inertia: [f64; 3],
    gravity: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FollowGains {
    k: ([f64; 6], [f64; 6], [f64; 5], [f64; 2]),
    #[serde(default)]
    k_integral: [f64; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TrackGainFields {
    k: ([f64; 6], [f64; 6], [f64; 6], [f64; 2]),
    #[serde(default)]
    k_integral: [f64; 3],
}

/// The answer to one line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Answer {
    /// T, N.
    pub thrust: f64,
    /// The compensator's input, m/s⁶.
    pub u_zeta: f64,
    /// τ in body axes, N·m.
    pub torque: [f64; 3],
    /// Outputs and derivatives: 19 numbers following, 20 tracking.
    pub xi: Vec<f64>,
    /// Wanted highest derivatives.
    pub nu: [f64; 4],
    /// Distances from the singularities.
    pub margins: MarginFields,
    /// b̄, by the witness.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub b: Option<[f64; 4]>,
    /// Ā by rows, by the witness.
    #[serde(rename = "A", skip_serializing_if = "Option::is_none")]
    pub a: Option<[[f64; 4]; 4]>,
}

/// The law's divisors, as in [`Margins`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MarginFields {
    /// q·e3.
    pub q3: f64,
    /// q·b3.
    pub q_b3: f64,
    /// Payload's specific force along the rod, m/s².
    pub lambda: f64,
    /// T/(m_Q L), 1/s².
    pub kappa: f64,
    /// (∇h1 × ∇h2)·ρ; 1 for tracking.
    pub path_det: f64,
}

impl From<Margins<f64>> for MarginFields {
    fn from(margins: Margins<f64>) -> Self {
        let Margins { q3, q_b3, lambda, kappa, path_det, .. } = margins;
        Self { q3, q_b3, lambda, kappa, path_det }
    }
}

/// Evaluates one line of JSON.
///
/// # Errors
/// [`Invalid`] names the field that is missing, unknown, of the wrong form or out of range, or the
/// result that is not finite where the law is singular.
pub fn evaluate(line: &[u8]) -> Result<Answer, Invalid> {
    if line.trim_ascii().is_empty() {
        return Err(Invalid::new("line", "empty"));
    }
    let Unique(value) = serde_json::from_slice(line).map_err(|error| Invalid::new("line", error))?;
    // A list would be read as the fields in their order.
    let objects = ["vehicle", "path", "reference", "gains"];
    let list = objects.into_iter().find(|key| value.get(key).is_some_and(Value::is_array));
    if let Some(field) = list.or_else(|| value.is_array().then_some("line")) {
        return Err(Invalid::new(field, "a list where an object with names is expected"));
    }
    let request: Request = read("", value)?;
    let point = Point::of(&request)?;
    let answer = match (request.law, request.path, request.reference) {
        (LawName::Follow, Some(path), None) => {
            if request.time.is_some() {
                return Err(Invalid::new("time", "the law \"follow\" does not depend on time"));
            }
            let path = parse_path("path", path)?;
            let FollowGains { k: (k1, k2, k3, k4), k_integral } = read("gains", request.gains)?;
            let gains = Gains { k1, k2, k3, k4, integral: k_integral };
            match request.arithmetic {
                Arithmetic::F32 => point.follow::<f32>(&path, &gains)?,
                Arithmetic::F64 => point.follow::<f64>(&path, &gains)?,
                Arithmetic::Witness => point.follow_witness(&path, &gains)?,
            }
        }
        (LawName::Track, None, Some(reference)) => {
            let time =
                request.time.ok_or_else(|| Invalid::new("time", "missing: the law \"track\" depends on it"))?;
            let time = within("time", time, -1e9..=1e9)?;
            let reference = parse_reference("reference", reference)?;
            let TrackGainFields { k: (k1, k2, k3, yaw), k_integral } = read("gains", request.gains)?;
            if k_integral != [0.0; 3] {
                return Err(Invalid::new("gains.k_integral", "the tracking law has no integral action"));
            }
            let gains = TrackGains { position: [k1, k2, k3], yaw };
            match request.arithmetic {
                Arithmetic::F32 => point.track::<f32>(&reference, time, &gains)?,
                Arithmetic::F64 => point.track::<f64>(&reference, time, &gains)?,
                Arithmetic::Witness => point.track_witness(&reference, time, &gains)?,
            }
        }
        (LawName::Follow, None, _) => return Err(Invalid::new("path", "missing: the law \"follow\" takes a path")),
        (LawName::Follow, _, Some(_)) => return Err(Invalid::new("reference", "the law \"follow\" takes a path")),
        (LawName::Track, _, None) => {
            return Err(Invalid::new("reference", "missing: the law \"track\" takes a reference"));
        }
        (LawName::Track, Some(_), _) => return Err(Invalid::new("path", "the law \"track\" takes a reference")),
    };
    finite(answer)
}

/// Where the law is to be evaluated.
struct Point {
    vehicle: VehicleParams<f64>,
    x: [f64; 16],
    zeta: [f64; 4],
    integral: [f64; 3],
}

/// Beyond these, m, rad, and their rates, products overflow binary32, and no vehicle flies.
const STATE_LIMIT: f64 = 1e6;

impl Point {
    fn of(request: &Request) -> Result<Self, Invalid> {
        let VehicleFields { payload_mass, uav_mass, rod_length, inertia, gravity } = request.vehicle;
        let vehicle = VehicleParams { payload_mass, uav_mass, rod_length, inertia, gravity };
        Vehicle::new(vehicle).map_err(|error| Invalid::out_of_range("vehicle", error))?;
        Ok(Self {
            vehicle,
            x: all_within("x", request.x, STATE_LIMIT)?,
            zeta: all_within("zeta", request.zeta, STATE_LIMIT)?,
            integral: all_within("integral", request.integral, STATE_LIMIT)?,
        })
    }

    fn vehicle<T: Real>(&self) -> Result<Vehicle<T>, Invalid> {
        Vehicle::new(self.vehicle.cast()).map_err(|error| Invalid::out_of_range("vehicle", error))
    }

    fn state<T: Real>(&self) -> State<T> {
        State::<f64>::from_paper(&self.x).cast()
    }

    fn follow<T: Real>(&self, path: &PathSpec, gains: &Gains<f64>) -> Result<Answer, Invalid> {
        let mut path = path.build::<T>().map_err(|error| Invalid::out_of_range("path", error))?;
        let state = self.state();
        while !path.search(&state.position) {}
        let solution = follow(
            &self.vehicle()?,
            &mut path,
            &gains.cast(),
            &state,
            &self.zeta.map(T::lit),
            &self.integral.map(T::lit),
            &Disturbance::none(),
        );
        let xi = &solution.xi;
        Ok(answer(&solution, &[&xi.h1, &xi.h2, &xi.h3, &xi.h4]))
    }

    fn track<T: Real>(
        &self,
        reference: &ReferenceSpec,
        time: f64,
        gains: &TrackGains<f64>,
    ) -> Result<Answer, Invalid> {
        let solution = track(
            &self.vehicle()?,
            &gains.cast(),
            &reference.at(time),
            &self.state(),
            &self.zeta.map(T::lit),
            &Disturbance::none(),
        );
        let [p1, p2, p3] = &solution.xi.position;
        Ok(answer(&solution, &[p1, p2, p3, &solution.xi.yaw]))
    }

    fn plant_vehicle(&self) -> VehicleParameters {
        let VehicleParams { payload_mass, uav_mass, rod_length, inertia, gravity } = self.vehicle;
        VehicleParameters { payload_mass, uav_mass, rod_length, inertia, gravity }
    }

    fn follow_witness(&self, path: &PathSpec, gains: &Gains<f64>) -> Result<Answer, Invalid> {
        let vehicle = self.plant_vehicle();
        let at = Operating { vehicle: &vehicle, x: &self.x, zeta: &self.zeta };
        let k = [gains.k1, gains.k2, pad(gains.k3), pad(gains.k4)];
        let evaluation = path.witness(at, &k, &gains.integral, &self.integral);
        let [p1, p2, p3, ..] = self.x;
        self.witnessed(evaluation, path.determinant([p1, p2, p3]))
    }

    fn track_witness(
        &self,
        reference: &ReferenceSpec,
        time: f64,
        gains: &TrackGains<f64>,
    ) -> Result<Answer, Invalid> {
        let vehicle = self.plant_vehicle();
        let at = Operating { vehicle: &vehicle, x: &self.x, zeta: &self.zeta };
        let [k1, k2, k3] = gains.position;
        let ReferenceSpec { radius, p3, rate } = *reference;
        let reference = witness::law::Reference::circle(radius, p3, rate, time);
        self.witnessed(witness::law::track(at, &reference, &[k1, k2, k3, pad(gains.yaw)]), 1.0)
    }

    fn witnessed<const N: usize>(
        &self,
        evaluation: Result<Evaluation<N>, witness::law::Singular>,
        path_det: f64,
    ) -> Result<Answer, Invalid> {
        let evaluation = evaluation.map_err(|error| Invalid::new("x", error))?;
        let [_, _, b3] = plant::attitude(&self.x);
        let q = plant::rod(&self.x);
        Ok(Answer {
            thrust: evaluation.thrust,
            u_zeta: evaluation.u_zeta,
            torque: evaluation.torque,
            xi: evaluation.xi.to_vec(),
            nu: evaluation.nu,
            margins: MarginFields {
                q3: q[2],
                q_b3: witness::jet::dot(q, b3),
                lambda: (self.zeta[0] - self.vehicle.gravity) / q[2],
                kappa: evaluation.thrust / (self.vehicle.uav_mass * self.vehicle.rod_length),
                path_det,
            },
            b: Some(evaluation.b),
            a: Some(evaluation.a),
        })
    }
}

fn pad<const R: usize>(row: [f64; R]) -> [f64; 6] {
    std::array::from_fn(|order| row.get(order).copied().unwrap_or(0.0))
}

fn answer<T: Real, X>(solution: &controller::Solution<T, X>, xi: &[&[T]]) -> Answer {
    let command = solution.command.cast::<f64>();
    Answer {
        thrust: command.thrust,
        u_zeta: solution.u_zeta.to_f64(),
        torque: command.torque.into(),
        xi: xi.iter().copied().flatten().map(|value| value.to_f64()).collect(),
        nu: solution.nu.map(T::to_f64),
        margins: solution.margins.cast().into(),
        b: None,
        a: None,
    }
}

/// The answer, if JSON can hold all its numbers.
fn finite(answer: Answer) -> Result<Answer, Invalid> {
    let MarginFields { q3, q_b3, lambda, kappa, path_det } = answer.margins;
    let scalars = [
        ("thrust", answer.thrust),
        ("u_zeta", answer.u_zeta),
        ("margins.q3", q3),
        ("margins.q_b3", q_b3),
        ("margins.lambda", lambda),
        ("margins.kappa", kappa),
        ("margins.path_det", path_det),
    ];
    let lists = [("torque", answer.torque.as_slice()), ("xi", &answer.xi), ("nu", &answer.nu)];
    let bad =
        scalars.iter().find(|(_, value)| !value.is_finite()).map(|(name, _)| name).or_else(|| {
            lists.iter().find(|(_, list)| !list.iter().all(|value| value.is_finite())).map(|(name, _)| name)
        });
    match bad {
        None => Ok(answer),
        Some(name) => Err(Invalid::new(
            "x",
            format_args!(
                "the law is singular here, {name} is not finite (q3 {q3:e}, q_b3 {q_b3:e}, lambda {lambda:e}, kappa \
                 {kappa:e}, path_det {path_det:e})"
            ),
        )),
    }
}
