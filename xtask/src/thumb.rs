//! What a Thumb-2 instruction does to the stack pointer and to the flow of control: enough to bound
//! the stack.
//!
//! Encodings: ARMv7-M Architecture Reference Manual, A7.7.

/// The effect of one instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// None that matters here.
    Other,
    /// Takes this many bytes of stack.
    Stack(u32),
    /// Calls, or branches to, this address.
    Branch(u32),
    /// Calls or jumps to an address in a register.
    Indirect,
    /// Sets the stack pointer in a way that is not followed.
    UnknownStack,
}

/// The effect of the instruction at `address`, and its length in bytes. `second` is its second half
/// if it has one.
pub fn decode(address: u32, first: u16, second: u16) -> (Effect, u32) {
    // The prefixes 11101, 11110 and 11111 start an instruction of 32 bits.
    if first >> 11 >= 0b11101 { (wide(address, first, second), 4) } else { (narrow(address, first), 2) }
}

fn narrow(address: u32, word: u16) -> Effect {
    let pc = address.wrapping_add(4);
    let register = (word >> 3) & 15;
    match word {
        // PUSH
        _ if word & 0xFE00 == 0xB400 => Effect::Stack(4 * (word & 0x1FF).count_ones()),
        // SUB SP, SP, #imm7
        _ if word & 0xFF80 == 0xB080 => Effect::Stack(4 * u32::from(word & 0x7F)),
        // BX; by the link register it is a return
        _ if word & 0xFF87 == 0x4700 && register != 14 => Effect::Indirect,
        // BLX
        _ if word & 0xFF87 == 0x4780 => Effect::Indirect,
        // MOV PC, Rm
        _ if word & 0xFF87 == 0x4687 => Effect::Indirect,
        // ADD SP, Rm
        _ if word & 0xFF87 == 0x4485 => Effect::UnknownStack,
        // B with a condition
        _ if word & 0xF000 == 0xD000 && word & 0x0E00 != 0x0E00 => {
            Effect::Branch(pc.wrapping_add_signed(sign_extend(u32::from(word & 0xFF) << 1, 9)))
        }
        // B
        _ if word & 0xF800 == 0xE000 => {
            Effect::Branch(pc.wrapping_add_signed(sign_extend(u32::from(word & 0x7FF) << 1, 12)))
        }
        _ => Effect::Other,
    }
}

fn wide(address: u32, first: u16, second: u16) -> Effect {
    let pc = address.wrapping_add(4);
    let (a, b) = (u32::from(first), u32::from(second));
    match (first, second) {
        // PUSH.W of several (STMDB SP!)
        (0xE92D, _) => Effect::Stack(4 * (second & 0x5FFF).count_ones()),
        // PUSH.W of one (STR Rt, [SP, #-imm8]!)
        (0xF84D, _) if second & 0x0F00 == 0x0D00 => Effect::Stack(b & 0xFF),
        // STRD Rt, Rt2, [SP, #-imm8]!
        (0xE96D, _) => Effect::Stack(4 * (b & 0xFF)),
        // VPUSH: imm8 counts words for both sizes
        _ if first & 0xFFBF == 0xED2D && second & 0x0E00 == 0x0A00 => Effect::Stack(4 * (b & 0xFF)),
        // SUB.W SP, SP, #const
        _ if first & 0xFBEF == 0xF1AD && second & 0x8F00 == 0x0D00 => Effect::Stack(expand(immediate(a, b))),
        // SUBW SP, SP, #imm12
        _ if first & 0xFBFF == 0xF2AD && second & 0x8F00 == 0x0D00 => Effect::Stack(immediate(a, b)),
        // SUB.W SP, SP, Rm
        _ if first & 0xFFEF == 0xEBAD && second & 0x0F00 == 0x0D00 => Effect::UnknownStack,
        // BFC Rd, #0, #width: how a frame is aligned, at the cost of at most 2^width − 1 bytes
        (0xF36F, _) if second & 0x70C0 == 0 && second & 31 < 8 => Effect::Stack((2 << (b & 31)) - 1),
        // LDR PC, […]; from the stack it is a return
        _ if first & 0xFF70 == 0xF850 && second >> 12 == 15 && first != 0xF85D => Effect::Indirect,
        // BL and B.W
        _ if first & 0xF800 == 0xF000 && second & 0x9000 == 0x9000 => {
            let sign = (a >> 10) & 1;
            // J1 and J2 are the offset's bits 23 and 22, flipped for a negative offset's sake.
            let (i1, i2) = (!((b >> 13) ^ sign) & 1, !((b >> 11) ^ sign) & 1);
            let offset = sign << 24 | i1 << 23 | i2 << 22 | (a & 0x3FF) << 12 | (b & 0x7FF) << 1;
            Effect::Branch(pc.wrapping_add_signed(sign_extend(offset, 25)))
        }
        // B.W with a condition
        _ if first & 0xF800 == 0xF000 && second & 0xD000 == 0x8000 && first & 0x0380 != 0x0380 => {
            let sign = (a >> 10) & 1;
            let (j1, j2) = ((b >> 13) & 1, (b >> 11) & 1);
            let offset = sign << 20 | j2 << 19 | j1 << 18 | (a & 0x3F) << 12 | (b & 0x7FF) << 1;
            Effect::Branch(pc.wrapping_add_signed(sign_extend(offset, 21)))
        }
        _ => Effect::Other,
    }
}

