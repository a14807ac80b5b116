/// One texel of a pyramid: the highest points of 4×4 blocks, row by row, as quantized heights of [`crate::MaxPyramid::height`].
pub type Node = [u8; 16];

/// The bits of a cell's index that a node spans: 4 of its level's blocks along each axis.
pub(crate) const BITS: u32 = 2;

/// The height above a block at which a march may pass over it, in quantization steps: the heights of an 8-bit map are
/// multiples of 1/255 only up to rounding, and so are quantized heights and rays.
pub(crate) const SLACK: f32 = 1.0 / 256.0;

/// Returns the index in a node of the block that holds these cells or nodes of the level below.
#[inline(always)]
pub(crate) fn child_index([x, y]: [u32; 2]) -> usize {
    ((y & 3) * 4 + (x & 3)) as usize
}
