//! Reads a height map and writes its normal map: `cargo run -p relievo-map --example height_to_normal -- HEIGHT
//! NORMAL`.
//!
//! Without arguments the heights are round bumps, made here, and `normal.png` goes to the folder for temporary files.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::f32::consts::PI;
use std::path::PathBuf;

use relievo_map::{
    BitDepth, Border, DerivativeKernel, Grid, HeightMap, Limits, NormalY, White, height_to_normal, read_height,
    write_normal,
};

fn main() -> Result<(), Box<dyn Error>> {
    let mut paths = std::env::args_os().skip(1).map(PathBuf::from);
    let heights = match paths.next() {
        Some(path) => {
            let loaded = read_height(&path, White::High, &Limits::default())?;
            for note in &loaded.notes {
                println!("{note}");
            }
            loaded.map
        }
        None => bumps(256),
    };
    let output = paths.next().unwrap_or_else(|| std::env::temp_dir().join("normal.png"));

    // The full range of heights is a twentieth of the map's width; the map tiles.
    let normals = height_to_normal(&heights, 0.05, DerivativeKernel::Scharr, Border::Wrap);
    write_normal(&output, &normals, NormalY::Up, BitDepth::Eight)?;

    let grid = normals.grid();
    let steepest = grid.texels().iter().map(|n| n[2]).fold(1.0, f32::min);
    println!(
        "{}: {}×{} normals, +Y up; the steepest leans by {:.1}°",
        output.display(),
        grid.width(),
        grid.height(),
        steepest.acos().to_degrees()
    );
    Ok(())
}

/// Four by four bumps that tile.
fn bumps(side: u32) -> HeightMap {
    let wave = |i: u32| (4.0 * PI * (i as f32 + 0.5) / side as f32).sin().powi(2);
    HeightMap::new(Grid::from_fn(side, side, |x, y| wave(x) * wave(y)))
}
