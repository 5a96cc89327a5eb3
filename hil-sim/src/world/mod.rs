//! Everything outside the controller: the slung load in its environment, behind its actuators, seen
//! through its sensors.
//!
//! A flight calls [`World::read`] and [`World::advance`] in turn, once a control period. What
//! happens is a function of the [`WorldSpec`], the start and the seed alone.
//!
//! What a flight meets beside the slung-load system itself: environment, sensors, actuators.
//! Everything is off unless a scenario switches it on.
//!
//! ```toml
//! [environment]
//! payload_force = [0.3, 0.0, 0.0]   # N, in N; uav_force likewise; torque in body axes, N·m
//! payload_step = { at_s = 20.0, mass = 1.5 }
//!
//! [environment.air]
//! wind = [5.0, 0.0, 0.0]            # m/s, where the air goes
//! gusts = { speed_at_6m = 5.0, height = 10.0 }
//! density = 1.225                   # kg/m³
//! payload_drag_area = 0.01          # Cd A, m²
//! uav_drag_area = 0.05
//!
//! [sensors.position]                # velocity, rod, rod_rate, attitude, body_rate likewise
//! noise = 0.02                      # standard deviation per sample and axis
//! bias = [0.0, 0.0, 0.0]
//! quantum = 0.001
//! jitter_s = 0.001
//! freeze = { at_s = 10.0, for_s = 0.5 }      # drop_out, nan likewise
//!
//! [actuators]
//! lag_s = 0.05
//! latency_s = 0.01
//! thrust_scale = 0.85
//! rotors = { layout = "quad-x", arm_m = 0.3, drag_m = 0.02, max_thrust = 15.0, failure = { rotor = 1, at_s = 9.0, effectiveness = 0.0 } }
//! rate_loop = { rate_hz = 1000.0, time_constant_s = [0.03, 0.03, 0.03] }
//! sag = { max_thrust = 30.9, during = { at_s = 15.0, for_s = 2.0 } }
//!
//! [cable]                           # in place of the rod: pulls only
//! hook = [0.0, 0.0, 0.2]            # where it hangs, in body axes
//! ea = 5e3                          # N: k = EA/L; left out: it does not stretch
//! damping = 2.0                     # N·s/m; of one that does not stretch, restitution = 0.0 instead
//! hooked = { at_s = 3.0, for_s = 60.0 }      # picked up and dropped; snagged likewise: caught where it is
//!
//! [ground]                          # payload and UAV can stand on it; the cable, if none is given, is one that does not stretch
//! p3 = 0.0
//! sink = 0.002                      # by a body's own weight, m
//! damping_ratio = 0.5
//! friction = 0.5
//! payload_height = 0.05             # from its centre to its foot, m
//! feet_below = 0.15                 # of the UAV, m; feet_apart from the middle
//!
//! [timing]
//! jitter = 0.1                      # each control period within ±10 %
//! missed = 0.01                     # probability that no state comes in a period
//! state_every = 5                   # periods from one state to the next
//! ```

mod actuators;
mod body;
mod cable;
mod dryden;
mod environment;
mod ground;
pub mod integrate;
pub mod multibody;
pub mod random;
mod rate_loop;
mod rotors;
pub mod sensors;
mod tethered;
mod timing;

pub use actuators::{ActuatorModel, Actuators, Order, Sag};
pub use body::{Bodies, Body, Rates};
pub use cable::Cable;
pub use dryden::{Dryden, Gusts};
pub use environment::{Air, Environment, PayloadStep, drag};
pub use ground::Ground;
pub use rate_loop::RateLoop;
pub use rotors::{Layout, RotorFailure, Rotors};
pub use sensors::instruments::{InstrumentModel, Readings};
pub use sensors::{Aboard, Channel, Reading, SensorModel, Sensors, Window};
pub use tethered::Tethered;
pub use timing::Timing;

use controller::{Command, State};

use crate::describe::input::{Invalid, within};
use crate::world::environment::Outside;
use crate::world::random::{Purpose, Stream};
use witness::plant::VehicleParameters;

