//! The named numbers that a controller is made of.

use core::ffi::c_char;
use core::mem::size_of;

use rig::{COUNT, Parameter, Parameters, Refused};

use crate::pointer::{Sized32, exclusive, shared, write_sized};
use crate::status::{Status, code, tell};
use crate::types::{SlungError, SlungParameter};

/// Written by [`slung_parameters_default`]; anything else is memory in which no parameters are.
const CREATED: u32 = 0x51A6_7A81;

/// `slung_parameters`: the caller's memory holds this.
#[derive(Clone)]
#[repr(C, align(8))]
pub struct Stored {
    created: u32,
    values: Parameters<f32>,
}

/// Bytes in the header's `slung_parameters`; a test compares.
pub const BYTES: usize = 1024;
const _: () = assert!(size_of::<Stored>() <= BYTES);

impl Stored {
    /// The values.
    ///
    /// # Errors
    /// [`Status::NotCreated`].
    pub fn values(&self) -> Result<&Parameters<f32>, Status> {
        if self.created == CREATED { Ok(&self.values) } else { Err(Status::NotCreated) }
    }
}

/// How many bytes parameters take, at most the size of `slung_parameters`.
#[unsafe(no_mangle)]
pub extern "C" fn slung_parameters_bytes() -> usize {
    size_of::<Stored>()
}

/// All parameters at their defaults.
///
/// # Safety
/// `bytes` may be written to at `parameters`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_parameters_default(parameters: *mut Stored, bytes: usize) -> i32 {
    if parameters.is_null() {
        return Status::NullPointer as i32;
    }
    if !parameters.is_aligned() {
        return Status::Misaligned as i32;
    }
    if bytes < size_of::<Stored>() {
        return Status::TooSmall as i32;
    }
    // SAFETY: not null, aligned, and large enough by the caller's word. What was there is nothing
    // that would have to be dropped.
    unsafe { parameters.write(Stored { created: CREATED, values: Parameters::default() }) };
    Status::Ok as i32
}

/// How many parameters there are.
#[unsafe(no_mangle)]
pub extern "C" fn slung_parameter_count() -> u32 {
    COUNT as u32
}

/// The name, unit, default, range and meaning of a parameter, by its place in the table.
///
/// # Safety
/// `info`, if not null, points to a `slung_parameter` whose `struct_size` is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_parameter_info(index: u32, info: *mut SlungParameter) -> i32 {
    let describe = || {
        let parameter = Parameter::at(index as usize).ok_or(Status::UnknownParameter)?;
        let (entry, default_value) = Parameters::<f32>::entry(parameter).ok_or(Status::UnknownParameter)?;
        let described = SlungParameter {
            struct_size: SlungParameter::SIZE,
            default_value,
            min: entry.min,
            max: entry.max,
            name: text(entry.name.as_str()),
            unit: text(entry.unit),
            text: text(entry.text),
        };
        // SAFETY: the caller's promise.
        unsafe { write_sized(info, &described, SlungParameter::SIZE) }
    };
    code(describe())
}

/// `text` and zeros; cut so that one is left.
fn text<const N: usize>(text: &str) -> [u8; N] {
    let mut bytes = [0; N];
    for (slot, byte) in bytes.iter_mut().take(N.saturating_sub(1)).zip(text.bytes()) {
        *slot = byte;
    }
    bytes
}

/// The parameter of a C string. It is read to its zero, or as far as the longest name goes.
///
/// # Safety
/// `name`, if not null, is ended by a zero.
unsafe fn named(name: *const c_char) -> Result<Parameter, Status> {
    if name.is_null() {
        return Err(Status::NullPointer);
    }
    let mut text = [0; 17];
    for (offset, slot) in text.iter_mut().enumerate() {
        // SAFETY: the caller's promise, as no byte before this one was the zero.
        *slot = unsafe { name.cast::<u8>().add(offset).read() };
        if *slot == 0 {
            break;
        }
    }
    (0..slung_parameter_count() as usize)
        .filter_map(Parameter::at)
        .find(|&parameter| {
            Parameters::<f32>::entry(parameter).is_some_and(|(entry, _)| {
                entry.name.as_str().bytes().chain(core::iter::repeat(0)).zip(text).all(|(a, b)| a == b)
            })
        })
        .ok_or(Status::UnknownParameter)
}

/// Sets a parameter. Refused, it keeps its value, and `error` (which may be null) tells why.
///
/// # Safety
/// Pointers that are not null point to what the header says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_parameters_set(
    parameters: *mut Stored,
    name: *const c_char,
    value: f32,
    error: *mut SlungError,
) -> i32 {
    let set = || {
        // SAFETY: the caller's promise.
        let stored = unsafe { exclusive(parameters)? };
        stored.values()?;
        // SAFETY: the caller's promise.
        let parameter = unsafe { named(name)? };
        stored.values.set(parameter, value).map_err(|refused| {
            let (status, range) = match refused {
                Refused::Unknown => return Status::UnknownParameter,
                Refused::OutOfRange(entry, value) => (Status::OutOfRange, (entry, [value, entry.min, entry.max])),
                Refused::NotWhole(entry, value) => (Status::NotWhole, (entry, [value, entry.min, entry.max])),
            };
            // SAFETY: the caller's promise.
            unsafe { tell(error, status, range.0.name.as_str(), range.1) }
        })
    };
    code(set())
}

/// Reads a parameter.
///
/// # Safety
/// As [`slung_parameters_set`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn slung_parameters_get(
    parameters: *const Stored,
    name: *const c_char,
    value: *mut f32,
) -> i32 {
    let get = || {
        // SAFETY: the caller's promise.
        let (stored, value) = unsafe { (shared(parameters)?, exclusive(value)?) };
        // SAFETY: the caller's promise.
        *value = stored.values()?.get(unsafe { named(name)? });
        Ok(())
    };
    code(get())
}
