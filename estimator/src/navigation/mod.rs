//! A small navigation filter, for those who have none: how the UAV moves, from an IMU and what
//! tells where it is.
//!
//! Fifteen error states around a [strapdown] integration. Fixes are late, so a [ring] remembers
//! where the vehicle was. The cycle of 30 periods is the payload filter's: the
//! [covariance](predict) moves in two of them, where the payload filter has nothing to do, and
//! [scalars](aiding) and corrections have fourteen of the others, one a period. Kinds of
//! measurements take turns, so that none that comes often keeps another from its own.

mod aiding;
#[cfg(test)]
mod jacobians;
mod params;
mod predict;
mod ring;
mod strapdown;

pub use params::{NavigationNoise, NavigationParams};
pub use strapdown::Imu;

use model::{Matrix3, OutOfRange, Real, Vector3, is_within};

use crate::covariance::dot;
use crate::lever::axes;
use crate::motion::Motion;
use aiding::{Clock, Kind, Waiting};
use predict::{Covariance, Spread};
use ring::Ring;
use strapdown::{ERRORS, Strapdown, index};

const CYCLE: u8 = 30;
const HALF: u8 = 15;
/// Periods without an IMU after which the motion is a guess: 0.1 s at 500 Hz.
const BLIND: u16 = 50;
/// Fixes in a row that are refused before the filter takes them for right and itself for wrong.
const STUBBORN: u8 = 15;
/// A fix is refused beyond so many deviations, squared.
const GATE: f64 = 100.0;
/// Fixes come while the last one is not older, s.
const RECENT: f64 = 0.5;
/// Deviations of tilt and heading, rad, where a restart finds the velocity off, too: it is the
/// attitude that has led it astray.
const MISLED: [f64; 2] = [0.3, 1.0];
/// What an unread accelerometer and gyro might have said, m/s² and rad/s.
const UNREAD: [f64; 2] = [3.0, 0.3];

/// A fix of a receiver or of motion capture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fix<T> {
    /// Antenna (or, from motion capture, the centre of mass) in N, m.
    pub position: Option<Vector3<T>>,
    /// Its velocity in N, m/s.
    pub velocity: Option<Vector3<T>>,
    /// Standard deviations of the position that the source states, horizontal and down, m. What the
    /// parameters say is the least believed.
    pub position_accuracy: [T; 2],
    /// Of the velocity, m/s.
    pub velocity_accuracy: [T; 2],
    /// How old it is, s: 0 to 150 periods, 0.3 s at 500 Hz.
    pub age: T,
}

/// Why a measurement is not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// A number that is not finite, or outside its possible range.
    NotUsable,
    /// Older than the ring remembers, or from the future.
    Age,
    /// More than ten deviations off. Fifteen in a row, and the filter starts anew from the fix.
    Outlier,
}

/// What a fix did.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accepted {
    /// It waits for its turn.
    Taken,
    /// The filter had gone astray and starts anew from it: **the position has jumped**, tell the
    /// law.
    Reset,
}

/// What the motion is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NavigationHealth<T> {
    /// Standard deviation of the position, m: horizontal, both axes together.
    pub position_deviation: T,
    /// Of the velocity, m/s.
    pub velocity_deviation: T,
    /// Of the attitude's tilt, rad.
    pub tilt_deviation: T,
    /// Since the last fix that was taken, s.
    pub fix_age: T,
    /// The IMU has been silent for more than 50 periods, 0.1 s at 500 Hz.
    pub is_blind: bool,
    /// How often it has started anew.
    pub resets: u16,
}

/// The filter.
#[derive(Clone, Debug)]
pub struct Navigation<T> {
    params: NavigationParams<T>,
    spread: Spread<T>,
    state: Strapdown<T>,
    covariance: Covariance<T>,
    ring: Ring<T>,
    phase: u8,
    /// Sum of f in N over the half cycle.
    force: Vector3<T>,
    waiting: [Waiting<T>; 5],
    clock: Clock<T>,
    /// Whose turn it is, as a place in [`Kind::ALL`].
    turn: usize,
    /// The batch at work: which kind, which of its scalars comes next, and what has been corrected
    /// by it.
    batch: Option<(Kind, Waiting<T>)>,
    row: usize,
    pending: [T; ERRORS],
    barometer_offset: Option<T>,
    refused: u8,
    resets: u16,
    fix_age: T,
    missing: u16,
    unread: T,
}

