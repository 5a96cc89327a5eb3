//! Thrust and torque to rotors: which speeds give them, and what is given up when the rotors can't.
//!
//! Rotor i at speed Ω gives the force f = k_T Ω² along −b3 and the drag torque ±k_Q Ω² about
//! b3 (down: a rotor that turns counter-clockwise seen from above drags the body clockwise, which
//! is positive), so with its place (x, y) from the centre of mass
//!
//! ```text
//! (T, τ) = B f,   column i of B = (1, −y, x, ±k_Q/k_T),   f = B⁺ (T, τ)        (16.1)
//! ```
//!
//! with the pseudo-inverse B⁺ taken once. Where a rotor would leave its range, what is applied
//! keeps, in this order,
//!
//! 1. roll and pitch torque, as much of them (in their proportion) as the rotors have at the thrust
//!    that leaves them most room,
//! 2. then thrust, the nearest that roll and pitch allow,
//! 3. then yaw torque, as much as is left.
//!
//! A vehicle that keeps these can still be righted, then kept in the air, then turned. There is no
//! iteration: the cost is the same for every command.

// Matrices are indexed over compile-time bounds.
#![allow(clippy::indexing_slicing)]

use model::{Command, OutOfRange, Real};
use nalgebra::Vector3;

use crate::ranges::{MAX_SPEED, MIN_SPEED, ROTOR_ARM, ROTOR_PLACE, THRUST_COEFFICIENT, TORQUE_COEFFICIENT};
use crate::sampled::actuator::Actuation;

/// One of the rotors, all of which are alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RotorParams<T> {
    /// k_T, N/(rad/s)².
    pub thrust_coefficient: T,
    /// k_Q, N·m/(rad/s)².
    pub torque_coefficient: T,
    /// Least speed, rad/s: an electronic speed controller's idle.
    pub min_speed: T,
    /// Largest speed, rad/s.
    pub max_speed: T,
}

impl<T: Real> RotorParams<T> {
    /// Rotors that hover `weight` (N), shared by `rotors` of them, at half of their largest force
    /// and at 600 rad/s, with a drag of 16 mm of their thrust and an idle of a tenth of the largest
    /// speed. A stand-in for a measured propeller of that size.
    pub fn typical(weight: T, rotors: usize) -> Self {
        let hover_speed = T::lit(600.0);
        let thrust_coefficient = weight / (T::lit(rotors as f64) * hover_speed * hover_speed);
        let max_speed = hover_speed * T::lit(core::f64::consts::SQRT_2);
        Self {
            thrust_coefficient,
            torque_coefficient: thrust_coefficient * T::lit(0.016),
            min_speed: max_speed * T::lit(0.1),
            max_speed,
        }
    }

    fn check(&self) -> Result<(), OutOfRange<T>> {
        THRUST_COEFFICIENT.check(self.thrust_coefficient)?;
        TORQUE_COEFFICIENT.check(self.torque_coefficient)?;
        MAX_SPEED.check(self.max_speed)?;
        OutOfRange::within("min_speed", self.min_speed, T::lit(MIN_SPEED.min), self.max_speed * T::lit(0.9))
    }
}

/// Where a rotor is and how it turns.
///
/// ```
/// use controller::{Place, RotorParams, Rotors};
///
/// let rotor = RotorParams::typical(29.4_f32, 4);
/// let place = |x, y| Place { x, y, counter_clockwise: x * y > 0.0 };
/// // Longer than wide.
/// let places = [place(0.3, 0.2), place(-0.3, -0.2), place(0.3, -0.2), place(-0.3, 0.2)];
/// let rotors = Rotors::new(rotor, &places)?;
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place<T> {
    /// Along b1 (forward) from the centre of mass, m.
    pub x: T,
    /// Along b2 (right), m.
    pub y: T,
    /// Whether it turns counter-clockwise seen from above.
    pub counter_clockwise: bool,
}

/// What a command comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Allocation<T, const N: usize> {
    /// Speeds, rad/s, within their range.
    pub speeds: [T; N],
    /// Forces along −b3, N.
    pub thrusts: [T; N],
    /// What they give together.
    pub applied: Command<T>,
    /// It is less than what was asked for.
    pub saturated: bool,
}

