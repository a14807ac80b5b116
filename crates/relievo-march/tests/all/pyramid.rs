//! The march through the pyramid against the plain walk over every cell: the same hits to the last bit.

use relievo_map::{Grid, HeightMap, Wrap};
use relievo_march::{
    Bounds, HeightField, MarchOptions, MaxPyramid, PyramidField, Ray, Record, ReliefMap, Shadow, Technique, TexelRect,
    TileEntry, WithoutPyramid, exact_loads, march, march_all, march_from, shadow, tile_entry,
};
use relievo_testkit::{Random, WRAPS, WithPyramid, generated, in_8_bits, noise, ray, spikes, tile};

/// Maps of all sorts and sizes.
fn maps() -> Vec<(&'static str, ReliefMap)> {
    let map = |grid: Grid<f32>| ReliefMap::with_mips(&HeightMap::new(grid));
    let wall = generated("brick-wall", 256);
    let hills =
        |x: u32, y: u32| 0.5 + 0.3 * (x as f32 * 0.05).sin() * (y as f32 * 0.08).cos() + 0.15 * (x as f32 * 0.6).sin();
    vec![
        ("brick wall", map(wall.grid().clone())),
        ("brick wall in 8 bits", map(in_8_bits(wall.grid()))),
        ("hills 300×77", map(Grid::from_fn(300, 77, hills))),
        ("hills in a narrow range", map(Grid::from_fn(64, 64, |x, y| 0.4 + 1e-3 * hills(x, y)))),
        ("noise 33×20", map(noise([33, 20], 1))),
        ("noise 4×64", map(noise([4, 64], 2))),
        ("noise 1×7", map(noise([1, 7], 3))),
        ("noise 5×1", map(noise([5, 1], 4))),
        ("one texel", map(Grid::from_fn(1, 1, |_, _| 0.4))),
        ("spikes 64×64", map(spikes([64, 64]))),
        ("one spike in 1000×1000", map(Grid::from_fn(1000, 1000, |x, y| if (x, y) == (700, 20) { 1.0 } else { 0.02 }))),
        ("flat 16×16", map(Grid::from_fn(16, 16, |_, _| 0.0))),
    ]
}

#[test]
fn hits_are_those_of_the_plain_walk_to_the_last_bit_for_no_more_fetches() {
    let mut random = Random(5);
    for (name, heights) in maps() {
        for wrap in WRAPS {
            let (mut hits, mut cheap, mut dear) = (0, 0u64, 0u64);
            for i in 0..4000 {
                let field = heights.field(if i % 5 == 0 { 1.0 + (i % 3) as f32 } else { 0.0 }, wrap);
                let ray = ray(&mut random, field.size());
                let bounds = (i % 4 == 0).then_some(Bounds { min: [0.0; 2], max: [1.0; 2] });
                let options =
                    MarchOptions { bounds, midlevel: if i % 8 == 0 { 0.6 } else { 1.0 }, ..MarchOptions::default() };
                let found = march(&field, &ray, &options);
                let truth = march(&WithoutPyramid(field), &ray, &options);
                let same = |a: &Record, b: &Record| (a.uv, a.depth, a.hit) == (b.uv, b.depth, b.hit);
                // Beyond a stretched border all cells are one, and its clearance is computed from another point.
                let nearly = |a: &Record, b: &Record| a.hit == b.hit && (a.depth - b.depth).abs() < 2e-6;
                let agrees = if wrap == Wrap::Clamp { nearly(&found, &truth) } else { same(&found, &truth) };
                assert!(agrees, "{name} {wrap:?} {ray:?} {options:?}: {found:?} for {truth:?}");
                hits += u32::from(found.hit);
                cheap += u64::from(found.fetches);
                dear += u64::from(truth.fetches);
                let light = Ray { uv: found.uv, ..ray };
                let [lit, truly] = [
                    shadow(&field, Shadow::Exact, &light, found.depth, &options),
                    shadow(&WithoutPyramid(field), Shadow::Exact, &light, found.depth, &options),
                ];
                assert_eq!(lit.factor, truly.factor, "{name} {wrap:?} {light:?} {options:?}");
            }
            assert!(hits > 2500, "{name} {wrap:?}: only {hits} hits");
            // Where the first cells decide, the pyramid is one load more.
            assert!(cheap <= dear + 4000, "{name} {wrap:?}: {cheap} fetches, {dear} without the pyramid");
        }
    }
}

/// Returns the highest point of a rectangle of cells, by brute force: corners wrap.
fn highest(map: &Grid<f32>, [x, y]: [u32; 2], cells: u32) -> f32 {
    let [w, h] = [map.width(), map.height()];
    let columns = x..(x + cells).min(w) + 1;
    columns.flat_map(|x| (y..(y + cells).min(h) + 1).map(move |y| *map.get(x % w, y % h))).fold(0.0, f32::max)
}

