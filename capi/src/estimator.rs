//! The payload filter: the law's state where nobody measures the load.

use core::mem::size_of;

use controller::{OutOfRange, Uav, Vector3};
use estimator::{Cable, Drag, Estimate, LoadMeasurement, Motion, Payload, PayloadParams, Validity};
use rig::parameter;

use crate::frames::{NO_UAV, frames, uav};
use crate::parameters::Stored;
use crate::pointer::{Sized32, Target, exclusive, optional, shared};
use crate::status::{Status, code, tell};
use crate::types::{SlungError, SlungEstimate, SlungMounting, SlungUav};

/// Written by [`slung_estimator_create`]; anything else is memory in which no estimator is.
const CREATED: u32 = 0x51A6_E571;

/// `slung_estimator`: the caller's memory holds this.
#[repr(C, align(8))]
pub struct Instance {
    created: u32,
    filter: Payload<f32>,
}

/// Bytes in the header's `slung_estimator`; a test compares.
pub const BYTES: usize = 2048;
const _: () = assert!(size_of::<Instance>() <= BYTES);

impl Instance {
    fn filter(&mut self) -> Result<&mut Payload<f32>, Status> {
        if self.created == CREATED { Ok(&mut self.filter) } else { Err(Status::NotCreated) }
    }
}

/// How many bytes an estimator takes, at most the size of `slung_estimator`.
#[unsafe(no_mangle)]
pub extern "C" fn slung_estimator_bytes() -> usize {
    size_of::<Instance>()
}

/// Makes an estimator of the parameters' vehicle and period; see the header.
///
/// # Safety
/// `bytes` may be written to at `estimator`; the other pointers, if not null, point to what the
/// header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_estimator_create(
    estimator: *mut Instance,
    bytes: usize,
    parameters: *const Stored,
    mounting: *const SlungMounting,
    error: *mut SlungError,
) -> i32 {
    let create = || {
        if estimator.is_null() {
            return Err(Status::NullPointer);
        }
        if !estimator.is_aligned() {
            return Err(Status::Misaligned);
        }
        if bytes < size_of::<Instance>() {
            return Err(Status::TooSmall);
        }
        // SAFETY: the caller's promise.
        let parameters = unsafe { shared(parameters)? }.values()?;
        let refused = |OutOfRange { field, value, min, max }| {
            // SAFETY: the caller's promise.
            unsafe { tell(error, Status::OutOfRange, field, [value, min, max]) }
        };
        let vehicle = parameters.vehicle().map_err(refused)?;
        let mut params = PayloadParams::of(vehicle.params(), parameters.get(parameter!("CTL_PERIOD")));
        // SAFETY: the caller's promise.
        if let Some(mounting) = unsafe { optional(mounting)? } {
            let drag = |[linear, quadratic]: [f32; 2]| Drag { linear, quadratic };
            params.hook = mounting.hook_frd_m.into();
            params.imu = mounting.imu_frd_m.into();
            params.uav_drag = drag(mounting.uav_drag);
            params.payload_drag = drag(mounting.payload_drag);
        }
        let filter = Payload::new(params).map_err(refused)?;
        // SAFETY: not null, aligned, and large enough by the caller's word. What was there needs no
        // drop.
        unsafe { estimator.write(Instance { created: CREATED, filter }) };
        Ok(())
    };
    code(create())
}

fn validity_code(validity: Validity) -> u32 {
    match validity {
        Validity::Valid => 0,
        Validity::Converging => 1,
        Validity::Inconsistent => 2,
        Validity::Blind => 3,
        Validity::Slack => 4,
    }
}

/// A period: how the UAV moves, its accelerometer and thrust; see the header.
///
/// # Safety
/// Pointers that are not null point to what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_estimator_step(
    estimator: *mut Instance,
    number: u32,
    reported: *const SlungUav,
    specific_force_body_m_s2: *const [f32; 3],
    thrust_n: f32,
    estimate: *mut SlungEstimate,
) -> i32 {
    let step = || {
        // SAFETY: the caller's promise.
        let filter = unsafe { exclusive(estimator)? }.filter()?;
        let frames = frames(number)?;
        // SAFETY: the caller's promise.
        let (target, reported, force) = unsafe {
            let target = Target::at(estimate, SlungEstimate::FIRST)?;
            (target, optional(reported)?, optional(specific_force_body_m_s2)?)
        };
        let motion = reported.zip(force).map(|(reported, force)| {
            let Uav { position, velocity, attitude, body_rate } = uav(frames, reported);
            Motion { position, velocity, attitude, body_rate, specific_force: frames.body(&Vector3::from(*force)) }
        });
        let estimate = filter.step(motion.as_ref(), Some(thrust_n).filter(|thrust| thrust.is_finite()));
        let beside = reported.map_or(NO_UAV, |reported| {
            let Uav { position, velocity, .. } = estimate.beside(&uav(frames, reported));
            SlungUav {
                position_world_m: frames.inertial(&position).into(),
                velocity_world_m_s: frames.inertial(&velocity).into(),
                ..*reported
            }
        });
        let Estimate { state, tension, cable, health, .. } = estimate;
        target.write(&SlungEstimate {
            struct_size: SlungEstimate::SIZE,
            validity: validity_code(health.validity),
            taut: u32::from(cable == Cable::Taut),
            tension_n: tension,
            rod_deviation_rad: health.rod_deviation,
            rate_deviation_1_s: health.rate_deviation,
            state: (&state).into(),
            uav: beside,
        });
        Ok(())
    };
    code(step())
}

/// The load's position as somebody saw it; see the header.
///
/// # Safety
/// As [`slung_estimator_step`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_estimator_observe(
    estimator: *mut Instance,
    number: u32,
    payload_position_world_m: *const [f32; 3],
    deviation_m: f32,
    age_s: f32,
) -> i32 {
    let observe = || {
        // SAFETY: the caller's promise.
        let (instance, position) = unsafe { (exclusive(estimator)?, shared(payload_position_world_m)?) };
        let filter = instance.filter()?;
        let position = frames(number)?.inertial(&Vector3::from(*position));
        used(filter.observe(&LoadMeasurement::Position(position, deviation_m), age_s))
    };
    code(observe())
}

/// The places of load and UAV as motion capture saw both; see the header.
///
/// # Safety
/// As [`slung_estimator_step`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_estimator_observe_pair(
    estimator: *mut Instance,
    number: u32,
    payload_position_world_m: *const [f32; 3],
    uav_position_world_m: *const [f32; 3],
    deviation_m: f32,
    age_s: f32,
) -> i32 {
    let observe = || {
        // SAFETY: the caller's promise.
        let (instance, load, uav) =
            unsafe { (exclusive(estimator)?, shared(payload_position_world_m)?, shared(uav_position_world_m)?) };
        let filter = instance.filter()?;
        let frames = frames(number)?;
        let pair = [load, uav].map(|position| frames.inertial(&Vector3::from(*position)));
        used(filter.observe(&LoadMeasurement::Pair(pair, deviation_m), age_s))
    };
    code(observe())
}

/// What is not used was no measurement.
fn used(is_used: bool) -> Result<(), Status> {
    if is_used { Ok(()) } else { Err(Status::OutOfRange) }
}
