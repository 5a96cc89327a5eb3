//! The flight program's logic in this process, at the other end of a line: a target without
//! hardware.

use std::io::{self, ErrorKind};
use std::time::Instant;

use autopilot::{Autopilot, Boot, Drive, Memory, Next, Server};
use link::{Decoder, Encoder, MavMessage};

use super::Wire;

/// Knots of a mission's route, as on the emulated boards.
const KNOTS: usize = 8192;

/// Serves one line until its other end closes it. The same code as in the firmware, but for the
/// interrupts around it.
///
/// Lockstep needs no clock; in real time the control period is kept as well as the system lets a
/// thread keep it.
///
/// # Errors
/// The line's, but for its regular end.
pub fn serve(mut wire: impl Wire) -> io::Result<()> {
    let start = Instant::now();
    // As long as the process lives, which serves one line or a few.
    let memory = Box::leak(Box::new(Memory::<KNOTS>::new()));
    let boot = Boot { core_hz: 1_000_000_000, ..Boot::default() };
    let mut autopilot = Autopilot::new(boot).with_memory(memory);
    let mut server = Server::new();
    let (mut decoder, mut encoder) = (Decoder::new(), Encoder::new(link::CONTROLLER));
    let mut outbox = Vec::new();
    let mut send =
        |outbox: &mut Vec<u8>, message: &MavMessage| outbox.extend_from_slice(encoder.frame(message).bytes());
    server.greet(&autopilot, &mut |message| send(&mut outbox, &message));
    let mut next_tick = start;
    let mut next_report = start;
    loop {
        let mut steps = Vec::new();
        let mut bytes = [0; 512];
        wire.set_patience(std::time::Duration::from_micros(500))?;
        match wire.read(&mut bytes) {
            Ok(0) => return Ok(()),
            Ok(count) => {
                for &byte in &bytes[..count] {
                    decoder.push(byte, |received| {
                        let time_ns = start.elapsed().as_nanos() as u64;
                        let next = server
                            .handle(received, time_ns, &mut autopilot, &mut |message| send(&mut outbox, &message));
                        if let Next::Step(frame) = next {
                            let begun = Instant::now();
                            let mut answer = autopilot.lockstep(&frame);
                            autopilot.note_cost(&mut answer, begun.elapsed().as_nanos() as u32);
                            steps.push(answer);
                        }
                    });
                }
            }
            Err(error)
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) => {}
            Err(error) if matches!(error.kind(), ErrorKind::ConnectionReset | ErrorKind::BrokenPipe) => return Ok(()),
            Err(error) => return Err(error),
        }
        let now = Instant::now();
        if now >= next_tick {
            next_tick += std::time::Duration::from_secs_f32(autopilot.period_s());
            if autopilot.drive() != Drive::Lockstep {
                let answer = autopilot.tick();
                if autopilot.is_armed() {
                    steps.push(answer);
                }
            }
        }
        for answer in steps {
            if let Some(telemetry) = answer.telemetry {
                send(&mut outbox, &MavMessage::LOAD_TELEMETRY(telemetry));
            }
            send(&mut outbox, &MavMessage::LOAD_COMMAND(answer.command));
        }
        if now >= next_report {
            next_report += std::time::Duration::from_secs(1);
            send(&mut outbox, &Server::heartbeat(&autopilot));
            send(&mut outbox, &Server::current_mode(&autopilot));
            send(&mut outbox, &Server::landed_state(&autopilot));
            send(&mut outbox, &server.counters(&autopilot, 0));
        }
        let time_ns = start.elapsed().as_nanos() as u64;
        while let Some(news) = server.news(time_ns, &autopilot) {
            send(&mut outbox, &news);
        }
        match wire.write_all(&outbox) {
            Err(error) if matches!(error.kind(), ErrorKind::ConnectionReset | ErrorKind::BrokenPipe) => return Ok(()),
            written => written?,
        }
        outbox.clear();
    }
}
