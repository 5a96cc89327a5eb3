//! States: what a law is stepped on, and the UAV by itself.

use controller::{Real, Vector3};
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::convert::{Attitude, frames, matrix, vector};
use crate::error::refused;

const LEVEL: Attitude = Attitude::Rows([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);

/// Payload, rod and UAV.
#[pyclass(frozen, module = "slung")]
#[derive(Clone, Copy)]
pub struct State(pub controller::State<f64>);

#[pymethods]
impl State {
    #[new]
    #[pyo3(signature = (
        position, velocity = [0.0; 3], rod = [0.0, 0.0, 1.0], rod_rate = [0.0; 3], attitude = LEVEL, body_rate = [0.0; 3]
    ))]
    fn new(
        position: [f64; 3],
        velocity: [f64; 3],
        rod: [f64; 3],
        rod_rate: [f64; 3],
        attitude: Attitude,
        body_rate: [f64; 3],
    ) -> Self {
        Self(controller::State {
            position: position.into(),
            velocity: velocity.into(),
            rod: rod.into(),
            rod_rate: rod_rate.into(),
            attitude: attitude.rotation(),
            body_rate: body_rate.into(),
        })
    }

    #[staticmethod]
    fn from_paper(x: [f64; 16]) -> Self {
        Self(controller::State::from_paper(&x))
    }

    #[expect(clippy::wrong_self_convention, reason = "Python's objects are borrowed")]
    fn to_paper<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.0.to_paper())
    }

    fn check(&self) -> PyResult<()> {
        self.0.check().map_err(|channel| {
            let field = format!("{channel:?}").to_lowercase();
            refused(format!("{field} is not a number, or outside any range"), &field, None)
        })
    }

    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.0.position)
    }
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.0.velocity)
    }
    #[getter]
    fn rod<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.0.rod)
    }
    #[getter]
    fn rod_rate<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.0.rod_rate)
    }
    #[getter]
    fn attitude<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, &self.0.attitude)
    }
    #[getter]
    fn body_rate<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.0.body_rate)
    }

    fn __repr__(&self) -> String {
        let array = |v: &Vector3<f64>| format!("{:?}", <[f64; 3]>::from(*v));
        let controller::State { position, velocity, rod, .. } = &self.0;
        format!("State(position={}, velocity={}, rod={}, …)", array(position), array(velocity), array(rod))
    }
}

/// The UAV as its own navigation has it.
#[pyclass(frozen, module = "slung")]
#[derive(Clone, Copy)]
pub struct Uav(pub controller::Uav<f64>);

impl Uav {
    /// In another scalar.
    pub fn cast<T: Real>(&self) -> controller::Uav<T> {
        self.0.cast()
    }
}

#[pymethods]
impl Uav {
    #[new]
    #[pyo3(signature = (position, velocity = [0.0; 3], attitude = LEVEL, body_rate = [0.0; 3], frames = "ned"))]
    fn new(
        position: [f64; 3],
        velocity: [f64; 3],
        attitude: Attitude,
        body_rate: [f64; 3],
        frames: &str,
    ) -> PyResult<Self> {
        let frames = self::frames(frames)?;
        Ok(Self(controller::Uav {
            position: frames.inertial(&position.into()),
            velocity: frames.inertial(&velocity.into()),
            attitude: frames.attitude(&attitude.rotation()),
            body_rate: frames.body(&body_rate.into()),
        }))
    }

    #[pyo3(signature = (position, velocity, frames = "ned"))]
    fn with_load(&self, position: [f64; 3], velocity: [f64; 3], frames: &str) -> PyResult<State> {
        let frames = self::frames(frames)?;
        Ok(State(self.0.with_load(frames.inertial(&position.into()), frames.inertial(&velocity.into()))))
    }

    #[pyo3(signature = (length, direction, rate = [0.0; 3], hook = [0.0; 3], frames = "ned"))]
    fn with_cable(
        &self,
        length: f64,
        direction: [f64; 3],
        rate: [f64; 3],
        hook: [f64; 3],
        frames: &str,
    ) -> PyResult<State> {
        let frames = self::frames(frames)?;
        let [direction, rate] = [direction, rate].map(|v| frames.inertial(&v.into()));
        Ok(State(self.0.with_cable(frames.body(&hook.into()), length, direction, rate)))
    }

    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.0.position)
    }
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.0.velocity)
    }
    #[getter]
    fn attitude<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, &self.0.attitude)
    }
    #[getter]
    fn body_rate<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.0.body_rate)
    }
}
