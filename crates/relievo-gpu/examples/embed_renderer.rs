//! A wgpu program that embeds the renderer: a scene drawn into a texture of its own. Writes `embed_renderer.png`, or the
//! file that is named.
//!
//! ```sh
//! cargo run --release -p relievo-gpu --example embed_renderer -- scenes/wall.toml out.png
//! ```

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;

use relievo_gpu::{Offscreen, Renderer, RendererOptions};
use relievo_map::write_picture;
use relievo_scene::{LoadOptions, Scene};

const SIZE: [u32; 2] = [640, 480];

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let scene = args.next().unwrap_or("scenes/wall.toml".to_owned());
    let path = args.next().unwrap_or("embed_renderer.png".to_owned());

    // A device of ours, with textures as large as the adapter can have.
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let descriptor = wgpu::DeviceDescriptor {
        required_limits: wgpu::Limits::default().using_resolution(adapter.limits()),
        ..wgpu::DeviceDescriptor::default()
    };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))?;

    let scene = Scene::load(Path::new(&scene), &LoadOptions::default())?;
    let format = wgpu::TextureFormat::Rgba8UnormSrgb;
    let mut renderer = Renderer::new(&device, &queue, &scene, format, &RendererOptions::default())?;
    // In place of a window's texture: `renderer.draw(&Target::new(&view, size))` draws into any other.
    let picture = Offscreen::new(&device, &queue, SIZE, format)?;
    picture.draw(&mut renderer)?;
    write_picture(path.as_ref(), &picture.pixels()?)?;
    println!("{path}, drawn by {}", adapter.get_info().name);
    Ok(())
}
