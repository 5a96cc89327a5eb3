//! What can go wrong between here and the target, said so that it can be put right.

use std::time::Duration;

use super::Endpoint;
use crate::describe::parameters::Unsupported;

/// Why a flight with a target could not begin or go on.
#[derive(Debug, thiserror::Error)]
pub enum HilError {
    /// Not an endpoint.
    #[error("{0:?} is no endpoint: here, unix:PATH, tcp:HOST:PORT or udp:HOST:PORT")]
    Endpoint(String),
    /// There is no such serial port, or it is not ours to open.
    #[error("cannot open the serial port {port}: {source}; {}", ports(.available))]
    Port {
        /// Its name.
        port: String,
        /// Those that there are.
        available: Vec<String>,
        /// The system's reason.
        source: serialport::Error,
    },
    /// Nobody listens.
    #[error("cannot connect to {endpoint}: {source}")]
    Connect {
        /// Where.
        endpoint: Endpoint,
        /// The system's reason.
        source: std::io::Error,
    },
    /// Nobody said where the target is.
    #[error("where is the target? --port, --connect or --emulate say it; with --station it may be here")]
    NoTarget,
    /// No way to a ground station.
    #[error("no way to a ground station at {address}: {source}")]
    Station {
        /// Where.
        address: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// Nothing has come at all.
    #[error("{endpoint} is silent: not a byte in {:.1} s. Is the target powered and running, are its TX and RX crossed?", .waited.as_secs_f64())]
    Silent {
        /// Where.
        endpoint: Endpoint,
        /// How long.
        waited: Duration,
    },
    /// Bytes have come, but no message of the dialect.
    #[error(
        "{endpoint} speaks another language: {bytes} bytes in {:.1} s, and no answer in them. Is the baud rate right, is it this program's firmware?",
        .waited.as_secs_f64()
    )]
    Unintelligible {
        /// Where.
        endpoint: Endpoint,
        /// How many bytes came.
        bytes: u64,
        /// In what time.
        waited: Duration,
    },
    /// The other end's dialect is not this one's.
    #[error("the target's dialect is number {theirs}, this program's is {ours}: build both from the same sources")]
    Dialect {
        /// Fingerprint of the target's.
        theirs: u32,
        /// Fingerprint of this program's.
        ours: u32,
    },
    /// It did answer, and does no more.
    #[error("{endpoint} has stopped answering: nothing usable for {:.1} s after {sent} tries", .waited.as_secs_f64())]
    Lost {
        /// Where.
        endpoint: Endpoint,
        /// How long.
        waited: Duration,
        /// How often the question was sent.
        sent: u32,
    },
    /// The line is down and does not come back.
    #[error("the line to {endpoint} is down and has not come back in {:.1} s: {source}", .waited.as_secs_f64())]
    Down {
        /// Where.
        endpoint: Endpoint,
        /// How long.
        waited: Duration,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The emulator could not be started.
    #[error("cannot start {program}: {source}; on Debian it is in the package qemu-system-arm")]
    NoEmulator {
        /// The program.
        program: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The image is not there.
    #[error("cannot read the image {image}: {source}")]
    Image {
        /// Its file.
        image: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// The emulator has ended.
    #[error("the emulator has ended ({status}){}", said(.stderr))]
    EmulatorDied {
        /// How.
        status: String,
        /// What it wrote before.
        stderr: String,
    },
    /// The scenario can't be flown by the target's program.
    #[error("the target can't fly this: {0}")]
    Unsupported(String),
    /// The target does not take a parameter.
    #[error("the target keeps {name} at {kept} and does not take {wanted}: {reason}")]
    Parameter {
        /// Its name.
        name: String,
        /// What was asked for.
        wanted: f32,
        /// What it is.
        kept: f32,
        /// What the target says.
        reason: String,
    },
    /// The target does not arm, or not do what it is asked for.
    #[error("the target refuses: {0}")]
    Refused(String),
    /// The target's memory of the flight is gone.
    #[error("the target has lost its place at step {sequence}: it was reset in mid-flight")]
    OutOfStep {
        /// The step asked for.
        sequence: u32,
    },
    /// A command that must never be.
    #[error("the target commands what is not finite or not allowed, at step {sequence}: {command}")]
    BadCommand {
        /// The step.
        sequence: u32,
        /// The command.
        command: String,
    },
}

fn ports(available: &[String]) -> String {
    if available.is_empty() {
        "this machine has none".to_owned()
    } else {
        format!("this machine has {}", available.join(", "))
    }
}

fn said(stderr: &str) -> String {
    let stderr = stderr.trim();
    if stderr.is_empty() { String::new() } else { format!(": {stderr}") }
}

impl From<Unsupported> for HilError {
    fn from(Unsupported(reason): Unsupported) -> Self {
        Self::Unsupported(reason)
    }
}
