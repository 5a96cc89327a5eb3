//! Cycles of a step by the published timings of its instructions, from a trace of the emulator,
//! which itself counts instructions only.
//!
//! Timings: Arm Cortex-M4 Processor Technical Reference Manual (100166), tables 3-1 and 7-1. A
//! division or root takes 14, a product that is added 3, a load or store 2, or 1 where a word
//! follows on another access, several words one more than they are; a branch taken 3. An
//! instruction whose condition fails counts as if it were carried out.

use std::collections::BTreeMap;
use std::ops::Range;

use anyhow::{Context, Result, ensure};
use object::{Object, ObjectSection, SectionKind};
use serde::{Deserialize, Serialize};

use crate::emulator::{self, Measured};
use crate::image::Image;

/// Cycles that a taken branch refills the pipeline for: 1 to 3, by its target.
const REFILL: u64 = 2;
/// VDIV and VSQRT.
const DIVISION: u64 = 14;
/// `blx r3`: how the probe calls a step.
const CALL: u16 = 0x4798;
/// Wait states of an STM32F405's flash at 168 MHz and 3.3 V, and bytes that a read brings (RM0090,
/// section 3.5). With its caches off and no prefetch, each line that is entered waits.
const WAIT_STATES: u64 = 5;
const LINE: u32 = 16;

/// Of the slowest step that was traced.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Cycles {
    /// From memory without wait states.
    pub zero_wait: u64,
    /// From an STM32F405's flash at 168 MHz without its accelerator: a bound.
    pub flash: u64,
    /// Divisions and roots among its instructions.
    pub divisions: u64,
}

/// The cycles of each case.
pub fn measure(machine: &str, image: &Image, cases: &[(String, Measured)]) -> Result<BTreeMap<String, Cycles>> {
    let code = Code::read(image)?;
    // Where the probe goes on after the step, by whichever of the compilers' two ways to name it.
    let ends: Vec<u32> =
        image.calls.named("bench::probe::Probe").filter_map(|probe| code.find(CALL, probe)).collect();
    let ends: Vec<u32> = ends.into_iter().map(|call| call + 2).collect();
    ensure!(!ends.is_empty(), "the bench has no probe");
    let entries: Vec<u32> = cases.iter().map(|(_, measured)| measured.entry).collect();
    let steps = entries.iter().flat_map(|&entry| image.calls.reachable(entry)).collect();
    let shown: Vec<Range<u32>> = image.calls.extents(&steps).chain(ends.iter().map(|&end| end..end + 2)).collect();

    let mut costs = Vec::new();
    let mut step: Option<Run> = None;
    emulator::trace(machine, &image.path, &shown, |address| match &mut step {
        None if entries.contains(&address) => step = Some(Run::at(address)),
        Some(run) => {
            run.pass(&code, address);
            if ends.contains(&address) {
                costs.push(run.cycles);
                step = None;
            }
        }
        None => {}
    })?;
    // As many steps of each case, one case after the other.
    ensure!(costs.len() == cases.len() * cases::STEPS * cases::FEW, "{} steps were traced", costs.len());
    let slowest =
        costs.chunks(cases::STEPS * cases::FEW).map(|steps| steps.iter().max().copied().unwrap_or_default());
    Ok(cases.iter().map(|(name, _)| name.clone()).zip(slowest).collect())
}

/// The image's instructions.
struct Code {
    start: u32,
    bytes: Vec<u8>,
}

impl Code {
    fn read(image: &Image) -> Result<Self> {
        let bytes = std::fs::read(&image.path)?;
        let elf = object::File::parse(&*bytes)?;
        let text = elf.sections().filter(|section| section.kind() == SectionKind::Text);
        let text = text.max_by_key(ObjectSection::size).context("the image has code")?;
        Ok(Self { start: text.address() as u32, bytes: text.data()?.to_vec() })
    }

    /// Where `instruction` first stands between two addresses.
    fn find(&self, instruction: u16, mut between: Range<u32>) -> Option<u32> {
        between.find(|&address| address % 2 == 0 && self.at(address).0 == instruction)
    }

