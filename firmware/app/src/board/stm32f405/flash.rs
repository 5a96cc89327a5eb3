//! Parameters, mission and fence in flash: sectors 10 and 11, of 128 KiB each, a page each.
//!
//! While flash is written or erased the core waits for its next instruction: 50 µs for a record,
//! which is written while disarmed, and so 60 ms for the longest mission; up to two seconds for a
//! sector, which is erased at a start, before the watchdog.

use autopilot::{Flash, FlashFault, RECORD};
use stm32f4xx_hal::pac::FLASH;

const FIRST_SECTOR: u8 = 10;
const FIRST_ADDRESS: usize = 0x080C_0000;
const PAGE: usize = 0x2_0000;
/// As RM0090 has them.
const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];
/// How often the busy bit is looked at: far longer than the longest erasure, even where the core
/// does not wait by itself.
const PATIENCE: u32 = 100_000_000;

/// The two sectors.
pub struct Memory(FLASH);

impl Memory {
    pub fn new(flash: FLASH) -> Self {
        Self(flash)
    }

    fn address(page: usize, record: usize) -> usize {
        FIRST_ADDRESS + page.min(1) * PAGE + record.min(Self::RECORDS - 1) * RECORD
    }

    /// Does `work` with the flash unlocked, and waits for its end.
    fn change(&mut self, work: impl FnOnce(&FLASH)) -> Result<(), FlashFault> {
        let flash = &self.0;
        for key in KEYS {
            // SAFETY: the sequence that unlocks.
            flash.keyr().write(|w| unsafe { w.key().bits(key) });
        }
        // Errors of before: cleared by writing ones.
        // SAFETY: the bits of errors and of an operation's end alone.
        flash.sr().write(|w| unsafe { w.bits(ERRORS | 1) });
        work(flash);
        let is_done = (0..PATIENCE).any(|_| flash.sr().read().bsy().bit_is_clear());
        let is_good = flash.sr().read().bits() & ERRORS == 0;
        flash.cr().write(|w| w.lock().set_bit());
        if is_done && is_good { Ok(()) } else { Err(FlashFault) }
    }
}

/// OPERR, WRPERR, PGAERR, PGPERR and PGSERR of FLASH_SR.
const ERRORS: u32 = 0b1111_0010;

impl Flash for Memory {
    /// 96 KiB: half of them hold all parameters, the longest mission and the longest fence.
    const RECORDS: usize = 8192;

    fn read(&self, page: usize, record: usize) -> [u8; RECORD] {
        let from = Self::address(page, record) as *const [u8; RECORD];
        // SAFETY: within the two sectors, where nothing else lies.
        unsafe { from.read_volatile() }
    }

    fn write(&mut self, page: usize, record: usize, bytes: &[u8; RECORD]) -> Result<(), FlashFault> {
        let (words, _) = bytes.as_chunks::<4>();
        for (word, index) in words.iter().zip(0..) {
            let to = (Self::address(page, record) + 4 * index) as *mut u32;
            self.change(|flash| {
                // SAFETY: of 32 bits at a time, at 2.7 V and more.
                flash.cr().write(|w| unsafe { w.psize().bits(0b10) }.pg().set_bit());
                // SAFETY: an aligned word within the two sectors, where nothing else lies.
                unsafe { to.write_volatile(u32::from_le_bytes(*word)) };
            })?;
        }
        if self.read(page, record) == *bytes { Ok(()) } else { Err(FlashFault) }
    }

    fn erase(&mut self, page: usize) -> Result<(), FlashFault> {
        let sector = FIRST_SECTOR + page.min(1) as u8;
        self.change(|flash| {
            // SAFETY: a sector of no code.
            let chosen = |w: &mut stm32f4xx_hal::pac::flash::cr::W| unsafe {
                w.psize().bits(0b10).ser().set_bit().snb().bits(sector);
            };
            flash.cr().write(|w| {
                chosen(w);
                w
            });
            flash.cr().write(|w| {
                chosen(w);
                w.strt().set_bit()
            });
        })?;
        // The data cache may hold what was there.
        let acr = self.0.acr();
        let is_cached = acr.read().dcen().bit_is_set();
        acr.modify(|_, w| w.dcen().clear_bit());
        acr.modify(|_, w| w.dcrst().set_bit());
        acr.modify(|_, w| w.dcrst().clear_bit());
        acr.modify(|_, w| w.dcen().bit(is_cached));
        Ok(())
    }
}
