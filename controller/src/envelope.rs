//! The law's distances from where it is singular.

/// The five numbers the law divides by, as signed distances from zero: the paper's singularities and the path's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins<T> {
    /// q·e3, cos α cos β: 1 hanging straight down, 0 with the rod horizontal.
    pub q3: T,
    /// q·b3: 1 with the thrust along the rod, 0 across it.
    pub q_b3: T,
    /// Payload's specific force along the rod, m/s²: −g hanging at rest, 0 in free fall (a slack cable).
    pub lambda: T,
    /// T/(m_Q L), 1/s²: 0 without thrust.
    pub kappa: T,
    /// (∇h1 × ∇h2)·ρ, in the units of h1 and h2 per m²; 1 for trajectory tracking. Negative where ρ is the opposite of (3).
    pub path_det: T,
    /// cos²φ: 0 where yaw is not defined.
    pub cos_phi_squared: T,
}
