//! The square root as the one instruction that the floating-point unit has for it.
//!
//! `f32::sqrt` belongs to `std`; a bare-metal crate has [`libm::sqrtf`], which computes the root
//! bit by bit in integers (61 instructions on a Cortex-M4F). Both are correctly rounded, as IEEE
//! 754 demands, so they agree in every bit of every number; only the sign and payload of a NaN
//! result may differ.
#![no_std]

/// √x in single precision, rounded to nearest; NaN for `x < 0`, and √(−0) = −0.
///
/// The compiler lets inline assembly hold a float in a float register only on targets with double
/// precision too, so the number travels through a core register: five instructions at most, and no
/// call.
#[cfg(all(target_arch = "arm", target_abi = "eabihf"))]
#[inline(always)]
#[must_use]
pub fn sqrt(x: f32) -> f32 {
    let root: u32;
    // SAFETY: `target_abi = "eabihf"` passes floats in FPU registers, so the unit is there and
    // enabled; the instructions change one core register and the one float register that they name.
    unsafe {
        core::arch::asm!("vmov s15, {x}", "vsqrt.f32 s15, s15", "vmov {x}, s15",
            x = inlateout(reg) x.to_bits() => root, out("s15") _, options(pure, nomem, nostack, preserves_flags));
    }
    f32::from_bits(root)
}

/// √x in single precision, rounded to nearest; NaN for `x < 0`, and √(−0) = −0.
#[cfg(not(all(target_arch = "arm", target_abi = "eabihf")))]
#[inline(always)]
#[must_use]
pub fn sqrt(x: f32) -> f32 {
    libm::sqrtf(x)
}

#[cfg(test)]
mod tests {
    use super::sqrt;

    #[test]
    fn edge_cases() {
        assert_eq!(sqrt(0.0).to_bits(), 0.0f32.to_bits());
        assert_eq!(sqrt(-0.0).to_bits(), (-0.0f32).to_bits());
        assert_eq!(sqrt(f32::INFINITY), f32::INFINITY);
        assert!(sqrt(-1.0).is_nan());
        assert!(sqrt(f32::NAN).is_nan());
        // The smallest subnormal, 2^-149: its root 2^-74.5 is a normal number.
        assert_eq!(sqrt(f32::from_bits(1)).to_bits(), 0x1A35_04F3);
    }

    #[test]
    fn correctly_rounded() {
        // A double holds the root of a single with enough bits (53 >= 2·24 + 2) that rounding twice
        // equals rounding once.
        let mut x = f32::MIN_POSITIVE;
        while x.is_finite() {
            assert_eq!(sqrt(x).to_bits(), (libm::sqrt(f64::from(x)) as f32).to_bits(), "{x:e}");
            x *= 1.000_37;
        }
    }
}
