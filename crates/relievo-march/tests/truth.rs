//! The exact march against the f64 oracle: materials × angles × depths × wrap modes, not one wrong hit.

// A test reports its figures.
#![allow(clippy::print_stdout)]

use rayon::prelude::*;
use relievo_map::{Grid, HeightMap, Wrap};
use relievo_march::{HeightField, Heights, March, MaxPyramid, OracleRay, PyramidField, Ray, march, oracle};

const ANGLES: [f32; 12] = [0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0, 85.0, 88.0, 88.5, 89.0, 89.5];
const DEPTHS: [f32; 6] = [1.0, 3.0, 10.0, 25.0, 50.0, 100.0];
const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];

/// SplitMix64 (Steele et al. 2014).
fn random(state: &mut u64) -> f32 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
}

/// Solid, airy, noisy, spiky; even, odd and narrow sizes; 8 bits and more.
fn corpus() -> Vec<(&'static str, Heights)> {
    let map = |grid: Grid<f32>| Heights::new(&HeightMap::new(grid));
    let made = |name: &str, size: u32| relievo_make::make(name, size).unwrap().height.unwrap();
    let mut seed = 1;
    let noise = Grid::from_fn(61, 64, |_, _| random(&mut seed));
    let hills =
        |x: u32, y: u32| 0.5 + 0.3 * (x as f32 * 0.05).sin() * (y as f32 * 0.08).cos() + 0.2 * (x as f32 * 0.6).sin();
    let spikes = |x: u32, y: u32| if (x * 7 + y * 13).is_multiple_of(53) { 1.0 } else { 0.1 };
    let spike = |x: u32, y: u32| if (x, y) == (170, 20) { 1.0 } else { 0.0 };
    let wall = made("brick-wall", 256);
    vec![
        ("brick wall", map(wall.grid().clone())),
        ("brick wall in 8 bits", map(wall.grid().map(|h| (h * 255.0).round() / 255.0))),
        ("toy box", map(made("toy-box", 128).grid().clone())),
        ("noise 61×64", map(noise)),
        ("hills 300×77", map(Grid::from_fn(300, 77, hills))),
        ("spikes 64×64", map(Grid::from_fn(64, 64, spikes))),
        ("one spike 257×255", map(Grid::from_fn(257, 255, spike))),
        ("slits 128×4", map(Grid::from_fn(128, 4, |x, _| if x % 9 == 0 { 0.0 } else { 0.8 }))),
    ]
}

/// The surface, higher by a little.
struct Raised<'a, F>(&'a F, f32);

impl<F: HeightField> HeightField for Raised<'_, F> {
    fn size(&self) -> [u32; 2] {
        self.0.size()
    }
    fn corners(&self, i: i32, j: i32) -> [f32; 4] {
        self.0.corners(i, j).map(|h| h + self.1)
    }
    fn sample(&self, uv: [f32; 2]) -> f32 {
        self.0.sample(uv) + self.1
    }
    fn range(&self) -> [f32; 2] {
        self.0.range().map(|h| h + self.1)
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    rays: u64,
    /// Farther than a twentieth of a texel from the oracle's hit, yet where a surface a rounding error higher or lower is met.
    grazing: u64,
    wrong: u64,
}

/// Judges one ray. Rounding in f32 moves a ray by a few units in the last place of its farthest coordinate, in texels; on a
/// slope that is a difference in height. A hit is right if it lies between those of the surface raised and lowered so much.
fn judge(field: &impl HeightField, ray: &Ray, steepest: f32, tally: &mut Tally) {
    let record = march(field, ray, &March::default());
    let ray = OracleRay::from(ray);
    let size = field.size().map(f64::from);
    let texels = (0..2).map(|k| ray.slope[k].abs() * size[k]).fold(0.0, f64::max);
    let reach = (0..2).map(|k| (ray.uv[k].abs() + ray.slope[k].abs()) * size[k]).fold(0.0, f64::max);
    let truth = oracle(field, &ray, None).map_or(f64::NAN, |hit| hit.depth);
    let depth = f64::from(record.depth);
    tally.rays += 1;
    let near = 0.05 / texels.max(1.0);
    if record.hit && (depth - truth).abs() <= near {
        return;
    }
    let rounding = 2e-6 + (4.0 * f64::from(f32::EPSILON) * reach) as f32 * steepest;
    let first = oracle(&Raised(field, rounding), &ray, None).map_or(f64::NAN, |hit| hit.depth);
    let last = oracle(&Raised(field, -rounding), &ray, None).map_or(f64::NAN, |hit| hit.depth);
    if record.hit && first - near <= depth && depth <= last + near {
        tally.grazing += 1;
    } else {
        tally.wrong += 1;
    }
}