#[test]
fn every_height_of_every_level_bounds_its_block_from_above_and_closely() {
    for (size, eight_bit) in [([37, 22], false), ([64, 64], true), ([1, 1], false), ([300, 5], true), ([2, 130], false)]
    {
        let mut map = noise(size, 9);
        if eight_bit {
            map = in_8_bits(&map);
        }
        let pyramid = MaxPyramid::build(&map, eight_bit);
        let mut last = [0; 2];
        for (i, level) in pyramid.levels().enumerate() {
            let cells = 1u32 << (2 * i);
            last = level.size();
            for (k, node) in level.nodes().iter().enumerate() {
                for (child, &quantized) in node.iter().enumerate() {
                    let [k, child] = [k as u32, child as u32];
                    let at = [(k % last[0] * 4 + child % 4) * cells, (k / last[0] * 4 + child / 4) * cells];
                    if at[0] >= size[0] || at[1] >= size[1] {
                        assert_eq!(quantized, 0);
                        continue;
                    }
                    let (truth, bound) = (highest(&map, at, cells), pyramid.height(quantized));
                    let [_, step] = pyramid.quantization();
                    assert!(bound >= truth - 1.1e-3 * step, "{size:?} level {}: {bound} over {truth}", i + 1);
                    assert!(bound < truth + step, "{size:?} level {}: {bound} over {truth}", i + 1);
                    // What is a multiple of 1/255 is kept.
                    assert!(!eight_bit || (bound - truth).abs() < 1e-3 * step);
                }
            }
        }
        assert_eq!(last, [1, 1]);
    }
}

#[test]
fn an_update_gives_what_building_anew_gives() {
    let mut random = Random(21);
    for size in [[64, 64], [37, 22], [5, 3], [1, 1]] {
        let mut map = noise(size, 3);
        // The extremes stay, and with them the quantization.
        map.texels_mut()[0] = 0.0;
        *map.texels_mut().last_mut().unwrap() = 1.0;
        let mut pyramid = MaxPyramid::build(&map, false);
        for i in 0..200 {
            let min = size.map(|n| random.next_u64() as u32 % n);
            let extent = [0, 1].map(|k| random.next_u64() as u32 % (size[k] - min[k] + 1));
            for y in min[1]..min[1] + extent[1] {
                for x in min[0]..min[0] + extent[0] {
                    let i = (y * size[0] + x) as usize;
                    if i > 0 && i + 1 < map.texels().len() {
                        map.texels_mut()[i] = random.unit();
                    }
                }
            }
            pyramid.update(&map, TexelRect { min, size: extent }, false);
            assert_eq!(pyramid, MaxPyramid::build(&map, false), "{size:?}, update {i}: {min:?} {extent:?}");
        }
    }
}

#[test]
fn an_update_that_leaves_the_range_builds_anew() {
    let mut map = noise([20, 20], 3).map(|h| 0.25 + 0.5 * h);
    let mut pyramid = MaxPyramid::build(&map, false);
    map.texels_mut()[77] = 0.9;
    pyramid.update(&map, TexelRect { min: [17, 3], size: [1, 1] }, false);
    assert_eq!(pyramid, MaxPyramid::build(&map, false));
}

#[test]
fn heights_that_were_updated_march_as_new_ones() {
    let mut random = Random(33);
    let mut grid = noise([48, 40], 8);
    let mut heights = ReliefMap::with_mips(&HeightMap::new(grid.clone()));
    for x in 10..20 {
        for y in 30..35 {
            grid.texels_mut()[y * 48 + x] = 0.01;
        }
    }
    let map = HeightMap::new(grid);
    heights.update(&map, TexelRect { min: [10, 30], size: [10, 5] });
    let new = ReliefMap::with_mips(&map);
    for i in 0..3000 {
        let lod = (i % 4) as f32;
        let (a, b) = (heights.field(lod, Wrap::Repeat), new.field(lod, Wrap::Repeat));
        let ray = ray(&mut random, a.size());
        let [a, b] = [march(&a, &ray, &MarchOptions::default()), march(&b, &ray, &MarchOptions::default())];
        assert_eq!((a.uv, a.depth, a.hit), (b.uv, b.depth, b.hit), "{ray:?}");
    }
}

