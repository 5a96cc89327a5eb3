//! The flight loop: a pilot at its rate, the [world](crate::world) between samples, and a watcher
//! that sees every period.

use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};

use controller::{Command, Request, State, Vector3};

use super::pilot::{Answers, Decision};
use super::sight::Sight;
use super::touchdown::{Touchdown, Watch};
use crate::describe::scenario::{Requests, Scenario};
use crate::world::{Body, Seed, World};

/// A flight this far from its path is lost and ends, m; one that starts further off, at twice its
/// distance then.
pub const LOST_M: f64 = 100.0;

/// How a pilot begins, and begins again after an obstacle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Entry {
    /// From the ζ that the scenario states, and from ζ = 0 after an obstacle, as the paper has it.
    Stated,
    /// From a hover, without a bump in thrust.
    Hover,
}

/// How a flight is interrupted, and whom it tells how far it is.
#[derive(Clone, Copy)]
pub struct Control<'a> {
    /// Ends the flight early once true.
    pub stop: &'a AtomicBool,
    /// Called now and then with the seconds flown since the last call; in all with the whole
    /// duration.
    pub progress: &'a (dyn Fn(f64) + Sync),
}

impl Control<'static> {
    /// Nobody interrupts, nobody is told.
    #[must_use]
    pub fn alone() -> Self {
        static NEVER: AtomicBool = AtomicBool::new(false);
        Self { stop: &NEVER, progress: &|_| {} }
    }
}

/// How a scenario is flown.
#[derive(Clone, Copy)]
pub struct Plan<'a> {
    /// The state at the start, but where the scenario says where both bodies are.
    pub start: State<f64>,
    /// Of everything random.
    pub seed: Seed,
    /// How the pilot begins.
    pub entry: Entry,
    /// Where a body that comes to it ends the flight, m; negative is above the origin. A scenario's
    /// own ground carries both.
    pub ground_p3: Option<f64>,
    /// Control periods from one d_C to the next: a nearest point can cost more than a step of the
    /// law.
    pub distance_every: u64,
    /// Who watches over it.
    pub control: Control<'a>,
}

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// At its duration.
    Complete,
    /// After a landing that was asked for, rotors off and both bodies at rest, at this time, s.
    Landed(f64),
    /// At a user's wish.
    Interrupted,
    /// Into the ground, at this time, s.
    Crashed(f64),
    /// [`LOST_M`] from its path, at this time, s.
    Lost(f64),
    /// State or command stopped being finite at this time, s.
    NotFinite(f64),
    /// The controller stopped answering at this time, s.
    Unanswered(f64),
}

impl End {
    /// In a few words, of a flight that ended before its time.
    #[must_use]
    pub fn failure(self) -> Option<String> {
        match self {
            Self::Complete | Self::Landed(_) => None,
            Self::Interrupted => Some("interrupted".to_owned()),
            Self::Crashed(at_s) => Some(format!("on the ground at {at_s:.3} s")),
            Self::Lost(at_s) | Self::NotFinite(at_s) => Some(format!("lost at {at_s:.3} s")),
            Self::Unanswered(at_s) => Some(format!("unanswered from {at_s:.3} s")),
        }
    }
}

/// What a watcher sees at every control period, and once more at the end, if the state is then one
/// to be seen.
pub struct Moment<'a> {
    /// Control periods since the start.
    pub step: u64,
    /// The world's time, s: with a clock that jitters, not a whole number of periods.
    pub t_s: f64,
    /// The state as it is, not as it is read.
    pub state: &'a State<f64>,
    /// Payload and UAV as they move.
    pub body: &'a Body,
    /// How they came to the ground so far.
    pub touchdown: &'a Touchdown,
    /// What was asked for.
    pub request: Request,
    /// d_C, m, where it was taken in this period.
    pub distance_m: Option<f64>,
    /// What the pilot answered; none while an obstacle holds the vehicle, and none at the end.
    pub decision: Option<&'a Decision>,
    /// The estimator that the pilot flies on, where it does, once it has answered.
    pub sight: Option<&'a Sight>,
    /// The flight is over: there is one such moment, the last.
    pub is_over: bool,
}

