//! placeholder
use crate::surface::{Surface, Texel};
/// The height scale
pub const TOY_BOX_HEIGHT_SCALE: f32 = 0.15;
pub(crate) struct ToyBox;
impl ToyBox {
    pub(crate) fn new() -> Self {
        Self
    }
}
impl Surface for ToyBox {
    type Scratch = ();
    fn scratch(&self, _: usize) {}
    fn height_scale(&self) -> f32 {
        TOY_BOX_HEIGHT_SCALE
    }
    fn row(&self, _: f32, _: &mut (), out: &mut [Texel]) {
        out.fill(Texel { height: 0.5, color: [0.5; 3], roughness: 0.5 });
    }
}
