//! Drag of a body in moving air: F(ρ) = (c₁ + c₂ |ρ|) ρ, with ρ the air's velocity less the body's.

use model::{Matrix3, OutOfRange, Real, Vector3};

/// Below this speed, m/s, the *derivative* of the quadratic part is taken as at it. At rest it
/// would be zero, and a filter that believes this takes wind for something else.
const LEAST_SPEED: f64 = 4.0;

/// The two coefficients of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drag<T> {
    /// c₁, N·s/m, 0 to 100: rotors in forward flight.
    pub linear: T,
    /// c₂ = ½ ρ C_d A, kg/m, 0 to 10: bluff bodies.
    pub quadratic: T,
}

impl<T: Real> Drag<T> {
    /// That of a bluff body with a drag area C_d A (m²) in air of 1.225 kg/m³.
    pub fn of_area(area: T) -> Self {
        Self { linear: T::zero(), quadratic: area * T::lit(0.5 * 1.225) }
    }

    /// `field` names whose they are.
    pub(crate) fn check(&self, field: &'static str) -> Result<(), OutOfRange<T>> {
        OutOfRange::check(field, self.linear, 0.0, 100.0)?;
        OutOfRange::check(field, self.quadratic, 0.0, 10.0)
    }

    /// F(ρ), N.
    #[inline(always)]
    pub(crate) fn force(&self, relative: &Vector3<T>) -> Vector3<T> {
        relative * (self.linear + self.quadratic * relative.dot(relative).sqrt())
    }

    /// ∂F/∂ρ = (c₁ + c₂ n) 1 + (c₂/n) ρ ρᵀ with n = max(|ρ|, 4 m/s), N·s/m.
    #[inline]
    pub(crate) fn slope(&self, relative: &Vector3<T>) -> Matrix3<T> {
        let speed = relative.dot(relative).sqrt().max(T::lit(LEAST_SPEED));
        let along = relative * (self.quadratic / speed);
        let across = self.linear + self.quadratic * speed;
        let mut slope = Matrix3::from_columns(&[along * relative.x, along * relative.y, along * relative.z]);
        slope.m11 += across;
        slope.m22 += across;
        slope.m33 += across;
        slope
    }
}
