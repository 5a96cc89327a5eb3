//! The simulator's world, stepped from Python.

use controller::{Command, Vector3};
use hil_sim::world::{Bodies, InstrumentModel, Order, Seed};
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::convert::{matrix, vector};
use crate::error::within;
use crate::scenario::Scenario;
use crate::state::{State, Uav};

/// Everything outside the controller: the vehicle in its environment, behind its actuators, seen
/// through its sensors.
#[pyclass(module = "slung")]
pub struct World {
    world: hil_sim::world::World,
    instruments: InstrumentModel,
    has_rate_loop: bool,
}

#[pymethods]
impl World {
    #[new]
    #[pyo3(signature = (scenario, *, seed = None, run = 0, thrust = None))]
    fn new(scenario: &Scenario, seed: Option<u64>, run: u64, thrust: Option<f64>) -> Self {
        let scenario = &scenario.flown;
        let seed = Seed { batch: seed.unwrap_or(scenario.seed), run };
        let start = controller::State::from_paper(&scenario.initial);
        let hover = scenario.vehicle.total_mass() * scenario.vehicle.gravity;
        let command = Command { thrust: thrust.unwrap_or(hover), torque: Vector3::zeros() };
        let instruments = InstrumentModel::new(&scenario.sensors, 1.0 / scenario.controller.rate_hz, seed);
        let has_rate_loop = scenario.actuators.rate_loop.is_some();
        Self { world: scenario.begin(&start, command, seed), instruments, has_rate_loop }
    }

    #[pyo3(signature = (thrust, torque = [0.0; 3], periods = 1))]
    fn advance(&mut self, py: Python<'_>, thrust: f64, torque: [f64; 3], periods: u32) -> PyResult<()> {
        within("thrust", thrust, [-1e6, 1e6])?;
        torque.iter().try_for_each(|&torque| within("torque", torque, [-1e6, 1e6]))?;
        let command = Command { thrust, torque: torque.into() };
        py.detach(|| (0..periods).for_each(|_| self.world.advance(&command)));
        Ok(())
    }

    #[pyo3(signature = (thrust, body_rate, periods = 1))]
    fn advance_at_rates(&mut self, py: Python<'_>, thrust: f64, body_rate: [f64; 3], periods: u32) -> PyResult<()> {
        if !self.has_rate_loop {
            return Err(PyValueError::new_err("the scenario has no actuators.rate_loop to take body rates"));
        }
        within("thrust", thrust, [-1e6, 1e6])?;
        body_rate.iter().try_for_each(|&rate| within("body_rate", rate, [-1e4, 1e4]))?;
        let order = Order::Rates { thrust, body_rate: body_rate.into() };
        py.detach(|| (0..periods).for_each(|_| self.world.obey(order)));
        Ok(())
    }

    #[getter]
    fn time_s(&self) -> f64 {
        self.world.time_s()
    }
    #[getter]
    fn state(&self) -> State {
        State(self.world.body().state())
    }
    #[getter]
    fn uav(&self) -> Uav {
        let Bodies { uav_position, uav_velocity, attitude, body_rate, .. } = self.world.body().bodies();
        Uav(controller::Uav { position: uav_position, velocity: uav_velocity, attitude, body_rate })
    }
    /// The state through the sensors. Once a period.
    fn read(&mut self) -> State {
        State(self.world.read(&self.world.body().state()).state)
    }
    #[getter]
    fn pull(&self) -> f64 {
        self.world.rates().pull
    }
    #[getter]
    fn on_ground(&self) -> (bool, bool) {
        let [payload, uav] = self.world.body().touching();
        (payload, uav)
    }
    #[getter]
    fn energy(&self) -> f64 {
        self.world.body().energy()
    }

    /// What the instruments give at the end of this period, as [`crate::estimator`] takes it. Once
    /// a period.
    fn instruments<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let readings = self.instruments.read(&self.world);
        let told = PyDict::new(py);
        told.set_item("body_rate", vector(py, &readings.imu.body_rate))?;
        told.set_item("specific_force", vector(py, &readings.imu.specific_force))?;
        if let Some(fix) = &readings.fix {
            let given = PyDict::new(py);
            given.set_item("position", vector(py, &fix.position))?;
            given.set_item("velocity", vector(py, &fix.velocity))?;
            given.set_item("position_accuracy", PyArray1::from_slice(py, &fix.position_accuracy))?;
            given.set_item("velocity_accuracy", PyArray1::from_slice(py, &fix.velocity_accuracy))?;
            given.set_item("age", fix.age)?;
            told.set_item("fix", given)?;
        }
        if let Some(pose) = &readings.pose {
            let given = PyDict::new(py);
            given.set_item("position", vector(py, &pose.position))?;
            given.set_item("attitude", matrix(py, &pose.attitude)?)?;
            given.set_item("age", pose.age)?;
            told.set_item("pose", given)?;
            if let Some(load) = &pose.load {
                told.set_item("load", vector(py, load))?;
            }
        }
        if let Some(height) = readings.height {
            told.set_item("height", height)?;
        }
        if let Some(field) = &readings.field {
            told.set_item("field", vector(py, field))?;
        }
        if let Some(thrust) = readings.thrust {
            told.set_item("thrust", thrust)?;
        }
        Ok(told)
    }
}
