//! Numbers in [0, 1] and their stored integers: the one place where this rounding is written down.
//!
//! (Normals are in [-1, 1] and have their own pair: [`NormalMap::encode8`](crate::NormalMap::encode8).)

/// A number in [0, 1] as 8 bits: the nearest of 256 steps. Outside is clamped; NaN becomes 0.
#[inline]
#[must_use]
pub fn quantize8(x: f32) -> u8 {
    // `as` saturates and turns NaN into 0.
    (x * 255.0 + 0.5) as u8
}

/// A number in [0, 1] as 16 bits: the nearest of 65536 steps. Outside is clamped; NaN becomes 0.
#[inline]
#[must_use]
pub fn quantize16(x: f32) -> u16 {
    (x * 65535.0 + 0.5) as u16
}

/// The number in [0, 1] that 8 stored bits mean: `x / 255`. [`quantize8`] gives `x` back.
#[inline]
#[must_use]
pub fn dequantize8(x: u8) -> f32 {
    f32::from(x) / 255.0
}

/// The number in [0, 1] that 16 stored bits mean: `x / 65535`. [`quantize16`] gives `x` back.
#[inline]
#[must_use]
pub fn dequantize16(x: u16) -> f32 {
    f32::from(x) / 65535.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stored_value_survives_a_round_trip() {
        for x in 0..=255 {
            assert_eq!(quantize8(dequantize8(x)), x);
        }
        for x in 0..=65535 {
            assert_eq!(quantize16(dequantize16(x)), x);
        }
    }

    #[test]
    fn values_are_rounded_to_the_nearest_step_and_tamed_outside() {
        assert_eq!(quantize8(0.499 / 255.0), 0);
        assert_eq!(quantize8(0.501 / 255.0), 1);
        assert_eq!([f32::NAN, f32::NEG_INFINITY, -0.2, 1.2, f32::INFINITY].map(quantize8), [0, 0, 0, 255, 255]);
        assert_eq!([f32::NAN, f32::NEG_INFINITY, -0.2, 1.2, f32::INFINITY].map(quantize16), [0, 0, 0, 65535, 65535]);
    }
}