impl<T: Real> Navigation<T> {
    /// At a `position` of the UAV's centre of mass known to `deviations` of position (m) and
    /// velocity (m/s), with this `velocity` and `attitude`.
    ///
    /// # Errors
    /// [`OutOfRange`] names the first parameter out of its range.
    pub fn new(params: NavigationParams<T>, motion: &Motion<T>, deviations: [T; 2]) -> Result<Self, OutOfRange<T>> {
        params.check()?;
        OutOfRange::check("deviations[0]", deviations[0], 1e-3, 1e5)?;
        OutOfRange::check("deviations[1]", deviations[1], 1e-3, 1e3)?;
        let noise = &params.noise;
        let [x, v] = deviations;
        let (tilt, heading, g, a) =
            (noise.start_tilt, noise.start_heading, noise.start_gyro, noise.start_accelerometer);
        let deviations = [x, x, x, v, v, v, tilt, tilt, heading, g, g, g, a, a, a];
        let step = params.period * T::lit(f64::from(HALF));
        let lever = motion.attitude * params.imu;
        let mut state = Strapdown {
            position: motion.position + lever,
            velocity: motion.velocity + motion.attitude * motion.body_rate.cross(&params.imu),
            attitude: motion.attitude,
            gyro_bias: Vector3::zeros(),
            accelerometer_bias: Vector3::zeros(),
            body_rate: motion.body_rate,
            force: motion.specific_force,
            acceleration: Vector3::zeros(),
        };
        state.straighten();
        Ok(Self {
            spread: Spread::new(noise, step),
            covariance: Covariance::diagonal(&deviations),
            ring: Ring::new(&state.position, &state.velocity, step),
            state,
            phase: 3,
            force: Vector3::zeros(),
            waiting: [Waiting::none(); 5],
            clock: Clock::every(params.period),
            turn: 0,
            batch: None,
            row: 0,
            pending: [T::zero(); ERRORS],
            barometer_offset: None,
            refused: 0,
            resets: 0,
            fix_age: T::zero(),
            missing: 0,
            unread: T::zero(),
            params,
        })
    }

    /// What it was told.
    pub fn params(&self) -> &NavigationParams<T> {
        &self.params
    }

    /// The covariance of the errors, in the order (δx, δv, δθ, δb_g, δb_a).
    pub fn covariance(&self) -> [[T; ERRORS]; ERRORS] {
        self.covariance.full()
    }

    /// Biases found: of the gyro, rad/s, and of the accelerometer, m/s².
    pub fn biases(&self) -> (Vector3<T>, Vector3<T>) {
        (self.state.gyro_bias, self.state.accelerometer_bias)
    }

    /// A fix of a satellite receiver.
    ///
    /// # Errors
    /// [`Refused`] says why it is not taken.
    pub fn fix(&mut self, fix: &Fix<T>) -> Result<Accepted, Refused> {
        let [position, velocity] = [self.params.noise.position, self.params.noise.velocity];
        self.locate(fix, &(self.params.antenna - self.params.imu), [position, velocity])
    }

    /// A pose from motion capture: position and velocity of the centre of mass, with the accuracies
    /// that the fix states, and attitude with its standard deviation, rad.
    ///
    /// # Errors
    /// [`Refused`] says why it is not taken.
    pub fn pose(&mut self, fix: &Fix<T>, attitude: Option<(&Matrix3<T>, T)>) -> Result<Accepted, Refused> {
        let accepted = self.locate(fix, &-self.params.imu, [[T::zero(); 2]; 2])?;
        if let Some((measured, deviation)) = attitude {
            self.face(measured, deviation, fix.age)?;
        }
        Ok(accepted)
    }

    /// Height above the origin by pressure, m, up. Its offset follows the fixes while they come, so
    /// that pressure carries on from the last of them where they are missing.
    ///
    /// # Errors
    /// [`Refused`] says why it is not taken.
    pub fn height(&mut self, height: T) -> Result<(), Refused> {
        if !height.is_finite() || height.abs() > T::lit(1e5) {
            return Err(Refused::NotUsable);
        }
        let difference = height + self.state.position.z;
        let offset = self.barometer_offset.unwrap_or(difference);
        let innovation = difference - offset;
        // At some 25 Hz: a reading moves the offset by 1/25 of its time's share.
        let share = T::lit(0.04) / self.params.noise.barometer_time;
        let is_followed = self.fix_age < T::lit(RECENT);
        self.barometer_offset = Some(if is_followed { offset + innovation * share } else { offset });
        let deviation = self.params.noise.barometer;
        self.wait(Kind::Height, &Vector3::new(innovation, T::zero(), T::zero()), [deviation; 2], T::zero());
        Ok(())
    }

