//! Forces of the air and of others on payload and UAV, and a payload picked up or dropped.
//!
//! Drag on a body with drag area C_d A in air that moves at w: F = ½ ρ C_d A |w − v| (w − v),
//! the quadratic law of bluff bodies at Reynolds numbers of 10⁴ to 10⁵ (Hoerner, *Fluid-Dynamic
//! Drag*, 1965, ch. 3).

use controller::Vector3;
use serde::Deserialize;

use super::check;
use super::dryden::Gusts;
use super::multibody::Loads;
use crate::describe::input::{Invalid, all_within, join};

/// What is around the vehicle.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Environment {
    /// Constant force on the payload in N, N; each component within ±1000.
    pub payload_force: [f64; 3],
    /// Constant force on the UAV in N, N; each component within ±1000.
    pub uav_force: [f64; 3],
    /// Constant disturbing torque on the UAV in body axes, N·m; each component within ±100.
    pub torque: [f64; 3],
    /// Air that drags at both bodies; none if left out.
    pub air: Option<Air>,
    /// A payload picked up or dropped in flight.
    pub payload_step: Option<PayloadStep>,
}

/// The air and how the bodies stand in it.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Air {
    /// Mean velocity of the air in N, m/s: **where it goes**, not where it comes from. Each
    /// component within ±50.
    pub wind: [f64; 3],
    /// Turbulence about the mean.
    pub gusts: Option<Gusts>,
    /// ρ, kg/m³, 0 to 2.
    pub density: f64,
    /// C_d A of the payload, m², 0 to 10.
    pub payload_drag_area: f64,
    /// C_d A of the UAV, m², 0 to 10.
    pub uav_drag_area: f64,
}

impl Default for Air {
    /// Still air of the standard atmosphere at sea level; drag areas of a cube of 10 cm (C_d 1.05,
    /// rounded) and of a quadrotor of 2.5 kg.
    fn default() -> Self {
        Self { wind: [0.0; 3], gusts: None, density: 1.225, payload_drag_area: 0.01, uav_drag_area: 0.05 }
    }
}

/// Another payload from a time on. It joins or leaves at the payload's velocity: velocities have no
/// step.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct PayloadStep {
    /// When, s.
    pub at_s: f64,
    /// Mass from then on, kg, 0.001 to 1000: dropped, the hook is what is left.
    pub mass: f64,
    /// C_d A from then on, m²; as before if left out.
    pub drag_area: Option<f64>,
}

impl Environment {
    /// Checks every range; `at` is the table's name.
    ///
    /// # Errors
    /// [`Invalid`] names the field.
    pub fn check(&self, at: &str) -> Result<(), Invalid> {
        all_within(&join(at, "payload_force"), self.payload_force, 1e3)?;
        all_within(&join(at, "uav_force"), self.uav_force, 1e3)?;
        all_within(&join(at, "torque"), self.torque, 100.0)?;
        if let Some(air) = &self.air {
            let at = join(at, "air");
            all_within(&join(&at, "wind"), air.wind, 50.0)?;
            if let Some(gusts) = &air.gusts {
                gusts.check(&join(&at, "gusts"))?;
            }
            check(&at, "density", air.density, 0.0, 2.0)?;
            check(&at, "payload_drag_area", air.payload_drag_area, 0.0, 10.0)?;
            check(&at, "uav_drag_area", air.uav_drag_area, 0.0, 10.0)?;
        }
        if let Some(step) = &self.payload_step {
            let at = join(at, "payload_step");
            check(&at, "at_s", step.at_s, 0.0, 1e5)?;
            check(&at, "mass", step.mass, 1e-3, 1e3)?;
            check(&at, "drag_area", step.drag_area.unwrap_or_default(), 0.0, 10.0)?;
        }
        Ok(())
    }
}

/// What acts from outside over the running period.
#[derive(Clone, Debug)]
pub(super) struct Outside {
    /// Whatever the bodies do.
    constant: Loads,
    /// Mean velocity of the air in N, m/s.
    pub wind: Vector3<f64>,
    /// Its velocity now.
    pub air: Vector3<f64>,
    /// ½ ρ C_d A of payload and UAV, kg/m.
    pub drag: [f64; 2],
}

impl Outside {
    /// In calm air, or in the mean wind of `environment`.
    pub fn new(environment: &Environment) -> Self {
        let Environment { payload_force, uav_force, torque, air, .. } = *environment;
        let [payload_force, uav_force, torque] = [payload_force, uav_force, torque].map(Vector3::from);
        let wind = air.map_or(Vector3::zeros(), |air| air.wind.into());
        let drag = air
            .map_or([0.0; 2], |air| [air.payload_drag_area, air.uav_drag_area].map(|area| 0.5 * air.density * area));
        Self { constant: Loads { payload_force, uav_force, torque }, wind, air: wind, drag }
    }

    /// With what the velocities of payload and UAV, m/s in N, bring with them.
    #[inline]
    pub fn loads(&self, payload: &Vector3<f64>, uav: &Vector3<f64>) -> Loads {
        let mut loads = self.constant;
        let [payload_drag, uav_drag] = self.drag;
        if payload_drag > 0.0 || uav_drag > 0.0 {
            loads.payload_force += drag(payload_drag, &self.air, payload);
            loads.uav_force += drag(uav_drag, &self.air, uav);
        }
        loads
    }
}

/// ½ ρ C_d A |w − v| (w − v), N in N, of a body at `velocity` with `half_density_area` = ½ ρ
/// C_d A, kg/m.
#[inline]
#[must_use]
pub fn drag(half_density_area: f64, air: &Vector3<f64>, velocity: &Vector3<f64>) -> Vector3<f64> {
    let relative = air - velocity;
    relative * (half_density_area * relative.dot(&relative).sqrt())
}
