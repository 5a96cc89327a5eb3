//! The sensors behind navigation as MAVLink's own messages bring them: IMU, magnetometer and
//! pressure by HIGHRES_IMU, a satellite receiver by GPS_INPUT or GPS_RAW_INT.

use crate::mission::DEGREES;
use controller::{Real, Vector3};
use estimator::Fix;
use link::Home;
use link::dialect::{GPS_INPUT_DATA, GPS_RAW_INT_DATA, HIGHRES_IMU_DATA};

/// Bits of HIGHRES_IMU.fields_updated.
const ACCELEROMETER: u16 = 0b111;
const GYRO: u16 = 0b111 << 3;
const FIELD: u16 = 0b111 << 6;
const HEIGHT: u16 = 1 << 11;
/// Bits of GPS_INPUT.ignore_flags.
const NO_ALTITUDE: u16 = 1;
const NO_VELOCITY: u16 = 8 | 16;
const NO_SPEED_ACCURACY: u16 = 32;
const NO_ACCURACY: u16 = 64 | 128;
/// The least fix that has three dimensions.
const THREE_DIMENSIONS: u8 = 3;
/// Accuracy of a receiver that does not state it, horizontal and down, m and m/s: a plain one's.
const UNSTATED_M: [f32; 2] = [1.0, 1.6];
const UNSTATED_M_S: [f32; 2] = [0.1, 0.16];
/// Field and height are passed on no sooner than so long after the last, s: some parts of their
/// errors hardly change from one reading to the next, so that more readings would add nothing.
const APART_S: f32 = 0.04;
/// 10⁻⁷ degrees, rad.
const UNIT: f32 = 1.745_329_3e-9;
/// WGS 84: the equator's radius, m, and the square of the eccentricity.
const RADIUS_M: f32 = 6_378_137.0;
const ECCENTRICITY: f32 = 6.694_38e-3;

/// What the IMU said in a control period.
#[derive(Clone, Copy, Debug)]
pub struct Inertial {
    /// The newest, rad/s, where the gyro is new.
    pub body_rate: Option<Vector3<f32>>,
    /// Mean of the period, m/s².
    pub specific_force: Vector3<f32>,
}

/// Where N has its origin: at home, or where none was told at the first fix.
#[derive(Clone, Copy, Debug)]
struct Origin {
    latitude: i32,
    longitude: i32,
    altitude_m: f32,
    /// Metres for a unit of latitude and of longitude.
    scale: [f32; 2],
    /// How much meridians draw together a metre north, 1/m.
    bend: f32,
}

impl Origin {
    /// At a latitude and longitude in units, m above the sea.
    fn new(latitude: i32, longitude: i32, altitude_m: f32) -> Self {
        let (sin, cos) = Real::sin_cos(latitude as f32 * UNIT);
        let short = 1.0 - ECCENTRICITY * sin * sin;
        let across = RADIUS_M / Real::sqrt(short);
        let along = across * (1.0 - ECCENTRICITY) / short + altitude_m;
        let across = across + altitude_m;
        Self {
            latitude,
            longitude,
            altitude_m,
            scale: [along * UNIT, across * cos * UNIT],
            bend: sin / (cos * across),
        }
    }

    /// In N, m: what [`Home::place`] makes of it there, to the second order of the distance.
    fn local(&self, latitude: i32, longitude: i32, altitude_m: f32) -> Vector3<f32> {
        let turn = 3_600_000_000_i64;
        let east = (i64::from(longitude) - i64::from(self.longitude) + turn / 2).rem_euclid(turn) - turn / 2;
        let north = i64::from(latitude) - i64::from(self.latitude);
        let [per_north, per_east] = self.scale;
        let north = north as f32 * per_north;
        let east = east as f32 * per_east * (1.0 - self.bend * north);
        Vector3::new(north + 0.5 * self.bend * east * east, east, self.altitude_m - altitude_m)
    }
}

/// What has come and was not taken yet.
#[derive(Clone, Debug)]
pub struct Instruments {
    /// Sum and number of the accelerometer's readings.
    force: Vector3<f32>,
    readings: u16,
    body_rate: Option<Vector3<f32>>,
    fix: Option<Fix<f32>>,
    /// From n1 toward n2, rad.
    heading: Option<f32>,
    field: Option<Vector3<f32>>,
    height: Option<f32>,
    since_slow_s: f32,
    origin: Option<Origin>,
    /// Stamps of the last IMU and fix that were taken, µs.
    stamps: [u64; 2],
}

impl Instruments {
    pub const fn new() -> Self {
        Self {
            force: Vector3::new(0.0, 0.0, 0.0),
            readings: 0,
            body_rate: None,
            fix: None,
            heading: None,
            field: None,
            height: None,
            since_slow_s: 0.0,
            origin: None,
            stamps: [0; 2],
        }
    }

    /// N has its origin at `home` from now on.
    pub fn set_home(&mut self, home: &Home) {
        let [latitude, longitude] = [home.latitude, home.longitude].map(|degrees| libm::round(degrees * 1e7) as i32);
        self.origin = Some(Origin::new(latitude, longitude, home.altitude as f32));
        self.fix = None;
    }

