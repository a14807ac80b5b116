//! Marches a picture's worth of rays at once, and writes the depths as an ASCII picture and the rate of rays.
//!
//! ```sh
//! cargo run --release -p relievo-march --example march_all
//! ```
#![allow(clippy::print_stdout)]

use std::time::Instant;

use relievo_map::{Grid, HeightMap, Wrap};
use relievo_march::{MarchOptions, Ray, Record, ReliefMap, march_all};

const SIDE: u32 = 256;

fn main() {
    let bumps =
        |x: u32, y: u32| 0.5 + 0.3 * (x as f32 * 0.1).sin() * (y as f32 * 0.15).cos() + 0.2 * (y as f32 * 0.05).sin();
    let relief = ReliefMap::new(&HeightMap::new(Grid::from_fn(256, 256, bumps)));
    let field = relief.field(0.0, Wrap::Repeat);

    // One ray per pixel, tile by tile of 4×4 pixels: rays that follow each other should be neighbours.
    let pixel = |i: u32| {
        let (tile, inside) = (i / 16, i % 16);
        [tile % (SIDE / 4) * 4 + inside % 4, tile / (SIDE / 4) * 4 + inside / 4]
    };
    let ray = |i: u32| {
        let uv = pixel(i).map(|p| (p as f32 + 0.5) / SIDE as f32);
        // 60° from the normal; a tenth of a repeat deep, v running down.
        Ray::from_view(uv, [0.75f32.sqrt(), 0.0, 0.5], [0.1, -0.1])
    };
    let rays: Vec<Ray> = (0..SIDE * SIDE).map(ray).collect();
    let mut records = vec![Record::default(); rays.len()];

    let start = Instant::now();
    march_all(&field, &rays, &MarchOptions::default(), &mut records);
    let seconds = start.elapsed().as_secs_f64();

    let mut picture = vec![b' '; (SIDE / 8 * SIDE / 4) as usize];
    for (i, record) in (0..).zip(&records) {
        let [x, y] = pixel(i);
        let shade = b"@%#*+=-:. "[((record.depth * 10.0) as usize).min(9)];
        picture[(y / 8 * (SIDE / 4) + x / 4) as usize] = shade;
    }
    for line in picture.chunks(SIDE as usize / 4) {
        println!("{}", String::from_utf8_lossy(line));
    }
    println!("{} rays, {:.1} M rays/s on one thread", rays.len(), rays.len() as f64 / seconds / 1e6);
}
