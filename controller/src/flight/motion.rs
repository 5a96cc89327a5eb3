//! Whether load, rod and UAV move as their velocities say.

use model::{Real, State, Uav, is_within};
use nalgebra::Vector3;

/// A position, m, or a rod, rad, further from where the velocities lead than this, for as long as
/// this, s, contradicts them.
const OFF: f64 = 0.3;
const ROD_OFF: f64 = 0.08;
const LONG: f64 = 0.1;
/// A share of that is enough where the velocity stands still to the last bit and the position moves.
const STUCK: f64 = 0.3;
/// Time, s, over which a difference is forgotten: a velocity may be wrong by `OFF` in this time,
/// 0.6 m/s, for ever, and a position that has jumped is believed once this has been forgotten. While
/// one of them stands still to the last bit, nothing is: that may be a sensor's last word.
const FORGOTTEN: f64 = 0.5;

/// The watch on two bodies' positions and velocities, and on the rod's direction and rate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion<T> {
    period: T,
    /// Time since load and UAV were measured, s.
    unseen: [T; 2],
    /// Whether the UAV was ever measured.
    has_uav: bool,
    load: Led<T>,
    rod: Led<T>,
    uav: Led<T>,
}

impl<T: Real> Motion<T> {
    /// Nothing has been measured yet.
    pub(crate) fn new(period: T) -> Self {
        let led = Led::at(&Vector3::zeros(), &Vector3::zeros());
        Self { period, unseen: [T::lit(FORGOTTEN); 2], has_uav: false, load: led, rod: led, uav: led }
    }

    /// What is measured next is where both are.
    pub(crate) fn forget(&mut self) {
        self.unseen = [T::lit(FORGOTTEN); 2];
        self.has_uav = false;
    }

    /// A period has passed.
    #[inline]
    pub(crate) fn pass(&mut self) {
        self.unseen = self.unseen.map(|unseen| unseen + self.period);
    }

    /// Takes in the UAV as it is measured; of the load, [`see_load`](Self::see_load).
    #[inline(never)]
    pub(crate) fn see_uav(&mut self, uav: &Uav<T>) {
        self.has_uav = true;
        let [_, unseen] = &mut self.unseen;
        self.uav.see(&uav.position, &uav.velocity, T::lit(OFF), core::mem::replace(unseen, T::zero()));
    }

    /// What of the UAV's position and velocity stands still to the last bit: a sensor's last word, or
    /// one that comes less often than the other.
    #[inline]
    pub(crate) fn standing(&self) -> Option<Standing> {
        match self.uav.stands {
            [true, _] => Some(Standing::Position),
            [false, true] => Some(Standing::Velocity),
            [false, false] => None,
        }
    }

    /// How far the UAV's velocity has led it while its position stood, m.
    pub(crate) fn led(&self) -> &Vector3<T> {
        &self.uav.led
    }

    /// Whether the UAV was ever measured.
    #[inline]
    pub(crate) fn has_uav(&self) -> bool {
        self.has_uav
    }

    /// Where a UAV that is not measured has come to, a period later with this `velocity`, m/s.
    pub(crate) fn carry(&mut self, velocity: &Vector3<T>) -> Vector3<T> {
        self.uav.place += velocity * self.period;
        self.uav.place
    }

    /// Takes in load and rod as they are measured.
    #[inline(never)]
    pub(crate) fn see_load(&mut self, state: &State<T>) {
        let [unseen, _] = &mut self.unseen;
        let passed = core::mem::replace(unseen, T::zero());
        self.load.see(&state.position, &state.velocity, T::lit(OFF), passed);
        self.rod.see(&state.rod, &state.rod_rate, T::lit(ROD_OFF), passed);
    }

    /// What has not moved as its velocity says.
    pub(crate) fn off(&self) -> Off {
        Off { load: self.load.is_off(), rod: self.rod.is_off(), uav: self.uav.is_off() }
    }

    /// On a taut cable of this `length`, m, `uav` and one of load and rod say where the other is, if
    /// that alone has not moved as its velocity says.
    pub(crate) fn mended(&self, state: &State<T>, uav: &Uav<T>, length: T) -> Option<State<T>> {
        match self.off() {
            Off { load: true, rod: false, uav: false } => Some(State {
                position: uav.position + state.rod * length,
                velocity: uav.velocity + state.rod_rate * length,
                ..*state
            }),
            Off { load: false, rod: true, uav: false } => Some(uav.with_load(state.position, state.velocity)),
            _ => None,
        }
    }
}

/// What stands still.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Standing {
    Position,
    Velocity,
}

/// What has not moved as its velocity says.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Off {
    pub(crate) load: bool,
    pub(crate) rod: bool,
    pub(crate) uav: bool,
}

/// Where a velocity has led.
#[derive(Clone, Copy, Debug)]
struct Led<T> {
    place: Vector3<T>,
    /// Position and velocity as they were measured last, whether that was once more what had been
    /// before, and for how long one of them has stood so, s.
    last: [Vector3<T>; 2],
    stands: [bool; 2],
    standing: T,
    /// How far the velocity has led since the position was another one.
    led: Vector3<T>,
    /// For how long the position has been off the place, s.
    off: T,
}

impl<T: Real> Led<T> {
    /// Nothing has led away from `position`.
    fn at(position: &Vector3<T>, velocity: &Vector3<T>) -> Self {
        let (zero, led) = (T::zero(), Vector3::zeros());
        Self { place: *position, last: [*position, *velocity], stands: [false; 2], standing: zero, led, off: zero }
    }

    /// A time `passed` (s) later `position` and `velocity` are measured; they may be off by `most`.
    #[inline(never)]
    fn see(&mut self, position: &Vector3<T>, velocity: &Vector3<T>, most: T, passed: T) {
        if passed >= T::lit(FORGOTTEN) {
            *self = Self::at(position, velocity);
            return;
        }
        let [last_position, last_velocity] = core::mem::replace(&mut self.last, [*position, *velocity]);
        self.stands = [*position == last_position, *velocity == last_velocity];
        let step = velocity * passed;
        self.place += step;
        self.led = if self.stands[0] { self.led + step } else { Vector3::zeros() };
        self.standing += passed;
        let off = position - self.place;
        if self.stands == [false; 2] {
            self.place += off * (self.standing * T::lit(1.0 / FORGOTTEN)).min(T::one());
            self.standing = T::zero();
        }
        let most = if self.stands == [false, true] { most * T::lit(STUCK) } else { most };
        self.off = if is_within(&off, most * most) { T::zero() } else { self.off + passed };
    }

    fn is_off(&self) -> bool {
        self.off > T::lit(LONG)
    }
}
