//! Compares three techniques with displaced geometry and the f64 oracle on the built-in wall.
//!
//! ```sh
//! cargo run --release -p relievo --features lab --example judge_techniques
//! ```

#![allow(clippy::print_stdout)]

use std::error::Error;

use relievo::lab::{CompareOptions, compare};
use relievo::scene::{LoadOptions, Scene};

fn main() -> Result<(), Box<dyn Error>> {
    let wall = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/wall.toml");
    let mut scene = Scene::load(wall.as_ref(), &LoadOptions { make_size: 128, ..LoadOptions::default() })?;
    (scene.image.width, scene.image.height) = (200, 150);
    let techniques = vec!["occlusion".parse()?, "relief".parse()?, "exact".parse()?];
    let comparison = compare(&scene, &CompareOptions { techniques, ..CompareOptions::default() })?;
    for entry in &comparison.entries {
        println!(
            "{:12} FLIP {:.4}, {:4.1} % of hits off by over a texel, {:.1} fetches",
            entry.technique.to_string(),
            entry.flip.mean,
            100.0 * entry.hits.wrong,
            entry.fetches.mean
        );
    }
    Ok(())
}
