//! The link: official messages are what MAVLink's own tools know, frames survive noise, and no byte
//! is able to do harm.

use link::dialect::*;
use link::{Decoder, Encoder, MavMessage};
use mavlink_core::Message;
use proptest::prelude::*;

fn decode(bytes: &[u8]) -> (Vec<MavMessage>, usize) {
    let (mut messages, mut rejected) = (Vec::new(), 0);
    let mut decoder = Decoder::new();
    for &byte in bytes {
        decoder.push(byte, |received| match received {
            Ok((message, sender)) => {
                assert!([link::STATION, (255, 190)].contains(&sender));
                messages.push(message);
            }
            Err(_) => rejected += 1,
        });
    }
    (messages, rejected)
}

fn state(sequence: u32) -> MavMessage {
    MavMessage::LOAD_STATE(LOAD_STATE_DATA {
        time_usec: 1_000 * u64::from(sequence),
        sequence,
        position: [1.0, -2.5, f32::from_bits(1)],
        attitude: [0.25, 253.0, -0.0, 1e-38, f32::MAX, 3.0, 7.0, 0.5, 1.0],
        ..LOAD_STATE_DATA::DEFAULT
    })
}

/// `CRC_EXTRA` is a checksum of a message's layout: with the official number and the official one
/// of these, a message is the official one. Numbers from MAVLink's common.xml by pymavlink 2.4.50.
#[test]
fn standard_messages_have_the_official_layout() {
    for (id, extra) in [
        (0, 50),
        (20, 214),
        (21, 159),
        (22, 220),
        (23, 168),
        (24, 24),
        (31, 246),
        (32, 185),
        (69, 243),
        (70, 124),
        (75, 158),
        (76, 152),
        (77, 143),
        (105, 93),
        (110, 84),
        (111, 34),
        (147, 154),
        (148, 178),
        (232, 151),
        (245, 130),
        (253, 83),
        (331, 91),
        (397, 182),
        (435, 134),
        (436, 193),
    ] {
        assert_eq!(MavMessage::extra_crc(id), extra, "message {id}");
    }
}

/// A heartbeat of a ground station, byte by byte as pymavlink 2.4.50 sends it.
#[test]
fn a_frame_of_another_implementation_is_understood() {
    let frame = [
        0xFD, 0x09, 0x00, 0x00, 0x00, 0xFF, 0xBE, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x06, 0x08, 0x00, 0x04,
        0x03, 0x3D, 0x48,
    ];
    let (messages, _) = decode(&frame);
    let [MavMessage::HEARTBEAT(heartbeat)] = &messages[..] else { panic!("{messages:?}") };
    assert_eq!((heartbeat.mavtype, heartbeat.autopilot, heartbeat.system_status), (6, 8, 4));
    assert_eq!(Encoder::new(link::STATION).frame(&messages[0]).bytes(), frame);
}

#[test]
fn every_float_crosses_bit_by_bit() {
    let message = state(7);
    let (messages, rejected) = decode(Encoder::new(link::STATION).frame(&message).bytes());
    assert_eq!((messages, rejected), (vec![message], 0));
}

/// A heartbeat that pymavlink 2.4.50 has signed, with the key of 32 times 42, link 0 and time 1; and
/// a battery's report from a dialect that has added to it since.
#[test]
fn signed_frames_and_newer_ones_are_understood() {
    let message = MavMessage::HEARTBEAT(HEARTBEAT_DATA { mavlink_version: 3, ..HEARTBEAT_DATA::DEFAULT });
    let mut bytes = vec![
        0xFD, 0x09, 0x01, 0x00, 0x00, 0xFF, 0xBE, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
        0x03, 0x61, 0x91, 0x00, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0xF9, 0x0D, 0x76, 0x85, 0xA2, 0x4C,
    ];
    bytes.extend_from_slice(Encoder::new(link::STATION).frame(&state(1)).bytes());
    assert_eq!(decode(&bytes), (vec![message, state(1)], 0));

    let battery = BATTERY_STATUS_DATA { battery_remaining: 71, id: 1, ..BATTERY_STATUS_DATA::DEFAULT };
    let message = MavMessage::BATTERY_STATUS(battery);
    let known = Encoder::new(link::STATION).frame(&message).bytes().to_vec();
    let mut frame = known[..known.len() - 2].to_vec();
    frame.resize(10 + BATTERY_STATUS_DATA::ENCODED_LEN, 0);
    frame.extend_from_slice(&[1, 2, 3]);
    frame[1] = (frame.len() - 10) as u8;
    let crc = mavlink_core::calculate_crc(&frame[1..], MavMessage::extra_crc(147));
    frame.extend_from_slice(&crc.to_le_bytes());
    assert_eq!(decode(&frame), (vec![message], 0));
}

#[test]
fn a_wrong_length_keeps_nobody_waiting() {
    let mut encoder = Encoder::new(link::STATION);
    let mut bytes = encoder.frame(&state(1)).bytes().to_vec();
    // As long as a payload can be, which is longer than this message ever is.
    bytes[1] = 255;
    bytes.extend_from_slice(encoder.frame(&state(2)).bytes());
    let (messages, rejected) = decode(&bytes);
    assert_eq!(messages, [state(2)]);
    assert!(rejected >= 1);
}

proptest! {
    /// Whatever came before, at most two more frames are lost: one that the noise has begun to look
    /// like, and its rest.
    #[test]
    fn noise_is_recovered_from(noise in prop::collection::vec(any::<u8>(), 0..600)) {
        let mut encoder = Encoder::new(link::STATION);
        let mut bytes = noise;
        for sequence in 0..6 {
            bytes.extend_from_slice(encoder.frame(&state(sequence)).bytes());
        }
        let (messages, _) = decode(&bytes);
        prop_assert!(messages.ends_with(&[state(3), state(4), state(5)]), "{} messages", messages.len());
    }

    /// One wrong byte costs the frame that it is in, and no other.
    #[test]
    fn a_wrong_byte_costs_one_frame(at in 0_usize..3 * 120, flip in 1_u8..) {
        let mut encoder = Encoder::new(link::STATION);
        let frames: Vec<Vec<u8>> = (1..=4).map(|sequence| encoder.frame(&state(sequence)).bytes().to_vec()).collect();
        let mut bytes = frames.concat();
        let at = at.min(bytes.len() - frames[3].len() - 1);
        bytes[at] ^= flip;
        let hit = 1 + (at / frames[0].len()) as u32;
        let (messages, rejected) = decode(&bytes);
        let expected: Vec<MavMessage> = (1..=4).filter(|&sequence| sequence != hit).map(state).collect();
        prop_assert_eq!(messages, expected);
        // A wrong start marker is no frame at all.
        prop_assert!(rejected >= 1 || at % frames[0].len() == 0);
    }
}
