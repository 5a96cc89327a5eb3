//! Paths, described as in scenario files.

use hil_sim::describe::course::{PathSpec, parse_path};
use hil_sim::study::check::Limits;
use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use toml::Table;

use crate::convert::{object, rows, table};
use crate::error::{invalid, out_of_range, whole};
use crate::parameters::Parameters;

/// A path: a curve with a speed and a yaw along it. Its keys are those of a scenario's `[path]`.
#[pyclass(frozen, module = "slung")]
pub struct Path {
    pub keys: Table,
    pub spec: PathSpec,
}

#[pymethods]
impl Path {
    #[new]
    #[pyo3(signature = (**keys))]
    fn new(keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let keys = keys.map_or_else(|| Ok(Table::new()), |keys| table(keys))?;
        let spec = parse_path("", keys.clone()).map_err(invalid)?;
        Ok(Self { keys, spec })
    }

    #[getter]
    fn keys<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &self.keys)
    }

    /// d_C of a point of N, m.
    fn distance(&self, py: Python<'_>, position: [f64; 3]) -> f64 {
        py.detach(|| self.spec.distance(position))
    }

    #[pyo3(signature = (points = 256))]
    fn outline<'py>(&self, py: Python<'py>, points: usize) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, &py.detach(|| self.spec.outline(points)))
    }

    #[pyo3(signature = (parameters = None))]
    fn check(&self, py: Python<'_>, parameters: Option<&Parameters>) -> PyResult<String> {
        let default = Parameters::default();
        let vehicle = parameters.unwrap_or(&default).values.vehicle().map_err(out_of_range)?;
        let report = py.detach(|| self.spec.check(&vehicle, &Limits::of(&vehicle)));
        report.map(|report| report.to_string()).map_err(whole)
    }

    fn __repr__(&self) -> String {
        format!("Path({})", self.keys)
    }
}
