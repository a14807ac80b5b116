//! Cone maps against brute force, and the march through them against the plain walk and the oracle.

use relievo_map::{Grid, HeightMap, Wrap};
use relievo_march::{
    Bounds, ConeMap, Cones, HeightField, MarchOptions, MaxPyramid, OracleRay, Raised, Ray, Record, ReliefMap,
    Technique, TexelRect, WithoutPyramid, march, oracle,
};
use relievo_testkit::{Random, WRAPS, generated, in_8_bits, noise, ray, spikes};

/// Small enough for comparing all pairs of cells.
fn small_maps() -> Vec<(&'static str, Grid<f32>)> {
    let hills =
        |x: u32, y: u32| 0.5 + 0.3 * (x as f32 * 0.4).sin() * (y as f32 * 0.3).cos() + 0.2 * (x as f32 * 0.9).sin();
    let boxes = |x: u32, y: u32| if x % 12 < 7 && y % 9 < 6 { 0.8 } else { 0.1 };
    let terraces = |x: u32, y: u32| (hills(x, y) * 10.0).floor() / 10.0;
    vec![
        ("noise 19×14", noise([19, 14], 1)),
        ("noise 3×22", noise([3, 22], 2)),
        ("noise 1×5", noise([1, 5], 3)),
        ("one texel", Grid::from_fn(1, 1, |_, _| 0.4)),
        ("hills 31×23", Grid::from_fn(31, 23, hills)),
        ("low hills 17×17", Grid::from_fn(17, 17, |x, y| 0.4 + 0.01 * hills(x, y))),
        ("boxes 36×27", Grid::from_fn(36, 27, boxes)),
        ("terraces 40×33", Grid::from_fn(40, 33, terraces)),
        ("one spike 25×30", Grid::from_fn(25, 30, |x, y| if (x, y) == (7, 11) { 1.0 } else { 0.0 })),
        ("ramp 24×10", Grid::from_fn(24, 10, |x, _| x as f32 / 24.0)),
    ]
}

/// Maps of all sorts and sizes, with cones of both kinds.
fn maps() -> Vec<(&'static str, ReliefMap)> {
    let map = |grid: Grid<f32>| {
        ReliefMap::with_mips(&HeightMap::new(grid)).with_cones(Cones::Relaxed).with_cones(Cones::Conservative)
    };
    let made = |name: &str, size| generated(name, size).grid().clone();
    let slits = |x: u32, _| if x.is_multiple_of(9) { 0.0 } else { 0.8 };
    let mut maps: Vec<_> = small_maps().into_iter().map(|(name, grid)| (name, map(grid))).collect();
    maps.push(("brick wall", map(made("brick-wall", 128))));
    maps.push(("brick wall in 8 bits", map(in_8_bits(&made("brick-wall", 128)))));
    maps.push(("toy box", map(made("toy-box", 96))));
    maps.push(("spikes 64×64", map(spikes([64, 64]))));
    maps.push(("slits 128×4", map(Grid::from_fn(128, 4, slits))));
    maps
}

/// Returns the corners of a cell of the endless, tiling map.
fn corners(map: &Grid<f32>, [x, y]: [i32; 2]) -> [f32; 4] {
    let at = |x: i32, y: i32| *map.get(Wrap::Repeat.index(x, map.width()), Wrap::Repeat.index(y, map.height()));
    [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)]
}

/// Returns true if some point of cell q falls in the direction from some point of cell p: a bilinear patch has its extreme slopes on
/// its edges, and directions from corner to corner are the extreme ones.
fn falls_outwards(map: &Grid<f32>, p: [i32; 2], q: [i32; 2]) -> bool {
    let [h00, h10, h01, h11] = corners(map, q);
    let mut least = f32::INFINITY;
    for dx in [q[0] - p[0] - 1, q[0] - p[0] + 1] {
        for dy in [q[1] - p[1] - 1, q[1] - p[1] + 1] {
            for gx in [h10 - h00, h11 - h01] {
                for gy in [h01 - h00, h11 - h10] {
                    least = least.min(dx as f32 * gx + dy as f32 * gy);
                }
            }
        }
    }
    least < 0.0
}

