/// Returns the position of sample `i` in its pixel, 0..1 from the top left: the first in the middle, the others spread
/// evenly however many there are (the R2 sequence, Roberts 2018).
#[must_use]
pub fn sample_offset(i: u32) -> [f64; 2] {
    [0.754_877_666_246_692_7_f64, 0.569_840_290_998_053_3].map(|step| (0.5 + step * f64::from(i)).fract())
}
