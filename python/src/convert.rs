//! Between Python's objects, NumPy's arrays, and ours.

use controller::{Frames, Matrix3, Vector3};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyMapping, PyString};
use serde::Serialize;
use serde_json::Value as Json;
use toml::{Table, Value};

use crate::error::{unknown, whole};
use crate::path::Path;

/// A vector as an array of three.
pub fn vector<'py>(py: Python<'py>, v: &Vector3<f64>) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_slice(py, v.as_slice())
}

/// A matrix as an array of its rows.
pub fn matrix<'py>(py: Python<'py>, m: &Matrix3<f64>) -> PyResult<Bound<'py, PyArray2<f64>>> {
    // By columns in memory, so that the transpose lies there by rows.
    PyArray1::from_slice(py, m.transpose().as_slice()).reshape([3, 3])
}

/// Rows of numbers as an array of two dimensions.
pub fn rows<'py>(py: Python<'py>, rows: &[[f64; 3]]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    PyArray1::from_slice(py, rows.as_flattened()).reshape([rows.len(), 3])
}

/// An attitude, body to world: three rows of a rotation, or a unit quaternion (w, x, y, z).
#[derive(FromPyObject)]
pub enum Attitude {
    /// Row by row.
    Rows([[f64; 3]; 3]),
    /// w, x, y, z.
    Quaternion([f64; 4]),
}

impl Attitude {
    /// The rotation. A quaternion of another length gives that length's square times one, which the
    /// state's check finds.
    pub fn rotation(self) -> Matrix3<f64> {
        match self {
            Self::Rows([a, b, c]) => Matrix3::new(a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]),
            Self::Quaternion(quaternion) => hil_sim::world::multibody::rotation(quaternion),
        }
    }
}

/// The axes of this name: `ned`, `enu` or `nwu`.
pub fn frames(name: &str) -> PyResult<Frames> {
    match name {
        "ned" => Ok(Frames::NedFrd),
        "enu" => Ok(Frames::EnuFlu),
        "nwu" => Ok(Frames::NwuFlu),
        other => Err(unknown("frames", other, &["ned", "enu", "nwu"])),
    }
}

/// A mapping as a table of TOML: what a scenario file holds. Arrays become lists, and a
/// [`Path`] its keys.
pub fn table(mapping: &Bound<'_, PyAny>) -> PyResult<Table> {
    let mapping = mapping.cast::<PyMapping>()?;
    let mut table = Table::new();
    for item in mapping.items()?.iter() {
        let (key, value): (String, Bound<'_, PyAny>) = item.extract()?;
        // As where a key is left out.
        if !value.is_none() {
            let value = self::value(&key, &value)?;
            table.insert(key, value);
        }
    }
    Ok(table)
}

fn value(key: &str, object: &Bound<'_, PyAny>) -> PyResult<Value> {
    if let Ok(path) = object.cast::<Path>() {
        return Ok(Value::Table(path.get().keys.clone()));
    }
    if object.is_instance_of::<PyBool>() {
        return Ok(Value::Boolean(object.extract()?));
    }
    if object.is_instance_of::<PyString>() {
        return Ok(Value::String(object.extract()?));
    }
    if object.is_instance_of::<PyInt>() {
        return Ok(Value::Integer(object.extract()?));
    }
    if object.is_instance_of::<PyFloat>() {
        return Ok(Value::Float(object.extract()?));
    }
    if object.cast::<PyMapping>().is_ok() {
        return Ok(Value::Table(table(object)?));
    }
    // NumPy's arrays and numbers say themselves what they are in Python.
    if let Ok(plain) = object.call_method0("tolist") {
        return value(key, &plain);
    }
    let items = object.try_iter().map_err(|_| {
        let kind = object.get_type().name().map_or_else(|_| "?".to_owned(), |name| name.to_string());
        PyTypeError::new_err(format!("{key}: a {kind} is no value of a scenario"))
    })?;
    items.map(|item| value(key, &item?)).collect::<PyResult<Vec<_>>>().map(Value::Array)
}

/// What serializes as an object of Python's own kinds.
pub fn object<'py>(py: Python<'py>, value: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    json(py, &serde_json::to_value(value).map_err(whole)?)
}

fn json<'py>(py: Python<'py>, value: &Json) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Json::Null => py.None().into_bound(py),
        Json::Bool(value) => value.into_pyobject(py)?.to_owned().into_any(),
        Json::Number(number) => match number.as_i64() {
            Some(whole) => whole.into_pyobject(py)?.into_any(),
            None => number.as_f64().unwrap_or(f64::NAN).into_pyobject(py)?.into_any(),
        },
        Json::String(text) => text.into_pyobject(py)?.into_any(),
        Json::Array(items) => {
            let items = items.iter().map(|item| json(py, item)).collect::<PyResult<Vec<_>>>()?;
            PyList::new(py, items)?.into_any()
        }
        Json::Object(fields) => {
            let dict = PyDict::new(py);
            for (name, value) in fields {
                dict.set_item(name, json(py, value)?)?;
            }
            dict.into_any()
        }
    })
}

/// Rows with the same fields as a dictionary of columns: arrays of numbers, NaN where there is
/// none, or of words.
pub fn columns<'py>(py: Python<'py>, rows: &[impl Serialize]) -> PyResult<Bound<'py, PyDict>> {
    let rows = rows.iter().map(serde_json::to_value).collect::<Result<Vec<_>, _>>().map_err(whole)?;
    let columns = PyDict::new(py);
    let Some(Json::Object(first)) = rows.first() else { return Ok(columns) };
    let array = py.import("numpy")?.getattr("array")?;
    for name in first.keys() {
        let cells: Vec<&Json> = rows.iter().filter_map(|row| row.get(name)).collect();
        let numbers: Option<Vec<f64>> =
            cells.iter().map(|cell| if cell.is_null() { Some(f64::NAN) } else { cell.as_f64() }).collect();
        let column = match numbers {
            Some(numbers) => PyArray1::from_vec(py, numbers).into_any(),
            None => array.call1((cells.iter().map(|cell| json(py, cell)).collect::<PyResult<Vec<_>>>()?,))?,
        };
        columns.set_item(name, column)?;
    }
    Ok(columns)
}
