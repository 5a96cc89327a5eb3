//! The flight program's decisions: nothing turns unless armed, nothing that is no number gets out, and a lost state ends safely.

use autopilot::{Answer, Autopilot, Boot, Mixer, Parameter, Parameters, Refused, Server};
use controller::{Command, State, Vector3};
use link::dialect::*;
use link::{MavMessage, state_frame};
use proptest::prelude::*;

/// Every 2 ms, 1 m outside the default circle.
fn frame(sequence: u32) -> LOAD_STATE_DATA {
    LOAD_STATE_DATA {
        time_usec: 2_000 * u64::from(sequence) + 1,
        sequence,
        ..state_frame(&State::at_rest(Vector3::new(6.0, 0.0, -10.0)))
    }
}

fn armed(simulate: f32) -> Autopilot {
    let mut autopilot = Autopilot::new(Boot::default());
    autopilot.parameters_mut().unwrap().set(Parameter::Simulate, simulate);
    autopilot.arm().unwrap();
    autopilot
}

fn fly(autopilot: &mut Autopilot, sequence: u32) -> Answer {
    autopilot.receive(&frame(sequence));
    autopilot.tick()
}

#[test]
fn nothing_turns_unless_armed_and_given_a_state() {
    let mut autopilot = Autopilot::new(Boot::default());
    let answer = fly(&mut autopilot, 1);
    assert_eq!(answer.outputs, [0.0; 4]);
    assert!(answer.command.faults.contains(LoadFault::LOAD_FAULT_NOT_ARMED));

    autopilot.arm().unwrap();
    assert_eq!((autopilot.tick().outputs, autopilot.mode()), ([0.0; 4], LoadMode::LOAD_MODE_READY));

    let answer = fly(&mut autopilot, 2);
    assert_eq!(autopilot.mode(), LoadMode::LOAD_MODE_FLYING);
    assert!(answer.outputs.iter().all(|&duty| duty > 0.3), "{answer:?}");

    autopilot.disarm();
    assert_eq!(fly(&mut autopilot, 3).outputs, [0.0; 4]);
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
fn a_lost_state_is_held_for_a_while_then_safe_then_flown_again() {
    let mut autopilot = armed(0.0);
    let last = fly(&mut autopilot, 1);
    // 0.1 s of hold at 2 ms.
    for _ in 0..50 {
        let answer = autopilot.tick();
        assert_eq!((answer.outputs, autopilot.mode()), (last.outputs, LoadMode::LOAD_MODE_HOLD));
        assert!(answer.command.faults.contains(LoadFault::LOAD_FAULT_NO_STATE));
    }
    for _ in 0..1000 {
        let answer = autopilot.tick();
        assert_eq!(autopilot.mode(), LoadMode::LOAD_MODE_SAFE);
        assert_eq!((answer.command.thrust, answer.command.torque), (28.0, [0.0; 3]));
    }
    assert_eq!(autopilot.counters().missed, 1050);
    let again = fly(&mut autopilot, 2);
    assert_eq!(autopilot.mode(), LoadMode::LOAD_MODE_FLYING);
    // Without a bump: from the safe command's thrust on.
    assert!((again.command.thrust - 28.0).abs() < 0.05, "{}", again.command.thrust);
}

#[test]
fn old_and_bad_states_are_refused_and_counted() {
    let mut autopilot = armed(0.0);
    fly(&mut autopilot, 5);
    fly(&mut autopilot, 4);
    assert_eq!((autopilot.mode(), autopilot.counters().refused), (LoadMode::LOAD_MODE_HOLD, 1));

    let good = frame(6);
    let mut bad = vec![good.clone(); 6];
    bad[0].position[1] = f32::NAN;
    bad[1].velocity[0] = f32::INFINITY;
    bad[2].rod = [0.0, 0.0, 1.2];
    bad[3].attitude[0] = -1.0;
    bad[4].body_rate[2] = 1e30;
    bad[5].reference_phase = f32::NAN;
    for (case, mut frame) in bad.into_iter().enumerate() {
        frame.time_usec += case as u64;
        autopilot.receive(&frame);
        let answer = autopilot.tick();
        assert!(answer.command.faults.contains(LoadFault::LOAD_FAULT_BAD_STATE), "case {case}");
        assert_eq!(autopilot.mode(), LoadMode::LOAD_MODE_HOLD, "case {case}");
    }
    assert_eq!(autopilot.counters().refused, 7);
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
    let boot = Boot { by_watchdog: true, watchdog_resets: 3, internal_clock: true, core_hz: 16_000_000 };
    let mut autopilot = Autopilot::new(boot);
    let mut said = Vec::new();
    Server::new().greet(&autopilot, &mut |message| said.push(message));
    let texts = said.iter().filter(|message| matches!(message, MavMessage::STATUSTEXT(_))).count();
    assert!(matches!(said[0], MavMessage::HEARTBEAT(_)));
    assert_eq!(texts, 2);
    let faults = autopilot.tick().command.faults;
    assert!(faults.contains(LoadFault::LOAD_FAULT_WATCHDOG | LoadFault::LOAD_FAULT_INTERNAL_CLOCK));
    assert_eq!(autopilot.counters_message().watchdog_resets, 3);
}

#[test]
fn lockstep_answers_the_same_question_the_same_way() {
    let mut autopilot = armed(1.0);
    let first = LOAD_STATE_DATA { action: LoadAction::LOAD_ACTION_START, ..frame(10) };
    let answer = autopilot.lockstep(&first);
    assert_eq!(autopilot.lockstep(&first), answer);
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
    let mut parameters = Parameters::default();
    assert_eq!(parameters.set_by_name("VEH_M_LOAD", -1.0), Err(Refused::OutOfRange));
    assert_eq!(parameters.set_by_name("VEH_M_LOAD", f32::NAN), Err(Refused::OutOfRange));
    assert_eq!(parameters.set_by_name("NO_SUCH", 1.0), Err(Refused::Unknown));
    assert_eq!(parameters.set_by_name("LINK_DIALECT", 0.0), Err(Refused::OutOfRange));
    assert!(parameters.set_by_name("VEH_M_LOAD", 0.75).is_ok());
    assert_eq!(parameters.get(Parameter::PayloadMass), 0.75);
    assert!(armed(0.0).parameters_mut().is_none());
}

#[test]
fn an_unstable_law_is_not_armed_with() {
    let mut autopilot = Autopilot::new(Boot::default());
    autopilot.parameters_mut().unwrap().set(Parameter::K1D0, -1.0);
    let mut said = Vec::new();
    let request = MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
        param1: 1.0,
        command: MavCmd::MAV_CMD_COMPONENT_ARM_DISARM as u16,
        ..COMMAND_LONG_DATA::DEFAULT
    });
    Server::new().handle(Ok(request), 0, &mut autopilot, &mut |message| said.push(message));
    assert!(!autopilot.is_armed());
    assert!(
        matches!(&said[..], [MavMessage::STATUSTEXT(_), MavMessage::COMMAND_ACK(ack)]
        if ack.result == MavResult::MAV_RESULT_DENIED as u8),
        "{said:?}"
    );
}

