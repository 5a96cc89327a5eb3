//! Scenarios: one flight each, from TOML files. What a file leaves out is as in the paper.
//!
//! ```toml
//! title = "…"                    # caption; figure = "3a" names the figure that it belongs to
//! duration_s = 10.0
//! substeps = 4                   # RK4 steps of the plant in one control period
//! log_period_s = 0.01            # of the CSV file; metrics see every sample
//! steady_from_s = 100.0          # steady errors are means from here to the end; left out: none
//! vehicle = { payload_mass = 0.5, uav_mass = 2.5, rod_length = 2.0, inertia = [0.03, 0.03, 0.05], gravity = 9.81 }
//! initial = { position = [0.0, 9.0, -10.0], alpha = 0.0 }   # any of the paper's coordinates, or "steady": on the path
//! # On a cable: the UAV anywhere in its reach, and with `standing` both on the ground, whatever their p3.
//! # initial = { position = [0.5, 0.0, 0.0], uav_position = [0.0, 0.0, 0.0], standing = true, psi = 0.3 }
//! request = [{ at_s = 0.0, do = "hold" }, { at_s = 20.0, do = "follow" }, { at_s = 60.0, do = "land" }]   # takes off, and ends on the ground
//! limits = { max_thrust = 50.0, tilt_deg = 40.0 }   # of `hil-sim check`, see check::Limits::read
//! obstacle = { at_s = 5.0, hold_s = 0.0 }
//! path = { kind = "circle", radius = 5.0, p3 = -10.0, speed = -5.0 }          # law = "follow"
//! reference = { kind = "circle", radius = 5.0, p3 = -10.0, rate = 1.0 }       # law = "track"
//!
//! [controller]
//! law = "follow"
//! rate_hz = 1000.0
//! look_ahead = true              # evaluate the law for the middle of the coming hold
//! poles = [[-2.0, [-1.0, 0.5]], …]   # an output each, a pair as [re, im]; or k = [[…], …], low order first
//! k_integral = [0.0, 0.0, 0.0]
//! zeta = [0.0, 0.0, 0.0, 0.0]    # ζ at the start
//! vehicle = { payload_mass = 0.25 }  # what the law is told, where it differs from what flies
//! latency_s = 0.0                # that the law knows of and looks ahead for
//! rotor_lag_s = 0.0
//! observer = { payload = 4.0, rod = 4.0, torque = 4.0 }                       # bandwidths, rad/s; 0 is off
//! limits = { thrust = [3.0, 60.0], torque = [3.0, 3.0, 3.0] }                 # on its commands, N and N·m
//! parameters = { POL_DESCENT = 0.3, ENV_ROD_LIM = 1.0 }                       # of envelope, approach, policy
//! ```
//!
//! Every key, with unit, range and default, is in `docs/scenario.md`, by
//! [`keys`](crate::describe::keys).
//!
//! `[cable]`, `[ground]`, `[environment]`, `[sensors]`, `[actuators]` and `[timing]` are described
//! in [`models`](crate::world); `seed` is that of their random numbers.
//!
//! `[estimator]`, see [`EstimatorSpec`], has the law fly on what it finds from the instruments in
//! `[sensors]`.

mod document;
mod estimator;
mod fields;
mod gains;
mod library;
mod requests;
mod steady;

pub use estimator::{EstimatorSpec, NavigationSource, RodStart};
pub use library::{CURVES, FIGURES, ROUTES, STATION, builtin, builtin_names};
pub use requests::{Asked, Requests};

use controller::{
    ActuatorLimits, Command, Gains, ObserverParams, Request, Sampling, State, TrackGains, VehicleParams,
};

use crate::describe::course::{PathSpec, ReferenceSpec, RouteSpec};
use crate::describe::input::Invalid;
use crate::study::check::{Fence, Limits};
use crate::world::{Actuators, Bodies, Cable, Environment, Ground, Sensors, Timing};
use crate::world::{Seed, World, WorldSpec};
use witness::plant::VehicleParameters;

