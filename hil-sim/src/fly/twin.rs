//! An f64 twin beside a pilot: the same source in another scalar, with its own ζ and integrals,
//! asked at the same states. What it answers moves nothing; its differences from the pilot are the
//! pilot's rounding.

use std::time::Duration;

use controller::{Command, Request, State};
use cpu_time::ThreadTime;

use super::deviation::{Deviation, Deviations};
use super::pilot::{Answers, Decision, Pilot};
use crate::describe::scenario::ControllerSpec;
use crate::world::Reading;

/// What the pilot was asked.
#[expect(clippy::large_enum_variant, reason = "nearly all are steps")]
enum Asked {
    Start(State<f64>, [f64; 4]),
    TakeOver(State<f64>, Command<f64>),
    SpeedFactor(f64),
    Step(Reading, Request, f64, Decision),
}

/// Questions after which the twin answers them: so many at a time that the clock costs nothing.
const BLOCK: usize = 256;

/// A pilot with its twin.
pub struct Twinned<'a> {
    pilot: &'a mut dyn Answers,
    twin: Option<Pilot<f64>>,
    asked: Vec<Asked>,
    deviations: Deviations,
    cpu: Duration,
}

impl<'a> Twinned<'a> {
    /// `pilot`, which flies what `spec` describes, with its `twin`, if it is to have one.
    pub fn new(pilot: &'a mut dyn Answers, twin: Option<Pilot<f64>>, spec: &ControllerSpec) -> Self {
        Self { pilot, twin, asked: Vec::new(), deviations: Deviations::new(spec), cpu: Duration::ZERO }
    }

    /// The pilot's rounding, where there is a twin, and the time that the twin took.
    pub fn finish(mut self) -> (Option<Deviation>, Duration) {
        self.answer();
        (self.twin.is_some().then(|| self.deviations.finish()), self.cpu)
    }

    /// Asks the twin something too, sooner or later.
    fn ask(&mut self, asked: Asked) {
        if self.twin.is_some() {
            self.asked.push(asked);
        }
    }

    fn answer(&mut self) {
        let Some(twin) = &mut self.twin else { return };
        let begun = ThreadTime::now();
        for asked in self.asked.drain(..) {
            match asked {
                Asked::Start(state, zeta) => twin.start(&state, zeta),
                Asked::TakeOver(state, applied) => twin.take_over(&state, &applied),
                Asked::SpeedFactor(factor) => twin.set_speed_factor(factor),
                Asked::Step(read, request, t_s, decision) => {
                    self.deviations.push(&decision, twin.decide(&read, request, t_s));
                }
            }
        }
        self.cpu += begun.elapsed();
    }
}

impl Answers for Twinned<'_> {
    fn start(&mut self, state: &State<f64>, zeta: [f64; 4]) {
        self.pilot.start(state, zeta);
        self.ask(Asked::Start(*state, zeta));
    }

    fn take_over(&mut self, state: &State<f64>, applied: &Command<f64>) {
        self.pilot.take_over(state, applied);
        self.ask(Asked::TakeOver(*state, *applied));
    }

    fn set_speed_factor(&mut self, factor: f64) {
        self.pilot.set_speed_factor(factor);
        self.ask(Asked::SpeedFactor(factor));
    }

    fn is_commanded(&self) -> bool {
        self.pilot.is_commanded()
    }

    fn finds_its_state(&self) -> bool {
        self.pilot.finds_its_state()
    }

    fn lands(&self) -> bool {
        self.pilot.lands()
    }

    fn step(&mut self, read: &Reading, request: Request, t_s: f64) -> Option<&Decision> {
        if self.asked.len() >= BLOCK {
            self.answer();
        }
        let decision = self.pilot.step(read, request, t_s)?;
        if self.twin.is_some() {
            self.asked.push(Asked::Step(*read, request, t_s, *decision));
        }
        Some(decision)
    }
}