/// i:imm3:imm8.
fn immediate(first: u32, second: u32) -> u32 {
    (first & 0x400) << 1 | (second & 0x7000) >> 4 | second & 0xFF
}

/// The modified immediate constant of A5.3.2.
fn expand(immediate: u32) -> u32 {
    let byte = immediate & 0xFF;
    match immediate >> 8 {
        0 => byte,
        1 => byte << 16 | byte,
        2 => byte << 24 | byte << 8,
        3 => byte << 24 | byte << 16 | byte << 8 | byte,
        _ => (0x80 | immediate & 0x7F).rotate_right(immediate >> 7),
    }
}

fn sign_extend(value: u32, bits: u32) -> i32 {
    (value << (32 - bits)).cast_signed() >> (32 - bits)
}

#[cfg(test)]
mod tests {
    use super::{Effect::*, decode};

    /// Assembled and disassembled by GNU binutils 2.40.
    #[test]
    fn known_encodings() {
        let table = [
            (0x00, [0xB580, 0x0000], Stack(8)),            // push {r7, lr}
            (0x02, [0xB5F0, 0x0000], Stack(20)),           // push {r4, r5, r6, r7, lr}
            (0x04, [0xB096, 0x0000], Stack(88)),           // sub sp, #88
            (0x06, [0x4770, 0x0000], Other),               // bx lr
            (0x08, [0x4718, 0x0000], Indirect),            // bx r3
            (0x0A, [0x4798, 0x0000], Indirect),            // blx r3
            (0x0C, [0x4697, 0x0000], Indirect),            // mov pc, r2
            (0x0E, [0x449D, 0x0000], UnknownStack),        // add sp, r3
            (0x10, [0xD006, 0x0000], Branch(0x20)),        // beq.n
            (0x12, [0xE7EE, 0x0000], Branch(0xFFFF_FFF2)), // b.n
            (0x14, [0xE92D, 0x0700], Stack(12)),           // stmdb sp!, {r8, r9, sl}
            (0x18, [0xF84D, 0xBD04], Stack(4)),            // str.w fp, [sp, #-4]!
            (0x1C, [0xE96D, 0x0102], Stack(8)),            // strd r0, r1, [sp, #-8]!
            (0x20, [0xED2D, 0x8B04], Stack(16)),           // vpush {d8-d9}
            (0x24, [0xED2D, 0x8A01], Stack(4)),            // vpush {s16}
            (0x28, [0xF5AD, 0x6DA0], Stack(1280)),         // sub.w sp, sp, #1280
            (0x2C, [0xF2AD, 0x5D04], Stack(1284)),         // subw sp, sp, #1284
            (0x30, [0xEBAD, 0x0D03], UnknownStack),        // sub.w sp, sp, r3
            (0x34, [0xF36F, 0x0403], Stack(15)),           // bfc r4, #0, #4
            (0x38, [0xF8D0, 0xF004], Indirect),            // ldr.w pc, [r0, #4]
            (0x3C, [0xF85D, 0xFB04], Other),               // ldr.w pc, [sp], #4
            (0x40, [0xF850, 0xF021], Indirect),            // ldr.w pc, [r0, r1, lsl #2]
            (0x44, [0xBD80, 0x0000], Other),               // pop {r7, pc}
            (0x46, [0xE8BD, 0x8100], Other),               // ldmia.w sp!, {r8, pc}
            (0x4A, [0xEE21, 0x1A01], Other),               // vmul.f32 s2, s2, s2
            (0x4E, [0xB002, 0x0000], Other),               // add sp, #8
            (0x50, [0xF6DC, 0xFDD3], Branch(0xFFED_CBFA)), // bl
            (0x54, [0xF254, 0xF18C], Branch(0x0065_4370)), // bl
            (0x58, [0xF7FD, 0xBDC6], Branch(0xFFFF_DBE8)), // b.w
            (0x5C, [0xF013, 0x82B4], Branch(0x0001_35C8)), // beq.w
            (0x60, [0xF1A7, 0x0410], Other),               // sub.w r4, r7, #16
            (0x66, [0xE8DF, 0xF000], Other),               // tbb [pc, r0]
        ];
        for (address, [first, second], effect) in table {
            assert_eq!(decode(address, first, second).0, effect, "{first:04x} {second:04x}");
        }
    }
}
