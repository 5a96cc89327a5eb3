//! STM32H743 (Cortex-M7), as on ST's NUCLEO-H743ZI2 (clock 8 MHz from its programmer or a crystal,
//! LED on PB0).
//!
//! | function | pins |
//! |---|---|
//! | rotors front right, rear left, front left, rear right | PA6, PC7, PC8, PC9 (TIM3, 400 Hz, 1 to 2 ms) |
//! | link, 921,600 baud 8N1 | PB6 out, PB7 in (USART1) |
//! | status LED | PB0 |
//! | kill: high stops the rotors | PC13 (its user button) |
//!
//! Parameters are not kept.
//!
//! Its HAL knows embedded-hal 0.2 only; [`Pulse`] is the step to 1.0.

use core::convert::Infallible;
use core::sync::atomic::{AtomicU32, Ordering};
use core::time::Duration;

use autopilot::{Boot, NotKept, Settings};
use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use stm32h7xx_hal::gpio::{Input, Output, Pin};
use stm32h7xx_hal::hal::PwmPin;
use stm32h7xx_hal::hal::serial::{Read, Write};
use stm32h7xx_hal::independent_watchdog::IndependentWatchdog;
pub use stm32h7xx_hal::pac;
use stm32h7xx_hal::prelude::*;
use stm32h7xx_hal::pwm::{ComplementaryImpossible, Pwm};
use stm32h7xx_hal::rcc::ResetReason;
use stm32h7xx_hal::serial::{Rx, Tx};
use stm32h7xx_hal::timer::{Event, Timer as HalTimer};

use super::{
    Board, ControlTimer, Kill, Led, NoMemory, PULSE_RATE_HZ, Rotors, Serial, WATCHDOG_MS, Watchdog, set_pulse,
};

const CRYSTAL_MHZ: u32 = 8;
const CORE_MHZ: u32 = 400;
const BAUD: u32 = 921_600;
/// How often a ready bit is looked at: some 20 ms on the internal oscillator, where a crystal
/// takes 2.
const PATIENCE: u32 = 100_000;

/// TIM2.
pub struct Timer(HalTimer<pac::TIM2>);

impl ControlTimer for Timer {
    fn set_period(&mut self, seconds: f32) {
        self.0.set_timeout(Duration::from_micros((seconds * 1e6) as u64));
        // From now on, and not from the end of the old period.
        self.0.apply_freq();
    }

    fn take_tick(&mut self) -> bool {
        let due = self.is_due();
        if due {
            self.0.clear_irq();
        }
        due
    }

    fn is_due(&self) -> bool {
        // SAFETY: reads a status bit, without effect.
        unsafe { &*pac::TIM2::ptr() }.sr.read().uif().bit_is_set()
    }
}

/// A channel of TIM3.
pub struct Pulse<const C: u8>(Pwm<pac::TIM3, C, ComplementaryImpossible>);

impl<const C: u8> ErrorType for Pulse<C> {
    type Error = Infallible;
}

impl<const C: u8> SetDutyCycle for Pulse<C>
where
    Pwm<pac::TIM3, C, ComplementaryImpossible>: PwmPin<Duty = u16>,
{
    fn max_duty_cycle(&self) -> u16 {
        self.0.get_max_duty()
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.0.set_duty(duty);
        Ok(())
    }
}

/// TIM3's four channels.
pub struct RotorOutputs(Pulse<0>, Pulse<1>, Pulse<2>, Pulse<3>);

impl Rotors for RotorOutputs {
    fn set(&mut self, [front_right, rear_left, front_left, rear_right]: [f32; 4]) {
        set_pulse(&mut self.0, front_right);
        set_pulse(&mut self.1, rear_left);
        set_pulse(&mut self.2, front_left);
        set_pulse(&mut self.3, rear_right);
    }
}

/// LED on PB0.
pub struct StatusLed(Pin<'B', 0, Output>);

impl Led for StatusLed {
    fn toggle(&mut self) {
        self.0.toggle();
    }
}

/// PC13.
pub struct KillPin(Pin<'C', 13, Input>);

impl Kill for KillPin {
    fn is_high(&self) -> bool {
        self.0.is_high()
    }
}

/// No memory for parameters.
pub type Memory = NoMemory;

/// The independent watchdog, on its own oscillator.
pub struct Dog(IndependentWatchdog);

impl Watchdog for Dog {
    fn feed(&mut self) {
        self.0.feed();
    }
}

/// USART1. Its receiver holds 16 bytes, 170 µs: longer than any control step.
pub struct SerialPort {
    tx: Tx<pac::USART1>,
    rx: Rx<pac::USART1>,
    lost: u32,
}

impl Serial for SerialPort {
    fn receive(&mut self) -> Option<u8> {
        loop {
            match self.rx.read() {
                Ok(byte) => return Some(byte),
                Err(stm32h7xx_hal::nb::Error::WouldBlock) => return None,
                // It clears the error; the next byte may be good.
                Err(stm32h7xx_hal::nb::Error::Other(_)) => self.lost = self.lost.wrapping_add(1),
            }
        }
    }

