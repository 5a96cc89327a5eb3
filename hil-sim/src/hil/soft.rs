//! The flight program's logic in this process: a target without hardware.

use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

use autopilot::{Answer, Autopilot, Boot, Drive, Memory, Next, Server};
use link::{Decoder, Encoder, MavMessage};

use super::Wire;

/// Knots of a mission's route, as on the emulated boards.
const KNOTS: usize = 8192;

/// The same code as in the firmware, but for the interrupts around it.
struct Program {
    start: Instant,
    autopilot: Autopilot,
    server: Server,
    decoder: Decoder,
    encoder: Encoder,
    outbox: Vec<u8>,
    next_report: Instant,
}

impl Program {
    fn new() -> Self {
        let start = Instant::now();
        // As long as the process lives, which serves one line or a few.
        let memory = Box::leak(Box::new(Memory::<KNOTS>::new()));
        let boot = Boot { core_hz: 1_000_000_000, ..Boot::default() };
        let mut program = Self {
            start,
            autopilot: Autopilot::new(boot).with_memory(memory),
            server: Server::new(),
            decoder: Decoder::new(),
            encoder: Encoder::new(link::CONTROLLER),
            outbox: Vec::new(),
            next_report: start,
        };
        let Self { autopilot, server, encoder, outbox, .. } = &mut program;
        server.greet(autopilot, &mut |message| outbox.extend_from_slice(encoder.frame(&message).bytes()));
        program
    }

    /// Bytes that have come. Where a simulated vehicle `is_stepped` by its states, each one is a
    /// control step in real time too, as it is in lockstep.
    fn hear(&mut self, bytes: &[u8], is_stepped: bool) {
        let Self { start, autopilot, server, decoder, encoder, outbox, .. } = self;
        let mut answers = Vec::new();
        for &byte in bytes {
            decoder.push(byte, |received| {
                let is_state = is_stepped && matches!(received, Ok((MavMessage::LOAD_STATE(_), _)));
                let time_ns = start.elapsed().as_nanos() as u64;
                let next = server.handle(received, time_ns, autopilot, &mut |message| {
                    outbox.extend_from_slice(encoder.frame(&message).bytes());
                });
                let begun = Instant::now();
                let mut answer = match next {
                    Next::Step(frame) => autopilot.lockstep(&frame),
                    _ if is_state => autopilot.tick(),
                    _ => return,
                };
                autopilot.note_cost(&mut answer, begun.elapsed().as_nanos() as u32);
                answers.push(answer);
            });
        }
        answers.into_iter().for_each(|answer| self.answer(answer));
    }

    /// A control period by the clock.
    fn tick(&mut self) {
        let answer = self.autopilot.tick();
        if self.autopilot.drive() != Drive::Flight || self.autopilot.is_armed() {
            self.answer(answer);
        }
    }

    fn answer(&mut self, answer: Answer) {
        if let Some(telemetry) = answer.telemetry {
            self.send(&MavMessage::LOAD_TELEMETRY(telemetry));
        }
        self.send(&MavMessage::LOAD_COMMAND(answer.command));
    }

    /// What is to be said unasked.
    fn tell(&mut self) {
        let now = Instant::now();
        if now >= self.next_report {
            self.next_report += Duration::from_secs(1);
            for message in self.server.report(&self.autopilot, 0) {
                self.send(&message);
            }
        }
        let time_ns = self.start.elapsed().as_nanos() as u64;
        let Self { server, autopilot, encoder, outbox, .. } = self;
        while let Some(news) = server.news(time_ns, autopilot).or_else(|| server.listed(autopilot)) {
            outbox.extend_from_slice(encoder.frame(&news).bytes());
        }
    }

    fn send(&mut self, message: &MavMessage) {
        self.outbox.extend_from_slice(self.encoder.frame(message).bytes());
    }
}

/// Serves one line until its other end closes it.
///
/// Lockstep needs no clock; in real time the control period is kept as well as the system lets a
/// thread keep it.
///
/// # Errors
/// The line's, but for its regular end.
pub fn serve(mut wire: impl Wire) -> io::Result<()> {
    let mut program = Program::new();
    let mut next_tick = program.start;
    loop {
        let mut bytes = [0; 512];
        wire.set_patience(Duration::from_micros(500))?;
        match wire.read(&mut bytes) {
            Ok(0) => return Ok(()),
            Ok(count) => program.hear(&bytes[..count], false),
            Err(error)
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) => {}
            Err(error) if matches!(error.kind(), ErrorKind::ConnectionReset | ErrorKind::BrokenPipe) => return Ok(()),
            Err(error) => return Err(error),
        }
        if Instant::now() >= next_tick {
            next_tick += Duration::from_secs_f32(program.autopilot.period_s());
            if program.autopilot.drive() != Drive::Lockstep {
                program.tick();
            }
        }
        program.tell();
        match wire.write_all(&program.outbox) {
            Err(error) if matches!(error.kind(), ErrorKind::ConnectionReset | ErrorKind::BrokenPipe) => return Ok(()),
            written => written?,
        }
        program.outbox.clear();
    }
}

/// The flight program at the near end of a line that is none: what is written it hears at once, and
/// each state is a control step, so that in real time none is ever late.
pub struct Here {
    program: Program,
    patience: Duration,
}

impl Here {
    /// Started, and not configured.
    #[must_use]
    pub fn new() -> Self {
        Self { program: Program::new(), patience: Duration::ZERO }
    }
}

impl Default for Here {
    fn default() -> Self {
        Self::new()
    }
}

impl Read for Here {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.program.tell();
        let outbox = &mut self.program.outbox;
        if outbox.is_empty() {
            std::thread::sleep(self.patience);
            return Err(ErrorKind::WouldBlock.into());
        }
        let count = outbox.len().min(bytes.len());
        bytes[..count].copy_from_slice(&outbox[..count]);
        outbox.drain(..count);
        Ok(count)
    }
}

impl Write for Here {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.program.hear(bytes, true);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Wire for Here {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.patience = patience;
        Ok(())
    }
}
