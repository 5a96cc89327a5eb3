//! The functions of `slung.h` for a linker.
//!
//! The panic handler calls a function that nobody defines, so a program that links proves that no
//! panic can be reached.
#![no_std]

pub use capi::*;

unsafe extern "C" {
    safe fn slung_a_panic_is_reachable() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    slung_a_panic_is_reachable()
}
