//! A corpus of reliefs and rays, and the judge: compares the records of any march with the f64 oracle.

use std::cell::OnceCell;
use std::ops::{Add, Range};

use rayon::prelude::*;
use relievo_map::{Grid, HeightMap, Wrap};
use relievo_march::{HeightField, HeightFieldView, OracleRay, Raised, Ray, Record, ReliefMap, oracle};

use crate::{Random, generated, in_8_bits, noise, spikes};

const ANGLES: [f32; 12] = [0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0, 85.0, 88.0, 88.5, 89.0, 89.5];
const DEPTHS: [f32; 6] = [1.0, 3.0, 10.0, 25.0, 50.0, 100.0];
/// All wrap modes.
pub const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];

/// Number of rays that are marched and judged at once.
const BATCH: u64 = 1 << 16;

/// Returns the number of rays per relief and wrap mode if all have `rays` together.
#[must_use]
pub fn share(rays: u64, corpus: &[Relief]) -> u64 {
    rays.div_ceil((WRAPS.len() * corpus.len()) as u64)
}

/// Returns the number of rays in the environment variable `RAYS`, else 10⁸.
///
/// # Panics
/// If `RAYS` is not a number.
#[must_use]
pub fn many_rays() -> u64 {
    std::env::var("RAYS").map_or(100_000_000, |rays| rays.parse().expect("RAYS is a number"))
}

/// A map of the corpus.
#[derive(Debug)]
pub struct Relief {
    /// Its name in messages; seeds its rays too.
    pub name: &'static str,
    /// The map, ready for marching.
    pub heights: ReliefMap,
    /// The largest difference between neighbouring texels.
    steepest: f32,
}

/// Returns maps of many kinds: solid, airy, noisy, spiky; even, odd and narrow sizes; 8 bits and more.
#[must_use]
pub fn corpus() -> Vec<Relief> {
    let hills =
        |x: u32, y: u32| 0.5 + 0.3 * (x as f32 * 0.05).sin() * (y as f32 * 0.08).cos() + 0.2 * (x as f32 * 0.6).sin();
    let spike = |x: u32, y: u32| if (x, y) == (170, 20) { 1.0 } else { 0.0 };
    let wall = generated("brick-wall", 256);
    vec![
        Relief::new("brick wall", wall.grid().clone()),
        Relief::new("brick wall in 8 bits", in_8_bits(wall.grid())),
        Relief::new("toy box", generated("toy-box", 128).grid().clone()),
        Relief::new("noise 61×64", noise([61, 64], 1)),
        Relief::new("hills 300×77", Grid::from_fn(300, 77, hills)),
        Relief::new("spikes 64×64", spikes([64, 64])),
        Relief::new("one spike 257×255", Grid::from_fn(257, 255, spike)),
        Relief::new("slits 128×4", Grid::from_fn(128, 4, |x, _| if x % 9 == 0 { 0.0 } else { 0.8 })),
    ]
}

/// Counts of judged records.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// All of them.
    pub rays: u64,
    /// Records farther than a twentieth of a texel from the oracle's hit, yet between the hits of the surface raised and
    /// lowered by a rounding error.
    pub grazing: u64,
    /// Records that are neither near the oracle's hit nor grazing.
    pub wrong: u64,
}

impl Add for Tally {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { rays: self.rays + other.rays, grazing: self.grazing + other.grazing, wrong: self.wrong + other.wrong }
    }
}

impl Tally {
    /// Asserts that not one ray is wrong, and that few graze a crest.
    ///
    /// # Panics
    /// If that is not so, or nothing was judged.
    pub fn assert_right(&self, backend: &str) {
        assert!(self.rays > 0, "{backend}: nothing was judged");
        assert_eq!(self.wrong, 0, "{backend}: {self:?}");
        assert!(self.grazing * 1000 < self.rays, "{backend}: {self:?}");
    }
}

impl Relief {
    /// Prepares a map.
    #[must_use]
    pub fn new(name: &'static str, map: Grid<f32>) -> Self {
        let steepest = steepest(&map);
        Self { name, heights: ReliefMap::new(&HeightMap::new(map)), steepest }
    }

