//! Shadow maps: the surfaces that the lights of a scene see first, in textures.

use super::formats::{DEPTH_FORMAT, OBJECT_FORMAT};
use super::layout::CameraViewLayout;
use super::shadow_views::ShadowViews;

/// Depth and object take six bytes per texel; all maps together take no more than this.
const MAX_BYTES: u64 = 256 << 20;
const BYTES_PER_TEXEL: u64 = 6;
const SMALLEST: u32 = 256;
const LARGEST: u32 = 4096;
const STEP: u32 = 256;

/// The maps, drawn or to be drawn.
pub(crate) struct ShadowMaps {
    pub(crate) size: u32,
    /// All layers, for looking up.
    pub(crate) depths: wgpu::TextureView,
    pub(crate) objects: wgpu::TextureView,
    /// Each layer, for drawing into.
    pub(crate) layers: Vec<[wgpu::TextureView; 2]>,
    /// The views of the layers, `stride` bytes apart.
    pub(crate) views: wgpu::Buffer,
    pub(crate) texture: wgpu::Texture,
}

/// Texels per side for a picture of this size: three for each pixel, as far as there is room.
pub(crate) fn map_size(picture: [u32; 2], layers: usize, wanted: Option<u32>, largest: u32) -> u32 {
    let [width, height] = picture;
    let room = (MAX_BYTES / (BYTES_PER_TEXEL * layers.max(1) as u64)).isqrt() as u32;
    let size = wanted.unwrap_or_else(|| 3 * width.max(height)).clamp(SMALLEST, LARGEST).min(largest);
    // In steps, so that a window that is drawn larger does not ask for new maps with every pixel.
    (size.next_multiple_of(STEP).min(room) / STEP * STEP).clamp(SMALLEST.min(largest), largest)
}

/// Layers of the textures for this many views: OpenGL takes a square texture of one layer, or of a multiple of six, for
/// something else than an array.
pub(crate) fn array_layers(views: usize) -> u32 {
    let spare = views <= 1 || views.is_multiple_of(6);
    (views + usize::from(spare)).max(2) as u32
}

impl ShadowMaps {
    /// Empty maps for as many views; without views, something to bind.
    pub(crate) fn new(device: &wgpu::Device, views: &ShadowViews, size: u32, stride: u32) -> Self {
        let count = array_layers(views.layers.len());
        let size = if views.layers.is_empty() { 1 } else { size };
        let texture = |label, format| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: count },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT
                    | wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        };
        let (depths, objects) =
            (texture("relievo shadow depths", DEPTH_FORMAT), texture("relievo shadow objects", OBJECT_FORMAT));
        let all = |texture: &wgpu::Texture| {
            let dimension = Some(wgpu::TextureViewDimension::D2Array);
            texture.create_view(&wgpu::TextureViewDescriptor { dimension, ..Default::default() })
        };
        let layer = |texture: &wgpu::Texture, layer| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                base_array_layer: layer,
                array_layer_count: Some(1),
                ..Default::default()
            })
        };
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("relievo shadow views"),
            size: u64::from(stride) * u64::from(count),
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self {
            size,
            depths: all(&depths),
            objects: all(&objects),
            layers: (0..views.layers.len() as u32).map(|k| [layer(&depths, k), layer(&objects, k)]).collect(),
            views: buffer,
            texture: depths,
        }
    }

    /// Uploads the views that the layers will be drawn from.
    pub(crate) fn write_views(&self, queue: &wgpu::Queue, views: &ShadowViews, stride: u32) {
        let mut bytes = vec![0; stride as usize * views.layers.len()];
        for (view, slot) in views.layers.iter().zip(bytes.chunks_exact_mut(stride as usize)) {
            slot[..size_of::<CameraViewLayout>()].copy_from_slice(bytemuck::bytes_of(&view.layout()));
        }
        queue.write_buffer(&self.views, 0, &bytes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn textures_stay_arrays_by_opengl() {
        assert_eq!([0, 1, 2, 6, 8, 12, 252].map(array_layers), [2, 2, 2, 7, 8, 13, 253]);
    }

    #[test]
    fn maps_fit_the_picture_and_the_memory() {
        assert_eq!(map_size([960, 540], 2, None, 8192), 3072);
        assert_eq!(map_size([3000, 20], 1, None, 8192), 4096);
        assert_eq!(map_size([960, 540], 2, None, 1024), 1024);
        assert_eq!(map_size([960, 540], 2, Some(512), 8192), 512);
        assert_eq!(map_size([1, 1], 0, None, 8192), 256);
        assert_eq!(map_size([960, 540], 1, None, 128), 128);
        let many = map_size([1920, 1080], 252, None, 8192);
        assert!(u64::from(many).pow(2) * 6 * 252 <= MAX_BYTES, "{many}");
    }
}
