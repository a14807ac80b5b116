use relievo_map::{Grid, HeightMap};
use relievo_march::{ReliefMap, TexelRect};
use wgpu::util::DeviceExt;

use crate::error::guarded;
use crate::height_mips::HeightMips;
use crate::layout::TaskLayout;
use crate::pyramid_kernels::{Kernels, Plan};
use crate::pyramid_plan::{MipNodes, Part, PyramidLayout};
use crate::{GpuError, HeightTexture, Tier};

/// Bytes of a node.
const NODE: u64 = 16;

/// Bytes that are kept of each mip level: `STATE` of pyramid_build.wgsl.
const STATE: u64 = 16;

/// How the heights of a changing map become codes of its pyramid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coding {
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
/// the marches read: 1.07 bytes per texel more than a [`HeightTexture`] takes.
#[derive(Debug)]
pub struct LiveHeights {
    device: wgpu::Device,
    heights: HeightTexture,
    coding: Coding,
    layout: PyramidLayout,
    /// Nodes from a row to the next in the buffer: copies ask for multiples of 256 bytes.
    pitch: u32,
    nodes: wgpu::Buffer,
    state: wgpu::Buffer,
    /// One view of each mip level.
    levels: Vec<wgpu::TextureView>,
    mips: HeightMips,
    kernels: Kernels,
}

