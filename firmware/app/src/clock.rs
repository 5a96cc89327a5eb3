//! Time since the start in core cycles, by SysTick: unlike the cycle counter of the debug unit,
//! emulators have it too.

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

/// SysTick counts down through 24 bits.
const WRAP: u32 = 1 << 24;

static WRAPS: AtomicU32 = AtomicU32::new(0);
static REPORTED: AtomicU32 = AtomicU32::new(0);
static CORE_HZ: AtomicU32 = AtomicU32::new(1);

/// Starts the counter on a core clock of `core_hz`.
pub fn start(mut syst: SYST, core_hz: u32) {
    CORE_HZ.store(core_hz.max(1), Ordering::Relaxed);
    syst.set_clock_source(SystClkSource::Core);
    syst.set_reload(WRAP - 1);
    syst.clear_current();
    syst.enable_counter();
    syst.enable_interrupt();
}

/// To be called once a wrap; true about once a second.
pub fn wrap() -> bool {
    let wraps = WRAPS.load(Ordering::Relaxed).wrapping_add(1);
    WRAPS.store(wraps, Ordering::Relaxed);
    let a_second = CORE_HZ.load(Ordering::Relaxed).div_ceil(WRAP);
    let due = wraps.wrapping_sub(REPORTED.load(Ordering::Relaxed)) >= a_second;
    if due {
        REPORTED.store(wraps, Ordering::Relaxed);
    }
    due
}

/// Nanoseconds since the start. Below the counter's interrupt in priority, it may be a wrap behind
/// for an instant.
pub fn now_ns() -> u64 {
    let wraps = WRAPS.load(Ordering::Relaxed);
    let cycles = u64::from(wraps) * u64::from(WRAP) + u64::from(WRAP - 1 - SYST::get_current());
    let core_hz = u64::from(CORE_HZ.load(Ordering::Relaxed));
    cycles / core_hz * 1_000_000_000 + cycles % core_hz * 1_000_000_000 / core_hz
}

/// A reading of the counter.
#[derive(Clone, Copy)]
pub struct Clock(u32);

impl Clock {
    /// Now.
    pub fn now() -> Self {
        Self(SYST::get_current())
    }

    /// Cycles since, of less than one wrap.
    pub fn elapsed(self) -> u32 {
        self.0.wrapping_sub(SYST::get_current()) % WRAP
    }
}