/// Returns the steepest slope from the top of a cell to one that limits it, in quantization steps per texel: all cells of all
/// tiles around.
fn steepest(map: &Grid<f32>, pyramid: &MaxPyramid, cones: Cones, p: [i32; 2]) -> f64 {
    let n = [map.width() as i32, map.height() as i32];
    let maximum = |q: [i32; 2]| {
        let [x, y] = [0, 1].map(|k| q[k].rem_euclid(n[k]) as u32);
        let level = pyramid.level(1);
        level.nodes()[(y / 4 * level.size()[0] + x / 4) as usize][(y % 4 * 4 + x % 4) as usize]
    };
    let mut steepest = 0.0f64;
    // A step through relaxed cones goes no farther than a tile.
    for x in -n[0]..2 * n[0] {
        for y in -n[1]..2 * n[1] {
            let ascent = f64::from(maximum([x, y])) - f64::from(maximum(p));
            if ascent > 0.0 && (cones == Cones::Conservative || falls_outwards(map, p, [x, y])) {
                let gap = [x - p[0], y - p[1]].map(|d| f64::from((d.abs() - 1).max(0)));
                steepest = steepest.max(ascent / (gap[0].hypot(gap[1]) + 1.0));
            }
        }
    }
    steepest
}

#[test]
fn every_slope_is_that_of_comparing_all_cells_rounded_up() {
    for (name, map) in small_maps() {
        for eight_bit in [false, true] {
            let map = if eight_bit { in_8_bits(&map) } else { map.clone() };
            let pyramid = MaxPyramid::build(&map, eight_bit);
            for kind in Cones::ALL {
                let built = ConeMap::build(&map, &pyramid, kind);
                for (i, &texel) in built.texels().iter().enumerate() {
                    let p = [i as i32 % map.width() as i32, i as i32 / map.width() as i32];
                    let truth = steepest(&map, &pyramid, kind, p);
                    let slope = f64::from(built.slope(texel)) / f64::from(built.quantization_step());
                    let near = slope >= truth * (1.0 - 1e-6) && slope <= (truth * 1.0626).max(truth + 1e-2);
                    assert!(near && (truth > 0.0 || slope == 0.0), "{name} {kind:?} {p:?}: {slope} for {truth}");
                    // One code less would be too little: the test would notice.
                    let [top, code] = texel;
                    let less =
                        f64::from(built.slope([top, code.saturating_sub(1)])) / f64::from(built.quantization_step());
                    assert!(code <= 1 || less < truth, "{name} {kind:?} {p:?}: {less} would do for {truth}");
                }
            }
        }
    }
}

/// Follows a ray over the tiling map, in f64: returns true if it goes below the surface, and true if it comes up again.
fn pierces_and_leaves(map: &Grid<f32>, p: [f64; 2], direction: [f64; 2], z: f64, length: f64) -> (bool, bool) {
    // The rounding of this measurement, not of the cones.
    const NEAR: f64 = 1e-6;
    let at = |s: f64| [p[0] + direction[0] * s, p[1] + direction[1] * s];
    let clearance = |cell: [i32; 2], s: f64| {
        let [h00, h10, h01, h11] = corners(map, cell).map(f64::from);
        let [a, b] = [at(s)[0] - f64::from(cell[0]), at(s)[1] - f64::from(cell[1])];
        z - s - (h00 * (1.0 - a) * (1.0 - b) + h10 * a * (1.0 - b) + h01 * (1.0 - a) * b + h11 * a * b)
    };
    let mut borders = vec![0.0, length];
    for k in 0..2 {
        let (from, to) = (p[k], p[k] + direction[k] * length);
        let range = from.min(to).ceil() as i32..=from.max(to).floor() as i32;
        borders.extend(range.map(|i| (f64::from(i) - p[k]) / direction[k]).filter(|s| (0.0..=length).contains(s)));
    }
    borders.sort_by(f64::total_cmp);
    let (mut below, mut leaves) = (false, false);
    for pair in borders.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let middle = 0.5 * (from + to);
        let cell = at(middle).map(|x| x.floor() as i32);
        // A parabola: its ends, its middle, and its summit if that lies between.
        let [c0, c1, c2] = [from, middle, to].map(|s| clearance(cell, s));
        let (bend, tilt) = (2.0 * (c0 - 2.0 * c1 + c2), 4.0 * c1 - 3.0 * c0 - c2);
        let summit = (from + (to - from) * (-tilt / (2.0 * bend)).clamp(0.0, 1.0)).max(from).min(to);
        let mut points = [from, summit, to];
        points.sort_by(f64::total_cmp);
        for s in points.into_iter().filter(|s| s.is_finite()) {
            let c = clearance(cell, s);
            leaves |= below && c > NEAR;
            below |= c < -NEAR;
        }
    }
    (below, leaves)
}

