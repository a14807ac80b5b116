//! What an embedder takes: two reliefs in one shader of his own, bindings, settings, and rays from axes.

use relievo_gpu::{
    HeightTexture, MarchUniforms, Permutation, shader_source, shader_source_named, texture_layout_entries,
};
use relievo_map::{Grid, HeightMap, Wrap};
use relievo_march::{Cones, MarchOptions, Ray, Record, ReliefMap, Technique, march};
use wgpu::util::DeviceExt;

use crate::common::device::{Gpu, gpu};
use crate::common::tolerances::{DEPTH, UV_TEXELS};

const SIDE: u32 = 64;
const COUNT: u32 = 256;
const DEPTH_OF_RELIEF: f32 = 0.1;

/// Marches the same rays through both reliefs: the first with settings from a buffer, the second with the defaults. The quad is
/// 2×2 scene units large, u along x and v down y, seen under a slant that turns with the ray.
const MINE: &str = "
@group(0) @binding(0) var<uniform> settings: RelievoMarchOptions;
@group(0) @binding(1) var<storage, read_write> found: array<vec4f>;

fn to_eye(i: u32) -> vec3f {
    let angle = f32(i) * 0.37;
    return normalize(vec3f(cos(angle), sin(angle), 0.8));
}

@compute @workgroup_size(64)
fn both(@builtin(global_invocation_id) id: vec3u) {
    let uv = vec2f(f32(id.x % 16u) + 0.5, f32(id.x / 16u) + 0.5) / 16.0;
    let du = vec3f(2.0, 0.0, 0.0);
    let dv = vec3f(0.0, -2.0, 0.0);
    let ray = relievo_ray_from_axes(uv, to_eye(id.x), du, dv, vec3f(0.0, 0.0, 1.0), 0.2);
    let first = relievo_march(relievo_height_field(0.0, 0), ray, settings);
    found[3u * id.x] = vec4f(first.uv, first.depth, select(0.0, 1.0, first.hit));
    let other = wall_ray_from_axes(uv, to_eye(id.x), du, dv, vec3f(0.0, 0.0, 1.0), 0.2);
    let second = wall_march(wall_height_field(0.0, 0), other, wall_default_options());
    found[3u * id.x + 1u] = vec4f(second.uv, second.depth, select(0.0, 1.0, second.hit));
    found[3u * id.x + 2u] = vec4f(ray.uv_delta, ray.cos, 0.0);
}
";

fn rays() -> Vec<Ray> {
    let ray = |i: u32| {
        let angle = i as f32 * 0.37;
        let (x, y, z) = (angle.cos(), angle.sin(), 0.8f32);
        let length = (x * x + y * y + z * z).sqrt();
        let uv = [(i % 16) as f32 + 0.5, (i / 16) as f32 + 0.5].map(|x| x / 16.0);
        // v runs down: the scale along it is negative.
        Ray::from_view(uv, [x / length, y / length, z / length], [DEPTH_OF_RELIEF, -DEPTH_OF_RELIEF])
    };
    (0..COUNT).map(ray).collect()
}

fn heights(f: impl Fn(f32, f32) -> f32) -> ReliefMap {
    let at = |i: u32| (i as f32 + 0.5) / SIDE as f32 * std::f32::consts::TAU;
    ReliefMap::new(&HeightMap::new(Grid::from_fn(SIDE, SIDE, |x, y| f(at(x), at(y)).clamp(0.0, 1.0))))
}