/// One flight, validated.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// The file's name without its ending.
    pub name: String,
    /// A caption.
    pub title: String,
    /// The figure and panel this run belongs to, as in `3a`.
    pub figure: Option<String>,
    /// What flies.
    pub vehicle: VehicleParameters,
    /// What steers it.
    pub controller: ControllerSpec,
    /// The paper's 16 coordinates at the start.
    pub initial: [f64; 16],
    /// Both bodies at the start, where the cable between them may be slack.
    pub bodies: Option<Bodies>,
    /// Both stand on the ground then, rotors off.
    pub standing: bool,
    /// What is asked for, in time's order; to follow from the start if nothing is.
    pub requests: Vec<Asked>,
    /// An obstacle that stops the vehicle, if there is one.
    pub obstacle: Option<Obstacle>,
    /// What joins UAV and payload; the paper's rod if left out and there is no ground.
    pub cable: Option<Cable>,
    /// What both may stand on.
    pub ground: Option<Ground>,
    /// Forces, air, another payload.
    pub environment: Environment,
    /// What the controller sees of the state.
    pub sensors: Sensors,
    /// What becomes of its commands.
    pub actuators: Actuators,
    /// The control loop's clock.
    pub timing: Timing,
    /// What finds the state from the instruments; the law is given the sensors' channels if left
    /// out.
    pub estimator: Option<EstimatorSpec>,
    /// Of all that is random.
    pub seed: u64,
    /// The flight's number among those of the seed.
    pub run: u64,
    /// The controller takes over from a hover, without a bump, in place of starting from ζ.
    pub take_over: bool,
    /// Where a body that comes to it has crashed, without a ground to stand on, m.
    pub ground_p3: Option<f64>,
    /// What the vehicle may be asked to do on its path.
    pub limits: Limits,
    /// Where it stays, and what it keeps out of.
    pub fence: Option<Fence>,
    /// s.
    pub duration_s: f64,
    /// RK4 steps of the plant in one control period.
    pub substeps: u32,
    /// Period of the logged samples, s.
    pub log_period_s: f64,
    /// Start of the time over which steady errors are averaged, s.
    pub steady_from_s: Option<f64>,
}

/// The controller of a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct ControllerSpec {
    /// The law with its task and gains.
    pub law: Law,
    /// The vehicle that the law is told.
    pub vehicle: VehicleParams<f64>,
    /// Control rate, Hz.
    pub rate_hz: f64,
    /// Evaluate the law for the middle of the coming hold.
    pub look_ahead: bool,
    /// ζ at the start, m/s²⁺ᵏ.
    pub zeta: [f64; 4],
    /// Latency that the law knows of, s.
    pub latency_s: f64,
    /// Time constant of the rotors that the law knows of, s.
    pub rotor_lag_s: f64,
    /// Time constants of the rate loop that the law gives setpoints to, as it knows them, s; none:
    /// it commands rotors.
    pub rate_loop_s: Option<[f64; 3]>,
    /// Its disturbance observers; off as the paper has it.
    pub observer: ObserverParams<f64>,
    /// What it may command.
    pub limits: ActuatorLimits<f64>,
    /// Whether envelope and policy are those of a flight, or so wide that the law flies alone.
    pub supervised: bool,
    /// Parameters of envelope, approach and policy, by name.
    pub parameters: Vec<(String, f64)>,
}

impl ControllerSpec {
    /// When the law is called and when its command acts.
    #[must_use]
    pub fn sampling(&self) -> Sampling<f64> {
        Sampling {
            period: 1.0 / self.rate_hz,
            latency: self.latency_s,
            rotor_lag: self.rotor_lag_s,
            look_ahead: self.look_ahead,
        }
    }
}

/// Which law flies, on what, with which gains.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "there is one a flight")]
pub enum Law {
    /// Path following.
    Follow {
        /// The path.
        path: PathSpec,
        /// K and K̃.
        gains: Gains<f64>,
    },
    /// Trajectory tracking.
    Track {
        /// The reference.
        reference: ReferenceSpec,
        /// K.
        gains: TrackGains<f64>,
    },
}