/// `value` in a range, with the field for an error.
fn check(at: &str, field: &str, value: f64, low: f64, high: f64) -> Result<(), Invalid> {
    within(&crate::describe::input::join(at, field), value, low..=high).map(|_| ())
}

/// What flies, where, and behind what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldSpec {
    /// The vehicle.
    pub vehicle: VehicleParameters,
    /// What joins UAV and payload; a massless rigid rod if left out and there is no ground.
    pub cable: Option<Cable>,
    /// What both may stand on.
    pub ground: Option<Ground>,
    /// Forces, air, another payload.
    pub environment: Environment,
    /// The sensors.
    pub sensors: Sensors,
    /// Latency, lag, limits.
    pub actuators: Actuators,
    /// The control loop's clock.
    pub timing: Timing,
    /// Control period, s.
    pub period: f64,
    /// Runge-Kutta steps in a control period.
    pub substeps: u32,
}

/// The seed of one flight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seed {
    /// Of the batch.
    pub batch: u64,
    /// The flight's number in it.
    pub run: u64,
}

impl Seed {
    /// The stream for a purpose.
    #[must_use]
    pub fn stream(self, purpose: Purpose) -> Stream {
        Stream::new(self.batch, self.run, purpose)
    }
}

/// The world at work.
#[derive(Clone, Debug)]
pub struct World {
    spec: WorldSpec,
    body: Body,
    actuators: ActuatorModel,
    sensors: SensorModel,
    /// What they made of the body last.
    reading: Reading,
    gusts: Option<Dryden>,
    outside: Outside,
    clock: Stream,
    /// Periods since the first with a state.
    since_first: u32,
    t_s: f64,
}

impl World {
    /// At time 0 in `state`, with `command` acting for long.
    #[must_use]
    pub fn new(spec: &WorldSpec, state: &State<f64>, command: Command<f64>, seed: Seed) -> Self {
        Self::with(spec, Body::new(spec.vehicle, spec.cable, spec.ground, state), command, seed)
    }

    /// At time 0 with the payload anywhere, on a cable, and with `command` acting for long.
    #[must_use]
    pub fn apart(spec: &WorldSpec, bodies: &Bodies, command: Command<f64>, seed: Seed) -> Self {
        Self::with(spec, Body::apart(spec.vehicle, spec.cable, spec.ground, bodies), command, seed)
    }

    fn with(spec: &WorldSpec, body: Body, command: Command<f64>, seed: Seed) -> Self {
        let outside = Outside::new(&spec.environment);
        let gusts = spec.environment.air.and_then(|air| air.gusts);
        Self {
            actuators: ActuatorModel::new(spec.actuators, command),
            sensors: SensorModel::new(spec.sensors, spec.period, &body.state(), seed.stream(Purpose::Sensor)),
            reading: body.state().into(),
            gusts: gusts.map(|gusts| Dryden::new(&gusts, &outside.wind, spec.period, seed.stream(Purpose::Gust))),
            outside,
            body,
            clock: seed.stream(Purpose::Timing),
            since_first: 0,
            spec: *spec,
            t_s: 0.0,
        }
    }

