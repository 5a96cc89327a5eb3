//! A ground station, which commands the target through this program.

use std::io;
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr, ToSocketAddrs, UdpSocket};

use link::{Address, Decoder, Encoder, MavMessage};

use super::HilError;

/// Where ground stations listen unless they are told otherwise.
pub const USUAL: &str = "127.0.0.1:14550";

/// The longest datagram that is read whole.
const LONGEST: usize = 2048;

/// A socket to a station that listens, or will, and what is decoded of what it says.
#[derive(Debug)]
pub struct Station {
    socket: UdpSocket,
    peer: SocketAddr,
    decoder: Decoder,
    encoder: Encoder,
}

impl Station {
    /// To HOST:PORT.
    ///
    /// # Errors
    /// [`HilError::Station`] with the system's reason.
    pub fn open(address: &str) -> Result<Self, HilError> {
        let refused = |source| HilError::Station { address: address.to_owned(), source };
        let open = || {
            // Nobody listens at port 0.
            let peer = address.to_socket_addrs()?.find(|peer| peer.port() != 0);
            let peer = peer.ok_or(io::ErrorKind::AddrNotAvailable)?;
            // From this machine alone, where the station is here.
            let own: SocketAddr = match (peer.is_ipv4(), peer.ip().is_loopback()) {
                (true, true) => (Ipv4Addr::LOCALHOST, 0).into(),
                (true, false) => (Ipv4Addr::UNSPECIFIED, 0).into(),
                (false, true) => (Ipv6Addr::LOCALHOST, 0).into(),
                (false, false) => (Ipv6Addr::UNSPECIFIED, 0).into(),
            };
            let socket = UdpSocket::bind(own)?;
            socket.set_nonblocking(true)?;
            Ok((socket, peer))
        };
        let (socket, peer) = open().map_err(refused)?;
        Ok(Self { socket, peer, decoder: Decoder::new(), encoder: Encoder::new(link::CONTROLLER) })
    }

    /// What it has said since the last call, with who says it. States are this program's to say.
    pub fn hear(&mut self, mut take: impl FnMut(MavMessage, Address)) {
        let mut bytes = [0; LONGEST];
        // An error is one of the network's, which datagrams do not wait for: the station may not be
        // there yet.
        while let Ok((count, from)) = self.socket.recv_from(&mut bytes) {
            if from.ip() != self.peer.ip() {
                continue;
            }
            for &byte in &bytes[..count] {
                self.decoder.push(byte, |received| match received {
                    Ok((MavMessage::LOAD_STATE(_), _)) | Err(_) => {}
                    Ok((message, address)) => take(message, address),
                });
            }
        }
    }

    /// Has it hear what the target says, but for what rotors alone need.
    pub fn tell(&mut self, message: &MavMessage) {
        if !matches!(message, MavMessage::LOAD_COMMAND(_)) {
            // As above.
            let _ = self.socket.send_to(self.encoder.frame(message).bytes(), self.peer);
        }
    }
}