impl<'a> Moment<'a> {
    /// Of `world` in `state`, without what is asked for and answered.
    fn of(step: u64, world: &'a World, state: &'a State<f64>, ground: &'a Watch) -> Self {
        Self {
            step,
            t_s: world.time_s(),
            state,
            body: world.body(),
            touchdown: &ground.touchdown,
            request: Request::Off,
            distance_m: None,
            decision: None,
            sight: None,
            is_over: false,
        }
    }
}

/// Control periods between two looks at `stop` and two calls of `progress`.
const CHECK_PERIODS: u64 = 256;

/// Flies `scenario`. What flies before the pilot begins is a hover at the thrust that the
/// controller takes for one; a vehicle that stands on the ground begins with its rotors off.
pub fn fly(scenario: &Scenario, plan: &Plan<'_>, pilot: &mut dyn Answers, watch: &mut dyn FnMut(&Moment<'_>)) -> End {
    let mut underway = Underway::new(scenario, plan, pilot);
    let steps = scenario.steps();
    let mut told_s = 0.0;
    let end = loop {
        if underway.step >= steps {
            break End::Complete;
        }
        if underway.step > 0 && underway.step.is_multiple_of(CHECK_PERIODS) {
            let flown_s = CHECK_PERIODS as f64 * underway.period;
            (plan.control.progress)(flown_s);
            told_s += flown_s;
            if plan.control.stop.load(Ordering::Relaxed) {
                break End::Interrupted;
            }
        }
        if let Some(end) = underway.pass(pilot, watch) {
            break end;
        }
    };
    underway.show_end(watch);
    (plan.control.progress)(scenario.duration_s - told_s);
    end
}

/// A flight at the beginning of a control period.
struct Underway<'a> {
    scenario: &'a Scenario,
    plan: &'a Plan<'a>,
    world: World,
    /// The estimator, where there is one.
    sight: Option<Sight>,
    ground: Watch,
    requests: Requests,
    /// Periods in which an obstacle holds the vehicle.
    held: Option<Range<u64>>,
    lost_m: f64,
    period: f64,
    is_commanded: bool,
    finds_its_state: bool,
    /// What the controller takes for a hover, and what was commanded last.
    hover: Command<f64>,
    applied: Command<f64>,
    zeta: [f64; 4],
    has_begun: bool,
    step: u64,
}

impl<'a> Underway<'a> {
    fn new(scenario: &'a Scenario, plan: &'a Plan<'a>, pilot: &dyn Answers) -> Self {
        let controller = &scenario.controller;
        let told = &controller.vehicle;
        let hover = Command { thrust: (told.payload_mass + told.uav_mass) * told.gravity, torque: Vector3::zeros() };
        let begun = if scenario.standing { Command::zero() } else { hover };
        let sight = scenario.estimator.as_ref().map(|estimator| {
            // Every range of a scenario lies within the filters' own.
            Sight::new(estimator, scenario, &plan.start, begun.thrust, plan.seed).expect("a scenario's numbers")
        });
        let period = 1.0 / controller.rate_hz;
        Self {
            scenario,
            plan,
            world: scenario.begin(&plan.start, begun, plan.seed),
            sight,
            ground: Watch::new(scenario.ground, period),
            requests: Requests::of(scenario),
            held: scenario.obstacle.map(|o| scenario.periods(o.at_s)..scenario.periods(o.at_s + o.hold_s)),
            lost_m: LOST_M.max(2.0 * controller.law.distance(plan.start.position.into())),
            period,
            is_commanded: pilot.is_commanded(),
            finds_its_state: pilot.finds_its_state(),
            hover,
            applied: begun,
            zeta: controller.zeta,
            has_begun: false,
            step: 0,
        }
    }

