use relievo_map::{Grid, HeightMap};
use relievo_march::{ReliefMap, TexelRect};
use wgpu::util::DeviceExt;

use super::height_mips::HeightMips;
use super::height_texture::HeightTexture;
use super::layout::PyramidTaskLayout;
use super::pyramid_kernels::{PyramidKernels, PyramidUpdate};
use super::pyramid_layout::{MipNodes, PyramidLayout, TexelSpan};
use crate::device::guarded;
use crate::device::wgpu_util::{bind_group, extent, one_of, view};
use crate::{GpuError, Tier};

/// Bytes of a node.
const NODE: u64 = 16;

/// Bytes that are kept of each mip level: `RELIEVO_STATE_WORDS` of pyramid_build.wgsl.
const STATE: u64 = 16;

/// Quantization of the heights of a changing map to the codes of its pyramid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Quantization {
    /// 255 steps between these heights, which no texel may leave. With [0, 1] the heights of 8-bit maps are kept exactly.
    Range([f32; 2]),
    /// 255 steps between the lowest and the highest texel of each mip level, which the device finds anew with every update:
    /// tighter, and every update is one of the whole map.
    Own,
}

/// A height map that changes on the device, drawn into or painted on, with its mip levels and max pyramids kept up to date by
/// compute shaders.
///
/// ```text
///  your pass, or write() ──▶ texture level 0 ──update()──▶ other levels ──▶ nodes (buffer) ──▶ pyramid texture
/// ```
///
/// Nodes are made in a buffer, which every device that computes can write and read again, and copied into the texture that
/// the marches read: 1.07 bytes per texel more than a [`HeightTexture`] takes. A map of columns (nearest) has no nodes.
#[derive(Debug)]
pub struct LiveHeights {
    device: wgpu::Device,
    heights: HeightTexture,
    quantization: Quantization,
    layout: PyramidLayout,
    /// Nodes from a row to the next in the buffer: copies ask for multiples of 256 bytes.
    pitch: u32,
    nodes: wgpu::Buffer,
    state: wgpu::Buffer,
    /// One view of each mip level.
    levels: Vec<wgpu::TextureView>,
    mips: HeightMips,
    kernels: PyramidKernels,
}

