//! The payload filter: where the load is, from how the UAV moves and what thrust it was given.
//!
//! Twelve error states behind any navigation filter. The accelerometer drives a
//! [pendulum](pendulum), whose swing the [thrust model](thrust) sees; navigation itself is never
//! touched by what the load's model makes of it.
//!
//! A cycle of 30 periods (60 ms at 500 Hz) spreads the work: every period moves the pendulum on and
//! sums up the thrust model's residual; the [covariance](predict) moves in one of them, and each
//! scalar has one of its own. What the filter waits for it counts in periods and cycles.

mod glide;
mod health;
#[cfg(test)]
mod jacobians;
mod load;
mod params;
mod pendulum;
mod predict;
mod state;
mod thrust;
mod track;

pub use health::{Cable, Health, Validity};
pub use load::LoadMeasurement;
pub use params::{PayloadNoise, PayloadParams};
pub use state::PayloadState;

use model::{Matrix3, OutOfRange, Real, State, Uav, Vector3};

use crate::covariance::{Scalar, dot};
use crate::lever::{axes, swing};
use crate::motion::Motion;
use glide::Glide;
use health::CableWatch;
use load::{Innovations, Swing};
use pendulum::{Pendulum, Pivot, Pull};
use predict::{Covariance, Spread};
use state::{ERRORS, index};
use thrust::{Axis, Batch, Linearized, Mean, Window};
use track::Track;

/// Periods of a cycle.
const CYCLE: u8 = 30;
/// Periods of a window with a thrust told, at least.
const LEAST: f64 = 15.0;
/// Periods without inputs after which the estimate is blind: 0.1 s at 500 Hz.
const BLIND: u16 = 50;
/// Standard deviation of the rod above which it does not count as known, rad.
const KNOWN: f64 = 0.15;
/// Mean ν²/S above which noise does not explain what is seen.
const CONSISTENT: f64 = 8.0;
/// Mean ν²/S above which the filter starts anew from the cable's pull. A noise told three times too
/// small is 9.
const ASTRAY: f64 = 20.0;
/// ν²/S of one scalar counts as so much at most: one wild window may not stand for many.
const WILD: f64 = 25.0;
/// Fastest rod, 1/s.
const FASTEST: f64 = 30.0;
/// Cycles after which what was found with a valid rod is believed without one: 10 s at 500 Hz.
const PROVEN: u8 = 167;
/// Cycles for which the rod has to be known before the mass is looked for: 1.2 s at 500 Hz. Until
/// then a very light load blown far out explains what is measured as well, and a filter that may
/// choose finds it: on a wide swing its covariance is too small for a moment, and a moment is enough.
const SURE: u8 = 20;
/// Half cycles for which the rod has to be known before it is valid: 6 s at 500 Hz. The mass that is
/// found meanwhile moves rod and rate by more than their deviations say, and a law that joins a path
/// on them swings. A cycle in which the rod is known to [`KNOWN`] only counts half: where the noise is
/// told three times too large that may be all that a UAV at rest comes to know.
const SETTLED: u8 = 202;
/// Standard deviation of an accelerometer that was not read, m/s².
const UNREAD: f64 = 2.0;

/// What a step answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate<T> {
    /// The law's state: payload and rod, with the line from the UAV's centre of mass to the load
    /// for the rod. Where navigation jumps by 5 cm to 2 m, or 2.5 cm/s to 2 m/s, it glides to the new
    /// place within some seconds; beyond, it jumps along.
    pub state: State<T>,
    /// What navigation's last jump has left in `state`'s position, m, and velocity, m/s.
    pub rest: [Vector3<T>; 2],
    /// The cable's pull m_L s by the pendulum, N.
    pub tension: T,
    /// Whether the cable carries.
    pub cable: Cable,
    /// What it is worth.
    pub health: Health<T>,
}

impl<T: Real> Estimate<T> {
    /// The UAV by navigation where it glides along with `state`: as a law is told it beside that.
    /// Of a jump that the one has taken and the other has not, a supervisor would say that load and
    /// UAV contradict each other.
    #[must_use]
    pub fn beside(&self, uav: &Uav<T>) -> Uav<T> {
        let [position, velocity] = self.rest;
        Uav { position: uav.position + position, velocity: uav.velocity + velocity, ..*uav }
    }
}

