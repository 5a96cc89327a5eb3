//! One flight of many: a pilot that takes over from a hover, judged by its distance from the path.
//! Comparisons and campaigns fly with this; it keeps no log.

use controller::{Mode, State};

use super::flight::{Control, End, Entry, LOST_M, Moment, Plan, fly};
use super::pilot::Answers;
use super::touchdown::Touchdown;
use crate::describe::scenario::Scenario;
use crate::world::Seed;

/// d_C below which a flight is good, m.
pub const GOOD_M: f64 = 0.25;

/// Share of the flight, at its end, in which d_C is judged.
pub const JUDGED: f64 = 0.25;

/// A flight that follows only when it is asked to is judged from so long after it began, s.
pub const JOINED_S: f64 = 5.0;

/// d_C is taken about this often, s.
const DISTANCE_PERIOD_S: f64 = 0.01;

/// The result of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// How it ended.
    pub end: End,
    /// Largest d_C in the last quarter, m; [`LOST_M`] if it did not come so far. Of a flight with
    /// requests, from [`JOINED_S`] after it began to follow for as long as it follows.
    pub dc_max_m: f64,
    /// Root mean square of d_C in the last quarter, m; likewise.
    pub dc_rms_m: f64,
    /// How it came to the ground.
    pub touchdown: Touchdown,
}

impl Outcome {
    /// Whether d_C stayed below 25 cm while it was judged.
    #[must_use]
    pub fn is_good(&self) -> bool {
        self.dc_max_m < GOOD_M
    }
}

/// Flies `scenario` from `start` with everything random drawn from `seed`; `ground_p3` (m) is where
/// a body that comes to it ends the flight. `watch` sees every period. `None` of a flight that was
/// interrupted.
pub fn judge(
    scenario: &Scenario,
    start: State<f64>,
    seed: Seed,
    ground_p3: Option<f64>,
    control: Control<'_>,
    pilot: &mut dyn Answers,
    watch: &mut dyn FnMut(&Moment<'_>),
) -> Option<Outcome> {
    let distance_every = ((DISTANCE_PERIOD_S * scenario.controller.rate_hz) as u64).max(1);
    let plan = Plan { start, seed, entry: Entry::Hover, ground_p3, distance_every, control };
    let judged_from = ((1.0 - JUDGED) * scenario.steps() as f64) as u64;
    let (mut largest, mut squares, mut count) = (0.0_f64, 0.0, 0_u32);
    let (mut touchdown, mut following_s) = (Touchdown::default(), 0.0);
    let end = fly(scenario, &plan, pilot, &mut |moment| {
        watch(moment);
        touchdown = *moment.touchdown;
        let follows = moment.decision.is_some_and(|decision| decision.mode == Mode::Follow);
        following_s = if follows { following_s + 1.0 / scenario.controller.rate_hz } else { 0.0 };
        let is_judged = if scenario.is_mission() { following_s > JOINED_S } else { moment.step >= judged_from };
        if is_judged && let (Some(distance), Some(_)) = (moment.distance_m, moment.decision) {
            largest = largest.max(distance);
            squares += distance * distance;
            count += 1;
        }
    });
    match end {
        End::Interrupted => None,
        End::Complete | End::Landed(_) => {
            let dc_rms_m = (squares / f64::from(count.max(1))).sqrt();
            Some(Outcome { end, dc_max_m: largest, dc_rms_m, touchdown })
        }
        _ => Some(Outcome { end, dc_max_m: LOST_M, dc_rms_m: LOST_M, touchdown }),
    }
}
