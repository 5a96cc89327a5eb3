//! A law's answer.

use model::{Command, Real};

use crate::law::margins::Margins;

/// What of a law's answer flies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer<T> {
    /// Thrust (3.5) and torque (7.5).
    pub command: Command<T>,
    /// The compensator's input, m/s⁶.
    pub u_zeta: T,
    /// ν of (5.3), the wanted highest derivatives of the outputs.
    pub nu: [T; 4],
    /// Distances from the singularities.
    pub margins: Margins<T>,
}

impl<T: Real> Answer<T> {
    /// All zeros.
    pub(crate) fn none() -> Self {
        let zero = T::zero();
        Self { command: Command::zero(), u_zeta: zero, nu: [zero; 4], margins: Margins::default() }
    }

    /// The whole answer, with ξ.
    pub(crate) fn with<X>(&self, xi: X) -> Solution<T, X> {
        let Self { command, u_zeta, nu, margins } = *self;
        Solution { command, u_zeta, xi, nu, margins }
    }

    /// Neither command nor u_ζ is infinite or NaN.
    #[inline]
    pub fn is_finite(&self) -> bool {
        let Command { thrust, torque } = &self.command;
        (*thrust + torque.x + torque.y + torque.z + self.u_zeta).is_finite()
    }
}

/// What a law answers: the command, and the numbers it came from as telemetry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution<T, X> {
    /// Thrust (3.5) and torque (7.5).
    pub command: Command<T>,
    /// The compensator's input, m/s⁶.
    pub u_zeta: T,
    /// Outputs and derivatives.
    pub xi: X,
    /// ν of (5.3), the wanted highest derivatives of the outputs.
    pub nu: [T; 4],
    /// Distances from the singularities.
    pub margins: Margins<T>,
}

/// Σ aₖ bₖ.
#[inline]
pub(crate) fn dot<T: Real, const N: usize>(a: &[T; N], b: &[T; N]) -> T {
    a.iter().zip(b).fold(T::EMPTY_SUM, |sum, (&a, &b)| sum + a * b)
}
