//! Cone maps on the device.

use relievo_march::{Cones, ReliefMap};
use relievo_shader::TextureBytes;

use super::upload::upload;
use crate::GpuError;

/// The cones of a height map, of all kinds: what shaders bind as `relievo_cones`.
#[derive(Clone, Debug)]
pub(crate) struct ConeTextures {
    kinds: Vec<(Cones, wgpu::TextureView)>,
    /// One cone with nothing free in it, for maps without: shaders see by its size that it is not theirs.
    none: wgpu::TextureView,
}

impl ConeTextures {
    /// Uploads the cones that the heights have.
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue, heights: &ReliefMap) -> Result<Self, GpuError> {
        let upload =
            |texture: &TextureBytes| upload(device, queue, "relievo cones", texture, wgpu::TextureUsages::empty());
        let built = Cones::ALL.into_iter().filter(|&cones| heights.cones(cones).is_some());
        let kinds = built.map(|cones| Ok((cones, upload(&TextureBytes::cones(heights, cones))?)));
        Ok(Self { kinds: kinds.collect::<Result<_, GpuError>>()?, none: upload(&TextureBytes::no_cones())? })
    }

    pub(crate) fn view(&self, cones: Cones) -> &wgpu::TextureView {
        self.kinds.iter().find(|(kind, _)| *kind == cones).map_or(&self.none, |(_, view)| view)
    }
}
