//! Draws a scene file on the CPU and writes the picture.
//!
//! ```sh
//! cargo run --release -p relievo --features cpu --example draw_scene -- scenes/wall.toml wall.png
//! ```

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::PathBuf;

use relievo::cpu::{RenderOptions, Renderer};
use relievo::map::write_picture;
use relievo::scene::{LoadOptions, Scene};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1).map(PathBuf::from);
    let scene = arguments.next().unwrap_or("scenes/wall.toml".into());
    let out = arguments.next().unwrap_or("wall.png".into());
    let scene = Scene::load(&scene, &LoadOptions::default())?;
    let frame = Renderer::new(&scene)?.render(&RenderOptions::default())?;
    write_picture(&out, &frame.pixels)?;
    println!("{}", out.display());
    Ok(())
}
