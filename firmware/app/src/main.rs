//! The flight program.
//!
//! | priority | task | woken by |
//! |---|---|---|
//! | 3 | `control`: one control step, rotors | the control timer; in lockstep, a state frame |
//! | 3 | `wrap`: extends the cycle counter | the counter's wrap |
//! | 2 | `exchange`: bytes to messages to bytes | the serial port; `control`, with an answer |
//! | 1 | `report`: heartbeat, counters, log, status LED | once a second |
//! | 0 | `idle`: feeds the watchdog while `control` lives | any interrupt |
//!
//! What is decided about flight stands in the `autopilot` crate, which the host tests; what is
//! known about a board in its file under [`board`]. Here they are only connected.
#![no_std]
#![no_main]

mod board;
mod clock;

use defmt_rtt as _;

#[rtic::app(device = crate::board::pac, peripherals = false, dispatchers = [SPI1])]
mod app {
    use core::sync::atomic::{AtomicBool, Ordering};

    use autopilot::{Answer, Autopilot, Boot, Drive, Kind, Memory, Next, NotKept, Server, Store};
    use heapless::{Deque, Vec};
    use link::dialect::LOAD_STATE_DATA;
    use link::{Decoder, Encoder, MavMessage};

    use crate::board::{
        self, Board, ControlTimer as _, Kill as _, Led as _, Rotors as _, Serial as _, Watchdog as _,
    };
    use crate::clock::{self, Clock};

    /// Bytes that wait to be sent: a parameter list comes one by one, so this is some ten frames.
    const OUTBOX: usize = 2048;

    /// The longest frame.
    const FRAME: usize = 280;

    /// The timer's period in lockstep, s: half of the watchdog's.
    const LOCKSTEP_PERIOD_S: f32 = 0.25;
    /// Time for the acknowledgement of a reset to go out, 60 bytes even at 57,600 baud.
    const ACKNOWLEDGED_NS: u64 = 50_000_000;

    /// Set by each control interrupt, cleared by whoever feeds the watchdog.
    static CONTROL_LIVES: AtomicBool = AtomicBool::new(false);

    #[shared]
    struct Shared {
        autopilot: Autopilot,
        server: Server,
        outbox: Outbox,
        /// Lockstep: the frame whose step is to be made.
        frame: Option<LOAD_STATE_DATA>,
        /// The last step's answer, to be sent.
        answer: Option<Answer>,
    }

    #[local]
    struct Local {
        timer: board::Timer,
        rotors: board::RotorOutputs,
        kill: board::KillPin,
        store: Result<Store<board::Memory>, NotKept>,
        serial: board::SerialPort,
        decoder: Decoder,
        led: board::StatusLed,
        watchdog: board::Dog,
    }

    /// Frames as bytes on their way out.
    pub struct Outbox {
        encoder: Encoder,
        bytes: Deque<u8, OUTBOX>,
        lost: u32,
    }

    impl Outbox {
        /// Whether half of it stays free with one more frame: a list, of which there is more than
        /// fits, waits for that.
        fn has_room(&self) -> bool {
            self.bytes.len() < OUTBOX / 2 - FRAME
        }

        /// The whole frame or nothing of it.
        fn send(&mut self, message: &MavMessage) {
            self.send_leaving(message, 0);
        }

        /// An answer, which leaves room for news: it is followed by the next, and those are not.
        fn answer(&mut self, message: &MavMessage) {
            self.send_leaving(message, 2 * FRAME);
        }

        fn send_leaving(&mut self, message: &MavMessage, room: usize) {
            let frame = self.encoder.frame(message);
            if self.bytes.capacity() - self.bytes.len() < frame.bytes().len() + room {
                self.lost = self.lost.wrapping_add(frame.bytes().len() as u32);
                return;
            }
            for &byte in frame.bytes() {
                let _ = self.bytes.push_back(byte);
            }
        }
    }

