//! Marches one slanted ray to a relief by every technique, and prints the error against the f64 oracle and the cost.
//!
//! ```sh
//! cargo run -p relievo-march --example march_one_ray
//! ```
#![allow(clippy::print_stdout)]

use relievo_map::{Grid, HeightMap, Wrap};
use relievo_march::{Cones, MarchOptions, OracleRay, Ray, ReliefMap, SurfaceAxes, Technique, march, oracle};

fn main() {
    // Round studs on a plane.
    let studs = Grid::from_fn(128, 128, |x, y| {
        let [x, y] = [x, y].map(|i| (i % 32) as f32 / 16.0 - 1.0);
        (1.0 - x * x - y * y).max(0.0).sqrt()
    });
    let relief = ReliefMap::new(&HeightMap::new(studs)).with_cones(Cones::Relaxed);
    let field = relief.field(0.0, Wrap::Repeat);

    // A quad of 2 × 2 units with one repeat of the texture, v running down; the relief is 0.2 units deep. The eye looks from
    // the right, 70° from the normal.
    let axes = SurfaceAxes { dp_du: [2.0, 0.0, 0.0], dp_dv: [0.0, -2.0, 0.0], normal: [0.0, 0.0, 1.0] };
    let (sin, cos) = 70f32.to_radians().sin_cos();
    let ray = Ray::from_surface([0.6, 0.4], [sin, 0.0, cos], &axes, 0.2);

    let Some(truth) = oracle(&field, &OracleRay::from(&ray), None) else { return println!("nothing is hit") };
    println!("the oracle: uv {:.5} {:.5}, depth {:.5}", truth.uv[0], truth.uv[1], truth.depth);
    for technique in Technique::ALL {
        let record = march(&field, &ray, &MarchOptions { technique, ..MarchOptions::default() });
        let [du, dv] = [0, 1].map(|k| (f64::from(record.uv[k]) - truth.uv[k]) * 128.0);
        println!(
            "{:16} uv {:.5} {:.5}, {:6.3} texels off, {:2} fetches",
            technique.name(),
            record.uv[0],
            record.uv[1],
            du.hypot(dv),
            record.fetches
        );
    }
}
