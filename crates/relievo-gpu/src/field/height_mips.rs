//! The mip levels of a height map, kept up to date on the device.

use wgpu::util::DeviceExt;

use super::layout::MipTaskLayout;
use super::pyramid_kernels::{groups, kernel_layout, module_pipeline};
use super::pyramid_layout::TexelSpan;
use crate::device::wgpu_util::{bind_group, extent, storage_type, view};

/// Halves level after level, through a buffer.
#[derive(Debug)]
pub(crate) struct HeightMips {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    /// Texels of each level.
    sizes: Vec<[u32; 2]>,
    /// Weights of each level but the first.
    weights: Vec<wgpu::Buffer>,
    /// Buffer that a level is computed in.
    texels: wgpu::Buffer,
}

impl HeightMips {
    /// Makes the pipeline for a map with levels of these sizes.
    pub(crate) fn new(device: &wgpu::Device, sizes: Vec<[u32; 2]>) -> Self {
        let layout = kernel_layout(device, storage_type(true));
        let largest = sizes.get(1).map_or(4, |&size| u64::from(row_bytes(size)) * u64::from(size[1]));
        Self {
            pipeline: module_pipeline(device, &layout, "halve", "relievo_halve"),
            layout,
            weights: sizes.windows(2).map(|pair| weights(device, pair[0], pair[1])).collect(),
            sizes,
            texels: device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("relievo mip level"),
                size: largest,
                usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
                mapped_at_creation: false,
            }),
        }
    }

    /// Records commands that bring all levels but the first up to date after `changed` texels of that one; gives the texels
    /// that have changed in each. `views` has one of each level.
    pub(crate) fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        views: &[wgpu::TextureView],
        changed: TexelSpan,
    ) -> Vec<TexelSpan> {
        let mut parts = vec![changed];
        for (k, weights) in self.weights.iter().enumerate() {
            let size = self.sizes[k + 1];
            let part = parts[k].halved(size);
            parts.push(part);
            let columns = size[0];
            let task =
                MipTaskLayout { first: part.min, count: part.size(), pitch: row_bytes(size) / 4, columns, pad: [0; 2] };
            let task = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("relievo mip level"),
                contents: bytemuck::bytes_of(&task),
                usage: wgpu::BufferUsages::UNIFORM,
            });
            let resources = vec![
                (0, view(&views[k])),
                (1, task.as_entire_binding()),
                (2, weights.as_entire_binding()),
                (3, self.texels.as_entire_binding()),
            ];
            let bindings = bind_group(device, "relievo mip level", &self.layout, resources);
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some("relievo mip level"),
                timestamp_writes: None,
            });
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &bindings, &[0]);
            let [x, y] = groups(part.size());
            pass.dispatch_workgroups(x, y, 1);
            drop(pass);
            let [x, y] = part.min;
            let from = wgpu::TexelCopyBufferInfo {
                buffer: &self.texels,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: u64::from(y) * u64::from(row_bytes(size)) + u64::from(x) * 4,
                    bytes_per_row: Some(row_bytes(size)),
                    rows_per_image: None,
                },
            };
            let to = wgpu::TexelCopyTextureInfo {
                mip_level: k as u32 + 1,
                origin: wgpu::Origin3d { x, y, z: 0 },
                ..views[0].texture().as_image_copy()
            };
            encoder.copy_buffer_to_texture(from, to, extent(part.size()));
        }
        parts
    }
}

/// Bytes from a row to the next of a level in the buffer.
fn row_bytes(size: [u32; 2]) -> u32 {
    (size[0] * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

/// Weights of the texels that belong to each of a mip level, by columns and rows: the numbers of `Grid::halved`.
fn weights(device: &wgpu::Device, from: [u32; 2], to: [u32; 2]) -> wgpu::Buffer {
    let axis = |k: usize| {
        let scale = f64::from(from[k]) / f64::from(to[k]);
        (0..to[k]).map(move |x| {
            let (start, end) = (f64::from(x) * scale, f64::from(x + 1) * scale);
            [0, 1, 2, 3].map(|i| {
                let texel = f64::from(2 * x + i);
                (((texel + 1.0).min(end) - texel.max(start)) / scale).max(0.0) as f32
            })
        })
    };
    let weights: Vec<[f32; 4]> = axis(0).chain(axis(1)).collect();
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("relievo weights"),
        contents: bytemuck::cast_slice(&weights),
        usage: wgpu::BufferUsages::STORAGE,
    })
}
