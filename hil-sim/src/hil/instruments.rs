//! What is aboard of a scenario's vehicle as MAVLink's messages, for a flight program that finds
//! navigation and load by itself.
//!
//! | `estimator.navigation` | `EST_LOAD` | messages |
//! |---|---|---|
//! | `"own"` | 2 | HIGHRES_IMU each period, GPS_INPUT with each fix |
//! | `"other"` | 1 | HIGHRES_IMU each period, LOCAL_POSITION_NED at 50 Hz, ATTITUDE_QUATERNION at 100 Hz |
//!
//! They are stamped by the clock of the states that drive the steps; a fix with its own time.
//! GPS_INPUT counts latitude and longitude in 10⁻⁷ degrees: 11 mm north, and east as much less as
//! the cosine of the latitude says.

use autopilot::Settings;
use controller::Vector3;
use estimator::{Drag, Motion, NavigationNoise};
use link::dialect::*;
use link::{Home, MavMessage};

use super::HilError;
use crate::describe::scenario::{EstimatorSpec, NavigationSource, RodStart, Scenario};
use crate::world::multibody::quaternion;
use crate::world::sensors::gnss::{FixReading, Solution};
use crate::world::{Aboard, Readings, Timing};

/// Bits of HIGHRES_IMU.fields_updated: accelerometer and gyro; the magnetic field; the altitude.
const INERTIAL: u16 = 0b11_1111;
const FIELD: u16 = 0b111 << 6;
const HEIGHT: u16 = 1 << 11;
/// Bits of GPS_INPUT.ignore_flags: no dilutions of precision.
const NO_DILUTION: u16 = 2 | 4;
/// Satellites are not simulated.
const UNKNOWN: u8 = u8::MAX;
/// Of another's navigation, Hz.
const PLACES_HZ: f64 = 50.0;
const ATTITUDES_HZ: f64 = 100.0;

/// A vehicle's instruments on their way to the flight program.
#[derive(Clone, Debug)]
pub struct Instruments {
    navigation: NavigationSource,
    home: Home,
    /// Periods from one place to the next, and from one attitude to the next.
    every: [u64; 2],
    period_s: f64,
    /// Another's navigation a period ago: a message takes its time, and the program carries what it
    /// hears over a period.
    motion: Option<Motion<f32>>,
}

impl Instruments {
    /// Those of `scenario` about `home`, if it flies on an estimate, with what the flight program
    /// is to be told of them put into `settings`.
    ///
    /// # Errors
    /// What can't be had there.
    pub fn of(scenario: &Scenario, home: Home, settings: &mut Settings) -> Result<Option<Self>, HilError> {
        let Some(spec) = &scenario.estimator else { return Ok(None) };
        refuse(spec, scenario).map_err(|why| HilError::Unsupported(why.to_owned()))?;
        for (name, value) in told(spec, scenario) {
            let refused = |refused| HilError::Unsupported(format!("{name}: {refused}"));
            settings.set_by_name(name, value as f32).map_err(refused)?;
        }
        let rate_hz = scenario.controller.rate_hz;
        Ok(Some(Self {
            navigation: spec.navigation,
            home,
            every: [PLACES_HZ, ATTITUDES_HZ].map(|hz| ((rate_hz / hz).round() as u64).max(1)),
            period_s: 1.0 / rate_hz,
            motion: None,
        }))
    }

    /// What is said in the period that ends at `t_s`, `time_usec` of the states' clock.
    pub fn say(&mut self, Aboard { readings, motion }: &Aboard, t_s: f64, time_usec: u64) -> Vec<MavMessage> {
        let mut said = vec![highres_imu(readings, time_usec)];
        match self.navigation {
            NavigationSource::Own => said.extend(readings.fix.map(|fix| gps_input(&fix, &self.home, time_usec))),
            NavigationSource::Other => {
                let before = self.motion.replace(*motion).unwrap_or(*motion);
                let step = (t_s / self.period_s).round() as u64;
                let ms = (time_usec / 1000) as u32;
                let all = [local_position(&before, ms), attitude(&before, ms)];
                let due = all.into_iter().zip(self.every).filter(|(_, every)| step.is_multiple_of(*every));
                said.extend(due.map(|(message, _)| message));
            }
        }
        said
    }
}

/// Why the flight program can't be told `scenario`.
fn refuse(spec: &EstimatorSpec, scenario: &Scenario) -> Result<(), &'static str> {
    let sensors = &scenario.sensors;
    let Timing { missed, state_every, .. } = scenario.timing;
    let is_own = spec.navigation == NavigationSource::Own;
    let why = match () {
        () if is_own && !scenario.standing => {
            "estimator.navigation = \"own\": navigation begins at rest, with initial.standing = true"
        }
        () if is_own && sensors.gnss.is_none() => "estimator.navigation = \"own\": it needs [sensors.gnss]",
        () if is_own && sensors.magnetometer.is_none() => {
            "estimator.navigation = \"own\": it needs a heading to begin with, from [sensors.magnetometer]"
        }
        () if is_own && sensors.mocap.is_some() => {
            "sensors.mocap: the target's own navigation goes by a receiver; estimator.navigation = \"other\" by this"
        }
        () if sensors.mocap.is_some_and(|mocap| mocap.load) => {
            "sensors.mocap.load: no message brings a place of the load to an estimator"
        }
        () if sensors.esc.is_some() => "sensors.esc: no message brings the rotors' speeds to an estimator",
        () if spec.start != RodStart::default() => "estimator.start: the target has a start of its own",
        () if scenario.obstacle.is_some() => "obstacle: instruments feel a hand that stops the vehicle",
        () if missed > 0.0 || state_every > 1 => "timing: no state is sent that could be missed",
        () => return Ok(()),
    };
    Err(why)
}

