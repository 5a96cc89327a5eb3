//! The link between a controller and what gives it states: one MAVLink 2 dialect, and frames found
//! in a stream of bytes.
//!
//! The messages, with their units and frames, stand in `dialect/slung_load.xml`; [`dialect`] is
//! generated from it. Both ends use this crate, and neither allocates here.
#![no_std]

mod convert;
mod decoder;
mod home;

/// The messages, generated from the dialect's XML.
#[allow(
    missing_docs,
    non_camel_case_types,
    unused_qualifications,
    elided_lifetimes_in_paths,
    clippy::all,
    clippy::pedantic
)]
mod generated {
    include!(concat!(env!("OUT_DIR"), "/modules.rs"));
}

pub use convert::{measured_frame, name, specific_force_of, state_frame, state_of, text, text_of, uav_of};
pub use decoder::{Decoder, Rejected};
pub use generated::slung_load as dialect;
pub use generated::slung_load::MavMessage;
pub use home::Home;

pub use mavlink_core::Message;
use mavlink_core::{MAVLinkV2MessageRaw, MavHeader};

/// Changes with every change of the dialect: parameter `LINK_DIALECT` is this number, exact as a
/// float.
pub const FINGERPRINT: u32 = include!(concat!(env!("OUT_DIR"), "/fingerprint.rs"));

/// A MAVLink address: system, component.
pub type Address = (u8, u8);
/// The controller's, an autopilot.
pub const CONTROLLER: Address = (1, 1);
/// The simulator's or ground station's.
pub const STATION: Address = (255, 190);

/// Numbers the frames one end sends.
#[derive(Clone, Copy, Debug)]
pub struct Encoder {
    address: Address,
    sequence: u8,
}

impl Encoder {
    /// For frames from `address`.
    #[must_use]
    pub const fn new(address: Address) -> Self {
        Self { address, sequence: 0 }
    }

    /// The next frame.
    pub fn frame(&mut self, message: &MavMessage) -> Frame {
        let header =
            MavHeader { system_id: self.address.0.into(), component_id: self.address.1, sequence: self.sequence };
        self.sequence = self.sequence.wrapping_add(1);
        let mut frame = MAVLinkV2MessageRaw::new();
        frame.serialize_message(header, message);
        Frame(frame)
    }
}

/// One serialized message.
#[derive(Clone, Copy, Debug)]
pub struct Frame(MAVLinkV2MessageRaw);

impl Frame {
    /// All its bytes, from the start marker to the checksum.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        self.0.raw_bytes()
    }
}
