//! Flights with the controller at the other end of a line: the same, bit by bit, as with the
//! controller in this program, whatever the line does; and where a flight can't go on, an end with
//! a reason.

mod common;
mod mission;
mod route;
mod station;

use std::io::{self, Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::time::{Duration, Instant};

use common::{Ending, OPTIONS, Recorded, flights, fly, fly_here, fly_there, scenario};
use controller::ActuatorLimits;
use hil_sim::fly::flight::End;
use hil_sim::fly::pilot::Pilot;
use hil_sim::hil::{Endpoint, HilError, Options, Pace, Target, Wire, serve};

/// The flight program's logic in a thread, at the other end of a pair of sockets, behind what
/// `damage` does to the line.
fn soft_target<W: Wire + 'static>(
    options: Options,
    damage: impl FnOnce(UnixStream) -> W,
) -> Result<Target, HilError> {
    let (here, there) = UnixStream::pair().expect("sockets");
    std::thread::spawn(move || serve(there));
    Target::over(Endpoint::Unix("the other thread".into()), Box::new(damage(here)), options)
}

#[test]
fn the_figures_are_the_same_over_the_link() {
    let mut target = soft_target(OPTIONS, |stream| stream).unwrap();
    for scenario in flights(2.0) {
        let (commands, back) = fly_there(&scenario, target);
        assert_eq!(commands.unwrap(), fly_here(&scenario), "{}", scenario.name);
        target = back;
    }
}

#[test]
fn a_mission_from_ground_to_ground_is_the_same_over_the_link() {
    let here = mission::fly_here();
    mission::check(&here);
    let mut target = soft_target(OPTIONS, |stream| stream).unwrap();
    target.prepare(&mission::scenario()).unwrap();
    let there = mission::fly(|measured, request, t_s| target.fly(measured, request, t_s).unwrap());
    assert_eq!(there, here);
}

#[test]
fn a_route_is_uploaded_and_flown_to_its_end() {
    let (_, here, _) = route::flown(Pilot::<f32>::new(&route::scenario().controller).unwrap());
    let (_, there, _) = route::flown_there(soft_target(OPTIONS, |stream| stream).unwrap());
    // Places of items are rounded to 0.1 mm; a sample every 10 ms is off by 7.5 mm along the route,
    // which is 0.3 mm of the distance from a point 0.1 m beside it.
    assert!((here - there).abs() < 1e-3, "passes at {there} m, not at {here} m");
}

#[test]
fn the_observed_flight_meets_its_limits() {
    let observed = flights(2.0).pop().expect("it is the last");
    let commands = fly_here(&observed);
    let ActuatorLimits { min_thrust, max_thrust, max_torque: [roll, pitch, yaw] } = observed.controller.limits;
    let met = |index: usize, limit: f64| commands.iter().any(|command| command[index] == (limit as f32).to_bits());
    assert!(met(0, min_thrust) || met(0, max_thrust));
    assert!(met(1, roll) || met(2, pitch) || met(3, yaw));
}

/// Changes one byte of a hundred, both ways.
struct Noisy {
    stream: UnixStream,
    seed: u32,
}

impl Noisy {
    fn spoil(&mut self, bytes: &mut [u8]) {
        for byte in bytes {
            // Marsaglia's xorshift32.
            self.seed ^= self.seed << 13;
            self.seed ^= self.seed >> 17;
            self.seed ^= self.seed << 5;
            if self.seed.is_multiple_of(100) {
                *byte ^= (self.seed >> 8) as u8 | 1;
            }
        }
    }
}

impl Read for Noisy {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let count = self.stream.read(bytes)?;
        self.spoil(&mut bytes[..count]);
        Ok(count)
    }
}

impl Write for Noisy {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut bytes = bytes.to_vec();
        self.spoil(&mut bytes);
        self.stream.write_all(&bytes)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

impl Wire for Noisy {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.stream.set_patience(patience)
    }
}

#[test]
fn noise_changes_nothing_but_the_time_it_takes() {
    let options = Options { retry: Duration::from_millis(4), ..OPTIONS };
    let target = soft_target(options, |stream| Noisy { stream, seed: 2024 }).unwrap();
    let scenario = scenario("fig3a", 0.3);
    let (commands, target) = fly_there(&scenario, target);
    assert_eq!(commands.unwrap(), fly_here(&scenario));
    assert!(target.statistics().repeats > 100, "the line was not noisy: {} repeats", target.statistics().repeats);
}

/// Loses each seventh write and each eleventh read, whole.
struct Lossy {
    stream: UnixStream,
    turns: [u32; 2],
}

