use super::height_field::HeightField;
use crate::Bounds;

/// A field whose samples are on the floor outside of its bounds. Cells are those of the field.
pub(crate) struct ClippedField<'a, F> {
    pub(crate) field: &'a F,
    pub(crate) bounds: Bounds,
}

impl<F: HeightField> HeightField for ClippedField<'_, F> {
    fn size(&self) -> [u32; 2] {
        self.field.size()
    }

    fn corners(&self, i: i32, j: i32) -> [f32; 4] {
        self.field.corners(i, j)
    }

    fn sample(&self, uv: [f32; 2]) -> f32 {
        if self.bounds.contains(uv) { self.field.sample(uv) } else { 0.0 }
    }

    fn range(&self) -> [f32; 2] {
        self.field.range()
    }

    fn texel_offset(&self) -> f32 {
        self.field.texel_offset()
    }
}
