//! The controller's instance, in the caller's memory.

use core::mem::size_of;

use controller::{Command, Frames, Measured, Mode, Refused, Request, State, Vector3};
use rig::{Rig, SetupError};

use crate::frames::{frames, uav};
use crate::parameters::Stored;
use crate::path::{self, FlownPath};
use crate::pointer::{Sized32, Target, exclusive, optional, shared, write_sized};
use crate::route::StoredRoute;
use crate::status::{Status, code, setup, tell};
use crate::text::{fault_code, margin_code, mode_code};
use crate::types::{SlungError, SlungOutput, SlungProgress, SlungState, SlungTelemetry, SlungUav, SlungWrench};

/// Written by [`slung_create`]; anything else is memory in which no controller is.
const CREATED: u32 = 0x51A6_C081;

type Controller = Rig<f32, FlownPath>;

/// `slung_controller`: the caller's memory holds this.
#[repr(C, align(8))]
pub struct Instance {
    created: u32,
    request: Request,
    rig: Controller,
}

/// Bytes in the header's `slung_controller`; a test compares.
pub const BYTES: usize = 4096;
const _: () = assert!(size_of::<Instance>() <= BYTES);

impl Instance {
    fn rig(&mut self) -> Result<&mut Controller, Status> {
        if self.created == CREATED { Ok(&mut self.rig) } else { Err(Status::NotCreated) }
    }
}

/// How many bytes a controller takes, at most the size of `slung_controller`.
#[unsafe(no_mangle)]
pub extern "C" fn slung_controller_bytes() -> usize {
    size_of::<Instance>()
}

/// Makes a controller of `parameters`, rotors off. Refused, nothing is made, and `error` (which may
/// be null) tells why.
///
/// # Safety
/// `bytes` may be written to at `controller`; the other pointers, if not null, point to what the
/// header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_create(
    controller: *mut Instance,
    bytes: usize,
    parameters: *const Stored,
    error: *mut SlungError,
) -> i32 {
    // SAFETY: the caller's promise.
    unsafe { slung_create_on(controller, bytes, parameters, core::ptr::null(), error) }
}

/// The same on a route, or on the parameters' own path where it is null.
///
/// # Safety
/// As [`slung_create`]; the route's knots and runs stay where they are as long as the controller is
/// used.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_create_on(
    controller: *mut Instance,
    bytes: usize,
    parameters: *const Stored,
    route: *const StoredRoute,
    error: *mut SlungError,
) -> i32 {
    let create = || {
        if controller.is_null() {
            return Err(Status::NullPointer);
        }
        if !controller.is_aligned() {
            return Err(Status::Misaligned);
        }
        if bytes < size_of::<Instance>() {
            return Err(Status::TooSmall);
        }
        // SAFETY: the caller's promise.
        let parameters = unsafe { shared(parameters)? }.values()?;
        let refused = |refused: SetupError<f32>| {
            let (status, field, numbers) = setup(&refused, parameters);
            // SAFETY: the caller's promise.
            unsafe { tell(error, status, field, numbers) }
        };
        let (path, lands) = if route.is_null() {
            (path::of(parameters).map_err(|error| refused(error.into()))?, false)
        } else {
            // SAFETY: the caller's promise.
            let stored = unsafe { shared(route)? }.check()?;
            (FlownPath::Route(stored.route().map_err(|error| refused(error.into()))?), stored.lands())
        };
        let rig = Rig::on(path, parameters).map_err(refused)?;
        let rig = if lands { rig.landing_at_end() } else { rig };
        // SAFETY: not null, aligned, and large enough by the caller's word. What was there needs no
        // drop.
        unsafe { controller.write(Instance { created: CREATED, request: Request::Off, rig }) };
        Ok(())
    };
    code(create())
}

/// Takes over a flying vehicle to which `applied` has been applied until now: hold, without a bump.
///
/// # Safety
/// Pointers that are not null point to what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_take_over(
    controller: *mut Instance,
    state: *const SlungState,
    applied: *const SlungWrench,
) -> i32 {
    let take_over = || {
        // SAFETY: the caller's promise.
        let (instance, state, applied) = unsafe { (exclusive(controller)?, shared(state)?, shared(applied)?) };
        let applied = Command { thrust: applied.thrust_n, torque: applied.torque_frd_n_m.into() };
        instance.rig()?.take_over(&state.into(), applied).map_err(refused)?;
        instance.request = Request::Hold;
        Ok(())
    };
    code(take_over())
}

