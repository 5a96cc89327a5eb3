//! The load's state from what the UAV itself measures, where nothing that sees the load sends it.
//!
//! ```text
//! LOCAL_POSITION_NED, ATTITUDE_QUATERNION, or ODOMETRY ────────┐
//! HIGHRES_IMU ──┬──────────────────────────────────────────────┼─▶ payload filter ──▶ state, if it is valid
//! GPS_* ────────┴──▶ navigation filter, where EST_LOAD says so ┘         ▲
//!                                                  thrust, by the law's model of the rotors
//! ```
//!
//! A state that is not valid is none: the supervisor then holds, takes off or lands by the UAV
//! alone, and follows again when the rod is known.

mod own;
pub mod params;

use controller::{State, Uav, Vector3};
use estimator::{Motion, OutOfRange, Payload, Validity};

use crate::seen::Navigation;
use crate::settings::Settings;
use own::Own;

/// Where the UAV's motion is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Somebody else's navigation.
    Messages,
    /// The navigation filter here.
    Sensors,
}

/// Why the load's state is not known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unseen {
    /// No message of the UAV's navigation.
    Navigation,
    /// No IMU.
    Imu,
    /// No fix for `EST_FIX_T`, or none yet.
    Fix,
    /// No heading to begin with: neither a magnetic field nor a receiver's.
    Heading,
    /// The payload filter does not know the rod.
    Rod(Validity),
}

/// What is known of both bodies.
#[derive(Clone, Debug)]
pub struct Found {
    pub state: State<f32>,
    pub uav: Uav<f32>,
    pub specific_force: Vector3<f32>,
    /// Why the state is not to be followed on.
    pub unseen: Option<Unseen>,
}

/// Without a fix for so long, s, somebody has to be told: no receiver is slower than 1 Hz.
const LATE_S: f32 = 1.5;

/// The estimator at work.
#[derive(Clone, Debug)]
pub struct Estimator {
    payload: Payload<f32>,
    /// None behind somebody else's.
    own: Option<Own>,
    /// What the rotors gave at the last period's end, N.
    thrust: Option<f32>,
}

impl Estimator {
    /// The estimator that `settings` describe, if they do.
    ///
    /// # Errors
    /// A number that the filters refuse.
    pub fn new(settings: &Settings) -> Result<Option<Self>, OutOfRange<f32>> {
        let Some(source) = params::source(settings) else { return Ok(None) };
        let payload = Payload::new(params::payload(settings)?)?;
        let own = (source == Source::Sensors).then(|| Own::new(settings)).transpose()?;
        Ok(Some(Self { payload, own, thrust: None }))
    }

    /// Looks for the load anew, which is hanging or, before a take-off, standing.
    ///
    /// # Errors
    /// As [`new`](Self::new); nothing has changed.
    pub fn restart(&mut self, settings: &Settings, is_standing: bool) -> Result<(), OutOfRange<f32>> {
        let payload = Payload::new(params::payload(settings)?)?;
        self.payload = if is_standing { payload.with_slack_cable() } else { payload };
        self.thrust = None;
        Ok(())
    }

    /// Fixes are what it goes by, and are missing: position drifts.
    pub fn misses_fix(&self) -> bool {
        self.own.as_ref().is_some_and(|own| own.fix_age_s() > LATE_S)
    }

    /// A control period, at whose end the rotors give `thrust`, N, if they turn.
    ///
    /// # Errors
    /// Why not even the UAV's motion is known.
    pub fn step(
        &mut self,
        settings: &Settings,
        navigation: &mut Navigation,
        thrust: Option<f32>,
    ) -> Result<Found, Unseen> {
        let mean = thrust.map(|now| 0.5 * (self.thrust.unwrap_or(now) + now));
        self.thrust = thrust;
        let moves = match &mut self.own {
            Some(own) => own.step(settings, navigation).map(|motion| (uav_of(&motion), Some(motion))),
            None => navigation.uav().map(|uav| (uav, navigation.motion())).ok_or(Unseen::Navigation),
        };
        let motion = moves.as_ref().ok().and_then(|(_, motion)| motion.as_ref());
        let estimate = self.payload.step(motion, mean);
        let (uav, motion) = moves?;
        let unseen = match estimate.health.validity {
            Validity::Valid => None,
            Validity::Blind => Some(Unseen::Imu),
            validity => Some(Unseen::Rod(validity)),
        };
        let specific_force = motion.map_or_else(Vector3::zeros, |motion| motion.specific_force);
        Ok(Found { state: estimate.state, uav: estimate.beside(&uav), specific_force, unseen })
    }
}

fn uav_of(motion: &Motion<f32>) -> Uav<f32> {
    let Motion { position, velocity, attitude, body_rate, .. } = *motion;
    Uav { position, velocity, attitude, body_rate }
}
