//! What one call costs: instructions by the SysTick timer, stack by painting.
//!
//! Under QEMU's `-icount shift=7` an instruction lasts 2^7 ns of virtual time, 3.2 ticks of the 25
//! MHz SysTick of the mps2 boards: more than a tick an instruction, so that the difference of two
//! readings, wrong by at most one tick, names their number exactly.

use core::arch::asm;
use core::mem::MaybeUninit;
use cortex_m::peripheral::{SYST, syst::SystClkSource};

/// Ticks of one instruction: 128 ns · 25 MHz = 16/5.
const TICKS: (u32, u32) = (16, 5);
/// SysTick counts down through 24 bits.
const COUNTER: u32 = 0x00FF_FFFF;
/// A word that no computation is likely to leave on the stack: as a float, a NaN with a payload.
const PAINT: u32 = 0x7FA5_C3E1;
/// How far down the stack is painted, words: four times what a step may take.
const PAINTED: usize = 2048;

/// The cost of one call.
pub struct Cost {
    /// Beyond those of calling an empty function.
    pub instructions: u32,
    /// Below the caller's stack pointer.
    pub stack_bytes: u32,
}

/// A running instruction counter.
pub struct Probe {
    overhead: u32,
}

/// A call to be measured: reads and changes `A`, reads `B`, and returns a `C` of more than four
/// words, which the calling convention has it write where the first register points.
pub type Call<A, B, C> = extern "C" fn(&mut A, &B) -> C;

/// Nothing but the return.
#[unsafe(naked)]
extern "C" fn nothing(_: &mut (), _: &()) -> [u32; 5] {
    core::arch::naked_asm!("bx lr")
}

impl Probe {
    /// Starts the counter and takes the cost of an empty call, which every measurement then leaves
    /// out. `None` if the counter doesn't count.
    pub fn start() -> Option<Self> {
        // SAFETY: the only code of this image that touches a peripheral, and it runs once.
        let mut timer = unsafe { cortex_m::Peripherals::steal() }.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(COUNTER);
        timer.clear_current();
        timer.enable_counter();
        let (_, empty) = Self { overhead: 0 }.measure(nothing, &mut (), &());
        // A load, the call and the return; anything else means that the clock is not the one
        // reckoned with.
        (empty.instructions == 3).then_some(Self { overhead: empty.instructions })
    }

    /// Calls `f` and returns what it wrote, and its cost.
    #[inline(never)]
    pub fn measure<A, B, C>(&self, f: Call<A, B, C>, a: &mut A, b: &B) -> (C, Cost) {
        let mut output = MaybeUninit::<C>::zeroed();
        let paint = paint();
        let (start, end, sp): (u32, u32, usize);
        const { assert!(size_of::<C>() > 16) };
        // SAFETY: a call of an extern "C" function with its result's and its arguments' pointers,
        // all of them live; the clobbers are those of the calling convention, and what outlives the
        // call is declared an early output, so kept out of them.
        unsafe {
            asm!(
                "mov r4, sp",
                "ldr r5, [r8]",
                "blx r3",
                "ldr r8, [r8]",
                out("r4") sp,
                out("r5") start,
                inout("r8") &raw const (*SYST::PTR).cvr => end,
                inlateout("r0") &raw mut output => _,
                inlateout("r1") &raw mut *a => _,
                inlateout("r2") &raw const *b => _,
                inlateout("r3") f => _,
                out("r12") _, out("lr") _,
                out("d0") _, out("d1") _, out("d2") _, out("d3") _,
                out("d4") _, out("d5") _, out("d6") _, out("d7") _,
            );
        }
        let ticks = start.wrapping_sub(end) & COUNTER;
        let instructions = (ticks * TICKS.1 + TICKS.0 / 2) / TICKS.0;
        let stack_bytes = sp.saturating_sub(lowest_touched(paint)) as u32;
        // SAFETY: every `Call` writes its result, and all zeros is what the empty one's is.
        let output = unsafe { output.assume_init() };
        (output, Cost { instructions: instructions - self.overhead, stack_bytes })
    }
}

/// Paints the free stack below this call's frame; returns the lowest painted address.
#[inline(always)]
fn paint() -> usize {
    let sp: usize;
    // SAFETY: reads one register.
    unsafe { asm!("mov {}, sp", out(reg) sp, options(nomem, nostack, preserves_flags)) };
    let bottom = sp - 4 * PAINTED;
    for word in 0..PAINTED {
        // SAFETY: below the stack pointer and far above the statics (4 MiB of RAM) lies nothing; no
        // interrupt is enabled.
        unsafe { ((bottom + 4 * word) as *mut u32).write_volatile(PAINT) };
    }
    bottom
}

/// The lowest address from `bottom` up that no longer holds the paint.
#[inline(always)]
fn lowest_touched(bottom: usize) -> usize {
    let mut address = bottom;
    // SAFETY: ends at the latest in this call's own frame.
    while unsafe { (address as *const u32).read_volatile() } == PAINT {
        address += 4;
    }
    address
}