/// N rotors, checked.
///
/// ```
/// use controller::{Command, RotorParams, Rotors};
///
/// // A quadrotor in X, 0.25 m from the centre to each axis.
/// let rotor = RotorParams {
///     thrust_coefficient: 2e-5_f32,
///     torque_coefficient: 3.2e-7,
///     min_speed: 80.0,
///     max_speed: 900.0,
/// };
/// let rotors = Rotors::quad_x(rotor, 0.25)?;
/// let allocation = rotors.allocate(&Command::of_thrust(29.4));
/// assert!(!allocation.saturated);
/// assert!(allocation.speeds.iter().all(|speed| (speed - 606.2).abs() < 0.1));
/// # Ok::<(), controller::OutOfRange<f32>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotors<T, const N: usize> {
    /// A row of B⁺ a rotor: its force, N, per newton of thrust and newton metre of torque.
    inverse: [[T; 4]; N],
    /// N per newton of its force: the first column's reciprocals.
    thrust_per_force: [T; N],
    /// Force, N, that each rotor has left either way for roll and pitch, at the thrust where that
    /// is largest.
    room: [T; N],
    least_force: T,
    largest_force: T,
    /// Beyond what the rotors can give: commands are cut to this first, so that no product
    /// overflows.
    bounds: [T; 4],
    per_thrust_coefficient: T,
    per_largest_force: T,
}

/// Rows of unit length span a volume less than this only when, to f32's rounding, one of them
/// depends on the others.
const LEAST_PIVOT: f64 = 1e-4;

impl<T: Real, const N: usize> Rotors<T, N> {
    /// Rotors at `places`, their axes along b3.
    ///
    /// # Errors
    /// As [`from_matrix`](Self::from_matrix), or a place is out of [its
    /// range](crate::ranges::ROTOR_PLACE).
    pub fn new(rotor: RotorParams<T>, places: &[Place<T>; N]) -> Result<Self, OutOfRange<T>> {
        for place in places {
            for (range, along) in ROTOR_PLACE.iter().zip([place.x, place.y]) {
                range.check(along)?;
            }
        }
        let drag = rotor.torque_coefficient / rotor.thrust_coefficient;
        let mut effect = [[T::one(); N]; 4];
        for (i, place) in places.iter().enumerate() {
            effect[1][i] = -place.y;
            effect[2][i] = place.x;
            effect[3][i] = if place.counter_clockwise { drag } else { -drag };
        }
        Self::from_matrix(rotor, &effect)
    }

    /// Rotors that give thrust and torque (T, τ) = B f, by the matrix B = `effect` itself: for
    /// tilted axes, or a measured one. Each rotor must have a part in thrust alone (the first
    /// column of B⁺ positive), as in every configuration where rotors lift.
    ///
    /// # Errors
    /// A number of `rotor` or `effect` is out of range, the rotors do not act on thrust and each
    /// torque apart, or a rotor has no share of the thrust or no room for torque.
    pub fn from_matrix(rotor: RotorParams<T>, effect: &[[T; N]; 4]) -> Result<Self, OutOfRange<T>> {
        rotor.check()?;
        for x in effect.iter().flatten() {
            OutOfRange::check("effect", *x, -100.0, 100.0)?;
        }
        let inverse = pseudo_inverse(effect)?;
        let force = |speed: T| rotor.thrust_coefficient * speed * speed;
        let (least_force, largest_force) = (force(rotor.min_speed), force(rotor.max_speed));
        // At thrust t rotor i has force c_i t, and the smaller of c_i t − least and largest − c_i t
        // as room.
        let shares = inverse.map(|[c, ..]| c);
        for &share in &shares {
            OutOfRange::check("share of thrust", share, 1e-3, 1e3)?;
        }
        let least = shares.iter().fold(T::lit(1e3), |least, &c| least.min(c));
        let largest = shares.iter().fold(T::zero(), |largest, &c| largest.max(c));
        let middle = (least_force + largest_force) / (least + largest);
        let room = shares.map(|c| (c * middle - least_force).min(largest_force - c * middle));
        for &room in &room {
            OutOfRange::within("room for torque", room, largest_force * T::lit(1e-6), T::lit(f64::from(f32::MAX)))?;
        }
        let bounds = effect.map(|row| row.iter().fold(T::zero(), |sum, &x| sum + x.abs()) * largest_force);
        Ok(Self {
            inverse,
            thrust_per_force: shares.map(|c| T::one() / c),
            room,
            least_force,
            largest_force,
            bounds,
            per_thrust_coefficient: T::one() / rotor.thrust_coefficient,
            per_largest_force: T::one() / largest_force,
        })
    }

