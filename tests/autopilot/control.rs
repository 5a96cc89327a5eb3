//! When the law is stepped, on which state, and what is counted and reported.

use autopilot::{Autopilot, Boot, NotKept, Server, Setting, Settings};
use controller::{Mode, Request};
use link::MavMessage;
use link::dialect::*;
use proptest::prelude::*;
use rig::{Refused, parameter, run};

use crate::station::{Station, arm, arm_in_flight, armed, driven, fly, frame, is_flyable, see, set};

#[test]
fn nothing_turns_unless_armed_and_given_a_state() {
    let mut autopilot = Autopilot::new(Boot::default());
    let answer = fly(&mut autopilot, 1);
    assert_eq!(answer.outputs, [0.0; 4]);
    assert!(answer.command.faults.contains(LoadFault::LOAD_FAULT_NOT_ARMED));

    autopilot.arm().unwrap();
    assert_eq!((autopilot.tick().outputs, autopilot.mode()), ([0.0; 4], Mode::Off));

    let idle = fly(&mut autopilot, 2);
    assert_eq!(autopilot.mode(), Mode::Idle);
    assert!(idle.outputs.iter().all(|&duty| duty > 0.05 && duty < 0.12), "{idle:?}");

    autopilot.disarm();
    assert_eq!(fly(&mut autopilot, 3).outputs, [0.0; 4]);
}

#[test]
fn asked_before_it_is_armed_it_takes_over_in_flight() {
    for (request, mode) in [(Request::Follow, Mode::Join), (Request::Hold, Mode::Hold), (Request::Land, Mode::Land)] {
        let mut autopilot = driven(0.0);
        autopilot.request(request);
        arm(&mut autopilot);
        let answer = fly(&mut autopilot, 1);
        assert_eq!(autopilot.mode(), mode);
        assert!(answer.outputs.iter().all(|&duty| duty > 0.3), "{answer:?}");
        // What was asked for was for that flight.
        autopilot.disarm();
        autopilot.arm().unwrap();
        fly(&mut autopilot, 2);
        assert_eq!(autopilot.mode(), Mode::Idle);
    }
}

#[test]
fn a_simulated_vehicle_turns_no_rotor() {
    for simulate in [1.0, 2.0] {
        let mut autopilot = armed(simulate);
        let answer = if simulate < 1.5 {
            autopilot.lockstep(&LOAD_STATE_DATA { action: LoadAction::LOAD_ACTION_START, ..frame(1) })
        } else {
            fly(&mut autopilot, 1)
        };
        assert!(answer.command.rotor.iter().all(|&duty| duty > 0.3));
        assert_eq!(answer.outputs, [0.0; 4]);
    }
}

#[test]
fn on_the_ground_it_idles_until_it_is_asked_to_fly() {
    let mut autopilot = driven(0.0);
    arm(&mut autopilot);
    for sequence in 1..1000 {
        fly(&mut autopilot, sequence);
        assert_eq!(autopilot.mode(), Mode::Idle);
    }
    autopilot.request(Request::Hold);
    fly(&mut autopilot, 1000);
    assert_eq!(autopilot.mode(), Mode::Hold);
}

#[test]
fn a_lost_state_is_carried_by_the_model_then_sunk_from_then_flown_again() {
    let mut autopilot = armed(0.0);
    fly(&mut autopilot, 1);
    let last = fly(&mut autopilot, 2);
    // 0.1 s at 2 ms, to within the sum's rounding, in which the law goes on as smoothly as before.
    let mut last = last.outputs;
    for _ in 0..49 {
        let answer = autopilot.tick();
        let largest = answer.outputs.iter().zip(last).map(|(now, then)| (now - then).abs()).fold(0.0, f32::max);
        assert!(largest < 1e-3 && autopilot.mode() == Mode::Join, "{largest}");
        assert!(autopilot.fault().is_none());
        last = answer.outputs;
        assert!(answer.command.faults.contains(LoadFault::LOAD_FAULT_NO_STATE));
    }
    autopilot.tick();
    for _ in 0..1000 {
        let answer = autopilot.tick();
        assert_eq!(autopilot.mode(), Mode::Fault);
        assert_eq!((answer.command.thrust, answer.command.torque), (0.9 * 3.0 * 9.81, [0.0; 3]));
    }
    assert_eq!((autopilot.counters().missed, autopilot.counters().fallbacks), (1050, 1));
    let again = fly(&mut autopilot, 3);
    assert_eq!(autopilot.mode(), Mode::Hold);
    // Without a bump: from the sinking's thrust on.
    assert!((again.command.thrust - 0.9 * 3.0 * 9.81).abs() < 0.2, "{}", again.command.thrust);
}

