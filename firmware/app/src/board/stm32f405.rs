//! STM32F405, as on Olimex's STM32-H405 (crystal 8 MHz, LED on PC12).
//!
//! | function | pins |
//! |---|---|
//! | rotors front right, rear left, front left, rear right | PA6, PA7, PB0, PB1 (TIM3, 400 Hz, 1 to 2 ms) |
//! | link, 921,600 baud 8N1 | PA9 out, PA10 in (USART1) |
//! | status LED | PC12 |
//! | kill: high stops the rotors | PA0 (its button) |
//!
//! Parameters are kept in the last two sectors of flash, which the memory map leaves out.

use core::cell::UnsafeCell;
use core::sync::atomic::{AtomicU32, Ordering, fence};

use autopilot::Boot;
use stm32f4xx_hal::gpio::{Input, Output, Pin};
use stm32f4xx_hal::nb;
pub use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::*;
use stm32f4xx_hal::rcc::Config;
use stm32f4xx_hal::serial::{self, Rx, RxISR, RxListen, Tx, TxListen};
use stm32f4xx_hal::timer::{CounterUs, Event, Flag, PwmChannel};
use stm32f4xx_hal::watchdog::IndependentWatchdog;

use super::{
    Board, ControlTimer, Kill, Led, PULSE_RATE_HZ, Rotors, Serial, WATCHDOG_MS, Watchdog, recall, set_pulse,
};

mod flash;

pub use flash::Memory;

const CRYSTAL_MHZ: u32 = 8;
const CORE_MHZ: u32 = 168;
const BAUD: u32 = 921_600;
/// How often a ready bit is looked at: some 60 ms on the internal oscillator, where a crystal
/// takes 2.
const PATIENCE: u32 = 100_000;

/// TIM2, counting microseconds.
pub struct Timer(CounterUs<pac::TIM2>);

impl ControlTimer for Timer {
    fn set_period(&mut self, seconds: f32) {
        let _ = self.0.start((((seconds * 1e6) as u32).max(1)).micros());
    }

    fn take_tick(&mut self) -> bool {
        let due = self.is_due();
        if due {
            self.0.clear_flags(Flag::Update);
        }
        due
    }

    fn is_due(&self) -> bool {
        self.0.flags().contains(Flag::Update)
    }
}

/// TIM3's four channels.
pub struct RotorOutputs(
    PwmChannel<pac::TIM3, 0>,
    PwmChannel<pac::TIM3, 1>,
    PwmChannel<pac::TIM3, 2>,
    PwmChannel<pac::TIM3, 3>,
);

impl Rotors for RotorOutputs {
    fn set(&mut self, [front_right, rear_left, front_left, rear_right]: [f32; 4]) {
        set_pulse(&mut self.0, front_right);
        set_pulse(&mut self.1, rear_left);
        set_pulse(&mut self.2, front_left);
        set_pulse(&mut self.3, rear_right);
    }
}

/// LED on PC12.
pub struct StatusLed(Pin<'C', 12, Output>);

impl Led for StatusLed {
    fn toggle(&mut self) {
        self.0.toggle();
    }
}

/// PA0.
pub struct KillPin(Pin<'A', 0, Input>);

impl Kill for KillPin {
    fn is_high(&self) -> bool {
        self.0.is_high()
    }
}

/// The independent watchdog, on its own oscillator.
pub struct Dog(IndependentWatchdog);

impl Watchdog for Dog {
    fn feed(&mut self) {
        self.0.feed();
    }
}

/// USART1. Its receiver holds one byte, and a control step may last longer than two: so DMA takes
/// the bytes to a ring. Where there is no DMA, as in emulators, which wait for a byte to be read,
/// they come by interrupt.
pub struct SerialPort {
    tx: Tx<pac::USART1>,
    rx: Rx<pac::USART1>,
    ring: Option<Ring>,
    lost: u32,
}