impl Read for Lossy {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        loop {
            let count = self.stream.read(bytes)?;
            self.turns[0] += 1;
            if count == 0 || !self.turns[0].is_multiple_of(11) {
                return Ok(count);
            }
        }
    }
}

impl Write for Lossy {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.turns[1] += 1;
        if !self.turns[1].is_multiple_of(7) {
            self.stream.write_all(bytes)?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

impl Wire for Lossy {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.stream.set_patience(patience)
    }
}

/// What instruments say goes with the state, is lost with it, and counts once however often it
/// comes.
#[test]
fn on_instruments_a_question_that_is_lost_changes_nothing() {
    let scenario = scenario("on-instruments", 3.0);
    let whole = Target::connect(Endpoint::Here, None, OPTIONS).unwrap();
    let (whole, _) = fly_there(&scenario, whole);
    let options = Options { retry: Duration::from_millis(4), ..OPTIONS };
    let (commands, target) =
        fly_there(&scenario, soft_target(options, |stream| Lossy { stream, turns: [0; 2] }).unwrap());
    assert!(commands.unwrap() == whole.unwrap(), "another flight");
    assert!(target.statistics().repeats > 200, "{} repeats", target.statistics().repeats);
}

/// Loses each tenth of what the target says whole reads at a time, if it is telemetry.
struct Deaf {
    stream: UnixStream,
    heard: u32,
}

impl Read for Deaf {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let count = self.stream.read(bytes)?;
        // A frame of MAVLink 2 begins with its sign and has the message's number from the eighth
        // byte on.
        let telemetry = <link::dialect::LOAD_TELEMETRY_DATA as mavlink_core::MessageData>::ID.to_le_bytes();
        if bytes.first() == Some(&0xfd) && bytes.get(7..10) == Some(&telemetry[..3]) {
            self.heard += 1;
            if self.heard.is_multiple_of(10) {
                bytes[9] ^= 1;
            }
        }
        Ok(count)
    }
}

impl Write for Deaf {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

impl Wire for Deaf {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.stream.set_patience(patience)
    }
}

/// What is missing from a log is counted.
#[test]
fn telemetry_that_is_lost_is_counted() {
    let options = Options { telemetry: true, ..OPTIONS };
    let mut target = soft_target(options, |stream| Deaf { stream, heard: 0 }).unwrap();
    let scenario = scenario("fig3a", 3.0);
    target.prepare(&scenario).unwrap();
    let flight = fly(&scenario, &mut target);
    assert_eq!(flight.end, End::Complete);
    let decided = flight.log.iter().filter_map(|sample| sample.decision);
    let missing = decided.filter(|decision| decision.telemetry.is_none()).count() as u64;
    assert!(missing > 5, "{missing}");
    assert_eq!(target.statistics().telemetry_lost, missing);
}

/// Answers come later than they are asked for again.
struct Slow {
    stream: UnixStream,
    reads: u32,
}

impl Read for Slow {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.reads += 1;
        if self.reads.is_multiple_of(7) {
            std::thread::sleep(Duration::from_millis(12));
        }
        self.stream.read(bytes)
    }
}

impl Write for Slow {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.stream.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

impl Wire for Slow {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.stream.set_patience(patience)
    }
}

#[test]
fn delay_changes_nothing() {
    let options = Options { retry: Duration::from_millis(3), ..OPTIONS };
    let target = soft_target(options, |stream| Slow { stream, reads: 0 }).unwrap();
    let scenario = scenario("fig3b", 0.5);
    let (commands, _) = fly_there(&scenario, target);
    assert_eq!(commands.unwrap(), fly_here(&scenario));
}

#[test]
fn real_time_flies_the_path_too() {
    let options = Options { pace: Pace::RealTime, ..OPTIONS };
    let target = soft_target(options, |stream| stream).unwrap();
    // On the steady motion: a command of the period before, or two, is almost the right one.
    let mut scenario = scenario("fig2a", 2.0);
    scenario.obstacle = None;
    let mut target = Recorded::new(target);
    target.inner.prepare(&scenario).unwrap();
    let begun = Instant::now();
    let flight = fly(&scenario, &mut target);
    assert_eq!(flight.end, End::Complete, "{:?}", target.inner.take_failure());
    assert!(begun.elapsed() >= Duration::from_secs_f64(0.95 * scenario.duration_s), "by the clock on the wall");
    let last = flight.log.last().expect("the end is logged").x;
    let off = scenario.controller.law.distance([last[0], last[1], last[2]]);
    assert!(off < 0.5, "{off} m from the path");
}

