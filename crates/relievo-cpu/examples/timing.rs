//! How long the built-in wall takes: `cargo run --release -p relievo-cpu --example timing`.

// An example reports its figures.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use relievo_cpu::{RenderOptions, Renderer};
use relievo_scene::{LoadOptions, Scene};

const SCENE: &str = r#"
[image]
width = 800
height = 600
[camera]
position = [1.2, -0.5, 1.5]
vertical_fov = 35
[[lights]]
kind = "point"
position = [0.8, 1.0, 1.0]
[materials.wall]
from = "make:brick-wall"
[materials.wall.relief]
technique = "exact"
[[objects]]
mesh = "quad"
scale = 2
uv_repeat = 2
"#;

fn main() -> Result<(), Box<dyn Error>> {
    for changes in [
        &["materials.wall.relief.technique=none"][..],
        &["materials.wall.relief.technique=occlusion"],
        &[],
        &["materials.wall.relief.shadow=exact"],
        &["materials.wall.relief.shadow=exact", "lights.0.radius=0.1"],
        &["materials.wall.relief.shadow=exact", "objects.0.mesh=torus"],
        &[
            "materials.wall.relief.technique=displacement",
            "materials.wall.relief.shadow=exact",
            "materials.wall.relief.grid=1000",
        ],
    ] {
        let overrides = changes.iter().map(|text| text.parse()).collect::<Result<_, _>>()?;
        let options = LoadOptions { overrides, ..LoadOptions::default() };
        let scene = Scene::parse(SCENE, "timing", Path::new(""), &options)?;
        let start = Instant::now();
        let renderer = Renderer::new(&scene)?;
        let build = start.elapsed();
        let mut times = Vec::new();
        for _ in 0..5 {
            let start = Instant::now();
            renderer.render(&RenderOptions::default())?;
            times.push(start.elapsed());
        }
        times.sort();
        println!("{changes:?}: ready in {build:.0?}, drawn in {:.1?} ({:.1?} at best)", times[2], times[0]);
    }
    Ok(())
}