    /// Heading ψ of b1 from n1 toward n2, rad.
    ///
    /// # Errors
    /// [`Refused`] says why it is not taken.
    pub fn heading(&mut self, heading: T) -> Result<(), Refused> {
        let [b1, ..] = axes(&self.state.attitude);
        // Near the vertical there is no heading.
        let is_angle = heading.is_finite() && heading.abs() < T::lit(100.0);
        if !is_angle || b1.x * b1.x + b1.y * b1.y < T::lit(0.04) {
            return Err(Refused::NotUsable);
        }
        self.turn((heading - b1.y.atan2(b1.x)).wrap_angle());
        Ok(())
    }

    /// The magnetic field in body axes, of any unit.
    ///
    /// # Errors
    /// [`Refused`] says why it is not taken.
    pub fn magnetic_field(&mut self, field: &Vector3<T>) -> Result<(), Refused> {
        let level = self.state.attitude * field;
        let horizontal = level.x * level.x + level.y * level.y;
        if !horizontal.is_finite() || horizontal < field.dot(field) * T::lit(1e-3) || horizontal <= T::zero() {
            return Err(Refused::NotUsable);
        }
        self.turn((self.params.declination - level.y.atan2(level.x)).wrap_angle());
        Ok(())
    }

    fn turn(&mut self, innovation: T) {
        let deviation = self.params.noise.heading;
        self.wait(Kind::Heading, &Vector3::new(innovation, T::zero(), T::zero()), [deviation; 2], T::zero());
    }

    fn wait(&mut self, kind: Kind, innovation: &Vector3<T>, deviations: [T; 2], age: T) {
        self.wait_at(kind, innovation, deviations, age, &Vector3::zeros());
    }

    fn wait_at(&mut self, kind: Kind, innovation: &Vector3<T>, deviations: [T; 2], age: T, lever: &Vector3<T>) {
        for (other, waiting) in Kind::ALL.into_iter().zip(&mut self.waiting) {
            if other == kind {
                waiting.add(innovation, deviations, age, lever, &self.clock);
            }
        }
    }

    /// Compares an attitude with the nominal one at its time.
    fn face(&mut self, measured: &Matrix3<T>, deviation: T, age: T) -> Result<(), Refused> {
        let mut double = Vector3::zeros();
        for (now, then) in axes(&self.state.attitude).into_iter().zip(axes(measured)) {
            double += now.cross(&then);
        }
        // Half the sum is the sine of the angle between them, and what has been turned since is to
        // be taken off.
        let innovation = double * T::lit(0.5) + self.state.attitude * self.state.body_rate * age;
        if !(innovation.dot(&innovation) < T::lit(4.0) && deviation > T::zero() && deviation < T::lit(10.0)) {
            return Err(Refused::NotUsable);
        }
        self.wait(Kind::Attitude, &innovation, [deviation; 2], age);
        Ok(())
    }

