use super::HeightField;

/// A field without its pyramid and cones: the exact march visits every cell. For measuring and judging.
#[derive(Clone, Copy, Debug)]
pub struct WithoutPyramid<F>(pub F);

impl<F: HeightField> HeightField for WithoutPyramid<F> {
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
    #[inline]
    fn texel_offset(&self) -> f32 {
        self.0.texel_offset()
    }
}

/// A field raised by this height, or lowered by a negative one, without pyramid and cones: what rounding may do to a surface,
/// for judging hits at its crests.
#[derive(Clone, Copy, Debug)]
pub struct Raised<'a, F>(pub &'a F, pub f32);

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
    fn texel_offset(&self) -> f32 {
        self.0.texel_offset()
    }
}

/// A field upside down, without pyramid and cones: a line that rises out of the surface meets it from above here.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Negated<'a, F>(pub(crate) &'a F);

impl<F: HeightField> HeightField for Negated<'_, F> {
    #[inline]
    fn size(&self) -> [u32; 2] {
        self.0.size()
    }
    #[inline]
    fn corners(&self, i: i32, j: i32) -> [f32; 4] {
        self.0.corners(i, j).map(|h| -h)
    }
    #[inline]
    fn sample(&self, uv: [f32; 2]) -> f32 {
        -self.0.sample(uv)
    }
    #[inline]
    fn range(&self) -> [f32; 2] {
        let [low, high] = self.0.range();
        [-high, -low]
    }
    #[inline]
    fn texel_offset(&self) -> f32 {
        self.0.texel_offset()
    }
}
