//! What is known of the vehicle at a control period: the load's state, and the UAV by its own
//! navigation, from one LOAD_STATE or from MAVLink's own messages beside it.

use controller::{Matrix3, Measured, State, Uav, Vector3};
use link::dialect::{ATTITUDE_QUATERNION_DATA, HIGHRES_IMU_DATA, LOAD_STATE_DATA, LOCAL_POSITION_NED_DATA, LoadSeen};

/// The newest of each of MAVLink's messages counts for so long, s: two of a stream of 10 Hz.
const KEPT_S: f32 = 0.2;
/// How far a quaternion's norm squared may be from 1.
const UNIT: f32 = 0.01;
/// Bits of HIGHRES_IMU.fields_updated for the accelerometer.
const ACCELEROMETER: u16 = 0b111;

/// All that is seen at a control period.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    /// The load's state, if it is one.
    pub state: Option<State<f32>>,
    /// A state has come that is none.
    pub is_bad: bool,
    uav: Option<Uav<f32>>,
    specific_force: Option<Vector3<f32>>,
}

impl Seen {
    /// In a frame.
    pub fn of(frame: &LOAD_STATE_DATA) -> Self {
        let is_none = frame.seen.contains(LoadSeen::LOAD_SEEN_NO_LOAD) || frame.position.iter().all(|p| p.is_nan());
        let state = (!is_none).then(|| link::state_of(frame));
        let is_bad = state.is_some_and(|state| state.check().is_err());
        Self { state, is_bad, uav: link::uav_of(frame), specific_force: link::specific_force_of(frame) }
    }

    /// What can't be used.
    pub fn bad() -> Self {
        Self { is_bad: true, ..Self::default() }
    }

    /// The state, if it is a good one.
    pub fn good(&self) -> Option<&State<f32>> {
        self.state.as_ref().filter(|_| !self.is_bad)
    }

    /// The UAV, if its navigation is a good one.
    pub fn uav(&self) -> Option<&Uav<f32>> {
        self.uav.as_ref().filter(|uav| uav.check().is_ok())
    }

    /// With what `navigation` has where this has nothing.
    pub fn or(self, navigation: &Navigation) -> Self {
        let specific_force = self.specific_force.or_else(|| navigation.specific_force());
        Self { uav: self.uav.or_else(|| navigation.uav()), specific_force, ..self }
    }

    /// For the controller.
    pub fn measured(&self) -> Measured<'_, f32> {
        Measured { state: self.state.as_ref(), uav: self.uav.as_ref(), specific_force: self.specific_force }
    }
}

/// Something that has come, and for how long it has been there, s.
#[derive(Clone, Copy, Debug)]
struct Aged<T>(Option<(T, f32)>);

impl<T: Copy> Aged<T> {
    fn come(&mut self, what: T) {
        self.0 = Some((what, 0.0));
    }

    fn pass(&mut self, period_s: f32) {
        self.0 = self.0.map(|(what, age_s)| (what, age_s + period_s)).filter(|&(_, age_s)| age_s < KEPT_S);
    }
}

/// The UAV's navigation as MAVLink's own messages bring it, each at its own rate.
#[derive(Clone, Copy, Debug)]
pub struct Navigation {
    /// Position, m, and velocity, m/s.
    place: Aged<[Vector3<f32>; 2]>,
    /// Attitude and body rate, rad/s.
    attitude: Aged<(Matrix3<f32>, Vector3<f32>)>,
    specific_force: Aged<Vector3<f32>>,
}

impl Navigation {
    /// Nothing has come.
    pub const fn new() -> Self {
        Self { place: Aged(None), attitude: Aged(None), specific_force: Aged(None) }
    }

    /// LOCAL_POSITION_NED.
    pub fn hear_place(&mut self, message: &LOCAL_POSITION_NED_DATA) {
        let LOCAL_POSITION_NED_DATA { x, y, z, vx, vy, vz, .. } = *message;
        self.place.come([Vector3::new(x, y, z), Vector3::new(vx, vy, vz)]);
    }

    /// ATTITUDE_QUATERNION; one that is no rotation is left out.
    pub fn hear_attitude(&mut self, message: &ATTITUDE_QUATERNION_DATA) {
        let ATTITUDE_QUATERNION_DATA { q1: w, q2: x, q3: y, q4: z, rollspeed, pitchspeed, yawspeed, .. } = *message;
        let squared = w * w + x * x + y * y + z * z;
        if (squared - 1.0).abs() <= UNIT {
            let s = 2.0 / squared;
            let attitude = Matrix3::new(
                1.0 - s * (y * y + z * z),
                s * (x * y - w * z),
                s * (x * z + w * y),
                s * (x * y + w * z),
                1.0 - s * (x * x + z * z),
                s * (y * z - w * x),
                s * (x * z - w * y),
                s * (y * z + w * x),
                1.0 - s * (x * x + y * y),
            );
            self.attitude.come((attitude, Vector3::new(rollspeed, pitchspeed, yawspeed)));
        }
    }

    /// HIGHRES_IMU, where its accelerometer is new.
    pub fn hear_imu(&mut self, message: &HIGHRES_IMU_DATA) {
        if message.fields_updated & ACCELEROMETER == ACCELEROMETER {
            self.specific_force.come(Vector3::new(message.xacc, message.yacc, message.zacc));
        }
    }

    /// A control period goes by.
    pub fn pass(&mut self, period_s: f32) {
        self.place.pass(period_s);
        self.attitude.pass(period_s);
        self.specific_force.pass(period_s);
    }

    /// The UAV now: its last place, moved on at its velocity, and its last attitude.
    fn uav(&self) -> Option<Uav<f32>> {
        let ([position, velocity], age_s) = self.place.0?;
        let ((attitude, body_rate), _) = self.attitude.0?;
        Some(Uav { position: position + velocity * age_s, velocity, attitude, body_rate })
    }

    fn specific_force(&self) -> Option<Vector3<f32>> {
        self.specific_force.0.map(|(force, _)| force)
    }
}