/// The filter.
#[derive(Clone, Debug)]
pub struct Payload<T> {
    params: PayloadParams<T>,
    spread: Spread<T>,
    state: PayloadState<T>,
    covariance: Covariance<T>,
    /// The period's place in the cycle.
    phase: u8,
    window: Window<T>,
    mean: Mean<T>,
    /// The pivot's specific force in N: summed up over the cycle, and its mean over the last one.
    force: Vector3<T>,
    mean_force: Vector3<T>,
    linearized: Linearized<T>,
    batch: Batch<T>,
    /// Cycles since the start.
    age: u8,
    /// Whether the mass has been known to 15 % since the start.
    is_mass_found: bool,
    /// Cycles for which the rod has been known.
    known: u8,
    /// For how many half cycles it has been, up to [`SETTLED`], which it keeps.
    settled: u8,
    health: Health<T>,
    /// Corrections of a batch that is not complete.
    pending: [T; ERRORS],
    watch: CableWatch<T>,
    load_surprise: [T; 2],
    /// Innovations of the load's rod and rate: being summed up, and being taken in.
    fresh: [Innovations<T>; 2],
    taken: [Innovations<T>; 2],
    last: Motion<T>,
    glide: Glide<T>,
    track: Track<T>,
    pull: Pull<T>,
    /// Periods without an input in a row, and since the covariance has moved.
    missing: u16,
    unread: T,
}

impl<T: Real> Payload<T> {
    /// A filter for a load that hangs straight down, as uncertain as the noise's start says.
    ///
    /// # Errors
    /// [`OutOfRange`] names the first parameter out of its range.
    pub fn new(params: PayloadParams<T>) -> Result<Self, OutOfRange<T>> {
        params.check()?;
        let (rod, rate) = (params.noise.start_rod, params.noise.start_rate);
        Ok(Self {
            spread: Spread::new(&params, params.period * T::lit(f64::from(CYCLE))),
            state: PayloadState::hanging(),
            covariance: Covariance::diagonal(&params.noise.start()),
            phase: 3,
            window: Window::empty(),
            mean: Mean { residual: Vector3::zeros(), thrust: T::zero(), is_full: false },
            // The first cycle begins at its fourth period.
            force: Vector3::new(T::zero(), T::zero(), params.gravity * T::lit(-3.0)),
            mean_force: Vector3::new(T::zero(), T::zero(), -params.gravity),
            linearized: Linearized::none(),
            batch: Batch::none(),
            age: 0,
            is_mass_found: false,
            known: 0,
            settled: 0,
            health: Health {
                validity: Validity::Converging,
                rod_deviation: rod * T::lit(core::f64::consts::SQRT_2),
                rate_deviation: rate * T::lit(core::f64::consts::SQRT_2),
                surprise: [T::one(); 3],
            },
            pending: [T::zero(); ERRORS],
            watch: CableWatch::new(Cable::Taut),
            load_surprise: [T::one(); 2],
            fresh: [Innovations::none(); 2],
            taken: [Innovations::none(); 2],
            last: Motion::at_rest(Vector3::zeros(), params.gravity),
            glide: Glide::none(),
            track: Track::none(),
            pull: Pull { u: Vector3::zeros(), tension: params.gravity, acceleration: Vector3::zeros() },
            // Nothing has been seen yet.
            missing: 1,
            unread: T::zero(),
            params,
        })
    }

    /// The same, told where the rod is: `rod` in N of any length, `rate` 1/s. It is believed to the
    /// start's deviations.
    #[must_use]
    pub fn with_rod(mut self, rod: &Vector3<T>, rate: &Vector3<T>) -> Self {
        let length = rod.dot(rod).sqrt();
        if length > T::zero() && rod.z > T::zero() && length.is_finite() && rate.dot(rate).is_finite() {
            self.state.set_rod([rod.x / length, rod.y / length], [rate.x, rate.y]);
        }
        self
    }

    /// The same, with the load on the ground: the cable is slack until it pulls.
    #[must_use]
    pub fn with_slack_cable(mut self) -> Self {
        self.watch = CableWatch::new(Cable::Slack);
        self
    }

    /// What it was told.
    pub fn params(&self) -> &PayloadParams<T> {
        &self.params
    }

    /// The nominal state: wind, thrust scale and mass among it.
    pub fn nominal(&self) -> &PayloadState<T> {
        &self.state
    }

    /// The covariance of the errors, in the order (η, ζ, w, r, l, k_T, μ).
    pub fn covariance(&self) -> [[T; ERRORS]; ERRORS] {
        self.covariance.full()
    }