    /// Where N has its origin: at home, or else at the first fix.
    pub fn origin(&self) -> Option<Home> {
        let Origin { latitude, longitude, altitude_m, .. } = self.origin?;
        let [latitude, longitude] = [latitude, longitude].map(|steps| f64::from(steps) * DEGREES);
        Some(Home { latitude, longitude, altitude: altitude_m.into() })
    }

    /// HIGHRES_IMU. Returns the specific force, if it is new.
    pub fn hear_imu(&mut self, message: &HIGHRES_IMU_DATA) -> Option<Vector3<f32>> {
        let [newest, _] = &mut self.stamps;
        if is_again(newest, message.time_usec) {
            return None;
        }
        let has = |bits: u16| message.fields_updated & bits == bits;
        if has(GYRO) {
            self.body_rate = Some(Vector3::new(message.xgyro, message.ygyro, message.zgyro));
        }
        if has(FIELD) {
            self.field = Some(Vector3::new(message.xmag, message.ymag, message.zmag));
        }
        if has(HEIGHT) {
            self.height = Some(message.pressure_alt);
        }
        let specific_force = Vector3::new(message.xacc, message.yacc, message.zacc);
        has(ACCELEROMETER).then(|| {
            self.force += specific_force;
            self.readings = self.readings.saturating_add(1);
            specific_force
        })
    }

    /// GPS_INPUT: a receiver's solution with its velocity and accuracies.
    pub fn hear_gps_input(&mut self, message: &GPS_INPUT_DATA) {
        let has = |bits: u16| message.ignore_flags & bits == 0;
        if message.fix_type < THREE_DIMENSIONS || !has(NO_ALTITUDE) || !is_latitude(message.lat) {
            return;
        }
        let [_, newest] = &mut self.stamps;
        if is_again(newest, message.time_usec) {
            return;
        }
        let both = |stated: [f32; 2], bits, unstated| if has(bits) { stated } else { unstated };
        let speed = message.speed_accuracy;
        self.fix = Some(Fix {
            position: Some(self.place(message.lat, message.lon, message.alt)),
            velocity: has(NO_VELOCITY).then(|| Vector3::new(message.vn, message.ve, message.vd)),
            position_accuracy: both([message.horiz_accuracy, message.vert_accuracy], NO_ACCURACY, UNSTATED_M),
            velocity_accuracy: both([speed; 2], NO_SPEED_ACCURACY, UNSTATED_M_S),
            age: 0.0,
        });
        self.hear_yaw(message.yaw);
    }

    /// GPS_RAW_INT: the same without a velocity, of which it has two components only.
    pub fn hear_gps_raw(&mut self, message: &GPS_RAW_INT_DATA) {
        if message.fix_type < THREE_DIMENSIONS || !is_latitude(message.lat) {
            return;
        }
        let [_, newest] = &mut self.stamps;
        if is_again(newest, message.time_usec) {
            return;
        }
        let stated = [message.h_acc, message.v_acc];
        let position_accuracy = if stated == [0; 2] { UNSTATED_M } else { stated.map(|mm| mm as f32 * 1e-3) };
        self.fix = Some(Fix {
            position: Some(self.place(message.lat, message.lon, message.alt as f32 * 1e-3)),
            velocity: None,
            position_accuracy,
            velocity_accuracy: UNSTATED_M_S,
            age: 0.0,
        });
        self.hear_yaw(message.yaw);
    }

    /// Hundredths of a degree; 0 where there is none, and 65535 where there might be one.
    fn hear_yaw(&mut self, yaw: u16) {
        if (1..=36_000).contains(&yaw) {
            self.heading = Some(f32::from(yaw) * (100_000.0 * UNIT));
        }
    }

    /// In N, m. Where no home was told, the first place is the origin.
    fn place(&mut self, latitude: i32, longitude: i32, altitude_m: f32) -> Vector3<f32> {
        let origin = self.origin.get_or_insert_with(|| Origin::new(latitude, longitude, altitude_m));
        origin.local(latitude, longitude, altitude_m)
    }

    /// What the IMU said since the last call, if it said anything.
    pub fn take_inertial(&mut self) -> Option<Inertial> {
        let (force, readings) = (self.force, self.readings);
        (self.force, self.readings) = (Vector3::zeros(), 0);
        let body_rate = self.body_rate.take();
        (readings > 0).then(|| Inertial { body_rate, specific_force: force * (1.0 / f32::from(readings)) })
    }

    /// The receiver's fix since the last call.
    pub fn take_fix(&mut self) -> Option<Fix<f32>> {
        self.fix.take()
    }

    /// The receiver's heading since the last call, rad.
    pub fn take_heading(&mut self) -> Option<f32> {
        self.heading.take()
    }

    /// The magnetic field in body axes and the height by pressure, m, up, once in a while.
    pub fn take_slow(&mut self, period_s: f32) -> (Option<Vector3<f32>>, Option<f32>) {
        self.since_slow_s += period_s;
        if self.since_slow_s < APART_S {
            return (None, None);
        }
        self.since_slow_s = 0.0;
        (self.field.take(), self.height.take())
    }
}

/// Whether a message has the stamp of the last one, as one that a line brings twice does; of 0 there
/// is none.
fn is_again(newest: &mut u64, stamp: u64) -> bool {
    stamp != 0 && core::mem::replace(newest, stamp) == stamp
}

fn is_latitude(latitude: i32) -> bool {
    (-900_000_000..=900_000_000).contains(&latitude)
}
