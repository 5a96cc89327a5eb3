//! The supervised controller.

use controller::{Command, Fault, Frames, Margin, Measured, Mode, Request, Vector3};
use hil_sim::describe::course::{FlownPath, RouteSpec};
use hil_sim::fly::fault::describe;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rig::{RateSetpoint, SetupError, Tabled};

use crate::convert::{frames, object, vector};
use crate::error::{out_of_range, refused, unknown, whole, within};
use crate::parameters::Parameters;
use crate::path::Path;
use crate::state::{State, Uav};

/// A controller made of parameters: states and requests in, commands out.
#[pyclass(module = "slung")]
pub struct Rig(Scalar);

/// In the arithmetic of a board, or in that of a reference.
#[expect(clippy::large_enum_variant, reason = "each is behind a Python object of its own")]
enum Scalar {
    Single(rig::Rig<f32, FlownPath<f32>>),
    Double(rig::Rig<f64, FlownPath<f64>>),
}

macro_rules! either {
    ($scalar:expr, $rig:ident => $value:expr) => {
        match $scalar {
            Scalar::Single($rig) => $value,
            Scalar::Double($rig) => $value,
        }
    };
}

/// What a step answers.
#[pyclass(frozen, module = "slung")]
pub struct Output {
    output: rig::Output<f64>,
    setpoint: RateSetpoint<f64>,
    /// Shares of the rotors' largest: of thrust, and of torque about each axis.
    shares: [f64; 4],
    duties: [f64; 4],
    /// What the body's vectors are given in.
    frames: Frames,
}

fn make<T: Tabled>(parameters: &rig::Parameters<f64>, path: Option<&Path>) -> PyResult<rig::Rig<T, FlownPath<T>>> {
    let parameters = parameters.cast();
    let lands = path.and_then(|path| path.spec.route()).is_some_and(RouteSpec::lands);
    let path = match path {
        Some(path) => path.spec.build().map_err(out_of_range)?,
        None => rig::path(&parameters).map_err(out_of_range)?,
    };
    let rig = rig::Rig::on(path, &parameters).map_err(|error| match error {
        SetupError::Range(error) => out_of_range(error),
        SetupError::Gains(_) => whole(error),
    })?;
    Ok(if lands { rig.landing_at_end() } else { rig })
}

fn request(name: &str) -> PyResult<Request> {
    Ok(match name {
        "off" => Request::Off,
        "idle" => Request::Idle,
        "follow" => Request::Follow,
        "hold" => Request::Hold,
        "land" => Request::Land,
        other => return Err(unknown("request", other, &["off", "idle", "follow", "hold", "land"])),
    })
}

fn not_taken(reason: controller::Refused) -> PyErr {
    refused(format!("refused: {reason:?}"), "state", None)
}

#[pymethods]
impl Rig {
    #[new]
    #[pyo3(signature = (parameters = None, path = None, *, arithmetic = "f32"))]
    fn new(parameters: Option<&Parameters>, path: Option<&Path>, arithmetic: &str) -> PyResult<Self> {
        let default = Parameters::default();
        let values = &parameters.unwrap_or(&default).values;
        Ok(Self(match arithmetic {
            "f32" => Scalar::Single(make(values, path)?),
            "f64" => Scalar::Double(make(values, path)?),
            other => return Err(unknown("arithmetic", other, &["f32", "f64"])),
        }))
    }

    #[pyo3(signature = (state, thrust, torque = [0.0; 3]))]
    fn take_over(&mut self, state: &State, thrust: f64, torque: [f64; 3]) -> PyResult<()> {
        let applied = Command { thrust, torque: torque.into() };
        either!(&mut self.0, rig => rig.take_over(&state.0.cast(), applied.cast())).map_err(not_taken)
    }

    #[pyo3(signature = (state, zeta = [0.0; 4]))]
    fn start(&mut self, state: &State, zeta: [f64; 4]) -> PyResult<()> {
        either!(&mut self.0, rig => rig.start(&state.0.cast(), zeta.map(controller::Real::lit))).map_err(not_taken)
    }

    #[pyo3(signature = (state, request = "follow", *, uav = None, specific_force = None, phase = 0.0))]
    fn step(
        &mut self,
        state: Option<&State>,
        request: &str,
        uav: Option<&Uav>,
        specific_force: Option<[f64; 3]>,
        phase: f64,
    ) -> PyResult<Output> {
        let request = self::request(request)?;
        Ok(either!(&mut self.0, rig => {
            let state = state.map(|state| state.0.cast());
            let uav = uav.map(Uav::cast);
            let specific_force = specific_force.map(|force| Vector3::from(force.map(controller::Real::lit)));
            let measured = Measured { state: state.as_ref(), uav: uav.as_ref(), specific_force };
            let output = *rig.step(measured, request, controller::Real::lit(phase));
            let RateSetpoint { angular_acceleration, body_rate } = rig.rate_setpoint(measured.body_rate());
            Output {
                setpoint: RateSetpoint {
                    angular_acceleration: angular_acceleration.map(controller::Real::to_f64),
                    body_rate: body_rate.map(controller::Real::to_f64),
                },
                shares: rig.actuators().shares(&output.command).map(controller::Real::to_f64),
                duties: rig.duties().map(controller::Real::to_f64),
                output: rig::Output {
                    command: output.command.cast(),
                    mode: output.mode,
                    fault: output.fault,
                    warning: output.warning,
                    limited: output.limited,
                },
                frames: Frames::NedFrd,
            }
        }))
    }

