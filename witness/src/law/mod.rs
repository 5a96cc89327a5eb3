//! An independent witness of the law: b̄, Ā and ū by Lie derivatives of the extended system.
//!
//! The extended state is that of (3.8): the plant's 16 coordinates and ζ, with the thrust (3.5)
//! substituted, so that the system is affine in ū = (u_ζ, τ1, τ2, τ3) with constant input fields.
//! The flow of its drift is expanded in a Taylor series over dual numbers seeded along those four
//! fields. For an output h of relative degree r this gives, without any formula worked out by hand,
//!
//! - ξ: L_f^k h for k < r (k! times the coefficients),
//! - an entry of b̄, (3.9): L_f^r h,
//! - a row of Ā, (3.9): L_g L_f^(r−1) h (the dual parts),
//!
//! and ū = Ā⁻¹(−b̄ + ν), (3.10), by a 4×4 solve. It is slow and literal, and shares no code
//! with the controller.

mod extended;
mod linear;
mod path;
mod route;

pub use path::{Bent, Circle, Ellipse, WitnessPath, outputs};
pub use route::Route;

use crate::jet::Scalar;
use crate::plant::{VehicleParameters, index};
use extended::{Expansion, INPUTS};
use std::f64::consts::{PI, TAU};

/// Gains of one law: for each output, the feedback on its derivatives, low order first (0 above the
/// relative degree).
pub type OutputGains = [[f64; 6]; 4];

/// Relative degrees of the path-following outputs (h1, h2, ρ·v − v_d, ψ − ψ_d).
const FOLLOW_DEGREES: [usize; 4] = [6, 6, 5, 2];
/// Relative degrees of the tracking outputs (p, ψ).
const TRACK_DEGREES: [usize; 4] = [6, 6, 6, 2];

/// One evaluation of a law.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluation<const N: usize> {
    /// T of (3.5), N.
    pub thrust: f64,
    /// u_ζ, the compensator's input, m/s⁶.
    pub u_zeta: f64,
    /// τ in body axes, N·m.
    pub torque: [f64; 3],
    /// The outputs and their derivatives below the relative degree, output by output, low order
    /// first.
    pub xi: [f64; N],
    /// ν, the wanted value of each output's derivative at the relative degree.
    pub nu: [f64; 4],
    /// b̄ of (3.9).
    pub b: [f64; 4],
    /// Ā of (3.9), by rows; columns u_ζ, τ1, τ2, τ3.
    pub a: [[f64; 4]; 4],
}

/// The point at which a law is evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Operating<'a> {
    /// The vehicle as the law knows it.
    pub vehicle: &'a VehicleParameters,
    /// The paper's 16 coordinates.
    pub x: &'a [f64; 16],
    /// ζ, the payload's vertical acceleration (m/s²) and its derivatives.
    pub zeta: &'a [f64; 4],
}

/// Why a law has no value at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Singular;

impl std::fmt::Display for Singular {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("the decoupling matrix is singular or not finite at this state")
    }
}

impl std::error::Error for Singular {}

/// The path-following law (3.10), (5.3), (5.4): ν = −K ξ − (K̃ ξ̃, 0).
///
/// `integral` is ξ̃ = ∫(h1, h2, h3) and `integral_gains` the diagonal of K̃. ψ − ψ_d is taken
/// in (−π, π].
///
/// # Errors
/// [`Singular`] where Ā has no finite inverse.
pub fn follow<P: WitnessPath>(
    at: Operating<'_>,
    path: &P,
    gains: &OutputGains,
    integral_gains: &[f64; 3],
    integral: &[f64; 3],
) -> Result<Evaluation<19>, Singular> {
    let expansion = Expansion::of(at.vehicle, at.x, at.zeta);
    let mut outputs = outputs(
        path,
        expansion.group(index::POSITION),
        expansion.group(index::VELOCITY),
        expansion.state[index::PSI],
    );
    let yaw_error = &mut outputs[3].c[0].value;
    *yaw_error = wrap(*yaw_error);
    evaluate(at, &expansion, &outputs, FOLLOW_DEGREES, |xi| {
        let mut nu = feedback(gains, FOLLOW_DEGREES, xi);
        for (output, value) in nu.iter_mut().take(3).enumerate() {
            *value -= integral_gains[output] * integral[output];
        }
        nu
    })
}

/// Where the payload should be, and its yaw, at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reference {
    /// Each coordinate of p_ref in N and its first six time derivatives.
    pub position: [[f64; 7]; 3],
    /// ψ_ref and its first two time derivatives.
    pub yaw: [f64; 3],
}

