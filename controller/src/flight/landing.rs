//! Landing: the load is set down first, then the UAV beside it.
//!
//! With the UAV's own navigation that is a descent beside the load with a slack cable. With the
//! rod's direction alone the UAV's distance from the load is known only while the cable is taut. So
//! it is kept taut: once the load stands, the UAV is flown along the sphere of radius L around it,
//! under a small tension, down to the ground. That the load stands is seen by its standing still
//! while it is being sunk; it is believed for as long as the load does not fall when a part of its
//! weight is taken off the thrust. Theory (14.6), (14.7).

use model::{Real, State, Uav, Vehicle, is_within};
use nalgebra::Vector3;

/// The UAV lands no further beside the load than this share of the cable.
const ROOM: f64 = 0.6;
/// By the rod it goes around the load at no more than this speed, m/s.
const AROUND: f64 = 0.4;
/// Nearer to above the load than this, m, aside is forward.
const ABOVE: f64 = 0.05;
/// A load stands when its speed has been below this share of the descent's, for so long, s, after
/// it sank at that share for so long, s; or, where it has not sunk, with this share of its weight gone from the
/// pull.
const STILL: f64 = 0.2;
const TOUCHED: f64 = 0.05;
const SUNK: f64 = 0.4;
const SINKING: f64 = 0.5;
const UNWEIGHTED: f64 = 0.5;
/// When the load comes to stand the UAV is still sinking, with a cable that has just gone slack.
/// For so long, s, its velocity is reckoned from its thrust and brought to this, m/s, so that the
/// cable tautens gently; meanwhile the thrust exceeds the weight by this share of the load's.
const CATCHING: f64 = 0.7;
const TAUTENING: f64 = -0.1;
const CATCHING_SHARE: f64 = 0.35;
/// Tension of the cable while the UAV goes around the load, a share of the load's weight: above it,
/// where an error of the thrust goes into it, and beside it, where friction has to hold the load.
const TENSION_ABOVE: f64 = 0.6;
const TENSION_BESIDE: f64 = 0.2;

/// Where a landing has come to.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Landing<T> {
    /// Time since the load was set down, s; 0 before.
    set_down: T,
    /// Level direction in which the UAV then goes.
    aside: Vector3<T>,
    /// It was set down by the rod alone.
    is_by_rod: bool,
    /// For how long the load has sunk, up to [`SINKING`], and stood still, s.
    sunk: T,
    still: T,
    /// The UAV's reckoned velocity along n3, m/s, and from when it was set down the level pull,
    /// m/s², and the rod's angle from the vertical, rad.
    falling: T,
    wind: Vector3<T>,
    from: T,
}

/// What hold is to fly.
pub(crate) struct Aim<T> {
    /// The UAV as it is to be taken.
    pub uav: Uav<T>,
    /// Where it should be, m, and how fast, m/s.
    pub target: Vector3<T>,
    pub velocity: Vector3<T>,
    /// What pulls at it, per UAV mass, m/s².
    pub pull: Vector3<T>,
}

impl<T: Real> Landing<T> {
    /// Nothing has been set down.
    pub(crate) fn begin() -> Self {
        Self {
            set_down: T::zero(),
            aside: Vector3::zeros(),
            is_by_rod: false,
            sunk: T::zero(),
            still: T::zero(),
            falling: T::zero(),
            wind: Vector3::zeros(),
            from: T::zero(),
        }
    }

    /// By its own navigation: the velocity, m/s, at which the UAV goes for the coming `period`, s.
    /// Once the cable is slack, it goes aside as fast as it sinks, so that the cable stays slack,
    /// until it is far enough from the `load`, m, or has gone as far; not where it may be carried
    /// by the ground. As far aside as wanted is no more than a part of the cable's `length`, m.
    #[inline(never)]
    pub(crate) fn velocity(
        &mut self,
        load: Option<Vector3<T>>,
        now: &Uav<T>,
        (is_slack, is_carried): (bool, bool),
        (descent, wanted, length): (T, T, T),
        period: T,
    ) -> Vector3<T> {
        let sinking = Vector3::new(T::zero(), T::zero(), descent);
        if !is_slack {
            (self.set_down, self.is_by_rod) = (T::zero(), false);
            return sinking;
        }
        let line = load.map(|load| now.position - load);
        if self.set_down == T::zero() {
            self.aside = aside(now, line);
        }
        self.set_down += period;
        let gone = line.map_or(self.set_down * descent, |line| line.dot(&self.aside));
        let is_clear = gone >= wanted.min(length * T::lit(ROOM));
        if is_clear || is_carried { sinking } else { sinking + self.aside * descent }
    }

