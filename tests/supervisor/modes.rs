//! Every edge of the transition table, as the documentation of `controller::Supervisor` has it.

use controller::{Fault, Follow, Law, Margin, Measured, Mode, Path, Policy, Request, Sampling, State, Uav, Vector3};

use crate::flight::{CIRCLE, Flight, PERIOD, supervisor};

const DOCUMENTATION: &str = include_str!("../../controller/src/flight/supervisor/mod.rs");

/// The table: its columns' names, and the rows' cells with the mode's name first.
fn table() -> Vec<Vec<String>> {
    let rows = DOCUMENTATION.lines().filter_map(|line| line.strip_prefix("/// |"));
    let rows = rows.filter(|row| !row.starts_with('-'));
    rows.map(|row| {
        row.trim_end_matches('|').split('|').map(|cell| cell.trim().trim_matches('`').to_owned()).collect()
    })
    .collect()
}

fn mode(name: &str) -> Mode {
    let all = [Mode::Off, Mode::Idle, Mode::TakeOff, Mode::Join, Mode::Follow, Mode::Hold, Mode::Land, Mode::Fault];
    all.into_iter().find(|mode| format!("{mode:?}") == name).unwrap()
}

/// A flight in `mode`, and the request that keeps it there.
fn flight_in(mode: Mode) -> (Flight<Follow<f32, impl Path<f32>>>, Request) {
    let law = supervisor(Sampling::every(PERIOD as f32), Policy::default());
    // A metre outside the circle.
    let start = State::at_rest(Vector3::new(CIRCLE[0] + 1.0, 0.0, CIRCLE[1]));
    let mut flight = Flight::new(law, &start, 0.5, 29.43, 0.0);
    let request = match mode {
        Mode::Off => Request::Off,
        Mode::Idle => {
            flight.until(Mode::Off, Request::Off, 1.0);
            Request::Idle
        }
        Mode::TakeOff => {
            flight.until(Mode::Off, Request::Off, 1.0);
            flight.step(Request::Idle);
            flight.step_knowing(true, Some(&flight.uav()), Request::Hold);
            Request::Hold
        }
        Mode::Join | Mode::Follow => Request::Follow,
        Mode::Land => Request::Land,
        _ => Request::Hold,
    };
    if mode == Mode::Fault {
        while flight.supervisor.mode() != Mode::Fault {
            flight.step_seeing(None, request);
        }
    } else {
        flight.until(mode, request, 30.0);
    }
    (flight, request)
}

/// The mode after `event` in `from`.
fn after(event: &str, from: Mode) -> Mode {
    let (mut flight, standing) = flight_in(from);
    let requests = [Request::Off, Request::Idle, Request::Follow, Request::Hold, Request::Land];
    if let Some(request) = requests.into_iter().find(|request| format!("{request:?}") == event) {
        return flight.step(request).mode;
    }
    match event {
        "path reached" => {
            while flight.supervisor.law().approach().is_active() {
                assert_eq!(flight.step(standing).mode, from);
            }
            flight.step(standing).mode
        }
        "margin beyond" => {
            let mut leaning: State<f32> = flight.body.state().cast();
            let (sin, cos) = 1.4_f32.sin_cos();
            leaning.rod = Vector3::new(sin, 0.0, cos);
            let output = flight.step_seeing(Some(&leaning), standing);
            let named = [Margin::RodAngle, Margin::ThrustAngle, Margin::Thrust, Margin::Tension].map(Fault::Margin);
            let by_law = matches!(from, Mode::Join | Mode::Follow);
            assert!(!by_law || output.fault.is_some_and(|fault| named.contains(&fault)), "{output:?}");
            assert!(by_law || from == Mode::Fault || output.warning.is_some(), "{output:?}");
            output.mode
        }
        "payload lost" => {
            // What is observed is known first.
            for _ in 0..1500 {
                assert_eq!(flight.step(standing).mode, from);
            }
            // A hook's mass is left.
            flight.body.set_payload_mass(0.02);
            let lost = (0..1500).map(|_| flight.step(standing)).find(|output| output.mode != from);
            let lost = lost.expect("noticed within three seconds");
            assert_eq!(lost.fault, Some(Fault::PayloadLost));
            // And there it stays, in spite of the request.
            assert!((0..3000).all(|_| flight.step(standing).mode == Mode::Hold));
            // Until it pulls as before, for three seconds.
            flight.body.set_payload_mass(0.5);
            assert!((0..1500).all(|_| flight.step(standing).mode == Mode::Hold));
            let joins = (0..5000).map(|_| flight.step(standing)).find(|output| output.mode == Mode::Join);
            assert_eq!(joins.expect("joined again").fault, Some(Fault::Slack));
            lost.mode
        }
        "landed" => {
            // The ground carries it from here on: the state stays.
            let landed: State<f32> = flight.body.state().cast();
            let landed = State { velocity: Vector3::zeros(), rod_rate: Vector3::zeros(), ..landed };
            let steps = (0..5000).map(|_| flight.supervisor.step(Some(&landed), standing));
            steps.map(|output| output.mode).find(|mode| *mode != from).unwrap_or(from)
        }
        "caught" => {
            // Something keeps it in the air, where it can turn, and the load is not seen.
            let uav = Uav { velocity: Vector3::zeros(), body_rate: Vector3::z() * 0.3, ..flight.uav() };
            let measured = Measured { state: None, uav: Some(&uav), specific_force: None };
            let mut steps = (0..8000).map(|_| flight.supervisor.step(measured, standing));
            let caught = steps.find(|output| output.mode != from).expect("noticed");
            assert_eq!(caught.fault, Some(Fault::Caught));
            // And there it stays, in spite of the request, until another.
            assert!((0..3000).all(|_| flight.step(standing).mode == Mode::Hold));
            assert_eq!(flight.step(Request::Hold).mode, Mode::Hold);
            assert_eq!(flight.step(standing).mode, Mode::Land);
            caught.mode
        }
        "risen" => {
            let uav = flight.uav();
            let above = Uav { position: uav.position - Vector3::z() * 3.1, ..uav };
            flight.step_knowing(true, Some(&above), standing).mode
        }
        "cable slack" => {
            // Longer than a tenth of a second, with the load at half of the cable's length.
            let steps = (0.12 / PERIOD) as usize;
            let near = |uav: Uav<f32>| Uav { position: uav.position + Vector3::z(), ..uav };
            let outputs = (0..steps).map(|_| flight.step_knowing(true, Some(&near(flight.uav())), standing));
            outputs.last().unwrap().mode
        }
        "load unseen" => {
            let steps = (0.11 / PERIOD) as usize;
            let outputs = (0..steps).map(|_| flight.step_knowing(false, Some(&flight.uav()), standing));
            let output = outputs.last().unwrap();
            assert_eq!(output.fault, Some(Fault::NoState));
            output.mode
        }
        "no state" => {
            let output = flight.step_seeing(None, standing);
            assert_eq!(output.fault, Some(Fault::NoState));
            output.mode
        }
        "none for long" => {
            // Longer than the policy's tenth of a second.
            let steps = (0.11 / PERIOD) as usize;
            (0..steps).map(|_| flight.step_seeing(None, standing).mode).last().unwrap()
        }
        other => panic!("no such event: {other}"),
    }
}