impl Law {
    /// `follow` or `track`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Follow { .. } => "follow",
            Self::Track { .. } => "track",
        }
    }

    /// The route that is followed, if it is one.
    #[must_use]
    pub fn route(&self) -> Option<&RouteSpec> {
        match self {
            Self::Follow { path, .. } => path.route(),
            Self::Track { .. } => None,
        }
    }

    /// d_C, m: distance of a point of N from the curve to be flown.
    #[must_use]
    pub fn distance(&self, position: [f64; 3]) -> f64 {
        match self {
            Self::Follow { path, .. } => path.distance(position),
            Self::Track { reference, .. } => reference.distance(position),
        }
    }

    /// The curve to be flown, as points of N, m.
    #[must_use]
    pub fn outline(&self, points: usize) -> Vec<[f64; 3]> {
        match self {
            Self::Follow { path, .. } => path.outline(points),
            Self::Track { reference, .. } => reference.outline(points),
        }
    }

    /// The horizontal circle to be flown: radius (m), p3 (m), and the speed (m/s) along (−p2, p1,
    /// 0)/r.
    #[must_use]
    pub fn circle(&self) -> Option<[f64; 3]> {
        match self {
            Self::Follow { path, .. } => path.circle(),
            // (sin, cos) turns from n2 to n1.
            Self::Track { reference: ReferenceSpec { radius, p3, rate }, .. } => Some([*radius, *p3, -rate * radius]),
        }
    }
}

/// The obstacle of Fig. 2: it sets v, α, β, φ, θ and all rates to zero, keeping p and ψ, and holds
/// the vehicle there with the law suspended; then the law starts again from ζ = 0. A reference's
/// clock runs on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Obstacle {
    /// When it is met, s.
    pub at_s: f64,
    /// How long it holds, s.
    pub hold_s: f64,
}

/// A scenario that cannot be flown as it is written.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{file}:{line}: {message}")]
pub struct ScenarioError {
    /// The file.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// The field and what is wrong with it.
    pub message: String,
}

impl Scenario {
    /// Reads a scenario from the text of `file`; its name is the file's without folder and ending.
    ///
    /// # Errors
    /// [`ScenarioError`] with line and field for anything unknown, missing, or out of range.
    pub fn parse(file: &str, text: &str) -> Result<Self, ScenarioError> {
        let error = |line, message| ScenarioError { file: file.to_owned(), line, message };
        let document = document::Document::parse(text).map_err(|(line, message)| error(line, message))?;
        let name = std::path::Path::new(file).file_stem().unwrap_or_default().to_string_lossy();
        let table: toml::Table = toml::from_str(text).map_err(|wrong| error(1, wrong.message().to_owned()))?;
        fields::scenario(&name, table).map_err(|invalid| error(document.line_of(&invalid.field), invalid.to_string()))
    }

    /// A scenario from its parsed keys.
    ///
    /// # Errors
    /// [`Invalid`] names the field that is unknown, missing or out of range.
    pub fn from_table(name: &str, table: toml::Table) -> Result<Self, Invalid> {
        fields::scenario(name, table)
    }

    /// All but the controller.
    #[must_use]
    pub fn world(&self) -> WorldSpec {
        WorldSpec {
            vehicle: self.vehicle,
            cable: self.cable,
            ground: self.ground,
            environment: self.environment,
            sensors: self.sensors,
            actuators: self.actuators,
            timing: self.timing,
            period: 1.0 / self.controller.rate_hz,
            substeps: self.substeps,
        }
    }

    /// The world at the flight's start, with `command` acting for long: in `start`, but where the
    /// scenario itself says where both bodies are.
    #[must_use]
    pub fn begin(&self, start: &State<f64>, command: Command<f64>, seed: Seed) -> World {
        match &self.bodies {
            Some(bodies) => World::apart(&self.world(), bodies, command, seed),
            None => World::new(&self.world(), start, command, seed),
        }
    }

    /// Whether the flight does what it is asked for, step by step, instead of following all the
    /// time.
    #[must_use]
    pub fn is_mission(&self) -> bool {
        !self.requests.is_empty()
    }

    /// Whether it is to end on the ground.
    #[must_use]
    pub fn lands(&self) -> bool {
        match self.requests.iter().rev().find_map(|asked| asked.request) {
            None | Some(Request::Follow) => self.controller.law.route().is_some_and(RouteSpec::lands),
            last => last == Some(Request::Land),
        }
    }

    /// Control periods in the flight.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.periods(self.duration_s)
    }

    /// Control periods in so many seconds.
    #[must_use]
    pub fn periods(&self, seconds: f64) -> u64 {
        // Rounded: times are whole numbers of periods, up to the rounding of the product.
        (seconds * self.controller.rate_hz).round() as u64
    }

    /// Control periods from one logged sample to the next.
    #[must_use]
    pub fn log_every(&self) -> u64 {
        self.periods(self.log_period_s).max(1)
    }
}
