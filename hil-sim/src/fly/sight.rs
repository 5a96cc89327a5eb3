//! What a law sees through an estimator: instruments, navigation, payload filter, all in the
//! flight's own arithmetic.

use controller::{Command, Matrix3, State, Uav, Vector3};
use estimator::{
    Estimate, Fix, Imu, LoadMeasurement, Motion, Navigation, NavigationParams, OutOfRange, Payload, PayloadParams,
    Validity,
};
use std::collections::VecDeque;

use crate::describe::scenario::{EstimatorSpec, Scenario};
use crate::world::random::Purpose;
use crate::world::sensors::gnss::FixReading;
use crate::world::sensors::mocap::PoseReading;
use crate::world::{Aboard, InstrumentModel, Reading, Seed, World};

/// Motion capture's own word on its accuracy: a little more than its noise, since its frames are
/// not all independent.
const TRUST: f64 = 1.2;

/// An estimator at work in a flight.
pub struct Sight {
    instruments: InstrumentModel,
    navigation: Navigation<f32>,
    payload: Payload<f32>,
    rotors: RotorModel,
    mocap: Option<(f64, f64)>,
    estimate: Option<Estimate<f32>>,
    /// What was seen last.
    reading: Reading,
    /// The rod has been known since it was last lost.
    has_found: bool,
    specific_force: Vector3<f64>,
}

/// Thrust as an autopilot without rotor speeds has it: the command, late and through a first-order
/// lag.
pub struct RotorModel {
    line: VecDeque<f64>,
    given: f64,
    kept: f64,
}

impl RotorModel {
    /// Of the latency and lag that the law of `scenario` is told, after a long time under `thrust`,
    /// N.
    #[must_use]
    pub fn new(scenario: &Scenario, thrust: f64) -> Self {
        let controller = &scenario.controller;
        let periods = (controller.latency_s * controller.rate_hz).round() as usize;
        let kept = if controller.rotor_lag_s > 0.0 {
            libm::exp(-1.0 / (controller.rate_hz * controller.rotor_lag_s))
        } else {
            0.0
        };
        Self { line: std::iter::repeat_n(thrust, periods).collect(), given: thrust, kept }
    }

    /// A period under `thrust`, N: the mean of what the rotors gave at its ends.
    pub fn pass(&mut self, thrust: f64) -> f64 {
        self.line.push_back(thrust);
        let target = self.line.pop_front().unwrap_or(thrust);
        let before = self.given;
        self.given = target + (before - target) * self.kept;
        0.5 * (before + self.given)
    }
}

/// The payload filter of `scenario`, told that the rod hangs, or that the load stands.
///
/// # Errors
/// [`OutOfRange`] for a scenario's number that it refuses.
pub fn payload_filter(spec: &EstimatorSpec, scenario: &Scenario) -> Result<Payload<f32>, OutOfRange<f32>> {
    let period = 1.0 / scenario.controller.rate_hz;
    let [payload_drag, uav_drag] = spec.drags(scenario.environment.air.as_ref());
    let filter = Payload::new(PayloadParams {
        payload_drag,
        uav_drag,
        imu: scenario.sensors.imu.map_or_else(Vector3::zeros, |imu| single(&imu.lever.into())),
        noise: spec.payload_noise(),
        ..PayloadParams::of(&scenario.controller.vehicle.cast(), period as f32)
    })?;
    Ok(if scenario.standing { filter.with_slack_cable() } else { filter })
}

/// Whether the rod is known, by what it is worth now and whether it was known before.
#[must_use]
pub fn is_known(validity: Validity, before: bool) -> bool {
    match validity {
        Validity::Valid => true,
        // A wrong noise figure makes no rod unknown.
        Validity::Inconsistent => before,
        Validity::Converging | Validity::Blind | Validity::Slack => false,
    }
}