    fn send(&mut self, byte: u8) -> bool {
        self.tx.write(byte).is_ok()
    }

    fn wake_when_free(&mut self, wanted: bool) {
        if wanted {
            self.tx.listen();
        } else {
            self.tx.unlisten();
        }
    }

    fn take_lost(&mut self) -> u32 {
        core::mem::take(&mut self.lost)
    }
}

/// Not cleared at a reset: holds the number of watchdog resets since power-on.
#[unsafe(link_section = ".uninit.WATCHDOG_RESETS")]
static WATCHDOG_RESETS: AtomicU32 = AtomicU32::new(0);

/// Clocks, watchdog, outputs, in this order.
pub fn start() -> Board {
    // SAFETY: called once, before any interrupt, and nothing else has taken the peripherals.
    let (dp, mut cp) = unsafe { (pac::Peripherals::steal(), cortex_m::Peripherals::steal()) };
    cp.SCB.enable_icache();
    let crystal = crystal_starts(&dp.RCC);
    let power = dp.PWR.constrain().freeze();
    let mut rcc = dp.RCC.constrain();
    let (by_watchdog, watchdog_resets) = reset_cause(rcc.get_reset_reason());
    if crystal {
        rcc = rcc.use_hse(CRYSTAL_MHZ.MHz());
    }
    let ccdr = rcc.sys_ck(CORE_MHZ.MHz()).freeze(power, &dp.SYSCFG);

    let mut watchdog = IndependentWatchdog::new(dp.IWDG);
    watchdog.start(WATCHDOG_MS.millis());

    let gpioa = dp.GPIOA.split(ccdr.peripheral.GPIOA);
    let gpiob = dp.GPIOB.split(ccdr.peripheral.GPIOB);
    let gpioc = dp.GPIOC.split(ccdr.peripheral.GPIOC);

    let pins = (
        gpioa.pa6.into_alternate(),
        gpioc.pc7.into_alternate(),
        gpioc.pc8.into_alternate(),
        gpioc.pc9.into_alternate(),
    );
    let (c1, c2, c3, c4) = dp.TIM3.pwm(pins, PULSE_RATE_HZ.Hz(), ccdr.peripheral.TIM3, &ccdr.clocks);
    let mut rotors = RotorOutputs(Pulse(c1), Pulse(c2), Pulse(c3), Pulse(c4));
    rotors.set([0.0; 4]);
    rotors.0.0.enable();
    rotors.1.0.enable();
    rotors.2.0.enable();
    rotors.3.0.enable();

    let mut timer = dp.TIM2.timer(1.kHz(), ccdr.peripheral.TIM2, &ccdr.clocks);
    timer.listen(Event::TimeOut);

    let pins = (gpiob.pb6.into_alternate(), gpiob.pb7.into_alternate());
    // The divider of a known clock and baud rate.
    let Ok(port) = dp.USART1.serial(pins, BAUD.bps(), ccdr.peripheral.USART1, &ccdr.clocks) else {
        super::super::fail()
    };
    let (tx, mut rx) = port.split();
    rx.listen();

    Board {
        boot: Boot {
            by_watchdog,
            watchdog_resets,
            internal_clock: !crystal,
            core_hz: ccdr.clocks.c_ck().raw(),
            ..Boot::default()
        },
        timer: Timer(timer),
        rotors,
        serial: SerialPort { tx, rx, lost: 0 },
        led: StatusLed(gpiob.pb0.into_push_pull_output()),
        kill: KillPin(gpioc.pc13.into_pull_down_input()),
        settings: Settings::default(),
        store: Err(NotKept::NoMemory),
        watchdog: Dog(watchdog),
    }
}

/// Whether the watchdog caused this reset, and how often it has since power-on.
fn reset_cause(reason: ResetReason) -> (bool, u32) {
    let by_watchdog = matches!(reason, ResetReason::IndependentWatchdogReset | ResetReason::GenericWatchdogReset);
    let kept =
        by_watchdog || matches!(reason, ResetReason::PinReset | ResetReason::SystemReset | ResetReason::CpuReset);
    let before = if kept { WATCHDOG_RESETS.load(Ordering::Relaxed) } else { 0 };
    let resets = before.wrapping_add(by_watchdog.into());
    WATCHDOG_RESETS.store(resets, Ordering::Relaxed);
    (by_watchdog, resets)
}

/// The HAL waits for the crystal for ever, so it is tried here before, in bounded time. Without it
/// the PLL multiplies the internal oscillator to the same rate.
fn crystal_starts(rcc: &pac::RCC) -> bool {
    rcc.cr.modify(|_, w| w.hseon().on());
    let starts = (0..PATIENCE).any(|_| rcc.cr.read().hserdy().is_ready());
    if !starts {
        rcc.cr.modify(|_, w| w.hseon().off());
    }
    starts
}

/// Pulses of no length.
pub fn stop_rotors() {
    // SAFETY: the program has ended; nothing else writes here any more.
    unsafe { &*pac::TIM3::ptr() }.ccer.reset();
}

/// By the watchdog, so that it is counted.
pub fn reset() -> ! {
    loop {
        cortex_m::asm::nop();
    }
}
