//! Lines to a target: a serial port, or a socket.

use std::fmt;
use std::io::{self, Read, Write};
use std::net::{TcpListener, TcpStream, ToSocketAddrs};
#[cfg(unix)]
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

use super::HilError;
use super::datagrams::Datagrams;
use super::soft::Here;

/// Where a target is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Endpoint {
    /// The flight program in this process.
    Here,
    /// A serial port.
    Serial {
        /// As the system names it.
        port: String,
        /// Bits a second; 8N1.
        baud: u32,
    },
    /// A Unix socket.
    Unix(PathBuf),
    /// A TCP socket, HOST:PORT.
    Tcp(String),
    /// A UDP socket, HOST:PORT.
    Udp(String),
}

impl FromStr for Endpoint {
    type Err = HilError;

    fn from_str(text: &str) -> Result<Self, HilError> {
        if text == "here" {
            return Ok(Self::Here);
        }
        match text.split_once(':') {
            Some(("unix", path)) if !path.is_empty() => Ok(Self::Unix(path.into())),
            Some(("tcp", address)) if address.contains(':') => Ok(Self::Tcp(address.to_owned())),
            Some(("udp", address)) if address.contains(':') => Ok(Self::Udp(address.to_owned())),
            _ => Err(HilError::Endpoint(text.to_owned())),
        }
    }
}

impl fmt::Display for Endpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Here => f.write_str("here"),
            Self::Serial { port, baud } => write!(f, "{port} at {baud} baud"),
            Self::Unix(path) => write!(f, "unix:{}", path.display()),
            Self::Tcp(address) => write!(f, "tcp:{address}"),
            Self::Udp(address) => write!(f, "udp:{address}"),
        }
    }
}

/// A two-way line of bytes whose reads end after a while.
pub trait Wire: Read + Write + Send {
    /// How long a read waits at most. It then fails with [`io::ErrorKind::WouldBlock`] or
    /// [`io::ErrorKind::TimedOut`].
    ///
    /// # Errors
    /// The system's.
    fn set_patience(&mut self, patience: Duration) -> io::Result<()>;
}

#[cfg(unix)]
impl Wire for UnixStream {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.set_read_timeout(Some(patience))
    }
}

impl Wire for TcpStream {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.set_read_timeout(Some(patience))
    }
}

impl Wire for Box<dyn serialport::SerialPort> {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        Ok(self.as_mut().set_timeout(patience)?)
    }
}

/// A line that takes no byte for this long is down: the other end of a socket does not read.
const WRITE_PATIENCE: Duration = Duration::from_secs(2);

impl Endpoint {
    /// Opens the line.
    ///
    /// # Errors
    /// [`HilError::Port`] or [`HilError::Connect`].
    pub fn open(&self) -> Result<Box<dyn Wire>, HilError> {
        let refused = |source| HilError::Connect { endpoint: self.clone(), source };
        match self {
            Self::Here => Ok(Box::new(Here::new())),
            Self::Serial { port, baud } => match serialport::new(port, *baud).timeout(WRITE_PATIENCE).open() {
                Ok(port) => Ok(Box::new(port)),
                Err(source) => {
                    let available = serialport::available_ports().unwrap_or_default();
                    let available = available.into_iter().map(|port| port.port_name).collect();
                    Err(HilError::Port { port: port.clone(), available, source })
                }
            },
            #[cfg(unix)]
            Self::Unix(path) => {
                let stream = UnixStream::connect(path).map_err(refused)?;
                stream.set_write_timeout(Some(WRITE_PATIENCE)).map_err(refused)?;
                Ok(Box::new(stream))
            }
            #[cfg(not(unix))]
            Self::Unix(_) => Err(refused(io::ErrorKind::Unsupported.into())),
            Self::Tcp(address) => {
                let connect = || {
                    let address = address.to_socket_addrs()?.next().ok_or(io::ErrorKind::AddrNotAvailable)?;
                    let stream = TcpStream::connect_timeout(&address, WRITE_PATIENCE)?;
                    stream.set_write_timeout(Some(WRITE_PATIENCE))?;
                    // A frame is small and its answer is waited for.
                    stream.set_nodelay(true)?;
                    Ok(stream)
                };
                Ok(Box::new(connect().map_err(refused)?))
            }
            Self::Udp(address) => Ok(Box::new(Datagrams::connect(address).map_err(refused)?)),
        }
    }
}

/// Where a target of this program waits to be connected to.
pub enum Listener {
    /// A Unix socket.
    #[cfg(unix)]
    Unix(UnixListener),
    /// A TCP socket.
    Tcp(TcpListener),
}

impl Listener {
    /// Listens at a socket.
    ///
    /// # Errors
    /// [`HilError::Connect`] with the system's reason; a serial port is nowhere to listen.
    pub fn open(endpoint: &Endpoint) -> Result<Self, HilError> {
        let refused = |source| HilError::Connect { endpoint: endpoint.clone(), source };
        match endpoint {
            #[cfg(unix)]
            Endpoint::Unix(path) => UnixListener::bind(path).map(Self::Unix).map_err(refused),
            Endpoint::Tcp(address) => TcpListener::bind(address).map(Self::Tcp).map_err(refused),
            _ => Err(refused(io::ErrorKind::Unsupported.into())),
        }
    }

    /// Waits for the next connection.
    ///
    /// # Errors
    /// The system's.
    pub fn accept(&self) -> io::Result<Box<dyn Wire>> {
        Ok(match self {
            #[cfg(unix)]
            Self::Unix(listener) => Box::new(listener.accept()?.0),
            Self::Tcp(listener) => {
                let stream = listener.accept()?.0;
                stream.set_nodelay(true)?;
                Box::new(stream)
            }
        })
    }
}

impl Wire for Box<dyn Wire> {
    fn set_patience(&mut self, patience: Duration) -> io::Result<()> {
        self.as_mut().set_patience(patience)
    }
}
