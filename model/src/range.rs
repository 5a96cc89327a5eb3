//! What a parameter may be, and what it is unless somebody says otherwise.

use crate::error::OutOfRange;
use crate::scalar::Real;

/// A parameter's name, its range and its value where none is given. Constructors check against
/// these and parameter tables list them, so that each number is written once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The field's name, as in the struct that holds it.
    pub field: &'static str,
    /// The least allowed value.
    pub min: f64,
    /// The largest allowed value.
    pub max: f64,
    /// The value where none is given.
    pub default: f64,
}

impl Range {
    /// `field` from `min` to `max`, both allowed.
    #[must_use]
    pub const fn new(field: &'static str, min: f64, max: f64, default: f64) -> Self {
        assert!(min <= default && default <= max);
        Self { field, min, max, default }
    }

    /// The value where none is given.
    #[must_use]
    pub fn default<T: Real>(&self) -> T {
        T::lit(self.default)
    }

    /// `Ok` if `value` is in the range, which a NaN is not.
    ///
    /// # Errors
    /// [`OutOfRange`] with the field, the value and the range.
    pub fn check<T: Real>(&self, value: T) -> Result<(), OutOfRange<T>> {
        OutOfRange::check(self.field, value, self.min, self.max)
    }
}

/// Payload mass m_L, kg.
pub const PAYLOAD_MASS: Range = Range::new("payload_mass", 1e-3, 1e3, 0.5);
/// UAV mass m_Q, kg.
pub const UAV_MASS: Range = Range::new("uav_mass", 1e-2, 1e3, 2.5);
/// Rod length L, m.
pub const ROD_LENGTH: Range = Range::new("rod_length", 0.05, 100.0, 2.0);
/// Principal moments of inertia about b1, b2 and b3, kg·m².
pub const INERTIA: [Range; 3] = [
    Range::new("inertia[0]", 1e-6, 1e3, 0.03),
    Range::new("inertia[1]", 1e-6, 1e3, 0.03),
    Range::new("inertia[2]", 1e-6, 1e3, 0.05),
];
/// Gravity g, m/s².
pub const GRAVITY: Range = Range::new("gravity", 0.1, 30.0, 9.81);