#[test]
fn every_edge_is_as_documented() {
    let table = table();
    let (events, rows) = table.split_first().unwrap();
    assert_eq!((events.len(), rows.len()), (16, 8), "{table:?}");
    let mut tried = 0;
    for row in rows {
        let from = mode(&row[0]);
        for (event, to) in events.iter().zip(row).skip(1).filter(|(_, to)| !to.is_empty()) {
            assert_eq!(after(event, from), mode(to), "{event} in {from:?}");
            tried += 1;
        }
    }
    assert!(tried > 70, "{tried}");
}

#[test]
fn cut_rotors_stay_cut_until_off() {
    let policy = Policy { lost: controller::Lost::Cut, ..Policy::default() };
    let start = State::at_rest(Vector3::new(0.0, 0.0, -10.0));
    let mut flight = Flight::new(supervisor(Sampling::every(PERIOD as f32), policy), &start, 0.5, 29.43, 0.0);
    flight.step(Request::Hold);
    let blind = (0..60).map(|_| flight.step_seeing(None, Request::Hold)).last().unwrap();
    assert_eq!((blind.mode, blind.command.thrust), (Mode::Fault, 0.0));
    for request in [Request::Hold, Request::Follow, Request::Land, Request::Idle] {
        let output = flight.step(request);
        assert_eq!((output.mode, output.command.thrust), (Mode::Fault, 0.0), "{request:?}");
    }
    assert_eq!(flight.step(Request::Off).mode, Mode::Off);
    assert_eq!(flight.step(Request::Idle).mode, Mode::Idle);
}

#[test]
fn a_policy_that_does_not_resume_waits_for_a_new_request() {
    let policy = Policy { resume: false, ..Policy::default() };
    let start = State::at_rest(Vector3::new(CIRCLE[0], 0.0, CIRCLE[1]));
    let mut flight = Flight::new(supervisor(Sampling::every(PERIOD as f32), policy), &start, 0.5, 29.43, 0.0);
    flight.until(Mode::Follow, Request::Follow, 30.0);
    let mut leaning: State<f32> = flight.body.state().cast();
    leaning.rod = Vector3::new(1.0, 0.0, 0.0);
    assert_eq!(flight.step_seeing(Some(&leaning), Request::Follow).mode, Mode::Hold);
    assert!((0..5000).all(|_| flight.step(Request::Follow).mode == Mode::Hold));
    flight.step(Request::Hold);
    assert_eq!(flight.step(Request::Follow).mode, Mode::Join);
}

/// A torque that begins once the load is not seen any more.
#[test]
fn hold_without_a_load_does_not_turn_under_a_torque() {
    let (mut flight, request) = flight_in(Mode::Hold);
    flight.torque = Vector3::new(0.1, -0.1, 0.05);
    let before = flight.uav();
    for _ in 0..5000 {
        let output = flight.step_knowing(false, Some(&flight.uav()), request);
        assert_eq!(output.mode, Mode::Hold);
    }
    let now = flight.uav();
    // Measured: 4e-5 rad/s and 9 cm, of a load that still swings; not looked for, the torque turns
    // it at 0.33 rad/s for ever, 0.8 m beside its place.
    assert!(now.body_rate.z.abs() < 1e-3, "{:?}", now.body_rate);
    assert!((now.position - before.position).amax() < 0.2, "{:?}", now.position - before.position);
}
