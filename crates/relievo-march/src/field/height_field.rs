use crate::grid_line::TEXEL_CENTER;
use crate::{ConeField, Cones, PyramidField};

/// The surface that marches sample: a rectangle of texels, continued for ever in both directions, bilinear in between.
pub trait HeightField {
    /// Returns the texels along u and v.
    fn size(&self) -> [u32; 2];

    /// Returns the heights h00, h10, h01, h11 of the cell between the centres of texels (i, j) and (i+1, j+1); any i, j.
    fn corners(&self, i: i32, j: i32) -> [f32; 4];

    /// Returns the filtered height at `uv`; in [0, 1] for every finite uv.
    fn sample(&self, uv: [f32; 2]) -> f32;

    /// Returns heights that no texel falls below and none rises above, in [0, 1].
    fn range(&self) -> [f32; 2] {
        [0.0, 1.0]
    }

    /// Returns the distance of the first cell's lower corner from uv 0, in texels: half a texel, as cells lie between texel
    /// centres; 0 where each cell is a texel (nearest filtering).
    fn texel_offset(&self) -> f32 {
        TEXEL_CENTER
    }

    /// Returns the smallest difference in height that the map resolves: 1/255 for 8-bit maps, 0 where it does not matter.
    fn quantization_step(&self) -> f32 {
        0.0
    }

    /// Returns the same cells with their max pyramid, if there is one: the exact march then skips blocks.
    fn pyramid(&self) -> Option<PyramidField<'_>> {
        None
    }

    /// Returns the same cells with cones of this kind, if there are any, for [`crate::Technique::Cone`]. Without, it walks over
    /// every cell.
    fn cones(&self, _cones: Cones) -> Option<ConeField<'_>> {
        None
    }
}