#[test]
fn telemetry_comes_in_its_turn_and_when_it_is_asked_for() {
    for (every, asked, expected) in [
        (0.0, 0, [false; 6]),
        (3.0, 0, [true, false, false, true, false, false]),
        (0.0, 4, [false, false, false, true, false, false]),
    ] {
        let mut autopilot = driven(0.0);
        autopilot.settings_mut().unwrap().set(Setting::TELEMETRY_EVERY, every).unwrap();
        arm_in_flight(&mut autopilot);
        let came = [1, 2, 3, 4, 5, 6].map(|sequence| {
            autopilot.receive(&LOAD_STATE_DATA { telemetry: u8::from(sequence == asked), ..frame(sequence) });
            autopilot.tick().telemetry.map(|telemetry| telemetry.sequence)
        });
        assert_eq!(
            came,
            [1, 2, 3, 4, 5, 6].map(|sequence| expected[sequence as usize - 1].then_some(sequence)),
            "{every} {asked}"
        );
    }
}

#[test]
fn rotors_that_were_cut_stay_so_until_it_is_armed_anew() {
    for law in [0.0, 1.0] {
        let mut autopilot = driven(0.0);
        set(&mut autopilot, parameter!("POL_SINK"), -1.0);
        set(&mut autopilot, parameter!("CTL_LAW"), law);
        if law > 0.5 {
            six_gains_of_p3(&mut autopilot);
        }
        arm_in_flight(&mut autopilot);
        assert!(fly(&mut autopilot, 1).outputs.iter().all(|&duty| duty > 0.3));
        let cut = (0..60).map(|_| autopilot.tick()).last().unwrap();
        assert_eq!((cut.outputs, autopilot.mode()), ([0.0; 4], Mode::Fault), "law {law}");
        assert_eq!((fly(&mut autopilot, 2).outputs, autopilot.mode()), ([0.0; 4], Mode::Fault), "law {law}");
        autopilot.disarm();
        arm_in_flight(&mut autopilot);
        assert!(fly(&mut autopilot, 3).outputs.iter().all(|&duty| duty > 0.3), "law {law}");
    }
}

/// The tracking law's chain of p3 is one longer than the following law's of h3.
fn six_gains_of_p3(autopilot: &mut Autopilot) {
    let gains = [720.0, 1764.0, 1624.0, 735.0, 175.0, 21.0];
    autopilot.settings_mut().unwrap().rig_mut().set_run(run!("K3_0" to "K3_5"), gains).unwrap();
}

#[test]
fn the_tracking_law_flies_under_the_same_supervisor() {
    let mut autopilot = driven(0.0);
    set(&mut autopilot, parameter!("CTL_LAW"), 1.0);
    six_gains_of_p3(&mut autopilot);
    arm_in_flight(&mut autopilot);
    assert_eq!(autopilot.tick().outputs, [0.0; 4]);
    let settings = autopilot.settings().clone();
    let mut is_lawful = true;
    for (sequence, phase) in (1..).zip([0.0, f32::NAN, 0.0, f32::INFINITY, 0.0]) {
        autopilot.receive(&LOAD_STATE_DATA { reference_phase: phase, ..frame(sequence) });
        let answer = autopilot.tick();
        assert!(is_flyable(&answer, &settings), "{answer:?}");
        is_lawful &= phase.is_finite();
        let (mode, faults) = (autopilot.mode(), answer.command.faults);
        // A reference that is not a number gets no answer, and the vehicle holds until it has been
        // calm.
        let expected = if is_lawful { Mode::Join } else { Mode::Hold };
        assert_eq!((mode, faults.contains(LoadFault::LOAD_FAULT_LAW)), (expected, !is_lawful), "{sequence}");
    }
    assert_eq!(autopilot.counters().fallbacks, 1);
    let asked = [(Request::Hold, Mode::Hold), (Request::Follow, Mode::Join), (Request::Land, Mode::Land)];
    for (sequence, (request, mode)) in (10..).zip(asked) {
        autopilot.request(request);
        fly(&mut autopilot, sequence);
        assert_eq!(autopilot.mode(), mode);
    }
}

