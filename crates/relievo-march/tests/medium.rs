//! The optical depth of a relief against quadrature in f64: any direction, from outside and inside, many crossings.

// A test reports its figures.
#![allow(clippy::print_stdout)]

use rayon::prelude::*;
use relievo_map::{Grid, HeightMap, Wrap};
use relievo_march::{
    MAX_OPTICAL_DEPTH, MaxPyramid, Medium, MediumRay, OpticalDepth, PyramidField, ReliefMap, WithoutPyramid,
    optical_depth, scatter_distances,
};
use relievo_testkit::{Random, WRAPS, WithPyramid, noise, spikes};

/// Transmittances may differ by this much.
const TOLERANCE: f64 = 1e-4;

/// The map in f64, sampled without any code of the march.
struct Reference<'a> {
    map: &'a Grid<f32>,
    wrap: Wrap,
    ray: MediumRay,
}

impl Reference<'_> {
    fn height(&self, uv: [f64; 2]) -> f64 {
        let size = [self.map.width(), self.map.height()];
        let x = [0, 1].map(|k| uv[k] * f64::from(size[k]) - 0.5);
        let texel = |i: i32, j: i32| {
            let at = self.map.get(self.wrap.index(i, size[0]), self.wrap.index(j, size[1]));
            f64::from(*at)
        };
        let [i, j] = x.map(|x| x.floor() as i32);
        let [a, b] = x.map(|x| x - x.floor());
        let row = |j: i32| texel(i, j) * (1.0 - a) + texel(i + 1, j) * a;
        row(j) * (1.0 - b) + row(j + 1) * b
    }

    /// The depth of the ray's point below the surface.
    fn depth(&self, s: f64) -> f64 {
        let at = |k: usize| f64::from(self.ray.uv[k]) + f64::from(self.ray.uv_delta[k]) * s;
        self.height([at(0), at(1)]) - (f64::from(self.ray.height) + f64::from(self.ray.height_delta) * s)
    }

    fn density(&self, s: f64, softness: f64) -> f64 {
        let depth = self.depth(s);
        if softness == 0.0 { f64::from(u8::from(depth > 0.0)) } else { (depth / softness).clamp(0.0, 1.0) }
    }

    /// All distances at which the ray crosses a line of texel centres, and both ends.
    fn borders(&self, [start, end]: [f64; 2]) -> Vec<f64> {
        let mut all = vec![start, end];
        for (k, n) in [self.map.width(), self.map.height()].into_iter().enumerate() {
            let (uv, delta) = (f64::from(self.ray.uv[k]), f64::from(self.ray.uv_delta[k]));
            let at = |s: f64| (uv + delta * s) * f64::from(n) - 0.5;
            let (low, high) = (at(start).min(at(end)).ceil() as i64, at(start).max(at(end)).floor() as i64);
            if delta != 0.0 {
                all.extend((low..=high).map(|i| ((i as f64 + 0.5) / f64::from(n) - uv) / delta));
            }
        }
        all.retain(|s| (start..=end).contains(s));
        all.sort_by(f64::total_cmp);
        all
    }

    /// Integrates by bisection for the changes of the density's law, and Gauss's rule of three points between them.
    fn integral(&self, range: [f64; 2], softness: f64) -> f64 {
        let borders = self.borders(range);
        let mut sum = 0.0;
        for cell in borders.windows(2) {
            let (a, b) = (cell[0], cell[1]);
            if b - a < 1e-13 {
                continue;
            }
            // A parabola in each cell: of one sign of slope before its vertex, of the other behind.
            let (h, first, middle, last) = (0.5 * (b - a), self.depth(a), self.depth(0.5 * (a + b)), self.depth(b));
            let vertex = 0.5 * (a + b) - h * (last - first) / (2.0 * (first + last - 2.0 * middle));
            let mut cuts = vec![a, b];
            cuts.extend((vertex > a && vertex < b).then_some(vertex));
            cuts.sort_by(f64::total_cmp);
            for monotone in cuts.clone().windows(2) {
                for level in [0.0, softness] {
                    cuts.extend(self.bisect(monotone[0], monotone[1], level));
                }
            }
            cuts.sort_by(f64::total_cmp);
            sum += cuts.windows(2).map(|piece| self.gauss(piece[0], piece[1], softness)).sum::<f64>();
        }
        sum
    }

    fn bisect(&self, mut a: f64, mut b: f64, level: f64) -> Option<f64> {
        let below = |s: f64| self.depth(s) > level;
        let side = below(a);
        if side == below(b) {
            return None;
        }
        for _ in 0..60 {
            let middle = 0.5 * (a + b);
            if below(middle) == side { a = middle } else { b = middle }
        }
        Some(a)
    }

    fn gauss(&self, a: f64, b: f64, softness: f64) -> f64 {
        let at = |x: f64| self.density(0.5 * (a + b) + 0.5 * (b - a) * x, softness);
        let x = 0.6f64.sqrt();
        0.5 * (b - a) * (5.0 / 9.0 * (at(-x) + at(x)) + 8.0 / 9.0 * at(0.0))
    }

    /// Integrates by the midpoint rule alone.
    fn midpoints(&self, [start, end]: [f64; 2], softness: f64, count: u32) -> f64 {
        let h = (end - start) / f64::from(count);
        (0..count).map(|i| self.density(start + h * (f64::from(i) + 0.5), softness) * h).sum()
    }
}

