//! What a call answers, and why parameters are refused.

use controller::{GainError, OutOfRange};
use rig::{Parameter, Parameters, SetupError};

use crate::pointer::{Sized32, write_sized};
use crate::types::SlungError;

/// The outcome of a call: zero, or negative and stable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// A pointer that must not be null is.
    NullPointer = -1,
    /// A pointer is not aligned for what it points to.
    Misaligned = -2,
    /// A structure's `struct_size` is smaller than the first version's.
    StructSize = -3,
    /// Too few bytes for an instance.
    TooSmall = -4,
    /// The memory holds no instance that `slung_create` or `slung_parameters_default` has made.
    NotCreated = -5,
    /// There is no parameter of this name or index.
    UnknownParameter = -6,
    /// A number is outside its range, or not a number.
    OutOfRange = -7,
    /// A parameter takes whole numbers alone.
    NotWhole = -8,
    /// The gains make no stable loop.
    UnstableGains = -9,
    /// A state, or a part of it, is not a number or outside any range.
    BadState = -10,
    /// An enumerator has none of its values.
    UnknownEnumerator = -11,
    /// Waypoints make no route: a leg is too short, or a turn too sharp.
    NoRoute = -12,
    /// A measurement is older than the filter remembers, or from the future.
    Late = -13,
    /// A measurement is too far off what is known.
    Outlier = -14,
    /// There is nothing to go on from, or to report on.
    NotNow = -15,
}

/// `Ok` as zero.
pub fn code(outcome: Result<(), Status>) -> i32 {
    match outcome {
        Ok(()) => Status::Ok as i32,
        Err(status) => status as i32,
    }
}

/// Tells `error`, where the caller wants to know, and answers its status.
///
/// # Safety
/// As [`write_sized`].
pub unsafe fn tell(target: *mut SlungError, status: Status, field: &str, numbers: [f32; 3]) -> Status {
    // SAFETY: the caller's promise.
    unsafe { tell_of(target, status, field, numbers, None) }
}

/// The same of a `waypoint`.
///
/// # Safety
/// As [`write_sized`].
pub unsafe fn tell_of(
    target: *mut SlungError,
    status: Status,
    field: &str,
    [value, min, max]: [f32; 3],
    waypoint: Option<usize>,
) -> Status {
    let mut error = SlungError {
        struct_size: SlungError::SIZE,
        status: status as i32,
        field: [0; SlungError::FIELD_BYTES],
        value,
        min,
        max,
        waypoint: waypoint.map_or(-1, |waypoint| waypoint as i32),
    };
    // The last byte stays zero.
    for (slot, byte) in error.field.iter_mut().take(SlungError::FIELD_BYTES - 1).zip(field.bytes()) {
        *slot = byte;
    }
    if !target.is_null() {
        // SAFETY: the caller's promise. What can't be told leaves the status, which says so.
        let _ = unsafe { write_sized(target, &error, SlungError::SIZE) };
    }
    status
}

/// Why no controller was made of `parameters`: status, field, and value, least and largest.
pub fn setup(error: &SetupError<f32>, parameters: &Parameters<f32>) -> (Status, &'static str, [f32; 3]) {
    let of_output =
        |names: &[&'static str; 4], output: usize| names.get(output.wrapping_sub(1)).copied().unwrap_or("K1_0");
    match *error {
        SetupError::Range(OutOfRange { field, value, min, max }) => (Status::OutOfRange, field, [value, min, max]),
        SetupError::Gains(GainError::Integral { output, value, limit }) => {
            (Status::UnstableGains, of_output(&["KI_1", "KI_2", "KI_3", "KI_3"], output), [value, 0.0, limit])
        }
        SetupError::Gains(GainError::NotHurwitz { output }) => {
            let name = of_output(&["K1_0", "K2_0", "K3_0", "K4_0"], output);
            let value = Parameter::find(name).map_or(0.0, |parameter| parameters.get(parameter));
            (Status::UnstableGains, name, [value, 0.0, f32::MAX])
        }
        SetupError::Gains(_) => (Status::UnstableGains, "K1_0", [0.0; 3]),
    }
}
