//! Frames out of a stream of bytes of which some may be lost or wrong.

use mavlink_core::{MAV_STX_V2, MavlinkVersion, Message, MessageData, calculate_crc};

use crate::Address;
use crate::dialect::*;

/// Start marker, nine bytes of header, checksum, and a signature, which is not looked at.
const HEADER: usize = 10;
const CHECKSUM: usize = 2;
const SIGNATURE: usize = 13;
const LONGEST: usize = HEADER + u8::MAX as usize + CHECKSUM + SIGNATURE;
/// The one flag of a header that is understood.
const SIGNED: u8 = 1;

/// Why a frame was not taken. The search goes on from the byte after its marker, so a frame inside
/// is still found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rejected {
    /// The message is not in the dialect, or is one of the dialect's own and longer than it has it,
    /// or asks for a feature unknown here.
    Header {
        /// The message's number.
        id: u32,
    },
    /// Wrong checksum, or a value outside its enumeration: noise on the line, or another version of
    /// the dialect.
    Checksum {
        /// The message's number.
        id: u32,
    },
}

/// Finds frames, in bounded memory: never more than one frame is kept.
///
/// A wrong length can't make it wait longer than the longest form of the message it claims to be,
/// if that is one of the dialect's own; the standard ones may have been extended since.
#[derive(Clone, Debug)]
pub struct Decoder {
    buffer: [u8; LONGEST],
    length: usize,
}

impl Default for Decoder {
    fn default() -> Self {
        Self::new()
    }
}

impl Decoder {
    /// Nothing received yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { buffer: [0; LONGEST], length: 0 }
    }

    /// Takes one byte; calls `sink` for each message that it completes, with its sender, and each
    /// candidate that it shows to be none.
    pub fn push(&mut self, byte: u8, mut sink: impl FnMut(Result<(MavMessage, Address), Rejected>)) {
        if let Some(slot) = self.buffer.get_mut(self.length) {
            *slot = byte;
            self.length += 1;
        }
        // Only a rejected candidate leaves bytes to be looked at again.
        while let Some(outcome) = self.examine() {
            sink(outcome);
        }
    }

    /// Forgets a frame that has begun, as after the line was down.
    pub fn reset(&mut self) {
        self.length = 0;
    }

    /// The first candidate's fate, once it is known; its bytes are then gone.
    fn examine(&mut self) -> Option<Result<(MavMessage, Address), Rejected>> {
        let received = self.buffer.get(..self.length)?;
        let start = received.iter().position(|&byte| byte == MAV_STX_V2).unwrap_or(self.length);
        if start > 0 {
            self.drop_first(start);
        }
        let received = self.buffer.get(..self.length)?;
        let (&[_, payload, incompatible, _, _, system, component, id0, id1, id2], _) =
            received.split_first_chunk::<HEADER>()?;
        let id = u32::from_le_bytes([id0, id1, id2, 0]);
        let payload = usize::from(payload);
        let longest = longest_payload(id).filter(|&longest| {
            let most = if id < OWN { usize::from(u8::MAX) } else { longest };
            incompatible & !SIGNED == 0 && (1..=most).contains(&payload)
        });
        let Some(longest) = longest else {
            self.drop_first(1);
            return Some(Err(Rejected::Header { id }));
        };
        let end = HEADER + payload;
        let whole = end + CHECKSUM + if incompatible == SIGNED { SIGNATURE } else { 0 };
        let received = received.get(..whole)?;
        // What has been added to a message since is behind what is known of it.
        let body = received.get(HEADER..HEADER + payload.min(longest))?;
        let &[low, high] = received.get(end..end + CHECKSUM)? else { return None };
        let right =
            calculate_crc(received.get(1..end)?, MavMessage::extra_crc(id)) == u16::from_le_bytes([low, high]);
        let message = if right { MavMessage::parse(MavlinkVersion::V2, id, body).ok() } else { None };
        match message {
            Some(message) => {
                self.drop_first(whole);
                Some(Ok((message, (system, component))))
            }
            None => {
                self.drop_first(1);
                Some(Err(Rejected::Checksum { id }))
            }
        }
    }

    fn drop_first(&mut self, count: usize) {
        self.buffer.copy_within(count..self.length, 0);
        self.length -= count;
    }
}

/// The number of the dialect's first own message.
const OWN: u32 = LOAD_STATE_DATA::ID;

/// The whole payload of each message, before trailing zeros are left out.
fn longest_payload(id: u32) -> Option<usize> {
    macro_rules! lengths {
        ($($data:ident),*) => {
            match id {
                $(<$data as MessageData>::ID => Some(<$data as MessageData>::ENCODED_LEN),)*
                _ => None,
            }
        };
    }
    lengths!(
        HEARTBEAT_DATA,
        SYS_STATUS_DATA,
        PARAM_REQUEST_READ_DATA,
        PARAM_REQUEST_LIST_DATA,
        PARAM_VALUE_DATA,
        PARAM_SET_DATA,
        ATTITUDE_DATA,
        ATTITUDE_QUATERNION_DATA,
        LOCAL_POSITION_NED_DATA,
        GLOBAL_POSITION_INT_DATA,
        VFR_HUD_DATA,
        MANUAL_CONTROL_DATA,
        RC_CHANNELS_OVERRIDE_DATA,
        COMMAND_INT_DATA,
        COMMAND_LONG_DATA,
        COMMAND_ACK_DATA,
        HIGHRES_IMU_DATA,
        GPS_RAW_INT_DATA,
        GPS_INPUT_DATA,
        ODOMETRY_DATA,
        FILE_TRANSFER_PROTOCOL_DATA,
        TIMESYNC_DATA,
        BATTERY_STATUS_DATA,
        AUTOPILOT_VERSION_DATA,
        EXTENDED_SYS_STATE_DATA,
        STATUSTEXT_DATA,
        COMPONENT_METADATA_DATA,
        AVAILABLE_MODES_DATA,
        CURRENT_MODE_DATA,
        MISSION_REQUEST_PARTIAL_LIST_DATA,
        MISSION_WRITE_PARTIAL_LIST_DATA,
        MISSION_REQUEST_DATA,
        MISSION_SET_CURRENT_DATA,
        MISSION_CURRENT_DATA,
        MISSION_REQUEST_LIST_DATA,
        MISSION_COUNT_DATA,
        MISSION_CLEAR_ALL_DATA,
        MISSION_ITEM_REACHED_DATA,
        MISSION_ACK_DATA,
        SET_GPS_GLOBAL_ORIGIN_DATA,
        GPS_GLOBAL_ORIGIN_DATA,
        MISSION_REQUEST_INT_DATA,
        MISSION_ITEM_INT_DATA,
        HOME_POSITION_DATA,
        SET_HOME_POSITION_DATA,
        LOAD_STATE_DATA,
        LOAD_COMMAND_DATA,
        LOAD_TELEMETRY_DATA,
        LOAD_COUNTERS_DATA
    )
}