/// Counts the rays from cells to the ends of their cones that go below the surface, and that come up again.
fn pierced_and_left(map: &Grid<f32>, cone: impl Fn([i32; 2]) -> (f64, f64), rays: u32, seed: u64) -> (u32, u32) {
    let mut random = Random(seed);
    let n = [map.width() as i32, map.height() as i32];
    let (mut pierced, mut left) = (0, 0);
    for _ in 0..rays {
        let cell = n.map(|n| (random.next_u64() % n as u64) as i32);
        let p = cell.map(|i| f64::from(i) + f64::from(random.unit()));
        let (top, slope) = cone(cell);
        let z = top + (1.0 - top) * f64::from(random.unit());
        let angle = f64::from(random.unit()) * std::f64::consts::TAU;
        // From nearly straight down to thousands of texels per unit of height.
        let speed = 10f64.powf(4.0 * f64::from(random.unit()) - 0.5);
        let direction = [angle.cos() * speed, angle.sin() * speed];
        let tile = (0..2).map(|k| f64::from(n[k]) / direction[k].abs()).fold(f64::INFINITY, f64::min);
        let length = ((z - top - slope) / (1.0 + speed * slope)).min(tile);
        if length > 0.0 {
            let (pierces, leaves) = pierces_and_leaves(map, p, direction, z, length);
            pierced += u32::from(pierces);
            left += u32::from(leaves);
        }
    }
    (pierced, left)
}

#[test]
fn inside_a_relaxed_cone_a_ray_meets_the_surface_at_most_once_and_inside_a_conservative_one_never() {
    let (mut pierced, mut wider) = (0, 0);
    for (name, map) in small_maps() {
        let pyramid = MaxPyramid::build(&map, false);
        for kind in Cones::ALL {
            let built = ConeMap::build(&map, &pyramid, kind);
            let cone = |[x, y]: [i32; 2]| {
                let texel = built.texels()[y as usize * map.width() as usize + x as usize];
                (f64::from(built.top(texel)), f64::from(built.slope(texel)))
            };
            let (below, left) = pierced_and_left(&map, cone, 20_000, 5);
            assert_eq!(left, 0, "{name} {kind:?}");
            if kind == Cones::Relaxed {
                pierced += below;
            } else {
                assert_eq!(below, 0, "{name} {kind:?}");
            }
            // The same cones, wider by two thirds, must not pass.
            let wide = |cell| {
                let (top, slope) = cone(cell);
                (top, slope * 0.6)
            };
            let (below, left) = pierced_and_left(&map, wide, 20_000, 5);
            wider += if kind == Cones::Relaxed { left } else { below };
        }
    }
    assert!(pierced > 100, "only {pierced} rays tell relaxed cones from conservative ones");
    assert!(wider > 100, "only {wider} rays tell cones that are too wide");
}

/// The generator of GPU Gems 3, chapter 18: only rays from the lid over the cone's texel count, and where they come up again.
fn slope_of_gpu_gems(map: &Grid<f32>, p: [i32; 2]) -> (f64, f64) {
    const SEARCH_STEPS: u32 = 128;
    let n = [map.width() as i32, map.height() as i32];
    let height = |[x, y]: [f64; 2]| {
        let cell = [x.floor() as i32, y.floor() as i32];
        let [h00, h10, h01, h11] = corners(map, cell).map(f64::from);
        let [a, b] = [x - x.floor(), y - y.floor()];
        h00 * (1.0 - a) * (1.0 - b) + h10 * a * (1.0 - b) + h01 * (1.0 - a) * b + h11 * a * b
    };
    let source = p.map(f64::from);
    let top = height(source);
    let mut slope = 0.0f64;
    for x in -n[0] / 2..=n[0] / 2 {
        for y in -n[1] / 2..=n[1] / 2 {
            let direction = [f64::from(x), f64::from(y)];
            let destination = [source[0] + direction[0], source[1] + direction[1]];
            let depth = 1.0 - height(destination);
            if depth <= 0.0 || (x, y) == (0, 0) {
                continue;
            }
            let rest = (1.0 - depth) / depth / f64::from(SEARCH_STEPS);
            let at = |k: u32| 1.0 + f64::from(k) * rest;
            let point = |t: f64| [source[0] + direction[0] * t, source[1] + direction[1] * t];
            let mut k = 1;
            while k < SEARCH_STEPS && height(point(at(k))) >= 1.0 - at(k) * depth {
                k += 1;
            }
            let exit = 1.0 - at(k) * depth;
            if exit > top {
                slope = slope.max((exit - top) / (at(k) * direction[0].hypot(direction[1])));
            }
        }
    }
    (top, slope)
}

