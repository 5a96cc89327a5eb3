//! What the model leaves out: a force on the payload, one across the rod, a torque on the UAV.

use nalgebra::Vector3;

use crate::scalar::Real;
use crate::vehicle::Vehicle;

/// Unmodelled effects, and how fast the forces change. Over a Taylor series they grow at these
/// rates.
///
/// ```
/// use model::{Disturbance, Vector3};
///
/// // A wind that pushes the payload north with 0.4 m/s².
/// let wind = Disturbance { payload: Vector3::new(0.4, 0.0, 0.0), ..Disturbance::<f32>::none() };
/// assert!(wind.rod == Vector3::zeros());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disturbance<T> {
    /// d, specific force on the payload in N, m/s².
    pub payload: Vector3<T>,
    /// δ, acceleration of the rod's direction in N, 1/s².
    pub rod: Vector3<T>,
    /// Torque on the UAV in body axes, N·m.
    pub torque: Vector3<T>,
    /// ḋ, m/s³.
    pub payload_rate: Vector3<T>,
    /// δ̇, 1/s³.
    pub rod_rate: Vector3<T>,
}

impl<T: Real> Disturbance<T> {
    /// None: the paper's model.
    #[must_use]
    pub fn none() -> Self {
        Self {
            payload: Vector3::zeros(),
            rod: Vector3::zeros(),
            torque: Vector3::zeros(),
            payload_rate: Vector3::zeros(),
            rod_rate: Vector3::zeros(),
        }
    }

    /// The same in another scalar, rounded to nearest. Host-side use.
    pub fn cast<U: Real>(&self) -> Disturbance<U> {
        let vector = |v: &Vector3<T>| v.map(T::cast);
        Disturbance {
            payload: vector(&self.payload),
            rod: vector(&self.rod),
            torque: vector(&self.torque),
            payload_rate: vector(&self.payload_rate),
            rod_rate: vector(&self.rod_rate),
        }
    }

    /// Force on the payload in N (frame), N (newton): m_L d + m_Q (q·d) q. Along the `rod` forces
    /// on either body are one motion, of all the mass, and counted here.
    pub fn payload_force(&self, vehicle: &Vehicle<T>, rod: &Vector3<T>) -> Vector3<T> {
        let params = vehicle.params();
        self.payload * params.payload_mass + rod * (rod.dot(&self.payload) * params.uav_mass)
    }

    /// Force on the UAV in N (frame), N (newton), across the `rod`: that of m_Q (d − L δ), since
    /// δ = (F_L/m_L − F_Q/m_Q)/L.
    pub fn uav_force(&self, vehicle: &Vehicle<T>, rod: &Vector3<T>) -> Vector3<T> {
        let params = vehicle.params();
        let force = (self.payload - self.rod * params.rod_length) * params.uav_mass;
        force - rod * rod.dot(&force)
    }

    /// The payload mass, kg, that would explain d in still air, with `lambda` (m/s²) the payload's
    /// specific force along `rod` without d: the rod's tension is shared as M λ, so M = M₀ λ/(λ +
    /// d·q) (12.6).
    pub fn implied_payload_mass(&self, vehicle: &Vehicle<T>, rod: &Vector3<T>, lambda: T) -> T {
        let total = vehicle.total_mass() * lambda / (lambda + self.payload.dot(rod));
        (total - vehicle.params().uav_mass).max(T::zero())
    }
}