fn maps() -> Vec<(&'static str, Grid<f32>)> {
    let sine = Grid::from_fn(96, 80, |x, y| {
        let [u, v] = [x as f32 / 96.0, y as f32 / 80.0].map(|t| t * std::f32::consts::TAU);
        0.5 + 0.25 * (5.0 * u).sin() * (3.0 * v).cos() + 0.25 * (2.0 * u + 7.0 * v).sin()
    });
    vec![("sine", sine), ("noise", noise([61, 47], 5)), ("spikes", spikes([64, 64]))]
}

/// A ray of any direction through up to `reach` texels, begun above, in or below the relief; most cross many times.
fn ray(random: &mut Random, size: [u32; 2]) -> MediumRay {
    let texels = [4.0, 20.0, 90.0][(random.unit() * 3.0) as usize];
    let angle = random.unit() * std::f32::consts::TAU;
    let uv_delta = [angle.cos() / size[0] as f32, angle.sin() / size[1] as f32].map(|d| d * texels);
    let [height, until] = [0, 1].map(|_| random.unit() * 1.4 - 0.2);
    MediumRay { uv: [random.signed(2.0), random.signed(2.0)], uv_delta, height, height_delta: until - height }
}

/// Finds an optical depth.
trait Finder: Fn(&ReliefMap, Wrap, &MediumRay, [f32; 2], &Medium) -> OpticalDepth + Sync {}
impl<F: Fn(&ReliefMap, Wrap, &MediumRay, [f32; 2], &Medium) -> OpticalDepth + Sync> Finder for F {}

/// The worst difference in transmittance, and the number of rays that are off.
fn differences(rays: u64, find: impl Finder) -> (f64, u64) {
    let each = rays / (3 * WRAPS.len() as u64);
    let mut worst = (0.0f64, 0u64);
    for (name, map) in maps() {
        let heights = ReliefMap::new(&HeightMap::new(map.clone()));
        for wrap in WRAPS {
            let judge = |i: u64| {
                let mut random = Random(i.wrapping_mul(0x9e37_79b9) ^ u64::from(map.width()));
                let ray = ray(&mut random, [map.width(), map.height()]);
                let softness = [0.0, 0.04, 0.3][(random.unit() * 3.0) as usize];
                let medium = Medium { density: 4.0 * random.unit(), softness };
                let range = [0.3 * random.unit(), 1.0];
                let found = find(&heights, wrap, &ray, range, &medium).transmittance();
                let reference = Reference { map: &map, wrap, ray };
                let integral = reference.integral(range.map(f64::from), f64::from(softness));
                let off = (f64::from(found) - (-integral * f64::from(medium.density)).exp()).abs();
                (off, u64::from(!(off <= TOLERANCE)))
            };
            let tally = (0..each).into_par_iter().map(judge).reduce(|| (0.0, 0), |a, b| (a.0.max(b.0), a.1 + b.1));
            println!("{name} {wrap:?}: {each} rays, at most {:.2e} off", tally.0);
            worst = (worst.0.max(tally.0), worst.1 + tally.1);
        }
    }
    worst
}