impl LiveHeights {
    /// Uploads a map as it is at first. What lies outside of `coding`'s range is an error.
    ///
    /// # Errors
    /// If the device has no compute shaders, the map or its nodes are larger than the device's textures and buffers can be,
    /// the range is none in [0, 1] or the map leaves it, or the device fails.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        heights: &ReliefMap,
        coding: Coding,
    ) -> Result<Self, GpuError> {
        if !Tier::of(device).computes() {
            return Err(GpuError::NoCompute);
        }
        let whole = TexelRect { min: [0; 2], size: heights.size() };
        check_range(&heights.levels()[0], whole, coding)?;
        let layout = PyramidLayout::new(heights);
        let pitch = layout.size[0].next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT / NODE as u32);
        let bytes = u64::from(pitch) * u64::from(layout.size[1]) * NODE;
        let limits = device.limits();
        let max = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        if bytes > max {
            return Err(GpuError::BufferTooLarge { what: "the nodes of a changing height map".to_owned(), bytes, max });
        }
        let range = match coding {
            Coding::Range(range) => range,
            Coding::Own => [0.0, 1.0],
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
            let view = |level: usize| {
                texture.view().texture().create_view(&wgpu::TextureViewDescriptor {
                    base_mip_level: level as u32,
                    mip_level_count: Some(1),
                    ..wgpu::TextureViewDescriptor::default()
                })
            };
            Ok(Self {
                device: device.clone(),
                coding,
                pitch,
                nodes: buffer("relievo nodes", bytes, wgpu::BufferUsages::COPY_SRC),
                state: buffer("relievo ranges", STATE * layout.mips.len() as u64, wgpu::BufferUsages::COPY_DST),
                levels: (0..layout.mips.len()).map(view).collect(),
                mips: HeightMips::new(device, layout.mips.iter().map(|mip| mip.texels).collect()),
                kernels: Kernels::new(device),
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
    /// [`LiveHeights::update`] must follow. Heights are in [0, 1], and in the range of [`Coding::Range`]: rays pass through
    /// what is higher.
    #[must_use]
    pub fn texture(&self) -> &wgpu::Texture {
        self.heights.view().texture()
    }

    /// Takes over a changed part of a map from the host: as `ReliefMap::update`.
    ///
    /// # Errors
    /// If the map has another size, `dirty` is not inside it, its heights there leave the range of [`Coding::Range`], or the
    /// device fails.
    pub fn write(&self, queue: &wgpu::Queue, map: &HeightMap, dirty: TexelRect) -> Result<(), GpuError> {
        let size = [map.grid().width(), map.grid().height()];
        if size != self.layout.mips[0].texels {
            let [w, h] = self.layout.mips[0].texels;
            let text = format!("a map of {}×{} texels cannot take the place of one of {w}×{h}", size[0], size[1]);
            return Err(GpuError::Scene(text));
        }
        self.check_inside(dirty)?;
        check_range(map.grid(), dirty, self.coding)?;
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

    /// Records what brings mip levels and pyramids up to date after the heights in `dirty` have changed.
    ///
    /// # Errors
    /// If `dirty` is not inside the map.
    pub fn update(&self, encoder: &mut wgpu::CommandEncoder, dirty: TexelRect) -> Result<(), GpuError> {
        self.check_inside(dirty)?;
        if dirty.size.contains(&0) {
            return Ok(());
        }
        let alignment = self.device.limits().min_uniform_buffer_offset_alignment as usize;
        let stride = size_of::<TaskLayout>().next_multiple_of(alignment.max(16));
        let mut plan = Plan { stride, ..Plan::default() };
        let changed = self.mips.record(&self.device, encoder, &self.levels, Part::from(dirty));
        for ((mip, nodes), changed) in self.layout.mips.iter().enumerate().zip(changed) {
            if self.coding == Coding::Own {
                encoder.clear_buffer(&self.state, STATE * mip as u64, Some(8));
                let task = TaskLayout { mip: mip as u32, ..TaskLayout::default() };
                let blocks = nodes.levels[0].1;
                plan.dispatch(&self.kernels.range, mip, TaskLayout { count: blocks, ..task });
                self.plan_pyramid(&mut plan, mip, nodes, Part::all(nodes.texels));
            } else {
                self.plan_pyramid(&mut plan, mip, nodes, changed);
            }
        }
        self.record(encoder, &plan);
        Ok(())
    }

    /// The nodes of one mip level that hold these texels, from the lowest level up, and the header.
    fn plan_pyramid<'a>(&'a self, plan: &mut Plan<'a>, mip: usize, nodes: &MipNodes, changed: Part) {
        let coding = match self.coding {
            Coding::Range(range) => coding_of(range),
            Coding::Own => [0.0; 2],
        };
        let task = TaskLayout { pitch: self.pitch, mip: mip as u32, coding, ..TaskLayout::default() };
        let mut parts: Vec<Part> = changed.cells(nodes.texels).collect();
        for (k, &(row, _)) in nodes.levels.iter().enumerate() {
            let (pipeline, blocks, below) = match k {
                0 => (&self.kernels.base, nodes.texels, 0),
                _ => (&self.kernels.above, nodes.levels[k - 1].1, nodes.levels[k - 1].0),
            };
            for part in &mut parts {
                *part = part.nodes();
                let (first, count) = (part.min, part.size());
                let sums = u32::from(k == 1);
                plan.dispatch(pipeline, mip, TaskLayout { first, count, blocks, row, below, sums, ..task });
                plan.copies.push((row, *part));
            }
        }
        let (lowest, size) = nodes.levels[0];
        let (top, levels) = (nodes.levels[nodes.levels.len() - 1].0, nodes.levels.len() as u32);
        let count = [1, 1];
        plan.dispatch(
            &self.kernels.header,
            mip,
            TaskLayout { count, blocks: size, row: top, below: lowest, levels, ..task },
        );
        plan.copies.push((0, Part { min: [mip as u32, 0], max: [mip as u32 + 1, 1] }));
    }

    fn record(&self, encoder: &mut wgpu::CommandEncoder, plan: &Plan<'_>) {
        let settings = self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("relievo pyramid tasks"),
            contents: &plan.settings,
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let bindings: Vec<_> = (0..self.levels.len()).map(|mip| self.bindings(mip, &settings)).collect();
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("relievo pyramid"),
            timestamp_writes: None,
        });
        for (number, dispatch) in plan.dispatches.iter().enumerate() {
            pass.set_pipeline(dispatch.pipeline);
            pass.set_bind_group(0, &bindings[dispatch.mip], &[(number * plan.stride) as u32]);
            pass.dispatch_workgroups(dispatch.groups[0], dispatch.groups[1], 1);
        }
        drop(pass);
        for (row, part) in &plan.copies {
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

    /// What the kernels bind for a mip level.
    fn bindings(&self, mip: usize, settings: &wgpu::Buffer) -> wgpu::BindGroup {
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        let task = wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: settings,
            offset: 0,
            size: std::num::NonZeroU64::new(size_of::<TaskLayout>() as u64),
        });
        self.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("relievo pyramid"),
            layout: &self.kernels.layout,
            entries: &[
                entry(0, wgpu::BindingResource::TextureView(&self.levels[mip])),
                entry(1, task),
                entry(2, self.nodes.as_entire_binding()),
                entry(3, self.state.as_entire_binding()),
            ],
        })
    }

    fn check_inside(&self, dirty: TexelRect) -> Result<(), GpuError> {
        let size = self.layout.mips[0].texels;
        let inside = |k: usize| dirty.min[k].checked_add(dirty.size[k]).is_some_and(|end| end <= size[k]);
        if inside(0) && inside(1) {
            return Ok(());
        }
        let ([x, y], [w, h]) = (dirty.min, dirty.size);
        Err(GpuError::Scene(format!("{w}×{h} texels from ({x}, {y}) on are not inside {}×{}", size[0], size[1])))
    }
}

/// The height of code 0 and the difference between two codes, as `MaxPyramid` has them.
fn coding_of([low, high]: [f32; 2]) -> [f32; 2] {
    if low < high { [low, (high - low) / 255.0] } else { [0.0, 1.0 / 255.0] }
}

/// Refuses heights that codes cannot bound.
fn check_range(map: &Grid<f32>, part: TexelRect, coding: Coding) -> Result<(), GpuError> {
    let Coding::Range([low, high]) = coding else { return Ok(()) };
    if !(0.0 <= low && low < high && high <= 1.0) {
        return Err(GpuError::Scene(format!("{low} to {high} is no range of heights: 0 ≤ lowest < highest ≤ 1")));
    }
    let rows = part.min[1]..part.min[1] + part.size[1];
    let texels = rows.flat_map(|y| (part.min[0]..part.min[0] + part.size[0]).map(move |x| *map.get(x, y)));
    let leaves = texels.into_iter().find(|h| !(*h >= low && *h <= high));
    leaves.map_or(Ok(()), |h| {
        Err(GpuError::Scene(format!("the height {h} is outside of the changing map's range, {low} to {high}")))
    })
}

pub(crate) fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}