/// Somebody who accepts one connection and does with it what `habit` says.
fn listener(name: &str, habit: impl FnOnce(UnixStream) + Send + 'static) -> Endpoint {
    let path = std::env::temp_dir().join(format!("hil-test-{}-{name}.sock", std::process::id()));
    let _ = std::fs::remove_file(&path);
    let listener = UnixListener::bind(&path).expect("a socket in the temporary folder");
    std::thread::spawn(move || {
        let (stream, _) = listener.accept().expect("someone connects");
        let _ = std::fs::remove_file(path);
        habit(stream);
    });
    Endpoint::Unix(std::env::temp_dir().join(format!("hil-test-{}-{name}.sock", std::process::id())))
}

const HASTY: Options = Options { patience: Duration::from_millis(300), ..OPTIONS };

fn refused(endpoint: Endpoint) -> HilError {
    let begun = Instant::now();
    let error = Target::connect(endpoint, None, HASTY).err().expect("nobody is there to fly with");
    assert!(begun.elapsed() < Duration::from_secs(3), "took {:?}", begun.elapsed());
    error
}

#[test]
fn a_silent_target_is_named() {
    let error = refused(listener("silent", |_stream| std::thread::sleep(Duration::from_secs(1))));
    assert!(matches!(error, HilError::Silent { .. }), "{error}");
}

#[test]
fn gibberish_is_named() {
    let error = refused(listener("gibberish", |mut stream| {
        for byte in 0..100_u8 {
            let _ = stream.write_all(&[byte; 32]);
            std::thread::sleep(Duration::from_millis(4));
        }
    }));
    assert!(matches!(error, HilError::Unintelligible { .. }), "{error}");
}

#[test]
fn another_dialect_is_named() {
    use link::dialect::{MavParamType, PARAM_VALUE_DATA};
    let error = refused(listener("dialect", |mut stream| {
        let _ = stream.read(&mut [0; 256]);
        let value = link::MavMessage::PARAM_VALUE(PARAM_VALUE_DATA {
            param_value: 1.0,
            param_count: 1,
            param_index: 0,
            param_id: link::name("LINK_DIALECT"),
            param_type: MavParamType::MAV_PARAM_TYPE_REAL32 as u8,
        });
        let _ = stream.write_all(link::Encoder::new(link::CONTROLLER).frame(&value).bytes());
        std::thread::sleep(Duration::from_secs(1));
    }));
    assert!(matches!(error, HilError::Dialect { theirs: 1, ours: link::FINGERPRINT }), "{error}");
}

#[test]
fn a_missing_port_or_socket_is_named() {
    let error = refused(Endpoint::Serial { port: "/dev/no-such-port".into(), baud: 921_600 });
    assert!(error.to_string().contains("/dev/no-such-port"), "{error}");
    let error = refused(Endpoint::Unix("/no/such/socket".into()));
    assert!(error.to_string().contains("unix:/no/such/socket"), "{error}");
    assert!("serial:x".parse::<Endpoint>().is_err());
    // Datagrams go to nobody without an error: that none comes back is what shows.
    let error = refused("udp:127.0.0.1:9".parse().unwrap());
    assert!(matches!(error, HilError::Silent { .. }) && error.to_string().contains("udp:127.0.0.1:9"), "{error}");
}

#[test]
fn a_line_that_stays_down_ends_the_flight() {
    let options = Options { patience: Duration::from_millis(500), ..OPTIONS };
    let target = soft_target(options, |stream| Ending { stream: Some(stream), reads: 2_000 }).unwrap();
    let (commands, _) = fly_there(&scenario("fig3a", 10.0), target);
    let error = commands.expect_err("the line has ended");
    assert!(matches!(error, HilError::Down { .. }), "{error}");
}

#[test]
fn every_logged_sample_has_its_telemetry() {
    let options = Options { telemetry: true, ..OPTIONS };
    // Also where the law starts anew at another sample than those that are logged.
    let mut stopped = scenario("fig2a", 8.0);
    stopped.log_period_s = 0.007;
    for scenario in [scenario("fig5", 2.0), stopped] {
        let mut target = soft_target(options, |stream| stream).unwrap();
        target.prepare(&scenario).unwrap();
        let there = fly(&scenario, &mut target);
        let here = fly(&scenario, &mut Pilot::<f32>::new(&scenario.controller).unwrap());
        assert_eq!((there.end, there.log.len()), (End::Complete, here.log.len()));
        for (there, here) in there.log.iter().zip(&here.log) {
            let decisions = there.decision.zip(here.decision);
            assert_eq!(there.decision.is_some(), here.decision.is_some());
            if let Some((there, here)) = decisions {
                assert_eq!(there.margins, here.margins);
                let (there, here) = (there.telemetry.unwrap(), here.telemetry.unwrap());
                assert_eq!((there.xi, there.nu, there.integral), (here.xi, here.nu, here.integral));
            }
        }
    }
}
