//! The law's distances from where it is singular: theory, section 9.

use model::{Real, State, Vehicle, Yaw, dynamics::lambda};
use nalgebra::Vector3;

/// The numbers the law divides by, as signed distances from zero: the paper's singularities, the
/// path's and the yaw's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Margins<T> {
    /// q·e3, cos α cos β: 1 hanging straight down, 0 with the rod horizontal.
    pub q3: T,
    /// q·b3: 1 with the thrust along the rod, 0 across it.
    pub q_b3: T,
    /// Payload's specific force along the rod, m/s²: −g hanging at rest, 0 in free fall (a slack
    /// cable).
    pub lambda: T,
    /// T/(m_Q L), 1/s²: 0 without thrust.
    pub kappa: T,
    /// (∇h1 × ∇h2)·ρ, in the units of h1 and h2 per m²; 1 for trajectory tracking. Negative where
    /// ρ is the opposite of (3.2).
    pub path_det: T,
    /// What is left of the reach of a path with a nearest point; 1 for the others.
    pub reach: T,
    /// cos²φ: 0 where yaw is not defined.
    pub cos_phi_squared: T,
}

impl<T: Real> Margins<T> {
    /// Those of the motion itself, at `state` under `thrust` (N); the path's are 1.
    pub fn of_motion(vehicle: &Vehicle<T>, state: &State<T>, thrust: T) -> Self {
        let b3: Vector3<T> = state.attitude.column(2).into();
        Self {
            q3: state.rod.z,
            q_b3: b3.dot(&state.rod),
            lambda: lambda(vehicle, state, thrust),
            kappa: thrust * vehicle.kappa_per_thrust(),
            path_det: T::one(),
            reach: T::one(),
            cos_phi_squared: Yaw::of(state).cos_phi_squared,
        }
    }

    /// In the order of [`Margin::ALL`], each falling to 0 where the law is singular; the
    /// determinant as a share of `path_det`.
    #[inline(always)]
    pub(crate) fn values(&self, path_det: T) -> [T; 7] {
        [self.q3, self.q_b3, -self.lambda, self.kappa, self.path_det / path_det, self.reach, self.cos_phi_squared]
    }

    /// The same in another scalar, rounded to nearest. Host-side use.
    pub fn cast<U: Real>(&self) -> Margins<U> {
        Margins {
            q3: self.q3.cast(),
            q_b3: self.q_b3.cast(),
            lambda: self.lambda.cast(),
            kappa: self.kappa.cast(),
            path_det: self.path_det.cast(),
            reach: self.reach.cast(),
            cos_phi_squared: self.cos_phi_squared.cast(),
        }
    }
}

/// Which margin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Margin {
    /// The rod's angle from the vertical (α, β → π/2).
    RodAngle,
    /// The angle between thrust axis and rod (b3 ⊥ q).
    ThrustAngle,
    /// The tension of the rod (free fall).
    Tension,
    /// The thrust (T → 0).
    Thrust,
    /// The regularity of the path's functions (∇h1 ∥ ∇h2, or one of them zero).
    Path,
    /// The reach of a path with a nearest point.
    Reach,
    /// The yaw's chart (φ → π/2).
    Yaw,
}

impl Margin {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::RodAngle, Self::ThrustAngle, Self::Tension, Self::Thrust, Self::Path, Self::Reach, Self::Yaw];
}
