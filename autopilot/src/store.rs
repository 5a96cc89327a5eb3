//! Parameters that survive a reset: records in two pages of flash, each with a checksum, so that a
//! write that is cut short costs what it wrote and nothing else.
//!
//! A parameter that is set is appended as a record of its name's hash, its value and a checksum;
//! the last good one counts. When a page is more than half full at a start, what differs from the
//! defaults is written to the other page, whose first record, its number, comes last and makes it
//! the valid one. Until then the old page is. Erasing, which may take seconds, so happens at a
//! start alone.

use crate::settings::{self, Settings};

/// Bytes of a record: key, value, checksum, each with its least byte first.
pub const RECORD: usize = 12;

/// Two pages of memory as flash is: erased to ones, and written once. What is written may be less
/// than all when power fails.
pub trait Flash {
    /// Records that a page holds.
    const RECORDS: usize;

    /// Reads a record of page 0 or 1.
    fn read(&self, page: usize, record: usize) -> [u8; RECORD];

    /// Writes an erased record.
    ///
    /// # Errors
    /// The hardware's.
    fn write(&mut self, page: usize, record: usize, bytes: &[u8; RECORD]) -> Result<(), FlashFault>;

    /// Erases a page.
    ///
    /// # Errors
    /// The hardware's.
    fn erase(&mut self, page: usize) -> Result<(), FlashFault>;
}

/// The flash did not do as it was told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlashFault;

/// Why a parameter is not kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotKept {
    /// The page is full until the next start.
    Full,
    /// The flash's fault.
    Flash,
    /// There is none.
    NoMemory,
}

impl From<FlashFault> for NotKept {
    fn from(FlashFault: FlashFault) -> Self {
        Self::Flash
    }
}

/// Parameters in flash.
#[derive(Clone, Debug)]
pub struct Store<F> {
    flash: F,
    /// The valid page, its number, and where its next record goes.
    page: usize,
    number: u32,
    next: usize,
}

/// The key of a page's first record. No name has this hash: a test tries all.
const NUMBER: u32 = 0;
const ERASED: [u8; RECORD] = [0xFF; RECORD];

impl<F: Flash> Store<F> {
    /// Reads what is kept into `settings`, and tidies up. To be called before anything that must
    /// not wait for an erasure.
    ///
    /// # Errors
    /// The flash's; `settings` then holds what could be read.
    pub fn open(flash: F, settings: &mut Settings) -> Result<Self, FlashFault> {
        let numbers = [0, 1].map(|page| number(&flash, page));
        let (page, found) = match numbers {
            [Some(first), Some(second)] if second.wrapping_sub(first).cast_signed() > 0 => (1, Some(second)),
            [None, Some(second)] => (1, Some(second)),
            [first, _] => (0, first),
        };
        let mut store = Self { flash, page, number: found.unwrap_or(0), next: 1 };
        if found.is_none() {
            // Never used, or not by this program.
            store.flash.erase(page)?;
            store.begin()?;
            return Ok(store);
        }
        for index in 1..F::RECORDS {
            let record = store.flash.read(store.page, index);
            if record != ERASED {
                store.next = index + 1;
            }
            if let Some((key, value)) = parse(&record) {
                // One that is no parameter's any more, or out of its range now, is left out.
                let place = settings::entries().position(|entry| hash(entry.name.as_str()) == key);
                let _ = place.map(|place| settings.set_at(place, f32::from_bits(value)));
            }
        }
        if store.next > F::RECORDS / 2 {
            store.tidy(settings)?;
        }
        Ok(store)
    }

    /// Keeps the parameter at `index` of `settings`.
    ///
    /// # Errors
    /// It is not kept.
    pub fn keep(&mut self, settings: &Settings, index: usize) -> Result<(), NotKept> {
        let Some((entry, value)) = settings.at(index) else { return Ok(()) };
        self.append(hash(entry.name.as_str()), value.to_bits())
    }

    /// The flash.
    #[must_use]
    pub fn flash(&self) -> &F {
        &self.flash
    }

    /// Writes what differs from the defaults to the other page, which is then the valid one.
    fn tidy(&mut self, settings: &Settings) -> Result<(), FlashFault> {
        self.page = 1 - self.page;
        self.next = 1;
        self.flash.erase(self.page)?;
        for (entry, value) in settings.iter() {
            if value.to_bits() != entry.default.to_bits() {
                let written = self.append(hash(entry.name.as_str()), value.to_bits());
                written.map_err(|_| FlashFault)?;
            }
        }
        self.number = self.number.wrapping_add(1);
        self.begin()
    }

    /// Makes the page the valid one.
    fn begin(&mut self) -> Result<(), FlashFault> {
        self.flash.write(self.page, 0, &record(NUMBER, self.number))
    }

    fn append(&mut self, key: u32, value: u32) -> Result<(), NotKept> {
        if self.next >= F::RECORDS {
            return Err(NotKept::Full);
        }
        let record = record(key, value);
        self.next += 1;
        self.flash.write(self.page, self.next - 1, &record)?;
        if self.flash.read(self.page, self.next - 1) == record { Ok(()) } else { Err(NotKept::Flash) }
    }
}

/// A page's number, if it is valid.
fn number<F: Flash>(flash: &F, page: usize) -> Option<u32> {
    parse(&flash.read(page, 0)).filter(|&(key, _)| key == NUMBER).map(|(_, number)| number)
}

fn record(key: u32, value: u32) -> [u8; RECORD] {
    let [a, b, c, d] = key.to_le_bytes();
    let [e, f, g, h] = value.to_le_bytes();
    let [i, j, k, l] = checksum(key, value).to_le_bytes();
    [a, b, c, d, e, f, g, h, i, j, k, l]
}

/// Key and value, if the checksum is right.
fn parse(&[a, b, c, d, e, f, g, h, i, j, k, l]: &[u8; RECORD]) -> Option<(u32, u32)> {
    let (key, value) = (u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h]));
    (u32::from_le_bytes([i, j, k, l]) == checksum(key, value)).then_some((key, value))
}

/// CRC-32 (IEEE 802.3, bit by bit) of key and value.
fn checksum(key: u32, value: u32) -> u32 {
    let bits = u64::from(value) << 32 | u64::from(key);
    let crc = (0..64).fold(u32::MAX, |crc, bit| {
        let mixed = crc ^ (bits >> bit) as u32 & 1;
        if mixed & 1 == 1 { mixed >> 1 ^ 0xEDB8_8320 } else { mixed >> 1 }
    });
    !crc
}

/// FNV-1a of a name.
fn hash(name: &str) -> u32 {
    name.bytes().fold(0x811C_9DC5, |hash, byte| (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_the_usual_crc() {
        // The check value of CRC-32/ISO-HDLC is of nine digits; of "12345678" it is this.
        let (key, value) = (u32::from_le_bytes(*b"1234"), u32::from_le_bytes(*b"5678"));
        assert_eq!(checksum(key, value), 0x9AE0_DAAF);
    }

    #[test]
    fn every_name_has_its_own_key() {
        for (index, entry) in settings::entries().enumerate() {
            let key = hash(entry.name.as_str());
            assert_ne!(key, NUMBER);
            assert!(settings::entries().take(index).all(|other| hash(other.name.as_str()) != key));
        }
    }
}
