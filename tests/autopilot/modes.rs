//! A vehicle in flight on the program, rotors and all: requests over the link, the envelope, and
//! states that fail.

use autopilot::{Answer, Autopilot, Boot, Setting};
use controller::{Command, Mode, State, Vector3};
use hil_sim::world::multibody::{Loads, Multibody};
use link::MavMessage;
use link::dialect::*;
use rig::parameter;
use witness::plant::VehicleParameters;

use crate::station::{Station, frame_of, is_flyable, see, set, start};

const PERIOD: f64 = 0.002;

/// The plant under the program.
struct Flight {
    station: Station,
    body: Multibody,
    sequence: u32,
}

impl Flight {
    /// Armed in flight, at rest 1 m outside the circle, to follow it.
    fn new() -> Self {
        Self::of(Autopilot::new(Boot::default()))
    }

    fn of(mut autopilot: Autopilot) -> Self {
        see(&mut autopilot);
        let mut station = Station::new(autopilot);
        station.ask(LoadMode::LOAD_MODE_FOLLOW);
        let (result, said) = station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
        assert_eq!(result, MavResult::MAV_RESULT_ACCEPTED as u8, "{said:?}");
        Self { station, body: Multibody::new(VehicleParameters::default(), &start().cast()), sequence: 0 }
    }

    /// A control period in which the program sees `frame`, if anything.
    fn step_seeing(&mut self, frame: Option<&LOAD_STATE_DATA>) -> Answer {
        if let Some(frame) = frame {
            self.station.autopilot.receive(frame);
        }
        let answer = self.station.autopilot.tick();
        assert!(is_flyable(&answer, self.station.autopilot.settings()), "{answer:?}");
        let LOAD_COMMAND_DATA { thrust, torque, .. } = &answer.command;
        let command = Command { thrust: f64::from(*thrust), torque: Vector3::from(*torque).map(f64::from) };
        self.body.advance(PERIOD, |_| command, |_, _| Loads::none());
        assert!(self.body.is_finite());
        answer
    }

    fn next_frame(&mut self) -> LOAD_STATE_DATA {
        self.sequence += 1;
        frame_of(&self.body.state().cast(), self.sequence)
    }

    fn step(&mut self) -> Answer {
        let frame = self.next_frame();
        self.step_seeing(Some(&frame))
    }

    /// A period in which the program sees the rod almost level.
    fn step_leaning(&mut self) -> Answer {
        let (sin, cos) = 1.4_f32.sin_cos();
        let frame = LOAD_STATE_DATA { rod: [sin, 0.0, cos], ..self.next_frame() };
        self.step_seeing(Some(&frame))
    }

    fn mode(&self) -> Mode {
        self.station.autopilot.mode()
    }

    /// Up to `seconds`, until `mode` is reached.
    fn until(&mut self, mode: Mode, seconds: f64) {
        for _ in 0..(seconds / PERIOD) as usize {
            self.step();
            if self.mode() == mode {
                return;
            }
        }
        panic!("{mode:?} not reached in {seconds} s: {:?}, {:?}", self.mode(), self.station.autopilot.fault());
    }

    fn ask(&mut self, mode: LoadMode) {
        assert_eq!(self.station.ask(mode).0, MavResult::MAV_RESULT_ACCEPTED as u8);
    }
}

#[test]
fn what_the_pilot_asks_for_over_the_link_is_done() {
    let mut flight = Flight::new();
    flight.until(Mode::Follow, 30.0);
    assert_eq!(flight.station.news(), ["on the path"]);
    flight.ask(LoadMode::LOAD_MODE_HOLD);
    flight.step();
    assert_eq!((flight.mode(), flight.station.news()), (Mode::Hold, vec!["hold".to_owned()]));
    flight.ask(LoadMode::LOAD_MODE_FOLLOW);
    flight.step();
    assert_eq!((flight.mode(), flight.station.news()), (Mode::Join, vec!["joining the path".to_owned()]));
    flight.until(Mode::Follow, 30.0);
    // In flight, to idle is to hold.
    flight.ask(LoadMode::LOAD_MODE_IDLE);
    flight.step();
    assert_eq!(flight.mode(), Mode::Hold);
    assert_eq!(flight.station.autopilot.counters().fallbacks, 0);
}

