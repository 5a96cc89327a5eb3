//! One flight of many: a controller in f32 engaged from hover thrust in a [world](crate::world), judged by its distance from
//! the path. Comparisons and campaigns fly with this; it keeps no log, a watcher sees every period.

use controller::{Command, Disturbance, Fault, Margins, Mode, State, Vector3};

use crate::describe::scenario::Scenario;
use crate::fly::pilot::{Decision, Pilot};
use crate::world::{Seed, World};

/// A flight this far from its path is lost and ends, m.
pub const LOST_M: f64 = 100.0;

/// d_C below which a flight is good, m.
pub const GOOD_M: f64 = 0.25;

/// Share of the flight, at its end, in which d_C is judged.
pub const JUDGED: f64 = 0.25;

/// d_C is taken about this often, s: a nearest point can cost more than a step of the law.
const DISTANCE_PERIOD_S: f64 = 0.01;

/// What flies the vehicle: a law alone, or a supervised one.
pub trait Steers {
    /// Takes over from whatever applied `applied` until now.
    fn take_over(&mut self, state: &State<f64>, applied: &Command<f64>);

    /// The command for the coming hold, from the state read now.
    fn steer(&mut self, state: &State<f64>, t_s: f64) -> Steering;
}

/// An answer of what flies the vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Steering {
    /// For the coming hold.
    pub command: Command<f64>,
    /// The law's distances from its singularities, where the law was asked.
    pub margins: Option<Margins<f64>>,
    /// What the vehicle is doing; [`Mode::Follow`] of a law alone.
    pub mode: Mode,
    /// Why it is not doing what was asked.
    pub fault: Option<Fault>,
    /// What has been found of disturbances.
    pub disturbance: Disturbance<f64>,
}

impl Steers for Pilot<f32> {
    fn take_over(&mut self, state: &State<f64>, applied: &Command<f64>) {
        Self::take_over(self, state, applied);
    }

    #[inline]
    fn steer(&mut self, state: &State<f64>, t_s: f64) -> Steering {
        let Decision { input, telemetry, .. } = self.step(state, t_s);
        Steering {
            command: Command { thrust: input.thrust, torque: Vector3::from(input.torque) },
            margins: telemetry.map(|telemetry| telemetry.margins),
            mode: Mode::Follow,
            fault: None,
            disturbance: self.disturbance(),
        }
    }
}

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// At its duration.
    Complete,
    /// On the ground, at this time, s.
    Crashed(f64),
    /// [`LOST_M`] from its path, at this time, s.
    Lost(f64),
    /// With a state or command that is not finite, at this time, s.
    NotFinite(f64),
}

/// What a watcher sees at every period.
pub struct Moment<'a> {
    /// s.
    pub t_s: f64,
    /// The state as it is, not as it is read.
    pub state: &'a State<f64>,
    /// d_C, m, where it was taken in this period.
    pub distance_m: Option<f64>,
    /// What the controller answered.
    pub steering: &'a Steering,
}

/// The result of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// How it ended.
    pub ending: Ending,
    /// Largest d_C in the last quarter, m; [`LOST_M`] if it did not come so far.
    pub dc_max_m: f64,
    /// Root mean square of d_C in the last quarter, m; likewise.
    pub dc_rms_m: f64,
}

impl Outcome {
    /// Whether d_C stayed below 25 cm in the last quarter.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.dc_max_m < GOOD_M
    }
}

/// Flies `scenario` from `start` with everything random drawn from `seed`; what flies before it engages is a hover at the thrust that
/// the controller takes for one. `ground_p3` (m) is where a body that comes to it ends the flight.
pub fn fly(
    scenario: &Scenario,
    start: &State<f64>,
    seed: Seed,
    ground_p3: Option<f64>,
    pilot: &mut impl Steers,
    watch: &mut impl FnMut(&Moment<'_>),
) -> Outcome {
    let told = &scenario.controller.vehicle;
    let hover = Command { thrust: (told.payload_mass + told.uav_mass) * told.gravity, torque: Vector3::zeros() };
    let mut world = World::new(&scenario.world(), start, hover, seed);
    let rate_hz = scenario.controller.rate_hz;
    let steps = scenario.steps();
    let periods = |seconds: f64| (seconds * rate_hz).round() as u64;
    let held = scenario.obstacle.map_or(0..0, |o| periods(o.at_s)..periods(o.at_s + o.hold_s));
    let stopped_at = scenario.obstacle.map(|obstacle| periods(obstacle.at_s));
    let every = ((DISTANCE_PERIOD_S * rate_hz) as u64).max(1);
    let judged_from = ((1.0 - JUDGED) * steps as f64) as u64;
    let lost = |ending| Outcome { ending, dc_max_m: LOST_M, dc_rms_m: LOST_M };
    let (mut largest, mut squares, mut count) = (0.0_f64, 0.0, 0_u32);
    let mut last: Option<Steering> = None;
    for step in 0..steps {
        let t_s = world.time_s();
        if stopped_at == Some(step) {
            let attitude = world.body().state().attitude;
            world.stop(libm::atan2(attitude.m21, attitude.m22));
            last = None;
        }
        if held.contains(&step) {
            world.wait();
            continue;
        }
        let read = world.read();
        let steering = if let Some(last) = last.filter(|_| world.misses()) {
            last
        } else {
            if last.is_none() {
                pilot.take_over(&read, &hover);
            }
            pilot.steer(&read, t_s)
        };
        last = Some(steering);
        let state = world.body().state();
        let distance_m = (step % every == 0).then(|| scenario.controller.law.distance(state.position.into()));
        watch(&Moment { t_s, state: &state, distance_m, steering: &steering });
        if let Some(distance) = distance_m {
            // Not so of a NaN, which the body's finite state cannot give.
            if distance > LOST_M {
                return lost(Ending::Lost(t_s));
            }
            if step >= judged_from {
                largest = largest.max(distance);
                squares += distance * distance;
                count += 1;
            }
        }
        if ground_p3.is_some_and(|ground| state.position.z >= ground || world.body().uav_position().z >= ground) {
            return lost(Ending::Crashed(t_s));
        }
        let command = &steering.command;
        world.advance(command);
        let finite = command.thrust.is_finite() && command.torque.iter().all(|torque| torque.is_finite());
        if !(finite && world.body().is_finite()) {
            return lost(Ending::NotFinite(t_s));
        }
    }
    let dc_rms_m = (squares / f64::from(count.max(1))).sqrt();
    Outcome { ending: Ending::Complete, dc_max_m: largest, dc_rms_m }
}
