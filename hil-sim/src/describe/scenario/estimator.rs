//! `[estimator]`: what the filters are told.
//!
//! ```toml
//! [estimator]
//! payload_drag_area = 0.01   # C_d A, m²; those of [environment.air] if left out
//! uav_drag_area = 0.05
//! uav_rotor_drag = 0.0       # N·s/m
//! noise = 1.0                # every noise figure times this
//! accelerometer_noise = 0.015
//! residual = 0.04            # m/s², specific force on the load that drag doesn't explain
//! lateral = 0.05             # m/s², error of the thrust model across its axis, over 40 ms
//! wind = 4.0                 # m/s
//! offset = 0.02              # m/s², lateral bias of accelerometer and thrust's axis
//! navigation = "own"         # on a target: by its own filter, or "other": by messages of another's
//! start = { rod = 0.4, rate = 0.8 }   # standard deviations of the rod (rad) and its rate (1/s) at the start; it is told to hang
//! ```

use controller::Real;
use estimator::{Drag, NavigationNoise, PayloadNoise};
use serde::Deserialize;

use crate::describe::input::{Invalid, join, within};
use crate::world::Air;

/// What the filters are told, where it differs from what is so or from the defaults.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct EstimatorSpec {
    /// C_d A of the payload, m², 0 to 10; the air's if left out.
    pub payload_drag_area: Option<f64>,
    /// C_d A of the UAV, m², 0 to 10; the air's if left out.
    pub uav_drag_area: Option<f64>,
    /// Linear drag of the UAV, N·s/m, 0 to 100.
    pub uav_rotor_drag: f64,
    /// Every noise figure of both filters times this, 0.01 to 100.
    pub noise: f64,
    /// N_a, m/s²/√Hz, 10⁻⁴ to 1.
    pub accelerometer_noise: f64,
    /// Residual force on the payload, m/s², 10⁻³ to 10.
    pub residual: f64,
    /// Lateral error of the thrust model over 40 ms, m/s², 10⁻³ to 10.
    pub lateral: f64,
    /// Wind, m/s, 0.1 to 50.
    pub wind: f64,
    /// Lateral offset of the thrust model at the start, m/s², 10⁻⁴ to 10.
    pub offset: f64,
    /// The rod's deviations at the start.
    pub start: RodStart,
    /// Whose navigation a target goes by.
    pub navigation: NavigationSource,
}

/// Whose navigation a target of `hil-sim hil` goes by; in a flight in this program both are one.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum NavigationSource {
    /// Its own, from IMU and receiver, begun at rest.
    #[default]
    Own,
    /// That of another autopilot, whose place and attitude come as messages.
    Other,
}

/// How sure the filter is of a rod that hangs straight down.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct RodStart {
    /// rad, 0.01 to 1.5.
    pub rod: f64,
    /// 1/s, 0.01 to 10.
    pub rate: f64,
}

impl Default for RodStart {
    fn default() -> Self {
        Self { rod: 0.4, rate: 0.8 }
    }
}

impl Default for EstimatorSpec {
    fn default() -> Self {
        let noise = PayloadNoise::<f64>::default();
        Self {
            payload_drag_area: None,
            uav_drag_area: None,
            uav_rotor_drag: 0.0,
            noise: 1.0,
            accelerometer_noise: noise.accelerometer,
            residual: noise.residual,
            lateral: noise.lateral,
            wind: noise.wind,
            offset: noise.offset,
            start: RodStart::default(),
            navigation: NavigationSource::default(),
        }
    }
}

impl EstimatorSpec {
    pub(super) fn check(&self, at: &str) -> Result<(), Invalid> {
        let check = |field: &str, value, low, high| within(&join(at, field), value, low..=high).map(|_| ());
        check("payload_drag_area", self.payload_drag_area.unwrap_or_default(), 0.0, 10.0)?;
        check("uav_drag_area", self.uav_drag_area.unwrap_or_default(), 0.0, 10.0)?;
        check("uav_rotor_drag", self.uav_rotor_drag, 0.0, 100.0)?;
        check("noise", self.noise, 0.01, 100.0)?;
        check("accelerometer_noise", self.accelerometer_noise, 1e-4, 1.0)?;
        check("residual", self.residual, 1e-3, 10.0)?;
        check("lateral", self.lateral, 1e-3, 10.0)?;
        check("wind", self.wind, 0.1, 50.0)?;
        check("offset", self.offset, 1e-4, 10.0)?;
        check("start.rod", self.start.rod, 0.01, 1.5)?;
        check("start.rate", self.start.rate, 0.01, 10.0)
    }

    /// Drag of payload and UAV as told.
    #[must_use]
    pub fn drags<T: Real>(&self, air: Option<&Air>) -> [Drag<T>; 2] {
        let air = air.copied().unwrap_or_default();
        let payload = Drag::of_area(T::lit(self.payload_drag_area.unwrap_or(air.payload_drag_area)));
        let uav = Drag::of_area(T::lit(self.uav_drag_area.unwrap_or(air.uav_drag_area)));
        [payload, Drag { linear: T::lit(self.uav_rotor_drag), ..uav }]
    }

    /// Noise of the payload filter as told.
    #[must_use]
    pub fn payload_noise<T: Real>(&self) -> PayloadNoise<T> {
        let told = PayloadNoise {
            accelerometer: T::lit(self.accelerometer_noise),
            residual: T::lit(self.residual),
            lateral: T::lit(self.lateral),
            wind: T::lit(self.wind),
            offset: T::lit(self.offset),
            ..PayloadNoise::default()
        };
        told.times(T::lit(self.noise)).starting(T::lit(self.start.rod), T::lit(self.start.rate))
    }

    /// Noise of navigation as told.
    #[must_use]
    pub fn navigation_noise<T: Real>(&self) -> NavigationNoise<T> {
        let told = NavigationNoise { accelerometer: T::lit(self.accelerometer_noise), ..NavigationNoise::default() };
        told.times(T::lit(self.noise))
    }
}