    /// Both halves of what stands at an address, the second of no meaning in a short instruction.
    fn at(&self, address: u32) -> (u16, u16) {
        let half = |address: u32| {
            let at = address.wrapping_sub(self.start) as usize;
            self.bytes.get(at..at + 2).map_or(0, |bytes| u16::from_le_bytes([bytes[0], bytes[1]]))
        };
        (half(address), half(address + 2))
    }
}

/// A step under way.
struct Run {
    /// The instruction that is being carried out.
    address: u32,
    /// The one before was a single load or store.
    accessed: bool,
    line: u32,
    cycles: Cycles,
}

impl Run {
    fn at(entry: u32) -> Self {
        Self { address: entry, accessed: false, line: u32::MAX, cycles: Cycles::default() }
    }

    /// The instruction under way leads to `next`.
    fn pass(&mut self, code: &Code, next: u32) {
        let (first, second) = code.at(self.address);
        let length = if first >> 11 >= 0b11101 { 4 } else { 2 };
        let timing = timing(first, second);
        let mut cycles = match timing {
            Timing::Fixed(cycles) => cycles,
            Timing::Access => 2 - u64::from(self.accessed),
        };
        if next != self.address + length {
            cycles += REFILL;
        }
        self.cycles.zero_wait += cycles;
        self.cycles.flash += cycles;
        for half in [self.address, self.address + length - 2] {
            if half / LINE != self.line {
                self.line = half / LINE;
                self.cycles.flash += WAIT_STATES;
            }
        }
        self.cycles.divisions += u64::from(timing == Timing::Fixed(DIVISION));
        self.accessed = timing == Timing::Access;
        if is_literal(first, second) {
            self.cycles.flash += WAIT_STATES;
        }
        self.address = next;
    }
}

/// What an instruction takes where no branch is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Timing {
    Fixed(u64),
    /// A load or store of one word by the core, which can follow on another.
    Access,
}

/// The timing of an instruction; encodings: ARMv7-M Architecture Reference Manual, A5 and A6.
fn timing(first: u16, second: u16) -> Timing {
    let (a, b) = (u32::from(first), u32::from(second));
    let words = |list: u32| Timing::Fixed(1 + u64::from(list.count_ones()));
    match (first, second) {
        // PUSH and POP, LDM and STM
        _ if a & 0xF600 == 0xB400 => words(a & 0x1FF),
        _ if a & 0xF000 == 0xC000 => words(a & 0xFF),
        // LDR and STR of all sizes
        _ if a & 0xF800 == 0x4800 || (0x5000..0xA000).contains(&first) => Timing::Access,
        _ if first >> 11 < 0b11101 => Timing::Fixed(1),
        // LDM.W and STM.W, PUSH.W and POP.W
        _ if a & 0xFE40 == 0xE800 => words(b),
        // TBB, TBH, then LDRD and STRD
        _ if a & 0xFFF0 == 0xE8D0 && b & 0xFFE0 == 0xF000 => Timing::Fixed(2),
        _ if a & 0xFE40 == 0xE840 => Timing::Fixed(3),
        // LDR.W and STR.W
        _ if a & 0xFE00 == 0xF800 => Timing::Access,
        // SDIV and UDIV: 2 to 12
        _ if a & 0xFFD0 == 0xFB90 && b & 0xF0 == 0xF0 => Timing::Fixed(12),
        _ if a & 0xEC00 == 0xEC00 && b & 0x0E00 == 0x0A00 => Timing::Fixed(floating_point(a, b)),
        _ => Timing::Fixed(1),
    }
}