impl Reference {
    /// y_ref of Section V: (r sin Ωt, r cos Ωt, p3, 0).
    #[must_use]
    pub fn circle(radius: f64, p3: f64, rate: f64, time: f64) -> Self {
        let (sin, cos) = (rate * time).sin_cos();
        // Each derivative of a sine is Ω times the sine a quarter turn on; n2 is a quarter turn
        // ahead of n1.
        let derivatives = |ahead: usize| {
            std::array::from_fn(|order| {
                let value = [sin, cos, -sin, -cos][(order + ahead) % 4];
                (0..order).fold(radius * value, |scaled, _| scaled * rate)
            })
        };
        let mut height = [0.0; 7];
        height[0] = p3;
        Self { position: [derivatives(0), derivatives(1), height], yaw: [0.0; 3] }
    }
}

/// The trajectory-tracking law of Section V: outputs (p, ψ), ν = y_ref⁽ʳ⁾ − Σ k (y −
/// y_ref)⁽ʲ⁾.
///
/// ξ holds the outputs themselves, not their errors. ψ − ψ_ref is taken in (−π, π].
///
/// # Errors
/// [`Singular`] where Ā has no finite inverse.
pub fn track(at: Operating<'_>, reference: &Reference, gains: &OutputGains) -> Result<Evaluation<20>, Singular> {
    let expansion = Expansion::of(at.vehicle, at.x, at.zeta);
    let [p1, p2, p3] = expansion.group(index::POSITION);
    let outputs = [p1, p2, p3, expansion.state[index::PSI]];
    evaluate(at, &expansion, &outputs, TRACK_DEGREES, |xi| {
        let [r1, r2, r3] = reference.position;
        let mut error = *xi;
        for (axis, wanted) in [r1, r2, r3].iter().enumerate() {
            for order in 0..6 {
                error[6 * axis + order] -= wanted[order];
            }
        }
        error[18] = wrap(error[18] - reference.yaw[0]);
        error[19] -= reference.yaw[1];
        let nu = feedback(gains, TRACK_DEGREES, &error);
        [nu[0] + r1[6], nu[1] + r2[6], nu[2] + r3[6], nu[3] + reference.yaw[2]]
    })
}

/// An angle in (−π, π].
fn wrap(angle: f64) -> f64 {
    if -PI < angle && angle <= PI {
        angle // untouched, so that no rounding enters
    } else {
        PI - (PI - angle).rem_euclid(TAU)
    }
}

/// −K ξ.
fn feedback(gains: &OutputGains, degrees: [usize; 4], xi: &[f64]) -> [f64; 4] {
    let mut first = 0;
    std::array::from_fn(|output| {
        let degree = degrees[output];
        let chain = &xi[first..first + degree];
        first += degree;
        -chain.iter().zip(&gains[output]).map(|(derivative, gain)| derivative * gain).sum::<f64>()
    })
}

/// ξ, b̄, Ā and ū of four outputs given as series along the drift.
fn evaluate<const N: usize>(
    at: Operating<'_>,
    expansion: &Expansion,
    outputs: &[extended::Series; 4],
    degrees: [usize; 4],
    law: impl Fn(&[f64; N]) -> [f64; 4],
) -> Result<Evaluation<N>, Singular> {
    let mut xi = [0.0; N];
    let mut b = [0.0; 4];
    let mut a = [[0.0; INPUTS]; 4];
    let mut slot = 0;
    for (output, degree) in degrees.into_iter().enumerate() {
        let series = &outputs[output];
        for order in 0..degree {
            xi[slot] = factorial(order) * series.c[order].value();
            slot += 1;
        }
        b[output] = factorial(degree) * series.c[degree].value();
        a[output] = series.c[degree - 1].parts.map(|part| factorial(degree - 1) * part);
    }
    let nu = law(&xi);
    let rhs = std::array::from_fn(|output| nu[output] - b[output]);
    let u = linear::solve(a, rhs).ok_or(Singular)?;
    let thrust = expansion.thrust(at.vehicle);
    if !(thrust.is_finite() && u.iter().all(|value| value.is_finite())) {
        return Err(Singular);
    }
    Ok(Evaluation { thrust, u_zeta: u[0], torque: [u[1], u[2], u[3]], xi, nu, b, a })
}

/// k!, exact here.
fn factorial(k: usize) -> f64 {
    (1..=k).map(|factor| factor as f64).product()
}