impl LiveHeights {
    /// Uploads a map as it is at first. Heights outside of `quantization`'s range are an error.
    ///
    /// # Errors
    /// If the device has no compute shaders, the map or its nodes are larger than the device's textures and buffers can be,
    /// the range is none in [0, 1] or the map leaves it, or the device fails.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        heights: &ReliefMap,
        quantization: Quantization,
    ) -> Result<Self, GpuError> {
        if !Tier::of(device).computes() {
            return Err(GpuError::NoCompute);
        }
        let whole = TexelRect { min: [0; 2], size: heights.size() };
        check_range(&heights.levels()[0], whole, quantization)?;
        let layout = PyramidLayout::new(heights);
        let pitch = layout.size[0].next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT / NODE as u32);
        let bytes = u64::from(pitch) * u64::from(layout.size[1]) * NODE;
        let limits = device.limits();
        let max = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        if bytes > max {
            return Err(GpuError::BufferTooLarge { what: "the nodes of a changing height map".to_owned(), bytes, max });
        }
        let range = match quantization {
            Quantization::Range(range) => range,
            Quantization::Own => [0.0, 1.0],
        };
        let texture = HeightTexture::live(device, queue, heights, range)?;
        let live = guarded(device, || {
            let buffer = |label, size, usage| {
                let usage = wgpu::BufferUsages::STORAGE | usage;
                device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(label),
                    size,
                    usage,
                    mapped_at_creation: false,
                })
            };
            let level_view = |level: usize| {
                texture.view().texture().create_view(&wgpu::TextureViewDescriptor {
                    base_mip_level: level as u32,
                    mip_level_count: Some(1),
                    ..wgpu::TextureViewDescriptor::default()
                })
            };
            Ok(Self {
                device: device.clone(),
                quantization,
                pitch,
                nodes: buffer("relievo nodes", bytes, wgpu::BufferUsages::COPY_SRC),
                state: buffer("relievo ranges", STATE * layout.mips.len() as u64, wgpu::BufferUsages::COPY_DST),
                levels: (0..layout.mips.len()).map(level_view).collect(),
                mips: HeightMips::new(device, layout.mips.iter().map(|mip| mip.texels).collect()),
                kernels: PyramidKernels::new(device),
                layout,
                heights: texture,
            })
        })?;
        live.submit(queue, whole)?;
        Ok(live)
    }

    /// The map as marches bind it: for [`crate::ComputeField`], [`crate::Renderer::set_heights`], or shaders of one's own.
    #[must_use]
    pub fn heights(&self) -> &HeightTexture {
        &self.heights
    }

    /// The texture of the heights, format R32Float, to be written on the device: level 0, by a copy or as a storage texture.
    /// [`LiveHeights::update`] must follow. Heights are in [0, 1], and in the range of [`Quantization::Range`]: rays pass through
    /// what is higher.
    #[must_use]
    pub fn texture(&self) -> &wgpu::Texture {
        self.heights.view().texture()
    }

    /// Takes over a changed part of a map from the host: as `ReliefMap::update`.
    ///
    /// # Errors
    /// If the map has another size, `dirty` is not inside it, its heights there leave the range of [`Quantization::Range`], or the
    /// device fails.
    pub fn write(&self, queue: &wgpu::Queue, map: &HeightMap, dirty: TexelRect) -> Result<(), GpuError> {
        let size = [map.grid().width(), map.grid().height()];
        if size != self.layout.mips[0].texels {
            let [w, h] = self.layout.mips[0].texels;
            let text = format!("a map of {}×{} texels cannot take the place of one of {w}×{h}", size[0], size[1]);
            return Err(GpuError::InvalidArgument(text));
        }
        self.check_inside(dirty)?;
        check_range(map.grid(), dirty, self.quantization)?;
        if dirty.size.contains(&0) {
            return Ok(());
        }
        guarded(&self.device, || {
            let [x, y] = dirty.min;
            let target =
                wgpu::TexelCopyTextureInfo { origin: wgpu::Origin3d { x, y, z: 0 }, ..self.texture().as_image_copy() };
            let layout = wgpu::TexelCopyBufferLayout {
                offset: (u64::from(y) * u64::from(size[0]) + u64::from(x)) * 4,
                bytes_per_row: Some(size[0] * 4),
                rows_per_image: None,
            };
            queue.write_texture(target, bytemuck::cast_slice(map.grid().texels()), layout, extent(dirty.size));
            Ok(())
        })?;
        self.submit(queue, dirty)
    }

    fn submit(&self, queue: &wgpu::Queue, dirty: TexelRect) -> Result<(), GpuError> {
        guarded(&self.device, || {
            let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            self.update(&mut encoder, dirty)?;
            queue.submit([encoder.finish()]);
            Ok(())
        })
    }

    /// Records commands that bring mip levels and pyramids up to date after the heights in `dirty` have changed.
    ///
    /// # Errors
    /// If `dirty` is not inside the map.
    pub fn update(&self, encoder: &mut wgpu::CommandEncoder, dirty: TexelRect) -> Result<(), GpuError> {
        self.check_inside(dirty)?;
        if dirty.size.contains(&0) {
            return Ok(());
        }
        let alignment = self.device.limits().min_uniform_buffer_offset_alignment as usize;
        let stride = size_of::<PyramidTaskLayout>().next_multiple_of(alignment.max(16));
        let mut update_plan = PyramidUpdate { stride, ..PyramidUpdate::default() };
        let changed = self.mips.record(&self.device, encoder, &self.levels, TexelSpan::from(dirty));
        if self.heights.is_sampled_nearest() {
            return Ok(());
        }
        for ((mip, nodes), changed) in self.layout.mips.iter().enumerate().zip(changed) {
            if self.quantization == Quantization::Own {
                encoder.clear_buffer(&self.state, STATE * mip as u64, Some(8));
                let task = PyramidTaskLayout { mip: mip as u32, ..PyramidTaskLayout::default() };
                let blocks = nodes.levels[0].1;
                update_plan.dispatch(&self.kernels.range, mip, PyramidTaskLayout { count: blocks, ..task });
                self.plan_pyramid(&mut update_plan, mip, nodes, TexelSpan::all(nodes.texels));
            } else {
                self.plan_pyramid(&mut update_plan, mip, nodes, changed);
            }
        }
        self.record(encoder, &update_plan);
        Ok(())
    }

    /// The nodes of one mip level that hold these texels, from the lowest level up, and the header.
    fn plan_pyramid<'a>(
        &'a self,
        update_plan: &mut PyramidUpdate<'a>,
        mip: usize,
        nodes: &MipNodes,
        changed: TexelSpan,
    ) {
        let quantization = match self.quantization {
            Quantization::Range(range) => quantization_of(range),
            Quantization::Own => [0.0; 2],
        };
        let task =
            PyramidTaskLayout { pitch: self.pitch, mip: mip as u32, quantization, ..PyramidTaskLayout::default() };
        let mut parts: Vec<TexelSpan> = changed.cells(nodes.texels).collect();
        for (k, &(row, _)) in nodes.levels.iter().enumerate() {
            let (pipeline, blocks, below) = match k {
                0 => (&self.kernels.base, nodes.texels, 0),
                _ => (&self.kernels.above, nodes.levels[k - 1].1, nodes.levels[k - 1].0),
            };
            for part in &mut parts {
                *part = part.nodes();
                let (first, count) = (part.min, part.size());
                let sums = u32::from(k == 1);
                update_plan.dispatch(
                    pipeline,
                    mip,
                    PyramidTaskLayout { first, count, blocks, row, below, sums, ..task },
                );
                update_plan.copies.push((row, *part));
            }
        }
        let (lowest, size) = nodes.levels[0];
        let (top, levels) = (nodes.levels[nodes.levels.len() - 1].0, nodes.levels.len() as u32);
        let count = [1, 1];
        update_plan.dispatch(
            &self.kernels.header,
            mip,
            PyramidTaskLayout { count, blocks: size, row: top, below: lowest, levels, ..task },
        );
        update_plan.copies.push((0, TexelSpan { min: [mip as u32, 0], max: [mip as u32 + 1, 1] }));
    }

    fn record(&self, encoder: &mut wgpu::CommandEncoder, update_plan: &PyramidUpdate<'_>) {
        let settings = self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("relievo pyramid tasks"),
            contents: &update_plan.settings,
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let bindings: Vec<_> = (0..self.levels.len()).map(|mip| self.bindings(mip, &settings)).collect();
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("relievo pyramid"),
            timestamp_writes: None,
        });
        for (number, dispatch) in update_plan.dispatches.iter().enumerate() {
            pass.set_pipeline(dispatch.pipeline);
            pass.set_bind_group(0, &bindings[dispatch.mip], &[(number * update_plan.stride) as u32]);
            pass.dispatch_workgroups(dispatch.groups[0], dispatch.groups[1], 1);
        }
        drop(pass);
        for (row, part) in &update_plan.copies {
            let [x, y] = [part.min[0], row + part.min[1]];
            let buffer = wgpu::TexelCopyBufferInfo {
                buffer: &self.nodes,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: (u64::from(y) * u64::from(self.pitch) + u64::from(x)) * NODE,
                    bytes_per_row: Some(self.pitch * NODE as u32),
                    rows_per_image: None,
                },
            };
            let target = wgpu::TexelCopyTextureInfo {
                origin: wgpu::Origin3d { x, y, z: 0 },
                ..self.heights.pyramid().texture().as_image_copy()
            };
            encoder.copy_buffer_to_texture(buffer, target, extent(part.size()));
        }
    }

    /// Bindings of the kernels for a mip level.
    fn bindings(&self, mip: usize, settings: &wgpu::Buffer) -> wgpu::BindGroup {
        let resources = vec![
            (0, view(&self.levels[mip])),
            (1, one_of(settings, size_of::<PyramidTaskLayout>())),
            (2, self.nodes.as_entire_binding()),
            (3, self.state.as_entire_binding()),
        ];
        bind_group(&self.device, "relievo pyramid", &self.kernels.layout, resources)
    }

    fn check_inside(&self, dirty: TexelRect) -> Result<(), GpuError> {
        let size = self.layout.mips[0].texels;
        let inside = |k: usize| dirty.min[k].checked_add(dirty.size[k]).is_some_and(|end| end <= size[k]);
        if inside(0) && inside(1) {
            return Ok(());
        }
        let ([x, y], [w, h]) = (dirty.min, dirty.size);
        Err(GpuError::InvalidArgument(format!(
            "{w}×{h} texels from ({x}, {y}) on are not inside {}×{}",
            size[0], size[1]
        )))
    }
}

/// The height of code 0 and the difference between two codes, as `MaxPyramid` has them.
fn quantization_of([low, high]: [f32; 2]) -> [f32; 2] {
    if low < high { [low, (high - low) / 255.0] } else { [0.0, 1.0 / 255.0] }
}

/// Refuses heights that codes cannot bound.
fn check_range(map: &Grid<f32>, part: TexelRect, quantization: Quantization) -> Result<(), GpuError> {
    let Quantization::Range([low, high]) = quantization else { return Ok(()) };
    if !(0.0 <= low && low < high && high <= 1.0) {
        return Err(GpuError::InvalidArgument(format!(
            "{low} to {high} is no range of heights: 0 ≤ lowest < highest ≤ 1"
        )));
    }
    let rows = part.min[1]..part.min[1] + part.size[1];
    let texels = rows.flat_map(|y| (part.min[0]..part.min[0] + part.size[0]).map(move |x| *map.get(x, y)));
    let leaves = texels.into_iter().find(|h| !(*h >= low && *h <= high));
    leaves.map_or(Ok(()), |h| {
        Err(GpuError::InvalidArgument(format!(
            "the height {h} is outside of the changing map's range, {low} to {high}"
        )))
    })
}
