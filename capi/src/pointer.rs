//! From a caller's pointers to references, once and in one place.

use core::mem::size_of;

use crate::status::Status;

/// What `pointer` points to.
///
/// # Errors
/// [`Status::NullPointer`], [`Status::Misaligned`].
///
/// # Safety
/// If it is neither null nor misaligned, it points to a `T` that nobody writes to during the call.
pub unsafe fn shared<'a, T>(pointer: *const T) -> Result<&'a T, Status> {
    if pointer.is_null() {
        return Err(Status::NullPointer);
    }
    if !pointer.is_aligned() {
        return Err(Status::Misaligned);
    }
    // SAFETY: not null and aligned; the rest is the caller's promise.
    Ok(unsafe { &*pointer })
}

/// What `pointer` points to, if it is not null.
///
/// # Errors
/// [`Status::Misaligned`].
///
/// # Safety
/// As [`shared`].
pub unsafe fn optional<'a, T>(pointer: *const T) -> Result<Option<&'a T>, Status> {
    if pointer.is_null() {
        return Ok(None);
    }
    // SAFETY: the caller's promise.
    unsafe { shared(pointer) }.map(Some)
}

/// What `pointer` points to, to be written to.
///
/// # Errors
/// As [`shared`].
///
/// # Safety
/// If it is neither null nor misaligned, it points to a `T` that nobody else touches during the
/// call.
pub unsafe fn exclusive<'a, T>(pointer: *mut T) -> Result<&'a mut T, Status> {
    if pointer.is_null() {
        return Err(Status::NullPointer);
    }
    if !pointer.is_aligned() {
        return Err(Status::Misaligned);
    }
    // SAFETY: not null and aligned; the rest is the caller's promise.
    Ok(unsafe { &mut *pointer })
}

/// A structure that begins with its size, so that it can grow at its end.
///
/// # Safety
/// The first field is a `u32`.
pub unsafe trait Sized32: Copy {
    /// Its bytes.
    const SIZE: u32 = size_of::<Self>() as u32;
}

/// Where a caller has room for a structure that begins with its size. Taken before anything is done
/// that an answer belongs to, so that a call without room for its answer does nothing.
pub struct Target<T> {
    pointer: *mut T,
    room: u32,
}

impl<T: Sized32> Target<T> {
    /// The room at `pointer`.
    ///
    /// # Errors
    /// [`Status::NullPointer`], [`Status::Misaligned`], and [`Status::StructSize`] where the
    /// caller's size is smaller than the first version's, `least`.
    ///
    /// # Safety
    /// If it is neither null nor misaligned, the first four bytes hold how many bytes may be written
    /// there until the target is.
    pub unsafe fn at(pointer: *mut T, least: u32) -> Result<Self, Status> {
        if pointer.is_null() {
            return Err(Status::NullPointer);
        }
        if !pointer.is_aligned() {
            return Err(Status::Misaligned);
        }
        // SAFETY: the caller's promise, and the trait's: the first field is a u32.
        let room = unsafe { pointer.cast::<u32>().read() };
        if room < least { Err(Status::StructSize) } else { Ok(Self { pointer, room }) }
    }

    /// Writes as much of `value` as the caller's header knows of.
    pub fn write(self, value: &T) {
        let Self { pointer, room } = self;
        let bytes = room.min(T::SIZE) as usize;
        // SAFETY: `room` bytes may be written there by what `at` was promised, and `bytes` is at
        // most that and at most the value's size.
        unsafe {
            core::ptr::copy_nonoverlapping(core::ptr::from_ref(value).cast::<u8>(), pointer.cast::<u8>(), bytes);
            pointer.cast::<u32>().write(room);
        }
    }
}

/// Writes `value` where a caller has room for it, where nothing else is done.
///
/// # Errors
/// As [`Target::at`].
///
/// # Safety
/// As [`Target::at`].
pub unsafe fn write_sized<T: Sized32>(target: *mut T, value: &T, least: u32) -> Result<(), Status> {
    // SAFETY: the caller's promise.
    unsafe { Target::at(target, least)? }.write(value);
    Ok(())
}

/// What a caller says in a structure that begins with its size, and `default` in the fields that
/// the caller's header did not know of.
///
/// # Errors
/// As [`write_sized`].
///
/// # Safety
/// As [`write_sized`], for reading; any bits make a `T`.
pub unsafe fn read_sized<T: Sized32>(source: *const T, default: T, least: u32) -> Result<T, Status> {
    // SAFETY: the caller's promise, and the trait's: the first field is a u32.
    let room = *unsafe { shared(source.cast::<u32>())? };
    if !source.is_aligned() {
        return Err(Status::Misaligned);
    }
    if room < least {
        return Err(Status::StructSize);
    }
    let (mut value, bytes) = (default, room.min(T::SIZE) as usize);
    // SAFETY: `room` bytes may be read there, and `bytes` is at most that and at most the value's
    // size.
    unsafe { core::ptr::copy_nonoverlapping(source.cast::<u8>(), (&raw mut value).cast::<u8>(), bytes) };
    Ok(value)
}
