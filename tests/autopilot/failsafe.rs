//! Nobody is heard any more, the battery is low, the pilot's switches, and rotors that do not run
//! for ever.

use autopilot::{Autopilot, Setting};
use controller::{Mode, Request};
use link::MavMessage;
use link::dialect::*;

use crate::station::{Station, arm, arm_in_flight, driven, fly, frame};

const PERIOD_S: f32 = 0.002;

fn configure(autopilot: &mut Autopilot, setting: Setting, value: f32) {
    autopilot.settings_mut().unwrap().set(setting, value).unwrap();
}

fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(HEARTBEAT_DATA { mavtype: MavType::MAV_TYPE_GCS as u8, ..HEARTBEAT_DATA::DEFAULT })
}

fn joystick(buttons: u16) -> MavMessage {
    MavMessage::MANUAL_CONTROL(MANUAL_CONTROL_DATA { target: 1, buttons, ..MANUAL_CONTROL_DATA::DEFAULT })
}

fn radio(chan5_raw: u16, chan6_raw: u16) -> MavMessage {
    MavMessage::RC_CHANNELS_OVERRIDE(RC_CHANNELS_OVERRIDE_DATA {
        target_system: 1,
        chan5_raw,
        chan6_raw,
        ..RC_CHANNELS_OVERRIDE_DATA::DEFAULT
    })
}

fn battery(battery_remaining: i8) -> MavMessage {
    pack(0, battery_remaining)
}

fn pack(id: u8, battery_remaining: i8) -> MavMessage {
    MavMessage::BATTERY_STATUS(BATTERY_STATUS_DATA { id, battery_remaining, ..BATTERY_STATUS_DATA::DEFAULT })
}

/// In flight, on its way to the path.
struct Flying {
    station: Station,
    sequence: u32,
}

impl Flying {
    fn with(settings: &[(Setting, f32)]) -> Self {
        let mut autopilot = driven(0.0);
        for &(setting, value) in settings {
            configure(&mut autopilot, setting, value);
        }
        arm_in_flight(&mut autopilot);
        let mut flying = Self { station: Station::new(autopilot), sequence: 0 };
        flying.fly(PERIOD_S);
        assert_eq!(flying.mode(), Mode::Join);
        flying.station.news();
        flying
    }

    /// Flies on good states. Returns the last step's faults.
    fn fly(&mut self, seconds: f32) -> LoadFault {
        let mut faults = LoadFault::empty();
        for _ in 0..(seconds / PERIOD_S).round() as u32 {
            self.sequence += 1;
            faults = fly(&mut self.station.autopilot, self.sequence).command.faults;
        }
        faults
    }

    fn mode(&self) -> Mode {
        self.station.autopilot.mode()
    }
}

#[test]
fn a_ground_station_that_was_heard_and_is_silent_is_lost() {
    for (action, mode) in [(0.0, Mode::Join), (1.0, Mode::Hold), (2.0, Mode::Land)] {
        let mut flying = Flying::with(&[(Setting::STATION_TIMEOUT, 0.5), (Setting::STATION_ACTION, action)]);
        // Never heard, never lost.
        flying.fly(1.0);
        assert_eq!(flying.mode(), Mode::Join);
        flying.station.say(&heartbeat());
        flying.fly(0.45);
        flying.station.say(&heartbeat());
        assert!(!flying.fly(0.45).contains(LoadFault::LOAD_FAULT_STATION_LOST));
        assert!(flying.fly(0.1).contains(LoadFault::LOAD_FAULT_STATION_LOST));
        assert_eq!(flying.mode(), mode);
        assert_eq!(flying.station.news()[0], "ground station lost: FS_GCS_ACT");
        // Heard again, it may ask for what it will.
        flying.station.say(&heartbeat());
        flying.station.ask(LoadMode::LOAD_MODE_HOLD);
        assert!(!flying.fly(0.1).contains(LoadFault::LOAD_FAULT_STATION_LOST));
        assert_eq!(flying.mode(), Mode::Hold);
    }
}

#[test]
fn a_heartbeat_of_another_vehicle_is_no_ground_station_s() {
    let mut flying = Flying::with(&[(Setting::STATION_TIMEOUT, 0.5)]);
    let other = MavType::MAV_TYPE_GENERIC_MULTIROTOR as u8;
    flying.station.say(&MavMessage::HEARTBEAT(HEARTBEAT_DATA { mavtype: other, ..HEARTBEAT_DATA::DEFAULT }));
    flying.fly(1.0);
    assert_eq!(flying.mode(), Mode::Join);
}