    /// A control period; how the flight ended, if it did.
    fn pass(&mut self, pilot: &mut dyn Answers, watch: &mut dyn FnMut(&Moment<'_>)) -> Option<End> {
        let t_s = self.world.time_s();
        if self.held.as_ref().is_some_and(|held| held.start == self.step) {
            let attitude = self.world.body().state().attitude;
            self.world.stop(libm::atan2(attitude.m21, attitude.m22));
            (self.has_begun, self.zeta) = (false, [0.0; 4]);
        }
        let state = self.world.body().state();
        let distance_m = self.distance_m(&state);
        if distance_m.is_some_and(|distance| distance > self.lost_m) {
            return Some(End::Lost(t_s));
        }
        if self.has_crashed(&state) {
            return Some(End::Crashed(t_s));
        }
        let (request, factor) = self.requests.at(self.step);
        let request = if request == Request::Follow && pilot.lands() { Request::Land } else { request };
        if let Some(factor) = factor {
            pilot.set_speed_factor(factor);
        }
        if self.held.as_ref().is_some_and(|held| held.contains(&self.step)) {
            watch(&Moment { request, distance_m, ..self.moment(&state) });
            self.world.wait();
            self.step += 1;
            return None;
        }
        let Some(decision) = self.ask(pilot, &state, request) else { return Some(End::Unanswered(t_s)) };
        watch(&Moment {
            request,
            distance_m,
            decision: Some(decision),
            sight: self.sight.as_ref().filter(|_| !self.finds_its_state),
            ..self.moment(&state)
        });
        let has_landed = self.ground.has_landed(self.world.body(), request, decision.mode);
        if has_landed && self.requests.is_over() && !self.is_commanded {
            return Some(End::Landed(t_s));
        }
        self.applied = decision.command;
        self.world.obey(decision.order());
        self.step += 1;
        let is_finite = self.applied.is_finite() && self.world.body().is_finite();
        (!is_finite).then_some(End::NotFinite(t_s))
    }

    /// The pilot's answer to what it can see.
    fn ask<'p>(&mut self, pilot: &'p mut dyn Answers, state: &State<f64>, request: Request) -> Option<&'p Decision> {
        let Self { world, sight, has_begun, .. } = self;
        let comes = !(*has_begun && world.misses());
        let read = match sight {
            Some(sight) => sight.see(world, &self.applied),
            None => world.read(state),
        };
        if !*has_begun && !self.scenario.standing {
            match self.plan.entry {
                Entry::Stated => pilot.start(&read.state, self.zeta),
                Entry::Hover => pilot.take_over(&read.state, &self.hover),
            }
        }
        read.comes = comes;
        // Whether it stands or flies, the first reading says.
        read.sees_load |= !*has_begun;
        *has_begun = true;
        // A controller counts its periods.
        pilot.step(read, request, self.step as f64 * self.period)
    }

    /// The end, to the watcher.
    fn show_end(&mut self, watch: &mut dyn FnMut(&Moment<'_>)) {
        let state = self.world.body().state();
        // A state beyond all ranges is no number to log or to draw.
        if state.check().is_ok() {
            let distance_m = self.distance_m(&state);
            let request = self.requests.at(self.step).0;
            watch(&Moment { request, distance_m, is_over: true, ..self.moment(&state) });
        }
    }

    fn moment<'m>(&'m self, state: &'m State<f64>) -> Moment<'m> {
        Moment::of(self.step, &self.world, state, &self.ground)
    }

    /// d_C, m, in a period in which it is taken.
    fn distance_m(&self, state: &State<f64>) -> Option<f64> {
        let is_taken = !self.is_commanded && self.step.is_multiple_of(self.plan.distance_every);
        is_taken.then(|| self.scenario.controller.law.distance(state.position.into()))
    }

    fn has_crashed(&mut self, state: &State<f64>) -> bool {
        let body = self.world.body();
        let on_ground = |p3: f64| self.plan.ground_p3.is_some_and(|ground| p3 >= ground);
        self.ground.has_crashed(body) || on_ground(state.position.z) || on_ground(body.uav_position().z)
    }
}