    /// Time, s.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.t_s
    }

    /// The vehicle as it moves.
    #[must_use]
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// Thrust that the rotors' speeds stand for, N: what they really give is that times the thrust
    /// scale.
    #[must_use]
    pub fn rotor_thrust(&self) -> f64 {
        self.actuators.given().thrust
    }

    /// What the sensors make of the body, in `state` now. Once a period.
    #[inline]
    pub fn read(&mut self, state: &State<f64>) -> &mut Reading {
        self.sensors.read(self.t_s, state, &mut self.reading.state);
        let Sensors { uav, accelerometer, .. } = self.spec.sensors;
        // On a rod, the state says it all.
        let apart = matches!(self.body, Body::Cable(_));
        // What is given once is given at every sample.
        if uav.unwrap_or(apart) {
            let Bodies { uav_position, uav_velocity, .. } = self.body.bodies();
            let own = [&uav_position, &uav_velocity];
            self.reading.uav = Some(self.sensors.read_uav(self.t_s, own, &self.reading.state));
        }
        if accelerometer.unwrap_or(apart) {
            let mut acceleration = self.rates().uav;
            acceleration.z -= self.body.vehicle().gravity;
            let force = self.body.bodies().attitude.tr_mul(&acceleration);
            self.reading.specific_force = Some(self.sensors.read_force(self.t_s, &force));
        }
        (self.reading.comes, self.reading.sees_load) = (true, true);
        &mut self.reading
    }

    /// Whether no state comes to the controller in this period. Once a period, after the first.
    pub fn misses(&mut self) -> bool {
        self.since_first = self.since_first.wrapping_add(1);
        self.spec.timing.misses(self.since_first, &mut self.clock)
    }

    /// Stops the vehicle as the paper's obstacle does: level, rod straight down, all velocities
    /// zero; position and yaw stay.
    pub fn stop(&mut self, yaw: f64) {
        let (sin, cos) = (libm::sin(yaw), libm::cos(yaw));
        let mut state = State::at_rest(self.body.state().position);
        state.attitude = controller::Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
        self.body = Body::new(*self.body.vehicle(), self.spec.cable, self.spec.ground, &state);
    }

    /// Passes one control period in which the vehicle is held where it is.
    pub fn wait(&mut self) {
        self.t_s += self.spec.period;
    }

    /// Passes one control period under `command`, given to the rotors at its start.
    #[inline]
    pub fn advance(&mut self, command: &Command<f64>) {
        self.obey(Order::Wrench(*command));
    }

    /// Passes one control period under `order`, given at its start. A vehicle without a rate loop
    /// takes no body rates: what it was told before goes on.
    #[inline]
    pub fn obey(&mut self, order: Order) {
        self.step_payload();
        self.body.set_time(self.t_s);
        if let Some(gusts) = &mut self.gusts {
            self.outside.air = self.outside.wind + gusts.step();
        }
        self.actuators.push(self.t_s, order);
        let end_s = self.t_s + self.spec.period * self.spec.timing.stretch(&mut self.clock);
        // A piece shorter than the clock's rounding ends the period.
        while end_s - self.t_s > 1e-12 {
            let piece = self.actuators.piece(self.t_s, end_s, &self.body);
            self.fly(piece);
            self.t_s += piece;
        }
        self.t_s = end_s;
    }

    /// Flies a piece of time in which the rotors are told one thing.
    #[inline]
    fn fly(&mut self, piece: f64) {
        let share = piece / self.spec.period * f64::from(self.spec.substeps);
        let resolved = piece / self.body.largest_step();
        let least = share.max(resolved) - 1e-6;
        let steps = if least > 1.0 { libm::ceil(least) as u32 } else { 1 };
        let step = piece / f64::from(steps);
        self.actuators.prepare(step);
        let Self { actuators, body, outside, t_s, .. } = self;
        for index in 0..steps {
            let start = step * f64::from(index);
            body.advance(step, |t| actuators.at(*t_s, start + t), |payload, uav| outside.loads(payload, uav));
        }
        actuators.pass(piece);
    }

    /// Accelerations and the cable's pull now, under what the rotors give.
    #[must_use]
    pub fn rates(&self) -> Rates {
        let bodies = self.body.bodies();
        let loads = self.outside.loads(&bodies.velocity, &bodies.uav_velocity);
        self.body.rates(&self.actuators.at(self.t_s, 0.0), &loads)
    }

    #[inline]
    fn step_payload(&mut self) {
        if let Some(step) = self.spec.environment.payload_step
            && self.t_s >= step.at_s - 0.5 * self.spec.period
            && self.body.vehicle().payload_mass != step.mass
        {
            self.body.set_payload_mass(step.mass);
            if let (Some(area), Some(air)) = (step.drag_area, self.spec.environment.air) {
                self.outside.drag[0] = 0.5 * air.density * area;
            }
        }
    }
}
