//! MAVLink's file transfer, to read the files of [metadata](crate::metadata) and nothing else.

use link::dialect::FILE_TRANSFER_PROTOCOL_DATA;
use link::{Address, MavMessage};

use crate::metadata::File;

/// Operations and errors, as MAVLink numbers them.
const TERMINATE_SESSION: u8 = 1;
const RESET_SESSIONS: u8 = 2;
const LIST_DIRECTORY: u8 = 3;
const OPEN_TO_READ: u8 = 4;
const READ: u8 = 5;
const CHECKSUM: u8 = 14;
const BURST_READ: u8 = 15;
const ACK: u8 = 128;
const NAK: u8 = 129;
const INVALID_SESSION: u8 = 4;
const END_OF_FILE: u8 = 6;
const UNKNOWN_COMMAND: u8 = 7;
const FILE_NOT_FOUND: u8 = 10;

/// Bytes of a payload before its data, and of those.
const HEAD: usize = 12;
const ROOM: usize = 239;

/// The one session there is.
#[derive(Clone, Copy, Debug, Default)]
pub struct Files {
    open: Option<File>,
}

impl Files {
    /// Nothing is open.
    pub const fn new() -> Self {
        Self { open: None }
    }

    /// The answer to `request` from `sender`; none to an answer.
    pub fn answer(
        &mut self,
        request: &FILE_TRANSFER_PROTOCOL_DATA,
        (system, component): Address,
    ) -> Option<MavMessage> {
        let (&[low, high, session, operation, size, _, _, _, o0, o1, o2, o3], asked) =
            request.payload.split_first_chunk::<HEAD>()?;
        if operation >= ACK {
            return None;
        }
        let offset = u32::from_le_bytes([o0, o1, o2, o3]);
        let text = asked.get(..usize::from(size)).map_or("", link::text_of);
        let mut data = [0; ROOM];
        let done = self.act(operation, (offset, size), text, &mut data);
        let (outcome, length) = match done {
            Ok(length) => (ACK, length),
            Err(error) => {
                data[0] = error;
                (NAK, 1)
            }
        };
        let [low, high] = u16::from_le_bytes([low, high]).wrapping_add(1).to_le_bytes();
        // A burst is one answer long: whoever wants more asks on.
        let is_complete = u8::from(operation == BURST_READ);
        let head = [low, high, session, outcome, length as u8, operation, is_complete, 0, o0, o1, o2, o3];
        let mut payload = [0; HEAD + ROOM];
        for (slot, byte) in payload.iter_mut().zip(head.into_iter().chain(data)) {
            *slot = byte;
        }
        Some(MavMessage::FILE_TRANSFER_PROTOCOL(FILE_TRANSFER_PROTOCOL_DATA {
            target_network: 0,
            target_system: system,
            target_component: component,
            payload,
        }))
    }

    /// Does an operation; the length of its answer's data.
    fn act(
        &mut self,
        operation: u8,
        (offset, size): (u32, u8),
        name: &str,
        data: &mut [u8; ROOM],
    ) -> Result<usize, u8> {
        match operation {
            TERMINATE_SESSION | RESET_SESSIONS => {
                self.open = None;
                Ok(0)
            }
            OPEN_TO_READ => {
                let file = File::named(name).ok_or(FILE_NOT_FOUND)?;
                self.open = Some(file);
                Ok(number(file.length(), data))
            }
            CHECKSUM => Ok(number(File::named(name).ok_or(FILE_NOT_FOUND)?.checksum(), data)),
            READ | BURST_READ => {
                let file = self.open.ok_or(INVALID_SESSION)?;
                let wanted = usize::from(if size == 0 { ROOM as u8 } else { size }).min(ROOM);
                let bytes = data.get_mut(..wanted).unwrap_or_default();
                match file.read(offset, bytes) {
                    0 => Err(END_OF_FILE),
                    length => Ok(length),
                }
            }
            LIST_DIRECTORY => Err(FILE_NOT_FOUND),
            _ => Err(UNKNOWN_COMMAND),
        }
    }
}

/// A number as data.
fn number(number: u32, data: &mut [u8; ROOM]) -> usize {
    let bytes = number.to_le_bytes();
    for (slot, byte) in data.iter_mut().zip(bytes) {
        *slot = byte;
    }
    bytes.len()
}
