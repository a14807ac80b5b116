//! A height field with a pyramid of its own.

use relievo_march::{HeightField, PyramidField};

/// A field with another pyramid than its own: an updated one, or a wrong one that must be noticed.
#[derive(Clone, Copy, Debug)]
pub struct WithPyramid<'a, F>(pub F, pub PyramidField<'a>);

impl<F: HeightField> HeightField for WithPyramid<'_, F> {
    fn size(&self) -> [u32; 2] {
        self.0.size()
    }
    fn corners(&self, i: i32, j: i32) -> [f32; 4] {
        self.0.corners(i, j)
    }
    fn sample(&self, uv: [f32; 2]) -> f32 {
        self.0.sample(uv)
    }
    fn range(&self) -> [f32; 2] {
        self.0.range()
    }
    fn pyramid(&self) -> Option<PyramidField<'_>> {
        Some(self.1)
    }
}