/// The parameters by name.
fn told(spec: &EstimatorSpec, scenario: &Scenario) -> Vec<(&'static str, f64)> {
    let sensors = &scenario.sensors;
    let [payload, uav] = spec.drags::<f64>(scenario.environment.air.as_ref());
    let per_area = Drag::<f64>::of_area(1.0).quadratic;
    let [imu, antenna] =
        [sensors.imu.map_or([0.0; 3], |imu| imu.lever), sensors.gnss.map_or([0.0; 3], |gnss| gnss.lever)];
    let [across, down] = NavigationNoise::<f64>::default().position;
    vec![
        ("EST_LOAD", if spec.navigation == NavigationSource::Own { 2.0 } else { 1.0 }),
        ("EST_CDA_LOAD", payload.quadratic / per_area),
        ("EST_CDA_UAV", uav.quadratic / per_area),
        ("EST_ROTOR_DRAG", uav.linear),
        ("EST_IMU_X", imu[0]),
        ("EST_IMU_Y", imu[1]),
        ("EST_IMU_Z", imu[2]),
        ("EST_ANT_X", antenna[0]),
        ("EST_ANT_Y", antenna[1]),
        ("EST_ANT_Z", antenna[2]),
        ("EST_ACC_N", spec.accelerometer_noise),
        ("EST_NOISE", spec.noise),
        ("EST_RESIDUAL", spec.residual),
        ("EST_LATERAL", spec.lateral),
        ("EST_WIND", spec.wind),
        ("EST_OFFSET", spec.offset),
        ("EST_FIX_H", across),
        ("EST_FIX_V", down),
        ("EST_FIX_AGE", sensors.gnss.map_or(0.0, |gnss| gnss.delay_s)),
        ("EST_DECL", sensors.magnetometer.map_or(0.0, |magnetometer| magnetometer.declination)),
    ]
}

fn highres_imu(readings: &Readings, time_usec: u64) -> MavMessage {
    let [force, rate] = [readings.imu.specific_force, readings.imu.body_rate].map(|v| v.map(|x| x as f32));
    let field = readings.field.map_or_else(Vector3::zeros, |field| field.map(|x| x as f32));
    let is_new = |is_new: bool, bits: u16| if is_new { bits } else { 0 };
    MavMessage::HIGHRES_IMU(HIGHRES_IMU_DATA {
        time_usec,
        xacc: force.x,
        yacc: force.y,
        zacc: force.z,
        xgyro: rate.x,
        ygyro: rate.y,
        zgyro: rate.z,
        xmag: field.x,
        ymag: field.y,
        zmag: field.z,
        pressure_alt: readings.height.unwrap_or_default() as f32,
        fields_updated: INERTIAL
            | is_new(readings.field.is_some(), FIELD)
            | is_new(readings.height.is_some(), HEIGHT),
        ..HIGHRES_IMU_DATA::DEFAULT
    })
}

fn gps_input(fix: &FixReading, home: &Home, time_usec: u64) -> MavMessage {
    let [lat, lon] = home.place([fix.position.x, fix.position.y].map(|n| n as f32));
    let age_usec = (fix.age * 1e6).round() as u64;
    let [horiz_accuracy, vert_accuracy] = fix.position_accuracy.map(|m| m as f32);
    MavMessage::GPS_INPUT(GPS_INPUT_DATA {
        // 0 would be no time.
        time_usec: time_usec.saturating_sub(age_usec).max(1),
        ignore_flags: NO_DILUTION,
        fix_type: match fix.solution {
            Solution::Plain => 3,
            Solution::Float => 5,
            Solution::Fixed => 6,
        },
        lat,
        lon,
        alt: (home.altitude - fix.position.z) as f32,
        vn: fix.velocity.x as f32,
        ve: fix.velocity.y as f32,
        vd: fix.velocity.z as f32,
        speed_accuracy: fix.velocity_accuracy[0] as f32,
        horiz_accuracy,
        vert_accuracy,
        satellites_visible: UNKNOWN,
        ..GPS_INPUT_DATA::DEFAULT
    })
}

fn local_position(motion: &Motion<f32>, time_boot_ms: u32) -> MavMessage {
    let Motion { position, velocity, .. } = motion;
    MavMessage::LOCAL_POSITION_NED(LOCAL_POSITION_NED_DATA {
        time_boot_ms,
        x: position.x,
        y: position.y,
        z: position.z,
        vx: velocity.x,
        vy: velocity.y,
        vz: velocity.z,
    })
}

fn attitude(motion: &Motion<f32>, time_boot_ms: u32) -> MavMessage {
    let [q1, q2, q3, q4] = quaternion(&motion.attitude.map(f64::from)).map(|part| part as f32);
    MavMessage::ATTITUDE_QUATERNION(ATTITUDE_QUATERNION_DATA {
        time_boot_ms,
        q1,
        q2,
        q3,
        q4,
        rollspeed: motion.body_rate.x,
        pitchspeed: motion.body_rate.y,
        yawspeed: motion.body_rate.z,
        ..ATTITUDE_QUATERNION_DATA::DEFAULT
    })
}
