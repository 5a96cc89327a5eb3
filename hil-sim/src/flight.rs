//! One flight of many: the f32 controller engaged from hover thrust in a [world](crate::world), judged by its distance from
//! the path. Comparisons and campaigns fly with this; it keeps no log, a watcher sees every period.

use controller::{Command, SetupError, State, Vector3};

use crate::pilot::{Decision, Pilot};
use crate::scenario::Scenario;
use crate::world::{Seed, World};

/// A flight this far from its path is lost and ends, m.
pub const LOST_M: f64 = 100.0;

/// d_C is taken about this often, s: a nearest point can cost more than a step of the law.
const DISTANCE_PERIOD_S: f64 = 0.01;

/// Share of the flight, at its end, in which d_C is judged.
const JUDGED: f64 = 0.25;

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// At its duration.
    Complete,
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
    pub decision: &'a Decision,
    /// The controller.
    pub pilot: &'a Pilot<f32>,
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

/// d_C below which a flight is good, m.
pub const GOOD_M: f64 = 0.25;

/// Flies `scenario` from `start` with everything random drawn from `seed`.
///
/// # Errors
/// [`SetupError`] if the scenario's numbers do not survive rounding to f32.
pub fn fly(
    scenario: &Scenario,
    start: &State<f64>,
    seed: Seed,
    watch: &mut impl FnMut(&Moment<'_>),
) -> Result<Outcome, SetupError<f32>> {
    let told = &scenario.controller.vehicle;
    let hover = Command { thrust: (told.payload_mass + told.uav_mass) * told.gravity, torque: Vector3::zeros() };
    let mut pilot = Pilot::<f32>::new(&scenario.controller)?;
    let mut world = World::new(&scenario.world(), start, hover, seed);

    let rate_hz = scenario.controller.rate_hz;
    let steps = scenario.steps();
    let every = ((DISTANCE_PERIOD_S * rate_hz) as u64).max(1);
    let judged_from = ((1.0 - JUDGED) * steps as f64) as u64;
    let lost = |ending| Outcome { ending, dc_max_m: LOST_M, dc_rms_m: LOST_M };
    let (mut largest, mut squares, mut count) = (0.0_f64, 0.0, 0_u32);
    for step in 0..steps {
        let t_s = world.time_s();
        let read = world.read();
        if step == 0 {
            pilot.engage(&read, &hover);
        }
        let decision = pilot.step(&read, t_s);
        let state = world.body().state();
        let distance_m = (step % every == 0).then(|| scenario.controller.law.distance(state.position.into()));
        watch(&Moment { t_s, state: &state, distance_m, decision: &decision, pilot: &pilot });
        if let Some(distance) = distance_m {
            if distance > LOST_M {
                return Ok(lost(Ending::Lost(t_s)));
            }
            if step >= judged_from {
                largest = largest.max(distance);
                squares += distance * distance;
                count += 1;
            }
        }
        let command = Command { thrust: decision.input.thrust, torque: Vector3::from(decision.input.torque) };
        world.advance(&command);
        let finite = command.thrust.is_finite() && command.torque.iter().all(|torque| torque.is_finite());
        if !(finite && world.body().is_finite()) {
            return Ok(lost(Ending::NotFinite(t_s)));
        }
    }
    let dc_rms_m = (squares / f64::from(count.max(1))).sqrt();
    Ok(Outcome { ending: Ending::Complete, dc_max_m: largest, dc_rms_m })
}