    #[init(local = [memory: Memory<{ board::KNOTS }> = Memory::new()])]
    fn init(cx: init::Context) -> (Shared, Local) {
        let Board { boot, mut timer, rotors, serial, led, kill, settings, store, watchdog } = board::start();
        clock::start(cx.core.SYST, boot.core_hz);
        let boot = Boot { forgotten: store.as_ref().err().copied(), ..boot };
        let Boot { core_hz, by_watchdog, internal_clock, watchdog_resets, .. } = boot;
        defmt::info!("{=u32} Hz, crystal: {=bool}", core_hz, !internal_clock);
        if by_watchdog {
            defmt::error!("reset by the watchdog, {=u32} times since power-on", watchdog_resets);
        }
        let mut autopilot = Autopilot::with(settings, boot).with_memory(cx.local.memory);
        let server = Server::new();
        let mut outbox = Outbox { encoder: Encoder::new(link::CONTROLLER), bytes: Deque::new(), lost: 0 };
        server.greet(&autopilot, &mut |message| outbox.send(&message));
        if let Ok(Err(refusal)) = store.as_ref().map(|store| autopilot.recall(store)) {
            outbox.send(&Server::not_recalled(&refusal));
        }
        timer.set_period(autopilot.period_s());
        board::pend_link();
        (
            Shared { autopilot, server, outbox, frame: None, answer: None },
            Local { timer, rotors, kill, store, serial, decoder: Decoder::new(), led, watchdog },
        )
    }

    #[idle(local = [watchdog])]
    fn idle(cx: idle::Context) -> ! {
        loop {
            if CONTROL_LIVES.swap(false, Ordering::Relaxed) {
                cx.local.watchdog.feed();
            }
            cortex_m::asm::wfi();
        }
    }

    #[task(binds = SysTick, priority = 3)]
    fn wrap(_: wrap::Context) {
        if clock::wrap() {
            // Still at work on the last one: there is nothing to add.
            let _ = report::spawn();
        }
    }

    #[task(binds = TIM2, priority = 3, shared = [autopilot, frame, answer], local = [timer, rotors, kill, period_s: f32 = 0.0])]
    fn control(cx: control::Context) {
        let control::LocalResources { timer, rotors, kill, period_s, .. } = cx.local;
        CONTROL_LIVES.store(true, Ordering::Relaxed);
        let due = timer.take_tick();
        let start = Clock::now();
        (cx.shared.autopilot, cx.shared.frame, cx.shared.answer).lock(|autopilot, frame, pending| {
            autopilot.sense_kill_pin(kill.is_high());
            let lockstep = autopilot.drive() == Drive::Lockstep;
            let answer = match frame.take() {
                Some(frame) if lockstep => Some(autopilot.lockstep(&frame)),
                _ if due && !lockstep => Some(autopilot.tick()),
                _ => None,
            };
            // Disarmed in lockstep there is no answer, and no rotor turns either.
            rotors.set(answer.as_ref().map_or([0.0; 4], |answer| answer.outputs));
            if let Some(mut answer) = answer {
                autopilot.note_cost(&mut answer, start.elapsed());
                if !lockstep && timer.is_due() {
                    autopilot.note_overrun();
                }
                if autopilot.drive() != Drive::Flight || autopilot.is_armed() {
                    *pending = Some(answer);
                    board::pend_link();
                }
            }
            if due {
                // The link's questions are asked again in time.
                board::pend_link();
            }
            // In lockstep it only shows the watchdog that control lives.
            let wanted_s = if lockstep { LOCKSTEP_PERIOD_S } else { autopilot.period_s() };
            if *period_s != wanted_s {
                *period_s = wanted_s;
                timer.set_period(wanted_s);
            }
        });
    }

