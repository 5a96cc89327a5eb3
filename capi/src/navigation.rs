//! The navigation filter: how the UAV moves, for those who have no navigation of their own.

use core::mem::size_of;

use controller::{Frames, OutOfRange, Uav, Vector3};
use estimator::{Fix, Imu, Motion, Navigation, NavigationNoise, NavigationParams, Refused, attitude_at_rest};
use rig::parameter;

use crate::frames::{frames, quaternion, reported, rotation, uav};
use crate::parameters::Stored;
use crate::pointer::{Sized32, Target, exclusive, optional, read_sized, shared, write_sized};
use crate::status::{Status, code, tell};
use crate::types::{SlungError, SlungFix, SlungNavigated, SlungNavigationSettings, SlungUav};

/// Written by [`slung_navigation_create`]; anything else is memory in which no filter is.
const CREATED: u32 = 0x51A6_4A71;

/// `slung_navigation`: the caller's memory holds this.
#[repr(C, align(8))]
pub struct Instance {
    created: u32,
    filter: Navigation<f32>,
}

/// Bytes in the header's `slung_navigation`; a test compares.
pub const BYTES: usize = 2560;
const _: () = assert!(size_of::<Instance>() <= BYTES);

impl Instance {
    fn filter(&mut self) -> Result<&mut Navigation<f32>, Status> {
        if self.created == CREATED { Ok(&mut self.filter) } else { Err(Status::NotCreated) }
    }
}

/// How many bytes a navigation filter takes, at most the size of `slung_navigation`.
#[unsafe(no_mangle)]
pub extern "C" fn slung_navigation_bytes() -> usize {
    size_of::<Instance>()
}

/// Position and velocity are known to this at the start where nothing else is said, m and m/s.
const START: [f32; 2] = [1.0, 0.3];

fn defaults() -> SlungNavigationSettings {
    let noise = NavigationNoise::default();
    SlungNavigationSettings {
        struct_size: SlungNavigationSettings::SIZE,
        imu_frd_m: [0.0; 3],
        antenna_frd_m: [0.0; 3],
        declination_rad: 0.0,
        accelerometer_m_s2_rthz: noise.accelerometer,
        gyro_rad_s_rthz: noise.gyro,
        accelerometer_walk_m_s2_rts: noise.accelerometer_walk,
        gyro_walk_rad_s_rts: noise.gyro_walk,
        fix_position_m: noise.position,
        fix_velocity_m_s: noise.velocity,
        heading_rad: noise.heading,
        barometer_m: noise.barometer,
        barometer_time_s: noise.barometer_time,
        start_position_m: START[0],
        start_velocity_m_s: START[1],
        start_tilt_rad: noise.start_tilt,
        start_heading_rad: noise.start_heading,
        start_gyro_rad_s: noise.start_gyro,
        start_accelerometer_m_s2: noise.start_accelerometer,
    }
}

fn params(told: &SlungNavigationSettings, period: f32, gravity: f32) -> NavigationParams<f32> {
    NavigationParams {
        period,
        gravity,
        imu: told.imu_frd_m.into(),
        antenna: told.antenna_frd_m.into(),
        declination: told.declination_rad,
        noise: NavigationNoise {
            accelerometer: told.accelerometer_m_s2_rthz,
            gyro: told.gyro_rad_s_rthz,
            gyro_walk: told.gyro_walk_rad_s_rts,
            accelerometer_walk: told.accelerometer_walk_m_s2_rts,
            position: told.fix_position_m,
            velocity: told.fix_velocity_m_s,
            heading: told.heading_rad,
            barometer: told.barometer_m,
            barometer_time: told.barometer_time_s,
            start_tilt: told.start_tilt_rad,
            start_heading: told.start_heading_rad,
            start_gyro: told.start_gyro_rad_s,
            start_accelerometer: told.start_accelerometer_m_s2,
        },
    }
}

