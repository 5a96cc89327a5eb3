//! The vehicle's state on R³ × S² × SO(3), and the paper's 16 coordinates for it.

use nalgebra::{Matrix3, Vector3};

use crate::scalar::Real;

/// A part of the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Channel {
    /// Payload position.
    Position,
    /// Payload velocity.
    Velocity,
    /// Rod direction.
    Rod,
    /// Rod rate.
    RodRate,
    /// Attitude.
    Attitude,
    /// Body rate.
    BodyRate,
    /// The UAV's own position.
    UavPosition,
    /// The UAV's own velocity.
    UavVelocity,
}

/// Configuration and velocity of payload, rod and UAV.
///
/// **n3 points down, and the rod vector points from the UAV to the payload:** hanging straight down
/// is `rod` = e3, and altitude is −`position[2]`.
///
/// ```
/// use model::{State, Vector3};
///
/// // UAV and payload as motion capture sees them, level and at rest; n3 points down.
/// let (uav, payload) = (Vector3::new(0.2, 0.0, -12.0_f32), Vector3::new(0.0, 0.0, -10.0));
/// let along = payload - uav;
/// let state = State { rod: along / along.dot(&along).sqrt(), ..State::at_rest(payload) };
/// assert!(state.check().is_ok());
///
/// // A length forgotten is found before it flies.
/// assert!(State { rod: along, ..state }.check().is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<T> {
    /// Position p of the **payload** in N, m. The UAV is at p − L q.
    pub position: Vector3<T>,
    /// Velocity v of the payload in N, m/s.
    pub velocity: Vector3<T>,
    /// Unit vector q of the rod in N, from the UAV to the payload.
    pub rod: Vector3<T>,
    /// q̇ in N, 1/s; orthogonal to `rod`.
    pub rod_rate: Vector3<T>,
    /// Attitude R, body to N; its columns are b1, b2, b3, and thrust acts along −b3.
    pub attitude: Matrix3<T>,
    /// Angular velocity ω in body axes, rad/s.
    pub body_rate: Vector3<T>,
}

impl<T: Real> State<T> {
    /// At rest at `position`, rod straight down, level, yaw 0.
    pub fn at_rest(position: Vector3<T>) -> Self {
        Self {
            position,
            velocity: Vector3::zeros(),
            rod: Vector3::new(T::zero(), T::zero(), T::one()),
            rod_rate: Vector3::zeros(),
            attitude: Matrix3::identity(),
            body_rate: Vector3::zeros(),
        }
    }

    /// From the paper's coordinates (p, α, β, φ, θ, ψ, v, α̇, β̇, ω): q = Rx(α) Ry(β) e3 and
    /// R = Ry(θ) Rx(φ) Rz(ψ). Any values are allowed; angles in rad.
    pub fn from_paper(x: &[T; 16]) -> Self {
        let [p1, p2, p3, alpha, beta, phi, theta, psi, v1, v2, v3, alpha_dot, beta_dot, o1, o2, o3] = *x;
        let (sa, ca) = alpha.sin_cos();
        let (sb, cb) = beta.sin_cos();
        let (sf, cf) = phi.sin_cos();
        let (st, ct) = theta.sin_cos();
        let (sp, cp) = psi.sin_cos();
        Self {
            position: Vector3::new(p1, p2, p3),
            velocity: Vector3::new(v1, v2, v3),
            rod: Vector3::new(sb, -sa * cb, ca * cb),
            rod_rate: Vector3::new(
                cb * beta_dot,
                -ca * cb * alpha_dot + sa * sb * beta_dot,
                -sa * cb * alpha_dot - ca * sb * beta_dot,
            ),
            attitude: Matrix3::new(
                ct * cp + st * sf * sp,
                -ct * sp + st * sf * cp,
                st * cf,
                cf * sp,
                cf * cp,
                -sf,
                -st * cp + ct * sf * sp,
                st * sp + ct * sf * cp,
                ct * cf,
            ),
            body_rate: Vector3::new(o1, o2, o3),
        }
    }