fn through_the_pyramid(
    heights: &ReliefMap,
    wrap: Wrap,
    ray: &MediumRay,
    range: [f32; 2],
    medium: &Medium,
) -> OpticalDepth {
    optical_depth(&heights.field(0.0, wrap), ray, range, medium)
}

fn every_ray_is_right(rays: u64) {
    let (worst, off) = differences(rays, through_the_pyramid);
    println!("{rays} rays: at most {worst:.2e} off");
    assert_eq!(off, 0, "{off} rays are off, the worst by {worst:.2e}");
}

#[test]
fn transmittance_is_the_integral_over_all_crossings() {
    every_ray_is_right(20_000);
}

/// `cargo test --release -p relievo-march --test medium -- --ignored --nocapture`
#[test]
#[ignore = "takes a minute"]
fn transmittance_is_the_integral_over_all_crossings_of_a_million_rays() {
    every_ray_is_right(1_000_000);
}

#[test]
fn the_quadrature_agrees_with_midpoints_alone() {
    for (name, map) in maps() {
        for i in 0..40 {
            let mut random = Random(i);
            let ray = ray(&mut random, [map.width(), map.height()]);
            let softness = [0.0, 0.05][(i % 2) as usize];
            let reference = Reference { map: &map, wrap: Wrap::Mirror, ray };
            let [exact, plain] =
                [reference.integral([0.0, 1.0], softness), reference.midpoints([0.0, 1.0], softness, 200_000)];
            assert!((exact - plain).abs() < 2e-4, "{name} {ray:?}: {exact} by cells, {plain} by midpoints");
        }
    }
}

#[test]
fn what_is_not_the_whole_integral_is_caught() {
    // A pyramid that is too low passes over what it should not.
    let low = |heights: &ReliefMap, wrap: Wrap, ray: &MediumRay, range: [f32; 2], medium: &Medium| {
        let map = &heights.levels()[0];
        let pyramid = MaxPyramid::build(&map.map(|h| (h - 0.05).max(0.0)), false);
        optical_depth(
            &WithPyramid(heights.field(0.0, wrap), PyramidField::new(map, &pyramid, wrap)),
            ray,
            range,
            medium,
        )
    };
    let (_, off) = differences(900, low);
    assert!(off > 20, "only {off} of 900 rays tell a pyramid that is too low");
    // What ends at the first way out.
    let first = |heights: &ReliefMap, wrap: Wrap, ray: &MediumRay, range: [f32; 2], medium: &Medium| {
        let field = heights.field(0.0, wrap);
        let hard = Medium { density: 1.0, softness: 0.0 };
        let part = |k: u32| range[0] + (range[1] - range[0]) * k as f32 / 512.0;
        let inside = |k: u32| optical_depth(&field, ray, [part(k), part(k + 1)], &hard).value > 0.0;
        let exit = (0..512).skip_while(|&k| !inside(k)).find(|&k| !inside(k)).map_or(range[1], part);
        optical_depth(&field, ray, [range[0], exit], medium)
    };
    let (_, off) = differences(900, first);
    assert!(off > 100, "only {off} of 900 rays have more than one way out");
}

#[test]
fn the_pyramid_changes_nothing_but_the_cost() {
    let (mut with, mut without) = (0u64, 0u64);
    for (_, map) in maps() {
        let heights = ReliefMap::new(&HeightMap::new(map.clone()));
        let mut random = Random(9);
        for _ in 0..3000 {
            let ray = ray(&mut random, [map.width(), map.height()]);
            let field = heights.field(0.0, Wrap::Repeat);
            let medium = Medium { density: 0.5, softness: 0.1 };
            let skipped = optical_depth(&field, &ray, [0.0, 1.0], &medium);
            let plain = optical_depth(&WithoutPyramid(field), &ray, [0.0, 1.0], &medium);
            assert!((skipped.transmittance() - plain.transmittance()).abs() < 1e-5, "{ray:?}: {skipped:?}, {plain:?}");
            with += u64::from(skipped.fetches);
            without += u64::from(plain.fetches);
        }
    }
    println!("{with} fetches through the pyramid, {without} without");
}

