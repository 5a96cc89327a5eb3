//! The load's state from an autopilot's own sensors, in the arithmetic of a board.

use controller::Vector3;
use estimator::{
    Drag, Estimate as Found, Fix, Imu, LoadMeasurement, Motion, NavigationParams, PayloadParams, Refused, Validity,
};
use pyo3::prelude::*;

use crate::convert::{Attitude, vector};
use crate::error::{out_of_range, refused};
use crate::parameters::Parameters;
use crate::state::{State, Uav};

type Vector = [f64; 3];

fn single(v: Vector) -> Vector3<f32> {
    Vector3::from(v).map(|x| x as f32)
}

fn period(parameters: &Parameters) -> f32 {
    parameters.values.get(rig::parameter!("CTL_PERIOD")) as f32
}

fn not_used(field: &str, reason: Refused) -> PyErr {
    let why = match reason {
        Refused::NotUsable => "not a number, or outside its possible range",
        Refused::Age => "older than 150 periods (0.3 s at 500 Hz), or from the future",
        Refused::Outlier => "more than ten deviations off",
    };
    refused(format!("{field}: {why}"), field, None)
}

/// A navigation filter for those who have none: IMU, and GNSS or motion capture.
#[pyclass(module = "slung")]
pub struct Navigation(estimator::Navigation<f32>);

/// Where the load is, behind any navigation filter.
#[pyclass(module = "slung")]
pub struct PayloadFilter(estimator::Payload<f32>);

/// What the payload filter has found.
#[pyclass(frozen, module = "slung")]
pub struct Estimate {
    found: Found<f32>,
    /// The step's UAV as it goes beside the state.
    uav: Uav,
}

#[pymethods]
impl Navigation {
    #[new]
    #[pyo3(signature = (
        parameters, uav, *, deviations = [0.05, 0.1], imu = [0.0; 3], antenna = [0.0; 3], declination = 0.0
    ))]
    fn new(
        parameters: &Parameters,
        uav: &Uav,
        deviations: [f64; 2],
        imu: Vector,
        antenna: Vector,
        declination: f64,
    ) -> PyResult<Self> {
        let gravity = parameters.values.get(rig::parameter!("VEH_G")) as f32;
        let params = NavigationParams {
            gravity,
            imu: single(imu),
            antenna: single(antenna),
            declination: declination as f32,
            ..NavigationParams::every(period(parameters))
        };
        let motion = motion(uav, Vector3::new(0.0, 0.0, -gravity));
        let filter = estimator::Navigation::new(params, &motion, deviations.map(|x| x as f32));
        filter.map(Self).map_err(out_of_range)
    }

    /// A period: the newest body rate, and the mean specific force.
    #[pyo3(signature = (body_rate, specific_force))]
    fn step(&mut self, body_rate: Vector, specific_force: Vector) -> Uav {
        let imu = Imu { body_rate: single(body_rate), specific_force: single(specific_force) };
        uav(&self.0.step(Some(&imu)))
    }

    /// The specific force less its bias, which the payload filter takes.
    #[getter]
    fn specific_force<'py>(&self, py: Python<'py>) -> Bound<'py, numpy::PyArray1<f64>> {
        vector(py, &self.0.motion().specific_force.map(f64::from))
    }

    #[pyo3(signature = (position, velocity = None, *, position_accuracy = [0.0; 2], velocity_accuracy = [0.0; 2], age = 0.0))]
    fn fix(
        &mut self,
        position: Vector,
        velocity: Option<Vector>,
        position_accuracy: [f64; 2],
        velocity_accuracy: [f64; 2],
        age: f64,
    ) -> PyResult<bool> {
        let fix = Fix {
            position: Some(single(position)),
            velocity: velocity.map(single),
            position_accuracy: position_accuracy.map(|x| x as f32),
            velocity_accuracy: velocity_accuracy.map(|x| x as f32),
            age: age as f32,
        };
        let accepted = self.0.fix(&fix).map_err(|reason| not_used("fix", reason))?;
        Ok(accepted == estimator::Accepted::Reset)
    }

    #[pyo3(signature = (position, attitude, *, accuracy, attitude_accuracy, age = 0.0))]
    fn pose(
        &mut self,
        position: Vector,
        attitude: Attitude,
        accuracy: f64,
        attitude_accuracy: f64,
        age: f64,
    ) -> PyResult<bool> {
        let fix = Fix {
            position: Some(single(position)),
            velocity: None,
            position_accuracy: [accuracy as f32; 2],
            velocity_accuracy: [0.0; 2],
            age: age as f32,
        };
        let attitude = attitude.rotation().map(|x| x as f32);
        let accepted = self.0.pose(&fix, Some((&attitude, attitude_accuracy as f32)));
        Ok(accepted.map_err(|reason| not_used("pose", reason))? == estimator::Accepted::Reset)
    }

    fn height(&mut self, height: f64) -> PyResult<()> {
        self.0.height(height as f32).map_err(|reason| not_used("height", reason))
    }

    fn heading(&mut self, heading: f64) -> PyResult<()> {
        self.0.heading(heading as f32).map_err(|reason| not_used("heading", reason))
    }

    fn magnetic_field(&mut self, field: Vector) -> PyResult<()> {
        self.0.magnetic_field(&single(field)).map_err(|reason| not_used("field", reason))
    }

    #[getter]
    fn position_deviation(&self) -> f64 {
        self.0.health().position_deviation.into()
    }
    #[getter]
    fn is_blind(&self) -> bool {
        self.0.health().is_blind
    }
}