    /// A measurement of the load, `age` s old at the last [`step`](Self::step), compared with the
    /// rod at once and taken in within a cycle. One that is not finite, or whose deviation is not
    /// positive, is ignored; so is any while the cable is slack. Returns whether it counts.
    pub fn observe(&mut self, measurement: &LoadMeasurement<T>, age: T) -> bool {
        let (value, deviation) = match measurement {
            LoadMeasurement::Direction(value, deviation)
            | LoadMeasurement::Position(value, deviation)
            | LoadMeasurement::Velocity(value, deviation) => (value, *deviation),
            LoadMeasurement::Pair([load, uav], deviation) if uav.dot(uav).is_finite() => (load, *deviation),
            LoadMeasurement::Pair(..) => return false,
        };
        let is_usable = value.dot(value).is_finite()
            && deviation > T::zero()
            && deviation.is_finite()
            && age >= T::zero()
            && age <= T::lit(0.5)
            && self.watch.cable == Cable::Taut;
        if !is_usable {
            return false;
        }
        let per_length = T::one() / self.params.cable_length;
        // Steps since the one that took the last ones, at phase 6.
        let ages = [age, self.waited((self.phase + CYCLE - 7) % CYCLE)];
        let PayloadState { rod, rod_rate, .. } = self.state;
        let now = Swing { rod, rate: rod_rate, acceleration: self.pull.acceleration };
        let lever = self.last.attitude * self.last.body_rate.cross(&self.params.hook);
        let hook_velocity = self.last.velocity + lever;
        // Where the hook was then, of a UAV that was there.
        let hook_of = |uav: Vector3<T>| uav + self.last.attitude * self.params.hook - lever * age;
        let load_velocity = hook_velocity + rod_rate * self.params.cable_length;
        let [rods, rates] = &mut self.fresh;
        match measurement {
            LoadMeasurement::Direction(rod, _) => {
                let length = rod.dot(rod).sqrt();
                if !(length > T::zero() && rod.z > T::zero()) {
                    return false;
                }
                rods.add_rod([rod.x / length, rod.y / length], deviation, ages, &now);
            }
            LoadMeasurement::Position(place, _) => {
                let rod = (place - hook_of(self.last.position - self.last.velocity * age)) * per_length;
                self.track.take(place, [deviation, age, self.params.noise.accelerometer], &[*place, load_velocity]);
                rods.add_rod([rod.x, rod.y], deviation * per_length, ages, &now);
            }
            LoadMeasurement::Pair([place, uav], _) => {
                let rod = (place - hook_of(*uav)) * per_length;
                self.track.take(place, [deviation, age, self.params.noise.accelerometer], &[*place, load_velocity]);
                let both = deviation * T::lit(core::f64::consts::SQRT_2);
                rods.add_rod([rod.x, rod.y], both * per_length, ages, &now);
            }
            LoadMeasurement::Velocity(velocity, _) => {
                let rate = (velocity - hook_velocity) * per_length;
                rates.add_rate([rate.x, rate.y], deviation * per_length, ages, &now);
            }
        }
        true
    }

    /// One period: `motion` at its end, and the mean `thrust` over it, N, as the rotors give it by
    /// their speed, or as a model of them has it. What is `None` or can't be is missing: without
    /// motion the last one goes on, without thrust nothing is learnt.
    #[inline(never)]
    pub fn step(&mut self, motion: Option<&Motion<T>>, thrust: Option<T>) -> Estimate<T> {
        let Motion { position: place, velocity: speed, body_rate: before, .. } = self.last;
        // Where it is after a gap is news, not a jump.
        let is_next = self.missing == 0;
        let usable = motion.filter(|motion| motion.is_usable());
        if let Some(motion) = usable {
            self.last.take_over(motion);
            self.missing = 0;
        } else {
            self.missing = self.missing.saturating_add(1);
            self.unread += T::one();
        }
        let params = &self.params;
        let Motion { position, velocity, attitude, body_rate, specific_force } = self.last;
        let turning = (body_rate - before) * (T::one() / params.period);
        let swing = swing(&body_rate, &turning);
        let center = specific_force - swing * params.imu;
        let hooked = center + swing * params.hook;
        let reach = attitude * params.hook;
        // Force is the period's mean, attitude its end's: turned back by half a period.
        let halfway = hooked - body_rate.cross(&hooked) * (params.period * T::lit(0.5));
        let pivot = Pivot {
            velocity: velocity + attitude * body_rate.cross(&params.hook),
            specific_force: attitude * halfway,
        };
        if is_next && usable.is_some() {
            let mut gained = pivot.specific_force * params.period;
            gained.z += params.gravity * params.period;
            self.glide.take(&(position - place - velocity * params.period), &(velocity - speed - gained));
        }
        self.glide.pass(params.period);
        self.force += pivot.specific_force;
        let pendulum = Pendulum::new(params, &self.state);
        self.pull = if self.watch.cable == Cable::Taut {
            pendulum.advance(params, &pivot, &self.pull.acceleration, &mut self.state)
        } else {
            pendulum.pull(params, &pivot, &self.state.rod, &self.state.rod_rate)
        };
        let mut falling = self.state.rod * -self.pull.tension;
        falling.z += params.gravity;
        self.track.pass(&falling, params.period);
        // No rotors give more than ten times what the vehicle weighs.
        let most = (params.uav_mass + params.payload_mass) * params.gravity * T::lit(10.0);
        let thrust = thrust.filter(|&thrust| thrust >= T::zero() && thrust <= most);
        if let (Some(_), Some(thrust)) = (usable, thrust) {
            self.window.add(params, &self.state, (&pendulum, &self.pull), &attitude, &velocity, &center, thrust);
        }
        self.work(&pendulum, &pivot.velocity, &attitude, &velocity);
        self.phase = if self.phase + 1 >= CYCLE { 0 } else { self.phase + 1 };
        self.estimate(&position, &reach, &pivot.velocity)
    }