/// Starts on the path from a stated ζ: follow, without an approach.
///
/// # Safety
/// As [`slung_take_over`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_start(
    controller: *mut Instance,
    state: *const SlungState,
    zeta: *const [f32; 4],
) -> i32 {
    let start = || {
        // SAFETY: the caller's promise.
        let (instance, state, zeta) = unsafe { (exclusive(controller)?, shared(state)?, shared(zeta)?) };
        instance.rig()?.start(&state.into(), *zeta).map_err(refused)?;
        instance.request = Request::Follow;
        Ok(())
    };
    code(start())
}

fn refused(reason: Refused) -> Status {
    match reason {
        Refused::State(_) => Status::BadState,
        _ => Status::OutOfRange,
    }
}

fn good(state: &SlungState) -> Result<State<f32>, Status> {
    let state = State::from(state);
    state.check().map(|()| state).map_err(|_| Status::BadState)
}

fn request(number: u32) -> Result<Request, Status> {
    match number {
        0 => Ok(Request::Off),
        1 => Ok(Request::Idle),
        2 => Ok(Request::Follow),
        3 => Ok(Request::Hold),
        4 => Ok(Request::Land),
        _ => Err(Status::UnknownEnumerator),
    }
}

/// A control period. Whatever the state is, the output is written; on an unknown request, which is
/// refused, the last one is flown on.
///
/// # Safety
/// As [`slung_take_over`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_step(
    controller: *mut Instance,
    state: *const SlungState,
    wanted: u32,
    output: *mut SlungOutput,
) -> i32 {
    let (uav, force) = (core::ptr::null(), core::ptr::null());
    // SAFETY: the caller's promise.
    unsafe { slung_step_measured(controller, state, 0, uav, force, wanted, output) }
}

/// The same with what the UAV knows of itself, in the axes of `slung_frames`; any of it may be
/// null.
///
/// # Safety
/// As [`slung_take_over`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_step_measured(
    controller: *mut Instance,
    state: *const SlungState,
    number: u32,
    reported: *const SlungUav,
    specific_force_body_m_s2: *const [f32; 3],
    wanted: u32,
    output: *mut SlungOutput,
) -> i32 {
    let step = || {
        // SAFETY: the caller's promise.
        let instance = unsafe { exclusive(controller)? };
        instance.rig()?;
        let frames = frames(number)?;
        // SAFETY: the caller's promise.
        let (target, state, uav, force) = unsafe {
            let target = Target::at(output, SlungOutput::SIZE)?;
            (target, optional(state)?, optional(reported)?, optional(specific_force_body_m_s2)?)
        };
        let known = request(wanted).map(|wanted| instance.request = wanted);
        let body_rate = fly(instance, state, frames, uav, force);
        answer(&instance.rig, body_rate, target);
        known
    };
    code(step())
}

/// The step itself, and the body rate that it was made on. Out of line, and the answer too:
/// neither's stack lies under the other's.
#[inline(never)]
fn fly(
    instance: &mut Instance,
    state: Option<&SlungState>,
    frames: Frames,
    reported: Option<&SlungUav>,
    force: Option<&[f32; 3]>,
) -> Option<Vector3<f32>> {
    let state = state.map(State::from);
    let uav = reported.map(|reported| uav(frames, reported));
    let specific_force = force.map(|force| frames.body(&Vector3::from(*force)));
    let measured = Measured { state: state.as_ref(), uav: uav.as_ref(), specific_force };
    instance.rig.step(measured, instance.request, 0.0);
    measured.body_rate()
}

/// Writes the last step's answer.
#[inline(never)]
fn answer(rig: &Controller, body_rate: Option<Vector3<f32>>, target: Target<SlungOutput>) {
    let output = rig.output();
    let Command { thrust, torque } = output.command;
    let setpoint = rig.rate_setpoint(body_rate);
    let [thrust_normalized, roll, pitch, yaw] = rig.actuators().shares(&output.command);
    target.write(&SlungOutput {
        struct_size: SlungOutput::SIZE,
        mode: mode_code(output.mode),
        fault: output.fault.map_or(0, fault_code),
        warning: output.warning.map_or(0, margin_code),
        limited: u32::from(output.limited),
        thrust_n: thrust,
        torque_frd_n_m: torque.into(),
        angular_acceleration_frd_rad_s2: setpoint.angular_acceleration.into(),
        body_rate_setpoint_frd_rad_s: setpoint.body_rate.into(),
        thrust_normalized,
        torque_normalized_frd: [roll, pitch, yaw],
        rotor: rig.duties(),
    });
}

