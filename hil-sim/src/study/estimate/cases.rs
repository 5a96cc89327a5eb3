//! The cases of `hil-sim estimate`: what flies, in what air, and what the filters are told wrong.

use crate::describe::course::PathSpec;
use crate::describe::scenario::{Law, Scenario, ScenarioError};
use crate::world::random::Stream;
use crate::world::sensors::gnss::{Gnss, GnssPart};
use crate::world::sensors::mocap::Mocap;
use crate::world::{Air, Gusts, Window};

/// One case.
pub struct Case {
    /// Its name in tables and files.
    pub name: &'static str,
    /// What it is.
    pub title: &'static str,
    /// The path.
    pub course: Course,
    /// Mean wind with its gusts, m/s.
    pub wind: f64,
    /// The rod's angle at the start, rad; drawn within 0.2 if left out.
    pub rod: Option<f64>,
    /// Makes the rest so.
    pub apply: fn(&mut Scenario, &mut Stream),
}

/// Where it flies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    /// A level circle at 1 m/s, yaw 0.
    Slow,
    /// The same at 2.5 m/s.
    Fast,
    /// A circle inclined by 20°, yaw along it.
    Climbing,
}

/// The disturbed cases' wind, m/s.
const WIND: f64 = 5.0;

const fn case(name: &'static str, title: &'static str, apply: fn(&mut Scenario, &mut Stream)) -> Case {
    Case { name, title, course: Course::Slow, wind: WIND, rod: None, apply }
}

/// All cases, in the order of the table.
pub const CASES: &[Case] = &[
    Case { wind: 0.0, ..case("full-state-calm", "the state itself, calm", |s, _| s.estimator = None) },
    case("full-state-gusts", "the state itself, gusts of 5 m/s", |s, _| s.estimator = None),
    Case { wind: 0.0, ..case("mocap-calm", "motion capture of UAV and load, calm", mocap) },
    Case { wind: 0.0, ..case("rtk-calm", "RTK, calm, 1 m/s", |_, _| {}) },
    Case { wind: 0.0, course: Course::Fast, ..case("rtk-calm-2.5", "RTK, calm, 2.5 m/s", |_, _| {}) },
    Case { wind: 0.0, course: Course::Climbing, ..case("rtk-calm-climbing", "RTK, calm, climbing", |_, _| {}) },
    case("rtk-gusts", "RTK, gusts of 5 m/s, 1 m/s", |_, _| {}),
    Case { course: Course::Fast, ..case("rtk-gusts-2.5", "RTK, gusts, 2.5 m/s", |_, _| {}) },
    Case { course: Course::Climbing, ..case("rtk-gusts-climbing", "RTK, gusts, climbing", |_, _| {}) },
    case("mass-0.25", "0.25 kg told 0.5, gusts", |s, _| s.vehicle.payload_mass = 0.25),
    case("mass-0.75", "0.75 kg told 0.5, gusts", |s, _| s.vehicle.payload_mass = 0.75),
    case("mass-1.5", "1.5 kg told 0.5, gusts", |s, _| s.vehicle.payload_mass = 1.5),
    case("thrust-0.9", "90 % of the thrust, gusts", |s, _| s.actuators.thrust_scale = 0.9),
    case("thrust-1.1", "110 % of the thrust, gusts", |s, _| s.actuators.thrust_scale = 1.1),
    Case { rod: Some(40.0), ..case("rod-start-40", "rod at 40° at the start, told 0, gusts", |_, _| {}) },
    Case { rod: Some(60.0), ..case("rod-start-60", "rod at 60° at the start, told 0, gusts", |_, _| {}) },
    case("noise-times-3", "every noise figure told three times too large, gusts", |s, _| told_noise(s, 3.0)),
    case("noise-over-3", "every noise figure told three times too small, gusts", |s, _| told_noise(s, 1.0 / 3.0)),
    case("vibration-lines", "rotors' lines of 3 and 1 m/s² on the accelerometer, gusts", vibration),
    case("drag-wrong-25", "drag of both bodies told 25 % wrong, either way, gusts", |s, r| told_drag(s, r, 1.25)),
    case("drag-wrong-2", "drag of both bodies told wrong by two, either way, gusts", |s, r| told_drag(s, r, 2.0)),
    case("everything-wrong", "mass, thrust, cable, drag, lag, delay, biases, vibration, gusts", everything),
    case("gnss-out-2s", "no fix for 2 s, gusts", |s, _| drop_out(s, 2.0)),
    case("gnss-out-5s", "no fix for 5 s, gusts", |s, _| drop_out(s, 5.0)),
    case("gnss-plain", "a receiver without corrections, gusts", |s, _| {
        s.sensors.gnss = Some(Gnss::of(GnssPart::Plain));
    }),
];