/// What the filter calls a number that it refuses, in the header's words.
fn field_of(field: &'static str) -> &'static str {
    match field {
        "period" => "CTL_PERIOD",
        "gravity" => "VEH_G",
        "imu" => "imu_frd_m",
        "antenna" => "antenna_frd_m",
        "declination" => "declination_rad",
        "deviations[0]" => "start_position_m",
        "deviations[1]" => "start_velocity_m_s",
        "noise.accelerometer" => "accelerometer_m_s2_rthz",
        "noise.gyro" => "gyro_rad_s_rthz",
        "noise.gyro_walk" => "gyro_walk_rad_s_rts",
        "noise.accelerometer_walk" => "accelerometer_walk_m_s2_rts",
        "noise.position" => "fix_position_m",
        "noise.velocity" => "fix_velocity_m_s",
        "noise.heading" => "heading_rad",
        "noise.barometer" => "barometer_m",
        "noise.barometer_time" => "barometer_time_s",
        "noise.start_tilt" => "start_tilt_rad",
        "noise.start_heading" => "start_heading_rad",
        "noise.start_gyro" => "start_gyro_rad_s",
        "noise.start_accelerometer" => "start_accelerometer_m_s2",
        other => other,
    }
}

fn refusal(refused: Refused) -> Status {
    match refused {
        Refused::NotUsable => Status::OutOfRange,
        Refused::Age => Status::Late,
        Refused::Outlier => Status::Outlier,
    }
}

/// All settings at their defaults; see the header.
///
/// # Safety
/// If it is neither null nor misaligned, the first four bytes of `settings` hold how many may be
/// written there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_navigation_defaults(settings: *mut SlungNavigationSettings) -> i32 {
    // SAFETY: the caller's promise.
    code(unsafe { write_sized(settings, &defaults(), SlungNavigationSettings::SIZE) })
}

/// A UAV that stands still at the origin, by its accelerometer and heading; see the header.
///
/// # Safety
/// Pointers that are not null point to what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_navigation_at_rest(
    number: u32,
    specific_force_body_m_s2: *const [f32; 3],
    heading_rad: f32,
    standing: *mut SlungUav,
) -> i32 {
    let stand = || {
        // SAFETY: the caller's promise.
        let (force, standing) = unsafe { (shared(specific_force_body_m_s2)?, exclusive(standing)?) };
        let frames = frames(number)?;
        let force = frames.body(&Vector3::from(*force));
        let attitude = attitude_at_rest(&force, &Vector3::x(), heading_rad).ok_or(Status::OutOfRange)?;
        *standing = SlungUav {
            position_world_m: [0.0; 3],
            velocity_world_m_s: [0.0; 3],
            quaternion_body_to_world: quaternion(&frames.attitude(&attitude)),
            body_rate_rad_s: [0.0; 3],
        };
        Ok(())
    };
    code(stand())
}

/// Makes a navigation filter that begins where the UAV is; see the header.
///
/// # Safety
/// `bytes` may be written to at `navigation`; the other pointers, if not null, point to what the
/// header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_navigation_create(
    navigation: *mut Instance,
    bytes: usize,
    parameters: *const Stored,
    settings: *const SlungNavigationSettings,
    number: u32,
    start: *const SlungUav,
    error: *mut SlungError,
) -> i32 {
    let create = || {
        if navigation.is_null() {
            return Err(Status::NullPointer);
        }
        if !navigation.is_aligned() {
            return Err(Status::Misaligned);
        }
        if bytes < size_of::<Instance>() {
            return Err(Status::TooSmall);
        }
        // SAFETY: the caller's promise.
        let (parameters, start) = unsafe { (shared(parameters)?.values()?, shared(start)?) };
        let told = if settings.is_null() {
            defaults()
        } else {
            // SAFETY: the caller's promise; numbers alone are in it.
            unsafe { read_sized(settings, defaults(), SlungNavigationSettings::SIZE)? }
        };
        let gravity = parameters.get(parameter!("VEH_G"));
        let Uav { position, velocity, attitude, body_rate } = uav(frames(number)?, start);
        let motion = Motion { position, velocity, attitude, body_rate, ..Motion::at_rest(Vector3::zeros(), gravity) };
        if !motion.is_usable() {
            return Err(Status::BadState);
        }
        let params = params(&told, parameters.get(parameter!("CTL_PERIOD")), gravity);
        let filter = Navigation::new(params, &motion, [told.start_position_m, told.start_velocity_m_s]).map_err(
            |OutOfRange { field, value, min, max }| {
                // SAFETY: the caller's promise.
                unsafe { tell(error, Status::OutOfRange, field_of(field), [value, min, max]) }
            },
        )?;
        // SAFETY: not null, aligned, and large enough by the caller's word. What was there needs no
        // drop.
        unsafe { navigation.write(Instance { created: CREATED, filter }) };
        Ok(())
    };
    code(create())
}

/// The header's fix as the filter's. Three numbers that are none say that it was not measured.
fn fix(frames: Frames, told: &SlungFix) -> Fix<f32> {
    let measured = |v: &[f32; 3]| (!v.iter().all(|c| c.is_nan())).then(|| frames.inertial(&Vector3::from(*v)));
    Fix {
        position: measured(&told.position_world_m),
        velocity: measured(&told.velocity_world_m_s),
        position_accuracy: told.position_deviation_m,
        velocity_accuracy: told.velocity_deviation_m_s,
        age: told.age_s,
    }
}