    /// Compares a fix with where its point was then.
    fn locate(&mut self, fix: &Fix<T>, lever: &Vector3<T>, least: [[T; 2]; 2]) -> Result<Accepted, Refused> {
        let Fix { position, velocity, position_accuracy, velocity_accuracy, age } = *fix;
        if !(age >= T::zero() && age <= self.ring.span()) {
            return Err(Refused::Age);
        }
        let usable = |v: &Vector3<T>, most: f64| is_within(v, T::lit(most * most));
        let known =
            |accuracy: [T; 2]| accuracy.into_iter().all(|accuracy| accuracy >= T::zero() && accuracy < T::lit(1e4));
        if position.is_some_and(|x| !usable(&x, 8e4) || !known(position_accuracy))
            || velocity.is_some_and(|v| !usable(&v, 8e2) || !known(velocity_accuracy))
        {
            return Err(Refused::NotUsable);
        }
        let believed = |stated: [T; 2], least: [T; 2]| {
            [stated[0].max(least[0]), stated[1].max(least[1])].map(|d| d.max(T::lit(1e-5)))
        };
        let (x, v) = self.ring.at(age, (self.state.position, self.state.velocity));
        // The lever at that time: turned back.
        let swing = self.state.body_rate.cross(lever);
        let reach = self.state.attitude * (lever - swing * age);
        let moving = self.state.attitude * swing;
        let mut accepted = Accepted::Taken;
        if let Some(position) = position {
            let innovation = position - x - reach;
            let deviations = believed(position_accuracy, least[0]);
            if self.is_outlier(index::POSITION, &innovation, deviations) {
                self.refused = self.refused.saturating_add(1);
                if self.refused < STUBBORN {
                    return Err(Refused::Outlier);
                }
                if let Some(velocity) = velocity {
                    let faster = velocity - v - moving;
                    self.mistrust(&faster, believed(velocity_accuracy, least[1]));
                }
                self.restart(&innovation, deviations);
                accepted = Accepted::Reset;
            } else {
                self.wait_at(Kind::Position, &innovation, deviations, age, lever);
            }
            self.refused = 0;
            self.fix_age = T::zero();
        }
        if let (Some(velocity), Accepted::Taken) = (velocity, accepted) {
            self.wait_at(
                Kind::Velocity,
                &(velocity - v - moving),
                believed(velocity_accuracy, least[1]),
                age,
                &swing,
            );
        }
        Ok(accepted)
    }

    /// Whether a position or velocity, whose errors begin `at`, is off by more than can be. After one
    /// that was, the filter's own doubt does not count: it grows without fixes, and by it the next
    /// would be taken for true and the jump for a velocity.
    fn is_outlier(&self, at: usize, innovation: &Vector3<T>, [across, down]: [T; 2]) -> bool {
        let doubts = if self.refused == 0 { T::one() } else { T::zero() };
        [across, across, down].into_iter().enumerate().any(|(axis, deviation)| {
            let square = innovation.get(axis).map_or(T::zero(), |&along| along * along);
            square > (deviation * deviation + self.covariance.get(at + axis, at + axis) * doubts) * T::lit(GATE)
        })
    }

    /// Takes the velocity of a restart, which is off by so much. Where that is more than can be,
    /// attitude and gyro's bias have led it astray, and are looked for as at a start.
    fn mistrust(&mut self, off: &Vector3<T>, deviations: [T; 2]) {
        if self.is_outlier(index::VELOCITY, off, deviations) {
            let ([tilt, heading], gyro) = (MISLED.map(T::lit), self.params.noise.start_gyro);
            for (component, deviation) in [tilt, tilt, heading].into_iter().enumerate() {
                self.covariance.forget(index::ATTITUDE + component, deviation * deviation);
                self.covariance.forget(index::GYRO + component, gyro * gyro);
            }
            self.state.gyro_bias = Vector3::zeros();
        }
        self.state.velocity += off;
    }

    /// Starts anew from a fix that is off by so much.
    fn restart(&mut self, off: &Vector3<T>, [across, down]: [T; 2]) {
        self.state.position += off;
        self.ring.restart(&self.state.position, &self.state.velocity);
        let quick = T::lit(4.0);
        for (component, deviation) in [across, across, down].into_iter().enumerate() {
            self.covariance.forget(index::POSITION + component, deviation * deviation * quick);
            self.covariance.forget(index::VELOCITY + component, T::one());
        }
        self.waiting = [Waiting::none(); 5];
        self.batch = None;
        self.pending = [T::zero(); ERRORS];
        self.barometer_offset = None;
        self.resets = self.resets.saturating_add(1);
    }

    /// One period that ends with this reading of the IMU. `None`, or one with a number that can't
    /// be, is missing: the last one goes on.
    #[inline(never)]
    pub fn step(&mut self, imu: Option<&Imu<T>>) -> Motion<T> {
        let usable =
            imu.filter(|imu| is_within(&imu.body_rate, T::lit(1e4)) && is_within(&imu.specific_force, T::lit(1e6)));
        let reading = if let Some(imu) = usable {
            self.missing = 0;
            *imu
        } else {
            self.missing = self.missing.saturating_add(1);
            self.unread += T::one();
            Imu {
                body_rate: self.state.body_rate + self.state.gyro_bias,
                specific_force: self.state.force + self.state.accelerometer_bias,
            }
        };
        let period = self.params.period;
        self.state.advance(&reading, period, self.params.gravity);
        self.force += self.state.acceleration;
        self.ring.pass(period);
        self.clock.pass();
        self.fix_age = (self.fix_age + period).min(T::lit(1e4));
        match self.phase {
            11 | 26 => self.spread(),
            12 | 27 => self.finish_spread(),
            13..=19 | 21..=25 | 28 | 29 => self.work(),
            _ => {}
        }
        self.phase = if self.phase + 1 >= CYCLE { 0 } else { self.phase + 1 };
        self.motion()
    }