#[test]
fn a_stick_that_is_lost_has_its_end_and_a_landing_is_not_called_off() {
    for message in [joystick(0), radio(0, 0)] {
        let mut flying = Flying::with(&[(Setting::STICK_TIMEOUT, 0.2), (Setting::STATION_TIMEOUT, 0.4)]);
        flying.station.say(&message);
        flying.station.say(&heartbeat());
        assert!(flying.fly(0.3).contains(LoadFault::LOAD_FAULT_STICK_LOST));
        assert_eq!(
            (flying.mode(), flying.station.news().remove(0)),
            (Mode::Hold, "stick or radio lost: FS_RC_ACT".into())
        );
        flying.station.ask(LoadMode::LOAD_MODE_LAND);
        // The station's own action would be to hold.
        assert!(flying.fly(0.3).contains(LoadFault::LOAD_FAULT_STATION_LOST));
        assert_eq!(flying.mode(), Mode::Land);
    }
}

#[test]
fn a_low_battery_lands_once_and_keeps_it_down() {
    let mut flying = Flying::with(&[]);
    for (percent, mode) in [(-1, Mode::Join), (80, Mode::Join), (15, Mode::Join), (14, Mode::Land)] {
        flying.station.say(&battery(percent));
        let faults = flying.fly(0.01);
        assert_eq!(
            (flying.mode(), faults.contains(LoadFault::LOAD_FAULT_BATTERY)),
            (mode, mode == Mode::Land),
            "{percent}"
        );
    }
    assert_eq!(flying.station.news()[0], "battery below FS_BAT_PCT: FS_BAT_ACT");
    // The pilot may know better.
    flying.station.ask(LoadMode::LOAD_MODE_HOLD);
    flying.fly(0.01);
    assert_eq!(flying.mode(), Mode::Hold);
    flying.station.autopilot.disarm();
    flying.fly(0.01);
    let (result, said) = flying.station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
    assert_eq!(
        (result, said),
        (MavResult::MAV_RESULT_TEMPORARILY_REJECTED as u8, vec!["not armed: battery below FS_BAT_PCT".into()])
    );
}

/// The other pack's report does not end the loss, so that the next of the first is no new one.
#[test]
fn the_emptiest_battery_counts() {
    let mut flying = Flying::with(&[]);
    for (id, percent) in [(0, 60), (1, 14)] {
        flying.station.say(&pack(id, percent));
    }
    flying.fly(0.01);
    assert_eq!(flying.mode(), Mode::Land);
    flying.station.ask(LoadMode::LOAD_MODE_HOLD);
    for _ in 0..5 {
        for (id, percent) in [(0, 60), (1, 14)] {
            flying.station.say(&pack(id, percent));
            assert!(flying.fly(0.01).contains(LoadFault::LOAD_FAULT_BATTERY));
        }
    }
    assert_eq!(flying.mode(), Mode::Hold);
}

/// A mode switch says some mode before arming too, and is not obeyed until it is turned.
#[test]
fn a_mode_switch_before_arming_asks_for_nothing() {
    for place in [1100, 1500, 1900] {
        let mut autopilot = driven(0.0);
        configure(&mut autopilot, Setting::MODE_CHANNEL, 5.0);
        let mut station = Station::new(autopilot);
        station.say(&radio(place, 1000));
        arm(&mut station.autopilot);
        station.say(&radio(place, 1000));
        for sequence in 1..100 {
            fly(&mut station.autopilot, sequence);
            assert_eq!(station.autopilot.mode(), Mode::Idle, "{place}");
        }
        let (turned, mode) = if place == 1500 { (1900, Request::Follow) } else { (1500, Request::Hold) };
        station.say(&radio(turned, 1000));
        assert_eq!(station.autopilot.requested(), mode);
    }
}

/// What gives a channel back to the radio, or says that it has no value, turns no switch.
#[test]
fn only_a_pulse_turns_a_switch() {
    let mut flying = Flying::with(&[(Setting::MODE_CHANNEL, 5.0), (Setting::KILL_CHANNEL, 6.0)]);
    flying.station.say(&radio(1900, 1000));
    for none in [0, 1, 799, 2201, 65534, 65535] {
        flying.station.say(&radio(none, none));
        flying.fly(0.01);
        assert!(flying.station.autopilot.is_armed(), "{none}");
        assert_eq!(flying.mode(), Mode::Join, "{none}");
    }
    flying.station.say(&radio(1900, 1800));
    assert!(!flying.station.autopilot.is_armed());
    // Nor does it turn a kill switch back.
    flying.station.say(&radio(1900, 0));
    let (_, said) = flying.station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
    assert_eq!(said, ["not armed: the kill switch is on"]);
}