    #[task(binds = USART1, priority = 2, shared = [autopilot, server, outbox, frame, answer], local = [serial, decoder, store, reset_ns: Option<u64> = None])]
    fn exchange(cx: exchange::Context) {
        let exchange::LocalResources { serial, decoder, store, reset_ns, .. } = cx.local;
        let exchange::SharedResources { mut autopilot, mut server, mut outbox, mut frame, mut answer, .. } =
            cx.shared;

        while let Some(byte) = serial.receive() {
            decoder.push(byte, |received| {
                let mut replies = Vec::<MavMessage, 4>::new();
                let next = (&mut autopilot, &mut server).lock(|autopilot, server| {
                    server.handle(received, clock::now_ns(), autopilot, &mut |message| {
                        // No message has more than three replies.
                        let _ = replies.push(message);
                    })
                });
                match next {
                    Next::Nothing => {}
                    Next::Step(state) => {
                        frame.lock(|frame| *frame = Some(state));
                        // Preempts this task here and now.
                        board::pend_control();
                    }
                    Next::Store(index) => {
                        let kept = autopilot.lock(|autopilot| match store {
                            Ok(store) => store.keep(autopilot.settings(), index),
                            Err(why) => Err(*why),
                        });
                        if let Err(why) = kept {
                            let _ = replies.push(Server::not_kept(why));
                        }
                    }
                    Next::StoreMission => {
                        let kept = autopilot.lock(|autopilot| {
                            let store = store.as_mut().map_err(|why| *why)?;
                            let mut keep = |kind| store.keep_items(kind, autopilot.mission().items(kind));
                            keep(Kind::Mission).and(keep(Kind::Fence))
                        });
                        if let Err(why) = kept {
                            let _ = replies.push(Server::not_kept(why));
                        }
                    }
                    // Once its acknowledgement has gone out: a station that misses it asks again.
                    Next::Reboot => *reset_ns = Some(clock::now_ns() + ACKNOWLEDGED_NS),
                }
                outbox.lock(|outbox| replies.iter().for_each(|reply| outbox.send(reply)));
            });
        }

        if let Some(answer) = answer.lock(Option::take) {
            outbox.lock(|outbox| {
                if let Some(telemetry) = answer.telemetry {
                    outbox.answer(&MavMessage::LOAD_TELEMETRY(telemetry));
                }
                outbox.answer(&MavMessage::LOAD_COMMAND(answer.command));
            });
        }
        let has_room = outbox.lock(|outbox| outbox.has_room());
        let news = (&mut autopilot, &mut server).lock(|autopilot, server| {
            let news = server.news(clock::now_ns(), autopilot);
            if news.is_none() && has_room { server.listed(autopilot) } else { news }
        });
        if let Some(news) = &news {
            outbox.lock(|outbox| outbox.send(news));
        }
        let waiting = outbox.lock(|outbox| {
            while let Some(&byte) = outbox.bytes.front() {
                if !serial.send(byte) {
                    break;
                }
                outbox.bytes.pop_front();
            }
            outbox.lost = outbox.lost.wrapping_add(serial.take_lost());
            !outbox.bytes.is_empty()
        });
        serial.wake_when_free(waiting);
        // A control period's tick pends this task again.
        if reset_ns.is_some_and(|reset_ns| clock::now_ns() >= reset_ns) {
            cortex_m::peripheral::SCB::sys_reset();
        }
        if news.is_some() {
            board::pend_link();
        }
    }

    #[task(priority = 1, shared = [autopilot, server, outbox], local = [led])]
    async fn report(cx: report::Context) {
        let report::SharedResources { mut autopilot, mut server, mut outbox, .. } = cx.shared;
        cx.local.led.toggle();
        let lost = outbox.lock(|outbox| outbox.lost);
        let messages = (&mut autopilot, &mut server).lock(|autopilot, server| server.report(autopilot, lost));
        outbox.lock(|outbox| messages.iter().for_each(|message| outbox.send(message)));
        board::pend_link();
        if let [.., MavMessage::LOAD_COUNTERS(c)] = &messages {
            defmt::info!(
                "steps {=u32} missed {=u32} refused {=u32} overruns {=u32} fallbacks {=u32} bad frames {=u32} lost bytes {=u32} \
                 worst {=u32} cycles",
                c.steps,
                c.missed,
                c.refused,
                c.overruns,
                c.fallbacks,
                c.bad_frames,
                c.lost_bytes,
                c.worst_cycles
            );
        }
    }
}

/// Rotors off, then a reset: by the watchdog, so that it is counted and reported, or where there is
/// none at once.
fn fail() -> ! {
    cortex_m::interrupt::disable();
    board::stop_rotors();
    board::reset()
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    let place = info.location().map_or(("?", 0), |at| (at.file(), at.line()));
    defmt::error!("panic at {=str}:{=u32}", place.0, place.1);
    fail()
}

#[cortex_m_rt::exception]
unsafe fn HardFault(frame: &cortex_m_rt::ExceptionFrame) -> ! {
    defmt::error!("hard fault at {=u32:#x}", frame.pc());
    fail()
}
