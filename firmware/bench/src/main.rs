//! Runs every case of [`cases`] on the target, and prints for each what one step costs:
//! instructions, stack, state.
//!
//! It is also the proof that a step can't panic: the panic handler calls a function that doesn't
//! exist, so an image with a reachable panic doesn't link.
#![no_std]
#![no_main]

mod console;
mod probe;

use cases::{Case, Visitor};
use console::Console;
use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};
use probe::Probe;

/// What the fastest, the slowest and the deepest of the steps took, and all of them.
struct Extremes {
    best: u32,
    worst: u32,
    stack: u32,
    /// Of all steps together, and how many there were.
    total: u64,
    steps: u64,
}

struct Bench {
    probe: Probe,
    console: Console,
    states: usize,
}

impl Visitor for Bench {
    fn visit<C: Case>(&mut self, name: &str, case: Option<C>) {
        if !C::IS_STEP && self.states < cases::STATES {
            return;
        }
        let Some(mut case) = case else {
            self.console.field("refused", name);
            self.console.end();
            return;
        };
        let mut extremes = Extremes { best: u32::MAX, worst: 0, stack: 0, total: 0, steps: 0 };
        let digest = cases::exercise(&mut case, self.states, |case, state| {
            let (output, cost) = self.probe.measure(step::<C>, case, state);
            extremes.best = extremes.best.min(cost.instructions);
            extremes.worst = extremes.worst.max(cost.instructions);
            extremes.stack = extremes.stack.max(cost.stack_bytes);
            extremes.total += u64::from(cost.instructions);
            extremes.steps += 1;
            output
        });
        self.console.field("case", name);
        self.console.number("entry", step::<C> as *const () as u64);
        self.console.number("best", extremes.best.into());
        self.console.number("worst", extremes.worst.into());
        self.console.number("total", extremes.total);
        self.console.number("steps", extremes.steps);
        self.console.number("stack", extremes.stack.into());
        self.console.number("ram", size_of::<C>() as u64);
        self.console.number("digest", digest.value());
        self.console.end();
    }
}

/// The step as the measurement calls it: the root of the call graph whose code and stack are
/// counted.
// Its callers are this image's own, so its result's layout is as good as any.
#[allow(improper_ctypes_definitions)]
#[inline(never)]
extern "C" fn step<C: Case>(case: &mut C, state: &C::State) -> C::Output {
    case.step(state)
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let status = match (Console::open(), Probe::start()) {
        (Some(console), Some(probe)) => {
            // Where the emulator logs every instruction, all states would take too long.
            let states = if console::is_command_line(b"few") { cases::FEW } else { cases::STATES };
            let mut bench = Bench { probe, console, states };
            cases::visit_all(&mut bench);
            bench.console.number("roots", cases::roots().value());
            bench.console.end();
            EXIT_SUCCESS
        }
        _ => EXIT_FAILURE,
    };
    loop {
        debug::exit(status);
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    #[cfg(not(feature = "reachable-panics"))]
    {
        unsafe extern "C" {
            safe fn a_panic_is_reachable() -> !;
        }
        a_panic_is_reachable()
    }
    #[cfg(feature = "reachable-panics")]
    loop {
        debug::exit(EXIT_FAILURE);
    }
}
