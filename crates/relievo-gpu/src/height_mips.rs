//! The mip levels of a height map, kept up to date on the device.

use wgpu::util::DeviceExt;

use crate::layout::PartLayout;
use crate::live_heights::extent;
use crate::pyramid_kernels::{bind_group_layout, groups, pipeline, storage, task, texture};
use crate::pyramid_plan::Part;

/// Halves level after level, through a buffer.
#[derive(Debug)]
pub(crate) struct HeightMips {
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    /// Texels of each level.
    sizes: Vec<[u32; 2]>,
    /// Weights of each level but the first.
    weights: Vec<wgpu::Buffer>,
    /// Where a level is computed.
    texels: wgpu::Buffer,
}

impl HeightMips {
    /// For a map with levels of these sizes.
    pub(crate) fn new(device: &wgpu::Device, sizes: Vec<[u32; 2]>) -> Self {
        let layout = bind_group_layout(device, [texture(), task(), storage(true), storage(false)]);
        let largest = sizes.get(1).map_or(4, |&size| u64::from(row_bytes(size)) * u64::from(size[1]));
        Self {
            pipeline: pipeline(device, &layout, "halve", "halve"),
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

    /// Records what brings all levels but the first up to date after `changed` texels of that one; gives what has changed in
    /// each. `views` has one of each level.
    pub(crate) fn record(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        views: &[wgpu::TextureView],
        changed: Part,
    ) -> Vec<Part> {
        let mut parts = vec![changed];
        for (k, weights) in self.weights.iter().enumerate() {
            let size = self.sizes[k + 1];
            let part = parts[k].halved(size);
            parts.push(part);
            let columns = size[0];
            let task =
                PartLayout { first: part.min, count: part.size(), pitch: row_bytes(size) / 4, columns, pad: [0; 2] };
            let task = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("relievo mip level"),
                contents: bytemuck::bytes_of(&task),
                usage: wgpu::BufferUsages::UNIFORM,
            });
            let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
            let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("relievo mip level"),
                layout: &self.layout,
                entries: &[
                    entry(0, wgpu::BindingResource::TextureView(&views[k])),
                    entry(1, task.as_entire_binding()),
                    entry(2, weights.as_entire_binding()),
                    entry(3, self.texels.as_entire_binding()),
                ],
            });
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

/// How much of which texels belongs to each of a mip level, by columns and rows: the numbers of `Grid::halved`.
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