#[test]
fn the_generator_of_gpu_gems_is_caught() {
    let mut caught = 0;
    for (name, map) in
        small_maps().into_iter().filter(|(name, _)| name.starts_with("boxes") || name.starts_with("hills"))
    {
        let cones: Vec<_> = (0..map.texels().len() as i32)
            .map(|i| slope_of_gpu_gems(&map, [i % map.width() as i32, i / map.width() as i32]))
            .collect();
        // Its cones stand on texels: on their own ground, and with no rim.
        let mut random = Random(9);
        let mut left = 0;
        for _ in 0..20_000 {
            let i = random.next_u64() as usize % cones.len();
            let p = [i as i32 % map.width() as i32, i as i32 / map.width() as i32].map(f64::from);
            let (top, slope) = cones[i];
            let z = top + (1.0 - top) * f64::from(random.unit());
            let angle = f64::from(random.unit()) * std::f64::consts::TAU;
            let speed = 10f64.powf(4.0 * f64::from(random.unit()) - 0.5);
            let length = ((z - top) / (1.0 + speed * slope)).min(12.0 / speed);
            let direction = [angle.cos() * speed, angle.sin() * speed];
            left += u32::from(pierces_and_leaves(&map, p, direction, z - 1e-9, length).1);
        }
        println!("{name}: {left} of 20000 rays come up again inside the cones of GPU Gems 3");
        caught += left;
    }
    assert!(caught > 50, "only {caught}");
}

fn options(cones: Cones) -> MarchOptions {
    MarchOptions { technique: Technique::Cone, cones, max_layers: 4096.0, refine_steps: 64, ..MarchOptions::default() }
}

#[test]
fn through_conservative_cones_hits_are_those_of_the_plain_walk_to_the_last_bit() {
    let mut random = Random(5);
    for (name, heights) in maps() {
        for wrap in WRAPS {
            let (mut hits, mut cheap, mut dear) = (0, 0u64, 0u64);
            for i in 0..4000 {
                let field = heights.field(if i % 5 == 0 { 1.0 + (i % 3) as f32 } else { 0.0 }, wrap);
                let ray = ray(&mut random, field.size());
                let bounds = (i % 4 == 0).then_some(Bounds { min: [0.0; 2], max: [1.0; 2] });
                let options = MarchOptions {
                    bounds,
                    midlevel: if i % 8 == 0 { 0.6 } else { 1.0 },
                    ..options(Cones::Conservative)
                };
                let [found, truth] = [march(&field, &ray, &options), march(&WithoutPyramid(field), &ray, &options)];
                let same = |record: &Record| (record.uv, record.depth, record.hit);
                assert_eq!(same(&found), same(&truth), "{name} {wrap:?} {ray:?} {options:?}");
                hits += u32::from(found.hit);
                cheap += u64::from(found.fetches);
                dear += u64::from(truth.fetches);
            }
            assert!(hits > 2500, "{name} {wrap:?}: only {hits} hits");
            println!("{name:22} {wrap:?}: {cheap} fetches, {dear} cell by cell");
        }
    }
}

