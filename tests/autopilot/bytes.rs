//! Whatever bytes come over the link, in whatever order, what goes out is finite and what the
//! rotors can give.

use autopilot::{Autopilot, Boot, Settings};
use link::MavMessage;
use link::dialect::*;
use proptest::prelude::*;

use crate::station::{Station, driven, frame_of, is_flyable, see, start};

/// Something that comes over the link.
#[derive(Clone, Debug)]
enum Event {
    /// A state with some of its numbers replaced by any bits.
    State { action: u8, words: Vec<(usize, u32)> },
    /// A parameter, as a multiple of its default, so that mostly a law can be made of it, or as any
    /// bits.
    Parameter { index: usize, factor: f32, bits: Option<u32> },
    /// A command with its first two parameters.
    Command(u16, f32, f32),
    /// Any bytes.
    Noise(Vec<u8>),
    /// A frame cut short.
    Cut(usize),
    /// Time goes by.
    Ticks(u8),
}

const ARM: u16 = MavCmd::MAV_CMD_COMPONENT_ARM_DISARM as u16;
const MODE: u16 = MavCmd::MAV_CMD_DO_SET_MODE as u16;

fn event() -> impl Strategy<Value = Event> {
    let words = prop::collection::vec((0_usize..29, any::<u32>()), 0..3);
    let bits = prop::option::weighted(0.2, any::<u32>());
    prop_oneof![
        8 => (0_u8..4, words).prop_map(|(action, words)| Event::State { action, words }),
        1 => (0..Settings::COUNT, 0.3_f32..3.0, bits)
            .prop_map(|(index, factor, bits)| Event::Parameter { index, factor, bits }),
        1 => (0_u8..2).prop_map(|on| Event::Command(ARM, on.into(), 0.0)),
        2 => (0_u8..8).prop_map(|mode| Event::Command(MODE, 1.0, mode.into())),
        1 => (any::<u16>(), any::<u32>(), any::<u32>())
            .prop_map(|(command, a, b)| Event::Command(command, f32::from_bits(a), f32::from_bits(b))),
        1 => prop::collection::vec(any::<u8>(), 0..80).prop_map(Event::Noise),
        1 => (0_usize..100).prop_map(Event::Cut),
        3 => (1_u8..80).prop_map(Event::Ticks),
    ]
}

/// A good state, then spoilt.
fn state(sequence: u32, action: u8, words: &[(usize, u32)]) -> MavMessage {
    let mut frame = frame_of(&start(), sequence);
    frame.action = match action {
        0 => LoadAction::LOAD_ACTION_START,
        1 => LoadAction::LOAD_ACTION_ENGAGE,
        _ => LoadAction::LOAD_ACTION_CONTINUE,
    };
    for &(index, word) in words {
        let fields = [
            &mut frame.position[..],
            &mut frame.velocity,
            &mut frame.rod,
            &mut frame.rod_rate,
            &mut frame.attitude,
            &mut frame.body_rate,
            std::slice::from_mut(&mut frame.reference_phase),
            &mut frame.zeta,
        ];
        if let Some(slot) = fields.into_iter().flatten().nth(index) {
            *slot = f32::from_bits(word);
        }
    }
    MavMessage::LOAD_STATE(frame)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn nothing_but_flyable_commands_goes_out(events in prop::collection::vec(event(), 1..60), simulate in 0_u8..3) {
        let mut autopilot = driven(simulate.into());
        see(&mut autopilot);
        let mut station = Station::new(autopilot);
        station.ask(LoadMode::LOAD_MODE_FOLLOW);
        station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
        let mut sequence = 0;
        for event in events {
            let bytes = match event {
                Event::State { action, words } => {
                    sequence += 1;
                    station.encode(&state(sequence, action, &words))
                }
                Event::Parameter { index, factor, bits } => {
                    let (entry, _) = station.autopilot.settings().at(index).expect("it is one of the table's");
                    let param_value = bits.map_or(entry.default * factor, f32::from_bits);
                    let param_id = link::name(entry.name.as_str());
                    station.encode(&MavMessage::PARAM_SET(PARAM_SET_DATA { param_value, param_id, ..PARAM_SET_DATA::DEFAULT }))
                }
                Event::Command(command, param1, param2) => station.encode(&MavMessage::COMMAND_LONG(COMMAND_LONG_DATA {
                    param1,
                    param2,
                    command,
                    ..COMMAND_LONG_DATA::DEFAULT
                })),
                Event::Noise(bytes) => bytes,
                Event::Cut(length) => {
                    let mut bytes = station.encode(&state(sequence, 2, &[]));
                    bytes.truncate(length);
                    bytes
                }
                Event::Ticks(count) => {
                    for _ in 0..count {
                        let answer = station.autopilot.tick();
                        prop_assert!(is_flyable(&answer, station.autopilot.settings()), "{:?}", answer);
                        prop_assert!(station.autopilot.is_armed() || answer.outputs == [0.0; 4]);
                    }
                    continue;
                }
            };
            let (_, answers) = station.hear(&bytes);
            for answer in answers {
                prop_assert!(is_flyable(&answer, station.autopilot.settings()), "{:?}", answer);
                prop_assert_eq!(answer.outputs, [0.0; 4]);
            }
        }
    }
}

/// The bits of any states, over a flight that is otherwise good.
#[test]
fn one_bad_number_at_a_time_leads_nowhere() {
    let odd =
        [0.0, -0.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, f32::MIN_POSITIVE, 1.0, -1.0];
    for index in 0..29 {
        for value in odd {
            let mut autopilot = Autopilot::new(Boot::default());
            see(&mut autopilot);
            let mut station = Station::new(autopilot);
            station.ask(LoadMode::LOAD_MODE_FOLLOW);
            station.command(MavCmd::MAV_CMD_COMPONENT_ARM_DISARM, 1.0, 0.0);
            for sequence in 1..20 {
                let words = if sequence % 3 == 0 { vec![(index, value.to_bits())] } else { vec![] };
                let bytes = station.encode(&state(sequence, 2, &words));
                station.hear(&bytes);
                let answer = station.autopilot.tick();
                assert!(is_flyable(&answer, station.autopilot.settings()), "{index} {value}: {answer:?}");
            }
        }
    }
}
