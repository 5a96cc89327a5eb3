//! A flight with everything that figures, tables and logs ask of it.

use controller::{State, Trapped};
use cpu_time::ThreadTime;

use super::deviation::Deviation;
use super::flight::{Control, End, Entry, Plan};
use super::metrics::{Metrics, Results};
use super::pilot::{Answers, Pilot};
use super::sample::{Contact, Sample, Seen};
use super::twin::Twinned;
use crate::describe::input::Invalid;
use crate::describe::scenario::Scenario;
use crate::study::replay::Replayed;
use crate::world::{Bodies, Seed};

/// The scalar that the pilot computes in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// As on the target.
    F32,
    /// As a reference.
    F64,
    /// As on the target, stopping at the first invalid operation: it panics, naming the operation
    /// and its place.
    Trapped,
}

/// A finished flight.
#[derive(Clone, Debug)]
pub struct Flight {
    /// What was measured.
    pub results: Results,
    /// Samples every `log_period_s`.
    pub log: Vec<Sample>,
    /// Rounding of the pilot, where a twin flew along.
    pub deviation: Option<Deviation>,
    /// How it ended.
    pub end: End,
    /// Time flown over CPU time of the thread that flew it, without the twin's.
    pub times_real_time: f64,
    /// The same with the twin's.
    pub times_real_time_with_twin: f64,
    /// Of a replay: how it compares with its log.
    pub replayed: Option<Replayed>,
}

/// Flies `scenario`; with `twin`, an f64 twin of the pilot answers beside it.
///
/// # Errors
/// [`Invalid`] if the scenario's numbers do not survive the pilot's scalar.
pub fn fly(scenario: &Scenario, arithmetic: Arithmetic, twin: bool, control: Control<'_>) -> Result<Flight, Invalid> {
    let spec = &scenario.controller;
    match arithmetic {
        Arithmetic::F32 => fly_on(scenario, &mut Pilot::<f32>::new(spec)?, twin, control),
        Arithmetic::F64 => fly_on(scenario, &mut Pilot::<f64>::new(spec)?, twin, control),
        Arithmetic::Trapped => fly_on(scenario, &mut Pilot::<Trapped>::new(spec)?, twin, control),
    }
}

/// Flies `scenario` with the pilot alone and to the end.
///
/// # Errors
/// As [`fly`].
pub fn fly_simply(scenario: &Scenario, arithmetic: Arithmetic) -> Result<Flight, Invalid> {
    fly(scenario, arithmetic, false, Control::alone())
}

/// Flies `scenario` on any pilot, as a target at the other end of a link.
///
/// # Errors
/// [`Invalid`] if the twin cannot be made.
pub fn fly_on(
    scenario: &Scenario,
    pilot: &mut dyn Answers,
    twin: bool,
    control: Control<'_>,
) -> Result<Flight, Invalid> {
    fly_watched(scenario, pilot, twin, control, &mut |_| {})
}

/// The same, where `see` sees the log whenever it has a sample more.
///
/// # Errors
/// As [`fly_on`].
pub fn fly_watched(
    scenario: &Scenario,
    pilot: &mut dyn Answers,
    twin: bool,
    control: Control<'_>,
    see: &mut dyn FnMut(&[Sample]),
) -> Result<Flight, Invalid> {
    let twin = if twin { Some(Pilot::<f64>::new(&scenario.controller)?) } else { None };
    let begun = ThreadTime::now();
    let mut pilot = Twinned::new(pilot, twin, &scenario.controller);
    let period = 1.0 / scenario.controller.rate_hz;
    let log_every = scenario.log_every();
    let plan = Plan {
        start: State::from_paper(&scenario.initial),
        seed: Seed { batch: scenario.seed, run: scenario.run },
        entry: if scenario.take_over { Entry::Hover } else { Entry::Stated },
        ground_p3: scenario.ground_p3,
        distance_every: 1,
        control,
    };
    let mut metrics = Metrics::new(scenario);
    let mut log = Vec::with_capacity((scenario.steps() / log_every) as usize + 2);
    let mut flown_s = 0.0;
    let end = super::flight::fly(scenario, &plan, &mut pilot, &mut |moment| {
        flown_s = moment.step as f64 * period;
        metrics.push(flown_s, moment.distance_m, moment.state, moment.decision);
        metrics.touch(moment.touchdown);
        if moment.step % log_every == 0 || moment.is_over {
            // At the start as they were given: there and back they would be rounded.
            let x = if moment.step == 0 { scenario.initial } else { moment.state.to_paper() };
            let Bodies { uav_position, uav_velocity, .. } = moment.body.bodies();
            log.push(Sample {
                t_s: flown_s,
                x,
                uav_position,
                uav_velocity,
                distance_m: moment.distance_m.unwrap_or(f64::NAN),
                decision: moment.decision.copied(),
                seen: moment.sight.and_then(Seen::of),
                contact: Contact::of(moment.body),
                logged: None,
            });
            see(&log);
        }
    });
    let (deviation, twin_cpu) = pilot.finish();
    let cpu = begun.elapsed();
    Ok(Flight {
        results: metrics.finish(),
        log,
        deviation,
        end,
        times_real_time: flown_s / cpu.saturating_sub(twin_cpu).as_secs_f64(),
        times_real_time_with_twin: flown_s / cpu.as_secs_f64(),
        replayed: None,
    })
}
