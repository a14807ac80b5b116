use relievo_map::Wrap;
use relievo_march::{HeightField, Heights};

use crate::GpuError;
use crate::error::guarded;

/// A height map on the device, ready to be marched: format R32Float, with the mip levels it was given.
///
/// Shaders read it by `textureLoad`, so that the format need not be filterable.
#[derive(Debug)]
pub struct HeightTexture {
    view: wgpu::TextureView,
    ranges: Vec<[f32; 2]>,
    step: f32,
    eight_bit: bool,
}

impl HeightTexture {
    /// Uploads a height map.
    ///
    /// # Errors
    /// If it is larger than the device's textures can be, or the device fails.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, heights: &Heights) -> Result<Self, GpuError> {
        let levels = heights.levels();
        let [width, height] = heights.size();
        check_size(device, "the height map", width, height)?;
        let view = guarded(device, || {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("relievo heights"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: levels.len() as u32,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::R32Float,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            });
            for (level, grid) in levels.iter().enumerate() {
                let bytes = bytemuck::cast_slice(grid.texels());
                write_level(queue, &texture, level as u32, grid.width(), grid.height(), bytes);
            }
            Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
        })?;
        let ranges = (0..levels.len()).map(|level| heights.field(level as f32, Wrap::Repeat).range()).collect();
        Ok(Self { view, ranges, step: heights.step(), eight_bit: heights.is_filtered_in_8_bits() })
    }

    /// What shaders bind as `relief_heights`.
    #[must_use]
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// Lowest and highest texel of every mip level, the full-size map first: `Field.range` in the shaders.
    #[must_use]
    pub fn ranges(&self) -> &[[f32; 2]] {
        &self.ranges
    }

    /// The smallest difference in height that the map can tell: `Field.step` in the shaders.
    #[must_use]
    pub fn step(&self) -> f32 {
        self.step
    }

    /// Whether the map is to be filtered in 8-bit arithmetic: for [`crate::Permutation::eight_bit`].
    #[must_use]
    pub fn is_filtered_in_8_bits(&self) -> bool {
        self.eight_bit
    }

    /// The last mip level: `last` of `height_field` in the shaders.
    #[must_use]
    pub fn last_level(&self) -> u32 {
        self.ranges.len() as u32 - 1
    }
}

/// Refuses a texture that the device cannot have.
pub(crate) fn check_size(device: &wgpu::Device, what: &str, width: u32, height: u32) -> Result<(), GpuError> {
    let max = device.limits().max_texture_dimension_2d;
    if width.max(height) > max {
        return Err(GpuError::TextureTooLarge { what: what.to_owned(), width, height, max });
    }
    Ok(())
}

/// Fills one mip level of a texture.
pub(crate) fn write_level(
    queue: &wgpu::Queue,
    texture: &wgpu::Texture,
    level: u32,
    width: u32,
    height: u32,
    bytes: &[u8],
) {
    let target = wgpu::TexelCopyTextureInfo {
        texture,
        mip_level: level,
        origin: wgpu::Origin3d::ZERO,
        aspect: wgpu::TextureAspect::All,
    };
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some((bytes.len() / height as usize) as u32),
        rows_per_image: None,
    };
    queue.write_texture(target, bytes, layout, wgpu::Extent3d { width, height, depth_or_array_layers: 1 });
}
