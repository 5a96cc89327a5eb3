//! A stream of bytes over UDP.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};
use std::time::{Duration, Instant};

use super::Wire;

/// The system keeps some hundred bytes beside each datagram, and an emulator makes a datagram of
/// each byte: so this is room for ten thousand of them, a list of all parameters.
const ROOM: usize = 1 << 22;

/// The longest datagram that is read whole: any frame is shorter.
const LONGEST: usize = 512;

/// How long to look for the next datagram without sleeping, ten times what an answer takes: waking
/// up takes longer than an emulator's next byte, and the sender pays for it.
const WATCHFUL: Duration = Duration::from_millis(5);

/// Time between looks after that.
const NAP: Duration = Duration::from_micros(200);

/// A connected socket, and what is read from it in order of arrival.
#[derive(Debug)]
pub struct Datagrams {
    socket: UdpSocket,
    patience: Duration,
}

impl Datagrams {
    /// To a listener at `address`, HOST:PORT.
    pub fn connect(address: &str) -> io::Result<Self> {
        let peer = address.to_socket_addrs()?.next().ok_or(ErrorKind::AddrNotAvailable)?;
        let any: SocketAddr = if peer.is_ipv4() { ([0; 4], 0).into() } else { ([0; 16], 0).into() };
        let socket = UdpSocket::bind(any)?;
        socket.connect(peer)?;
        Self::over(socket)
    }

    /// Over a socket that is connected.
    pub fn over(socket: UdpSocket) -> io::Result<Self> {
        socket.set_nonblocking(true)?;
        // The system may give less, or refuse: a datagram without room is lost, and asked for
        // again.
        let _ = socket2::SockRef::from(&socket).set_recv_buffer_size(ROOM);
        Ok(Self { socket, patience: WATCHFUL })
    }
}

impl Read for Datagrams {
    /// All that has come; waits for the first of it.
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let begun = Instant::now();
        let mut count = 0;
        loop {
            match self.socket.recv(&mut bytes[count..]) {
                Ok(more) => count += more,
                Err(error) if error.kind() != ErrorKind::WouldBlock => return Err(error),
                Err(_) if count > 0 => return Ok(count),
                Err(error) => match begun.elapsed() {
                    waited if waited >= self.patience => return Err(error),
                    waited if waited < WATCHFUL => std::thread::yield_now(),
                    _ => std::thread::sleep(NAP),
                },
            }
            if bytes.len() - count < LONGEST && count > 0 {
                return Ok(count);
            }
        }
    }
}

impl Write for Datagrams {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.socket.send(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Wire for Datagrams {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.patience = patience;
        Ok(())
    }
}
