//! A flight: the controller at its rate, the [world](crate::world) between samples, and an f64 twin that measures rounding.
//!
//! The pilot sees the state at each sample; its thrust and torque are held until the next. Beside an f32 pilot an f64
//! twin, the same source in another scalar with its own ζ and integrals, is asked at the same states; what it answers
//! moves nothing.

use controller::Trapped;
use controller::{Command, SetupError, State, Vector3};
use cpu_time::ThreadTime;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::describe::scenario::Scenario;
use crate::fly::deviation::{Deviation, Deviations};
use crate::fly::metrics::{Metrics, Results};
use crate::fly::pilot::{Answers, Decision, Pilot};
use crate::world::{Seed, World};
use witness::plant::{Input, index};

/// The scalar that the pilot computes in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// As on the target.
    F32,
    /// As a reference.
    F64,
    /// As on the target, stopping at the first invalid operation: it panics, naming the operation and its place.
    Trapped,
}

/// One sample of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// s.
    pub t_s: f64,
    /// The paper's 16 coordinates.
    pub x: [f64; 16],
    /// What the pilot answered; none while an obstacle holds the vehicle, and none at the end.
    pub decision: Option<Decision>,
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
    /// Time flown over CPU time of the thread that flew it.
    pub times_real_time: f64,
}

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// At its duration.
    Complete,
    /// At a user's wish.
    Interrupted,
    /// State or command stopped being finite at this time, s.
    NotFinite(f64),
    /// The controller stopped answering at this time, s.
    Unanswered(f64),
}

/// How to fly.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// The pilot's scalar.
    pub arithmetic: Arithmetic,
    /// Let an f64 twin of the pilot answer beside it.
    pub twin: bool,
    /// Ends the flight early once true.
    pub stop: &'a AtomicBool,
    /// Called now and then with the seconds flown since the last call.
    pub progress: &'a (dyn Fn(f64) + Sync),
}

/// Control periods between two looks at `stop` and two calls of `progress`.
const CHECK_PERIODS: u64 = 256;

/// Flies `scenario`.
///
/// # Errors
/// [`SetupError`] if the scenario's numbers do not survive the pilot's scalar.
pub fn fly(scenario: &Scenario, options: Options<'_>) -> Result<Flight, SetupError<f64>> {
    let twin = if options.twin { Some(Pilot::<f64>::new(&scenario.controller)?) } else { None };
    Ok(match options.arithmetic {
        Arithmetic::F32 => {
            let mut pilot = Pilot::<f32>::new(&scenario.controller).map_err(|error| error.cast())?;
            fly_with(scenario, &mut pilot, twin, options)
        }
        Arithmetic::F64 => fly_with(scenario, &mut Pilot::<f64>::new(&scenario.controller)?, twin, options),
        Arithmetic::Trapped => {
            let mut pilot = Pilot::<Trapped>::new(&scenario.controller).map_err(|error| error.cast())?;
            fly_with(scenario, &mut pilot, twin, options)
        }
    })
}

/// Flies `scenario` on a controller that is not made here, as a target at the other end of a link; `options.arithmetic` has no say.
///
/// # Errors
/// [`SetupError`] if the twin cannot be made.
pub fn fly_on(
    scenario: &Scenario,
    controller: &mut impl Answers,
    options: Options<'_>,
) -> Result<Flight, SetupError<f64>> {
    let twin = if options.twin { Some(Pilot::<f64>::new(&scenario.controller)?) } else { None };
    Ok(fly_with(scenario, controller, twin, options))
}

/// Flies `scenario` with the f32 pilot, alone and to the end.
///
/// # Errors
/// As [`fly`].
pub fn fly_simply(scenario: &Scenario, arithmetic: Arithmetic) -> Result<Flight, SetupError<f64>> {
    let stop = AtomicBool::new(false);
    fly(scenario, Options { arithmetic, twin: false, stop: &stop, progress: &|_| {} })
}

fn fly_with<A: Answers>(
    scenario: &Scenario,
    pilot: &mut A,
    mut twin: Option<Pilot<f64>>,
    options: Options<'_>,
) -> Flight {
    let started = ThreadTime::now();
    let period = 1.0 / scenario.controller.rate_hz;
    let steps = scenario.steps();
    let log_every = scenario.log_every();
    let (stopped_at, released_at) = match scenario.obstacle {
        Some(obstacle) => (scenario.periods(obstacle.at_s), scenario.periods(obstacle.at_s + obstacle.hold_s)),
        None => (u64::MAX, u64::MAX),
    };

    let hover =
        Command { thrust: scenario.vehicle.total_mass() * scenario.vehicle.gravity, torque: Vector3::zeros() };
    let seed = Seed { batch: scenario.seed, run: 0 };
    let mut world = World::new(&scenario.world(), &State::from_paper(&scenario.initial), hover, seed);
    let mut x = scenario.initial;
    let mut metrics = Metrics::new(scenario);
    let mut deviations = Deviations::new(&scenario.controller);
    let mut log = Vec::with_capacity((steps / log_every) as usize + 2);
    let mut end = End::Complete;
    let mut start = Some(scenario.controller.zeta);
    // What goes on where the controller misses a sample.
    let mut last: Option<Decision> = None;
    let mut step = 0;
    while step < steps {
        let t_s = step as f64 * period;
        if step % CHECK_PERIODS == 0 && step > 0 {
            (options.progress)(CHECK_PERIODS as f64 * period);
            if options.stop.load(Ordering::Relaxed) {
                end = End::Interrupted;
                break;
            }
        }
        if step == stopped_at {
            world.stop(x[index::PSI]);
            x = world.body().state().to_paper();
        }
        if step == released_at {
            start = Some([0.0; 4]);
        }
        let held = (stopped_at..released_at).contains(&step);
        let mut sample = Sample { t_s, x, decision: None };
        if held {
            world.wait();
        } else {
            let state = world.read();
            if let Some(zeta) = start.take() {
                pilot.start(&state, zeta);
                if let Some(twin) = &mut twin {
                    twin.start(&state, zeta);
                }
            }
            let decision = if let Some(last) = last.filter(|_| world.misses()) {
                last
            } else {
                let Some(decision) = pilot.step(&state, t_s) else {
                    end = End::Unanswered(t_s);
                    break;
                };
                if let Some(twin) = &mut twin {
                    deviations.push(&decision, &twin.step(&state, t_s));
                }
                decision
            };
            last = Some(decision);
            sample.decision = last;
            let Input { thrust, torque } = decision.input;
            world.advance(&Command { thrust, torque: torque.into() });
            x = world.body().state().to_paper();
        }
        metrics.push(&sample, period);
        if step % log_every == 0 {
            log.push(sample);
        }
        step += 1;
        if !(world.body().is_finite() && sample.decision.is_none_or(|d| is_finite(&d.input))) {
            end = End::NotFinite(t_s);
            break;
        }
    }
    let last = Sample { t_s: step as f64 * period, x, decision: None };
    metrics.push(&last, 0.0);
    log.push(last);
    (options.progress)((step % CHECK_PERIODS) as f64 * period);

    let flown = step as f64 * period;
    Flight {
        results: metrics.finish(),
        log,
        deviation: options.twin.then(|| deviations.finish()),
        end,
        times_real_time: flown / started.elapsed().as_secs_f64(),
    }
}

fn is_finite(input: &Input) -> bool {
    input.thrust.is_finite() && input.torque.iter().all(|value| value.is_finite())
}
