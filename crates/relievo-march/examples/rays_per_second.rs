//! Rays per second of the exact march on one thread, ray by ray and many at a time, and its pyramid's time and bytes.
//!
//! `cargo run --release -p relievo-march --example rays_per_second -- [--json] [--dump DIR] [MATERIAL | HEIGHT.png]`
//!
//! MATERIAL is one that can be made (`brick-wall` if nothing is said), at 1024². The full depth is 25 texels; 512² rays, half a
//! texel apart. `--dump` writes the field and the rays for `peers/embree.py`, which sends them through
//! Embree.

// An example reports on the terminal.
#![allow(clippy::print_stdout)]

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use relievo_map::{HeightMap, Limits, White, Wrap, read_height};
use relievo_march::{MarchOptions, MaxPyramid, Ray, Record, ReliefMap, march, march_all};

const ANGLES: [f32; 4] = [0.0, 60.0, 80.0, 88.5];
const DEPTH: f32 = 25.0;
const SIDE: u32 = 512;
const SPACING: f32 = 0.5;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut json, mut dump, mut name) = (false, None, "brick-wall".to_owned());
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--json" => json = true,
            "--dump" => dump = Some(args.next().ok_or("--dump needs a folder")?),
            _ => name = arg,
        }
    }
    let map = load(&name)?;
    let (build, _) = best(|| MaxPyramid::build(map.grid(), map.is_8_bit()));
    let heights = ReliefMap::new(&map);
    let pyramid = &heights.pyramids()[0];
    let bytes = pyramid.bytes() + pyramid.window_bytes();
    let size = heights.size();
    if let Some(dir) = &dump {
        let texels: Vec<u8> = map.grid().texels().iter().flat_map(|h| h.to_le_bytes()).collect();
        fs::write(Path::new(dir).join("field.f32"), texels)?;
    }
    let mut rows = Vec::new();
    for degrees in ANGLES {
        let rays = rays(size, degrees);
        if let Some(dir) = &dump {
            // The origin of a ray, in texels, and its direction: x, y, z (up).
            let (sin, cos) = degrees.to_radians().sin_cos();
            let ray = |ray: &Ray| {
                let at = [0, 1].map(|k| ray.uv[k] * size[k] as f32 - 0.5);
                [at[0], at[1], DEPTH, sin * 0.8, sin * 0.6, -cos]
            };
            let numbers: Vec<u8> = rays.iter().flat_map(ray).flat_map(f32::to_le_bytes).collect();
            fs::write(Path::new(dir).join(format!("rays-{degrees}.f32")), numbers)?;
        }
        let field = heights.field(0.0, Wrap::Repeat);
        let options = MarchOptions::default();
        let (scalar, one_by_one) = best(|| rays.iter().map(|ray| march(&field, ray, &options)).collect::<Vec<_>>());
        let mut together = vec![Record::default(); rays.len()];
        let (packets, ()) = best(|| march_all(&field, &rays, &options, &mut together));
        let hits = |records: &[Record]| -> Vec<_> { records.iter().map(|r| (r.uv, r.depth, r.hit)).collect() };
        assert!(hits(&one_by_one) == hits(&together), "rays hit what they hit alone");
        if let Some(dir) = &dump {
            let depths: Vec<u8> = one_by_one.iter().flat_map(|record| record.depth.to_le_bytes()).collect();
            fs::write(Path::new(dir).join(format!("depths-{degrees}.f32")), depths)?;
        }
        let rate = |time: Duration| rays.len() as f64 / time.as_secs_f64();
        rows.push((degrees, rate(scalar), rate(packets)));
    }
    if json {
        let row = |(degrees, scalar, packets): &(f32, f64, f64)| {
            format!(r#"{{"degrees": {degrees}, "scalar": {scalar}, "packets": {packets}}}"#)
        };
        let rows: Vec<String> = rows.iter().map(row).collect();
        println!(
            r#"{{"field": "{name}", "size": [{}, {}], "build_ms": {}, "pyramid_bytes": {bytes}, "angles": [{}]}}"#,
            size[0],
            size[1],
            build.as_secs_f64() * 1e3,
            rows.join(", ")
        );
        return Ok(());
    }
    println!("{name}, {}×{}: pyramid {bytes} bytes, built in {build:.2?} on all cores", size[0], size[1]);
    for (degrees, scalar, packets) in rows {
        let gain = packets / scalar;
        println!("{degrees:>5}°: {:6.1} M rays/s ray by ray, {:6.1} together, ×{gain:.2}", scalar / 1e6, packets / 1e6);
    }
    Ok(())
}

fn load(name: &str) -> Result<HeightMap, Box<dyn std::error::Error>> {
    if Path::new(name).exists() {
        return Ok(read_height(name.as_ref(), White::High, &Limits::default())?.map);
    }
    relievo_make::make(name, 1024)?.height.ok_or_else(|| format!("{name} has no heights").into())
}

/// The shortest of some runs.
fn best<T>(mut run: impl FnMut() -> T) -> (Duration, T) {
    let mut time = || {
        let start = Instant::now();
        let result = run();
        (start.elapsed(), result)
    };
    let mut best = time();
    for _ in 0..9 {
        let again = time();
        if again.0 < best.0 {
            best = again;
        }
    }
    best
}

/// Parallel rays, the middle of the map below them, in Morton order: any 2, 4, 8, 16 … that follow each other are neighbours.
fn rays(size: [u32; 2], degrees: f32) -> Vec<Ray> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    // Every second bit of a number is one of the column's, the others are the row's.
    let pixel = |i: u32| [0, 1].map(|k| (0..SIDE.ilog2()).fold(0, |at, bit| at | (i >> (2 * bit + k) & 1) << bit));
    (0..SIDE * SIDE)
        .map(|i| {
            let at = pixel(i).map(|p| (p as f32 + 0.5) * SPACING);
            let uv = [0, 1].map(|k| 0.125 + at[k] / size[k] as f32);
            Ray::from_view(uv, [-sin * 0.8, -sin * 0.6, cos], size.map(|n| DEPTH / n as f32))
        })
        .collect()
}