impl Sight {
    /// The estimator of `scenario` for a flight that starts at `state` of the body under `hover`
    /// thrust, N. It is told the UAV's motion with errors of a settled navigation, and that the rod
    /// hangs.
    ///
    /// # Errors
    /// [`OutOfRange`] for a scenario's number that the filters refuse.
    pub fn new(
        spec: &EstimatorSpec,
        scenario: &Scenario,
        state: &State<f64>,
        hover: f64,
        seed: Seed,
    ) -> Result<Self, OutOfRange<f32>> {
        let period = 1.0 / scenario.controller.rate_hz;
        let sensors = &scenario.sensors;
        let mut told = seed.stream(Purpose::Told);
        // With a slack cable the UAV is not where the rod ends.
        let (place, velocity) = scenario.bodies.as_ref().map_or_else(
            || {
                let length = scenario.vehicle.rod_length;
                (state.position - state.rod * length, state.velocity - state.rod_rate * length)
            },
            |bodies| (bodies.uav_position, bodies.uav_velocity),
        );
        // A receiver's accuracy, or motion capture's, is what the start is known to.
        let deviation = sensors.gnss.map_or(0.01, |gnss| gnss.position_noise[0].hypot(gnss.slow[0]));
        let turn = told.normals().component_mul(&Vector3::new(0.005, 0.005, 0.05));
        let columns = [0, 1, 2].map(|i| {
            let b: Vector3<f64> = state.attitude.column(i).into();
            let turned = b + turn.cross(&b);
            turned / turned.dot(&turned).sqrt()
        });
        let motion = Motion {
            position: single(&(place + told.normals() * deviation)),
            velocity: single(&(velocity + told.normals() * 0.05)),
            attitude: Matrix3::from_columns(&columns).map(|x| x as f32),
            body_rate: single(&state.body_rate),
            specific_force: Vector3::new(0.0, 0.0, -(scenario.vehicle.gravity as f32)),
        };
        let gravity = scenario.controller.vehicle.gravity as f32;
        let navigation = NavigationParams {
            gravity,
            imu: sensors.imu.map_or_else(Vector3::zeros, |imu| single(&imu.lever.into())),
            antenna: sensors.gnss.map_or_else(Vector3::zeros, |gnss| single(&gnss.lever.into())),
            declination: sensors.magnetometer.map_or(0.0, |magnetometer| magnetometer.declination as f32),
            noise: spec.navigation_noise(),
            ..NavigationParams::every(period as f32)
        };
        Ok(Self {
            instruments: InstrumentModel::new(sensors, period, seed),
            navigation: Navigation::new(navigation, &motion, [(1.5 * deviation) as f32, 0.1])?,
            payload: payload_filter(spec, scenario)?,
            rotors: RotorModel::new(scenario, hover),
            mocap: sensors.mocap.map(|mocap| (mocap.noise * TRUST, mocap.attitude_noise * TRUST)),
            estimate: None,
            reading: (*state).into(),
            has_found: false,
            specific_force: Vector3::zeros(),
        })
    }

    /// What is seen of `world` at the end of a period under `command`: the payload filter's state,
    /// once it is known, and the UAV by navigation.
    pub fn see(&mut self, world: &World, command: &Command<f64>) -> &mut Reading {
        let readings = self.instruments.read(world);
        self.specific_force = readings.imu.specific_force;
        let modelled = self.rotors.pass(command.thrust);
        let imu =
            Imu { body_rate: single(&readings.imu.body_rate), specific_force: single(&readings.imu.specific_force) };
        let motion = self.navigation.step(Some(&imu));
        // A refusal leaves the filter as it was: its health tells.
        if let Some(fix) = &readings.fix {
            let _ = self.navigation.fix(&position_fix(fix));
        }
        if let Some(height) = readings.height {
            let _ = self.navigation.height(height as f32);
        }
        if let Some(field) = &readings.field {
            let _ = self.navigation.magnetic_field(&single(field));
        }
        let thrust = readings.thrust.unwrap_or(modelled) as f32;
        let estimate = self.payload.step(Some(&motion), Some(thrust));
        if let Some(pose) = &readings.pose {
            self.capture(pose);
        }
        self.has_found = is_known(estimate.health.validity, self.has_found);
        let Motion { position, velocity, attitude, body_rate, specific_force } = motion;
        let uav = Uav { position, velocity, attitude, body_rate };
        self.estimate = Some(estimate);
        self.reading = Reading {
            comes: true,
            state: estimate.state.cast(),
            sees_load: self.has_found,
            uav: Some(estimate.beside(&uav).cast()),
            specific_force: Some(specific_force.map(f64::from)),
            aboard: Some(Aboard { readings, motion }),
        };
        &mut self.reading
    }

    fn capture(&mut self, pose: &PoseReading) {
        let Some((deviation, turn)) = self.mocap.map(|(x, r)| (x as f32, r as f32)) else { return };
        let fix = Fix {
            position: Some(single(&pose.position)),
            velocity: None,
            position_accuracy: [deviation; 2],
            velocity_accuracy: [0.0; 2],
            age: pose.age as f32,
        };
        let attitude = pose.attitude.map(|x| x as f32);
        let _ = self.navigation.pose(&fix, Some((&attitude, turn)));
        if let Some(load) = &pose.load {
            let pair = LoadMeasurement::Pair([single(load), single(&pose.position)], deviation);
            self.payload.observe(&pair, pose.age as f32);
        }
    }

    /// The last estimate.
    #[must_use]
    pub fn estimate(&self) -> Option<&Estimate<f32>> {
        self.estimate.as_ref()
    }

    /// The accelerometer's last reading, body axes, m/s².
    #[must_use]
    pub fn specific_force(&self) -> Vector3<f64> {
        self.specific_force
    }

    /// The payload filter.
    #[must_use]
    pub fn payload(&self) -> &Payload<f32> {
        &self.payload
    }

    /// The navigation filter.
    #[must_use]
    pub fn navigation(&self) -> &Navigation<f32> {
        &self.navigation
    }
}

fn single(v: &Vector3<f64>) -> Vector3<f32> {
    v.map(|x| x as f32)
}

fn position_fix(fix: &FixReading) -> Fix<f32> {
    Fix {
        position: Some(single(&fix.position)),
        velocity: Some(single(&fix.velocity)),
        position_accuracy: fix.position_accuracy.map(|x| x as f32),
        velocity_accuracy: fix.velocity_accuracy.map(|x| x as f32),
        age: fix.age as f32,
    }
}
