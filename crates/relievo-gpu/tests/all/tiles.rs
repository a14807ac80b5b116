//! The coarse pass for tiles of rays gives what the CPU's gives, and no ray loses its hit by it.

use relievo_gpu::{ComputeField, ComputeMarch, HeightTexture, module_source};
use relievo_map::{Grid, HeightMap, Wrap};
use relievo_march::{Bounds, MarchOptions, Ray, ReliefMap, Technique, TileEntry, march, march_from, tile_entry};
use relievo_testkit::{Random, WRAPS, in_8_bits};

use crate::common::device::{Gpu, gpu};
use crate::common::tolerances::{DEPTH, OTHER_CREST, SAME_COST};

const TILES: usize = 300;

fn maps() -> Vec<(&'static str, ReliefMap)> {
    let noise = |x: u32, y: u32| Random(u64::from(x) << 32 | u64::from(y)).unit();
    let wall = relievo_make::brick_wall(256).unwrap().height.unwrap();
    let steps = HeightMap::new(in_8_bits(wall.grid()));
    let spike = |x: u32, y: u32| if (x, y) == (700, 20) { 1.0 } else { 0.02 };
    vec![
        ("brick wall", ReliefMap::with_mips(&wall)),
        ("brick wall in 8 bits", ReliefMap::new(&steps)),
        ("noise 33×20", ReliefMap::new(&HeightMap::new(Grid::from_fn(33, 20, noise)))),
        ("noise 5×1", ReliefMap::new(&HeightMap::new(Grid::from_fn(5, 1, noise)))),
        ("one texel", ReliefMap::new(&HeightMap::new(Grid::from_fn(1, 1, |_, _| 0.4)))),
        ("one spike in 1000×300", ReliefMap::new(&HeightMap::new(Grid::from_fn(1000, 300, spike)))),
    ]
}

/// Tiles of eight by four neighbours that see the relief in perspective; the last is not full.
fn tiles(size: [u32; 2], seed: u64) -> Vec<Ray> {
    let mut random = Random(seed);
    let mut rays = Vec::new();
    for _ in 0..TILES {
        let (sin, cos) = (1.54 * random.unit()).sin_cos();
        let (y, x) = random.signed(std::f32::consts::PI).sin_cos();
        let depth = (1.0 + 60.0 * random.unit()) / size[0].max(size[1]).max(16) as f32;
        let uv = [random.unit() * 3.0 - 1.0, random.unit() * 3.0 - 1.0];
        // Of all sizes, up to those that a tile says nothing of.
        let pixel = 4.0 * random.unit().powi(4) + 0.2;
        rays.extend((0..ComputeMarch::TILE).map(|k| {
            let at = [(k % 8) as f32, (k / 8) as f32];
            Ray {
                uv: [0, 1].map(|k| uv[k] + pixel * at[k] / size[k] as f32),
                uv_delta: [depth * sin * x * (1.0 + 0.002 * at[0]), depth * sin * y * (1.0 + 0.002 * at[1])],
                cos: cos * (1.0 + 0.001 * at[1]),
            }
        }));
    }
    rays.truncate(rays.len() - 5);
    // A ray that no march takes spoils its tile, and that alone.
    rays[40].cos = -1.0;
    rays
}

#[derive(Debug, Default)]
struct Found {
    tiles: usize,
    other_entry: usize,
    same_cost: usize,
    rays: usize,
    /// Another record than the CPU's from the same entry.
    other: usize,
    /// Another hit than without the coarse pass.
    lost: usize,
    with: u64,
    entries: u64,
    alone: u64,
}