    /// Returns the full-size field in this wrap mode.
    #[must_use]
    pub fn field(&self, wrap: Wrap) -> HeightFieldView<'_> {
        self.heights.field(0.0, wrap)
    }

    /// Sends `rays` rays of all angles and depths through `march`, in batches, and judges the records of several backends,
    /// one of every ray for each. Neighbouring rays have the same angle and depth.
    ///
    /// # Panics
    /// If a backend gives another number of records than rays.
    pub fn march_and_judge<const N: usize>(
        &self,
        wrap: Wrap,
        rays: u64,
        mut march: impl FnMut(&[Ray]) -> [Vec<Record>; N],
    ) -> [Tally; N] {
        let mut total = [Tally::default(); N];
        for first in (0..rays).step_by(BATCH as usize) {
            let batch = self.rays(wrap, first..(first + BATCH).min(rays), rays);
            let records = march(&batch);
            let tallies = self.judge(wrap, &batch, records.each_ref().map(Vec::as_slice));
            total = std::array::from_fn(|k| total[k] + tallies[k]);
        }
        total
    }

    /// Returns some of `all` rays, each with a random origin and direction of its own.
    fn rays(&self, wrap: Wrap, some: Range<u64>, all: u64) -> Vec<Ray> {
        let size = self.heights.size();
        let seed = self.name.bytes().fold(wrap as u64, |seed, byte| seed.wrapping_mul(31) + u64::from(byte));
        let cases = (ANGLES.len() * DEPTHS.len()) as u64;
        let ray = |i: u64| {
            let case = (i * cases / all) as usize;
            let (degrees, depth) = (ANGLES[case / DEPTHS.len()], DEPTHS[case % DEPTHS.len()]);
            let mut random = Random(seed << 40 ^ i << 4);
            let (sin, cos) = degrees.to_radians().sin_cos();
            let (sy, sx) = (random.unit() * std::f32::consts::TAU).sin_cos();
            let uv = [random.unit() * 2.0 - 0.5, random.unit() * 2.0 - 0.5];
            Ray::from_view(uv, [sin * sx, sin * sy, cos], size.map(|n| depth / n as f32))
        };
        some.into_par_iter().map(ray).collect()
    }

    /// Judges the records of several backends for the same rays: the oracle is asked once.
    ///
    /// # Panics
    /// If a backend gives another number of records than rays.
    #[must_use]
    pub fn judge<const N: usize>(&self, wrap: Wrap, rays: &[Ray], records: [&[Record]; N]) -> [Tally; N] {
        assert!(records.iter().all(|records| records.len() == rays.len()), "a record for every ray");
        let field = self.field(wrap);
        let judged = (0..rays.len()).into_par_iter().map(|i| {
            let truth = Truth::new(&field, &rays[i], self.steepest);
            records.map(|records| truth.judge(&records[i]))
        });
        judged.reduce(|| [Tally::default(); N], |a, b| std::array::from_fn(|k| a[k] + b[k]))
    }
}

/// The oracle's answer for one ray.
struct Truth<'a> {
    field: &'a HeightFieldView<'a>,
    ray: OracleRay,
    depth: f64,
    /// A twentieth of a texel, in depth.
    near: f64,
    /// The largest rounding error in f32, in height: it moves a ray by a few units in the last place of its farthest
    /// coordinate, in texels, and on a slope that is a difference in height.
    rounding: f32,
    /// The hits on the surface raised and lowered by so much.
    between: OnceCell<[f64; 2]>,
}

impl<'a> Truth<'a> {
    fn new(field: &'a HeightFieldView<'a>, ray: &Ray, steepest: f32) -> Self {
        let ray = OracleRay::from(ray);
        let size = field.size().map(f64::from);
        let texels = (0..2).map(|k| ray.slope[k].abs() * size[k]).fold(0.0, f64::max);
        let reach = (0..2).map(|k| (ray.uv[k].abs() + ray.slope[k].abs()) * size[k]).fold(0.0, f64::max);
        Self {
            field,
            ray,
            depth: depth(field, &ray),
            near: 0.05 / texels.max(1.0),
            rounding: 2e-6 + (4.0 * f64::from(f32::EPSILON) * reach) as f32 * steepest,
            between: OnceCell::new(),
        }
    }

    /// Judges a record: right if it is near the oracle's, or lies between those of the surface raised and lowered by a rounding error.
    fn judge(&self, record: &Record) -> Tally {
        let depth = f64::from(record.depth);
        let (mut grazing, mut wrong) = (0, 0);
        // Written so that NaN is wrong.
        if !(record.hit && (depth - self.depth).abs() <= self.near) {
            let [first, last] = *self.between.get_or_init(|| {
                [self.rounding, -self.rounding].map(|offset| self::depth(&Raised(self.field, offset), &self.ray))
            });
            let grazes = record.hit && first - self.near <= depth && depth <= last + self.near;
            (grazing, wrong) = (u64::from(grazes), u64::from(!grazes));
        }
        Tally { rays: 1, grazing, wrong }
    }
}

fn depth(field: &impl HeightField, ray: &OracleRay) -> f64 {
    oracle(field, ray, None).map_or(f64::NAN, |hit| hit.depth)
}

/// Returns the largest difference between neighbouring texels.
fn steepest(map: &Grid<f32>) -> f32 {
    let [w, h] = [map.width(), map.height()];
    let difference = |x: u32, y: u32| {
        let here = map.get(x, y);
        (map.get((x + 1) % w, y) - here).abs().max((map.get(x, (y + 1) % h) - here).abs())
    };
    (0..h).flat_map(|y| (0..w).map(move |x| difference(x, y))).fold(0.0, f32::max)
}