#[test]
fn on_the_ground_it_disarms() {
    let mut flight = Flight::new();
    flight.until(Mode::Follow, 30.0);
    flight.ask(LoadMode::LOAD_MODE_LAND);
    for _ in 0..1000 {
        flight.step();
    }
    assert_eq!(flight.mode(), Mode::Land);
    // From here on the ground carries it.
    let landed = State { velocity: Vector3::zeros(), rod_rate: Vector3::zeros(), ..flight.body.state().cast() };
    let down = (0..5000).map(|_| {
        flight.sequence += 1;
        flight.step_seeing(Some(&frame_of(&landed, flight.sequence)))
    });
    let last = down.skip_while(|answer| answer.command.mode != LoadMode::LOAD_MODE_OFF).last().expect("it lands");
    assert_eq!(last.outputs, [0.0; 4]);
    assert!(!flight.station.autopilot.is_armed());
}

#[test]
fn px4_s_modes_are_those_that_mavsdk_means() {
    let ask = |flight: &mut Flight, sub: f32| {
        let custom = MavModeFlag::MAV_MODE_FLAG_CUSTOM_MODE_ENABLED as u32 as f32;
        let command = MavCmd::MAV_CMD_DO_SET_MODE as u16;
        let request =
            COMMAND_LONG_DATA { param1: custom, param2: 4.0, param3: sub, command, ..COMMAND_LONG_DATA::DEFAULT };
        let replies = flight.station.say(&MavMessage::COMMAND_LONG(request));
        matches!(&replies[..], [.., MavMessage::COMMAND_ACK(ack)] if ack.result == 0)
    };
    let mut flight = Flight::new();
    flight.until(Mode::Follow, 30.0);
    for (sub, mode) in [(3.0, Mode::Hold), (4.0, Mode::Join), (6.0, Mode::Land)] {
        assert!(ask(&mut flight, sub), "{mode:?}");
        flight.step();
        assert_eq!(flight.mode(), mode);
    }
    // A return to launch is none of them.
    assert!(!ask(&mut flight, 5.0));
    assert_eq!(flight.mode(), Mode::Land);
}

#[test]
fn modes_that_cannot_be_asked_for_are_denied_in_words() {
    let mut station = Station::new(Autopilot::new(Boot::default()));
    for mode in [LoadMode::LOAD_MODE_OFF, LoadMode::LOAD_MODE_ENGAGE, LoadMode::LOAD_MODE_FAULT] {
        let (result, said) = station.ask(mode);
        assert_eq!(result, MavResult::MAV_RESULT_DENIED as u8, "{mode:?}");
        assert_eq!(said, ["modes: idle, follow, hold, land, take-off"]);
    }
    // Without the flag it is no mode of this dialect.
    let (result, _) = station.command(MavCmd::MAV_CMD_DO_SET_MODE, 0.0, LoadMode::LOAD_MODE_HOLD as u32 as f32);
    assert_eq!(result, MavResult::MAV_RESULT_DENIED as u8);
}