/// The rotors' geometry, taken forwards: thrust and torque of four thrusts.
#[test]
fn the_mixer_gives_what_is_asked_for() {
    let parameters = Parameters::default();
    let (arm, drag, most) = (0.25, 0.05, 25.0);
    let wanted = Command { thrust: 30.0, torque: Vector3::new(0.5, -0.7, 0.2) };
    let (duties, limited) = Mixer::new(&parameters).mix(&wanted);
    assert!(!limited);
    // Front right, rear left, front left, rear right; the first two turn counter-clockwise.
    let places = [[arm, arm], [-arm, -arm], [arm, -arm], [-arm, arm]];
    let (mut thrust, mut torque) = (0.0, Vector3::zeros());
    for ((duty, [x, y]), spin) in duties.into_iter().zip(places).zip([1.0, 1.0, -1.0, -1.0]) {
        let force = most * duty * duty;
        thrust += force;
        torque += Vector3::new(x, y, 0.0).cross(&Vector3::new(0.0, 0.0, -force))
            + Vector3::new(0.0, 0.0, spin * drag * force);
    }
    // Single precision, squared and rooted.
    assert!((thrust - wanted.thrust).abs() < 1e-5 * wanted.thrust);
    assert!((torque - wanted.torque).iter().all(|axis| axis.abs() < 1e-5), "{torque}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Any bits for a state, on top of good ones: what goes out is finite and within limits.
    #[test]
    fn whatever_comes_in(words in prop::collection::vec(any::<u32>(), 30), every in 1_usize..30, steps in 1_u32..8) {
        let mut autopilot = armed(0.0);
        let check = |answer: &Answer| {
            let command = &answer.command;
            (0.0..=100.0).contains(&command.thrust)
                && command.torque.iter().all(|axis| axis.abs() <= 10.0)
                && answer.outputs.iter().chain(&command.rotor).all(|duty| (0.0..=1.0).contains(duty))
                && command.zeta.iter().all(|z| z.is_finite())
        };
        for sequence in 1..=steps {
            let mut frame = frame(sequence);
            let fields = [&mut frame.position[..], &mut frame.velocity, &mut frame.rod, &mut frame.rod_rate, &mut frame.attitude, &mut frame.body_rate];
            for (slot, word) in fields.into_iter().flatten().zip(&words).skip(sequence as usize).step_by(every) {
                *slot = f32::from_bits(*word);
            }
            autopilot.receive(&frame);
            prop_assert!(check(&autopilot.tick()));
        }
        // And the next good one is flown.
        let answer = fly(&mut autopilot, steps + 1);
        prop_assert!(check(&answer));
        prop_assert_eq!(autopilot.mode(), LoadMode::LOAD_MODE_FLYING);
    }
}
