//! Many flights: comparisons and campaigns.

use hil_sim::describe::input::Invalid;
use hil_sim::fly::flight::Control;
use hil_sim::study::{campaign as drawn, compare as compared};
use hil_sim::world::Seed;
use pyo3::exceptions::{PyFileNotFoundError, PyKeyboardInterrupt, PyOSError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyMapping};
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::path::PathBuf;
use std::sync::atomic::Ordering;

use crate::convert::{columns, object, table};
use crate::error::{count, invalid, unknown, whole, within};
use crate::flight::log;
use crate::interrupt::interruptible;
use crate::state::State;

/// The threads: all cores for 0.
fn pool(jobs: usize) -> PyResult<ThreadPool> {
    ThreadPoolBuilder::new().num_threads(jobs).build().map_err(whole)
}

/// Flies four laws in each case of a world that is not as told: a row a case and law.
#[pyfunction]
#[pyo3(signature = (runs = 20, *, cases = None, seed = 1, bandwidth = compared::BANDWIDTH, jobs = 0))]
pub fn compare<'py>(
    py: Python<'py>,
    runs: i64,
    cases: Option<Vec<String>>,
    seed: u64,
    bandwidth: f64,
    jobs: usize,
) -> PyResult<Bound<'py, PyDict>> {
    let runs = count("runs", runs)? as usize;
    within("bandwidth", bandwidth, [0.01, 100.0])?;
    let known: Vec<&str> = compared::CASES.iter().map(|case| case.name).collect();
    let cases = cases.unwrap_or_else(|| known.iter().copied().map(str::to_owned).collect());
    if let Some(other) = cases.iter().find(|name| !known.contains(&name.as_str())) {
        return Err(unknown("cases", other, &known));
    }
    let pool = pool(jobs)?;
    let wanted = |name: &str| cases.iter().any(|case| case == name);
    let comparison =
        interruptible(py, |control| pool.install(|| compared::compare(runs, seed, bandwidth, &wanted, control)))?;
    match comparison.map_err(whole)? {
        Some(comparison) => columns(py, &comparison.rows),
        None => Err(PyKeyboardInterrupt::new_err(())),
    }
}

/// Thousands of flights, each drawn from distributions.
#[pyclass(frozen, module = "slung")]
pub struct Campaign(pub drawn::Campaign);

/// The campaign of this name or in this file.
fn read(source: &Bound<'_, PyAny>) -> PyResult<String> {
    let file: PathBuf = source.extract()?;
    match std::fs::read_to_string(&file) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            let name = file.display().to_string();
            let known = || drawn::BUILTIN.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
            let absent = || format!("{name}: there is no such file, and the built-in campaigns are {}", known());
            Ok(drawn::builtin(&name).ok_or_else(|| PyFileNotFoundError::new_err(absent()))?.to_owned())
        }
        read => read.map_err(|error| PyOSError::new_err(format!("{}: {error}", file.display()))),
    }
}

#[pymethods]
impl Campaign {
    #[new]
    #[pyo3(signature = (source = None, /))]
    fn new(source: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let text = match source {
            None => drawn::builtin("campaign").unwrap_or_default().to_owned(),
            Some(mapping) if mapping.cast::<PyMapping>().is_ok() => table(mapping)?.to_string(),
            Some(source) => read(source)?,
        };
        drawn::Campaign::parse(&text).map(Self).map_err(invalid)
    }

    #[getter]
    fn title(&self) -> &str {
        &self.0.title
    }
    #[getter]
    fn runs(&self) -> u64 {
        self.0.runs
    }

    /// The state at a flight's start.
    #[pyo3(signature = (run, *, seed = 1))]
    fn start(&self, py: Python<'_>, run: u64, seed: u64) -> PyResult<State> {
        let drawn = py.detach(|| self.0.draw(Seed { batch: seed, run })).map_err(invalid)?;
        Ok(State(drawn.start.state))
    }

    /// Flies all, or the first `runs`: a row a flight.
    #[pyo3(signature = (runs = None, *, seed = 1, jobs = 0))]
    fn run<'py>(&self, py: Python<'py>, runs: Option<i64>, seed: u64, jobs: usize) -> PyResult<Bound<'py, PyDict>> {
        let runs = runs.map(|runs| count("runs", runs)).transpose()?;
        let pool = pool(jobs)?;
        let campaign = &self.0;
        let rows: Result<Vec<Option<drawn::Row>>, Invalid> = interruptible(py, |control| {
            let stop = control.stop;
            pool.install(|| {
                let flights = (0..runs.unwrap_or(campaign.runs)).into_par_iter();
                let flights = flights.map(|run| {
                    if stop.load(Ordering::Relaxed) {
                        return Ok(None);
                    }
                    let control = Control { stop, progress: &|_| {} };
                    drawn::fly_run(campaign, Seed { batch: seed, run }, control, None)
                });
                flights.collect()
            })
        })?;
        let rows: Option<Vec<drawn::Row>> = rows.map_err(invalid)?.into_iter().collect();
        columns(py, &rows.ok_or_else(|| PyKeyboardInterrupt::new_err(()))?)
    }

    /// One flight again: its row, and its log, a sample a period.
    #[pyo3(signature = (run, *, seed = 1))]
    fn replay<'py>(&self, py: Python<'py>, run: u64, seed: u64) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyDict>)> {
        let seed = Seed { batch: seed, run };
        let replayed = interruptible(py, |control| drawn::replay(&self.0, seed, control))?.map_err(invalid)?;
        let replayed = replayed.ok_or_else(|| PyKeyboardInterrupt::new_err(()))?;
        Ok((object(py, &replayed.row)?, log(py, &replayed.log)?))
    }

    fn __repr__(&self) -> String {
        format!("Campaign({}, {} flights)", self.0.title, self.0.runs)
    }
}
