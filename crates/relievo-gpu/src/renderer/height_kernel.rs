//! Heights that change, made on the device: the kernels of recipes and of layers.

use bytemuck::{Pod, Zeroable};
use relievo_make::{HeightLayers, HeightProgram, LayerBlend, OctaveEntry};
use relievo_scene::ChangingHeights;
use wgpu::util::DeviceExt;

use crate::device::guarded;
use crate::device::wgpu_util::{
    bind_group, bind_group_layout, compute_pipeline, layout_entries, storage_type, uniform_type, view,
};
use crate::{Composer, GpuError, LiveHeights, Permutation};

/// Texels along each side of a workgroup, as in the shaders.
const GROUP: u32 = 8;

/// Makes heights at any moment into level 0 of a map.
pub(crate) struct HeightKernel {
    pipeline: wgpu::ComputePipeline,
    bindings: wgpu::BindGroup,
    task: wgpu::Buffer,
    /// What of the moment shaders read: octaves, or layers.
    table: wgpu::Buffer,
    program: Option<HeightProgram>,
    size: [u32; 2],
}

/// `RelievoRecipeTask` of recipe_heights.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct RecipeTaskLayout {
    size: u32,
    samples: u32,
    phase: f32,
    pad: u32,
}

/// `RelievoOctave` of noise.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct OctaveLayout {
    cells: [u32; 2],
    seeds: [u32; 2],
    offset: f32,
    weight: f32,
    mean: f32,
    shown: f32,
}

/// `RelievoLayerTask` of layer_heights.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct LayerTaskLayout {
    size: [u32; 2],
    count: u32,
    blend: u32,
}

/// `RelievoLayer` of layer_heights.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct LayerLayout {
    first: u32,
    size: [u32; 2],
    pad: u32,
    repeat: [f32; 2],
    offset: [f32; 2],
    factor: f32,
    pads: [u32; 3],
}

impl HeightKernel {
    /// Makes the kernel of these heights for a map of their size; the reason, in words, if the device cannot make them.
    pub(crate) fn new(
        device: &wgpu::Device,
        heights: &ChangingHeights,
        target: &LiveHeights,
    ) -> Result<Result<Self, String>, GpuError> {
        match heights {
            ChangingHeights::Recipe { recipe, size, .. } => match recipe.program(*size) {
                Some(program) => Self::recipe(device, program, target).map(Ok),
                None => Ok(Err("it has steps other than noise and formulas of numbers".to_owned())),
            },
            ChangingHeights::Layers { layers, .. } => Self::layers(device, layers, target),
            _ => Ok(Err("it is of a kind that is not known here".to_owned())),
        }
    }

    fn recipe(device: &wgpu::Device, program: HeightProgram, target: &LiveHeights) -> Result<Self, GpuError> {
        let recipe = format!("//! #import fractal\n{}", program.wgsl());
        let mut composer = Composer::new(&Permutation::default());
        composer.add("chosen_recipe", recipe);
        let wgsl = composer.compose("recipe_heights")?;
        let octaves: Vec<OctaveLayout> = octaves(&program, 0.0);
        let size = [program.size(); 2];
        let task = size_of::<RecipeTaskLayout>();
        let entries: &[u8] = bytemuck::cast_slice(&octaves);
        Self::assemble(device, (wgsl, "relievo_recipe_heights"), target, size, (task, entries, &[]), Some(program))
    }

    fn layers(
        device: &wgpu::Device,
        layers: &HeightLayers,
        target: &LiveHeights,
    ) -> Result<Result<Self, String>, GpuError> {
        let texels: Vec<f32> =
            layers.layers.iter().flat_map(|layer| layer.map.grid().texels().iter().copied()).collect();
        let (bytes, limits) = (texels.len() as u64 * 4, device.limits());
        if bytes > limits.max_storage_buffer_binding_size.min(limits.max_buffer_size) {
            return Ok(Err(format!("its layers take {bytes} bytes, more than this device's buffers have")));
        }
        let wgsl = Composer::new(&Permutation::default()).compose("layer_heights")?;
        let table = layer_table(layers, 0.0);
        let parts = (size_of::<LayerTaskLayout>(), bytemuck::cast_slice(&table), bytemuck::cast_slice(&texels));
        Self::assemble(device, (wgsl, "relievo_layer_heights"), target, layers.size, parts, None).map(Ok)
    }

