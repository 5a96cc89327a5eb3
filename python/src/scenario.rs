//! Scenarios, as files or as mappings with the same keys.

use hil_sim::describe::scenario::{self as described, CURVES, FIGURES, ROUTES};
use pyo3::exceptions::{PyFileNotFoundError, PyOSError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use std::io::ErrorKind;
use std::path::PathBuf;
use toml::{Table, Value};

use crate::convert::{object, table};
use crate::error::{invalid, whole};

/// Name and text of each scenario that comes with the simulator.
fn built_in() -> impl Iterator<Item = &'static (&'static str, &'static str)> {
    [FIGURES, CURVES, ROUTES].into_iter().flatten()
}

/// A flight, described.
#[pyclass(frozen, module = "slung")]
pub struct Scenario {
    keys: Table,
    pub flown: described::Scenario,
}

impl Scenario {
    fn of(name: &str, keys: Table) -> PyResult<Self> {
        let flown = described::Scenario::from_table(name, keys.clone()).map_err(invalid)?;
        Ok(Self { keys, flown })
    }

    fn parse(file: &str, text: &str) -> PyResult<Self> {
        let flown = described::Scenario::parse(file, text).map_err(whole)?;
        Ok(Self { keys: toml::from_str(text).map_err(whole)?, flown })
    }
}

/// `keys` with those of `others` in their place, table by table.
fn over(keys: &mut Table, others: Table) {
    for (key, value) in others {
        match (keys.get_mut(&key), value) {
            // A path is one thing: another kind has other keys.
            (Some(Value::Table(keys)), Value::Table(others)) if !others.contains_key("kind") => over(keys, others),
            (_, value) => {
                keys.insert(key, value);
            }
        }
    }
}

#[pymethods]
impl Scenario {
    #[new]
    #[pyo3(signature = (source = None, /, **keys))]
    fn new(source: Option<&Bound<'_, PyAny>>, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let scenario = match source {
            None => Self::of("scenario", Table::new())?,
            Some(mapping) if mapping.cast::<PyMapping>().is_ok() => Self::of("scenario", table(mapping)?)?,
            Some(file) => {
                let file: PathBuf = file.extract()?;
                match std::fs::read_to_string(&file) {
                    Ok(text) => Self::parse(&file.to_string_lossy(), &text)?,
                    Err(error) => {
                        let found = built_in().find(|(name, _)| file.as_os_str() == *name);
                        let (name, text) = found.ok_or_else(|| {
                            let name = file.display();
                            if error.kind() != ErrorKind::NotFound {
                                return PyOSError::new_err(format!("{name}: {error}"));
                            }
                            let known = built_in().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
                            let absent = "there is no such file, and the built-in scenarios are";
                            PyFileNotFoundError::new_err(format!("{name}: {absent} {known}"))
                        })?;
                        Self::parse(&format!("{name}.toml"), text)?
                    }
                }
            }
        };
        match keys {
            Some(keys) => scenario.replace(Some(keys)),
            None => Ok(scenario),
        }
    }

    #[pyo3(signature = (**keys))]
    fn replace(&self, keys: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut all = self.keys.clone();
        if let Some(keys) = keys {
            over(&mut all, table(keys)?);
        }
        Self::of(&self.flown.name, all)
    }

    #[staticmethod]
    fn names() -> Vec<&'static str> {
        built_in().map(|(name, _)| *name).collect()
    }

    #[getter]
    fn keys<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        object(py, &self.keys)
    }
    #[getter]
    fn name(&self) -> &str {
        &self.flown.name
    }
    #[getter]
    fn title(&self) -> &str {
        &self.flown.title
    }
    #[getter]
    fn duration_s(&self) -> f64 {
        self.flown.duration_s
    }
    #[getter]
    fn period_s(&self) -> f64 {
        1.0 / self.flown.controller.rate_hz
    }

    /// d_C of a point of N, m.
    fn distance(&self, py: Python<'_>, position: [f64; 3]) -> f64 {
        py.detach(|| self.flown.controller.law.distance(position))
    }

    fn __repr__(&self) -> String {
        format!("Scenario({:?}: {})", self.flown.name, self.flown.title)
    }
}