fn motion(uav: &Uav, specific_force: Vector3<f32>) -> Motion<f32> {
    let controller::Uav { position, velocity, attitude, body_rate } = uav.cast();
    Motion { position, velocity, attitude, body_rate, specific_force }
}

fn uav(motion: &Motion<f32>) -> Uav {
    let Motion { position, velocity, attitude, body_rate, .. } = *motion;
    Uav(controller::Uav { position, velocity, attitude, body_rate }.cast())
}

#[pymethods]
impl PayloadFilter {
    #[new]
    #[pyo3(signature = (
        parameters, *, hook = [0.0; 3], imu = [0.0; 3], uav_drag = [0.0; 2], payload_drag = [0.0; 2], noise = 1.0
    ))]
    fn new(
        parameters: &Parameters,
        hook: Vector,
        imu: Vector,
        uav_drag: [f64; 2],
        payload_drag: [f64; 2],
        noise: f64,
    ) -> PyResult<Self> {
        let vehicle = parameters.values.cast::<f32>().vehicle().map_err(out_of_range)?;
        let told = PayloadParams::of(vehicle.params(), period(parameters));
        let drag = |[linear, quadratic]: [f64; 2]| Drag { linear: linear as f32, quadratic: quadratic as f32 };
        let params = PayloadParams {
            hook: single(hook),
            imu: single(imu),
            uav_drag: drag(uav_drag),
            payload_drag: drag(payload_drag),
            noise: told.noise.times(noise as f32),
            ..told
        };
        estimator::Payload::new(params).map(Self).map_err(out_of_range)
    }

    /// A period: how the UAV moves, its mean specific force, and the thrust it was given.
    fn step(&mut self, uav: &Uav, specific_force: Vector, thrust: Option<f64>) -> Estimate {
        let motion = motion(uav, single(specific_force));
        let found = self.0.step(Some(&motion), thrust.map(|thrust| thrust as f32));
        Estimate { uav: Uav(found.beside(&uav.cast()).cast()), found }
    }

    #[pyo3(signature = (direction, deviation, age = 0.0))]
    fn observe_direction(&mut self, direction: Vector, deviation: f64, age: f64) -> bool {
        self.0.observe(&LoadMeasurement::Direction(single(direction), deviation as f32), age as f32)
    }
    #[pyo3(signature = (position, deviation, age = 0.0))]
    fn observe_position(&mut self, position: Vector, deviation: f64, age: f64) -> bool {
        self.0.observe(&LoadMeasurement::Position(single(position), deviation as f32), age as f32)
    }
    #[pyo3(signature = (position, uav_position, deviation, age = 0.0))]
    fn observe_pair(&mut self, position: Vector, uav_position: Vector, deviation: f64, age: f64) -> bool {
        let pair = [position, uav_position].map(single);
        self.0.observe(&LoadMeasurement::Pair(pair, deviation as f32), age as f32)
    }
    #[pyo3(signature = (velocity, deviation, age = 0.0))]
    fn observe_velocity(&mut self, velocity: Vector, deviation: f64, age: f64) -> bool {
        self.0.observe(&LoadMeasurement::Velocity(single(velocity), deviation as f32), age as f32)
    }
}

#[pymethods]
impl Estimate {
    #[getter]
    fn state(&self) -> State {
        State(self.found.state.cast())
    }
    #[getter]
    fn uav(&self) -> Uav {
        self.uav
    }
    #[getter]
    fn tension(&self) -> f64 {
        self.found.tension.into()
    }
    #[getter]
    fn is_taut(&self) -> bool {
        self.found.cable == estimator::Cable::Taut
    }
    #[getter]
    fn validity(&self) -> &'static str {
        match self.found.health.validity {
            Validity::Valid => "valid",
            Validity::Converging => "converging",
            Validity::Inconsistent => "inconsistent",
            Validity::Blind => "blind",
            Validity::Slack => "slack",
        }
    }
    #[getter]
    fn rod_deviation(&self) -> f64 {
        self.found.health.rod_deviation.into()
    }
}
