//! Draws a scene to a PNG: `cargo run -p relievo-cpu --example draw_scene -- [SCENE.toml] [PICTURE.png]`.
//!
//! Without a scene file it draws a generated brick wall.

// An example reports what it did.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;

use relievo_cpu::{RenderOptions, Renderer};
use relievo_scene::{LoadOptions, Scene};

const WALL: &str = r#"
    [image]
    width = 400
    height = 300
    [camera]
    position = [1.2, -0.6, 1.8]
    [[lights]]
    kind = "point"
    position = [-1.5, 1.5, 2.0]
    [materials.wall]
    from = "make:brick-wall"
    relief = { technique = "exact", shadow = "exact" }
    [[objects]]
    mesh = "quad"
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let options = LoadOptions { make_size: 512, ..LoadOptions::default() };
    let scene = match arguments.next() {
        Some(path) => Scene::load(Path::new(&path), &options)?,
        None => Scene::parse(WALL, "the built-in wall", Path::new("."), &options)?,
    };
    let picture = arguments.next().unwrap_or_else(|| "picture.png".to_owned());

    let frame = Renderer::new(&scene)?.render(&RenderOptions::default())?;
    relievo_map::write_png8(Path::new(&picture), &frame.pixels.map(|rgb| rgb.map(|x| f32::from(x) / 255.0)))?;

    let pixels = frame.aovs.fetches.texels();
    let mean = pixels.iter().sum::<f32>() / pixels.len() as f32;
    println!("{picture}: {mean:.1} height fetches per pixel");
    Ok(())
}