    /// The speeds for `command`, and what they apply. Total: what is not a number counts as zero.
    pub fn allocate(&self, command: &Command<T>) -> Allocation<T, N> {
        let (thrusts, applied) = self.share_out(command);
        Allocation {
            speeds: thrusts.map(|force| (force * self.per_thrust_coefficient).sqrt()),
            thrusts,
            applied,
            saturated: applied != *command,
        }
    }

    /// The forces for `command`, and what they apply.
    #[inline(always)]
    fn share_out(&self, command: &Command<T>) -> ([T; N], Command<T>) {
        let zero = T::zero();
        let [_, b1, b2, b3] = self.bounds;
        let cut = |x: T, bound: T| {
            if x.abs() <= bound {
                x
            } else if x > bound {
                bound
            } else if x < -bound {
                -bound
            } else {
                zero
            }
        };
        let Command { thrust, torque } = *command;
        let torque = Vector3::new(cut(torque.x, b1), cut(torque.y, b2), cut(torque.z, b3));
        self.share_out_bounded(&Command { thrust, torque })
    }

    /// The same of a torque within the [largest](Self::largest).
    #[inline(always)]
    fn share_out_bounded(&self, command: &Command<T>) -> ([T; N], Command<T>) {
        let (zero, one) = (T::zero(), T::one());
        let Command { thrust, torque } = command;
        let (roll, pitch, yaw) = (torque.x, torque.y, torque.z);

        // Roll and pitch as far as there is room.
        let mut forces = self.inverse.map(|[_, r, p, _]| r * roll + p * pitch);
        let mut most = zero;
        for (force, room) in forces.iter().zip(&self.room) {
            most = most.max(force.abs() / *room);
        }
        let kept = if most > one { one / most } else { one };

        // Thrust between what the rotors then need and what they have.
        let mut least = zero;
        let mut largest = T::lit(f64::from(f32::MAX));
        for (force, per_force) in forces.iter_mut().zip(&self.thrust_per_force) {
            *force *= kept;
            least = least.max((self.least_force - *force) * *per_force);
            largest = largest.min((self.largest_force - *force) * *per_force);
        }
        let applied_thrust = thrust.clamp(least, largest);

        // Yaw as far as any of it is left.
        let mut yaw_kept = one;
        for (force, row) in forces.iter_mut().zip(&self.inverse) {
            *force += row[0] * applied_thrust;
            let wanted = row[3] * yaw;
            let left = if wanted > zero { self.largest_force - *force } else { *force - self.least_force }.max(zero);
            if wanted.abs() > left {
                yaw_kept = yaw_kept.min(left / wanted.abs());
            }
        }
        for (force, row) in forces.iter_mut().zip(&self.inverse) {
            // Rounding alone can lead outside.
            *force = (*force + row[3] * yaw * yaw_kept).clamp(self.least_force, self.largest_force);
        }
        let applied =
            Command { thrust: applied_thrust, torque: Vector3::new(roll * kept, pitch * kept, yaw * yaw_kept) };
        (forces, applied)
    }

    /// What is [applied](Actuation::apply) of a command whose torque is within the
    /// [largest](Self::largest), as limits may have left it.
    // Without the forces themselves, of which half of the cost is.
    #[inline(never)]
    pub fn apply_bounded(&self, command: &Command<T>) -> Command<T> {
        self.share_out_bounded(command).1
    }

    /// Thrust, N, and torque about b1, b2 and b3, N·m, that no command for these rotors exceeds:
    /// each rotor's largest force with its lever, added up.
    #[must_use]
    pub fn largest(&self) -> &[T; 4] {
        &self.bounds
    }

    /// The speeds, rad/s, of a command as it was [applied](Actuation::apply): those that
    /// [`allocate`](Self::allocate) finds for it, without looking for what has to be given up.
    #[inline]
    pub fn speeds(&self, applied: &Command<T>) -> [T; N] {
        self.roots(applied, self.per_thrust_coefficient)
    }

    /// The same as shares of the largest speed, up to 1.
    #[inline]
    pub fn duties(&self, applied: &Command<T>) -> [T; N] {
        self.roots(applied, self.per_largest_force)
    }