#[test]
fn rays_that_march_together_meet_what_an_update_has_raised() {
    let mut random = Random(34);
    // Raised beyond the map's own range, to heights that the quantization of 8-bit maps and of flat ones covers.
    for (low, is_8_bit) in [([0.2, 0.4], true), ([0.3, 0.3], false)] {
        let mut grid = noise([48, 40], 8).map(|h| ((low[0] + (low[1] - low[0]) * h) * 255.0).round() / 255.0);
        let mut pyramid = MaxPyramid::build(&grid, is_8_bit);
        for y in 10..20 {
            grid.texels_mut()[y * 48 + 10..y * 48 + 20].fill(204.0 / 255.0);
        }
        pyramid.update(&grid, TexelRect { min: [10; 2], size: [10; 2] }, is_8_bit);
        let heights = ReliefMap::new(&HeightMap::new(grid.clone()));
        let field = WithPyramid(heights.field(0.0, Wrap::Repeat), PyramidField::new(&grid, &pyramid, Wrap::Repeat));
        let rays: Vec<Ray> = (0..3000).map(|_| ray(&mut random, [48, 40])).collect();
        let mut records = vec![Record::default(); rays.len()];
        march_all(&field, &rays, &MarchOptions::default(), &mut records);
        for (ray, found) in rays.iter().zip(&records) {
            let alone = march(&field, ray, &MarchOptions::default());
            assert_eq!((found.uv, found.depth, found.hit), (alone.uv, alone.depth, alone.hit), "{low:?} {ray:?}");
        }
    }
}

#[test]
fn one_thread_builds_what_many_build() {
    let map = noise([301, 170], 5);
    let build = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| MaxPyramid::build(&map, false))
    };
    assert_eq!(build(1), build(7));
}

#[test]
fn a_tile_enters_above_all_its_hits_and_near_them_and_its_rays_hit_what_they_hit_alone() {
    let mut random = Random(77);
    for (name, heights) in maps() {
        for wrap in WRAPS {
            let field = heights.field(0.0, wrap);
            let size = field.size();
            let (mut entered, mut nearest_sum, mut fetches, mut alone) = (0.0, 0.0, 0u64, 0u64);
            for i in 0..100 {
                let options = MarchOptions { midlevel: if i % 4 == 0 { 0.4 } else { 1.0 }, ..MarchOptions::default() };
                let tile: Vec<Ray> = tile(ray(&mut random, size), size).collect();
                let entry = tile_entry(&field, &tile, &options);
                let records: Vec<Record> = tile.iter().map(|ray| march(&field, ray, &options)).collect();
                let nearest = records.iter().fold(1.0f32, |nearest, record| nearest.min(record.depth));
                assert!(entry.depth <= nearest + 1e-5, "{name} {wrap:?} {:?}: {entry:?} for {nearest}", tile[0]);
                for (ray, record) in tile.iter().zip(&records) {
                    let again = march_from(&field, ray, &options, entry.depth);
                    let same = again.hit == record.hit && (again.depth - record.depth).abs() < 1e-5;
                    assert!(same, "{name} {wrap:?} {ray:?} from {entry:?}: {again:?} for {record:?}");
                    fetches += u64::from(again.fetches);
                    alone += u64::from(record.fetches);
                }
                entered += entry.depth;
                nearest_sum += nearest;
            }
            assert!(fetches <= alone, "{name} {wrap:?}: {fetches} fetches, {alone} without the entry");
            if name.starts_with("brick wall") {
                assert!(entered > 0.5 * nearest_sum, "{name} {wrap:?}: enters at {entered}, hits at {nearest_sum}");
            }
        }
    }
}

#[test]
fn loads_by_kind_add_up_to_the_fetches_of_the_march() {
    let mut random = Random(91);
    for (name, heights) in maps() {
        let field = heights.field(0.0, Wrap::Repeat);
        let (mut nodes, mut gathers, mut cells) = (0, 0, 0);
        for _ in 0..500 {
            let ray = ray(&mut random, field.size());
            let loads = exact_loads(&field, &ray, &MarchOptions::default());
            assert_eq!(
                loads.nodes + loads.gathers,
                march(&field, &ray, &MarchOptions::default()).fetches,
                "{name} {ray:?}"
            );
            let plain = exact_loads(&WithoutPyramid(field), &ray, &MarchOptions::default());
            assert_eq!(
                (plain.nodes, plain.gathers),
                (0, march(&WithoutPyramid(field), &ray, &MarchOptions::default()).fetches)
            );
            (nodes, gathers, cells) = (nodes + loads.nodes, gathers + loads.gathers, cells + plain.gathers);
        }
        assert!(nodes >= 500 && gathers <= cells, "{name}: {nodes} nodes, {gathers} of {cells} cells");
    }
}