/// Returns true if a hit is the oracle's, or lies between those of the surface raised and lowered by what rounding in f32 comes to
/// over the ray's length; as in the tests of truth.
fn is_right(field: &impl HeightField, ray: &Ray, record: &Record) -> bool {
    let ray = OracleRay::from(ray);
    let size = field.size().map(f64::from);
    let reach = (0..2).map(|k| (ray.uv[k].abs() + ray.slope[k].abs()) * size[k]).fold(1.0, f64::max);
    let rounding = 2e-6 + (4.0 * f64::from(f32::EPSILON) * reach) as f32;
    let near = 0.05 / reach;
    let hit = |by: f32| oracle(&Raised(field, by), &ray, None).map_or(f64::NAN, |hit| hit.depth);
    let depth = f64::from(record.depth);
    record.hit && hit(rounding) - near <= depth && depth <= hit(-rounding) + near
}

#[test]
fn no_hit_through_cones_is_wrong_where_steps_suffice() {
    let (mut random, mut short) = (Random(77), 0);
    for (name, heights) in maps() {
        for wrap in WRAPS {
            for kind in Cones::ALL {
                let field = heights.field(0.0, wrap);
                let wrong = (0..3000)
                    .filter(|_| {
                        let ray = ray(&mut random, field.size());
                        let record = march(&field, &ray, &options(kind));
                        // Rays far beyond a stretched border run out of steps.
                        let suffice = kind == Cones::Conservative || record.iterations < 4096;
                        short += u32::from(!suffice);
                        suffice && !is_right(&field, &ray, &record)
                    })
                    .count();
                assert_eq!(wrong, 0, "{name} {wrap:?} {kind:?}");
            }
        }
    }
    assert!(short < 50, "{short} rays ran out of steps");
}

#[test]
fn relaxed_cones_take_no_more_steps_than_they_may() {
    let mut random = Random(3);
    let (_, heights) = maps().swap_remove(10);
    let field = heights.field(0.0, Wrap::Repeat);
    for steps in [1.0, 3.0, 8.0] {
        let options = MarchOptions { max_layers: steps, min_layers: 1.0, refine_steps: 4, ..options(Cones::Relaxed) };
        let mut cut_off = 0;
        for _ in 0..2000 {
            let ray = ray(&mut random, field.size());
            let record = march(&field, &ray, &options);
            assert!(record.hit && record.iterations <= steps as u32 + 4, "{record:?}");
            // What it has reached then lies above the surface.
            cut_off += u32::from(record.depth < 1.0 - field.sample(record.uv) - 1e-3);
        }
        assert!(cut_off > 20, "{steps} steps always suffice, which tests nothing");
    }
}

#[test]
fn a_field_without_cones_is_walked_cell_by_cell() {
    let map = HeightMap::new(noise([40, 30], 2));
    let heights = ReliefMap::new(&map);
    let field = heights.field(0.0, Wrap::Repeat);
    assert!(field.cones(Cones::Relaxed).is_none() && heights.cones(Cones::Conservative).is_none());
    let mut random = Random(8);
    for _ in 0..500 {
        let ray = ray(&mut random, field.size());
        let [a, b] = [march(&field, &ray, &options(Cones::Relaxed)), march(&field, &ray, &MarchOptions::default())];
        assert_eq!((a.uv, a.depth, a.hit), (b.uv, b.depth, b.hit));
    }
}

#[test]
fn heights_that_were_updated_have_new_cones() {
    let mut grid = noise([20, 16], 8);
    let mut heights = ReliefMap::with_mips(&HeightMap::new(grid.clone())).with_cones(Cones::Relaxed);
    grid.texels_mut()[77] = 0.01;
    let map = HeightMap::new(grid);
    heights.update(&map, TexelRect { min: [17, 3], size: [1, 1] });
    let new = ReliefMap::with_mips(&map).with_cones(Cones::Relaxed);
    assert!(heights.cones(Cones::Relaxed).is_some_and(|levels| levels.len() == 5));
    // The quantization of the updated pyramid is that of the old range, which is the new one here.
    assert_eq!(heights.cones(Cones::Relaxed), new.cones(Cones::Relaxed));
    assert!(heights.cones(Cones::Conservative).is_none());
}

#[test]
fn one_thread_builds_what_many_build() {
    let map = noise([150, 90], 6);
    let pyramid = MaxPyramid::build(&map, false);
    for kind in Cones::ALL {
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let many = rayon::ThreadPoolBuilder::new().num_threads(7).build().unwrap();
        let build = || ConeMap::build(&map, &pyramid, kind);
        assert_eq!(alone.install(build), many.install(build));
    }
}
