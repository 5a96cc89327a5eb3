//! QEMU with a target's image, its first serial port on a socket of our own.

use std::io::Read;
use std::net::{Ipv4Addr, UdpSocket};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use super::datagrams::Datagrams;
use super::{Endpoint, HilError, Wire};

const PROGRAM: &str = "qemu-system-arm";

/// A running emulator; it ends with this value.
pub struct Emulator {
    child: Child,
    socket: UdpSocket,
    endpoint: Endpoint,
    /// What it writes until it ends.
    stderr: Option<JoinHandle<String>>,
    /// What it wrote.
    said: String,
    /// log2 of the virtual nanoseconds an instruction takes, where instructions are counted.
    shift: Option<u32>,
    machine: String,
}

impl Emulator {
    /// Starts `image` on `machine`. With `count`, virtual time is a count of instructions, so that
    /// the target's cycle counts are instructions and repeatable.
    ///
    /// # Errors
    /// [`HilError::Image`], [`HilError::NoEmulator`], or [`HilError::Connect`] if there is no free
    /// port.
    pub fn start(machine: &str, image: &Path, count: bool) -> Result<Self, HilError> {
        std::fs::File::open(image)
            .map_err(|source| HilError::Image { image: image.display().to_string(), source })?;
        let (socket, port) = free_port().map_err(|source| {
            let endpoint = Endpoint::Udp(Ipv4Addr::LOCALHOST.to_string());
            HilError::Connect { endpoint, source }
        })?;
        let mut command = program();
        command
            .args(["-machine", machine, "-display", "none", "-monitor", "none", "-kernel"])
            .arg(image)
            // Datagrams, because QEMU then reads a whole frame at once, and from other lines a byte
            // for each turn of its main loop; multiplexed for the sake of that buffer: the port
            // takes the next byte when it has been read, and not a turn later.
            .arg("-chardev")
            .arg(format!("udp,id=hil,host=127.0.0.1,port={port},localaddr=127.0.0.1,localport=0,mux=on"))
            // No byte has this value, so none is taken for the multiplexer's escape.
            .args(["-echr", "0x100", "-serial", "chardev:hil"]);
        let shift = count.then_some(Self::SHIFT);
        if let Some(shift) = shift {
            command.args(["-icount", &format!("shift={shift},sleep=off")]);
        }
        let mut child = command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|source| HilError::NoEmulator { program: PROGRAM.to_owned(), source })?;
        // Ends with the child; what it writes must not block it.
        let stderr = child.stderr.take().map(|mut pipe| {
            std::thread::spawn(move || {
                let mut bytes = Vec::new();
                let _ = pipe.read_to_end(&mut bytes);
                String::from_utf8_lossy(&bytes).into_owned()
            })
        });
        let endpoint = Endpoint::Udp(format!("127.0.0.1:{port}"));
        Ok(Self { child, socket, endpoint, stderr, said: String::new(), shift, machine: machine.to_owned() })
    }

    /// 2⁶ ns an instruction: more than a tick of either machine's cycle counter, so that none is
    /// lost to rounding.
    const SHIFT: u32 = 6;

    /// Where its serial port is heard.
    #[must_use]
    pub fn endpoint(&self) -> Endpoint {
        self.endpoint.clone()
    }

    /// The line to its serial port, once the target has spoken: where from, only its first word
    /// tells.
    ///
    /// # Errors
    /// [`HilError::EmulatorDied`], or [`HilError::Silent`] after `patience`.
    pub fn open(&mut self, patience: Duration) -> Result<Box<dyn Wire>, HilError> {
        let begun = Instant::now();
        let failed = |endpoint: &Endpoint, source| HilError::Connect { endpoint: endpoint.clone(), source };
        while self.socket.peer_addr().is_err() {
            self.check()?;
            if begun.elapsed() >= patience {
                return Err(HilError::Silent { endpoint: self.endpoint.clone(), waited: begun.elapsed() });
            }
            if let Ok((_, peer)) = self.socket.peek_from(&mut [0]) {
                self.socket.connect(peer).map_err(|source| failed(&self.endpoint, source))?;
            }
        }
        self.check()?;
        let line = self.socket.try_clone().and_then(Datagrams::over);
        Ok(Box::new(line.map_err(|source| failed(&self.endpoint, source))?))
    }

    /// Process number.
    #[must_use]
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Counts of the target's cycle counter for one instruction, where instructions are counted.
    #[must_use]
    pub fn counts_per_instruction(&self) -> Option<f64> {
        // QEMU's own core clocks of these machines; what the target's program believes does not
        // move them.
        let clock_hz = match self.machine.as_str() {
            "netduinoplus2" | "olimex-stm32-h405" => 168e6,
            "mps2-an385" | "mps2-an386" | "mps2-an500" | "mps2-an511" => 25e6,
            _ => return None,
        };
        self.shift.map(|shift| f64::from(1_u32 << shift) * 1e-9 * clock_hz)
    }

    /// An error if it has ended.
    ///
    /// # Errors
    /// [`HilError::EmulatorDied`] with what it wrote.
    pub fn check(&mut self) -> Result<(), HilError> {
        match self.child.try_wait() {
            Ok(None) => Ok(()),
            Ok(Some(status)) => Err(self.died(status.to_string())),
            Err(error) => Err(self.died(error.to_string())),
        }
    }

    fn died(&mut self, status: String) -> HilError {
        let _ = self.child.kill();
        if let Some(all) = self.stderr.take().and_then(|reader| reader.join().ok()) {
            self.said = all;
        }
        HilError::EmulatorDied { status, stderr: self.said.lines().collect::<Vec<_>>().join("; ") }
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A socket of ours, whose reads end soon, and its port.
fn free_port() -> std::io::Result<(UdpSocket, u16)> {
    let socket = UdpSocket::bind((Ipv4Addr::LOCALHOST, 0))?;
    socket.set_read_timeout(Some(Duration::from_millis(20)))?;
    let port = socket.local_addr()?.port();
    Ok((socket, port))
}

/// QEMU behind the tools that the system has: one that ends it with this process, however that
/// ends, and those that keep its threads on one core and from interrupting each other, since they
/// wake each other for each byte, and on two cores take longer to wake than to work.
fn program() -> Command {
    static STARTED: AtomicUsize = AtomicUsize::new(0);
    let cores = cores();
    let number = std::process::id() as usize + STARTED.fetch_add(1, Ordering::Relaxed);
    let core = number.checked_rem(cores.len()).and_then(|turn| cores.get(turn)).map(u32::to_string);
    let bound: &[&str] = &["setpriv", "--pdeathsig", "KILL"];
    let placed = core.as_ref().map(|core| ["taskset", "-c", core, "chrt", "-b", "0"]);
    let mut words: Vec<&str> = Vec::new();
    for tool in [Some(bound), placed.as_ref().map(|placed| &placed[..])].into_iter().flatten() {
        // It fails where a tool is missing or may not: then it goes without.
        let works = Command::new(tool[0]).args(&tool[1..]).arg("true").output();
        if works.is_ok_and(|output| output.status.success()) {
            words.extend(tool);
        }
    }
    words.push(PROGRAM);
    let mut command = Command::new(words[0]);
    command.args(&words[1..]);
    command
}

/// The cores that this process may run on; none where the system doesn't tell.
fn cores() -> Vec<u32> {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let list = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:")).unwrap_or_default();
    let range = |range: &str| {
        let (first, last) = range.split_once('-').unwrap_or((range, range));
        Some(first.parse().ok()?..=last.parse().ok()?)
    };
    list.trim().split(',').filter_map(range).flatten().collect()
}