impl Serial for SerialPort {
    fn receive(&mut self) -> Option<u8> {
        if let Some(ring) = &mut self.ring {
            if self.rx.is_idle() {
                self.rx.clear_idle_interrupt();
            }
            return ring.pop();
        }
        match self.rx.read() {
            Ok(byte) => Some(byte),
            Err(nb::Error::WouldBlock) => None,
            Err(nb::Error::Other(_)) => {
                self.lost = self.lost.wrapping_add(1);
                None
            }
        }
    }

    fn send(&mut self, byte: u8) -> bool {
        self.tx.write(byte).is_ok()
    }

    fn wake_when_free(&mut self, wanted: bool) {
        if wanted {
            TxListen::listen(&mut self.tx);
        } else {
            TxListen::unlisten(&mut self.tx);
        }
    }

    fn take_lost(&mut self) -> u32 {
        core::mem::take(&mut self.lost)
    }
}

/// 11 ms of bytes: the link's task runs at the latest each control period.
const RING: usize = 1024;

struct Storage(UnsafeCell<[u8; RING]>);
// SAFETY: `Ring` is made once and is its only reader; DMA writes it, and is read around by its
// count.
unsafe impl Sync for Storage {}
static STORAGE: Storage = Storage(UnsafeCell::new([0; RING]));

/// What DMA2's stream 2 (channel 4: USART1's receiver) writes, round and round.
struct Ring {
    dma: pac::DMA2,
    read: usize,
}

impl Ring {
    const STREAM: usize = 2;

    /// Starts the stream; `None` if it does not say that it runs.
    fn start(dma: pac::DMA2, usart_data: u32) -> Option<Self> {
        let stream = dma.st(Self::STREAM);
        // SAFETY: from the receiver's data register to memory that only this stream writes, as much
        // of it as there is.
        unsafe {
            stream.par().write(|w| w.bits(usart_data));
            stream.m0ar().write(|w| w.bits(STORAGE.0.get() as u32));
        }
        stream.ndtr().write(|w| w.ndt().set(RING as u16));
        stream.cr().write(|w| w.chsel().set(4).circ().enabled().minc().incremented().en().enabled());
        if stream.cr().read().en().is_enabled() { Some(Self { dma, read: 0 }) } else { None }
    }

    fn pop(&mut self) -> Option<u8> {
        let left = usize::from(self.dma.st(Self::STREAM).ndtr().read().ndt().bits());
        let written = (RING - left) % RING;
        if written == self.read {
            return None;
        }
        fence(Ordering::Acquire);
        // SAFETY: inside the array, at a place that DMA has passed.
        let byte = unsafe { STORAGE.0.get().cast::<u8>().add(self.read).read_volatile() };
        self.read = (self.read + 1) % RING;
        Some(byte)
    }
}

/// Not cleared at a reset: holds the number of watchdog resets since power-on.
#[unsafe(link_section = ".uninit.WATCHDOG_RESETS")]
static WATCHDOG_RESETS: AtomicU32 = AtomicU32::new(0);

