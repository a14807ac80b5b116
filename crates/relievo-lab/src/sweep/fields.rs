//! Height fields seen otherwise.

use relievo_march::HeightField;

/// A field without its pyramid: the exact march walks over every cell.
pub(crate) struct CellByCell<F>(pub(crate) F);

impl<F: HeightField> HeightField for CellByCell<F> {
    #[inline]
    fn size(&self) -> [u32; 2] {
        self.0.size()
    }
    #[inline]
    fn corners(&self, i: i32, j: i32) -> [f32; 4] {
        self.0.corners(i, j)
    }
    #[inline]
    fn sample(&self, uv: [f32; 2]) -> f32 {
        self.0.sample(uv)
    }
    #[inline]
    fn range(&self) -> [f32; 2] {
        self.0.range()
    }
    #[inline]
    fn quantization_step(&self) -> f32 {
        self.0.quantization_step()
    }
}

/// The surface, higher by a little.
pub(crate) struct Raised<'a, F>(pub(crate) &'a F, pub(crate) f32);

impl<F: HeightField> HeightField for Raised<'_, F> {
    fn size(&self) -> [u32; 2] {
        self.0.size()
    }
    fn corners(&self, i: i32, j: i32) -> [f32; 4] {
        self.0.corners(i, j).map(|h| h + self.1)
    }
    fn sample(&self, uv: [f32; 2]) -> f32 {
        self.0.sample(uv) + self.1
    }
    fn range(&self) -> [f32; 2] {
        self.0.range().map(|h| h + self.1)
    }
}
