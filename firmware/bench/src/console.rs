//! Lines of `key=value` fields to the emulator's standard output, without the formatting machinery
//! and its panics.

use cortex_m_semihosting::hio::{self, HostStream};
use cortex_m_semihosting::{nr, syscall1};

/// Whether the host's command line for this program is `line`, of at most 15 bytes.
pub fn is_command_line(line: &[u8]) -> bool {
    let mut text = [0_u8; 16];
    let mut block = [text.as_mut_ptr() as usize, text.len()];
    // SAFETY: the call writes into `text`, at most the length that it is told, and into `block`;
    // both outlive it.
    let failed = unsafe { syscall1(nr::GET_CMDLINE, block.as_mut_ptr() as usize) };
    failed == 0 && text.strip_prefix(line).is_some_and(|rest| rest.first() == Some(&0))
}

/// The host's standard output through semihosting.
pub struct Console(HostStream);

impl Console {
    /// `None` where no host listens.
    pub fn open() -> Option<Self> {
        hio::hstdout().ok().map(Self)
    }

    /// `key=value` and a space.
    pub fn field(&mut self, key: &str, value: &str) {
        for part in [key, "=", value, " "] {
            self.put(part.as_bytes());
        }
    }

    /// `key=` and the number in hexadecimal.
    pub fn number(&mut self, key: &str, number: u64) {
        let mut digits = [0; 16];
        let mut rest = number;
        for digit in digits.iter_mut().rev() {
            *digit = match (rest & 0xF) as u8 {
                nibble @ 0..=9 => b'0' + nibble,
                nibble => b'a' + nibble - 10,
            };
            rest >>= 4;
        }
        self.put(key.as_bytes());
        self.put(b"=");
        self.put(&digits);
        self.put(b" ");
    }

    /// Ends the line.
    pub fn end(&mut self) {
        self.put(b"\n");
    }

    fn put(&mut self, bytes: &[u8]) {
        // Whoever reads the lines sees that some are missing; there is nobody else to tell.
        let _ = self.0.write_all(bytes);
    }
}
