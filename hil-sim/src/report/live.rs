//! A flight's page while it flies, over HTTP to browsers on this computer: the page itself, the
//! flights so far, and server-sent events whenever there is more of them.

use std::io::{self, BufRead, BufReader, Write};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::log::{Record, Table};
use super::page::{Shown, flights_json, live_page};
use crate::describe::scenario::Scenario;
use crate::fly::flight::End;
use crate::fly::sample::Sample;

/// How often a page is told that there is more.
const EVERY: Duration = Duration::from_millis(500);

/// How long a browser may take for its request, and a flight that is over waits for pages that
/// have not seen its end.
const PATIENCE: Duration = Duration::from_secs(2);

/// Longest line and most lines of a request.
const LINE: u64 = 4096;
const LINES: usize = 100;

/// A flight so far.
struct Flown {
    scenario: Scenario,
    samples: Vec<Sample>,
    end: Option<End>,
}

#[derive(Default)]
struct Shared {
    flights: Vec<Flown>,
    /// There will be no more.
    is_over: bool,
    /// Pages that listen and have not fetched the end.
    waiting: usize,
}

impl Shared {
    fn samples(&self) -> usize {
        self.flights.iter().map(|flight| flight.samples.len() + 1).sum()
    }
}

/// The server.
pub struct Live {
    shared: Arc<Mutex<Shared>>,
    address: SocketAddr,
}

impl Live {
    /// Serves on `port` of this computer, on any that is free if it is 0.
    ///
    /// # Errors
    /// The port can't be had.
    pub fn serve(port: u16) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        let address = listener.local_addr()?;
        let shared = Arc::new(Mutex::new(Shared::default()));
        let served = Arc::clone(&shared);
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let shared = Arc::clone(&served);
                // A browser that goes away ends its own thread.
                thread::spawn(move || drop(answer(&stream, &shared)));
            }
        });
        Ok(Self { shared, address })
    }

    /// Where it serves.
    #[must_use]
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    /// Takes what is new in the log of a flight. One that is flying does not wait for pages that
    /// are being written: what is new comes with the next sample.
    pub fn show(&self, scenario: &Scenario, log: &[Sample], end: Option<End>) {
        let shared = if end.is_some() { Some(locked(&self.shared)) } else { self.shared.try_lock().ok() };
        let Some(mut shared) = shared else { return };
        if shared.flights.last().is_none_or(|flight| flight.end.is_some()) {
            shared.flights.push(Flown { scenario: scenario.clone(), samples: Vec::new(), end: None });
        }
        if let Some(flight) = shared.flights.last_mut() {
            let new = log.get(flight.samples.len()..).unwrap_or_default();
            flight.samples.extend_from_slice(new);
            flight.end = end;
        }
    }

    /// Tells pages that this was all, and lets them fetch it.
    pub fn finish(&self) {
        locked(&self.shared).is_over = true;
        let begun = Instant::now();
        while locked(&self.shared).waiting > 0 && begun.elapsed() < PATIENCE {
            thread::sleep(EVERY / 10);
        }
    }
}

fn locked(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Answers one request.
fn answer(stream: &TcpStream, shared: &Mutex<Shared>) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut reader = BufReader::new(stream);
    let mut request = String::new();
    io::Read::take(&mut reader, LINE).read_line(&mut request)?;
    let mut line = String::new();
    for _ in 0..LINES {
        line.clear();
        io::Read::take(&mut reader, LINE).read_line(&mut line)?;
        if line.trim_end().is_empty() {
            break;
        }
    }
    let mut parts = request.split_ascii_whitespace();
    match (parts.next(), parts.next()) {
        (Some("GET"), Some("/")) => send(stream, "200 OK", "text/html; charset=utf-8", &live_page(&json(shared))),
        (Some("GET"), Some("/flights.json")) => {
            let is_over = locked(shared).is_over;
            send(stream, "200 OK", "application/json", &json(shared))?;
            if is_over {
                let mut shared = locked(shared);
                shared.waiting = shared.waiting.saturating_sub(1);
            }
            Ok(())
        }
        (Some("GET"), Some("/events")) => events(stream, shared),
        // What browsers ask for by themselves.
        (Some("GET"), Some("/favicon.ico")) => send(stream, "204 No Content", "text/plain", ""),
        _ => send(stream, "404 Not Found", "text/plain", "not found\n"),
    }
}

fn send(mut stream: &TcpStream, status: &str, kind: &str, body: &str) -> io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n{body}",
        body.len()
    )
}

/// Tells a page that there is more, until there is no more.
fn events(mut stream: &TcpStream, shared: &Mutex<Shared>) -> io::Result<()> {
    let head =
        "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\nConnection: close\r\n\r\n";
    stream.write_all(head.as_bytes())?;
    locked(shared).waiting += 1;
    let mut told = 0;
    let listening = loop {
        let (samples, is_over) = {
            let shared = locked(shared);
            (shared.samples(), shared.is_over)
        };
        if is_over {
            break stream.write_all(b"event: over\ndata:\n\n");
        }
        // A comment says whether anybody still listens.
        let text = if samples == told { ":\n\n".to_owned() } else { format!("data: {samples}\n\n") };
        if let Err(error) = stream.write_all(text.as_bytes()) {
            break Err(error);
        }
        told = samples;
        thread::sleep(EVERY);
    };
    if listening.is_err() {
        let mut shared = locked(shared);
        shared.waiting = shared.waiting.saturating_sub(1);
    }
    listening
}

/// The flights so far, as a page takes them.
fn json(shared: &Mutex<Shared>) -> String {
    let shared = locked(shared);
    let tables: Vec<Table> = shared
        .flights
        .iter()
        .map(|Flown { scenario, samples, .. }| {
            let records: Vec<Record> = samples.iter().map(|sample| Record::of_sample(scenario, sample)).collect();
            Table::new(&scenario.name, &scenario.title, &records)
        })
        .collect();
    let shown: Vec<Shown<'_>> = shared
        .flights
        .iter()
        .zip(&tables)
        .filter(|(flight, _)| !flight.samples.is_empty())
        .map(|(flight, table)| Shown::of(&flight.scenario, table, flight.end.unwrap_or(End::Complete)))
        .collect();
    flights_json(&shown)
}
