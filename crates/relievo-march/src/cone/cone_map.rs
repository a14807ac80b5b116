use relievo_map::Grid;

use super::build;
use super::cones::Cones;
use super::slope::slope;
use crate::MaxPyramid;

/// The cones of one height map, one to a cell.
///
/// A cone stands on the highest corner of its cell, at the height `top`, and its side rises by `slope` per texel. A point
/// x of the surface, in a cell that lies a gap of g texels away, is not higher than `top + slope·(g + 1)`: every point for
/// [`Cones::Conservative`] cones; for [`Cones::Relaxed`] ones the points that fall in the outward direction, where a ray from
/// the cone's cell could leave the surface again. (The generator of GPU Gems 3 follows rays from the lid
/// alone, and misses those that set out lower.) So a ray at the height z over any point of the cell, which goes d
/// texels per unit of height, may step down by `(z − top − slope) / (1 + d·slope)`.
///
/// Slopes are heights per texel: the depth of the relief, and the shape of texels, are the ray's, and one map serves all.
/// Both numbers have 8 bits, rounded so that cones get narrower: `top` quantized as in the [`MaxPyramid`], `slope` in steps
/// of 3 to 6 %. Distances are those on the tiling map; `clamp` and `mirror` bring no two places nearer to each other, and serve
/// from the same map.
#[derive(Clone, Debug, PartialEq)]
pub struct ConeMap {
    cones: Cones,
    pub(super) size: [u32; 2],
    low: f32,
    step: f32,
    pub(super) texels: Vec<[u8; 2]>,
}

impl ConeMap {
    /// Builds the cones of a height map from its pyramid, on all cores; the result does not depend on their number. In N² log N for
    /// N² texels.
    ///
    /// # Panics
    /// If the pyramid is that of a map of another size.
    #[must_use]
    pub fn build(map: &Grid<f32>, pyramid: &MaxPyramid, cones: Cones) -> Self {
        assert_eq!(pyramid.size(), [map.width(), map.height()], "the pyramid is that of the map");
        let texels = build::build(map, pyramid, cones);
        let [low, step] = pyramid.quantization();
        Self { cones, size: pyramid.size(), low, step, texels }
    }

    /// Returns the kind of these cones.
    #[must_use]
    pub fn cones(&self) -> Cones {
        self.cones
    }

    /// Returns the cells (and texels) along u and v.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns the quantized top and the slope's code of every cell, row by row.
    #[must_use]
    pub fn texels(&self) -> &[[u8; 2]] {
        &self.texels
    }

    /// Returns the height that a cone stands on.
    #[inline]
    #[must_use]
    pub fn top(&self, texel: [u8; 2]) -> f32 {
        self.low + f32::from(texel[0]) * self.step
    }

    /// Returns the slope of a cone's side, heights per texel.
    #[inline]
    #[must_use]
    pub fn slope(&self, texel: [u8; 2]) -> f32 {
        slope(texel[1]) * self.step
    }

    /// Returns the difference in height between two quantized heights.
    #[inline]
    #[must_use]
    pub fn quantization_step(&self) -> f32 {
        self.step
    }

    /// Returns the bytes of all cones.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.texels.as_slice())
    }

    /// Distorts all cones, for tests that must notice.
    #[cfg(test)]
    pub(crate) fn map_texels(&mut self, change: impl Fn([u8; 2]) -> [u8; 2]) {
        self.texels.iter_mut().for_each(|texel| *texel = change(*texel));
    }
}
