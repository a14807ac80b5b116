//! The 8-bit code of a cone's slope, in quantization steps of height per texel.

/// Bits by which a code is shifted to be the middle of an f32: a code is a small float, 4 bits of exponent before 4 of mantissa.
const CODE_BIT_SHIFT: u32 = 19;

/// The f32 bits added to a shifted code: code 240 is 2⁸ quantization steps of height per texel, more than any cell rises
/// above its neighbour.
const CODE_BIAS: u32 = 120 << 23;

/// Returns the slope that a code stands for, in quantization steps of height per texel.
#[inline]
pub(super) fn slope(code: u8) -> f32 {
    if code == 0 { 0.0 } else { f32::from_bits(CODE_BIAS + (u32::from(code) << CODE_BIT_SHIFT)) }
}

/// Returns the smallest code of a slope that is not below this one, in quantization steps of height per texel, at most 2⁸.
pub(super) fn slope_code(at_least: f64) -> u8 {
    if at_least <= 0.0 {
        return 0;
    }
    let code = (at_least as f32).to_bits().saturating_sub(CODE_BIAS) >> CODE_BIT_SHIFT;
    // One more where something was cut off.
    let code = code.min(254) as u8;
    if code > 0 && f64::from(slope(code)) >= at_least { code } else { code + 1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_rounded_up_and_by_less_than_a_sixteenth() {
        assert_eq!((slope_code(0.0), slope(0)), (0, 0.0));
        assert!(slope(240) == 256.0 && slope(248) == 384.0);
        for i in 0..20_000 {
            let steepness = 256.0 * (-f64::from(i) * 6e-4).exp();
            let rounded = f64::from(slope(slope_code(steepness)));
            assert!(
                rounded >= steepness && (rounded < steepness * 1.0626 || slope_code(steepness) == 1),
                "{steepness}: {rounded}"
            );
        }
        assert!((0..=255).all(|code| slope_code(slope(code).into()) == code));
    }
}