#[test]
fn old_and_bad_states_are_refused_counted_and_named() {
    let mut station = Station::new(armed(0.0));
    fly(&mut station.autopilot, 5);
    station.news();
    let stale = LoadFault::LOAD_FAULT_NO_STATE | LoadFault::LOAD_FAULT_STALE_STATE;
    assert!(fly(&mut station.autopilot, 4).command.faults.contains(stale));
    assert_eq!((station.autopilot.mode(), station.autopilot.counters().refused), (Mode::Join, 1));
    assert_eq!(station.news(), ["joining the path: stale states"]);

    type Spoil = fn(&mut LOAD_STATE_DATA);
    let spoilt: [(&str, Spoil); 6] = [
        ("bad position", |frame| frame.position[1] = f32::NAN),
        ("bad velocity", |frame| frame.velocity[0] = f32::INFINITY),
        ("bad rod", |frame| frame.rod[2] = 1.2),
        ("bad attitude", |frame| frame.attitude[0] = -1.0),
        ("bad body rate", |frame| frame.body_rate[2] = 1e30),
        // Nothing to start with: no state is taken of it.
        ("no state", |frame| (frame.action, frame.zeta[3]) = (LoadAction::LOAD_ACTION_START, f32::NAN)),
    ];
    for (sequence, (name, spoil)) in (6..).zip(spoilt) {
        let mut frame = frame(sequence);
        spoil(&mut frame);
        station.autopilot.receive(&frame);
        let answer = station.autopilot.tick();
        assert!(answer.command.faults.contains(LoadFault::LOAD_FAULT_BAD_STATE), "{name}");
        assert_eq!(station.autopilot.mode(), Mode::Join, "{name}");
        let said = station.news();
        assert!(said == [format!("joining the path: {name}")], "{said:?}");
    }
    assert_eq!(station.autopilot.counters().refused, 7);
}

#[test]
fn an_overrun_is_counted_and_reported_once() {
    let mut autopilot = armed(0.0);
    fly(&mut autopilot, 1);
    autopilot.note_overrun();
    assert!(fly(&mut autopilot, 2).command.faults.contains(LoadFault::LOAD_FAULT_OVERRUN));
    assert!(!fly(&mut autopilot, 3).command.faults.contains(LoadFault::LOAD_FAULT_OVERRUN));
    assert_eq!(autopilot.counters().overruns, 1);
}

#[test]
fn a_watchdog_reset_is_said_at_once_and_in_every_answer() {
    let boot = Boot {
        by_watchdog: true,
        watchdog_resets: 3,
        internal_clock: true,
        forgotten: Some(NotKept::Flash),
        core_hz: 16_000_000,
    };
    let mut autopilot = Autopilot::new(boot);
    let mut said = Vec::new();
    Server::new().greet(&autopilot, &mut |message| said.push(message));
    let texts = said.iter().filter(|message| matches!(message, MavMessage::STATUSTEXT(_))).count();
    assert!(matches!(said[0], MavMessage::HEARTBEAT(_)));
    // And that the flash failed, and that the link is not signed.
    assert_eq!(texts, 4);
    let faults = autopilot.tick().command.faults;
    assert!(faults.contains(LoadFault::LOAD_FAULT_WATCHDOG | LoadFault::LOAD_FAULT_INTERNAL_CLOCK));
    assert_eq!(autopilot.counters_message().watchdog_resets, 3);
}