/// Flies the path at another factor of its speed, smoothly: 0 rests anywhere, less goes back.
///
/// # Safety
/// As [`slung_take_over`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_set_speed_factor(controller: *mut Instance, factor: f32) -> i32 {
    let set = || {
        // SAFETY: the caller's promise.
        let rig = unsafe { exclusive(controller)? }.rig()?;
        if !(-2.0..=2.0).contains(&factor) {
            return Err(Status::OutOfRange);
        }
        rig.set_speed_factor(factor);
        Ok(())
    };
    code(set())
}

/// Goes on from the stop where the payload rests.
///
/// # Safety
/// As [`slung_take_over`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_go_on(controller: *mut Instance) -> i32 {
    let go_on = || {
        // SAFETY: the caller's promise.
        let rig = unsafe { exclusive(controller)? }.rig()?;
        let is_following = rig.mode() == Mode::Follow;
        let law = rig.following_mut().filter(|_| is_following).ok_or(Status::NotNow)?;
        if law.go_on() { Ok(()) } else { Err(Status::NotNow) }
    };
    code(go_on())
}

/// How far the route is flown.
///
/// # Safety
/// As [`slung_take_over`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_progress_of(controller: *mut Instance, progress: *mut SlungProgress) -> i32 {
    let read = || {
        // SAFETY: the caller's promise.
        let rig = unsafe { exclusive(controller)? }.rig()?;
        let law = rig.following().ok_or(Status::NotNow)?;
        let FlownPath::Route(route) = law.path() else { return Err(Status::NotNow) };
        let is_following = rig.mode() == Mode::Follow;
        let told = SlungProgress {
            struct_size: SlungProgress::SIZE,
            run: route.run() as u32,
            runs: route.table().runs.len() as u32,
            rests: u32::from(is_following && law.rests()),
            is_over: u32::from(rig.is_landing_at_end() || is_following && law.is_over()),
            speed_factor: law.speed_factor(),
            nearest_ned_m: route.point().into(),
        };
        // SAFETY: the caller's promise.
        unsafe { write_sized(progress, &told, SlungProgress::SIZE) }
    };
    code(read())
}

/// Turns an output's vectors, which are in forward-right-down axes, into the body axes of
/// `slung_frames`, in place.
///
/// # Safety
/// As [`slung_take_over`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_output_in(number: u32, output: *mut SlungOutput) -> i32 {
    let turn = || {
        let frames = frames(number)?;
        // SAFETY: the caller's promise.
        let output = unsafe { exclusive(output)? };
        if output.struct_size < SlungOutput::SIZE {
            return Err(Status::StructSize);
        }
        for vector in [
            &mut output.torque_frd_n_m,
            &mut output.angular_acceleration_frd_rad_s2,
            &mut output.body_rate_setpoint_frd_rad_s,
            &mut output.torque_normalized_frd,
        ] {
            *vector = frames.body(&(*vector).into()).into();
        }
        Ok(())
    };
    code(turn())
}

/// Where the last step's command came from, at the state that it was made on.
///
/// # Safety
/// As [`slung_take_over`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_telemetry_of(
    controller: *mut Instance,
    state: *const SlungState,
    telemetry: *mut SlungTelemetry,
) -> i32 {
    let read = || {
        // SAFETY: the caller's promise.
        let (instance, state) = unsafe { (exclusive(controller)?, shared(state)?) };
        let rig = instance.rig()?;
        let found = rig.telemetry(&good(state)?);
        let law = found.law;
        let margins = law.map(|law| law.margins).unwrap_or_default();
        let told = SlungTelemetry {
            struct_size: SlungTelemetry::SIZE,
            law_flew: u32::from(law.is_some()),
            xi: law.map_or([0.0; 20], |law| law.xi),
            nu: law.map_or([0.0; 4], |law| law.nu),
            u_zeta_m_s6: law.map_or(0.0, |law| law.u_zeta),
            zeta: *rig.zeta(),
            margin_rod: margins.q3,
            margin_thrust_axis: margins.q_b3,
            margin_lambda_m_s2: margins.lambda,
            margin_kappa_1_s2: margins.kappa,
            margin_path: margins.path_det,
            margin_reach: margins.reach,
            payload_force_ned_n: found.payload_force,
            uav_force_ned_n: found.uav_force,
            torque_frd_n_m: found.torque,
            implied_payload_mass_kg: found.payload_mass,
        };
        // SAFETY: the caller's promise.
        unsafe { write_sized(telemetry, &told, SlungTelemetry::SIZE) }
    };
    code(read())
}
