//! The loads of the exact march per ray, beside cone stepping and parallax occlusion mapping: generated materials, and the
//! height maps whose files are named.
#![allow(clippy::print_stdout)]

use std::path::Path;

use relievo_map::{HeightMap, Limits, White, Wrap, read_height};
use relievo_march::{
    Cones, MarchOptions, OracleRay, Ray, ReliefMap, Shadow, Technique, march, march_from, oracle, shadow, tile_entry,
};

/// The full depth, in texels.
const DEPTH: f32 = 25.0;
const TILES: usize = 2000;
const TILE: [u32; 2] = [8, 4];

/// Fractions that fill the unit square evenly (Roberts 2018).
fn even(i: usize, k: usize) -> f32 {
    (0.5 + i as f64 * [0.754_877_666_2, 0.569_840_291_0, 0.819_172_513_4][k]).fract() as f32
}

/// Tiles of 8×4 parallel rays a texel apart, from all sides.
fn tiles(size: [u32; 2], degrees: f32) -> Vec<Vec<Ray>> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let scale = DEPTH / size[0] as f32;
    (0..TILES)
        .map(|i| {
            let azimuth = even(i, 2) * std::f32::consts::TAU;
            let view = [sin * azimuth.cos(), sin * azimuth.sin(), cos];
            (0..TILE[0] * TILE[1])
                .map(|k| {
                    let uv = [
                        even(i, 0) + (k % TILE[0]) as f32 / size[0] as f32,
                        even(i, 1) + (k / TILE[0]) as f32 / size[1] as f32,
                    ];
                    Ray::from_view(uv, view, [scale, -scale * size[0] as f32 / size[1] as f32])
                })
                .collect()
        })
        .collect()
}

fn report(name: &str, map: &HeightMap) {
    let heights = ReliefMap::new(map).with_cones(Cones::Relaxed).with_cones(Cones::Conservative);
    let field = heights.field(0.0, Wrap::Repeat);
    let options = MarchOptions::default();
    for degrees in [0.0, 60.0, 82.0, 88.5] {
        let (mut fetches, mut iterations, mut worst, mut ideal, mut rays) = (0u64, 0u64, 0, 0u64, 0u64);
        let (mut shadows, mut lit) = (0u64, 0);
        let (mut before, mut after) = (0u64, 0u64);
        for tile in tiles(heights.size(), degrees) {
            let records: Vec<_> = tile.iter().map(|ray| march(&field, ray, &options)).collect();
            let nearest = records.iter().fold(1.0f32, |nearest, record| nearest.min(record.depth));
            let entry = tile_entry(&field, &tile, &options);
            assert!(entry.depth <= nearest + 1e-6, "{entry:?} for {nearest}");
            before += u64::from(entry.fetches);
            for (ray, record) in tile.iter().zip(&records) {
                let again = march_from(&field, ray, &options, entry.depth);
                assert!((again.depth - record.depth).abs() < 1e-5, "{again:?} for {record:?}");
                after += u64::from(again.fetches);
                rays += 1;
                fetches += u64::from(record.fetches);
                iterations += u64::from(record.iterations);
                worst = worst.max(record.fetches);
                // Towards a light as low as the eye, at a right angle to it.
                let light = Ray { uv: record.uv, uv_delta: [-ray.uv_delta[1], ray.uv_delta[0]], cos: ray.cos };
                let shadow = shadow(&field, Shadow::Exact, &light, record.depth, &options);
                shadows += u64::from(shadow.fetches);
                lit += u32::from(shadow.factor > 0.0);
                ideal += u64::from(march_from(&field, ray, &options, nearest).fetches);
            }
        }
        let mean = |sum: u64| sum as f64 / rays as f64;
        let lit = f64::from(lit) / rays as f64 * 100.0;
        println!(
            "{name:24} {degrees:5}°  {:6.2} fetches {:6.2} turns, most {worst:4}; pre-pass {:.2} + {:.2}, ideal {:.2}; shadow {:6.2}, {lit:.0} % lit",
            mean(fetches),
            mean(iterations),
            mean(before),
            mean(after),
            mean(ideal),
            mean(shadows)
        );
        report_others(&heights, degrees);
    }
}

/// Prints fetches, and the share of hits that are wrong by over a texel, by the oracle.
fn report_others(heights: &ReliefMap, degrees: f32) {
    let field = heights.field(0.0, Wrap::Repeat);
    let size = heights.size().map(f64::from);
    let cone = MarchOptions { technique: Technique::Cone, refine_steps: 8, ..MarchOptions::default() };
    let settings = [
        ("occlusion 8..32", MarchOptions { technique: Technique::Occlusion, ..MarchOptions::default() }),
        ("relaxed, 32 + 8", cone),
        ("relaxed, 16 + 8", MarchOptions { max_layers: 16.0, ..cone }),
        ("relaxed, 128 + 8", MarchOptions { max_layers: 128.0, ..cone }),
        ("conservative", MarchOptions { cones: Cones::Conservative, ..cone }),
    ];
    let rays: Vec<Ray> = tiles(heights.size(), degrees).into_iter().flatten().collect();
    let truths: Vec<_> = rays.iter().map(|ray| oracle(&field, &OracleRay::from(ray), None)).collect();
    for (name, options) in settings {
        let (mut fetches, mut iterations, mut worst, mut wrong) = (0u64, 0u64, 0, 0);
        for (ray, truth) in rays.iter().zip(&truths) {
            let record = march(&field, ray, &options);
            fetches += u64::from(record.fetches);
            iterations += u64::from(record.iterations);
            worst = worst.max(record.fetches);
            let texels = |uv: [f64; 2], k: usize| (f64::from(record.uv[k]) - uv[k]).abs() * size[k];
            wrong += u32::from(!truth.is_some_and(|truth| (0..2).all(|k| texels(truth.uv, k) <= 1.0)));
        }
        let mean = |sum: u64| sum as f64 / rays.len() as f64;
        println!(
            "{:24} {degrees:5}°  {:6.2} fetches {:6.2} turns, most {worst:4}; {:.2} % wrong by over a texel",
            format!("  {name}"),
            mean(fetches),
            mean(iterations),
            f64::from(wrong) / rays.len() as f64 * 100.0
        );
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let files: Vec<String> = std::env::args().skip(1).collect();
    for file in &files {
        let mut map = read_height(Path::new(file), White::High, &Limits::default())?.map;
        if map.grid().width() == 1024 && map.grid().height() == 1024 {
            map = HeightMap::new(map.grid().halved());
        }
        report(file.rsplit('/').nth(1).unwrap_or(file), &map);
    }
    for name in relievo_make::names() {
        let Some(map) = relievo_make::make(name, 512)?.height else { continue };
        report(name, &map);
        // All heights are multiples of 1/255 here: the difference to the line above is the price of rounding up.
        report(&format!("{name} in 8 bits"), &HeightMap::new(map.grid().map(|h| (h * 255.0).round() / 255.0)));
    }
    Ok(())
}