    /// The root of `scale` times each force, up to the largest force's.
    #[inline(always)]
    fn roots(&self, applied: &Command<T>, scale: T) -> [T; N] {
        let (least, largest) = (self.least_force * scale, self.largest_force * scale);
        let Command { thrust, torque } = applied.times(scale);
        self.inverse.map(|[t, r, p, y]| {
            let force = r * torque.x + p * torque.y + t * thrust + y * torque.z;
            force.clamp(least, largest).sqrt()
        })
    }
}

impl<T: Real> Rotors<T, 4> {
    /// A quadrotor with arms of `arm` m, its first rotor in front; spins alternate around it,
    /// counter-clockwise first.
    ///
    /// # Errors
    /// As [`new`](Self::new), or `arm` is out of [its range](crate::ranges::ROTOR_ARM).
    pub fn quad_plus(rotor: RotorParams<T>, arm: T) -> Result<Self, OutOfRange<T>> {
        Self::new(rotor, &ring(arm, 0.0)?)
    }

    /// A quadrotor with arms of `arm` m at 45° to its axes: front right, rear right, rear left,
    /// front left; spins alternate, counter-clockwise first.
    ///
    /// # Errors
    /// As [`new`](Self::new), or `arm` is out of [its range](crate::ranges::ROTOR_ARM).
    pub fn quad_x(rotor: RotorParams<T>, arm: T) -> Result<Self, OutOfRange<T>> {
        Self::new(rotor, &ring(arm, 0.5)?)
    }
}

impl<T: Real> Rotors<T, 6> {
    /// A hexarotor with arms of `arm` m, its first rotor in front; spins alternate,
    /// counter-clockwise first.
    ///
    /// # Errors
    /// As [`new`](Self::new), or `arm` is out of [its range](crate::ranges::ROTOR_ARM).
    pub fn hexa(rotor: RotorParams<T>, arm: T) -> Result<Self, OutOfRange<T>> {
        Self::new(rotor, &ring(arm, 0.0)?)
    }
}

impl<T: Real, const N: usize> Actuation<T> for Rotors<T, N> {
    /// Always: it was checked when it was made.
    fn check(&self) -> Result<(), OutOfRange<T>> {
        Ok(())
    }

    // Without the forces themselves, of which half of the cost is.
    #[inline(never)]
    fn apply(&self, command: &Command<T>) -> Command<T> {
        self.share_out(command).1
    }

    fn least_thrust(&self) -> T {
        self.apply(&Command::zero()).thrust
    }
}

/// N places on a ring, clockwise seen from above, the first `turned` steps from b1.
fn ring<T: Real, const N: usize>(arm: T, turned: f64) -> Result<[Place<T>; N], OutOfRange<T>> {
    ROTOR_ARM.check(arm)?;
    Ok(core::array::from_fn(|i| {
        let angle = (i as f64 + turned) * core::f64::consts::TAU / N as f64;
        let (sin, cos) = T::lit(angle).sin_cos();
        Place { x: arm * cos, y: arm * sin, counter_clockwise: i % 2 == 0 }
    }))
}

