//! The vehicle's input: total thrust and torque.

use nalgebra::Vector3;

use crate::scalar::Real;

/// Thrust and torque for the coming hold.
///
/// ```
/// use model::{Command, Vehicle, VehicleParams};
///
/// let vehicle = Vehicle::new(VehicleParams::<f32>::paper())?;
/// let hover = Command::of_thrust(vehicle.hover_thrust());
/// assert!(hover.torque.iter().all(|&torque| torque == 0.0));
/// # Ok::<(), model::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command<T> {
    /// Total thrust along −b3, N.
    pub thrust: T,
    /// Torque in body axes, N·m.
    pub torque: Vector3<T>,
}

impl<T: Real> Command<T> {
    /// No thrust, no torque.
    #[must_use]
    pub fn zero() -> Self {
        Self { thrust: T::zero(), torque: Vector3::zeros() }
    }

    /// This `thrust`, N, and no torque.
    pub fn of_thrust(thrust: T) -> Self {
        Self { thrust, torque: Vector3::zeros() }
    }

    /// Component by component, N and N·m.
    #[inline]
    pub fn plus(&self, other: &Self) -> Self {
        Self { thrust: self.thrust + other.thrust, torque: self.torque + other.torque }
    }

    /// Component by component, N and N·m.
    #[inline]
    pub fn minus(&self, other: &Self) -> Self {
        Self { thrust: self.thrust - other.thrust, torque: self.torque - other.torque }
    }

    /// Every component is less than `size`, N and N·m, either way.
    pub fn is_below(&self, size: T) -> bool {
        [self.thrust, self.torque.x, self.torque.y, self.torque.z].iter().all(|component| component.abs() < size)
    }

    /// No infinity, no NaN.
    #[inline]
    pub fn is_finite(&self) -> bool {
        (self.thrust + self.torque.x + self.torque.y + self.torque.z).is_finite()
    }

    /// The same in another scalar, rounded to nearest. Host-side use.
    #[must_use]
    pub fn cast<U: Real>(&self) -> Command<U> {
        Command { thrust: self.thrust.cast(), torque: self.torque.map(T::cast) }
    }

    /// All components times `factor`.
    #[inline]
    pub fn times(&self, factor: T) -> Self {
        Self { thrust: self.thrust * factor, torque: self.torque * factor }
    }
}