    /// What the cycle has for this period.
    ///
    /// What is linearized is so about the last cycle's mean force: that of a period shakes with the
    /// frame, and a gain that shakes with the innovation it meets would drag the state along.
    fn work(
        &mut self,
        pendulum: &Pendulum<T>,
        hook_velocity: &Vector3<T>,
        attitude: &Matrix3<T>,
        velocity: &Vector3<T>,
    ) {
        let pivot = &Pivot { velocity: *hook_velocity, specific_force: self.mean_force };
        match self.phase {
            0 => {
                self.close_window(attitude);
                self.mean_force = self.force * T::lit(1.0 / f64::from(CYCLE));
                self.force = Vector3::zeros();
                let pivot = &Pivot { specific_force: self.mean_force, ..*pivot };
                self.linearized = Linearized::about(&self.params, &self.state, pendulum, pivot, velocity);
            }
            // Over the window that has ended: what drove the rod in it, the batch then meets.
            1 => self.spread(pendulum, pivot),
            2 => self.take_thrust(attitude, Axis::First),
            3 => self.take_thrust(attitude, Axis::Second),
            4 => self.take_thrust(attitude, Axis::Thrust),
            5 => {
                self.settle(CYCLE - 1);
                self.known = if thrust::is_rod_known(&self.covariance) { self.known.saturating_add(1) } else { 0 };
                self.is_mass_found |= self.covariance.get(index::MASS, index::MASS) < T::lit(0.15 * 0.15);
                if self.is_astray() {
                    self.restart();
                }
                self.health = self.judge();
                self.get_sure();
                self.age = self.age.saturating_add(1);
            }
            6 => {
                self.taken = self.fresh;
                self.fresh = [Innovations::none(); 2];
                self.take_load(0, 0);
            }
            7 => self.take_load(0, 1),
            8 => self.take_load(1, 0),
            9 => self.take_load(1, 1),
            10 => self.settle(4),
            _ => {}
        }
    }

    /// Ends a window: its mean is for the coming three scalars, its pull for the cable.
    fn close_window(&mut self, attitude: &Matrix3<T>) {
        self.mean = self.window.mean(T::lit(LEAST));
        self.window = Window::empty();
        if !self.mean.is_full {
            return;
        }
        let mass = self.params.payload_mass * (T::one() + self.state.mass_ratio);
        let pull = self.state.rod * (mass * self.pull.tension) + attitude * self.mean.residual * self.params.uav_mass;
        if self.watch.look(&pull, mass * self.params.gravity) {
            self.restart();
        }
    }

    /// What is measured has been far from what was expected for long: the filter is sure of a rod
    /// that is not there. Less far will do where no mass is small or large enough for it.
    fn is_astray(&self) -> bool {
        let ([x, y, z], [rod_x, rod_y]) = (self.health.surprise, self.load_surprise);
        let most = if self.state.is_mass_at_bound() { CONSISTENT } else { ASTRAY };
        self.watch.cable == Cable::Taut && x.max(y).max(z).max(rod_x).max(rod_y) > T::lit(most)
    }

