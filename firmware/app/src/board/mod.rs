//! The seam between the program and a board: what a board's file has to bring.
//!
//! Another board is another file here, a memory map, a feature and three lines below. Each file has
//!
//! - `pac`: interrupts `TIM2` (control), `USART1` (link) and `SPI1` (free, for the program's own
//!   use);
//! - the types `Timer`, `RotorOutputs`, `SerialPort`, `StatusLed`, `KillPin`, `Memory` and `Dog`, with
//!   the traits below;
//! - `start`, `stop_rotors` (in any state, interrupts off) and `reset`.

use autopilot::{Boot, NotKept, Settings, Store};
use embedded_hal::pwm::SetDutyCycle;

#[cfg(feature = "mps2")]
mod mps2;
#[cfg(feature = "stm32f405")]
mod stm32f405;
#[cfg(feature = "stm32h743")]
mod stm32h743;

#[cfg(feature = "mps2")]
pub use mps2::*;
#[cfg(feature = "stm32f405")]
pub use stm32f405::*;
#[cfg(feature = "stm32h743")]
pub use stm32h743::*;

/// A board that has started: clocks up, watchdog running, rotors off.
pub struct Board {
    /// What was found out at the start.
    pub boot: Boot,
    /// The control timer, not yet set.
    pub timer: Timer,
    /// The rotors' outputs.
    pub rotors: RotorOutputs,
    /// The link.
    pub serial: SerialPort,
    /// The status LED.
    pub led: StatusLed,
    /// The kill pin.
    pub kill: KillPin,
    /// The parameters as they were kept, and what keeps them, where there is something.
    pub settings: Settings,
    /// The same.
    pub store: Result<Store<Memory>, NotKept>,
    /// The watchdog, running.
    pub watchdog: Dog,
}

/// Interrupts once a control period.
pub trait ControlTimer {
    /// Starts it, or changes its period, s.
    fn set_period(&mut self, seconds: f32);
    /// Whether a period has begun since the last call.
    fn take_tick(&mut self) -> bool;
    /// The same without taking it: in the control step, that the step was too long.
    fn is_due(&self) -> bool;
}

/// Rotors' outputs.
pub trait Rotors {
    /// Commands from 0 to 1: front right, rear left, front left, rear right.
    fn set(&mut self, commands: [f32; 4]);
}

/// The link's bytes. No call waits.
pub trait Serial {
    /// A byte that has come.
    fn receive(&mut self) -> Option<u8>;
    /// Takes a byte to send, if there is room for it.
    fn send(&mut self, byte: u8) -> bool;
    /// Whether the interrupt has to come once there is room again.
    fn wake_when_free(&mut self, wanted: bool);
    /// Bytes lost since the last call.
    fn take_lost(&mut self) -> u32;
}

/// The status LED.
pub trait Led {
    /// On if it was off.
    fn toggle(&mut self);
}

/// The pin that stops the rotors, pulled down: a broken wire stops nothing.
pub trait Kill {
    /// Whether it is high.
    fn is_high(&self) -> bool;
}

/// The parameters in `memory`, the memory to keep others in, or why there is none. Before the
/// watchdog: it may erase, for seconds.
#[cfg_attr(not(feature = "stm32f405"), allow(dead_code))]
pub fn recall(memory: Memory) -> (Settings, Result<Store<Memory>, NotKept>) {
    let mut settings = Settings::default();
    let store = Store::open(memory, &mut settings).map_err(NotKept::from);
    (settings, store)
}

/// Of a board that keeps no parameters.
#[cfg(not(feature = "stm32f405"))]
pub struct NoMemory(());

#[cfg(not(feature = "stm32f405"))]
impl autopilot::Flash for NoMemory {
    const RECORDS: usize = 0;

    fn read(&self, _: usize, _: usize) -> [u8; autopilot::RECORD] {
        [0xFF; autopilot::RECORD]
    }

    fn write(&mut self, _: usize, _: usize, _: &[u8; autopilot::RECORD]) -> Result<(), autopilot::FlashFault> {
        Err(autopilot::FlashFault)
    }

    fn erase(&mut self, _: usize) -> Result<(), autopilot::FlashFault> {
        Err(autopilot::FlashFault)
    }
}

/// Knots of a mission's route, 60 bytes each: a third of the memory that data and stack share, so
/// that the stack has 50 KB for making a controller and laying a route.
#[cfg(any(feature = "stm32f405", feature = "stm32h743"))]
pub const KNOTS: usize = 640;

/// Resets the board when it is not fed for half a second.
pub trait Watchdog {
    /// Puts the reset off.
    fn feed(&mut self);
}

/// The longest control period is 0.2 s.
#[cfg(any(feature = "stm32f405", feature = "stm32h743"))]
pub const WATCHDOG_MS: u32 = 500;

/// Runs the link's interrupt.
pub fn pend_link() {
    rtic::pend(pac::Interrupt::USART1);
}

/// Runs the control interrupt.
pub fn pend_control() {
    rtic::pend(pac::Interrupt::TIM2);
}

/// Pulses of a speed controller's signal, Hz: as many as its 1 to 2 ms allow.
#[cfg(any(feature = "stm32f405", feature = "stm32h743"))]
pub const PULSE_RATE_HZ: u32 = 400;

/// A pulse of 1 ms (stop) to 2 ms (full).
#[cfg_attr(not(feature = "stm32f405"), allow(dead_code))]
pub fn set_pulse(output: &mut impl SetDutyCycle, command: f32) {
    const FULL: f32 = 0.002 * 400.0;
    const STOP: f32 = 0.001 * 400.0;
    let share = STOP + (FULL - STOP) * command.clamp(0.0, 1.0);
    // A NaN stops the rotor.
    let share = if share >= STOP { share } else { STOP };
    let ticks = (share * f32::from(output.max_duty_cycle())) as u16;
    let _ = output.set_duty_cycle(ticks);
}
