//! The UAV's own navigation as MAVLink's own messages bring it, each at its own rate.

use controller::{Matrix3, Real, Uav, Vector3};
use estimator::Motion;
use link::dialect::{ATTITUDE_QUATERNION_DATA, HIGHRES_IMU_DATA, LOCAL_POSITION_NED_DATA, ODOMETRY_DATA};

use super::instruments::{Inertial, Instruments};

/// The newest of each of MAVLink's messages counts for so long, s: two of a stream of 10 Hz.
const KEPT_S: f32 = 0.2;
/// How far a quaternion's norm squared may be from 1.
const UNIT: f32 = 0.01;
/// Frames of ODOMETRY: N, and the two names of the body's.
const LOCAL_NED: u8 = 1;
const BODY: [u8; 2] = [8, 12];

/// Something that has come, and for how long it has been there, s.
#[derive(Clone, Copy, Debug)]
struct Aged<T>(Option<(T, f32)>);

impl<T: Copy> Aged<T> {
    fn come(&mut self, what: T) {
        self.0 = Some((what, 0.0));
    }

    fn now(&self) -> Option<T> {
        self.0.map(|(what, _)| what)
    }

    /// Goes on by `onward` over a period.
    fn pass(&mut self, period_s: f32, onward: impl Fn(T) -> T) {
        self.0 = self.0.map(|(what, age_s)| (onward(what), age_s + period_s)).filter(|&(_, age_s)| age_s < KEPT_S);
    }
}

/// What has come of the UAV.
#[derive(Clone, Debug)]
pub struct Navigation {
    /// Position, m, and velocity, m/s.
    place: Aged<[Vector3<f32>; 2]>,
    /// Attitude and body rate, rad/s.
    attitude: Aged<(Matrix3<f32>, Vector3<f32>)>,
    specific_force: Aged<Vector3<f32>>,
    /// Of the last control period.
    inertial: Option<Inertial>,
    instruments: Instruments,
}

impl Navigation {
    /// Nothing has come.
    pub const fn new() -> Self {
        Self {
            place: Aged(None),
            attitude: Aged(None),
            specific_force: Aged(None),
            inertial: None,
            instruments: Instruments::new(),
        }
    }

    /// LOCAL_POSITION_NED.
    pub fn hear_place(&mut self, message: &LOCAL_POSITION_NED_DATA) {
        let LOCAL_POSITION_NED_DATA { x, y, z, vx, vy, vz, .. } = *message;
        self.place.come([Vector3::new(x, y, z), Vector3::new(vx, vy, vz)]);
    }

    /// ATTITUDE_QUATERNION; one that is no rotation is left out.
    pub fn hear_attitude(&mut self, message: &ATTITUDE_QUATERNION_DATA) {
        let ATTITUDE_QUATERNION_DATA { q1, q2, q3, q4, rollspeed, pitchspeed, yawspeed, .. } = *message;
        if let Some(attitude) = rotation([q1, q2, q3, q4]) {
            self.attitude.come((attitude, Vector3::new(rollspeed, pitchspeed, yawspeed)));
        }
    }

    /// ODOMETRY, which is both; one in another frame than N is left out.
    pub fn hear_odometry(&mut self, message: &ODOMETRY_DATA) {
        let ODOMETRY_DATA { x, y, z, q, vx, vy, vz, rollspeed, pitchspeed, yawspeed, .. } = *message;
        let Some(attitude) = rotation(q).filter(|_| message.frame_id == LOCAL_NED) else { return };
        let velocity = Vector3::new(vx, vy, vz);
        let velocity = match message.child_frame_id {
            LOCAL_NED => velocity,
            child if BODY.contains(&child) => attitude * velocity,
            _ => return,
        };
        self.place.come([Vector3::new(x, y, z), velocity]);
        self.attitude.come((attitude, Vector3::new(rollspeed, pitchspeed, yawspeed)));
    }

    /// HIGHRES_IMU, of which counts what is new.
    pub fn hear_imu(&mut self, message: &HIGHRES_IMU_DATA) {
        if let Some(specific_force) = self.instruments.hear_imu(message) {
            self.specific_force.come(specific_force);
        }
    }

    /// The sensors behind navigation.
    pub fn instruments_mut(&mut self) -> &mut Instruments {
        &mut self.instruments
    }

    /// A control period goes by, in which the UAV moves on as the IMU says, or else as it moved.
    pub fn pass(&mut self, period_s: f32, gravity: f32) {
        self.inertial = self.instruments.take_inertial();
        let attitude = self.attitude.now();
        let acceleration = match (&self.inertial, attitude) {
            (Some(inertial), Some((attitude, _))) => {
                attitude * inertial.specific_force + Vector3::new(0.0, 0.0, gravity)
            }
            _ => Vector3::zeros(),
        };
        let gained = acceleration * period_s;
        self.place.pass(period_s, |[position, velocity]| {
            [position + (velocity + gained * 0.5) * period_s, velocity + gained]
        });
        let measured = self.inertial.and_then(|inertial| inertial.body_rate);
        self.attitude.pass(period_s, |(attitude, body_rate)| {
            let body_rate = measured.unwrap_or(body_rate);
            (turned(&attitude, &(body_rate * period_s)), body_rate)
        });
        self.specific_force.pass(period_s, |force| force);
    }

    /// The UAV now.
    pub fn uav(&self) -> Option<Uav<f32>> {
        let [position, velocity] = self.place.now()?;
        let (attitude, body_rate) = self.attitude.now()?;
        Some(Uav { position, velocity, attitude, body_rate })
    }

    /// The accelerometer's newest reading, m/s².
    pub fn specific_force(&self) -> Option<Vector3<f32>> {
        self.specific_force.now()
    }

    /// What the IMU said in the last control period.
    pub fn inertial(&self) -> Option<Inertial> {
        self.inertial
    }

    /// The UAV with its specific force of the last control period, if there was one.
    pub fn motion(&self) -> Option<Motion<f32>> {
        let Uav { position, velocity, attitude, body_rate } = self.uav()?;
        let specific_force = self.inertial?.specific_force;
        Some(Motion { position, velocity, attitude, body_rate, specific_force })
    }
}

/// Of a quaternion w, x, y, z, if it is one.
fn rotation([w, x, y, z]: [f32; 4]) -> Option<Matrix3<f32>> {
    let squared = w * w + x * x + y * y + z * z;
    if (squared - 1.0).abs() > UNIT || squared.is_nan() {
        return None;
    }
    let s = 2.0 / squared;
    Some(Matrix3::new(
        1.0 - s * (y * y + z * z),
        s * (x * y - w * z),
        s * (x * z + w * y),
        s * (x * y + w * z),
        1.0 - s * (x * x + z * z),
        s * (y * z - w * x),
        s * (x * z - w * y),
        s * (y * z + w * x),
        1.0 - s * (x * x + y * y),
    ))
}

/// R Exp(φ) by the Cayley map, a rotation for any φ.
fn turned(attitude: &Matrix3<f32>, angle: &Vector3<f32>) -> Matrix3<f32> {
    let (x, y, z) = (0.5 * angle.x, 0.5 * angle.y, 0.5 * angle.z);
    let norm = Real::sqrt(1.0 + x * x + y * y + z * z);
    rotation([1.0, x, y, z].map(|part| part / norm)).map_or(*attitude, |turn| attitude * turn)
}
