//! What the tests of a line share: the flights, their commands bit by bit, and a line that ends.

use std::io::{self, Read, Write};
use std::os::unix::net::UnixStream;
use std::time::Duration;

use controller::{ActuatorLimits, Command, ObserverParams, Request, State};
use hil_sim::describe::scenario::{FIGURES, Scenario, builtin};
use hil_sim::fly::flight::{Control, End};
use hil_sim::fly::pilot::{Answers, Decision, Pilot};
use hil_sim::fly::run::{self, Flight};
use hil_sim::hil::{HilError, Options, Pace, Target, Wire};
use hil_sim::world::Reading;

/// Remembers every number of every command, by its bits.
pub struct Recorded<A> {
    pub inner: A,
    pub commands: Vec<[u32; 8]>,
}

impl<A> Recorded<A> {
    pub fn new(inner: A) -> Self {
        Self { inner, commands: Vec::new() }
    }
}

impl<A: Answers> Answers for Recorded<A> {
    fn start(&mut self, state: &State<f64>, zeta: [f64; 4]) {
        self.inner.start(state, zeta);
    }

    fn take_over(&mut self, state: &State<f64>, applied: &Command<f64>) {
        self.inner.take_over(state, applied);
    }

    fn lands(&self) -> bool {
        self.inner.lands()
    }

    fn finds_its_state(&self) -> bool {
        self.inner.finds_its_state()
    }

    fn step(&mut self, read: &Reading, request: Request, t_s: f64) -> Option<&Decision> {
        let decision = self.inner.step(read, request, t_s)?;
        let Decision { command, zeta, .. } = *decision;
        let [t1, t2, t3] = command.torque.into();
        let [z1, z2, z3, z4] = zeta;
        // The law computes in f32, so nothing is lost.
        self.commands.push([command.thrust, t1, t2, t3, z1, z2, z3, z4].map(|number| (number as f32).to_bits()));
        Some(decision)
    }
}

pub fn scenario(name: &str, duration_s: f64) -> Scenario {
    let mut scenario = builtin(name).expect("it is built in").expect("and valid");
    scenario.duration_s = scenario.duration_s.min(duration_s);
    scenario.steady_from_s = None;
    scenario
}

/// The paper's figures, and one flight with what they leave off: observers against a wrong mass,
/// limits that are met, a latency and a lag to look ahead for.
pub fn flights(duration_s: f64) -> Vec<Scenario> {
    let mut flights: Vec<Scenario> = FIGURES.iter().map(|(name, _)| scenario(name, duration_s)).collect();
    let mut observed = scenario("fig5-no-integral", duration_s);
    observed.name = "observed".to_owned();
    let controller = &mut observed.controller;
    controller.observer = ObserverParams::with_bandwidth(4.0);
    controller.limits = ActuatorLimits { min_thrust: 5.0, max_thrust: 40.0, max_torque: [0.5, 0.75, 0.25] };
    controller.latency_s = 0.002;
    controller.rotor_lag_s = 0.005;
    flights.push(observed);
    flights
}

pub fn fly<A: Answers>(scenario: &Scenario, controller: &mut A) -> Flight {
    run::fly_on(scenario, controller, false, Control::alone()).expect("a built-in scenario can be set up")
}

pub fn fly_here(scenario: &Scenario) -> Vec<[u32; 8]> {
    let mut pilot = Recorded::new(Pilot::<f32>::new(&scenario.controller).expect("valid"));
    assert_eq!(fly(scenario, &mut pilot).end, End::Complete);
    pilot.commands
}

/// Flies on a target; its commands, or why it ended.
pub fn fly_there(scenario: &Scenario, target: Target) -> (Result<Vec<[u32; 8]>, HilError>, Target) {
    let mut target = Recorded::new(target);
    if let Err(error) = target.inner.prepare(scenario) {
        return (Err(error), target.inner);
    }
    let flight = fly(scenario, &mut target);
    let Recorded { inner: mut target, commands } = target;
    match (flight.end, target.take_failure()) {
        (End::Complete, None) => (Ok(commands), target),
        (_, Some(error)) => (Err(error), target),
        (end, None) => panic!("ended as {end:?} for no reason"),
    }
}

/// Quick to ask again: in a test the other end is near.
pub const OPTIONS: Options = Options {
    pace: Pace::Lockstep,
    patience: Duration::from_secs(10),
    retry: Duration::from_millis(20),
    telemetry: false,
};

/// A line that ends after so many reads.
pub struct Ending {
    pub stream: Option<UnixStream>,
    pub reads: u32,
}

impl Ending {
    fn stream(&mut self) -> io::Result<&mut UnixStream> {
        self.stream.as_mut().ok_or_else(|| io::ErrorKind::BrokenPipe.into())
    }
}

impl Read for Ending {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.reads = self.reads.saturating_sub(1);
        if self.reads == 0 {
            self.stream = None;
        }
        self.stream()?.read(bytes)
    }
}

impl Write for Ending {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream()?.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Wire for Ending {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.stream()?.set_patience(patience)
    }
}