/// A fix of a satellite receiver; see the header.
///
/// # Safety
/// Pointers that are not null point to what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_navigation_fix(navigation: *mut Instance, number: u32, told: *const SlungFix) -> i32 {
    let take = || {
        // SAFETY: the caller's promise.
        let (instance, told) = unsafe { (exclusive(navigation)?, shared(told)?) };
        instance.filter()?.fix(&fix(frames(number)?, told)).map_err(refusal)?;
        Ok(())
    };
    code(take())
}

/// A pose by motion capture; see the header.
///
/// # Safety
/// As [`slung_navigation_fix`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_navigation_pose(
    navigation: *mut Instance,
    number: u32,
    told: *const SlungFix,
    quaternion_body_to_world: *const [f32; 4],
    attitude_deviation_rad: f32,
) -> i32 {
    let take = || {
        // SAFETY: the caller's promise.
        let (instance, told, quaternion) =
            unsafe { (exclusive(navigation)?, shared(told)?, optional(quaternion_body_to_world)?) };
        let frames = frames(number)?;
        let attitude = quaternion.map(|&quaternion| frames.attitude(&rotation(quaternion)));
        let attitude = attitude.as_ref().map(|attitude| (attitude, attitude_deviation_rad));
        instance.filter()?.pose(&fix(frames, told), attitude).map_err(refusal)?;
        Ok(())
    };
    code(take())
}

/// Height by pressure; see the header.
///
/// # Safety
/// As [`slung_navigation_fix`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_navigation_height(navigation: *mut Instance, height_up_m: f32) -> i32 {
    // SAFETY: the caller's promise.
    let take = || unsafe { exclusive(navigation)? }.filter()?.height(height_up_m).map_err(refusal);
    code(take())
}

/// Heading; see the header.
///
/// # Safety
/// As [`slung_navigation_fix`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_navigation_heading(navigation: *mut Instance, heading_rad: f32) -> i32 {
    // SAFETY: the caller's promise.
    let take = || unsafe { exclusive(navigation)? }.filter()?.heading(heading_rad).map_err(refusal);
    code(take())
}

/// The magnetic field; see the header.
///
/// # Safety
/// As [`slung_navigation_fix`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_navigation_magnetic_field(
    navigation: *mut Instance,
    number: u32,
    field_body: *const [f32; 3],
) -> i32 {
    let take = || {
        // SAFETY: the caller's promise.
        let (instance, field) = unsafe { (exclusive(navigation)?, shared(field_body)?) };
        let field = frames(number)?.body(&Vector3::from(*field));
        instance.filter()?.magnetic_field(&field).map_err(refusal)
    };
    code(take())
}

/// A period: the IMU's reading; see the header.
///
/// # Safety
/// As [`slung_navigation_fix`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_navigation_step(
    navigation: *mut Instance,
    number: u32,
    body_rate_rad_s: *const [f32; 3],
    specific_force_body_m_s2: *const [f32; 3],
    navigated: *mut SlungNavigated,
) -> i32 {
    let step = || {
        // SAFETY: the caller's promise.
        let filter = unsafe { exclusive(navigation)? }.filter()?;
        let frames = frames(number)?;
        // SAFETY: the caller's promise.
        let (target, rate, force) = unsafe {
            let target = Target::at(navigated, SlungNavigated::SIZE)?;
            (target, optional(body_rate_rad_s)?, optional(specific_force_body_m_s2)?)
        };
        let in_body = |v: &[f32; 3]| frames.body(&Vector3::from(*v));
        let imu =
            rate.zip(force).map(|(rate, force)| Imu { body_rate: in_body(rate), specific_force: in_body(force) });
        let motion = filter.step(imu.as_ref());
        let health = filter.health();
        let (gyro, accelerometer) = filter.biases();
        target.write(&SlungNavigated {
            struct_size: SlungNavigated::SIZE,
            blind: u32::from(health.is_blind),
            resets: u32::from(health.resets),
            fix_age_s: health.fix_age,
            position_deviation_m: health.position_deviation,
            velocity_deviation_m_s: health.velocity_deviation,
            tilt_deviation_rad: health.tilt_deviation,
            gyro_bias_body_rad_s: frames.body(&gyro).into(),
            accelerometer_bias_body_m_s2: frames.body(&accelerometer).into(),
            specific_force_body_m_s2: frames.body(&motion.specific_force).into(),
            uav: reported(frames, &motion),
        });
        Ok(())
    };
    code(step())
}
