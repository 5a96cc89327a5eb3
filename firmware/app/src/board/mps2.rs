//! The emulated boards mps2-an386 (Cortex-M4F) and mps2-an500 (Cortex-M7): the link on UART0, the
//! control timer TIMER0.
//!
//! There are no rotors, LED or watchdog. Register names are those of Arm's CMSDK (DDI 0479).

use autopilot::{Boot, NotKept, Settings};

use super::{Board, ControlTimer, Kill, Led, NoMemory, Rotors, Serial, Watchdog};

/// Core and peripheral clock, Hz.
const CLOCK_HZ: u32 = 25_000_000;

/// What a peripheral access crate would bring. The application knows its interrupts by the names
/// that the STM32 give them.
pub mod pac {
    /// Priority bits the interrupt controller has.
    pub const NVIC_PRIO_BITS: u8 = 3;

    /// The interrupts in use.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[repr(u16)]
    pub enum Interrupt {
        /// UART0, received.
        USART1 = 0,
        /// UART0, sent; unused under that meaning.
        SPI1 = 1,
        /// TIMER0.
        TIM2 = 8,
    }

    pub use Interrupt as interrupt;

    // SAFETY: each variant is the number of its interrupt, fixed.
    unsafe impl cortex_m::interrupt::InterruptNumber for Interrupt {
        fn number(self) -> u16 {
            self as u16
        }
    }

    unsafe extern "C" {
        fn USART1();
        fn SPI1();
        fn TIM2();
    }

    /// An entry of the vector table.
    #[derive(Clone, Copy)]
    pub union Vector {
        handler: unsafe extern "C" fn(),
        reserved: u32,
    }

    /// The vectors after the core's own.
    #[unsafe(link_section = ".vector_table.interrupts")]
    #[unsafe(no_mangle)]
    pub static __INTERRUPTS: [Vector; 9] = {
        let mut vectors = [Vector { reserved: 0 }; 9];
        vectors[Interrupt::USART1 as usize] = Vector { handler: USART1 };
        vectors[Interrupt::SPI1 as usize] = Vector { handler: SPI1 };
        vectors[Interrupt::TIM2 as usize] = Vector { handler: TIM2 };
        vectors
    };
}

/// A block of registers at a fixed place.
#[derive(Clone, Copy)]
struct Registers(usize);

impl Registers {
    fn read(self, offset: usize) -> u32 {
        // SAFETY: the addresses below are of this board's peripherals, whose registers may be read
        // at any time.
        unsafe { ((self.0 + offset) as *const u32).read_volatile() }
    }

    fn write(self, offset: usize, value: u32) {
        // SAFETY: as above, and each block has one owner.
        unsafe { ((self.0 + offset) as *mut u32).write_volatile(value) }
    }
}

const TIMER0: Registers = Registers(0x4000_0000);
const UART0: Registers = Registers(0x4000_4000);

/// TIMER0.
pub struct Timer(());

impl Timer {
    const CTRL: usize = 0;
    const VALUE: usize = 4;
    const RELOAD: usize = 8;
    const INTERRUPT: usize = 12;
}

impl ControlTimer for Timer {
    fn set_period(&mut self, seconds: f32) {
        let reload = (seconds * CLOCK_HZ as f32) as u32 - 1;
        TIMER0.write(Self::RELOAD, reload);
        TIMER0.write(Self::VALUE, reload);
        // Enabled, with interrupt.
        TIMER0.write(Self::CTRL, 0b1001);
    }

    fn take_tick(&mut self) -> bool {
        let due = self.is_due();
        if due {
            TIMER0.write(Self::INTERRUPT, 1);
        }
        due
    }

    fn is_due(&self) -> bool {
        TIMER0.read(Self::INTERRUPT) & 1 != 0
    }
}

/// UART0.
pub struct SerialPort {
    lost: u32,
}

impl SerialPort {
    const DATA: usize = 0;
    const STATE: usize = 4;
    const CTRL: usize = 8;
    const INTERRUPT: usize = 12;
    const BAUDDIV: usize = 16;
}

impl Serial for SerialPort {
    fn receive(&mut self) -> Option<u8> {
        // Before the state is read, so that a byte that comes after has its interrupt.
        UART0.write(Self::INTERRUPT, 0b10);
        let state = UART0.read(Self::STATE);
        if state & 0b1000 != 0 {
            self.lost = self.lost.wrapping_add(1);
            UART0.write(Self::STATE, 0b1000);
        }
        if state & 0b10 == 0 {
            return None;
        }
        Some(UART0.read(Self::DATA) as u8)
    }

    fn send(&mut self, byte: u8) -> bool {
        let free = UART0.read(Self::STATE) & 1 == 0;
        if free {
            UART0.write(Self::DATA, byte.into());
        }
        free
    }

    fn wake_when_free(&mut self, wanted: bool) {
        if wanted {
            // Its own interrupt for this is another vector; the emulator's line is free again at
            // once.
            super::pend_link();
        }
    }

    fn take_lost(&mut self) -> u32 {
        core::mem::take(&mut self.lost)
    }
}

/// No rotors: commands go nowhere.
pub struct RotorOutputs(());

impl Rotors for RotorOutputs {
    fn set(&mut self, _: [f32; 4]) {}
}

/// No LED.
pub struct StatusLed(());

impl Led for StatusLed {
    fn toggle(&mut self) {}
}

/// No kill pin.
pub struct KillPin(());

impl Kill for KillPin {
    fn is_high(&self) -> bool {
        false
    }
}

/// Knots of a mission's route.
pub const KNOTS: usize = 8192;

/// No memory for parameters.
pub type Memory = NoMemory;

/// No watchdog.
pub struct Dog(());

impl Watchdog for Dog {
    fn feed(&mut self) {}
}

/// Starts the link's port.
pub fn start() -> Board {
    UART0.write(SerialPort::BAUDDIV, CLOCK_HZ / 921_600);
    // Transmitter, receiver, interrupt on receiving.
    UART0.write(SerialPort::CTRL, 0b1011);
    Board {
        boot: Boot { core_hz: CLOCK_HZ, ..Boot::default() },
        timer: Timer(()),
        rotors: RotorOutputs(()),
        serial: SerialPort { lost: 0 },
        led: StatusLed(()),
        kill: KillPin(()),
        settings: Settings::default(),
        store: Err(NotKept::NoMemory),
        watchdog: Dog(()),
    }
}

/// This board has no rotors.
pub fn stop_rotors() {}

/// Resets the core at once.
pub fn reset() -> ! {
    cortex_m::peripheral::SCB::sys_reset()
}
