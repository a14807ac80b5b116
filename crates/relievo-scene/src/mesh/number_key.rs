/// Returns numbers as the key of a map: 0 and −0 are one.
pub(super) fn number_key<const N: usize>(numbers: [f32; N]) -> [u32; N] {
    numbers.map(|x| (x + 0.0).to_bits())
}