#[test]
fn lockstep_answers_the_same_question_the_same_way() {
    let mut autopilot = armed(1.0);
    let first = LOAD_STATE_DATA { action: LoadAction::LOAD_ACTION_START, ..frame(10) };
    let mut answer = autopilot.lockstep(&first);
    autopilot.note_cost(&mut answer, 5_000);
    let mut again = autopilot.lockstep(&first);
    autopilot.note_cost(&mut again, 50);
    assert_eq!(again, answer);
    assert_eq!(autopilot.counters().steps, 1);
    // A number that is not the next one: a reset at one of the ends.
    assert!(autopilot.lockstep(&frame(12)).command.faults.contains(LoadFault::LOAD_FAULT_SEQUENCE));
    assert_eq!(autopilot.counters().steps, 1);
    assert!(!autopilot.lockstep(&frame(11)).command.faults.contains(LoadFault::LOAD_FAULT_SEQUENCE));
    assert_eq!(autopilot.counters().steps, 2);
    // Armed anew and not told to start.
    let mut fresh = armed(1.0);
    assert!(fresh.lockstep(&frame(13)).command.faults.contains(LoadFault::LOAD_FAULT_SEQUENCE));
}

#[test]
fn parameters_are_kept_in_range_and_closed_in_flight() {
    let mut settings = Settings::default();
    for (name, value) in [("VEH_M_LOAD", -1.0), ("VEH_M_LOAD", f32::NAN), ("LINK_DIALECT", 0.0)] {
        assert!(matches!(settings.set_by_name(name, value), Err(Refused::OutOfRange(..))), "{name} = {value}");
    }
    for (name, value) in
        [("SYS_SIM", 0.5), ("CTL_LAW", 0.6), ("PATH_KIND", 2.7), ("PATH_EXP2", 1.5), ("TLM_EVERY", 0.1)]
    {
        assert!(matches!(settings.set_by_name(name, value), Err(Refused::NotWhole(..))), "{name} = {value}");
    }
    assert_eq!(settings.set_by_name("NO_SUCH", 1.0), Err(Refused::Unknown));
    assert_eq!(settings, Settings::default());
    assert!(settings.set_by_name("VEH_M_LOAD", 0.75).is_ok());
    assert_eq!(settings.rig().get(parameter!("VEH_M_LOAD")), 0.75);
    assert!(armed(0.0).settings_mut().is_none());
}

#[test]
fn an_unstable_law_is_not_armed_with() {
    let mut autopilot = Autopilot::new(Boot::default());
    set(&mut autopilot, parameter!("K1_0"), -1.0);
    see(&mut autopilot);
    let mut station = Station::new(autopilot);
    let (result, said) = station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
    assert_eq!((result, said.len()), (MavResult::MAV_RESULT_DENIED as u8, 1), "{said:?}");
    assert!(!station.autopilot.is_armed());
}

#[test]
fn a_number_that_the_controller_refuses_is_named_with_its_range() {
    let mut autopilot = Autopilot::new(Boot::default());
    set(&mut autopilot, parameter!("LIM_T_MIN"), 50.0);
    set(&mut autopilot, parameter!("LIM_T_MAX"), 32.0);
    see(&mut autopilot);
    let (result, said) = Station::new(autopilot).command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
    assert_eq!(result, MavResult::MAV_RESULT_DENIED as u8);
    assert_eq!(said, ["LIM_T_MAX = 32 is outside 50 to 1000000"]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Any bits for a state, on top of good ones: what goes out is finite and within limits.
    #[test]
    fn whatever_comes_in(words in prop::collection::vec(any::<u32>(), 30), every in 1_usize..30, steps in 1_u32..8) {
        let mut autopilot = armed(0.0);
        let parameters = autopilot.settings().clone();
        for sequence in 1..=steps {
            let mut frame = frame(sequence);
            let fields = [&mut frame.position[..], &mut frame.velocity, &mut frame.rod, &mut frame.rod_rate, &mut frame.attitude, &mut frame.body_rate];
            for (slot, word) in fields.into_iter().flatten().zip(&words).skip(sequence as usize).step_by(every) {
                *slot = f32::from_bits(*word);
            }
            autopilot.receive(&frame);
            prop_assert!(is_flyable(&autopilot.tick(), &parameters));
        }
        // And the next good one is flown.
        let answer = fly(&mut autopilot, steps + 1);
        prop_assert!(is_flyable(&answer, &parameters));
        prop_assert!(matches!(autopilot.mode(), Mode::Join | Mode::Hold), "{:?}", autopilot.mode());
    }
}
