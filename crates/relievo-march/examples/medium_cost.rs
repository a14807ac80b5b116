//! Cost of the optical depth through mist: height look-ups with and without the max pyramid, and how many of the cells below the
//! surface lie in blocks that are full, which a min pyramid could take at once.
//!
//! `cargo run --release -p relievo-march --example medium_cost`

// An example reports on the terminal.
#![allow(clippy::print_stdout)]

use std::time::Instant;

use relievo_map::{HeightMap, Wrap};
use relievo_march::{HeightField, Medium, MediumRay, OpticalDepth, ReliefMap, WithoutPyramid, optical_depth};

const SIZE: u32 = 512;
const RAYS: u32 = 20_000;

/// Full depth in texels, as in `scenes/clouds.toml`.
const DEPTH: f32 = 80.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!(
        "per ray: look-ups through the pyramid / cell by cell, microseconds; cells in the mist, of which in full 4×4 blocks"
    );
    for (name, softness) in [("cloud-tops", 0.06), ("fog-bank", 0.2)] {
        let map: HeightMap = relievo_make::make(name, SIZE)?.height.ok_or("the recipe has heights")?;
        let heights = ReliefMap::new(&map);
        let field = heights.field(0.0, Wrap::Repeat);
        for (what, degrees, per_depth, from_inside) in [
            ("view, dense", 20.0f32, 12.0, false),
            ("view, thin", 20.0, 0.5, false),
            ("to the light, dense", 12.0, 12.0, true),
            ("to the light, thin", 12.0, 0.5, true),
        ] {
            let medium = Medium { density: per_depth, softness };
            let rays: Vec<MediumRay> = (0..RAYS).map(|i| ray(&field, i, degrees, from_inside)).collect();
            let end = 1.0 / degrees.to_radians().sin();
            let (with, time) = cost(&rays, |ray| optical_depth(&field, ray, [0.0, end], &medium));
            let (without, _) = cost(&rays, |ray| optical_depth(&WithoutPyramid(field), ray, [0.0, end], &medium));
            let (inside, full) = cells(&field, &rays[..2000], end, &medium);
            println!(
                "{name:11} {what:20} {with:6.1} / {without:6.1}, {time:5.2} µs; {inside:6.1} cells, {:4.0} % in full blocks",
                100.0 * full / inside
            );
        }
    }
    Ok(())
}

/// A ray at this angle above the horizon: down from the lid, or up from a third of the depth below the surface.
fn ray(field: &impl HeightField, i: u32, degrees: f32, from_inside: bool) -> MediumRay {
    let fraction = |k: f64| (0.5 + f64::from(i) * k).fract() as f32;
    let uv = [fraction(0.754_877_666), fraction(0.569_840_291)];
    let (sin, cos) = degrees.to_radians().sin_cos();
    let along = cos * DEPTH / SIZE as f32;
    let (height, height_delta) = if from_inside { (field.sample(uv) * 0.67, sin) } else { (1.0, -sin) };
    MediumRay { uv, uv_delta: [along * 0.8, along * 0.6], height, height_delta }
}

/// Returns the mean look-ups of a ray, and its mean time in microseconds.
fn cost(rays: &[MediumRay], march: impl Fn(&MediumRay) -> OpticalDepth) -> (f64, f64) {
    let start = Instant::now();
    let fetches: u64 = rays.iter().map(|ray| u64::from(march(ray).fetches)).sum();
    let n = rays.len() as f64;
    (fetches as f64 / n, start.elapsed().as_secs_f64() * 1e6 / n)
}

/// Counts the cells below the surface until nothing is left of the light, and those of them in full blocks of 4×4, per ray.
fn cells(field: &impl HeightField, rays: &[MediumRay], end: f32, medium: &Medium) -> (f64, f64) {
    let (mut inside, mut full) = (0u64, 0u64);
    for ray in rays {
        let step = 0.25 / (ray.uv_delta[0].hypot(ray.uv_delta[1]) * SIZE as f32);
        let (mut value, mut before, mut s) = (0.0, None, 0.0);
        while s < end && value < 16.0 {
            let at = [0, 1].map(|k| ray.uv[k] + ray.uv_delta[k] * s);
            let height = ray.height + ray.height_delta * s;
            let depth = field.sample(at) - height;
            let cell = at.map(|x| (x * SIZE as f32 - 0.5).floor() as i32);
            if depth > 0.0 && before.replace(cell) != Some(cell) {
                inside += 1;
                let block = cell.map(|i| i & !3);
                let lowest = (0..16)
                    .flat_map(|k| field.corners(block[0] + k % 4, block[1] + k / 4))
                    .fold(f32::INFINITY, f32::min);
                // The ray's highest point over the block, at most.
                let highest = height + ray.height_delta.abs() * step * 24.0;
                full += u64::from(lowest - medium.softness >= highest);
            }
            value += medium.density * (depth / medium.softness).clamp(0.0, 1.0) * step;
            s += step;
        }
    }
    (inside as f64 / rays.len() as f64, full as f64 / rays.len() as f64)
}
