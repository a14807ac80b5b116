//! Marches one ray through a groove with every technique and prints where each one ends.
//!
//! ```sh
//! cargo run --release -p relievo --example march
//! ```

#![allow(clippy::print_stdout)]

use relievo::{Grid, HeightMap, MarchOptions, Ray, ReliefMap, Technique, Wrap, march};

fn main() {
    let map = HeightMap::new(Grid::from_fn(64, 64, |x, _| if (24..40).contains(&x) { 0.0 } else { 1.0 }));
    let relief = ReliefMap::new(&map);
    let field = relief.field(0.0, Wrap::Repeat);
    // Seen under 75° from the left, over the groove; the groove is a tenth of a repeat deep.
    let (sin, cos) = 75.0f32.to_radians().sin_cos();
    let ray = Ray::from_view([0.40, 0.5], [-sin, 0.0, cos], [0.1, -0.1]);
    for technique in Technique::ALL {
        let record = march(&field, &ray, &MarchOptions { technique, ..MarchOptions::default() });
        println!(
            "{:16} u {:.4}  depth {:.4}  {:2} fetches",
            technique.name(),
            record.uv[0],
            record.depth,
            record.fetches
        );
    }
}
