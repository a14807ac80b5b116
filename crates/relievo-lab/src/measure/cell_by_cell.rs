use relievo_march::HeightField;

/// A height field without its pyramid: the exact march visits every cell.
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