fn floating_point(a: u32, b: u32) -> u64 {
    let is_single = b & 0x0100 == 0;
    match a {
        // VMOV of two registers, VLDR and VSTR, then VLDM, VSTM, VPUSH and VPOP
        _ if a & 0xFFE0 == 0xEC40 => 2,
        _ if a & 0xFF20 == 0xED00 => 2 + u64::from(!is_single),
        _ if a & 0xFE00 == 0xEC00 => 1 + u64::from(b & 0xFF),
        // Between the registers of FPU and core
        _ if b & 0x10 != 0 => 1,
        // VMLA, VMLS, VNMLA, VNMLS; VFMA and its kind
        _ => match a >> 4 & 0b1011 {
            0b0000 | 0b0001 | 0b1001 | 0b1010 => 3,
            // VDIV
            0b1000 => DIVISION,
            // VSQRT
            0b1011 if a & 0xF == 1 && b & 0xC0 == 0xC0 => DIVISION,
            _ => 1,
        },
    }
}

/// LDR and VLDR of a constant among the code.
fn is_literal(first: u16, second: u16) -> bool {
    let is_float = first & 0xFF3F == 0xED1F && second & 0x0E00 == 0x0A00;
    first & 0xF800 == 0x4800 || first & 0xFF7F == 0xF85F || is_float
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Assembled and disassembled by GNU binutils 2.40.
    #[test]
    fn known_encodings() {
        let table = [
            ([0xB580, 0x0000], Timing::Fixed(3)),  // push {r7, lr}
            ([0xBD80, 0x0000], Timing::Fixed(3)),  // pop {r7, pc}
            ([0xE8BD, 0x8100], Timing::Fixed(3)),  // ldmia.w sp!, {r8, pc}
            ([0x6808, 0x0000], Timing::Access),    // ldr r0, [r1, #0]
            ([0x4801, 0x0000], Timing::Access),    // ldr r0, [pc, #4]
            ([0x9000, 0x0000], Timing::Access),    // str r0, [sp, #0]
            ([0xF8D1, 0x0080], Timing::Access),    // ldr.w r0, [r1, #128]
            ([0xE9D1, 0x0100], Timing::Fixed(3)),  // ldrd r0, r1, [r1]
            ([0x4348, 0x0000], Timing::Fixed(1)),  // muls r0, r1
            ([0xFBB1, 0xF0F2], Timing::Fixed(12)), // udiv r0, r1, r2
            ([0xFBA1, 0x0102], Timing::Fixed(1)),  // umull r0, r1, r1, r2
            ([0xEE30, 0x0A20], Timing::Fixed(1)),  // vadd.f32 s0, s0, s1
            ([0xEE20, 0x0A20], Timing::Fixed(1)),  // vmul.f32 s0, s0, s1
            ([0xEE00, 0x0A81], Timing::Fixed(3)),  // vmla.f32 s0, s1, s2
            ([0xEE00, 0x0AC1], Timing::Fixed(3)),  // vmls.f32 s0, s1, s2
            ([0xEE80, 0x0A81], Timing::Fixed(14)), // vdiv.f32 s0, s1, s2
            ([0xEEB1, 0x0AE0], Timing::Fixed(14)), // vsqrt.f32 s0, s1
            ([0xEEB1, 0x0A60], Timing::Fixed(1)),  // vneg.f32 s0, s1
            ([0xEEB0, 0x0AE0], Timing::Fixed(1)),  // vabs.f32 s0, s1
            ([0xEEB4, 0x0A60], Timing::Fixed(1)),  // vcmp.f32 s0, s1
            ([0xEEF1, 0xFA10], Timing::Fixed(1)),  // vmrs APSR_nzcv, fpscr
            ([0xEE10, 0x0A10], Timing::Fixed(1)),  // vmov r0, s0
            ([0xED90, 0x0A01], Timing::Fixed(2)),  // vldr s0, [r0, #4]
            ([0xED80, 0x0A01], Timing::Fixed(2)),  // vstr s0, [r0, #4]
            ([0xEC90, 0x0A04], Timing::Fixed(5)),  // vldmia r0, {s0-s3}
            ([0xED2D, 0x8B04], Timing::Fixed(5)),  // vpush {d8-d9}
        ];
        for ([first, second], expected) in table {
            assert_eq!(timing(first, second), expected, "{first:04x} {second:04x}");
        }
        assert!(is_literal(0xED9F, 0x0A01) && is_literal(0xED1F, 0x0A01) && !is_literal(0xED90, 0x0A01));
    }
}