impl Case {
    /// `base` as this case has it.
    ///
    /// # Errors
    /// [`ScenarioError`] never: a test makes every case.
    pub fn scenario(&self, base: &Scenario, random: &mut Stream) -> Result<Scenario, ScenarioError> {
        let mut scenario = base.clone();
        let angle = random.uniform(0.0, std::f64::consts::TAU);
        if self.wind > 0.0 {
            let wind = [self.wind * libm::cos(angle), self.wind * libm::sin(angle), 0.0];
            let gusts = Some(Gusts { speed_at_6m: self.wind, height: 10.0 });
            scenario.environment.air = Some(Air { wind, gusts, ..Air::default() });
        }
        if let Some(path) = self.course.path()?
            && let Law::Follow { path: flown, .. } = &mut scenario.controller.law
        {
            *flown = path;
        }
        (self.apply)(&mut scenario, random);
        Ok(scenario)
    }
}

impl Course {
    /// Its path where that is not the base's.
    fn path(self) -> Result<Option<PathSpec>, ScenarioError> {
        let text = match self {
            Self::Slow => return Ok(None),
            Self::Fast => include_str!("../../../scenarios/estimate-fast.toml"),
            Self::Climbing => include_str!("../../../scenarios/estimate-climbing.toml"),
        };
        let scenario = Scenario::parse("hil-sim/scenarios/estimate-*.toml", text)?;
        Ok(match scenario.controller.law {
            Law::Follow { path, .. } => Some(path),
            Law::Track { .. } => None,
        })
    }
}

fn mocap(scenario: &mut Scenario, _: &mut Stream) {
    scenario.sensors.gnss = None;
    scenario.sensors.magnetometer = None;
    scenario.sensors.barometer = None;
    scenario.sensors.mocap = Some(Mocap::default());
}

fn told_noise(scenario: &mut Scenario, factor: f64) {
    if let Some(estimator) = &mut scenario.estimator {
        estimator.noise = factor;
    }
}

fn told_drag(scenario: &mut Scenario, random: &mut Stream, factor: f64) {
    let air = scenario.environment.air.unwrap_or_default();
    let mut wrong = |area: f64| Some(if random.unit() < 0.5 { area * factor } else { area / factor });
    if let Some(estimator) = &mut scenario.estimator {
        estimator.payload_drag_area = wrong(air.payload_drag_area);
        estimator.uav_drag_area = wrong(air.uav_drag_area);
    }
}

fn vibration(scenario: &mut Scenario, _: &mut Stream) {
    if let Some(imu) = &mut scenario.sensors.imu {
        imu.vibration = [3.0, 1.0];
    }
}

fn drop_out(scenario: &mut Scenario, for_s: f64) {
    if let Some(gnss) = &mut scenario.sensors.gnss {
        gnss.drop_out = Some(Window { at_s: 0.85 * scenario.duration_s, for_s });
    }
}

fn everything(scenario: &mut Scenario, random: &mut Stream) {
    scenario.vehicle.payload_mass = 0.7;
    scenario.vehicle.rod_length *= 1.01;
    scenario.actuators.thrust_scale = 0.92;
    scenario.actuators.lag_s = 0.04;
    told_drag(scenario, random, 1.4);
    if let Some(imu) = &mut scenario.sensors.imu {
        imu.accelerometer_bias = 0.1;
        imu.scale = 0.005;
        imu.misalignment = 0.017;
        imu.vibration = [3.0, 1.0];
    }
    if let Some(gnss) = &mut scenario.sensors.gnss {
        gnss.untold_delay_s = 0.02;
    }
}
