//! How long the compute kernels take for 512² coherent rays: `occlusion`, the exact walk over every cell, and `exact`.
//! Arguments: names of generated materials or height map files of any size; without, the generated ones.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use relievo_gpu::{ComputeField, ComputeMarch, HeightTexture};
use relievo_map::{HeightMap, Limits, White, Wrap, read_height};
use relievo_march::{MarchOptions, Ray, ReliefMap, Technique};

const SIDE: u32 = 512;
/// The full depth, in texels.
const DEPTH: f32 = 25.0;

/// Rays in tiles of 8×8, as a picture's are drawn, `degrees` from the normal.
fn rays(degrees: f32, texels: u32) -> Vec<Ray> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let view = [sin * 0.8, sin * 0.6, cos];
    let scale = DEPTH / texels as f32;
    (0..SIDE * SIDE)
        .map(|i| {
            let (tile, k) = (i / 64, i % 64);
            let at = |tile: u32, k: u32| ((tile * 8 + k) as f32 + 0.5) / SIDE as f32;
            Ray::from_view([at(tile % (SIDE / 8), k % 8), at(tile / (SIDE / 8), k / 8)], view, [scale, -scale])
        })
        .collect()
}

fn load(name: &str) -> Result<HeightMap, Box<dyn Error>> {
    if relievo_make::names().contains(&name) {
        return relievo_make::make(name, SIDE)?.height.ok_or_else(|| format!("{name} has no heights").into());
    }
    Ok(read_height(Path::new(name), White::High, &Limits::default())?.map)
}

fn main() -> Result<(), Box<dyn Error>> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let limits = wgpu::Limits::default().using_resolution(adapter.limits());
    let wanted = wgpu::DeviceDescriptor { required_limits: limits, ..wgpu::DeviceDescriptor::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&wanted))?;
    println!("{}", adapter.get_info().name);

    let mut names: Vec<String> = std::env::args().skip(1).collect();
    if names.is_empty() {
        names = relievo_make::names().iter().map(|&name| name.to_owned()).collect();
    }
    for name in names {
        let map = load(&name)?;
        let texture = HeightTexture::new(&device, &queue, &ReliefMap::new(&map))?;
        let field = ComputeField { heights: &texture, lod: 0.0, wrap: Wrap::Repeat };
        for degrees in [0.0, 60.0, 80.0, 88.5] {
            let rays = rays(degrees, map.grid().width());
            print!("{name} {degrees}°:");
            let exact = Technique::Exact;
            for (what, technique) in [("occlusion", Technique::Occlusion), ("cell by cell", exact), ("exact", exact)] {
                let mut kernels = ComputeMarch::new(&device, &queue)?;
                if what == "cell by cell" {
                    kernels = kernels.without_pyramid();
                }
                let options = MarchOptions { technique, ..MarchOptions::default() };
                kernels.march(field, &rays, &options)?;
                let mut best = f64::INFINITY;
                for _ in 0..7 {
                    let start = Instant::now();
                    kernels.march(field, &rays, &options)?;
                    best = best.min(start.elapsed().as_secs_f64() * 1e3);
                }
                print!("  {what} {best:.1} ms");
            }
            println!();
        }
    }
    Ok(())
}