    /// Flies the path at another factor of its speed, smoothly.
    fn set_speed_factor(&mut self, factor: f64) -> PyResult<()> {
        within("factor", factor, [-2.0, 2.0])?;
        either!(&mut self.0, rig => rig.set_speed_factor(controller::Real::lit(factor)));
        Ok(())
    }

    /// Goes on from the stop where the payload rests.
    fn go_on(&mut self) -> bool {
        either!(&mut self.0, rig => {
            let is_following = rig.mode() == Mode::Follow;
            rig.following_mut().is_some_and(|law| is_following && law.go_on())
        })
    }

    /// Whether the payload has rested at the route's end for as long as it is to.
    #[getter]
    fn is_over(&self) -> bool {
        either!(&self.0, rig => {
            let rests = rig.mode() == Mode::Follow && rig.following().is_some_and(controller::Follow::is_over);
            rests || rig.is_landing_at_end()
        })
    }

    #[getter]
    fn mode(&self) -> String {
        mode(either!(&self.0, rig => rig.mode()))
    }

    #[getter]
    fn zeta<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &either!(&self.0, rig => rig.zeta().map(controller::Real::to_f64)))
    }

    /// Where the last step's command came from, at the state that it was made on.
    fn telemetry<'py>(&self, py: Python<'py>, state: &State) -> PyResult<Bound<'py, PyDict>> {
        use controller::Real;
        let told = PyDict::new(py);
        either!(&self.0, rig => {
            let found = rig.telemetry(&state.0.cast());
            let numbers = |name: &str, numbers: &[f64]| told.set_item(name, PyArray1::from_slice(py, numbers));
            numbers("payload_force", &found.payload_force.map(Real::to_f64))?;
            numbers("uav_force", &found.uav_force.map(Real::to_f64))?;
            numbers("torque", &found.torque.map(Real::to_f64))?;
            told.set_item("payload_mass", found.payload_mass.to_f64())?;
            if let Some(law) = found.law {
                numbers("xi", &law.xi.map(Real::to_f64))?;
                numbers("nu", &law.nu.map(Real::to_f64))?;
                told.set_item("u_zeta", law.u_zeta.to_f64())?;
                let margins = law.margins.cast::<f64>();
                told.set_item("margins", object(py, &[
                    ("rod", margins.q3),
                    ("thrust_axis", margins.q_b3),
                    ("lambda", margins.lambda),
                    ("kappa", margins.kappa),
                    ("path", margins.path_det),
                    ("reach", margins.reach),
                ].into_iter().collect::<std::collections::BTreeMap<_, _>>())?)?;
            }
        });
        Ok(told)
    }
}

/// As scenario logs have it.
fn mode(mode: Mode) -> String {
    match mode {
        Mode::TakeOff => "take_off".to_owned(),
        mode => format!("{mode:?}").to_lowercase(),
    }
}

#[pymethods]
impl Output {
    #[getter]
    fn thrust(&self) -> f64 {
        self.output.command.thrust
    }
    #[getter]
    fn torque<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.body(py, &self.output.command.torque)
    }
    #[getter]
    fn mode(&self) -> String {
        mode(self.output.mode)
    }
    #[getter]
    fn fault(&self) -> Option<String> {
        self.output.fault.map(|fault: Fault| describe(fault))
    }
    #[getter]
    fn warning(&self) -> Option<String> {
        self.output.warning.map(|margin: Margin| format!("{margin:?}"))
    }
    #[getter]
    fn limited(&self) -> bool {
        self.output.limited
    }
    #[getter]
    fn angular_acceleration<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.body(py, &self.setpoint.angular_acceleration)
    }
    #[getter]
    fn body_rate_setpoint<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.body(py, &self.setpoint.body_rate)
    }
    #[getter]
    fn thrust_normalized(&self) -> f64 {
        self.shares[0]
    }
    #[getter]
    fn torque_normalized<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let [_, roll, pitch, yaw] = self.shares;
        self.body(py, &Vector3::new(roll, pitch, yaw))
    }
    #[getter]
    fn rotors<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.duties)
    }

    /// The same with the body's vectors in other axes.
    fn in_frames(&self, frames: &str) -> PyResult<Self> {
        let Self { output, setpoint, shares, duties, .. } = *self;
        Ok(Self { output, setpoint, shares, duties, frames: self::frames(frames)? })
    }

    fn __repr__(&self) -> String {
        let rig::Output { command, mode, fault, .. } = &self.output;
        format!("Output({mode:?}, {:.4} N, {:?} N·m, {fault:?})", command.thrust, command.torque.as_slice())
    }
}

impl Output {
    fn body<'py>(&self, py: Python<'py>, v: &Vector3<f64>) -> Bound<'py, PyArray1<f64>> {
        // Each of the conversions is its own inverse.
        vector(py, &self.frames.body(v))
    }
}
