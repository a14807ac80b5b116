//! Opens a window on a scene file, or on a small scene of its own. Needs a display and a GPU adapter.
//!
//! `cargo run -p relievo-viewer --example open_scene -- scenes/wall.toml`

use std::error::Error;
use std::path::Path;

use relievo_scene::{LoadOptions, Scene};
use relievo_viewer::{Options, run};

const SCENE: &str = r#"
lights = [{ kind = "directional", direction = [-0.7, -0.5, -0.5] }]
materials.wall.from = "make:brick-wall"
[[objects]]
mesh = "quad"
material = "wall"
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let options = LoadOptions::default();
    let scene = match std::env::args().nth(1) {
        Some(path) => Scene::load(Path::new(&path), &options)?,
        None => Scene::parse(SCENE, "the example", Path::new(""), &options)?,
    };
    let on_message = Box::new(|message: relievo_viewer::Message<'_>| eprintln!("{}", message.text()));
    run(scene, Options { title: "example".to_owned(), on_message, ..Options::default() })?;
    Ok(())
}
