//! A scenario flown.

use hil_sim::fly::batch::Outcome;
use hil_sim::fly::flight::End;
use hil_sim::fly::run::{Arithmetic, fly};
use hil_sim::report::log::{Record, Table, Values};
use hil_sim::study::replay::{Part, ReplayError, Replayed, replay as replayed};
use numpy::PyArray1;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::PathBuf;

use crate::convert::object;
use crate::error::{invalid, unknown, whole, within};
use crate::interrupt::interruptible;
use crate::scenario::Scenario;

/// What became of a flight.
#[pyclass(frozen, module = "slung")]
pub struct Flight {
    outcome: Outcome,
    log: Table,
}

/// Flies a scenario: its controller in the loop with its world.
#[pyfunction]
#[pyo3(signature = (scenario, *, arithmetic = "f32"))]
pub fn run(py: Python<'_>, scenario: &Scenario, arithmetic: &str) -> PyResult<Flight> {
    let arithmetic = match arithmetic {
        "f32" => Arithmetic::F32,
        "f64" => Arithmetic::F64,
        other => return Err(unknown("arithmetic", other, &["f32", "f64"])),
    };
    let scenario = scenario.flown.clone();
    let flown = interruptible(py, move |control| {
        let flight = fly(&scenario, arithmetic, false, control).map_err(whole)?;
        Ok(Flight::of(Outcome { scenario, flight }))
    })?;
    match flown {
        Ok(flight) if flight.outcome.flight.end == End::Interrupted => Err(PyKeyboardInterrupt::new_err(())),
        flown => flown,
    }
}

/// Puts a flown log, CSV or ULog, through a scenario's estimator and law again.
#[pyfunction]
#[pyo3(signature = (log, scenario, *, from_s = None, to_s = None, full_thrust = None))]
pub fn replay(
    py: Python<'_>,
    log: PathBuf,
    scenario: &Scenario,
    from_s: Option<f64>,
    to_s: Option<f64>,
    full_thrust: Option<f64>,
) -> PyResult<Flight> {
    if let Some(full_thrust) = full_thrust {
        within("full_thrust", full_thrust, [1e-3, 1e6])?;
    }
    let name = log.display().to_string();
    let named = |error: std::io::Error| std::io::Error::new(error.kind(), format!("{name}: {error}"));
    let bytes = std::fs::read(log).map_err(named)?;
    let (scenario, part) = (scenario.flown.clone(), Part { from_s, to_s, full_thrust });
    let outcome = py.detach(|| replayed(scenario, &bytes, &part)).map_err(|error| match error {
        ReplayError::Scenario(error) => invalid(error),
        error => whole(error),
    })?;
    Ok(Flight::of(outcome))
}

/// A log's columns by name.
pub fn log<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyDict>> {
    let log = PyDict::new(py);
    log.set_item("t_s", PyArray1::from_slice(py, &table.t_s))?;
    for column in &table.columns {
        match &column.values {
            Values::Numbers(numbers) => log.set_item(column.name, PyArray1::from_slice(py, numbers))?,
            Values::Words { .. } => {
                let words = (0..table.t_s.len()).map(|row| column.word(row));
                log.set_item(column.name, PyList::new(py, words.collect::<Vec<_>>())?)?;
            }
        }
    }
    Ok(log)
}

impl Flight {
    fn of(outcome: Outcome) -> Self {
        let records = Record::of_flight(&outcome);
        let log = Table::new(&outcome.scenario.name, &outcome.scenario.title, &records);
        Self { outcome, log }
    }
}

#[pymethods]
impl Flight {
    /// Of a replay: how it compares with its log, and what the log lacks, in sentences; else none.
    #[getter]
    fn said(&self) -> Vec<String> {
        self.outcome.flight.replayed.as_ref().map(Replayed::sentences).unwrap_or_default()
    }

    /// What was measured, by name; what does not apply is not there.
    #[getter]
    fn results<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &self.outcome.flight.results)
    }

    /// None, or how it ended before its time.
    #[getter]
    fn failure(&self) -> Option<String> {
        self.outcome.flight.end.failure()
    }

    /// Flown time over the CPU time that it took.
    #[getter]
    fn times_real_time(&self) -> f64 {
        self.outcome.flight.times_real_time
    }

    /// Time, s, and every logged quantity by name: an array of numbers, NaN where there is none, or
    /// a list of words.
    #[getter]
    fn log<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        log(py, &self.log)
    }

    /// Unit and meaning of each of the log's quantities.
    #[getter]
    fn quantities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let quantities = PyDict::new(py);
        quantities.set_item("t_s", ("s", "Time"))?;
        for column in &self.log.columns {
            quantities.set_item(column.name, (column.unit, column.about))?;
        }
        Ok(quantities)
    }

    fn __repr__(&self) -> String {
        let how = self.failure().unwrap_or_else(|| "complete".to_owned());
        format!("Flight({:?}, {} samples, {how})", self.outcome.scenario.name, self.log.t_s.len())
    }
}