/// The largest difference between two texels of a cell.
fn steepest(map: &Grid<f32>) -> f32 {
    let [w, h] = [map.width(), map.height()];
    let difference = |x: u32, y: u32| {
        let here = map.get(x, y);
        (map.get((x + 1) % w, y) - here).abs().max((map.get(x, (y + 1) % h) - here).abs())
    };
    (0..h).flat_map(|y| (0..w).map(move |x| difference(x, y))).fold(0.0, f32::max)
}

/// Judges rays of all angles and depths.
fn judge_all(size: [u32; 2], field: &(impl HeightField + Sync), steepest: f32, seed: u64, rays: u64) -> Tally {
    let cases: Vec<(f32, f32)> = ANGLES.iter().flat_map(|&a| DEPTHS.map(|d| (a, d))).collect();
    let tallies = cases.par_iter().enumerate().map(|(i, &(degrees, depth))| {
        let mut tally = Tally::default();
        let mut state = seed << 32 | (i as u64) << 16;
        let (sin, cos) = degrees.to_radians().sin_cos();
        for _ in 0..rays.div_ceil(cases.len() as u64) {
            let (sy, sx) = (random(&mut state) * std::f32::consts::TAU).sin_cos();
            let scale = size.map(|n| depth / n as f32);
            let uv = [random(&mut state) * 2.0 - 0.5, random(&mut state) * 2.0 - 0.5];
            judge(field, &Ray::from_view(uv, [sin * sx, sin * sy, cos], scale), steepest, &mut tally);
        }
        tally
    });
    tallies.reduce(Tally::default, |a, b| Tally {
        rays: a.rays + b.rays,
        grazing: a.grazing + b.grazing,
        wrong: a.wrong + b.wrong,
    })
}

fn no_ray_is_wrong(rays: u64) {
    let corpus = corpus();
    let mut total = Tally::default();
    for (k, (name, heights)) in corpus.iter().enumerate() {
        let steepest = steepest(&heights.levels()[0]);
        for (w, wrap) in WRAPS.into_iter().enumerate() {
            let seed = (k * 3 + w) as u64;
            let share = rays / (3 * corpus.len() as u64);
            let tally = judge_all(heights.size(), &heights.field(0.0, wrap), steepest, seed, share);
            println!("{name:22} {wrap:?}: {tally:?}");
            total.rays += tally.rays;
            total.grazing += tally.grazing;
            total.wrong += tally.wrong;
        }
    }
    println!("{total:?}");
    assert_eq!(total.wrong, 0, "{total:?}");
    assert!(total.grazing * 1000 < total.rays, "{total:?}");
}

#[test]
fn no_hit_is_wrong_from_straight_down_to_half_a_degree_in_reliefs_of_1_to_100_texels() {
    no_ray_is_wrong(60_000);
}

/// `cargo test --release -p relievo-march --test truth -- --ignored --nocapture`; `RAYS` says how many.
#[test]
#[ignore = "takes minutes to hours"]
fn no_hit_is_wrong_among_many_rays() {
    let rays = std::env::var("RAYS").map_or(100_000_000, |rays| rays.parse().expect("RAYS is a number"));
    no_ray_is_wrong(rays);
}

/// A field whose pyramid is that of a map one step of 1/255 lower.
struct RoundedDown<'a> {
    field: relievo_march::Field<'a>,
    map: &'a Grid<f32>,
    pyramid: &'a MaxPyramid,
}

impl HeightField for RoundedDown<'_> {
    fn size(&self) -> [u32; 2] {
        self.field.size()
    }
    fn corners(&self, i: i32, j: i32) -> [f32; 4] {
        self.field.corners(i, j)
    }
    fn sample(&self, uv: [f32; 2]) -> f32 {
        self.field.sample(uv)
    }
    fn range(&self) -> [f32; 2] {
        self.field.range()
    }
    fn pyramid(&self) -> Option<PyramidField<'_>> {
        Some(PyramidField::new(self.map, self.pyramid, Wrap::Repeat))
    }
}

#[test]
fn a_pyramid_rounded_down_gives_wrong_hits() {
    let (_, heights) = corpus().swap_remove(1);
    let map = &heights.levels()[0];
    let pyramid = MaxPyramid::build(&map.map(|h| (h - 1.0 / 255.0).max(0.0)), true);
    let field = RoundedDown { field: heights.field(0.0, Wrap::Repeat), map, pyramid: &pyramid };
    let tally = judge_all(heights.size(), &field, steepest(map), 1, 5_000);
    assert!(tally.wrong > 50, "{tally:?}");
}
