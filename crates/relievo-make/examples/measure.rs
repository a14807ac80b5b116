//! Time and memory of one operation on maps, for `peers/maps.py`:
//! `cargo run --release -p relievo-make --example measure -- OPERATION [SIZE]`
//!
//! Prints seconds, and the most bytes that the process held beyond what it held before, input included.

use std::io::Write;
use std::time::Instant;

use relievo_make::{Basis, Fractal, FractalKind, Noise, PhotoMaps, PhotoPreset, from_photo};
use relievo_map::{
    Border, ColorEncoding, ColorMap, DerivativeKernel, Grid, HeightMap, IntegrateOptions, height_to_normal,
    normal_to_height,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let operation = arguments.next().ok_or("usage: measure OPERATION [SIZE]")?;
    let size = arguments.next().map_or(Ok(4096), |text| text.parse())?;
    let fbm = |octaves| Fractal {
        noise: Noise { basis: Basis::Perlin, columns: 4, rows: 4, seed: 1, time_cells: 0 },
        kind: FractalKind::Fbm,
        octaves,
        gain: 0.5,
    };
    // Everything that an operation reads is made before the clock starts.
    let height = || -> Result<HeightMap, Box<dyn std::error::Error>> {
        Ok(HeightMap::new(fbm(8).grid(size, size)?.map(|n| 0.5 + 0.3 * n)))
    };
    let seconds = match operation.as_str() {
        "fbm" => {
            let start = Instant::now();
            std::hint::black_box(fbm(8).grid(size, size)?);
            start.elapsed()
        }
        "height-to-normal" => {
            let height = height()?;
            let start = Instant::now();
            std::hint::black_box(height_to_normal(&height, 0.05, DerivativeKernel::Central, Border::Wrap));
            start.elapsed()
        }
        "normal-to-height" | "normal-to-height-open" => {
            let border = if operation.ends_with("open") { Border::Open } else { Border::Wrap };
            let normal = height_to_normal(&height()?, 0.05, DerivativeKernel::Central, border);
            let start = Instant::now();
            std::hint::black_box(normal_to_height(
                &normal,
                &IntegrateOptions { border, ..IntegrateOptions::default() },
            ));
            start.elapsed()
        }
        "from-photo" => {
            let grid: Grid<[f32; 4]> = height()?.grid().map(|&h| [h, 0.8 * h, 0.6 * h + 0.1, 1.0]);
            let photo = ColorMap { grid, encoding: ColorEncoding::Srgb };
            let start = Instant::now();
            let options = PhotoPreset::Brick.options();
            // Height, roughness and normals; the colour is done with, as when it was written to a file.
            let PhotoMaps { color, height, roughness } = from_photo(photo, &options)?;
            drop(color);
            std::hint::black_box((options.normal(&height), &height, roughness));
            start.elapsed()
        }
        _ => return Err(format!("there is no operation {operation}").into()),
    };
    writeln!(std::io::stdout(), "{:.3} {}", seconds.as_secs_f64(), peak_bytes().unwrap_or(0))?;
    Ok(())
}

/// The most memory this process has held, where the system tells.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<u64>().ok()? * 1024)
}
