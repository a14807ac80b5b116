//! A wgpu program of its own that takes only the shader functions: a relief seen at a slant, drawn by a full-screen triangle
//! whose fragment stage calls `relievo_march` and `relievo_shadow`. Writes `embed_march.png`, or the file that is named.
//!
//! ```sh
//! cargo run --release -p relievo-gpu --example embed_march -- out.png
//! ```

#![allow(clippy::print_stdout)]

use std::error::Error;

use relievo_gpu::{AdapterChoice, Gpu, HeightTexture, Offscreen, Permutation, shader_source};
use relievo_map::write_picture;
use relievo_march::{Cones, ReliefMap, Shadow, Technique};

/// Entry points of ours. Every pixel looks at its own uv under the same slant; v runs down the picture.
const MINE: &str = "
@vertex
fn corners(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

fn ray_along(uv: vec2f, direction: vec3f) -> RelievoRay {
    return relievo_ray_from_axes(
        uv, normalize(direction), vec3f(1.0, 0.0, 0.0), vec3f(0.0, -1.0, 0.0), vec3f(0.0, 0.0, 1.0), 0.08);
}

@fragment
fn relief(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let options = relievo_default_options();
    let field = relievo_height_field(0.0, 0);
    let record = relievo_march(field, ray_along(at.xy / 512.0, vec3f(0.0, -0.8, 0.6)), options);
    let shadow = relievo_shadow(field, ray_along(record.uv, vec3f(-0.6, 0.3, 0.5)), record.depth, options).factor;
    return vec4f(vec3f(0.75, 0.45, 0.35) * (1.0 - 0.6 * record.depth) * (0.3 + 0.7 * shadow), 1.0);
}
";

fn main() -> Result<(), Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let Gpu { device, queue, adapter } = pollster::block_on(Gpu::open(&instance, &AdapterChoice::default()))?;

    let map = relievo_make::brick_wall(512)?.height.ok_or("the wall has heights")?;
    let heights = HeightTexture::new(&device, &queue, &ReliefMap::new(&map))?;
    let relief = Permutation { technique: Technique::Relief, shadow: Shadow::Soft, ..Permutation::default() };
    let wgsl = [relief.texture_declarations(0, 0), shader_source(&relief)?, MINE.to_owned()].concat();

    let source = wgpu::ShaderSource::Wgsl(wgsl.into());
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let format = wgpu::TextureFormat::Rgba8UnormSrgb;
    let (module, entry_point, targets) = (&shader, None, &[Some(format.into())]);
    let stage = wgpu::PipelineCompilationOptions::default;
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState { module, entry_point, compilation_options: stage(), buffers: &[] },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState { module, entry_point, compilation_options: stage(), targets }),
        multiview_mask: None,
        cache: None,
    });
    let layout = &pipeline.get_bind_group_layout(0);
    let entries = &heights.bind_group_entries(&relief, 0, Cones::default());
    let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries });
    let picture = Offscreen::new(&device, &queue, [512; 2], format)?;
    picture.render_pass(|pass| {
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        pass.draw(0..3, 0..1);
    })?;
    let path = std::env::args().nth(1).unwrap_or("embed_march.png".to_owned());
    write_picture(path.as_ref(), &picture.pixels()?)?;
    println!("{path}, drawn by {}", adapter.get_info().name);
    Ok(())
}