fn compared(gpu: &Gpu, kernels: &mut ComputeMarch, name: &str, heights: &ReliefMap, wrap: Wrap) -> Found {
    let texture = HeightTexture::new(&gpu.device, &gpu.queue, heights).unwrap();
    let mut found = Found::default();
    let whole = Some(Bounds { min: [0.0; 2], max: [1.0; 2] });
    let plain = MarchOptions::default();
    for (i, options) in
        [plain, MarchOptions { midlevel: 0.4, ..plain }, MarchOptions { bounds: whole, ..plain }].iter().enumerate()
    {
        let lod = if i == 1 { 1.0 } else { 0.0 };
        let rays = tiles(heights.size(), i as u64);
        let field = heights.field(lod, wrap);
        let on_gpu = ComputeField { heights: &texture, lod, wrap };
        let (records, entries) = kernels.march_tiles(on_gpu, &rays, options).unwrap();
        assert_eq!((records.len(), entries.len()), (rays.len(), TILES));
        let tiles = rays.chunks(ComputeMarch::TILE).zip(records.chunks(ComputeMarch::TILE));
        for ((rays, records), entry) in tiles.zip(&entries) {
            let expected: TileEntry = tile_entry(&field, rays, options);
            found.tiles += 1;
            found.same_cost += usize::from(entry.fetches == expected.fetches);
            found.other_entry += usize::from(!((entry.depth - expected.depth).abs() <= DEPTH));
            found.entries += u64::from(entry.fetches);
            for (ray, record) in rays.iter().zip(records) {
                let [from, alone] = [march_from(&field, ray, options, entry.depth), march(&field, ray, options)];
                let differs = |depth: f32, hit: bool| hit != record.hit || !((depth - record.depth).abs() <= DEPTH);
                found.rays += 1;
                found.other += usize::from(differs(from.depth, from.hit));
                found.lost += usize::from(differs(alone.depth, alone.hit));
                found.with += u64::from(record.fetches);
                found.alone += u64::from(alone.fetches);
            }
        }
    }
    println!("{name} {wrap:?}: {found:?}");
    found
}

impl Found {
    fn holds(&self) -> bool {
        let few = |some: usize, all: usize| some as f64 <= OTHER_CREST * all as f64;
        few(self.other_entry, self.tiles)
            && few(self.other, self.rays)
            && few(self.lost, self.rays)
            && self.same_cost as f64 >= SAME_COST * self.tiles as f64
    }
}

#[test]
fn tiles_enter_where_the_cpu_enters_and_rays_hit_what_they_hit_alone_for_fewer_fetches() {
    let Some(gpu) = gpu() else { return };
    let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    for (name, heights) in maps() {
        for wrap in WRAPS {
            let found = compared(gpu, &mut kernels, name, &heights, wrap);
            assert!(found.holds(), "{name} {wrap:?}: {found:?}");
            assert!(found.with <= found.alone, "{name} {wrap:?}: {found:?}");
            if name.starts_with("brick wall") {
                assert!(found.with + found.entries < found.alone, "{name} {wrap:?}: {found:?}");
            }
        }
    }
}

#[test]
fn an_entry_that_is_too_deep_or_not_the_cpus_is_caught() {
    let Some(gpu) = gpu() else { return };
    let (name, heights) = maps().swap_remove(1);
    for (module, right, wrong) in [
        ("beam", "- slack;\n        if free", "+ 4.0 * code;\n        if free"),
        ("beam", "max(beam.high, at)", "min(beam.high, at)"),
        ("beam", "level -= 1u", "level -= 0u"),
        ("span", "inside.x), entry)", "inside.x), entry + 0.01)"),
    ] {
        let source = module_source(module).unwrap();
        assert!(source.contains(right), "{module} has changed: choose another slip");
        let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
        kernels.set_module(module, source.replace(right, wrong));
        assert!(!compared(gpu, &mut kernels, name, &heights, Wrap::Repeat).holds(), "{module} passes with {wrong:?}");
    }
}

#[test]
fn techniques_that_know_no_entry_march_as_ever() {
    let Some(gpu) = gpu() else { return };
    let (_, heights) = maps().swap_remove(0);
    let texture = HeightTexture::new(&gpu.device, &gpu.queue, &heights).unwrap();
    let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let field = ComputeField { heights: &texture, lod: 0.0, wrap: Wrap::Repeat };
    let rays = tiles(heights.size(), 3);
    for technique in [Technique::Occlusion, Technique::Basic] {
        let options = MarchOptions { technique, ..MarchOptions::default() };
        assert_eq!(
            kernels.march_tiles(field, &rays, &options).unwrap().0,
            kernels.march(field, &rays, &options).unwrap()
        );
    }
    assert_eq!(kernels.march_tiles(field, &[], &MarchOptions::default()).unwrap(), (vec![], vec![]));
}
