use relievo_map::Wrap;
use relievo_march::{Cones, HeightField, MaxPyramid, ReliefMap};

use crate::GpuError;
use crate::cone_texture::ConeTextures;
use crate::error::guarded;

/// A height map on the device, ready to be marched: format R32Float, with the mip levels it was given; and the max pyramids
/// of all of them, in one texture of format Rgba32Uint; and their cones, if they were built, in format Rg8Uint.
///
/// Shaders read both by `textureLoad`, so that the formats need not be filterable: they are there on the least of devices.
#[derive(Clone, Debug)]
pub struct HeightTexture {
    view: wgpu::TextureView,
    pyramid: wgpu::TextureView,
    cones: ConeTextures,
    ranges: Vec<[f32; 2]>,
    step: f32,
    eight_bit: bool,
}

impl HeightTexture {
    /// Uploads a height map.
    ///
    /// # Errors
    /// If it is larger than the device's textures can be, or the device fails.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, heights: &ReliefMap) -> Result<Self, GpuError> {
        Self::with_usage(device, queue, heights, wgpu::TextureUsages::empty())
    }

    /// One whose heights the device may change, within `range`.
    pub(crate) fn live(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        heights: &ReliefMap,
        range: [f32; 2],
    ) -> Result<Self, GpuError> {
        let usage = wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let mut texture = Self::with_usage(device, queue, heights, usage)?;
        texture.ranges.fill(range);
        Ok(texture)
    }

    fn with_usage(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        heights: &ReliefMap,
        usage: wgpu::TextureUsages,
    ) -> Result<Self, GpuError> {
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
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST | usage,
                view_formats: &[],
            });
            for (level, grid) in levels.iter().enumerate() {
                let bytes = bytemuck::cast_slice(grid.texels());
                write_level(queue, &texture, level as u32, grid.width(), grid.height(), bytes);
            }
            Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
        })?;
        let pyramid = guarded(device, || Ok(upload_pyramids(device, queue, heights.pyramids())))?;
        let cones = guarded(device, || Ok(ConeTextures::new(device, queue, heights)))?;
        let ranges = (0..levels.len()).map(|level| heights.field(level as f32, Wrap::Repeat).range()).collect();
        Ok(Self {
            view,
            pyramid,
            cones,
            ranges,
            step: heights.quantization_step(),
            eight_bit: heights.is_filtered_in_8_bits(),
        })
    }

    /// What shaders bind as `relief_heights`.
    #[must_use]
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// What shaders bind as `relief_pyramid`, if they march or shadow by `exact`, or march by `cone`.
    #[must_use]
    pub fn pyramid(&self) -> &wgpu::TextureView {
        &self.pyramid
    }

    /// What shaders bind as `relief_cones`, if they march by `cone` with cones of this kind. Where the heights have none (see
    /// `ReliefMap::with_cones` of relievo-march), it makes them walk cell by cell.
    #[must_use]
    pub fn cones(&self, cones: Cones) -> &wgpu::TextureView {
        self.cones.view(cones)
    }

    /// Lowest and highest texel of every mip level, the full-size map first: `HeightFieldView.range` in the shaders.
    #[must_use]
    pub fn ranges(&self) -> &[[f32; 2]] {
        &self.ranges
    }

    /// The smallest difference in height that the map can tell: `HeightFieldView.step` in the shaders.
    #[must_use]
    pub fn quantization_step(&self) -> f32 {
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

/// All pyramids below one another in one texture, after a row of headers: what descent.wgsl reads.
fn upload_pyramids(device: &wgpu::Device, queue: &wgpu::Queue, pyramids: &[MaxPyramid]) -> wgpu::TextureView {
    let widest = pyramids[0].level(1).size()[0] as usize;
    let width = widest.max(pyramids.len());
    let mut texels = vec![[0u32; 4]; width];
    for (k, pyramid) in pyramids.iter().enumerate() {
        let [low, step] = pyramid.quantization();
        let row = (texels.len() / width) as u32;
        let levels = pyramid.top();
        texels[k] = [row | levels << 24, low.to_bits(), step.to_bits(), pyramid.clearance().to_bits()];
        for level in pyramid.levels() {
            for nodes in level.nodes().chunks(level.size()[0] as usize) {
                let row = texels.len();
                texels.extend(nodes.iter().map(|node| {
                    std::array::from_fn(|k| u32::from_le_bytes([0, 1, 2, 3].map(|byte| node[4 * k + byte])))
                }));
                texels.resize(row + width, [0; 4]);
            }
        }
    }
    let height = (texels.len() / width) as u32;
    let descriptor = wgpu::TextureDescriptor {
        label: Some("relievo pyramid"),
        size: wgpu::Extent3d { width: width as u32, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Uint,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    };
    let texture = device.create_texture(&descriptor);
    write_level(queue, &texture, 0, width as u32, height, bytemuck::cast_slice(&texels));
    texture.create_view(&wgpu::TextureViewDescriptor::default())
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
