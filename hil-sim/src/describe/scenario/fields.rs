//! The fields of a scenario file, and their way into a validated [`Scenario`].

use controller::{ActuatorLimits, ObserverParams, State, Vector3, VehicleParams};
use rig::Parameters;
use serde::Deserialize;
use std::collections::BTreeMap;

use super::gains::{self, GainFields, PoleField};
use super::requests::{AskedFields, requests};
use super::{ControllerSpec, EstimatorSpec, Law, Obstacle, Scenario, steady};
use crate::describe::course::{RouteSpec, parse_path, parse_reference};
use crate::describe::input::{Invalid, all_within, read, within};
use crate::describe::parameters::set_named;
use crate::study::check::{Fence, Limits};
use crate::world::{Actuators, Bodies, Cable, Environment, Ground, Sensors, Timing};
use witness::plant::VehicleParameters;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScenarioFields {
    #[serde(default)]
    title: String,
    figure: Option<String>,
    #[serde(default)]
    vehicle: VehicleFields,
    #[serde(default)]
    controller: ControllerFields,
    path: Option<toml::Value>,
    reference: Option<toml::Value>,
    initial: Option<toml::Value>,
    obstacle: Option<ObstacleFields>,
    #[serde(default)]
    request: Vec<AskedFields>,
    cable: Option<Cable>,
    ground: Option<Ground>,
    #[serde(default)]
    environment: Environment,
    #[serde(default)]
    sensors: Sensors,
    #[serde(default)]
    actuators: Actuators,
    #[serde(default)]
    timing: Timing,
    estimator: Option<EstimatorSpec>,
    #[serde(default)]
    seed: u64,
    #[serde(default)]
    run: u64,
    #[serde(default)]
    take_over: bool,
    ground_p3: Option<f64>,
    limits: Option<toml::Value>,
    fence: Option<Fence>,
    #[serde(default = "ten_seconds")]
    duration_s: f64,
    #[serde(default = "four")]
    substeps: u32,
    #[serde(default = "ten_milliseconds")]
    log_period_s: f64,
    steady_from_s: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
struct ControllerFields {
    law: Option<LawName>,
    rate_hz: f64,
    look_ahead: bool,
    poles: Option<Vec<Vec<PoleField>>>,
    k: Option<Vec<Vec<f64>>>,
    k_integral: [f64; 3],
    zeta: Option<[f64; 4]>,
    vehicle: VehicleFields,
    latency_s: f64,
    rotor_lag_s: f64,
    rate_loop_s: Option<[f64; 3]>,
    observer: ObserverFields,
    limits: Option<LimitFields>,
    supervised: Option<bool>,
    parameters: BTreeMap<String, f64>,
}

impl Default for ControllerFields {
    /// The paper's law at 1 kHz.
    fn default() -> Self {
        Self {
            law: None,
            rate_hz: 1000.0,
            look_ahead: true,
            poles: None,
            k: None,
            k_integral: [0.0; 3],
            zeta: None,
            vehicle: VehicleFields::default(),
            latency_s: 0.0,
            rotor_lag_s: 0.0,
            rate_loop_s: None,
            observer: ObserverFields::default(),
            limits: None,
            supervised: None,
            parameters: BTreeMap::new(),
        }
    }
}

/// Bandwidths, rad/s.
#[derive(Clone, Copy, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct ObserverFields {
    payload: f64,
    along: f64,
    cable_stiffness: f64,
    rod: f64,
    torque: f64,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct LimitFields {
    thrust: [f64; 2],
    torque: [f64; 3],
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum LawName {
    Follow,
    Track,
}

/// Parameters that differ from the default.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct VehicleFields {
    payload_mass: Option<f64>,
    uav_mass: Option<f64>,
    rod_length: Option<f64>,
    inertia: Option<[f64; 3]>,
    gravity: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct InitialFields {
    position: Option<[f64; 3]>,
    #[serde(default)]
    alpha: f64,
    #[serde(default)]
    beta: f64,
    #[serde(default)]
    phi: f64,
    #[serde(default)]
    theta: f64,
    #[serde(default)]
    psi: f64,
    #[serde(default)]
    velocity: [f64; 3],
    #[serde(default)]
    alpha_dot: f64,
    #[serde(default)]
    beta_dot: f64,
    body_rate: Option<[f64; 3]>,
    euler_rates: Option<[f64; 3]>,
    uav_position: Option<[f64; 3]>,
    #[serde(default)]
    uav_velocity: [f64; 3],
    #[serde(default)]
    standing: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ObstacleFields {
    at_s: f64,
    #[serde(default)]
    hold_s: f64,
}

fn four() -> u32 {
    4
}
fn ten_milliseconds() -> f64 {
    0.01
}
/// As Fig. 3's flights.
fn ten_seconds() -> f64 {
    10.0
}

/// Longest flight, s.
const DURATION_LIMIT: f64 = 1e5;

/// Reads and validates the scenario `name`.
pub(super) fn scenario(name: &str, table: toml::Table) -> Result<Scenario, Invalid> {
    let fields: ScenarioFields = read("", table)?;

    let table_one = VehicleParameters::default();
    let vehicle = fields.vehicle.over("vehicle", &table_one)?;
    let told = fields.controller.vehicle.over("controller.vehicle", &vehicle)?;
    let duration_s = within("duration_s", fields.duration_s, 0.01..=DURATION_LIMIT)?;
    let rate_hz = within("controller.rate_hz", fields.controller.rate_hz, 5.0..=10_000.0)?;
    let law = law(&fields.controller, fields.path, fields.reference)?;
    fields.cable.map_or(Ok(()), |cable| cable.check("cable"))?;
    fields.fence.as_ref().map_or(Ok(()), |fence| fence.check("fence"))?;
    fields.ground.map_or(Ok(()), |ground| ground.check("ground"))?;
    fields.environment.check("environment")?;
    fields.sensors.check("sensors", 1.0 / rate_hz)?;
    fields.actuators.check("actuators")?;
    fields.timing.check("timing")?;
    fields.estimator.map_or(Ok(()), |estimator| estimator.check("estimator"))?;
    let rate_loop_s = rate_loop(fields.controller.rate_loop_s, &fields.actuators)?;
    let params = vehicle_params(&vehicle);
    let flown = controller::Vehicle::new(params).map_err(|error| Invalid::out_of_range("vehicle", error))?;
    let (mut bodies, mut standing) = (None, false);
    let (initial, zeta) = match fields.initial {
        None => (initial("initial", &InitialFields::default())?, [0.0; 4]),
        Some(toml::Value::String(word)) if word == "steady" => steady(&law, &vehicle, &flown)?,
        Some(toml::Value::Table(table)) => {
            let given: InitialFields = read("initial", table)?;
            let x = initial("initial", &given)?;
            standing = given.standing;
            bodies = apart("initial", &given, &x, &vehicle, fields.cable, fields.ground)?;
            (x, [0.0; 4])
        }
        Some(_) => return Err(Invalid::new("initial", "neither \"steady\" nor a table of coordinates")),
    };
    let zeta = fields.controller.zeta.unwrap_or(zeta);
    let lands = law.route().is_some_and(RouteSpec::lands);
    if lands && fields.ground.is_none() {
        return Err(Invalid::new("path.end", "\"land\" needs a [ground] to land on"));
    }
    let mut limits = match fields.limits {
        Some(value) => Limits::read("limits", value, &flown)?,
        None => Limits::of(&flown),
    };
    let told_limits = fields.controller.limits.map_or(Ok(ActuatorLimits::none()), LimitFields::limits)?;
    // Whatever is allowed, no more can be had.
    limits.thrust[1] = limits.thrust[1].min(fields.actuators.most_thrust(told_limits.max_thrust));
    let obstacle = fields
        .obstacle
        .map(|obstacle| {
            let at_s = within("obstacle.at_s", obstacle.at_s, 0.0..=duration_s)?;
            let hold_s = within("obstacle.hold_s", obstacle.hold_s, 0.0..=duration_s - at_s)?;
            Ok(Obstacle { at_s, hold_s })
        })
        .transpose()?;
    let requests = requests(fields.request, duration_s)?;
    let parameters: Vec<(String, f64)> = fields.controller.parameters.into_iter().collect();
    set_named("controller.parameters", &parameters, &mut Parameters::default())?;
    let steady_from_s =
        fields.steady_from_s.map(|from| within("steady_from_s", from, 0.0..=duration_s)).transpose()?;

    Ok(Scenario {
        name: name.to_owned(),
        title: fields.title,
        figure: fields.figure,
        controller: ControllerSpec {
            law,
            vehicle: vehicle_params(&told),
            rate_hz,
            look_ahead: fields.controller.look_ahead,
            zeta: all_within("controller.zeta", zeta, 1e4)?,
            latency_s: within("controller.latency_s", fields.controller.latency_s, 0.0..=0.5)?,
            rotor_lag_s: within("controller.rotor_lag_s", fields.controller.rotor_lag_s, 0.0..=0.5)?,
            rate_loop_s,
            observer: fields.controller.observer.params()?,
            limits: told_limits,
            supervised: fields
                .controller
                .supervised
                .unwrap_or(lands || !(requests.is_empty() && parameters.is_empty())),
            parameters,
        },
        vehicle,
        initial,
        bodies,
        standing,
        requests,
        obstacle,
        cable: fields.cable,
        ground: fields.ground,
        environment: fields.environment,
        sensors: fields.sensors,
        actuators: fields.actuators,
        timing: fields.timing,
        estimator: fields.estimator,
        seed: fields.seed,
        run: fields.run,
        take_over: fields.take_over,
        ground_p3: fields.ground_p3.map(|p3| within("ground_p3", p3, -1e5..=1e5)).transpose()?,
        limits,
        fence: fields.fence,
        duration_s,
        substeps: within("substeps", fields.substeps, 1..=1000)?,
        log_period_s: within("log_period_s", fields.log_period_s, 1e-4..=duration_s)?,
        steady_from_s,
    })
}

fn vehicle_params(vehicle: &VehicleParameters) -> VehicleParams<f64> {
    let VehicleParameters { payload_mass, uav_mass, rod_length, inertia, gravity } = *vehicle;
    VehicleParams { payload_mass, uav_mass, rod_length, inertia, gravity }
}

/// State and ζ of the motion on the course itself.
fn steady(
    law: &Law,
    vehicle: &VehicleParameters,
    flown: &controller::Vehicle<f64>,
) -> Result<([f64; 16], [f64; 4]), Invalid> {
    if let Some([radius, p3, speed]) = law.circle() {
        return Ok((steady::on_circle(vehicle, radius, p3, speed), [0.0; 4]));
    }
    match law {
        Law::Follow { path, .. } => {
            let steady = path.steady(flown).map_err(|refusal| Invalid::new("initial", refusal))?;
            Ok((steady.state.to_paper(), steady.zeta))
        }
        Law::Track { .. } => Err(Invalid::new("initial", "\"steady\" is known for paths and circles only")),
    }
}

fn law(
    controller: &ControllerFields,
    path: Option<toml::Value>,
    reference: Option<toml::Value>,
) -> Result<Law, Invalid> {
    let gains =
        GainFields { poles: controller.poles.clone(), k: controller.k.clone(), integral: controller.k_integral };
    let named = match (controller.law, &reference) {
        (Some(law), _) => law,
        (None, Some(_)) if path.is_none() => LawName::Track,
        (None, _) => LawName::Follow,
    };
    match (named, path, reference) {
        (LawName::Follow, path, None) => {
            let path = parse_path("path", path.unwrap_or_else(|| circle("speed", -5.0)))?;
            Ok(Law::Follow { path, gains: gains::follow(gains)? })
        }
        (LawName::Track, None, reference) => {
            let reference = parse_reference("reference", reference.unwrap_or_else(|| circle("rate", 1.0)))?;
            Ok(Law::Track { reference, gains: gains::track(gains)? })
        }
        (LawName::Follow, _, Some(_)) => Err(Invalid::new("reference", "the law \"follow\" takes a path")),
        (LawName::Track, Some(_), _) => Err(Invalid::new("path", "the law \"track\" takes a reference")),
    }
}

/// The paper's circle, flown at this `speed` or `rate`: clockwise as seen from above in Fig. 3.
fn circle(motion: &str, value: f64) -> toml::Value {
    let numbers = [("radius", 5.0), ("p3", -10.0), (motion, value)];
    let mut table = toml::Table::from_iter(numbers.map(|(name, number)| (name.to_owned(), number.into())));
    table.insert("kind".to_owned(), "circle".into());
    table.into()
}

impl ObserverFields {
    fn params(self) -> Result<ObserverParams<f64>, Invalid> {
        let bandwidth = |name: &str, value| within(&format!("controller.observer.{name}"), value, 0.0..=100.0);
        Ok(ObserverParams {
            payload_bandwidth: bandwidth("payload", self.payload)?,
            along_bandwidth: bandwidth("along", self.along)?,
            cable_stiffness: within("controller.observer.cable_stiffness", self.cable_stiffness, 0.0..=1e8)?,
            rod_bandwidth: bandwidth("rod", self.rod)?,
            torque_bandwidth: bandwidth("torque", self.torque)?,
            ..ObserverParams::off()
        })
    }
}

impl LimitFields {
    fn limits(self) -> Result<ActuatorLimits<f64>, Invalid> {
        let [min_thrust, max_thrust] = self.thrust;
        within("controller.limits.thrust[0]", min_thrust, 0.0..=1e6)?;
        within("controller.limits.thrust[1]", max_thrust, min_thrust..=1e6)?;
        for (axis, limit) in self.torque.into_iter().enumerate() {
            within(&format!("controller.limits.torque[{axis}]"), limit, 0.0..=1e6)?;
        }
        Ok(ActuatorLimits { min_thrust, max_thrust, max_torque: self.torque })
    }
}

impl VehicleFields {
    /// `base` with what the file gives, checked by the controller's own ranges.
    fn over(&self, at: &str, base: &VehicleParameters) -> Result<VehicleParameters, Invalid> {
        let params = VehicleParams {
            payload_mass: self.payload_mass.unwrap_or(base.payload_mass),
            uav_mass: self.uav_mass.unwrap_or(base.uav_mass),
            rod_length: self.rod_length.unwrap_or(base.rod_length),
            inertia: self.inertia.unwrap_or(base.inertia),
            gravity: self.gravity.unwrap_or(base.gravity),
        };
        controller::Vehicle::new(params).map_err(|error| Invalid::out_of_range(at, error))?;
        let VehicleParams { payload_mass, uav_mass, rod_length, inertia, gravity } = params;
        Ok(VehicleParameters { payload_mass, uav_mass, rod_length, inertia, gravity })
    }
}

/// The paper's 16 coordinates. The chart of (1) ends at cos β = 0 and cos φ = 0.
/// What the law is told of the loop that the vehicle has: its own time constants, if nothing else.
fn rate_loop(told: Option<[f64; 3]>, actuators: &Actuators) -> Result<Option<[f64; 3]>, Invalid> {
    let at = "controller.rate_loop_s";
    match (actuators.rate_loop, told) {
        (None, None) => Ok(None),
        (None, Some(_)) => Err(Invalid::new(at, "there is no [actuators.rate_loop] to give setpoints to")),
        (Some(rate_loop), told) => {
            let times = told.unwrap_or(rate_loop.time_constant_s);
            for (axis, time) in times.into_iter().enumerate() {
                within(&format!("{at}[{axis}]"), time, 0.0..=5.0)?;
            }
            Ok(Some(times))
        }
    }
}

fn initial(at: &str, fields: &InitialFields) -> Result<[f64; 16], Invalid> {
    let field = |name: &str| format!("{at}.{name}");
    let angle = |name: &str, value, limit: f64| within(&field(name), value, -limit..=limit);
    let turn = std::f64::consts::PI;
    // Just short of a right angle.
    let chart = 1.57;
    let alpha = angle("alpha", fields.alpha, turn)?;
    let beta = angle("beta", fields.beta, chart)?;
    let phi = angle("phi", fields.phi, chart)?;
    let theta = angle("theta", fields.theta, turn)?;
    let psi = angle("psi", fields.psi, turn)?;
    let alpha_dot = angle("alpha_dot", fields.alpha_dot, 1e3)?;
    let beta_dot = angle("beta_dot", fields.beta_dot, 1e3)?;
    // Fig. 3 starts here.
    let [p1, p2, p3] = all_within(&field("position"), fields.position.unwrap_or([0.0, 9.0, -10.0]), 1e5)?;
    let [v1, v2, v3] = all_within(&field("velocity"), fields.velocity, 1e3)?;
    let [o1, o2, o3] = match (fields.body_rate, fields.euler_rates) {
        (Some(_), Some(_)) => {
            return Err(Invalid::new(field("euler_rates"), "give either body_rate or euler_rates"));
        }
        (Some(rate), None) => all_within(&field("body_rate"), rate, 1e3)?,
        (None, rates) => body_rate(phi, psi, all_within(&field("euler_rates"), rates.unwrap_or_default(), 1e3)?),
    };
    Ok([p1, p2, p3, alpha, beta, phi, theta, psi, v1, v2, v3, alpha_dot, beta_dot, o1, o2, o3])
}

/// Both bodies, where the UAV's place is given: the cable may be slack.
fn apart(
    at: &str,
    fields: &InitialFields,
    x: &[f64; 16],
    vehicle: &VehicleParameters,
    cable: Option<Cable>,
    ground: Option<Ground>,
) -> Result<Option<Bodies>, Invalid> {
    let invalid = |field: &str, message: &str| Invalid::new(format!("{at}.{field}"), message);
    let uav_velocity = all_within(&format!("{at}.uav_velocity"), fields.uav_velocity, 1e3)?;
    let Some(uav_position) = fields.uav_position else {
        let missing = || invalid("standing", "needs initial.uav_position: where the UAV stands beside the payload");
        return if fields.standing { Err(missing()) } else { Ok(None) };
    };
    if cable.is_none() && ground.is_none() {
        return Err(invalid("uav_position", "needs a [cable] or [ground]: a rod says where the UAV is"));
    }
    let state = State::from_paper(x);
    let mut bodies = Bodies {
        uav_position: all_within(&format!("{at}.uav_position"), uav_position, 1e5)?.into(),
        uav_velocity: uav_velocity.into(),
        ..Bodies::on_rod(&state, vehicle.rod_length)
    };
    if fields.standing {
        let ground = ground.ok_or_else(|| invalid("standing", "needs a [ground] to stand on"))?;
        [bodies.position.z, bodies.uav_position.z] = ground.standing(&bodies.position, &bodies.uav_position);
    }
    let hook = Vector3::from(cable.unwrap_or_default().hook);
    let apart = bodies.position - bodies.uav_position - bodies.attitude * hook;
    let length = apart.dot(&apart).sqrt();
    let (most, holds) = (vehicle.rod_length * (1.0 + 1e-9), cable.is_none_or(|cable| cable.hooked.is_none()));
    if holds && cable.is_none_or(|cable| cable.ea.is_none()) && length > most {
        let message = format!("{length:.3} m from hook to payload on a cable of {} m", vehicle.rod_length);
        return Err(invalid("uav_position", &message));
    }
    Ok(Some(bodies))
}

/// ω = W⁻¹ (φ̇, θ̇, ψ̇), in body axes: the rates about Rz(ψ)ᵀ e1, Rz(ψ)ᵀ Rx(φ)ᵀ e2 and e3.
fn body_rate(phi: f64, psi: f64, [phi_dot, theta_dot, psi_dot]: [f64; 3]) -> [f64; 3] {
    let (sin_phi, cos_phi) = phi.sin_cos();
    let (sin_psi, cos_psi) = psi.sin_cos();
    [
        cos_psi * phi_dot + sin_psi * cos_phi * theta_dot,
        -sin_psi * phi_dot + cos_psi * cos_phi * theta_dot,
        psi_dot - sin_phi * theta_dot,
    ]
}

#[cfg(test)]
mod tests {
    #[test]
    fn body_rate_of_the_papers_initial_state_is_the_reference_one() {
        // fig5_int_vd1 of the reference trajectories: φ = 10°, ψ = 40°, (φ̇, θ̇, ψ̇) = (0, 0.1,
        // −0.2).
        let omega = super::body_rate(10_f64.to_radians(), 40_f64.to_radians(), [0.0, 0.1, -0.2]);
        let reference = [0.0633022221559489, 0.07544065067354891, -0.21736481776669306];
        for (computed, wanted) in omega.iter().zip(reference) {
            assert!((computed - wanted).abs() < 1e-15, "{computed} against {wanted}");
        }
    }
}