    /// The cable has changed, or the filter has lost the rod: taut, the rod is where it pulls, and
    /// nothing is known of its swing or of what hangs there; slack, there is no rod.
    ///
    /// A filter that was wrong of the rod was so of what it has learnt by it: all begins as told.
    /// Next to no mass, blown far out, under weak rotors is one false answer, and by its thrust
    /// scale every cable would be slack for ever. Only where a rod that was long known ends do wind
    /// and rotors stay as they were found.
    fn restart(&mut self) {
        let is_slack = self.watch.cable == Cable::Slack;
        let start = self.params.noise.start();
        if is_slack && self.age >= PROVEN && self.health.validity == Validity::Valid {
            self.state.set_rod([T::zero(); 2], [T::zero(); 2]);
            for (component, deviation) in start.into_iter().enumerate() {
                if component < index::WIND || component == index::MASS {
                    self.covariance.forget(component, deviation * deviation);
                }
            }
        } else {
            self.state = PayloadState::hanging();
            self.covariance = Covariance::diagonal(&start);
            self.watch.settle();
        }
        let pull = self.watch.pull;
        if !is_slack && pull.z > T::zero() {
            let per_length = T::one() / pull.dot(&pull).sqrt();
            self.state.set_rod([pull.x * per_length, pull.y * per_length], [T::zero(); 2]);
        }
        self.age = 0;
        self.is_mass_found = false;
        (self.known, self.settled) = (0, 0);
        self.health.surprise = [T::one(); 3];
        self.load_surprise = [T::one(); 2];
        self.fresh = [Innovations::none(); 2];
        self.taken = [Innovations::none(); 2];
        self.mean.is_full = false;
    }

    /// One scalar of the thrust model.
    fn take_thrust(&mut self, attitude: &Matrix3<T>, axis: Axis) {
        if !self.mean.is_full || self.watch.cable == Cable::Slack {
            return;
        }
        let [x, y, z] = &mut self.health.surprise;
        let body @ [b1, b2, b3] = axes(attitude);
        let (mean, body_axis) = match axis {
            Axis::First => (x, b1),
            Axis::Second => (y, b2),
            Axis::Thrust => (z, b3),
        };
        let window = self.params.period * T::lit(f64::from(CYCLE));
        let is_witnessed = self.taken.iter().any(|taken| !taken.is_empty());
        let (mut scalar, along) =
            self.linearized.scalar(&self.params, axis, &body_axis, &self.mean, window, is_witnessed);
        self.batch.correct(axis, &mut scalar.correlation);
        // Sure of a mass that was found, the filter is so as long as it knows the rod.
        let least = if self.is_mass_found { 1 } else { SURE };
        let is_considered =
            self.known < least || thrust::is_considered(&self.covariance, axis, along, self.is_mass_found);
        let (gain, surprise) = take(&mut self.covariance, &mut self.pending, &scalar, is_considered);
        if !is_witnessed {
            self.batch.follow(axis, &scalar.h, &gain, |axis| self.linearized.correlation(&self.params, &body[axis]));
        }
        // Over some 17 cycles, 1 s at 500 Hz.
        *mean += (surprise.min(T::lit(WILD)) - *mean) * T::lit(0.06);
    }

    /// One scalar of the load's measurements.
    fn take_load(&mut self, kind: usize, axis: usize) {
        if let Some(taken) = self.taken.get(kind).filter(|taken| !taken.is_empty()) {
            let scalar = taken.scalar(axis, kind == 1, self.waited(CYCLE));
            let (_, surprise) = take(&mut self.covariance, &mut self.pending, &scalar, true);
            if let Some(mean) = self.load_surprise.get_mut(axis) {
                *mean += (surprise.min(T::lit(WILD)) - *mean) * T::lit(0.06);
            }
        }
    }

    /// So many periods, s.
    fn waited(&self, periods: u8) -> T {
        self.params.period * T::lit(f64::from(periods))
    }

    /// Ends a batch, so many `periods` after the measurements of the load were last taken.
    fn settle(&mut self, periods: u8) {
        self.state.inject(&self.pending);
        let waited = self.waited(periods);
        self.fresh.iter_mut().enumerate().for_each(|(kind, fresh)| fresh.shift(&self.pending, kind == 1, waited));
        self.pending = [T::zero(); ERRORS];
        // Readings that can't be true, kept up, may not make the rod whirl beyond what a state may
        // hold.
        let turning = self.state.rod_rate.dot(&self.state.rod_rate);
        if turning > T::lit(FASTEST * FASTEST) {
            self.state.rod_rate *= T::lit(FASTEST) / turning.sqrt();
        }
    }