/// Each of two senders has its own switches.
#[test]
fn a_joystick_does_not_turn_the_radio_s_switches() {
    let channels = [(Setting::MODE_CHANNEL, 5.0), (Setting::KILL_CHANNEL, 6.0)];
    let mut flying = Flying::with(&channels);
    flying.station.say(&radio(1500, 1000));
    flying.fly(0.01);
    assert_eq!(flying.mode(), Mode::Hold);
    flying.station.ask(LoadMode::LOAD_MODE_LAND);
    for _ in 0..5 {
        flying.station.say(&joystick(0));
        flying.station.say(&radio(1500, 1000));
        flying.fly(0.01);
        assert_eq!(flying.mode(), Mode::Land);
    }
    flying.station.say(&radio(1500, 1800));
    flying.station.say(&joystick(0));
    let (_, said) = flying.station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
    assert_eq!(said, ["not armed: the kill switch is on"]);
}

#[test]
fn the_pilot_s_switches_change_modes_and_stop_the_rotors() {
    let channels = [(Setting::MODE_CHANNEL, 5.0), (Setting::KILL_CHANNEL, 6.0)];
    let mut flying = Flying::with(&channels);
    // Without values, and then each of the three places; the same place again asks for nothing.
    for (place, mode) in
        [(0, Mode::Join), (65535, Mode::Join), (1500, Mode::Hold), (1900, Mode::Join), (1100, Mode::Land)]
    {
        flying.station.say(&radio(place, 1000));
        flying.fly(0.01);
        assert_eq!(flying.mode(), mode, "{place}");
    }
    flying.station.ask(LoadMode::LOAD_MODE_HOLD);
    flying.station.say(&radio(1100, 1000));
    flying.fly(0.01);
    assert_eq!(flying.mode(), Mode::Hold);
    flying.station.say(&radio(1100, 1800));
    assert!(!flying.station.autopilot.is_armed());
    assert_eq!(flying.station.news()[0], "rotors stopped by the kill switch");
    flying.fly(0.01);
    let (_, said) = flying.station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
    assert_eq!(said, ["not armed: the kill switch is on"]);

    let buttons = [(Setting::HOLD_BUTTON, 1.0), (Setting::LAND_BUTTON, 2.0), (Setting::KILL_BUTTON, 16.0)];
    let mut flying = Flying::with(&buttons);
    for (pressed, mode) in [(0, Mode::Join), (1, Mode::Hold), (0, Mode::Hold), (2, Mode::Land), (4, Mode::Land)] {
        flying.station.say(&joystick(pressed));
        flying.fly(0.01);
        assert_eq!(flying.mode(), mode, "{pressed}");
    }
    flying.station.say(&joystick(1 << 15));
    assert!(!flying.station.autopilot.is_armed());
}

#[test]
fn without_a_state_rotors_stop_after_a_while() {
    for idle in [true, false] {
        let mut autopilot = driven(0.0);
        configure(&mut autopilot, Setting::BLIND_TIMEOUT, 3.0);
        if idle {
            arm(&mut autopilot);
        } else {
            arm_in_flight(&mut autopilot);
        }
        fly(&mut autopilot, 1);
        let mut station = Station::new(autopilot);
        let turning =
            (0..3000).take_while(|_| station.autopilot.tick().outputs != [0.0; 4]).count() as f32 * PERIOD_S;
        // In flight it coasts first.
        let expected = if idle { 3.0 } else { 3.1 };
        assert!((turning - expected).abs() < 0.05, "{turning}");
        assert!(!station.autopilot.is_armed());
        assert!(station.news().contains(&"rotors stopped: no state for FS_BLIND_T".to_owned()));
    }
}

#[test]
fn in_lockstep_nothing_is_timed_by_the_link() {
    let mut autopilot = driven(1.0);
    arm_in_flight(&mut autopilot);
    let mut station = Station::new(autopilot);
    station.say(&heartbeat());
    station.say(&joystick(0));
    for sequence in 1..5000 {
        let action = if sequence == 1 { LoadAction::LOAD_ACTION_ENGAGE } else { LoadAction::LOAD_ACTION_CONTINUE };
        let answer = station.autopilot.lockstep(&LOAD_STATE_DATA { action, ..frame(sequence) });
        assert!(
            !answer.command.faults.intersects(LoadFault::LOAD_FAULT_STATION_LOST | LoadFault::LOAD_FAULT_STICK_LOST)
        );
    }
}
