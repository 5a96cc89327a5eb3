//! A jump of navigation, handed out over some seconds.
//!
//! A fix after an outage corrects the position by decimetres at once. To a law that answers with
//! the sixth derivative this is a blow; the estimate glides there instead. It keeps its position
//! and velocity over the jump, by a rest o that then vanishes critically damped, as fast as
//! a = 0.5 m/s² lets it:
//!
//! ```text
//! p = x_Q + L q + o,   v = v_Q + L q̇ + ȯ,   ö = −2 ȯ/τ − o/τ²,   τ = max(0.7 s, √(|o|/a))       (15)
//! ```
//!
//! Smaller corrections go through: spread out, they would only come later.

use model::{Real, Vector3};

/// Jumps of this size glide, m and m/s: below, it is the filter's daily work; above, it is another
/// place, which the law has to join anew. Where one of the two glides, so does the other.
const LEAST: [f64; 2] = [0.05, 0.025];
const MOST: f64 = 2.0;
/// Least τ, s: about that of the slowest of usual poles.
const TIME: f64 = 0.7;
/// a, m/s²: twice that, after an outage of 5 s, took laws with poles of 2 to their margins.
const ACCELERATION: f64 = 0.5;

/// What is left of the jumps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Glide<T> {
    /// o, m, and its rate, m/s, in N.
    pub(super) rest: Vector3<T>,
    pub(super) rate: Vector3<T>,
    /// 1/τ, 1/s.
    per_time: T,
}

impl<T: Real> Glide<T> {
    pub(super) fn none() -> Self {
        Self { rest: Vector3::zeros(), rate: Vector3::zeros(), per_time: T::lit(1.0 / TIME) }
    }

    /// Position and velocity have moved by these, m and m/s, beyond what velocity and acceleration
    /// move them by.
    #[inline(always)]
    pub(super) fn take(&mut self, position: &Vector3<T>, velocity: &Vector3<T>) {
        let squares = [position.dot(position), velocity.dot(velocity)];
        let is_small = squares.into_iter().zip(LEAST).all(|(square, least)| square <= T::lit(least * least));
        if !is_small {
            for ((left, jump), square) in
                [(&mut self.rest, position), (&mut self.rate, velocity)].into_iter().zip(squares)
            {
                if square < T::lit(MOST * MOST) {
                    *left -= jump;
                }
            }
            let (rest, rate) = (self.rest.dot(&self.rest), self.rate.dot(&self.rate));
            // Jump upon jump: there is no place to glide from.
            if rest.max(rate) >= T::lit(MOST * MOST) {
                *self = Self::none();
                return;
            }
            let square = rest.max(T::lit(LEAST[0] * LEAST[0]));
            self.per_time = (T::lit(ACCELERATION) / square.sqrt()).sqrt().min(T::lit(1.0 / TIME));
        }
    }

    /// A period goes by.
    #[inline(always)]
    pub(super) fn pass(&mut self, period: T) {
        self.rate -= (self.rate * T::lit(2.0) + self.rest * self.per_time) * (self.per_time * period);
        self.rest += self.rate * period;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: f64 = 0.002;

    /// Nothing jumps, velocity is the derivative of position, and in ten times τ it is gone.
    #[test]
    fn a_jump_is_handed_out_in_time() {
        for (size, time) in [(0.2, TIME), (1.9, (1.9 / ACCELERATION).sqrt())] {
            let mut glide = Glide::none();
            let jump = Vector3::new(size, 0.0, 0.0);
            glide.take(&jump, &Vector3::zeros());
            // The position that comes out right after the jump is the one before it.
            assert_eq!(glide.rest, -jump);
            let mut fastest = 0.0_f64;
            for _ in 0..(10.0 * time / PERIOD) as u32 {
                let before = glide.rest;
                glide.pass(PERIOD);
                assert!((glide.rest - before - glide.rate * PERIOD).amax() < 1e-15);
                fastest = fastest.max(glide.rate.x);
            }
            // The critically damped rest (1 + t/τ) e^(−t/τ) has its steepest slope 1/(e τ) at τ,
            // and is 5e-4 at 10 τ.
            assert!((fastest * time / size - (-1.0_f64).exp()).abs() < 0.01, "{fastest}");
            assert!(glide.rest.amax() < 6e-4 * size, "{}", glide.rest);
        }
    }

    #[test]
    fn jumps_upon_jumps_do_not_pile_up() {
        let mut glide = Glide::none();
        for _ in 0..1000 {
            glide.take(&Vector3::new(1.5, 0.0, 0.0), &Vector3::new(0.0, 1.5, 0.0));
            glide.pass(PERIOD);
            assert!(glide.rest.amax() < MOST && glide.rate.amax() < MOST);
        }
    }

    /// A fix after an outage corrects both: to a law with poles to 15/s even 5 cm/s at once are a blow
    /// at which its torque saturates.
    #[test]
    fn a_small_velocity_glides_with_a_position_that_jumps() {
        for (place, speed) in [(0.1, 0.02), (0.01, 0.03)] {
            let mut glide = Glide::none();
            glide.take(&Vector3::new(place, 0.0, 0.0), &Vector3::new(0.0, speed, 0.0));
            assert_eq!((glide.rest.x, glide.rate.y), (-place, -speed));
        }
    }

    #[test]
    fn small_corrections_and_other_places_go_through() {
        for (place, speed) in [(0.04, 0.02), (2.5, 2.5), (f64::NAN, f64::NAN)] {
            let mut glide = Glide::none();
            glide.take(&Vector3::new(place, 0.0, 0.0), &Vector3::new(0.0, speed, 0.0));
            assert_eq!((glide.rest, glide.rate), (Vector3::zeros(), Vector3::zeros()));
        }
    }
}