    /// Moves the covariance on.
    fn spread(&mut self, pendulum: &Pendulum<T>, pivot: &Pivot<T>) {
        if self.watch.cable == Cable::Slack {
            return;
        }
        let sensitivity = pendulum.sensitivity(&self.params, pivot, &self.state);
        let rows = sensitivity.acceleration(&self.params, &self.state.rod);
        self.spread.advance(&mut self.covariance, &rows, self.linearized.rod());
        self.spread.relax(&mut self.state);
        // Each period unread moves the rod by what the accelerometer might have said.
        let unread = T::lit(UNREAD) * self.params.period / self.params.cable_length * self.unread;
        for i in [index::RATE, index::RATE + 1] {
            self.covariance.add(i, unread * unread);
        }
        let (rod, rate) = (T::one(), T::lit(FASTEST * FASTEST));
        self.covariance.limit(&[(0, rod), (1, rod), (2, rate), (3, rate)]);
        self.unread = T::zero();
    }

    /// The answer.
    fn estimate(&self, position: &Vector3<T>, reach: &Vector3<T>, hook_velocity: &Vector3<T>) -> Estimate<T> {
        let Motion { attitude, body_rate, velocity, .. } = &self.last;
        let length = self.params.cable_length;
        let (q, w) = (self.state.rod, self.state.rod_rate);
        // From the centre of mass to the load: the line that the law takes for the rod.
        let line = reach + q * length;
        let load_velocity = hook_velocity + w * length;
        let closing = load_velocity - velocity;
        let per_length = T::one() / line.dot(&line).sqrt();
        let rod = line * per_length;
        let state = State {
            position: position + line + self.glide.rest,
            velocity: self.track.velocity().unwrap_or(&load_velocity) + self.glide.rate,
            rod,
            rod_rate: (closing - rod * rod.dot(&closing)) * per_length,
            attitude: *attitude,
            body_rate: *body_rate,
        };
        let mass = self.params.payload_mass * (T::one() + self.state.mass_ratio);
        let mut health = self.health;
        if self.missing > BLIND {
            health.validity = Validity::Blind;
        }
        let rest = [self.glide.rest, self.glide.rate];
        Estimate { state, rest, tension: mass * self.pull.tension, cable: self.watch.cable, health }
    }

    /// What the filter is worth, once a cycle.
    fn judge(&self) -> Health<T> {
        let both = |at: usize| (self.covariance.get(at, at) + self.covariance.get(at + 1, at + 1)).sqrt();
        let rod_deviation = both(index::ROD);
        Health {
            validity: self.validity(rod_deviation),
            rod_deviation,
            rate_deviation: both(index::RATE),
            surprise: self.health.surprise,
        }
    }

    /// Counts towards [`SETTLED`], once a cycle.
    fn get_sure(&mut self) {
        if self.settled < SETTLED {
            let is_vague = self.health.rod_deviation > T::lit(KNOWN);
            self.settled = match (self.known, is_vague) {
                (1.., _) => self.settled + 2,
                (0, false) => self.settled + 1,
                (0, true) => 0,
            };
        }
    }

    fn validity(&self, rod_deviation: T) -> Validity {
        let [x, y, z] = self.health.surprise;
        if self.watch.cable == Cable::Slack {
            Validity::Slack
        } else if rod_deviation > T::lit(KNOWN) || self.settled < SETTLED {
            Validity::Converging
        } else if x.max(y).max(z) > T::lit(CONSISTENT) {
            Validity::Inconsistent
        } else {
            Validity::Valid
        }
    }
}

/// Takes in a scalar of a batch, whose innovation is against the state before the batch. The mass
/// may be only considered. Returns the gain, and ν²/S.
fn take<T: Real>(
    covariance: &mut Covariance<T>,
    pending: &mut [T; ERRORS],
    scalar: &Scalar<T, ERRORS>,
    is_considered: bool,
) -> ([T; ERRORS], T) {
    let innovation = scalar.innovation - dot(&scalar.h, pending);
    if !innovation.is_finite() {
        return ([T::zero(); ERRORS], T::zero());
    }
    let absorbed = covariance.absorb(scalar, innovation, is_considered.then_some(index::MASS));
    let mut gain = absorbed.gain;
    if is_considered {
        gain[index::MASS] = T::zero();
    }
    for (sum, gain) in pending.iter_mut().zip(&gain) {
        *sum += *gain * absorbed.innovation;
    }
    (gain, absorbed.surprise)
}