/// Runs the shader; three vectors for each ray.
fn run(gpu: &Gpu, floor: (&Permutation, &ReliefMap), wall: (&Permutation, &ReliefMap)) -> Vec<[f32; 4]> {
    let (device, queue) = (&gpu.device, &gpu.queue);
    let second = 2 + floor.0.textures().len() as u32;
    let wgsl = [
        MINE.to_owned(),
        floor.0.texture_declarations(0, 2),
        shader_source(floor.0).unwrap(),
        shader_source_named(wall.0, "wall", 0, second).unwrap(),
    ]
    .concat();
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(wgsl.into()),
    });
    let buffer = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    };
    let storage = wgpu::BufferBindingType::Storage { read_only: false };
    let mut entries = vec![buffer(0, wgpu::BufferBindingType::Uniform), buffer(1, storage)];
    entries.extend(texture_layout_entries(floor.0, 2, wgpu::ShaderStages::COMPUTE));
    entries.extend(texture_layout_entries(wall.0, second, wgpu::ShaderStages::COMPUTE));
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&layout)],
        immediate_size: 0,
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&pipeline_layout),
        module: &shader,
        entry_point: Some("both"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let settings = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: &MarchUniforms::default().to_bytes(),
        usage: wgpu::BufferUsages::UNIFORM,
    });
    let made = |usage| {
        let size = u64::from(COUNT) * 3 * 16;
        device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
    };
    let found = made(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
    let staging = made(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let textures = [floor.1, wall.1].map(|heights| HeightTexture::new(device, queue, heights).unwrap());
    let mut entries = vec![
        wgpu::BindGroupEntry { binding: 0, resource: settings.as_entire_binding() },
        wgpu::BindGroupEntry { binding: 1, resource: found.as_entire_binding() },
    ];
    entries.extend(textures[0].bind_group_entries(floor.0, 2, Cones::default()));
    entries.extend(textures[1].bind_group_entries(wall.0, second, Cones::default()));
    let group =
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(COUNT / 64, 1, 1);
    }
    encoder.copy_buffer_to_buffer(&found, 0, &staging, 0, None);
    queue.submit([encoder.finish()]);
    staging.map_async(wgpu::MapMode::Read, .., |result| result.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = staging.get_mapped_range(..).unwrap();
    let word = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    bytes.chunks_exact(16).map(|v| [0, 4, 8, 12].map(|k| word(&v[k..]))).collect()
}

/// The fraction of rays that found something else than the CPU.
fn differing(heights: &ReliefMap, technique: Technique, found: &[[f32; 4]]) -> f64 {
    let options = MarchOptions { technique, ..MarchOptions::default() };
    let field = heights.field(0.0, Wrap::Repeat);
    let same = |record: &Record, found: &[f32; 4]| {
        let uv = (0..2).all(|k| (record.uv[k] - found[k]).abs() * SIDE as f32 <= UV_TEXELS);
        record.hit == (found[3] > 0.5) && uv && (record.depth - found[2]).abs() <= DEPTH
    };
    let records = rays().into_iter().map(|ray| march(&field, &ray, &options));
    let different = records.zip(found).filter(|(record, found)| !same(record, found)).count();
    different as f64 / f64::from(COUNT)
}

#[test]
fn two_reliefs_of_different_techniques_march_in_one_shader() {
    let Some(gpu) = gpu() else { return };
    let floor = heights(|x, y| 0.5 + 0.25 * (3.0 * x).sin() + 0.25 * (2.0 * y).cos());
    let wall = heights(|x, y| 0.5 + 0.5 * (2.0 * x + y).sin());
    for (first, second) in [
        (Technique::Exact, Technique::Relief),
        (Technique::Occlusion, Technique::Exact),
        (Technique::Cone, Technique::Steep),
    ] {
        let of = |technique| Permutation { technique, ..Permutation::default() };
        // Without cones built, `cone` walks cell by cell.
        let floor = if first == Technique::Cone { floor.clone().with_cones(Cones::default()) } else { floor.clone() };
        let found = run(gpu, (&of(first), &floor), (&of(second), &wall));
        let of_floor: Vec<_> = found.iter().copied().step_by(3).collect();
        let of_wall: Vec<_> = found.iter().copied().skip(1).step_by(3).collect();
        assert!(differing(&floor, first, &of_floor) <= 0.02, "{first:?} beside {second:?}");
        assert!(differing(&wall, second, &of_wall) <= 0.02, "{second:?} beside {first:?}");
        // They are not the same relief.
        assert!(differing(&floor, first, &of_wall) > 0.5);
    }
}

#[test]
fn rays_from_axes_are_those_from_a_view_on_a_square() {
    let Some(gpu) = gpu() else { return };
    let flat = heights(|_, _| 0.5);
    let permutation = Permutation { technique: Technique::None, ..Permutation::default() };
    let found = run(gpu, (&permutation, &flat), (&permutation, &flat));
    for (i, (ray, found)) in rays().iter().zip(found.iter().skip(2).step_by(3)).enumerate() {
        let expected = [ray.uv_delta[0], ray.uv_delta[1], ray.cos];
        assert!((0..3).all(|k| (expected[k] - found[k]).abs() < 1e-5), "ray {i}: {expected:?}, got {found:?}");
    }
}