    /// To the paper's coordinates. Its charts end where q2 = q3 = 0 (cos β = 0) and where b3 = ±e2
    /// (cos φ = 0): there the angles stay finite and α̇, β̇ do not.
    pub fn to_paper(&self) -> [T; 16] {
        let (p, v, q, w, r, o) =
            (&self.position, &self.velocity, &self.rod, &self.rod_rate, &self.attitude, &self.body_rate);
        let cos_beta_squared = q.y * q.y + q.z * q.z;
        let cos_beta = cos_beta_squared.sqrt();
        let cos_phi = (r.m21 * r.m21 + r.m22 * r.m22).sqrt();
        [
            p.x,
            p.y,
            p.z,
            (-q.y).atan2(q.z),
            q.x.atan2(cos_beta),
            (-r.m23).atan2(cos_phi),
            r.m13.atan2(r.m33),
            r.m21.atan2(r.m22),
            v.x,
            v.y,
            v.z,
            (q.y * w.z - w.y * q.z) / cos_beta_squared,
            w.x / cos_beta,
            o.x,
            o.y,
            o.z,
        ]
    }

    /// `Ok` if every number is finite and within the range the law is trusted with: position within
    /// 100 km, velocity within 1 km/s, rod rate and body rate within 100 rad/s, |q| and the
    /// attitude's columns within 1 % of 1, and those columns a right-handed frame.
    ///
    /// # Errors
    /// The first [`Channel`] that is not.
    #[inline]
    pub fn check(&self) -> Result<(), Channel> {
        // Mostly all is far inside its range: then so is the sum of the shares of all ranges.
        let share = |v: &Vector3<T>, most: f64| v.dot(v) * T::lit(1.0 / (most * most));
        let far = share(&self.position, 1e5) + share(&self.velocity, 1e3);
        let fast = (self.rod_rate.dot(&self.rod_rate) + self.body_rate.dot(&self.body_rate)) * T::lit(1e-4);
        let off = off_one(self.rod.dot(&self.rod)) + off_frame(&self.attitude);
        if far + fast + off * T::lit(1.0 / (TOLERANCE * TOLERANCE)) <= T::one() { Ok(()) } else { self.look() }
    }

    /// [`check`](Self::check), range by range.
    #[cold]
    #[inline(never)]
    fn look(&self) -> Result<(), Channel> {
        let within = |v: &Vector3<T>, most: f64| is_within(v, T::lit(most * most));
        let is_unit = off_one(self.rod.dot(&self.rod)) <= T::lit(TOLERANCE * TOLERANCE);
        let is_frame = is_frame(&self.attitude);
        if !within(&self.position, 1e5) {
            Err(Channel::Position)
        } else if !within(&self.velocity, 1e3) {
            Err(Channel::Velocity)
        } else if !is_unit {
            Err(Channel::Rod)
        } else if !within(&self.rod_rate, 1e2) {
            Err(Channel::RodRate)
        } else if !is_frame {
            Err(Channel::Attitude)
        } else if !within(&self.body_rate, 1e2) {
            Err(Channel::BodyRate)
        } else {
            Ok(())
        }
    }

    /// The same state in another scalar, rounded to nearest. Host-side use.
    pub fn cast<U: Real>(&self) -> State<U> {
        let vector = |v: &Vector3<T>| v.map(T::cast);
        State {
            position: vector(&self.position),
            velocity: vector(&self.velocity),
            rod: vector(&self.rod),
            rod_rate: vector(&self.rod_rate),
            attitude: self.attitude.map(T::cast),
            body_rate: vector(&self.body_rate),
        }
    }
}

/// |v|² ≤ `squared`; false for a NaN.
#[inline(never)]
pub fn is_within<T: Real>(v: &Vector3<T>, squared: T) -> bool {
    v.dot(v) <= squared
}

/// What 1 % of a length makes of its square.
const TOLERANCE: f64 = 0.02;

/// The squared distance from one.
#[inline]
fn off_one<T: Real>(x: T) -> T {
    (x - T::one()) * (x - T::one())
}

/// Columns within 1 % of unit length, and a right-handed frame.
#[inline]
pub(crate) fn is_frame<T: Real>(attitude: &Matrix3<T>) -> bool {
    off_frame(attitude) <= T::lit(TOLERANCE * TOLERANCE)
}

/// How far from that: the squared distances from one of what is one in such a frame.
#[inline]
fn off_frame<T: Real>(attitude: &Matrix3<T>) -> T {
    let b1: Vector3<T> = attitude.column(0).into();
    let b2: Vector3<T> = attitude.column(1).into();
    let b3: Vector3<T> = attitude.column(2).into();
    // Three vectors of length one span a volume of one only at right angles.
    off_one(b1.dot(&b1)) + off_one(b2.dot(&b2)) + off_one(b3.dot(&b3)) + off_one(b1.cross(&b2).dot(&b3))
}
