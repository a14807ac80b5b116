//! Times the building of cone maps, beside comparing all pairs of cells: generated materials of 256², 512² and 1024²
//! texels, and the height maps whose files are named. Prints Markdown for `docs/cones.md`.
//!
//! ```sh
//! cargo run --release -p relievo-march --example cone_build -- HEIGHT.png…
//! ```
#![allow(clippy::print_stdout)]

use std::path::Path;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use relievo_map::{Grid, HeightMap, Limits, White, read_height};
use relievo_march::{ConeMap, Cones, MaxPyramid};

/// The number of runs, of which the shortest counts.
const TIMES: u32 = 3;

/// Rows of cells that all others are compared with, where all rows would take too long.
const ROWS: usize = 4;

fn shortest<T>(mut run: impl FnMut() -> T) -> (Duration, T) {
    let once = |run: &mut dyn FnMut() -> T| {
        let start = Instant::now();
        let made = run();
        (start.elapsed(), made)
    };
    let mut best = once(&mut run);
    for _ in 1..TIMES {
        let again = once(&mut run);
        if again.0 < best.0 {
            best = again;
        }
    }
    best
}

/// The steepest slopes of some rows of cells, by looking at every other cell; heights as they are.
fn brute_force(map: &Grid<f32>, rows: &[usize]) -> Vec<f32> {
    let (w, h) = (map.width() as usize, map.height() as usize);
    let texels = map.texels();
    let row = |y: usize| &texels[y % h * w..][..w];
    let highest: Vec<f32> = (0..h)
        .flat_map(|y| (0..w).map(move |x| [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)]))
        .map(|corners| corners.into_iter().map(|(x, y)| row(y)[x % w]).fold(0.0, f32::max))
        .collect();
    let gap = |a: usize, b: usize, n: usize| (a.abs_diff(b).min(n - a.abs_diff(b)) as f32 - 1.0).max(0.0);
    let slope = |x: usize, y: usize| {
        let top = highest[y * w + x];
        let mut steepest = 0.0f32;
        for (v, row) in highest.chunks(w).enumerate() {
            let gap_v = gap(y, v, h);
            for (u, &other) in row.iter().enumerate() {
                let gap_u = gap(x, u, w);
                steepest = steepest.max((other - top) / ((gap_u * gap_u + gap_v * gap_v).sqrt() + 1.0));
            }
        }
        steepest
    };
    rows.par_iter().flat_map_iter(|&y| (0..w).map(move |x| (x, y))).map(|(x, y)| slope(x, y)).collect()
}

fn report(name: &str, map: &HeightMap) {
    let grid = map.grid();
    let (pyramid_time, pyramid) = shortest(|| MaxPyramid::build(grid, map.is_8_bit()));
    let build = |cones| shortest(|| ConeMap::build(grid, &pyramid, cones));
    let ((relaxed, _), (conservative, built)) = (build(Cones::Relaxed), build(Cones::Conservative));
    let height = grid.height() as usize;
    let rows: Vec<usize> = (0..ROWS).map(|k| k * height / ROWS).collect();
    let start = Instant::now();
    let slopes = brute_force(grid, &rows);
    let all = start.elapsed().mul_f64(height as f64 / ROWS as f64);
    // The cones that are timed are right: narrower than those of brute force, and not by much.
    for (i, &slope) in slopes.iter().enumerate() {
        let (x, y) = (i % grid.width() as usize, rows[i / grid.width() as usize]);
        let found = built.slope(built.texels()[y * grid.width() as usize + x]);
        assert!(found + 3.0 * built.quantization_step() >= slope, "cell {x}, {y}: {found} for {slope}");
    }
    let ms = |time: Duration| time.as_secs_f64() * 1e3;
    println!(
        "| {name}, {}×{} | {:.1} ms | {:.0} ms | {:.0} ms | {:.1} s, ×{:.0} | {} KiB, {} KiB |",
        grid.width(),
        grid.height(),
        ms(pyramid_time),
        ms(conservative),
        ms(relaxed),
        all.as_secs_f64(),
        ms(all) / ms(conservative),
        pyramid.bytes() / 1024,
        built.bytes() / 1024,
    );
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "| | pyramid | conservative cones | relaxed cones | all pairs (from {ROWS} rows) | memory: pyramid, cones |"
    );
    println!("|---|---|---|---|---|---|");
    for name in ["brick-wall", "toy-box"] {
        for side in [256, 512, 1024] {
            let map = relievo_make::make(name, side)?.height.ok_or("it has heights")?;
            report(name, &map);
        }
    }
    for file in std::env::args().skip(1) {
        let map = read_height(Path::new(&file), White::High, &Limits::default())?.map;
        report(file.rsplit('/').nth(1).unwrap_or(&file), &map);
    }
    Ok(())
}
