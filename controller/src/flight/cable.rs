//! Whether the cable pulls, from the UAV's own motion and, where it is seen, the load's place.

use model::{Real, State, Vehicle, dynamics::lambda, is_within};
use nalgebra::{Matrix3, Vector3};

use crate::sampled::pull::{BANDWIDTH, Pull};

/// The cable is slack when the load is nearer than this share of its length, or when this share of
/// the payload's weight has gone from the usual pull, for as long as [`SLACKENING`], s.
pub(crate) const SHORTENED: f64 = 0.9;
const UNWEIGHTED: f64 = 0.5;
const SLACKENING: f64 = 0.1;
/// A load that is measured further from where rod and cable can have it than this share of its
/// length, and than so many m, for as long as [`SLACKENING`]: one of the measurements is wrong. A
/// cable that is told a quarter too short is not meant.
const APART: f64 = 0.3;
const APART_AT_LEAST: f64 = 0.3;
/// Time, s, over which the usual pull is averaged.
const USUAL: f64 = 2.0;

/// What the flight says of the cable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Watching {
    /// It is not expected to pull.
    Not,
    /// It pulls, and how much is averaged.
    Learning,
    /// The load is being set down, which is not to be got used to.
    Against,
}

/// The watch on the cable.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cable<T> {
    period: T,
    pull: Pull<T>,
    /// The usual pull along n3, N, and for how long it has been averaged, s, up to [`USUAL`].
    usual: T,
    learning: T,
    /// For how long the cable has seemed slack, s.
    slackening: T,
    /// For how long load and UAV have contradicted each other, s.
    apart: T,
}

impl<T: Real> Cable<T> {
    /// Pulling as the load's weight, observed with no more than the bandwidth `most`, rad/s.
    pub(crate) fn new(vehicle: &Vehicle<T>, period: T, most: T) -> Self {
        let weight = vehicle.params().payload_mass * vehicle.params().gravity;
        Self {
            period,
            pull: Pull::new(period, most),
            usual: weight,
            learning: T::zero(),
            slackening: T::zero(),
            apart: T::zero(),
        }
    }

    /// Taut at `state` under `thrust`, N.
    #[inline(never)]
    pub(crate) fn begin(&mut self, vehicle: &Vehicle<T>, state: &State<T>, thrust: T) {
        let params = vehicle.params();
        (self.usual, self.learning, self.slackening) = (params.payload_mass * params.gravity, T::zero(), T::zero());
        let tension = -params.payload_mass * lambda(vehicle, state, thrust);
        let force = state.rod * (tension.max(T::zero()) / params.uav_mass);
        self.pull.start(&(state.velocity - state.rod_rate * params.rod_length), force);
    }

    /// The pull is observed with no more than the bandwidth `most`, rad/s, from now on.
    pub(crate) fn yield_to(&mut self, most: T) {
        self.pull = self.pull.with_bandwidth(self.period, most);
    }

    /// The pull is observed as fast as it ever is from now on: what is slack does not bounce, and a
    /// pull that is still believed holds the UAV up.
    pub(crate) fn hasten(&mut self) {
        self.yield_to(T::lit(BANDWIDTH));
    }

    /// After periods without the UAV's `velocity`.
    pub(crate) fn resume(&mut self, velocity: &Vector3<T>) {
        self.pull.resume(velocity);
    }

    /// The UAV's velocity, m/s, at the end of a period as of [`sample`](Self::sample), where none is
    /// measured.
    pub(crate) fn carried(
        &self,
        vehicle: &Vehicle<T>,
        attitude: &Matrix3<T>,
        thrust: T,
        specific: Option<&Vector3<T>>,
    ) -> Vector3<T> {
        self.pull.carried(vehicle, attitude, thrust, specific)
    }

    /// Averages the usual pull anew.
    pub(crate) fn learn(&mut self) {
        self.learning = T::zero();
    }

    /// Ends a period under `thrust`, N, with the UAV's `velocity` and `attitude` and, if it is
    /// known, its `specific` force in body axes.
    #[inline]
    pub(crate) fn sample(
        &mut self,
        vehicle: &Vehicle<T>,
        velocity: &Vector3<T>,
        attitude: &Matrix3<T>,
        thrust: T,
        specific: Option<Vector3<T>>,
    ) {
        match specific {
            Some(specific) => self.pull.sample_specific(vehicle, velocity, attitude, thrust, &specific),
            None => self.pull.sample(vehicle, velocity, attitude, thrust),
        }
    }

    /// Looks whether the cable is slack; `line` is from the UAV to the load, m, if that is seen.
    #[inline(never)]
    pub(crate) fn watch(&mut self, vehicle: &Vehicle<T>, line: Option<Vector3<T>>, watching: Watching) {
        let params = vehicle.params();
        let near = params.rod_length * T::lit(SHORTENED);
        let is_near = line.is_some_and(|line| is_within(&line, near * near));
        let down = self.pull.down(vehicle);
        let is_known = self.learning + self.period >= T::lit(USUAL);
        let is_unweighted = self.usual - down > params.payload_mass * params.gravity * T::lit(UNWEIGHTED);
        if watching != Watching::Not && (is_near || is_known && is_unweighted) {
            self.slackening += self.period;
            self.learning = (self.learning + self.period).min(T::lit(USUAL));
            return;
        }
        self.slackening = T::zero();
        self.average(vehicle, watching);
    }

    /// Whether the `line` from the UAV to the load, m, can't be a cable along `rod`, be it slack.
    #[inline(never)]
    pub(crate) fn is_contradicted(&mut self, vehicle: &Vehicle<T>, line: &Vector3<T>, rod: &Vector3<T>) -> bool {
        let length = vehicle.params().rod_length;
        let off = line - rod * line.dot(rod).clamp(T::zero(), length);
        let most = (length * T::lit(APART)).max(T::lit(APART_AT_LEAST));
        self.apart = if is_within(&off, most * most) { T::zero() } else { self.apart + self.period };
        self.apart > T::lit(SLACKENING)
    }

    /// Averages the usual pull.
    #[inline(never)]
    pub(crate) fn average(&mut self, vehicle: &Vehicle<T>, watching: Watching) {
        self.learning = (self.learning + self.period).min(T::lit(USUAL));
        if watching == Watching::Learning || watching == Watching::Against && self.learning < T::lit(USUAL) {
            self.usual += (self.pull.down(vehicle) - self.usual) * (self.period / self.learning);
        }
    }

    /// The pull along n3, N, as usual and now: what hangs from the UAV, and what the rotors fall
    /// short of.
    pub(crate) fn down(&self, vehicle: &Vehicle<T>) -> [T; 2] {
        [self.usual, self.pull.down(vehicle)]
    }

    /// The first of them.
    #[inline]
    pub(crate) fn usual(&self) -> T {
        self.usual
    }

    pub(crate) fn is_slack(&self) -> bool {
        self.slackening > T::lit(SLACKENING)
    }

    /// The pull on the UAV that can be believed, per UAV mass, m/s². Nothing lifts, but rotors that
    /// are stronger than told seem to: as much as they did with the load.
    #[inline(never)]
    pub(crate) fn pull(&self, vehicle: &Vehicle<T>) -> Vector3<T> {
        let params = vehicle.params();
        let excess = (self.usual - params.payload_mass * params.gravity) * vehicle.per_total_mass();
        self.pull.believed(vehicle, excess.min(T::zero()))
    }
}