/// Bᵀ (B Bᵀ)⁻¹, by Gauss and Jordan with pivots, on rows brought to unit length.
fn pseudo_inverse<T: Real, const N: usize>(effect: &[[T; N]; 4]) -> Result<[[T; 4]; N], OutOfRange<T>> {
    const FIELDS: [&str; 4] = ["effect on thrust", "effect on roll", "effect on pitch", "effect on yaw"];
    let product = |a: &[T; N], b: &[T; N]| a.iter().zip(b).fold(T::zero(), |sum, (&a, &b)| sum + a * b);
    let mut rows = *effect;
    let mut lengths = [T::one(); 4];
    for ((row, length), field) in rows.iter_mut().zip(&mut lengths).zip(FIELDS) {
        *length = product(row, row).sqrt();
        OutOfRange::check(field, *length, 1e-6, 1e6)?;
        *row = row.map(|x| x / *length);
    }
    // [B Bᵀ | 1] → [1 | (B Bᵀ)⁻¹].
    let mut table = [[T::zero(); 8]; 4];
    for (i, line) in table.iter_mut().enumerate() {
        for (j, row) in rows.iter().enumerate() {
            line[j] = product(&rows[i], row);
        }
        line[4 + i] = T::one();
    }
    for k in 0..4 {
        let mut pivot = k;
        for i in k + 1..4 {
            if table[i][k].abs() > table[pivot][k].abs() {
                pivot = i;
            }
        }
        table.swap(k, pivot);
        OutOfRange::check("rank of the rotors' effect", table[k][k].abs(), LEAST_PIVOT, 1e6)?;
        let scale = T::one() / table[k][k];
        let line = table[k].map(|x| x * scale);
        table[k] = line;
        for (i, other) in table.iter_mut().enumerate() {
            if i != k {
                let factor = other[k];
                for (x, y) in other.iter_mut().zip(&line) {
                    *x -= factor * *y;
                }
            }
        }
    }
    Ok(core::array::from_fn(|n| {
        core::array::from_fn(|j| {
            let sum = (0..4).fold(T::zero(), |sum, i| sum + rows[i][n] * table[i][4 + j]);
            sum / lengths[j]
        })
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOVER: f64 = 29.43;

    fn rotor() -> RotorParams<f64> {
        RotorParams::typical(HOVER, 4)
    }

    fn command(thrust: f64, torque: [f64; 3]) -> Command<f64> {
        Command { thrust, torque: torque.into() }
    }

    /// (T, τ) from the forces of rotors at `places`, by the definition.
    fn together<const N: usize>(places: &[Place<f64>; N], thrusts: &[f64; N], drag: f64) -> Command<f64> {
        let mut sum = Command::zero();
        for (place, force) in places.iter().zip(thrusts) {
            let arm = Vector3::new(place.x, place.y, 0.0);
            sum.thrust += force;
            sum.torque += arm.cross(&Vector3::new(0.0, 0.0, -force));
            sum.torque.z += if place.counter_clockwise { drag * force } else { -drag * force };
        }
        sum
    }

    fn distance(a: &Command<f64>, b: &Command<f64>) -> f64 {
        (a.thrust - b.thrust).abs() + (a.torque - b.torque).abs().sum()
    }

    fn allocation_is_what_it_says<const N: usize>(rotor: RotorParams<f64>, places: &[Place<f64>; N]) {
        let rotors = Rotors::new(rotor, places).unwrap();
        let drag = rotor.torque_coefficient / rotor.thrust_coefficient;
        let mut seed = 1_u64;
        let mut uniform = |most: f64| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0) * most
        };
        let (mut free, mut saturated) = (0, 0);
        for _ in 0..20_000 {
            let wanted = command(HOVER + uniform(HOVER), [uniform(5.0), uniform(5.0), uniform(0.5)]);
            let Allocation { speeds, thrusts, applied, saturated: is_saturated } = rotors.allocate(&wanted);
            assert!(distance(&together(places, &thrusts, drag), &applied) < 1e-9, "{wanted:?} {applied:?}");
            for (speed, force) in speeds.iter().zip(&thrusts) {
                assert!((rotor.thrust_coefficient * speed * speed - force).abs() < 1e-9);
                assert!(*speed >= rotor.min_speed * (1.0 - 1e-12) && *speed <= rotor.max_speed * (1.0 + 1e-12));
            }
            assert_eq!(is_saturated, applied != wanted);
            // Applied once, it is applied again as it is: callers may ask twice.
            assert!(
                distance(&rotors.allocate(&applied).applied, &applied) < 1e-9,
                "{wanted:?} {applied:?} {:?}",
                rotors.allocate(&applied)
            );
            if is_saturated {
                saturated += 1;
            } else {
                free += 1;
            }
            // Priorities: yaw is not the reason to give up thrust, nor either to give up roll and
            // pitch.
            let alone = rotors.allocate(&command(wanted.thrust, [wanted.torque.x, wanted.torque.y, 0.0])).applied;
            assert!(
                (alone.thrust - applied.thrust).abs() < 1e-12
                    && (alone.torque.xy() - applied.torque.xy()).abs().sum() < 1e-12
            );
            let other = rotors.allocate(&command(HOVER, wanted.torque.into())).applied;
            assert!((other.torque.xy() - applied.torque.xy()).abs().sum() < 1e-12);
            // Nothing is turned round, and proportions are kept.
            assert!(applied.torque.x * wanted.torque.y - applied.torque.y * wanted.torque.x < 1e-9);
            assert!(applied.torque.component_mul(&wanted.torque).min() >= 0.0);
        }
        assert!(free > 1000 && saturated > 1000, "{free} {saturated}");
    }

    #[test]
    fn rotors_give_what_is_applied_in_the_stated_order() {
        allocation_is_what_it_says(rotor(), &ring::<f64, 4>(0.25, 0.0).unwrap());
        allocation_is_what_it_says(rotor(), &ring::<f64, 4>(0.25, 0.5).unwrap());
        allocation_is_what_it_says(RotorParams::typical(HOVER, 6), &ring::<f64, 6>(0.3, 0.0).unwrap());
        // A quadrotor longer than wide, its centre of mass off the middle.
        let place = |x, y, counter_clockwise| Place { x, y, counter_clockwise };
        let places =
            [place(0.3, 0.2, true), place(-0.25, 0.2, false), place(-0.25, -0.2, true), place(0.3, -0.2, false)];
        allocation_is_what_it_says(rotor(), &places);
    }

    #[test]
    fn quad_x_is_the_known_mixer() {
        // f = (T ∓ τ1/l ± τ2/l ± τ3/k)/4 with l = arm/√2, for front right, rear right, rear left,
        // front left.
        let rotor = rotor();
        let rotors = Rotors::quad_x(rotor, 0.25).unwrap();
        let (l, k) = (0.25 / 2.0_f64.sqrt(), rotor.torque_coefficient / rotor.thrust_coefficient);
        let [t, roll, pitch, yaw] = [HOVER, 0.3, -0.2, 0.02];
        let found = rotors.allocate(&command(t, [roll, pitch, yaw]));
        let signs = [[-1.0, 1.0, 1.0], [-1.0, -1.0, -1.0], [1.0, -1.0, 1.0], [1.0, 1.0, -1.0]];
        for (force, [x, y, z]) in found.thrusts.iter().zip(signs) {
            let expected = (t + x * roll / l + y * pitch / l + z * yaw / k) / 4.0;
            assert!((force - expected).abs() < 1e-12, "{force} {expected}");
        }
        assert!(!found.saturated);
    }

    #[test]
    fn every_bit_pattern_is_answered() {
        let rotors = Rotors::quad_x(RotorParams::typical(29.43_f32, 4), 0.25).unwrap();
        let odd = [0.0, -0.0, 1.0, -1.0, 1e-45, 3e38, -3e38, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
        for thrust in odd {
            for x in odd {
                for y in odd {
                    for z in odd {
                        let found = rotors.allocate(&Command { thrust, torque: Vector3::new(x, y, z) });
                        assert!(found.applied.is_finite(), "{thrust} {x} {y} {z}");
                        assert!(found.speeds.iter().chain(&found.thrusts).all(|s| s.is_finite() && *s >= 0.0));
                    }
                }
            }
        }
    }

    #[test]
    fn rotors_that_can_not_fly_are_refused_by_name() {
        let refused = |rotor, places: &[Place<f64>; 4]| Rotors::new(rotor, places).unwrap_err().field;
        let quad = ring::<f64, 4>(0.25, 0.0).unwrap();
        assert_eq!(refused(RotorParams { thrust_coefficient: f64::NAN, ..rotor() }, &quad), "thrust_coefficient");
        assert_eq!(refused(RotorParams { torque_coefficient: 0.0, ..rotor() }, &quad), "torque_coefficient");
        assert_eq!(refused(RotorParams { min_speed: 1e4, ..rotor() }, &quad), "min_speed");
        assert_eq!(refused(RotorParams { max_speed: f64::INFINITY, ..rotor() }, &quad), "max_speed");
        assert_eq!(refused(rotor(), &quad.map(|p| Place { y: 0.0, ..p })), "effect on roll");
        assert_eq!(refused(rotor(), &quad.map(|p| Place { x: f64::NAN, ..p })), "x");
        // Rotors that all turn one way give no yaw without thrust; on one diagonal, no pitch
        // without roll.
        assert_eq!(
            refused(rotor(), &quad.map(|p| Place { counter_clockwise: true, ..p })),
            "rank of the rotors' effect"
        );
        assert_eq!(refused(rotor(), &quad.map(|p| Place { y: p.x, ..p })), "rank of the rotors' effect");
        assert_eq!(Rotors::quad_x(rotor(), f64::NAN).unwrap_err().field, "arm");
    }
}