#[test]
fn scattered_light_is_sampled_where_its_share_says() {
    let map = &maps()[0].1;
    let heights = ReliefMap::new(&HeightMap::new(map.clone()));
    let field = heights.field(0.0, Wrap::Repeat);
    let mut random = Random(3);
    let mut tested = 0;
    for i in 0..2000 {
        let ray = ray(&mut random, [96, 80]);
        let medium = Medium { density: 3.0, softness: [0.0, 0.2][i % 2] };
        let total = optical_depth(&field, &ray, [0.0, 1.0], &medium);
        let mut distances = [0.0; 7];
        scatter_distances(&field, &ray, [0.0, 1.0], &medium, &total, 0.5, &mut distances);
        assert!(distances.is_sorted() && (0.0..=1.0).contains(&distances[0]) && distances[6] <= 1.0);
        if total.value < 0.01 {
            continue;
        }
        for (k, &s) in distances.iter().enumerate() {
            let share =
                (1.0 - optical_depth(&field, &ray, [0.0, s], &medium).transmittance()) / (1.0 - total.transmittance());
            let expected = (k as f32 + 0.5) / 7.0;
            assert!((share - expected).abs() < 2e-3, "{ray:?} {medium:?}: {share} instead of {expected}");
            tested += 1;
        }
    }
    assert!(tested > 1000);
}

#[test]
fn a_flat_layer_scatters_as_the_closed_form_says_and_no_more_than_arrives() {
    // Light straight down, seen from straight above: ∫ e^(−2τ) dτ = (1 − e^(−2τ))/2.
    let heights = ReliefMap::new(&HeightMap::new(Grid::filled(8, 8, 0.75)));
    let field = heights.field(0.0, Wrap::Repeat);
    let down = MediumRay { uv: [0.3, 0.4], uv_delta: [0.0, 0.0], height: 1.0, height_delta: -1.0 };
    for density in [0.01, 0.5, 4.0, 30.0] {
        let medium = Medium { density, softness: 0.0 };
        let total = optical_depth(&field, &down, [0.0, 1.0], &medium);
        let mut distances = [0.0; 256];
        scatter_distances(&field, &down, [0.0, 1.0], &medium, &total, 0.5, &mut distances);
        let lit = |s: f32| {
            let up = MediumRay { height: 1.0 - s, height_delta: 1.0, ..down };
            optical_depth(&field, &up, [0.0, 1.0], &medium).transmittance()
        };
        let share = (1.0 - total.transmittance()) / 256.0;
        let found: f32 = distances.iter().map(|&s| lit(s) * share).sum();
        let expected = 0.5 * (1.0 - (-2.0 * 0.75 * density).exp());
        assert!((found - expected).abs() < 1e-3, "{density}: {found} instead of {expected}");
        assert!(found <= 1.0 - total.transmittance() + 1e-6);
    }
}

#[test]
fn every_input_ends() {
    let heights = ReliefMap::new(&HeightMap::new(noise([32, 32], 1)));
    let field = heights.field(0.0, Wrap::Repeat);
    let odd = [0.0, -1.0, 1e30, -1e30, f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e-30, 0.5];
    let mut random = Random(4);
    for _ in 0..20_000 {
        let mut odd_number = || odd[(random.next_u64() % odd.len() as u64) as usize];
        let ray = MediumRay {
            uv: [odd_number(), odd_number()],
            uv_delta: [odd_number(), odd_number()],
            height: odd_number(),
            height_delta: odd_number(),
        };
        let (range, medium) = ([odd_number(), odd_number()], Medium { density: odd_number(), softness: odd_number() });
        let total = optical_depth(&field, &ray, range, &medium);
        assert!(!(total.value > MAX_OPTICAL_DEPTH) && total.iterations <= relievo_march::MAX_CELLS);
        let mut distances = [0.0; 3];
        scatter_distances(&field, &ray, range, &medium, &total, 0.5, &mut distances);
    }
}