#[test]
fn tiles_of_which_nothing_is_known_enter_at_the_lid() {
    let heights = ReliefMap::new(&HeightMap::new(noise([16, 16], 1)));
    let field = heights.field(0.0, Wrap::Repeat);
    let good = Ray { uv: [0.5; 2], uv_delta: [0.1; 2], cos: 0.5 };
    let options = MarchOptions::default();
    assert_eq!(tile_entry(&field, &[], &options), TileEntry::default());
    assert_eq!(tile_entry(&field, &[good, Ray { cos: f32::NAN, ..good }], &options), TileEntry::default());
    assert_eq!(tile_entry(&WithoutPyramid(field), &[good], &options), TileEntry::default());
    assert!(tile_entry(&field, &[good], &options).fetches > 0);
    // Rays that have nothing in common.
    let apart: Vec<Ray> = (0..32)
        .map(|k| Ray { uv: [k as f32, -2.0 * k as f32], uv_delta: [(k % 5) as f32 - 2.0, 1.0], ..good })
        .collect();
    assert!(tile_entry(&field, &apart, &options).depth < 0.05);
}

#[test]
fn rays_that_march_together_hit_what_they_hit_alone_to_the_last_bit() {
    let mut random = Random(9);
    for (name, heights) in maps() {
        for wrap in WRAPS {
            for i in 0..48 {
                let field = heights.field(if i % 5 == 0 { 1.0 + (i % 3) as f32 } else { 0.0 }, wrap);
                let size = field.size();
                let mut rays: Vec<Ray> = match i % 3 {
                    // Tiles, rays that have nothing in common, and both, any number of them.
                    0 => tile(ray(&mut random, size), size).chain(tile(ray(&mut random, size), size)).collect(),
                    1 => (0..1 + random.next_u64() % 70).map(|_| ray(&mut random, size)).collect(),
                    _ => tile(ray(&mut random, size), size).chain((0..5).map(|_| ray(&mut random, size))).collect(),
                };
                if i % 6 == 1 {
                    let odd = [f32::NAN, f32::INFINITY, -1.0, 0.0, 1e30, 3e7];
                    for ray in &mut rays {
                        match random.next_u64() % 16 {
                            0 => ray.cos = odd[(random.next_u64() % 6) as usize],
                            1 => ray.uv[1] = odd[(random.next_u64() % 6) as usize],
                            2 => ray.uv_delta[0] = odd[(random.next_u64() % 6) as usize],
                            _ => (),
                        }
                    }
                }
                if i % 6 == 3 {
                    // Along rows and columns, from the middle of texels, under 45 degrees, and as good as flat.
                    let flat = [0.0, -0.0, 1e-42, -1e-42, 1e-36, -1e-36, 0.02, -0.5];
                    for ray in &mut rays {
                        for k in 0..2 {
                            if random.next_u64().is_multiple_of(2) {
                                let texel = random.next_u64() % u64::from(2 * size[k]);
                                ray.uv[k] = (texel as f32 + 0.5) / size[k] as f32;
                            }
                            if random.next_u64().is_multiple_of(2) {
                                ray.uv_delta[k] = flat[(random.next_u64() % 8) as usize];
                            }
                        }
                        if random.next_u64().is_multiple_of(4) {
                            (ray.uv[1], ray.uv_delta[1]) = (ray.uv[0], ray.uv_delta[0]);
                        }
                    }
                }
                let bounds = (i % 4 == 0).then_some(Bounds { min: [0.0; 2], max: [1.0; 2] });
                let options =
                    MarchOptions { bounds, midlevel: if i % 8 < 2 { 0.6 } else { 1.0 }, ..MarchOptions::default() };
                let mut records = vec![Record::default(); rays.len()];
                march_all(&field, &rays, &options, &mut records);
                for (ray, found) in rays.iter().zip(&records) {
                    let alone = march(&field, ray, &options);
                    let bits = |r: &Record| (r.uv.map(f32::to_bits), r.depth.to_bits(), r.hit);
                    // Beyond a stretched border the pyramid's march computes clearances from another point than the plain
                    // walk, whose hits these are there.
                    let plain = || bits(&march(&WithoutPyramid(field), ray, &options));
                    let agrees = bits(found) == bits(&alone) || (wrap == Wrap::Clamp && bits(found) == plain());
                    assert!(agrees, "{name} {wrap:?} {ray:?} {options:?}: {found:?} for {alone:?}");
                }
            }
        }
    }
}

#[test]
fn techniques_and_fields_that_do_not_march_together_do_so_one_by_one() {
    let mut random = Random(19);
    let heights = ReliefMap::new(&HeightMap::new(noise([33, 20], 1)));
    let field = heights.field(0.0, Wrap::Repeat);
    let rays: Vec<Ray> = tile(ray(&mut random, [33, 20]), [33, 20]).collect();
    let mut records = vec![Record::default(); rays.len()];
    for technique in Technique::ALL {
        let options = MarchOptions { technique, ..MarchOptions::default() };
        march_all(&WithoutPyramid(field), &rays, &options, &mut records);
        for (ray, record) in rays.iter().zip(&records) {
            assert_eq!(*record, march(&WithoutPyramid(field), ray, &options), "{technique:?}");
        }
    }
    march_all(&field, &[], &MarchOptions::default(), &mut []);
}