/// Clocks, watchdog, outputs, in this order.
pub fn start() -> Board {
    // SAFETY: called once, before any interrupt, and nothing else has taken the peripherals.
    let dp = unsafe { pac::Peripherals::steal() };
    let (by_watchdog, watchdog_resets) = reset_cause(&dp.RCC);
    let (config, internal_clock) = clocks(&dp.RCC);
    let mut rcc = dp.RCC.freeze(config);

    let (settings, store) = recall(Memory::new(dp.FLASH));

    let mut watchdog = IndependentWatchdog::new(dp.IWDG);
    watchdog.start(WATCHDOG_MS.millis());

    let gpioa = dp.GPIOA.split(&mut rcc);
    let gpiob = dp.GPIOB.split(&mut rcc);
    let gpioc = dp.GPIOC.split(&mut rcc);

    let (_, (c1, c2, c3, c4)) = dp.TIM3.pwm_hz(PULSE_RATE_HZ.Hz(), &mut rcc);
    let mut rotors = RotorOutputs(c1.with(gpioa.pa6), c2.with(gpioa.pa7), c3.with(gpiob.pb0), c4.with(gpiob.pb1));
    rotors.set([0.0; 4]);
    rotors.0.enable();
    rotors.1.enable();
    rotors.2.enable();
    rotors.3.enable();

    let mut timer = dp.TIM2.counter_us(&mut rcc);
    timer.listen(Event::Update);

    let usart_data = dp.USART1.dr().as_ptr() as u32;
    let pins = (gpioa.pa9, gpioa.pa10);
    let config = serial::Config::default().baudrate(BAUD.bps()).dma(serial::config::DmaConfig::Rx);
    // The divider of a known clock and baud rate.
    let Ok(port) = dp.USART1.serial(pins, config, &mut rcc) else { super::super::fail() };
    let (tx, mut rx) = port.split();
    rcc.ahb1enr().modify(|_, w| w.dma2en().enabled());
    let ring = Ring::start(dp.DMA2, usart_data);
    if ring.is_some() {
        rx.listen_idle();
    } else {
        RxListen::listen(&mut rx);
    }

    Board {
        boot: Boot {
            by_watchdog,
            watchdog_resets,
            internal_clock,
            core_hz: rcc.clocks.sysclk().raw(),
            ..Boot::default()
        },
        timer: Timer(timer),
        rotors,
        serial: SerialPort { tx, rx, ring, lost: 0 },
        led: StatusLed(gpioc.pc12.into_push_pull_output()),
        kill: KillPin(gpioa.pa0.into_pull_down_input()),
        settings,
        store,
        watchdog: Dog(watchdog),
    }
}

/// Whether the watchdog caused this reset, and how often it has since power-on.
fn reset_cause(rcc: &pac::RCC) -> (bool, u32) {
    let cause = rcc.csr().read();
    rcc.csr().modify(|_, w| w.rmvf().clear());
    let by_watchdog = cause.wdgrstf().is_reset();
    // After power-on, or with no cause given, RAM holds nothing of ours.
    let fresh =
        cause.porrstf().is_reset() || !(by_watchdog || cause.sftrstf().is_reset() || cause.padrstf().is_reset());
    let before = if fresh { 0 } else { WATCHDOG_RESETS.load(Ordering::Relaxed) };
    let resets = before.wrapping_add(by_watchdog.into());
    WATCHDOG_RESETS.store(resets, Ordering::Relaxed);
    (by_watchdog, resets)
}

/// The fastest clock that this board can make now, and whether it had to do without its crystal.
///
/// The HAL waits for ready bits for ever, so each source is tried here before, in bounded time.
fn clocks(rcc: &pac::RCC) -> (Config, bool) {
    let comes = |ready: &dyn Fn() -> bool| (0..PATIENCE).any(|_| ready());
    rcc.cr().modify(|_, w| w.hseon().on());
    let crystal = comes(&|| rcc.cr().read().hserdy().is_ready());
    if !crystal {
        rcc.cr().modify(|_, w| w.hseon().off());
    }
    // After a reset it multiplies the internal oscillator to 96 MHz.
    rcc.cr().modify(|_, w| w.pllon().on());
    let pll = comes(&|| rcc.cr().read().pllrdy().is_ready());
    rcc.cr().modify(|_, w| w.pllon().off());
    let stopped = comes(&|| rcc.cr().read().pllrdy().is_not_ready());
    let config = match (crystal, pll && stopped) {
        (true, true) => Config::hse(CRYSTAL_MHZ.MHz()).sysclk(CORE_MHZ.MHz()),
        (true, false) => Config::hse(CRYSTAL_MHZ.MHz()),
        (false, true) => Config::hsi().sysclk(CORE_MHZ.MHz()),
        (false, false) => Config::hsi(),
    };
    (config, !crystal)
}

/// Pulses of no length.
pub fn stop_rotors() {
    // SAFETY: the program has ended; nothing else writes here any more.
    let timer = unsafe { pac::TIM3::steal() };
    timer.ccer().reset();
}

/// By the watchdog, so that it is counted.
pub fn reset() -> ! {
    loop {
        cortex_m::asm::nop();
    }
}
