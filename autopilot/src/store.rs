//! Parameters, a mission and a fence that survive a reset: records in two pages of flash, each with
//! a checksum, so that a write that is cut short costs what it wrote and nothing else.
//!
//! A parameter that is set is appended as a record of its name's hash, its value and a checksum;
//! the last good one counts. The items of a mission are appended word by word, and then their
//! count, which makes what stands right before it the mission. When a page is more than half full
//! at a start, what differs from the defaults is written to the other page, with mission and fence;
//! its first record, its number, comes last and makes it the valid one. Until then the old page is.
//! Erasing, which may take seconds, so happens at a start alone.

use crate::mission::{Item, Kind, WORDS};
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

/// Why a parameter or a mission is not kept.
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

/// Parameters, mission and fence in flash.
#[derive(Clone, Debug)]
pub struct Store<F> {
    flash: F,
    /// The valid page, its number, and where its next record goes.
    page: usize,
    number: u32,
    next: usize,
}

/// The key of a page's first record, of a count of items, and of an item's first word, whose others
/// have the next ones. No name has a hash as small: a test tries all.
const NUMBER: u32 = 0;
const COUNT: u32 = 0x10;
const WORD: u32 = 0x20;
const LEAST_HASH: u32 = 0x100;
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
            if let Some((key, value)) = parse(&record).filter(|&(key, _)| key >= LEAST_HASH) {
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

    /// The items that are kept.
    pub fn items(&self, kind: Kind) -> impl Iterator<Item = Item> {
        let (first, count) = self.place(kind).unwrap_or_default();
        (0..count).map(move |item| {
            Item::of_words(core::array::from_fn(|word| {
                let record = self.flash.read(self.page, first + item * WORDS + word);
                parse(&record).map_or(0, |(_, value)| value)
            }))
        })
    }

    /// Keeps `items` in place of those that are kept.
    ///
    /// # Errors
    /// They are not kept, and those before are.
    pub fn keep_items(&mut self, kind: Kind, items: &[Item]) -> Result<(), NotKept> {
        if self.items(kind).map(|item| item.words()).eq(items.iter().map(Item::words)) {
            return Ok(());
        }
        if self.next + items.len() * WORDS >= F::RECORDS {
            return Err(NotKept::Full);
        }
        for item in items {
            for (key, word) in (WORD..).zip(item.words()) {
                self.append(key, word)?;
            }
        }
        self.append(COUNT + u32::from(kind.number()), items.len() as u32)
    }

    /// The first record of the items that are kept, and how many items they are.
    fn place(&self, kind: Kind) -> Option<(usize, usize)> {
        let record = |index| parse(&self.flash.read(self.page, index));
        let counts = |&(_, (key, _)): &(usize, (u32, u32))| key == COUNT + u32::from(kind.number());
        let (end, (_, count)) =
            (1..self.next).rev().filter_map(|index| Some((index, record(index)?))).find(counts)?;
        let count = count as usize;
        let first = end.checked_sub(count.checked_mul(WORDS)?)?;
        let keys = (WORD..WORD + WORDS as u32).cycle();
        let is_whole =
            (first..end).zip(keys).all(|(index, key)| record(index).is_some_and(|(found, _)| found == key));
        is_whole.then_some((first, count))
    }

    /// The flash.
    #[must_use]
    pub fn flash(&self) -> &F {
        &self.flash
    }

    /// Writes what differs from the defaults to the other page, with mission and fence, which is
    /// then the valid one.
    fn tidy(&mut self, settings: &Settings) -> Result<(), FlashFault> {
        let (old, places) = (self.page, Kind::ALL.map(|kind| self.place(kind)));
        self.page = 1 - self.page;
        self.next = 1;
        self.flash.erase(self.page)?;
        for (entry, value) in settings.iter() {
            if value.to_bits() != entry.default.to_bits() {
                let written = self.append(hash(entry.name.as_str()), value.to_bits());
                written.map_err(|_| FlashFault)?;
            }
        }
        for (first, count) in places.into_iter().flatten() {
            for index in first..=first + count * WORDS {
                if let Some((key, value)) = parse(&self.flash.read(old, index)) {
                    self.append(key, value).map_err(|_| FlashFault)?;
                }
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
fn parse(record: &[u8; RECORD]) -> Option<(u32, u32)> {
    if *record == ERASED {
        return None;
    }
    let &[a, b, c, d, e, f, g, h, i, j, k, l] = record;
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
            assert!(key >= LEAST_HASH);
            assert!(settings::entries().take(index).all(|other| hash(other.name.as_str()) != key));
        }
    }
}
