//! The tracking law and the least guard that it can fly with: a good state and a finite answer, or
//! the policy's command without either.

use controller::{
    Actuation, Command, Fault, Lost, Mode, Real, Reference, Refused, Solution, State, TrackXi, Tracker, Vehicle,
};

use crate::actuators::Actuators;
use crate::parameters::Parameters;
use crate::{flight, gains, observer, parameter, timing, vehicle};

/// A step of the tracking law, guarded.
pub struct Tracked<T> {
    pub command: Command<T>,
    pub fault: Option<Fault>,
}

/// Trajectory tracking of a circle.
#[derive(Clone, Debug)]
pub struct Tracking<T: Real> {
    tracker: Tracker<T>,
    /// Radius (m), p3 (m) and rate (rad/s) of the reference.
    circle: [T; 3],
    actuators: Actuators<T>,
    lost: Lost<T>,
    /// Off, follow or fault.
    mode: Mode,
    solution: Option<Solution<T, TrackXi<T>>>,
    /// Why the fault.
    fault: Option<Fault>,
}

impl<T: Real> Tracking<T> {
    /// The law of `parameters`, not started.
    pub fn new(parameters: &Parameters<T>) -> Result<Self, crate::error::SetupError<T>> {
        let actuators = Actuators::new(parameters)?;
        let vehicle = vehicle::vehicle(parameters)?;
        let tracker = Tracker::new(vehicle, gains::track_gains(parameters), timing::sampling(parameters))?
            .with_limits(actuators.limits())?
            .with_observer(observer::observer(parameters))?;
        let circle = [parameter!("PATH_RADIUS"), parameter!("PATH_P3"), parameter!("REF_RATE")];
        Ok(Self {
            tracker,
            circle: circle.map(|parameter| parameters.get(parameter)),
            actuators,
            lost: flight::policy(parameters).lost,
            mode: Mode::Off,
            solution: None,
            fault: None,
        })
    }

    pub fn tracker(&self) -> &Tracker<T> {
        &self.tracker
    }

    pub fn vehicle(&self) -> &Vehicle<T> {
        self.tracker.vehicle()
    }

    pub fn actuators(&self) -> &Actuators<T> {
        &self.actuators
    }

    pub fn solution(&self) -> Option<&Solution<T, TrackXi<T>>> {
        self.solution.as_ref()
    }

    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// Starts from a stated ζ.
    pub fn start(&mut self, state: &State<T>, zeta: [T; 4]) -> Result<(), Refused> {
        self.tracker.start(state, zeta)?;
        (self.mode, self.fault) = (Mode::Follow, None);
        Ok(())
    }

    /// Goes on from `applied` without a bump in thrust.
    pub fn take_over(&mut self, state: &State<T>, applied: Command<T>) -> Result<(), Refused> {
        self.tracker.take_over(state, applied)?;
        (self.mode, self.fault) = (Mode::Follow, None);
        Ok(())
    }

    /// The command for the coming hold; `phase` (rad) is where the reference is now.
    pub fn step(&mut self, state: Option<&State<T>>, phase: T) -> Tracked<T> {
        self.solution = None;
        if self.mode == Mode::Off {
            return Tracked { command: Command::zero(), fault: None };
        }
        let Some(state) = state else { return self.without(Some(Fault::NoState)) };
        if let Err(channel) = state.check() {
            return self.without(Some(Fault::State(channel)));
        }
        let is_taken_over = match (self.mode, self.lost) {
            (Mode::Fault, Lost::Cut) => return self.without(self.fault),
            (Mode::Fault, Lost::Sink(_)) => self.take_over(state, self.lost_command()),
            _ => Ok(()),
        };
        if is_taken_over.is_err() {
            return self.without(self.fault);
        }
        let [radius, p3, rate] = self.circle;
        let solution = self.tracker.track(state, &Reference::circle(radius, p3, rate, phase));
        // Limiting can turn a NaN into a finite command, so the law's own numbers are tested; and
        // once ζ is not finite, no later command is.
        let mut numbers = solution.nu.iter().chain(self.tracker.zeta());
        if !(solution.command.is_finite() && numbers.all(|number| number.is_finite())) {
            return self.without(Some(Fault::NotFinite));
        }
        self.solution = Some(solution);
        Tracked { command: self.actuators.apply(&solution.command), fault: None }
    }

    /// The policy's command instead of the law's.
    fn without(&mut self, fault: Option<Fault>) -> Tracked<T> {
        (self.mode, self.fault) = (Mode::Fault, fault);
        Tracked { command: self.lost_command(), fault }
    }

    fn lost_command(&self) -> Command<T> {
        match self.lost {
            Lost::Cut => Command::zero(),
            Lost::Sink(share) => {
                let thrust = share * self.vehicle().hover_thrust();
                self.actuators.apply(&Command::of_thrust(thrust))
            }
        }
    }
}