#[test]
fn beyond_the_envelope_it_holds_says_why_and_goes_back() {
    let mut flight = Flight::new();
    flight.until(Mode::Follow, 30.0);
    flight.station.news();
    let answer = flight.step_leaning();
    assert_eq!(answer.command.mode, LoadMode::LOAD_MODE_HOLD);
    let margins = LoadFault::LOAD_FAULT_ROD_ANGLE
        | LoadFault::LOAD_FAULT_THRUST_ANGLE
        | LoadFault::LOAD_FAULT_TENSION
        | LoadFault::LOAD_FAULT_THRUST;
    let named = answer.command.faults & margins;
    assert!(named.bits().is_power_of_two(), "{:?}", answer.command.faults);
    let said = flight.station.news();
    assert!(said.len() == 1 && said[0].starts_with("hold: "), "{said:?}");
    assert_eq!(flight.station.autopilot.counters().fallbacks, 1);

    flight.until(Mode::Join, 30.0);
    flight.until(Mode::Follow, 30.0);
    // The reason is known until something else is asked for.
    assert!(flight.step().command.faults.contains(named));
    flight.ask(LoadMode::LOAD_MODE_HOLD);
    assert!(!flight.step().command.faults.intersects(margins));
}

#[test]
fn a_policy_that_does_not_resume_waits_to_be_asked_again() {
    let mut autopilot = Autopilot::new(Boot::default());
    set(&mut autopilot, parameter!("POL_RESUME"), 0.0);
    let mut flight = Flight::of(autopilot);
    flight.until(Mode::Follow, 30.0);
    flight.step_leaning();
    assert!((0..5000).all(|_| flight.step().command.mode == LoadMode::LOAD_MODE_HOLD));
    flight.ask(LoadMode::LOAD_MODE_HOLD);
    flight.step();
    flight.ask(LoadMode::LOAD_MODE_FOLLOW);
    flight.until(Mode::Follow, 30.0);
}

/// States that are missing, stale, or no numbers: carried over while they are few, then sunk from,
/// and back to the path once they return.
#[test]
fn failing_states_lead_to_fault_and_back() {
    type Failure = fn(&mut Flight) -> Option<LOAD_STATE_DATA>;
    let failures: [(&str, LoadFault, Failure); 3] = [
        ("missing", LoadFault::LOAD_FAULT_NO_STATE, |_| None),
        ("stale", LoadFault::LOAD_FAULT_NO_STATE, |flight| {
            Some(frame_of(&flight.body.state().cast(), flight.sequence))
        }),
        ("no number", LoadFault::LOAD_FAULT_BAD_STATE, |flight| {
            Some(LOAD_STATE_DATA { velocity: [f32::NAN; 3], ..flight.next_frame() })
        }),
    ];
    for (name, fault, failure) in failures {
        let mut flight = Flight::new();
        flight.until(Mode::Follow, 30.0);
        for (periods, mode) in [(40, Mode::Follow), (60, Mode::Fault)] {
            for _ in 0..periods {
                let frame = failure(&mut flight);
                let answer = flight.step_seeing(frame.as_ref());
                assert!(answer.command.faults.contains(fault), "{name}");
            }
            assert_eq!(flight.mode(), mode, "{name}");
        }
        flight.step();
        assert_eq!(flight.mode(), Mode::Hold, "{name}");
        flight.until(Mode::Follow, 60.0);
    }
}

#[test]
fn what_the_observers_find_is_told_in_newtons_and_kilograms() {
    let mut autopilot = Autopilot::new(Boot::default());
    autopilot.settings_mut().unwrap().set(Setting::TELEMETRY_EVERY, 1.0).unwrap();
    let mut flight = Flight::of(autopilot);
    // Not the half kilogram that the law is told.
    flight.body.set_payload_mass(0.65);
    flight.ask(LoadMode::LOAD_MODE_HOLD);
    let last = (0..5000).map(|_| flight.step()).last().unwrap();
    let telemetry = last.telemetry.expect("every step has it");
    assert!((telemetry.payload_mass - 0.65).abs() < 0.01, "{telemetry:?}");
    // The weight that is more.
    assert!((telemetry.payload_force[2] - 0.15 * 9.81).abs() < 0.01, "{telemetry:?}");
    assert_eq!(telemetry.warning, LoadFault::empty());
    let warned = (0..200)
        .map(|_| flight.step_leaning())
        .find_map(|answer| answer.telemetry.map(|telemetry| telemetry.warning).filter(|warning| !warning.is_empty()));
    assert!(warned.is_some());
}