    /// The motion of the UAV's centre of mass at the last step.
    pub fn motion(&self) -> Motion<T> {
        let Strapdown { position, velocity, attitude, body_rate, force, .. } = &self.state;
        Motion {
            position: position - attitude * self.params.imu,
            velocity: velocity - attitude * body_rate.cross(&self.params.imu),
            attitude: *attitude,
            body_rate: *body_rate,
            specific_force: *force,
        }
    }

    /// What it is worth.
    pub fn health(&self) -> NavigationHealth<T> {
        let both = |at: usize| (self.covariance.get(at, at) + self.covariance.get(at + 1, at + 1)).sqrt();
        NavigationHealth {
            position_deviation: both(index::POSITION),
            velocity_deviation: both(index::VELOCITY),
            tilt_deviation: both(index::ATTITUDE),
            fix_age: self.fix_age,
            is_blind: self.missing > BLIND,
            resets: self.resets,
        }
    }

    /// The first half of the covariance's step.
    fn spread(&mut self) {
        let mut force = self.force * T::lit(1.0 / f64::from(HALF));
        force.z -= self.params.gravity;
        self.force = Vector3::zeros();
        self.spread.move_with_attitude(&mut self.covariance, &force);
        self.state.straighten();
        self.ring.push(&self.state.position, &self.state.velocity);
    }

    /// The second half, with its noise.
    fn finish_spread(&mut self) {
        let Strapdown { attitude, body_rate, .. } = &self.state;
        self.spread.move_with_biases(&mut self.covariance, attitude, body_rate);
        let [v, t] = UNREAD.map(|unread| T::lit(unread) * self.params.period * self.unread);
        for i in 0..3 {
            self.covariance.add(index::VELOCITY + i, v * v);
            self.covariance.add(index::ATTITUDE + i, t * t);
        }
        let [x, v, t] = [1e10, 1e6, 10.0].map(T::lit);
        self.covariance.limit(&[(0, x), (1, x), (2, x), (3, v), (4, v), (5, v), (6, t), (7, t), (8, t)]);
        self.unread = T::zero();
    }

    /// The next scalar of what waits.
    fn work(&mut self) {
        if self.batch.is_none() {
            let is_waiting = |place: &usize| self.waiting.get(*place).is_some_and(|waiting| !waiting.is_empty());
            let kinds = Kind::ALL.len();
            let next = (self.turn..kinds).chain(0..self.turn).find(is_waiting);
            self.batch = next.and_then(|place| {
                self.turn = (place + 1) % kinds;
                let waiting = self.waiting.get_mut(place)?;
                Some((*Kind::ALL.get(place)?, core::mem::replace(waiting, Waiting::none())))
            });
            self.row = 0;
        }
        let Some((kind, waiting)) = self.batch else { return };
        if self.row >= kind.scalars() {
            self.settle();
            return;
        }
        let scalar = waiting.scalar(kind, self.row, &self.state, &self.clock);
        let innovation = scalar.innovation - dot(&scalar.h, &self.pending);
        if innovation.is_finite() {
            let absorbed = self.covariance.absorb(&scalar, innovation, None);
            for (sum, gain) in self.pending.iter_mut().zip(absorbed.gain) {
                *sum += gain * absorbed.innovation;
            }
        }
        self.row += 1;
    }

    /// Ends a batch.
    fn settle(&mut self) {
        let moved = self.state.inject(&self.pending);
        for (kind, waiting) in Kind::ALL.into_iter().zip(&mut self.waiting) {
            waiting.shift(kind, &moved, &self.state.attitude, &self.clock);
        }
        self.ring.shift(&moved);
        self.pending = [T::zero(); ERRORS];
        self.batch = None;
    }
}
