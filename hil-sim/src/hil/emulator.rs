//! QEMU with a target's image, its first serial port on a socket of our own.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};

use super::{Endpoint, HilError};

const PROGRAM: &str = "qemu-system-arm";

/// A running emulator; it ends with this value.
pub struct Emulator {
    child: Child,
    socket: PathBuf,
    stderr: Arc<Mutex<String>>,
    /// log2 of the virtual nanoseconds an instruction takes, where instructions are counted.
    shift: Option<u32>,
    machine: String,
}

impl Emulator {
    /// Starts `image` on `machine`. With `count`, virtual time is a count of instructions, so that the target's cycle counts are
    /// instructions and repeatable.
    ///
    /// # Errors
    /// [`HilError::Image`] or [`HilError::NoEmulator`].
    pub fn start(machine: &str, image: &Path, count: bool) -> Result<Self, HilError> {
        static STARTED: AtomicU32 = AtomicU32::new(0);
        std::fs::File::open(image)
            .map_err(|source| HilError::Image { image: image.display().to_string(), source })?;
        let number = STARTED.fetch_add(1, Ordering::Relaxed);
        let socket = std::env::temp_dir().join(format!("hil-{}-{number}.sock", std::process::id()));
        let _ = std::fs::remove_file(&socket);
        let mut command = Command::new(PROGRAM);
        command
            .args(["-machine", machine, "-display", "none", "-monitor", "none", "-kernel"])
            .arg(image)
            // It waits for us, so that its first words are not lost.
            .arg("-chardev")
            // Multiplexed for the sake of its buffer: a port takes the next byte when it has been read, and not a wake-up later.
            .arg(format!("socket,id=hil,path={},server=on,wait=on,mux=on", socket.display()))
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
        let stderr = Arc::new(Mutex::new(String::new()));
        if let Some(mut pipe) = child.stderr.take() {
            let stderr = Arc::clone(&stderr);
            // Ends with the child; what it writes must not block it.
            std::thread::spawn(move || {
                let mut bytes = [0; 512];
                while let Ok(count @ 1..) = pipe.read(&mut bytes) {
                    if let Ok(mut text) = stderr.lock() {
                        text.push_str(&String::from_utf8_lossy(&bytes[..count]));
                    }
                }
            });
        }
        Ok(Self { child, socket, stderr, shift, machine: machine.to_owned() })
    }

    /// 2⁶ ns an instruction: more than a tick of either machine's cycle counter, so that none is lost to rounding.
    const SHIFT: u32 = 6;

    /// Where its serial port is.
    #[must_use]
    pub fn endpoint(&self) -> Endpoint {
        Endpoint::Unix(self.socket.clone())
    }

    /// Process number.
    #[must_use]
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Counts of the target's cycle counter for one instruction, where instructions are counted.
    #[must_use]
    pub fn counts_per_instruction(&self) -> Option<f64> {
        // QEMU's own core clocks of these machines; what the target's program believes does not move them.
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

    fn died(&self, status: String) -> HilError {
        let text = self.stderr.lock().map(|text| text.clone()).unwrap_or_default();
        // It says on which socket it waits: no fault.
        let stderr =
            text.lines().filter(|line| !line.contains("waiting for connection")).collect::<Vec<_>>().join("; ");
        HilError::EmulatorDied { status, stderr }
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = std::fs::remove_file(&self.socket);
    }
}
