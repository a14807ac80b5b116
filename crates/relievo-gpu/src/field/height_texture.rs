use relievo_map::Wrap;
use relievo_march::{Cones, HeightField, ReliefMap};
use relievo_shader::TextureBytes;

use super::cone_textures::ConeTextures;
use super::upload::upload;
use crate::GpuError;
use crate::device::guarded;
use crate::device::wgpu_util::check_size;

/// A height map on the device, ready to be marched: format R32Float, with the mip levels it was given; and the max pyramids
/// of all of them, in one texture of format Rgba32Uint; and their cones, if they were built, in format Rg8Uint.
///
/// The bytes are those of [`TextureBytes`]. Shaders read them by `textureLoad`, so that the formats need not be filterable:
/// they are there on the least of devices.
#[derive(Clone, Debug)]
pub struct HeightTexture {
    view: wgpu::TextureView,
    pyramid: wgpu::TextureView,
    cones: ConeTextures,
    ranges: Vec<[f32; 2]>,
    step: f32,
    eight_bit: bool,
    nearest: bool,
}

impl HeightTexture {
    /// Uploads a height map.
    ///
    /// # Errors
    /// If it is larger than the device's textures can be, or the device fails.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, heights: &ReliefMap) -> Result<Self, GpuError> {
        Self::with_usage(device, queue, heights, wgpu::TextureUsages::empty())
    }

    /// Uploads a height map whose heights the device may change, within `range`.
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
        let [width, height] = heights.size();
        check_size(device, "the height map", width, height)?;
        let made = |label, bytes: &TextureBytes, usage| guarded(device, || upload(device, queue, label, bytes, usage));
        let view = made("relievo heights", &TextureBytes::heights(heights), usage)?;
        let pyramid = made("relievo pyramid", &TextureBytes::pyramid(heights), wgpu::TextureUsages::COPY_SRC)?;
        let cones = guarded(device, || ConeTextures::new(device, queue, heights))?;
        let levels = heights.levels().len();
        Ok(Self {
            view,
            pyramid,
            cones,
            ranges: (0..levels).map(|level| heights.field(level as f32, Wrap::Repeat).range()).collect(),
            step: heights.quantization_step(),
            eight_bit: heights.is_filtered_in_8_bits(),
            nearest: heights.is_sampled_nearest(),
        })
    }

    /// View that shaders bind as `relievo_heights`.
    #[must_use]
    pub fn view(&self) -> &wgpu::TextureView {
        &self.view
    }

    /// View that shaders bind as `relievo_pyramid`, if they march or shadow by `exact`, or march by `cone`.
    #[must_use]
    pub fn pyramid(&self) -> &wgpu::TextureView {
        &self.pyramid
    }

    /// View that shaders bind as `relievo_cones`, if they march by `cone` with cones of this kind. Where the heights have none
    /// (see `ReliefMap::with_cones` of relievo-march), it makes them walk cell by cell.
    #[must_use]
    pub fn cones(&self, cones: Cones) -> &wgpu::TextureView {
        self.cones.view(cones)
    }

    /// Lowest and highest texel of every mip level, the full-size map first: `range` of `RelievoHeightField` in the shaders.
    #[must_use]
    pub fn ranges(&self) -> &[[f32; 2]] {
        &self.ranges
    }

    /// Smallest difference in height that the map can tell: `step` of `RelievoHeightField` in the shaders.
    #[must_use]
    pub fn quantization_step(&self) -> f32 {
        self.step
    }

    /// True if texels are columns with flat tops: for [`crate::Permutation::nearest`].
    #[must_use]
    pub fn is_sampled_nearest(&self) -> bool {
        self.nearest
    }

    /// True if the map is to be filtered in 8-bit arithmetic: for [`crate::Permutation::eight_bit`].
    #[must_use]
    pub fn is_filtered_in_8_bits(&self) -> bool {
        self.eight_bit
    }

    /// The last mip level: `last` of `relievo_height_field` in the shaders.
    #[must_use]
    pub fn last_level(&self) -> u32 {
        self.ranges.len() as u32 - 1
    }
}
