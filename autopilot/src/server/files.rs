//! MAVLink's file transfer: there are no files, which each request hears at once.

use link::dialect::FILE_TRANSFER_PROTOCOL_DATA;
use link::{Address, MavMessage};

/// Operations and errors, as MAVLink numbers them.
const TERMINATE_SESSION: u8 = 1;
const RESET_SESSIONS: u8 = 2;
const LIST_DIRECTORY: u8 = 3;
const OPEN_TO_READ: u8 = 4;
const CHECKSUM: u8 = 14;
const ACK: u8 = 128;
const NAK: u8 = 129;
const UNKNOWN_COMMAND: u8 = 7;
const FILE_NOT_FOUND: u8 = 10;

/// The answer to `request` from `sender`; none to an answer.
pub fn answer(request: &FILE_TRANSFER_PROTOCOL_DATA, (system, component): Address) -> Option<MavMessage> {
    let [low, high, session, operation, ..] = request.payload;
    let (outcome, error) = match operation {
        ACK.. => return None,
        TERMINATE_SESSION | RESET_SESSIONS => (ACK, None),
        LIST_DIRECTORY | OPEN_TO_READ | CHECKSUM => (NAK, Some(FILE_NOT_FOUND)),
        _ => (NAK, Some(UNKNOWN_COMMAND)),
    };
    let [low, high] = u16::from_le_bytes([low, high]).wrapping_add(1).to_le_bytes();
    let mut payload = [0; 251];
    let head = [low, high, session, outcome, u8::from(error.is_some()), operation];
    // The error is the first byte of the data.
    let data = [(DATA, error.unwrap_or_default())];
    for (index, byte) in head.into_iter().enumerate().chain(data) {
        if let Some(slot) = payload.get_mut(index) {
            *slot = byte;
        }
    }
    Some(MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA {
        target_network: 0,
        target_system: system,
        target_component: component,
        payload,
    }))
}

/// Where the data of a payload begin.
const DATA: usize = 12;