    /// Puts a kernel together: a task of so many bytes, a table, and texels, if there are any.
    fn assemble(
        device: &wgpu::Device,
        (wgsl, entry_point): (String, &str),
        target: &LiveHeights,
        size: [u32; 2],
        (task, table, texels): (usize, &[u8], &[u8]),
        program: Option<HeightProgram>,
    ) -> Result<Self, GpuError> {
        guarded(device, || {
            let map = wgpu::BindingType::StorageTexture {
                access: wgpu::StorageTextureAccess::WriteOnly,
                format: wgpu::TextureFormat::R32Float,
                view_dimension: wgpu::TextureViewDimension::D2,
            };
            let mut types = vec![(0, uniform_type(false)), (1, storage_type(true)), (2, map)];
            if !texels.is_empty() {
                types.push((3, storage_type(true)));
            }
            let entries = layout_entries(wgpu::ShaderStages::COMPUTE, &types);
            let layout = bind_group_layout(device, "relievo changing heights", &entries);
            let buffer = |contents: &[u8], usage| {
                let usage = usage | wgpu::BufferUsages::COPY_DST;
                let descriptor =
                    wgpu::util::BufferInitDescriptor { label: Some("relievo changing heights"), contents, usage };
                device.create_buffer_init(&descriptor)
            };
            // Buffers cannot be empty: a recipe may have no noise.
            let table = if table.is_empty() { &[0; size_of::<OctaveLayout>()] } else { table };
            let (task, table) =
                (buffer(&vec![0; task], wgpu::BufferUsages::UNIFORM), buffer(table, wgpu::BufferUsages::STORAGE));
            let level = target.texture().create_view(&wgpu::TextureViewDescriptor {
                mip_level_count: Some(1),
                ..wgpu::TextureViewDescriptor::default()
            });
            let texels = (!texels.is_empty()).then(|| buffer(texels, wgpu::BufferUsages::STORAGE));
            let mut resources = vec![(0, task.as_entire_binding()), (1, table.as_entire_binding()), (2, view(&level))];
            resources.extend(texels.as_ref().map(|texels| (3, texels.as_entire_binding())));
            let bindings = bind_group(device, "relievo changing heights", &layout, resources);
            let pipeline = compute_pipeline(device, &layout, wgsl, entry_point);
            Ok(Self { pipeline, bindings, task, table, program, size })
        })
    }

    /// Records commands that make the heights of a moment; `heights` are those that the kernel was made for.
    pub(crate) fn record(&self, queue: &wgpu::Queue, encoder: &mut wgpu::CommandEncoder, heights: &ChangingHeights) {
        match (heights, &self.program) {
            (ChangingHeights::Recipe { phase, .. }, Some(program)) => {
                let (size, samples) = (program.size(), program.samples_per_side());
                let task = RecipeTaskLayout { size, samples, phase: *phase as f32, pad: 0 };
                queue.write_buffer(&self.task, 0, bytemuck::bytes_of(&task));
                queue.write_buffer(&self.table, 0, bytemuck::cast_slice(&octaves(program, *phase)));
            }
            (ChangingHeights::Layers { layers, seconds }, None) => {
                let blend = match layers.blend {
                    LayerBlend::Multiply => 1,
                    LayerBlend::Max => 2,
                    LayerBlend::Min => 3,
                    _ => 0,
                };
                let task = LayerTaskLayout { size: layers.size, count: layers.layers.len() as u32, blend };
                queue.write_buffer(&self.task, 0, bytemuck::bytes_of(&task));
                queue.write_buffer(&self.table, 0, bytemuck::cast_slice(&layer_table(layers, *seconds)));
            }
            _ => {}
        }
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some("relievo changing heights"),
            timestamp_writes: None,
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bindings, &[]);
        let [x, y] = self.size.map(|n| n.div_ceil(GROUP));
        pass.dispatch_workgroups(x, y, 1);
    }
}

fn octaves(program: &HeightProgram, phase: f64) -> Vec<OctaveLayout> {
    let layout = |OctaveEntry { cells, seeds, offset, weight, mean, shown }| OctaveLayout {
        cells,
        seeds,
        offset,
        weight,
        mean,
        shown,
    };
    program.octaves(phase).into_iter().map(layout).collect()
}

