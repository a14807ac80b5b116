use relievo_march::HeightField;

/// A height field with a constant added to all heights.
pub(super) struct RaisedField<'a, F> {
    pub(super) field: &'a F,
    pub(super) offset: f32,
}

impl<F: HeightField> HeightField for RaisedField<'_, F> {
    fn size(&self) -> [u32; 2] {
        self.field.size()
    }
    fn corners(&self, i: i32, j: i32) -> [f32; 4] {
        self.field.corners(i, j).map(|h| h + self.offset)
    }
    fn sample(&self, uv: [f32; 2]) -> f32 {
        self.field.sample(uv) + self.offset
    }
    fn range(&self) -> [f32; 2] {
        self.field.range().map(|h| h + self.offset)
    }
}
