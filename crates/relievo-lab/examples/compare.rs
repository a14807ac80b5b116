//! Comparison of two techniques on the built-in wall.
//!
//! ```sh
//! cargo run --release -p relievo-lab --example compare
//! ```

#![allow(clippy::print_stdout)]

use relievo_lab::{CompareOptions, compare};
use relievo_scene::{LoadOptions, Scene};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/wall.toml");
    let mut scene = Scene::load(path.as_ref(), &LoadOptions { make_size: 128, ..LoadOptions::default() })?;
    (scene.image.width, scene.image.height) = (200, 150);

    let techniques = vec!["tutorials".parse()?, "exact".parse()?];
    let comparison = compare(&scene, &CompareOptions { techniques, ..CompareOptions::default() })?;
    println!("technique          FLIP     PSNR   wrong  p99 texels  fetches");
    for entry in &comparison.entries {
        println!(
            "{:16} {:6.4} {:5.1} dB {:5.1} % {:11.2} {:8.1}",
            entry.technique.to_string(),
            entry.flip.mean,
            entry.psnr,
            entry.hits.wrong * 100.0,
            entry.hits.texels.p99,
            entry.fetches.mean
        );
    }
    Ok(())
}
