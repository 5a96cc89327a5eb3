//! What the payload filter holds true, and the chart of its errors.
//!
//! The nominal state lives where it belongs, q on the sphere and q̇ across it; only the *error* has
//! a chart, of the hemisphere q₃ > 0: the horizontal components η = (δq₁, δq₂) and ζ = (δq̇₁,
//! δq̇₂). The law's envelope ends at 70° (q₃ = 0.34), so the chart always holds, and no basis of
//! the tangent plane has to be carried along. With q_h = (q₁, q₂) and B₃ = −q_h/q₃
//!
//! ```text
//! δq = (η, B₃·η)                                                                            (4)
//! δq̇ = (ζ, B₃·ζ − ((q̇_h + q̇₃ B₃)·η)/q₃)                                                     (5)
//! ```

use model::{Real, Vector3};

/// Error states.
pub(crate) const ERRORS: usize = 12;

/// Where each error stands in the vector of all.
pub(crate) mod index {
    pub(crate) const ROD: usize = 0;
    pub(crate) const RATE: usize = 2;
    pub(crate) const WIND: usize = 4;
    pub(crate) const RESIDUAL: usize = 6;
    pub(crate) const OFFSET: usize = 8;
    pub(crate) const MASS: usize = 11;
}

/// The nominal state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PayloadState<T> {
    /// q, from the hook to the payload in N, of length one.
    pub rod: Vector3<T>,
    /// q̇ in N, 1/s, orthogonal to it.
    pub rod_rate: Vector3<T>,
    /// Horizontal wind in N, m/s: where the air goes.
    pub wind: [T; 2],
    /// r, horizontal specific force on the payload beyond drag, in N, m/s².
    pub residual: [T; 2],
    /// l, lateral offset of the thrust model along b1 and b2, m/s².
    pub offset: [T; 2],
    /// k_T, thrust given over thrust told.
    pub thrust_scale: T,
    /// μ: the payload's mass is m₀ (1 + μ).
    pub mass_ratio: T,
}

/// Largest |q_h|² that a correction may lead to: 71.6° from the vertical.
const STEEPEST: f64 = 0.9;

/// Mass ratios that a correction may lead to.
const LIGHTEST: f64 = -0.7;
const HEAVIEST: f64 = 2.5;

impl<T: Real> PayloadState<T> {
    /// Rod straight down, at rest, still air, everything as told.
    pub(crate) fn hanging() -> Self {
        Self {
            rod: Vector3::new(T::zero(), T::zero(), T::one()),
            rod_rate: Vector3::zeros(),
            wind: [T::zero(); 2],
            residual: [T::zero(); 2],
            offset: [T::zero(); 2],
            thrust_scale: T::one(),
            mass_ratio: T::zero(),
        }
    }

    /// Puts the rod at the horizontal components `q`, its rate at `w`: the rest follows from (4),
    /// (5).
    pub(crate) fn set_rod(&mut self, q: [T; 2], w: [T; 2]) {
        let square = q[0] * q[0] + q[1] * q[1];
        let most = T::lit(STEEPEST);
        let shrink = if square > most { (most / square).sqrt() } else { T::one() };
        let q = q.map(|component| component * shrink);
        let down = (T::one() - (q[0] * q[0] + q[1] * q[1])).sqrt();
        self.rod = Vector3::new(q[0], q[1], down);
        self.rod_rate = Vector3::new(w[0], w[1], -(q[0] * w[0] + q[1] * w[1]) / down);
    }

    /// Adds an error to the state. Thrust scale and mass stay within what a vehicle can be.
    pub(crate) fn inject(&mut self, error: &[T; ERRORS]) {
        let [q1, q2, w1, w2, a1, a2, r1, r2, l1, l2, thrust, mass] = *error;
        let (q, w) = (self.rod, self.rod_rate);
        self.set_rod([q.x + q1, q.y + q2], [w.x + w1, w.y + w2]);
        self.wind = [self.wind[0] + a1, self.wind[1] + a2];
        self.residual = [self.residual[0] + r1, self.residual[1] + r2];
        self.offset = [self.offset[0] + l1, self.offset[1] + l2];
        self.thrust_scale = (self.thrust_scale + thrust).clamp(T::lit(0.5), T::lit(1.5));
        self.mass_ratio = (self.mass_ratio + mass).clamp(T::lit(LIGHTEST), T::lit(HEAVIEST));
    }

    /// Whether the mass is as far from what was told as a correction may lead.
    pub(crate) fn is_mass_at_bound(&self) -> bool {
        self.mass_ratio <= T::lit(LIGHTEST) || self.mass_ratio >= T::lit(HEAVIEST)
    }
}

/// δq and δq̇ as functions of η and ζ at one state, (4) and (5).
pub(crate) struct Chart<T> {
    /// B₃.
    pub(crate) lean: [T; 2],
    /// −(q̇_h + q̇₃ B₃)/q₃: what η does to δq̇₃.
    pub(crate) turn: [T; 2],
}

impl<T: Real> Chart<T> {
    pub(crate) fn at(q: &Vector3<T>, w: &Vector3<T>) -> Self {
        let per_down = -(T::one() / q.z);
        let lean = [q.x * per_down, q.y * per_down];
        Self { lean, turn: [(w.x + w.z * lean[0]) * per_down, (w.y + w.z * lean[1]) * per_down] }
    }

    /// `along`·δq per η, for a vector in N.
    #[inline(always)]
    pub(crate) fn per_rod(&self, along: &Vector3<T>) -> [T; 2] {
        [along.x + along.z * self.lean[0], along.y + along.z * self.lean[1]]
    }
}
