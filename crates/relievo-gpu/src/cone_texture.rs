//! Cone maps on the device.

use relievo_march::{ConeMap, Cones, ReliefMap};

use crate::height_texture::write_level;

/// The cones of a height map, of both kinds: what shaders bind as `relief_cones`.
#[derive(Clone, Debug)]
pub(crate) struct ConeTextures {
    kinds: [Option<wgpu::TextureView>; 2],
    /// One cone with nothing free in it, for maps without: shaders see by its size that it is not theirs.
    none: wgpu::TextureView,
}

impl ConeTextures {
    /// Uploads what cones the heights have.
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue, heights: &ReliefMap) -> Self {
        let levels = |maps: &[ConeMap]| {
            upload(device, queue, &maps.iter().map(|map| (map.size(), map.texels())).collect::<Vec<_>>())
        };
        Self {
            kinds: Cones::ALL.map(|cones| heights.cones(cones).map(levels)),
            none: upload(device, queue, &[([1; 2], &[[u8::MAX; 2]])]),
        }
    }

    pub(crate) fn view(&self, cones: Cones) -> &wgpu::TextureView {
        let kinds = Cones::ALL.iter().zip(&self.kinds);
        kinds.filter(|(kind, _)| **kind == cones).find_map(|(_, view)| view.as_ref()).unwrap_or(&self.none)
    }
}

/// A mip level for each map: top and slope of each cell, format Rg8Uint.
fn upload(device: &wgpu::Device, queue: &wgpu::Queue, levels: &[([u32; 2], &[[u8; 2]])]) -> wgpu::TextureView {
    let [width, height] = levels[0].0;
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("relievo cones"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rg8Uint,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (level, ([width, height], texels)) in levels.iter().enumerate() {
        write_level(queue, &texture, level as u32, *width, *height, bytemuck::cast_slice(texels));
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
