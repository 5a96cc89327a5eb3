//! The named numbers that a controller is made of.

use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rig::{COUNT, Parameter, Refused};

use crate::error::refused;

/// All parameters, by name.
#[pyclass(module = "slung")]
#[derive(Clone, Default)]
pub struct Parameters {
    pub values: rig::Parameters<f64>,
}

/// What a parameter is.
#[pyclass(frozen, get_all, module = "slung")]
pub struct Entry {
    name: String,
    unit: String,
    default: f64,
    min: f64,
    max: f64,
    text: String,
}

fn named(name: &str) -> PyResult<Parameter> {
    Parameter::find(name).ok_or_else(|| PyKeyError::new_err(format!("no parameter \"{name}\"")))
}

#[pymethods]
impl Parameters {
    #[new]
    #[pyo3(signature = (**values))]
    fn new(values: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut parameters = Self::default();
        for (name, value) in values.into_iter().flatten() {
            parameters.__setitem__(&name.extract::<String>()?, value.extract()?)?;
        }
        Ok(parameters)
    }

    fn __getitem__(&self, name: &str) -> PyResult<f64> {
        Ok(self.values.get(named(name)?))
    }

    fn __setitem__(&mut self, name: &str, value: f64) -> PyResult<()> {
        self.values.set(named(name)?, value).map_err(|error| match error {
            Refused::Unknown => PyKeyError::new_err(name.to_owned()),
            Refused::OutOfRange(entry, value) | Refused::NotWhole(entry, value) => {
                refused(error, entry.name.as_str(), Some([value, entry.min, entry.max]))
            }
        })
    }

    fn __contains__(&self, name: &str) -> bool {
        Parameter::find(name).is_some()
    }

    fn __len__(&self) -> usize {
        COUNT
    }

    fn keys(&self) -> Vec<&'static str> {
        self.values.iter().map(|(entry, _)| entry.name.as_str()).collect()
    }

    fn items(&self) -> Vec<(&'static str, f64)> {
        self.values.iter().map(|(entry, value)| (entry.name.as_str(), value)).collect()
    }

    fn __iter__(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        Ok(self.keys().into_pyobject(py)?.try_iter()?.into_any().unbind())
    }

    fn copy(&self) -> Self {
        self.clone()
    }

    #[staticmethod]
    fn entry(name: &str) -> PyResult<Entry> {
        let found = rig::Parameters::<f64>::entry(named(name)?);
        let (entry, default) = found.ok_or_else(|| PyKeyError::new_err(name.to_owned()))?;
        Ok(Entry {
            name: name.to_owned(),
            unit: entry.unit.to_owned(),
            default,
            min: entry.min,
            max: entry.max,
            text: entry.text.to_owned(),
        })
    }

    fn __repr__(&self) -> String {
        let default = rig::Parameters::<f64>::default();
        let set = self.values.iter().zip(default.iter()).filter(|((_, now), (_, usual))| now != usual);
        let set: Vec<String> = set.map(|((entry, value), _)| format!("{}={value}", entry.name.as_str())).collect();
        format!("Parameters({})", set.join(", "))
    }
}
