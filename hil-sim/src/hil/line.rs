//! The line to a target: questions and answers over it, asked again where one is lost, and the line
//! mended where it breaks.

use std::collections::VecDeque;
use std::io::ErrorKind;
use std::time::{Duration, Instant};

use link::{Decoder, Encoder, MavMessage};

use super::{Emulator, Endpoint, HilError, Options, Station, Statistics, Wire};

/// A line that is open, with what has come over it.
pub struct Line {
    endpoint: Endpoint,
    wire: Box<dyn Wire>,
    emulator: Option<Emulator>,
    options: Options,
    decoder: Decoder,
    encoder: Encoder,
    inbox: VecDeque<MavMessage>,
    received_bytes: u64,
    /// Who commands the target, if it is not this program.
    pub station: Option<Station>,
    /// What the line has seen.
    pub statistics: Statistics,
}

impl Line {
    /// Opens `endpoint`, or the line to the emulator, waiting for its first word as long as the
    /// patience lasts.
    pub fn open(endpoint: Endpoint, mut emulator: Option<Emulator>, options: Options) -> Result<Self, HilError> {
        let wire = open(&endpoint, emulator.as_mut(), options.patience)?;
        Ok(Self { emulator, ..Self::over(endpoint, wire, options) })
    }

    /// Over a wire that is open already; `endpoint` names it, and is where it is opened again.
    pub fn over(endpoint: Endpoint, wire: Box<dyn Wire>, options: Options) -> Self {
        Self {
            endpoint,
            wire,
            emulator: None,
            options,
            decoder: Decoder::new(),
            encoder: Encoder::new(link::STATION),
            inbox: VecDeque::new(),
            received_bytes: 0,
            station: None,
            statistics: Statistics::default(),
        }
    }

    pub fn options(&self) -> &Options {
        &self.options
    }

    pub fn emulator(&self) -> Option<&Emulator> {
        self.emulator.as_ref()
    }

    /// Bytes that have come, whatever they were.
    pub fn received_bytes(&self) -> u64 {
        self.received_bytes
    }

    /// The next message that has come, not read from the wire.
    pub fn next(&mut self) -> Option<MavMessage> {
        self.inbox.pop_front()
    }

    /// The target does not answer any more.
    pub fn lost(&self, since: Instant, sent: u32) -> HilError {
        HilError::Lost { endpoint: self.endpoint.clone(), waited: since.elapsed(), sent }
    }

    /// Sends `question`, all of it again and again if need be, until `answer` finds one or the
    /// patience ends.
    pub fn ask<T>(
        &mut self,
        question: &[MavMessage],
        answer: impl Fn(&MavMessage) -> Option<T>,
    ) -> Result<T, HilError> {
        let begun = Instant::now();
        let mut sent = 0;
        while begun.elapsed() < self.options.patience {
            self.transmit(question)?;
            sent += 1;
            let until = Instant::now() + self.options.retry;
            loop {
                while let Some(message) = self.inbox.pop_front() {
                    if let Some(found) = answer(&message) {
                        self.statistics.repeats += u64::from(sent - 1);
                        return Ok(found);
                    }
                    self.note(&message);
                }
                let left = until.saturating_duration_since(Instant::now());
                if left.is_zero() {
                    break;
                }
                self.receive(left)?;
            }
        }
        if let Some(emulator) = &mut self.emulator {
            emulator.check()?;
        }
        Err(self.lost(begun, sent))
    }

    /// What comes unasked.
    pub fn note(&mut self, message: &MavMessage) {
        if let Some(station) = &mut self.station {
            station.tell(message);
        }
        if let MavMessage::STATUSTEXT(text) = message {
            self.statistics.texts.push(link::text_of(&*text.text).to_owned());
        }
    }

    /// Passes on what the station has said, as whoever says it.
    pub fn relay(&mut self) -> Result<(), HilError> {
        let Some(station) = &mut self.station else { return Ok(()) };
        let mut bytes = Vec::new();
        station.hear(|message, address| bytes.extend_from_slice(Encoder::new(address).frame(&message).bytes()));
        if bytes.is_empty() { Ok(()) } else { self.write(&bytes) }
    }

    /// At once.
    pub fn transmit(&mut self, messages: &[MavMessage]) -> Result<(), HilError> {
        let mut bytes = Vec::new();
        for message in messages {
            bytes.extend_from_slice(self.encoder.frame(message).bytes());
        }
        self.write(&bytes)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), HilError> {
        match self.wire.write_all(bytes) {
            Ok(()) => Ok(()),
            Err(error) => self.mend(error),
        }
    }

    /// Reads what has come, waiting for `patience` at most.
    pub fn receive(&mut self, patience: Duration) -> Result<(), HilError> {
        let mut bytes = [0; 1024];
        // A socket refuses to wait for no time at all.
        let read =
            self.wire.set_patience(patience.max(Duration::from_millis(1))).and_then(|()| self.wire.read(&mut bytes));
        match read {
            Ok(0) => self.mend(ErrorKind::UnexpectedEof.into()),
            Ok(count) => {
                self.received_bytes += count as u64;
                let (inbox, statistics) = (&mut self.inbox, &mut self.statistics);
                for &byte in &bytes[..count] {
                    self.decoder.push(byte, |received| match received {
                        Ok((message, _)) => inbox.push_back(message),
                        Err(_) => statistics.bad_frames += 1,
                    });
                }
                Ok(())
            }
            Err(error)
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) =>
            {
                Ok(())
            }
            Err(error) => self.mend(error),
        }
    }

    /// The line is down: opens it again.
    fn mend(&mut self, source: std::io::Error) -> Result<(), HilError> {
        let begun = Instant::now();
        match open(&self.endpoint, self.emulator.as_mut(), self.options.patience) {
            Ok(wire) => {
                self.wire = wire;
                self.decoder.reset();
                self.statistics.reconnections += 1;
                Ok(())
            }
            Err(error @ HilError::EmulatorDied { .. }) => Err(error),
            Err(_) => Err(HilError::Down { endpoint: self.endpoint.clone(), waited: begun.elapsed(), source }),
        }
    }
}

/// Opens the line, to the emulator if there is one.
fn open(endpoint: &Endpoint, emulator: Option<&mut Emulator>, patience: Duration) -> Result<Box<dyn Wire>, HilError> {
    match emulator {
        Some(emulator) => emulator.open(patience),
        None => endpoint.open(),
    }
}