fn layer_table(layers: &HeightLayers, seconds: f64) -> Vec<LayerLayout> {
    let mut first = 0;
    let moved = layers.layers.iter().zip(layers.offsets(seconds)).zip(layers.factors());
    let table = moved.map(|((layer, offset), factor)| {
        let grid = layer.map.grid();
        let entry = LayerLayout {
            first,
            size: [grid.width(), grid.height()],
            pad: 0,
            repeat: layer.repeat.map(|n| n as f32),
            offset,
            factor,
            pads: [0; 3],
        };
        first += grid.width() * grid.height();
        entry
    });
    table.collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use relievo_make::{HeightLayer, HeightRecipe, Recipe};
    use relievo_map::{Grid, HeightMap};
    use relievo_march::{ReliefMap, TexelRect};

    use super::*;
    use crate::{AdapterChoice, Gpu, Quantization, read_texture};

    /// As `MADE_HEIGHTS` of the tests' tolerances.
    const TOLERANCE: f32 = 2e-4;

    /// `None` where there is no adapter and there need not be one.
    fn gpu() -> Option<Gpu> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
        match pollster::block_on(Gpu::open(&instance, &AdapterChoice::default())) {
            Ok(gpu) => Some(gpu),
            Err(error) => {
                assert!(std::env::var_os("RELIEVO_REQUIRE_ADAPTER").is_none(), "{error}");
                None
            }
        }
    }

    /// Heights of moments, made on the device one after the other.
    fn on_device(gpu: &Gpu, moments: &[ChangingHeights]) -> Vec<Vec<f32>> {
        let first = moments[0].heights().unwrap();
        let map = ReliefMap::of_changing(&first, false);
        let live = LiveHeights::new(&gpu.device, &gpu.queue, &map, Quantization::Range([0.0, 1.0])).unwrap();
        let kernel = HeightKernel::new(&gpu.device, &moments[0], &live).unwrap().unwrap();
        let made = moments.iter().map(|moment| {
            let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            kernel.record(&gpu.queue, &mut encoder, moment);
            let size = [first.grid().width(), first.grid().height()];
            live.update(&mut encoder, TexelRect { min: [0; 2], size }).unwrap();
            gpu.queue.submit([encoder.finish()]);
            let bytes = read_texture(&gpu.device, &gpu.queue, live.texture()).unwrap();
            bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
        });
        made.collect()
    }

    /// Largest difference between the device's heights and the CPU's over all moments, and between one moment and the next.
    fn differences(gpu: &Gpu, moments: &[ChangingHeights]) -> (f32, f32) {
        let made = on_device(gpu, moments);
        let most = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        let apart = moments.iter().zip(&made).map(|(moment, made)| {
            let expected = moment.heights().unwrap();
            assert_eq!(made.len(), expected.grid().texels().len());
            most(made, expected.grid().texels())
        });
        let moved = made.windows(2).map(|pair| most(&pair[0], &pair[1])).fold(f32::INFINITY, f32::min);
        (apart.fold(0.0, f32::max), moved)
    }

    fn recipe_moments(text: &str, size: u32) -> Vec<ChangingHeights> {
        let recipe = Arc::new(HeightRecipe::of(&Recipe::parse("test.toml", text, None).unwrap()));
        let at = |phase| ChangingHeights::Recipe { recipe: Arc::clone(&recipe), size, phase };
        [0.0, 0.13, 0.5, 0.7501, 0.999].map(at).to_vec()
    }

    const OUTPUT: &str = "[output]\nheight = \"h\"\ncolor = \"h\"\nroughness = \"h\"\n";

    #[test]
    fn every_noise_of_a_recipe_is_the_same_on_the_device() {
        let Some(gpu) = gpu() else { return };
        for basis in ["perlin", "value", "worley-f1", "worley-f2", "worley-edge"] {
            for fractal in ["fbm", "ridged", "billow"] {
                for size in [96, 512] {
                    let text = format!(
                        "[steps.a]\nop = \"noise\"\ncells = [5, 3]\ntime_cells = 2\n[steps.b]\nop = \"noise\"\n\
                         [steps.n]\nop = \"noise\"\nbasis = \"{basis}\"\nfractal = \"{fractal}\"\ncells = 6\noctaves = 5\n\
                         time_cells = 3\nwarp = [\"a\", \"b\"]\nwarp_amount = 0.02\n[steps.h]\nop = \"formula\"\n\
                         formula = \"0.4 + 0.3 * n\"\n{OUTPUT}"
                    );
                    let (apart, moved) = differences(&gpu, &recipe_moments(&text, size));
                    assert!(apart < TOLERANCE && moved > 0.03, "{basis} {fractal} {size}: {apart}, {moved}");
                }
            }
        }
    }

    #[test]
    fn every_function_of_a_formula_is_the_same_on_the_device() {
        let Some(gpu) = gpu() else { return };
        for formula in [
            "abs(x) * 0.5 + 0.2 * sign(x - 0.3)",
            "fract(floor(3 * u) * 0.3 + v * 0.5)",
            "0.5 * sqrt(u) + 0.2 * exp(0 - v)",
            "0.5 + 0.2 * sin(2 * pi * (u + phase)) + 0.2 * cos(2 * pi * (v - phase))",
            "min(u, v) + 0.3 * max(x, 0 - x)",
            "mod(3 * u, 0.7)",
            "0.5 * pow(u + 0.1, 2.2)",
            "hypot(u - 0.5, v - 0.5)",
            "0.5 + 0.1 * atan2(v - 0.52, u + 0.2)",
            "clamp(x, 0.1, 0.9) + 0.1 * (u < 0.43) - 0.1 * (v > 0.71)",
            "mix(u, v, 0.25) * step(0.21, u)",
            "smoothstep(0.2, 0.7, u) * 0.5 + 0.1 / (1 + v)",
            "smooth_min(u, v, 0.2) + smooth_max(x, u, 0.3) * 0.2",
            "-u + 1 - texel",
            "0.5 + phase * 0.1",
        ] {
            let text = format!(
                "[steps.x]\nop = \"noise\"\ncells = 4\ntime_cells = 2\n[steps.g]\nop = \"formula\"\nformula = \"{formula}\"\n\
                 [steps.h]\nop = \"formula\"\nformula = \"0.9 * g + 0.05 * x\"\n{OUTPUT}"
            );
            let (apart, _) = differences(&gpu, &recipe_moments(&text, 512));
            assert!(apart < TOLERANCE, "{formula}: {apart}");
        }
        // A recipe without noise, and one that divides by 0, make a kernel too.
        for formula in ["0.5 + 0.3 * phase * u", "0.5 / (1 - 1) * phase + u"] {
            let text = format!("[steps.h]\nop = \"formula\"\nformula = \"{formula}\"\n{OUTPUT}");
            assert!(on_device(&gpu, &recipe_moments(&text, 64)).iter().flatten().all(|h| (0.0..=1.0).contains(h)));
        }
    }

    #[test]
    fn what_no_shader_computes_says_why() {
        let Some(gpu) = gpu() else { return };
        for step in
            ["op = \"blur\"\ninput = \"x\"", "op = \"formula\"\nformula = \"luminance(#804020) * x\"", "op = \"cells\""]
        {
            let text = format!("[steps.x]\nop = \"noise\"\ntime_cells = 2\n[steps.h]\n{step}\n{OUTPUT}");
            let moments = recipe_moments(&text, 64);
            let map = ReliefMap::of_changing(&moments[0].heights().unwrap(), false);
            let live = LiveHeights::new(&gpu.device, &gpu.queue, &map, Quantization::Range([0.0, 1.0])).unwrap();
            let why = HeightKernel::new(&gpu.device, &moments[0], &live).unwrap().err().unwrap();
            assert!(why.contains("other than noise and formulas"), "{why}");
        }
    }

    #[test]
    fn layers_are_blended_as_on_the_cpu() {
        let Some(gpu) = gpu() else { return };
        let map = |width: u32, height: u32, k: u32| {
            HeightMap::new(Grid::from_fn(width, height, |x, y| ((x * 7 + y * 13 + k) % 31) as f32 / 30.0))
        };
        for (name, blend) in LayerBlend::ALL {
            let layer = |map, velocity, repeat, weight| HeightLayer { map, velocity, repeat, weight };
            let layers = vec![
                layer(map(40, 24, 0), [0.11, -0.07], [1, 1], 1.0),
                layer(map(16, 64, 5), [-0.2, 0.05], [3, 2], 0.7),
            ];
            let layers = Arc::new(HeightLayers { layers, blend, size: [72, 40] });
            let at = |seconds| ChangingHeights::Layers { layers: Arc::clone(&layers), seconds };
            let (apart, moved) = differences(&gpu, &[0.0, 0.9, 2.5, 7.77, 1000.3].map(at));
            assert!(apart < TOLERANCE && moved > 0.05, "{name}: {apart}, {moved}");
        }
    }
}
