//! A wgpu program of its own that takes only the shader functions: a relief seen at a slant, drawn by a full-screen triangle
//! whose fragment stage calls `relief_march` and `relief_shadow`. Writes `embed_march.png`, or the file that is named.
//!
//! ```sh
//! cargo run --release -p relievo-gpu --example embed_march -- out.png
//! ```

#![allow(clippy::print_stdout)]

use std::error::Error;

use relievo_gpu::{HeightTexture, Offscreen, Permutation, shader_source};
use relievo_map::write_picture;
use relievo_march::{ReliefMap, Shadow, Technique};

const SIZE: u32 = 512;

/// What is ours: bindings, entry points, and a little light. Every pixel looks at its own uv under the same slant.
const MINE: &str = "
@group(0) @binding(0) var relief_heights: texture_2d<f32>;

@vertex
fn corners(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

@fragment
fn relief(@builtin(position) at: vec4f) -> @location(0) vec4f {
    // 8 to 32 layers, 5 bisections, all of the relief below the surface, no bounds.
    let how = March(8.0, 32.0, 5u, 1.0, vec4f(0.0), 0u, 0u, CONES_RELAXED);
    let field = height_field(0.0, 0);
    // The sweep is -depth * V.xy (v runs down), the cosine V.z, for a depth of 0.08 repeats.
    let view = normalize(vec3f(0.0, -0.8, 0.6));
    let light = normalize(vec3f(-0.6, 0.3, 0.5));
    let record = relief_march(field, Ray(at.xy / 512.0, vec2f(-view.x, view.y) * 0.08, view.z), how);
    let towards = Ray(record.uv, vec2f(-light.x, light.y) * 0.08, light.z);
    let shadow = relief_shadow(field, towards, record.depth, how).factor;
    let stone = vec3f(0.75, 0.45, 0.35) * (1.0 - 0.6 * record.depth);
    return vec4f(stone * (0.3 + 0.7 * shadow), 1.0);
}
";

fn main() -> Result<(), Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;

    let map = relievo_make::brick_wall(512)?.height.ok_or("the wall has heights")?;
    let heights = HeightTexture::new(&device, &queue, &ReliefMap::new(&map))?;
    let choices = Permutation { technique: Technique::Relief, shadow: Shadow::Soft, ..Permutation::default() };
    let wgsl = format!("{MINE}\n{}", shader_source(&choices)?);

    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(wgsl.into()),
    });
    let format = wgpu::TextureFormat::Rgba8UnormSrgb;
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &shader,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: None,
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &shader,
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(format.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(heights.view()) }],
    });
    let picture = Offscreen::new(&device, &queue, [SIZE; 2], format)?;
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: picture.view(),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            ..wgpu::RenderPassDescriptor::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        pass.draw(0..3, 0..1);
    }
    queue.submit([encoder.finish()]);
    let path = std::env::args().nth(1).unwrap_or("embed_march.png".to_owned());
    write_picture(path.as_ref(), &picture.pixels()?)?;
    println!("{path}, drawn by {}", adapter.get_info().name);
    Ok(())
}
