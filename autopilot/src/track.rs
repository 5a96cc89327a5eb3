//! The tracking law and the least guard that it can fly with: a good state and a finite answer, or the policy's command without either.

use controller::{
    Actuation, Command, Fault, Lost, Mode, Reference, SetupError, Solution, State, TrackXi, Tracker, Vector3, Vehicle,
};

use crate::parameters::{Parameter, Parameters};
use crate::rotors::Actuators;
use crate::setup;

/// A step of the tracking law, guarded.
pub struct Tracked {
    pub command: Command<f32>,
    pub fault: Option<Fault>,
    pub solution: Option<Solution<f32, TrackXi<f32>>>,
}

/// Trajectory tracking of a circle.
#[derive(Clone, Debug)]
pub struct Tracking {
    tracker: Tracker<f32>,
    /// Radius (m), p3 (m) and rate (rad/s) of the reference.
    circle: [f32; 3],
    actuators: Actuators,
    lost: Lost<f32>,
    /// Off, follow or fault.
    mode: Mode,
    /// Why the fault.
    fault: Option<Fault>,
}

impl Tracking {
    /// The law of `parameters`, not started.
    pub fn new(parameters: &Parameters) -> Result<Self, SetupError<f32>> {
        let actuators = Actuators::new(parameters)?;
        let vehicle = setup::vehicle(parameters)?;
        let tracker = Tracker::new(vehicle, setup::track_gains(parameters), setup::sampling(parameters))?
            .with_limits(actuators.limits())?
            .with_observer(&setup::observer(parameters))?;
        let circle = [Parameter::PathRadius, Parameter::PathP3, Parameter::ReferenceRate];
        Ok(Self {
            tracker,
            circle: circle.map(|parameter| parameters.get(parameter)),
            actuators,
            lost: setup::policy(parameters).lost,
            mode: Mode::Off,
            fault: None,
        })
    }

    pub fn tracker(&self) -> &Tracker<f32> {
        &self.tracker
    }

    pub fn vehicle(&self) -> &Vehicle<f32> {
        self.tracker.vehicle()
    }

    pub fn actuators(&self) -> &Actuators {
        &self.actuators
    }

    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// Starts from a stated ζ.
    pub fn start(&mut self, state: &State<f32>, zeta: [f32; 4]) {
        self.tracker.start(state, zeta);
        (self.mode, self.fault) = (Mode::Follow, None);
    }

    /// Goes on from `applied` without a bump in thrust.
    pub fn take_over(&mut self, state: &State<f32>, applied: Command<f32>) {
        self.tracker.take_over(state, applied);
        (self.mode, self.fault) = (Mode::Follow, None);
    }

    /// The command for the coming hold; `phase` (rad) is where the reference is now.
    pub fn step(&mut self, state: &State<f32>, phase: f32) -> Tracked {
        if self.mode == Mode::Off {
            return Tracked { command: Command::zero(), fault: None, solution: None };
        }
        if let Err(channel) = state.check() {
            return self.without(Some(Fault::State(channel)));
        }
        match (self.mode, self.lost) {
            (Mode::Fault, Lost::Cut) => return self.without(self.fault),
            (Mode::Fault, Lost::Sink(_)) => self.take_over(state, self.lost_command()),
            _ => {}
        }
        let [radius, p3, rate] = self.circle;
        let solution = self.tracker.step(state, &Reference::circle(radius, p3, rate, phase));
        // The command is limited, which may make a number of what was none. And ζ is the law's memory: once it is no number, neither is
        // any later command.
        let mut numbers = solution.nu.iter().chain(self.tracker.zeta());
        if !(solution.command.is_finite() && numbers.all(|number| number.is_finite())) {
            return self.without(Some(Fault::NotFinite));
        }
        Tracked { command: self.actuators.apply(&solution.command), fault: None, solution: Some(solution) }
    }

    /// The policy's command instead of the law's.
    fn without(&mut self, fault: Option<Fault>) -> Tracked {
        (self.mode, self.fault) = (Mode::Fault, fault);
        Tracked { command: self.lost_command(), fault, solution: None }
    }

    fn lost_command(&self) -> Command<f32> {
        match self.lost {
            Lost::Cut => Command::zero(),
            Lost::Sink(share) => {
                let thrust = share * self.vehicle().hover_thrust();
                self.actuators.apply(&Command { thrust, torque: Vector3::zeros() })
            }
        }
    }
}