    /// Whether the load is down.
    pub(crate) fn is_set_down(&self) -> bool {
        self.set_down > T::zero()
    }

    /// Whether it was set down by the rod alone, which keeps the cable taut.
    pub(crate) fn is_by_rod(&self) -> bool {
        self.is_by_rod
    }

    /// By the rod alone, a `period` (s) on: what to fly once the load stands. The last `thrust` (N)
    /// acted along −b3; `usual` (N) hung from the UAV before, and `down` (N) does now; `pull`
    /// (m/s²) is observed.
    #[inline(never)]
    pub(crate) fn around(
        &mut self,
        vehicle: &Vehicle<T>,
        state: &State<T>,
        (thrust, [usual, down], pull): (T, [T; 2], &Vector3<T>),
        descent: T,
        period: T,
    ) -> Option<Aim<T>> {
        if self.is_set_down() && !self.is_by_rod {
            // Navigation is missing while the cable is slack.
            return None;
        }
        let params = vehicle.params();
        let sinking = state.velocity.z;
        if sinking > descent * T::lit(SUNK) {
            self.sunk = (self.sunk + period).min(T::lit(SINKING));
        }
        let has_sunk = self.sunk >= T::lit(SINKING);
        let mut uav = Uav::of(state, vehicle);
        if !self.is_set_down() {
            let is_still = sinking.abs() < descent * T::lit(STILL);
            self.still = if is_still { self.still + period } else { T::zero() };
            let gone = usual - down;
            let is_unweighted = gone > params.payload_mass * params.gravity * T::lit(UNWEIGHTED);
            if self.still < T::lit(TOUCHED) || !(has_sunk || is_unweighted) {
                return None;
            }
            self.is_by_rod = true;
            self.aside = aside(&uav, Some(state.rod * -params.rod_length));
            self.wind = Vector3::new(pull.x, pull.y, T::zero());
            let level = state.rod.x * state.rod.x + state.rod.y * state.rod.y;
            self.from = level.sqrt().atan2(state.rod.z);
            self.falling = if has_sunk { descent } else { T::zero() };
        } else if sinking > descent * T::lit(SUNK) {
            // It hangs after all.
            *self = Self::begin();
            return None;
        }
        self.set_down += period;

        // What the rotors must be told to carry a kilogram, by what carried both bodies.
        let gravity = params.gravity;
        let told = (params.uav_mass * gravity + usual) / vehicle.hover_thrust();
        let load = params.payload_mass * gravity / params.uav_mass;
        let weight = Vector3::new(T::zero(), T::zero(), (told - T::one()) * gravity);
        let carried = self.wind + weight;
        let length = params.rod_length;
        if self.set_down < T::lit(CATCHING) {
            self.falling += (gravity - thrust * state.attitude.m33 / (told * params.uav_mass)) * period;
            uav.velocity.z = self.falling;
            let velocity = Vector3::new(T::zero(), T::zero(), T::lit(TAUTENING));
            let pull = carried + state.rod * (told * load * T::lit(CATCHING_SHARE));
            return Some(Aim { uav, target: uav.position, velocity, pull });
        }
        // Along the meridian to beside the load, and from there straight down.
        let speed = descent.min(T::lit(AROUND));
        let way = self.from * length + (self.set_down - T::lit(CATCHING)) * speed;
        let quarter = T::lit(core::f64::consts::FRAC_PI_2);
        let angle = (way / length).min(quarter);
        let (sin, cos) = angle.sin_cos();
        let down = Vector3::new(T::zero(), T::zero(), T::one());
        let beyond = (way - length * quarter).max(T::zero());
        let target = state.position + self.aside * (length * sin) + down * (beyond - length * cos);
        let velocity = (self.aside * cos + down * sin) * speed;
        let above = state.rod.z.clamp(T::zero(), T::one());
        let tension = T::lit(TENSION_BESIDE) + T::lit(TENSION_ABOVE - TENSION_BESIDE) * above;
        Some(Aim { uav, target, velocity, pull: carried + state.rod * (told * load * tension) })
    }
}

/// The level direction away from the load, from which the UAV is by `line`, m; or forward.
fn aside<T: Real>(uav: &Uav<T>, line: Option<Vector3<T>>) -> Vector3<T> {
    let level = |v: Vector3<T>| Vector3::new(v.x, v.y, T::zero());
    let away = line.map_or_else(Vector3::zeros, level);
    let forward: Vector3<T> = uav.attitude.column(0).into();
    let aside = if is_within(&away, T::lit(ABOVE * ABOVE)) { level(forward) } else { away };
    aside / aside.dot(&aside).sqrt().max(T::lit(1e-3))
}
