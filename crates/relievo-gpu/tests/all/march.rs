//! The kernels give what the CPU gives, ray by ray.

use std::sync::OnceLock;

use relievo_gpu::{ComputeField, ComputeMarch, GpuError, HeightTexture, module_source};
use relievo_map::{Grid, HeightMap, Wrap};
use relievo_march::{
    Bounds, Cones, HeightField, MarchOptions, Ray, Record, ReliefMap, Shadow, Technique, WithoutPyramid, march, shadow,
};
use relievo_testkit::{Random, WRAPS, in_8_bits, spikes};

use crate::common::device::{Gpu, gpu};
use crate::common::tolerances::{DEPTH, OTHER_CREST, OTHER_SHADOW, SAME_COST, SHADOW, UV_TEXELS};

/// Rays per map, wrap mode and technique.
const RAYS: usize = 6_600;

struct Map {
    name: &'static str,
    heights: ReliefMap,
    texture: HeightTexture,
}

/// Made once for all tests of this file: cones take their time.
fn maps(gpu: &Gpu) -> &'static [Map] {
    static MAPS: OnceLock<Vec<Map>> = OnceLock::new();
    MAPS.get_or_init(|| make_maps(gpu))
}

fn make_maps(gpu: &Gpu) -> Vec<Map> {
    let noise = |x: u32, y: u32| Random(u64::from(x) << 32 | u64::from(y)).unit();
    let wall = relievo_make::brick_wall(512).unwrap().height.unwrap();
    let steps = HeightMap::new(in_8_bits(wall.grid()));
    [
        ("brick wall 512×512", ReliefMap::with_mips(&wall)),
        ("brick wall in 8 bits", ReliefMap::new(&steps).filtered_in_8_bits()),
        ("noise 33×20", ReliefMap::with_mips(&HeightMap::new(Grid::from_fn(33, 20, noise)))),
        ("one texel", ReliefMap::new(&HeightMap::new(Grid::from_fn(1, 1, |_, _| 0.4)))),
        ("spikes 64×64", ReliefMap::new(&HeightMap::new(spikes([64, 64])))),
    ]
    .into_iter()
    .map(|(name, heights)| {
        let heights = heights.with_cones(Cones::Relaxed).with_cones(Cones::Conservative);
        let texture = HeightTexture::new(&gpu.device, &gpu.queue, &heights).unwrap();
        Map { name, heights, texture }
    })
    .collect()
}

/// Rays from straight down to 3° above the surface, relief up to a quarter of a repeat deep.
fn rays(seed: u64) -> Vec<Ray> {
    let mut random = Random(seed);
    (0..RAYS)
        .map(|_| {
            let cos = 0.05 + 0.95 * random.unit();
            let (sin, angle) = ((1.0 - cos * cos).sqrt(), random.signed(std::f32::consts::PI));
            let depth = 0.02 + 0.23 * random.unit();
            let uv = [random.unit() * 1.4 - 0.2, random.unit() * 1.4 - 0.2];
            Ray { uv, uv_delta: [angle.cos() * sin * depth, angle.sin() * sin * depth], cos }
        })
        .collect()
}

/// Settings that between them use every field of `MarchOptions`; each with a mip level.
fn settings(technique: Technique) -> Vec<(MarchOptions, f32)> {
    let plain = MarchOptions { technique, refine_steps: 8, ..MarchOptions::default() };
    let bounds = Some(Bounds { min: [0.0; 2], max: [1.0; 2] });
    let conservative = MarchOptions { cones: Cones::Conservative, ..plain };
    vec![
        (plain, 0.0),
        (MarchOptions { offset_limiting: true, min_layers: 3.0, max_layers: 50.0, ..conservative }, 0.0),
        (MarchOptions { bounds, ..plain }, 0.0),
        (MarchOptions { bounds, midlevel: 0.3, ..conservative }, 0.0),
        (MarchOptions { midlevel: 0.7, refine_steps: 3, ..plain }, 1.6),
        (conservative, 2.0),
    ]
}

#[derive(Default)]
struct Agreement {
    rays: usize,
    hits: usize,
    other: usize,
    same_cost: usize,
    worst_texels: f32,
    worst_depth: f32,
}

impl Agreement {
    fn add(&mut self, cpu: &Record, gpu: &Record, size: [u32; 2]) {
        self.rays += 1;
        self.hits += usize::from(cpu.hit);
        self.same_cost += usize::from(cpu.fetches == gpu.fetches && cpu.iterations == gpu.iterations);
        let texels = (0..2).map(|k| (cpu.uv[k] - gpu.uv[k]).abs() * size[k] as f32).fold(0.0, f32::max);
        let depth = (cpu.depth - gpu.depth).abs();
        // Written so that NaN counts as other.
        if cpu.hit == gpu.hit && texels <= UV_TEXELS && depth <= DEPTH {
            self.worst_texels = self.worst_texels.max(texels);
            self.worst_depth = self.worst_depth.max(depth);
        } else {
            self.other += 1;
        }
    }

    fn holds(&self) -> bool {
        self.rays > 0
            && self.other as f64 <= OTHER_CREST * self.rays as f64
            && self.same_cost as f64 >= SAME_COST * self.rays as f64
    }
}

fn compared(kernels: &mut ComputeMarch, maps: &[Map], technique: Technique) -> Agreement {
    let mut all = Agreement::default();
    for (m, map) in maps.iter().enumerate() {
        for (w, wrap) in WRAPS.into_iter().enumerate() {
            let rays = rays((m * 3 + w) as u64);
            let settings = settings(technique);
            let mut part = Agreement::default();
            for (rays, (options, lod)) in rays.chunks(RAYS / settings.len()).zip(&settings) {
                let field = map.heights.field(*lod, wrap);
                let on_gpu =
                    kernels.march(ComputeField { heights: &map.texture, lod: *lod, wrap }, rays, options).unwrap();
                assert_eq!(on_gpu.len(), rays.len());
                for (ray, on_gpu) in rays.iter().zip(&on_gpu) {
                    let on_cpu = march(&field, ray, options);
                    part.add(&on_cpu, on_gpu, field.size());
                    all.add(&on_cpu, on_gpu, field.size());
                }
            }
            if !part.holds() {
                println!(
                    "  {} {wrap:?}: {} of {} rays differ, {} cost the same",
                    map.name, part.other, part.rays, part.same_cost
                );
            }
        }
    }
    all
}

#[test]
fn every_technique_finds_the_same_hits_at_the_same_cost() {
    let Some(gpu) = gpu() else { return };
    let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let maps = maps(gpu);
    let mut failed = Vec::new();
    for technique in Technique::ALL {
        let found = compared(&mut kernels, maps, technique);
        println!(
            "{:16} {} rays, {} hits: {:.4} % take another crest, the others within {:.5} texels and {:.1e} of depth; {:.3} % cost the same",
            technique.name(),
            found.rays,
            found.hits,
            found.other as f64 / found.rays as f64 * 100.0,
            found.worst_texels,
            found.worst_depth,
            found.same_cost as f64 / found.rays as f64 * 100.0
        );
        assert!(found.hits * 2 > found.rays, "{}: most rays miss, which tests nothing", technique.name());
        if !found.holds() {
            failed.push(technique.name());
        }
    }
    assert!(failed.is_empty(), "not the same: {failed:?}");
}

#[test]
fn every_shadow_is_the_same() {
    let Some(gpu) = gpu() else { return };
    let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let maps = maps(gpu);
    let mut failed = Vec::new();
    for kind in Shadow::ALL {
        let (mut points, mut shadowed, mut other, mut same_cost, mut worst) = (0, 0, 0, 0, 0.0f32);
        for (m, map) in maps.iter().enumerate() {
            for (w, wrap) in WRAPS.into_iter().enumerate() {
                let seed = (100 + m * 3 + w) as u64;
                let mut random = Random(seed);
                let settings = settings(Technique::Exact);
                for (rays, (options, lod)) in rays(seed).chunks(RAYS / settings.len()).zip(&settings) {
                    let field = map.heights.field(*lod, wrap);
                    // Points on the surface, and some above and below it, where approximate techniques end.
                    let lights: Vec<(Ray, f32)> = rays
                        .iter()
                        .map(|ray| (*ray, (1.0 - field.sample(ray.uv) + random.signed(0.05)).clamp(0.0, 1.0)))
                        .collect();
                    let on_gpu = kernels
                        .shadow(ComputeField { heights: &map.texture, lod: *lod, wrap }, kind, &lights, options)
                        .unwrap();
                    for ((light, depth), on_gpu) in lights.iter().zip(&on_gpu) {
                        let on_cpu = shadow(&field, kind, light, *depth, options);
                        points += 1;
                        shadowed += usize::from(on_cpu.factor < 0.9);
                        same_cost += usize::from(on_cpu.fetches == on_gpu.fetches);
                        let difference = (on_cpu.factor - on_gpu.factor).abs();
                        if difference <= SHADOW {
                            worst = worst.max(difference);
                        } else {
                            other += 1;
                        }
                    }
                }
            }
        }
        println!(
            "{:5} {points} points, {shadowed} in shadow: {:.4} % differ, the others by {worst:.1e}; {:.3} % cost the same",
            kind.name(),
            f64::from(other) / points as f64 * 100.0,
            same_cost as f64 / points as f64 * 100.0
        );
        assert!(kind == Shadow::None || shadowed * 20 > points, "{}: nothing is in shadow", kind.name());
        if f64::from(other) > OTHER_SHADOW * points as f64 || (same_cost as f64) < SAME_COST * points as f64 {
            failed.push(kind.name());
        }
    }
    assert!(failed.is_empty(), "not the same: {failed:?}");
}

#[test]
fn a_broken_shader_is_caught() {
    let Some(gpu) = gpu() else { return };
    let maps = maps(gpu);
    // Each a slip of one character that still compiles.
    let slips = [
        ("height", "uv * vec2f(field.size) - 0.5", "uv * vec2f(field.size) + 0.5", Technique::Basic),
        ("search", "found.t < found.surface", "found.t <= found.surface + 0.01", Technique::Steep),
        ("march_relief", "half *= 0.5", "half *= 0.6", Technique::Relief),
        ("walk", "kappa * at.x * at.y", "kappa * at.x * at.x", Technique::Exact),
        ("wrap_mirror", "vec2i(2 * n - 1 - k, -1)", "vec2i(2 * n - 2 - k, -1)", Technique::Exact),
        ("descent", "f32(highest)", "f32(highest) - 2.0", Technique::Exact),
        ("descent", "step * whole + grid.border_offset", "step * whole - grid.border_offset", Technique::Exact),
        (
            "descent",
            "row -= relievo_node_rows(field.size, level)",
            "row -= relievo_node_rows(field.size, level - 1u)",
            Technique::Exact,
        ),
        ("wrap_repeat", "select(index, n - 1, index < 0)", "select(index, n - 2, index < 0)", Technique::Exact),
        ("cone", "above - RELIEVO_CONE_RIM * slope", "above", Technique::Cone),
        ("cone", "x <= 0.0 && stepped", "x < 0.0 && stepped", Technique::Cone),
        ("cone", "clamp(index, vec2i(0)", "clamp(index + 1, vec2i(0)", Technique::Cone),
        ("cone", "line.height - middle <= surface", "line.height - middle > surface", Technique::Cone),
    ];
    for (module, right, wrong, technique) in slips {
        let source = module_source(module).unwrap();
        assert!(source.contains(right), "{module} has changed: choose another slip");
        let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
        kernels.set_module(module, source.replace(right, wrong));
        let found = compared(&mut kernels, maps, technique);
        assert!(!found.holds(), "{module} passes with {wrong:?}");
    }
}

#[test]
fn without_the_pyramid_hits_stay_and_every_cell_is_counted() {
    let Some(gpu) = gpu() else { return };
    let kernels = || ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let (mut plain, mut whole) = (kernels().without_pyramid(), kernels());
    let rays = rays(11);
    let options = MarchOptions { technique: Technique::Exact, ..MarchOptions::default() };
    for Map { name, heights, texture } in maps(gpu) {
        let field = ComputeField { heights: texture, lod: 0.0, wrap: Wrap::Repeat };
        let cells = WithoutPyramid(heights.field(0.0, Wrap::Repeat));
        let [found, with_pyramid] =
            [&mut plain, &mut whole].map(|kernels| kernels.march(field, &rays, &options).unwrap());
        let wanted: Vec<Record> = rays.iter().map(|ray| march(&cells, ray, &options)).collect();
        let differing = |costs: &[Record]| {
            costs.iter().zip(&wanted).filter(|(a, b)| a.fetches != b.fetches || a.iterations != b.iterations).count()
                as f64
                / rays.len() as f64
        };
        let (off, control) = (differing(&found), differing(&with_pyramid));
        eprintln!("{name}: cost differs for {off} of the rays, through the pyramid for {control}");
        assert!(off <= 1.0 - SAME_COST, "{name}: {off}");
        let hits = found.iter().zip(&wanted).filter(|(a, b)| a.hit != b.hit).count();
        assert!(hits as f64 <= OTHER_CREST * rays.len() as f64, "{name}: {hits}");
        assert!(heights.size() == [1, 1] || control > 0.5, "{name}: the pyramid saves nothing, {control}");
    }
}

#[test]
fn odd_rays_end_as_misses_and_odd_settings_end() {
    let Some(gpu) = gpu() else { return };
    let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let maps = maps(gpu);
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -f32::MAX, 0.0, -0.0, 1e-45, 1e-30, 1e30, -1.0];
    let mut rays = Vec::new();
    for a in odd {
        for b in odd {
            rays.push(Ray { uv: [a, 0.5], uv_delta: [b, 0.1], cos: 0.5 });
            rays.push(Ray { uv: [0.5, 0.5], uv_delta: [0.1, a], cos: b });
            rays.push(Ray { uv: [0.5, a], uv_delta: [0.0, 0.0], cos: b });
        }
    }
    for technique in Technique::ALL {
        for layers in odd {
            let options = MarchOptions {
                technique,
                min_layers: layers,
                max_layers: layers,
                refine_steps: u32::MAX,
                midlevel: layers,
                ..MarchOptions::default()
            };
            let field = ComputeField { heights: &maps[2].texture, lod: layers, wrap: Wrap::Mirror };
            for (ray, record) in rays.iter().zip(kernels.march(field, &rays, &options).unwrap()) {
                let away = !(ray.cos > 0.0) && !ray.cos.is_nan();
                assert!(!away || !record.hit, "{technique:?} {ray:?}: {record:?}");
                assert!(record.iterations <= relievo_march::MAX_CELLS, "{technique:?} {ray:?}: {record:?}");
            }
        }
    }
}

#[test]
fn nothing_in_nothing_out() {
    let Some(gpu) = gpu() else { return };
    let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let maps = maps(gpu);
    let field = ComputeField { heights: &maps[3].texture, lod: 0.0, wrap: Wrap::Repeat };
    assert_eq!(kernels.march(field, &[], &MarchOptions::default()).unwrap(), []);
}

#[test]
fn a_module_that_is_no_wgsl_is_an_error_that_says_where() {
    let Some(gpu) = gpu() else { return };
    let mut kernels = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let maps = maps(gpu);
    let field = ComputeField { heights: &maps[3].texture, lod: 0.0, wrap: Wrap::Repeat };
    kernels.set_module("march_exact", "//! #import walk\nfn relievo_march_exact() -> Nonsense {}\n");
    let error = kernels.march(field, &rays(1), &MarchOptions::default()).unwrap_err();
    assert!(matches!(&error, GpuError::Device(text) if text.contains("Nonsense")), "{error}");
    kernels.set_module("march_exact", "//! #import nowhere\n");
    let error = kernels.march(field, &rays(1), &MarchOptions::default()).unwrap_err();
    assert_eq!(error.to_string(), "march_exact.wgsl:1: there is no shader module \"nowhere\" to import");
}

#[test]
fn a_map_over_the_devices_limit_is_refused_with_advice() {
    let Some(gpu) = gpu() else { return };
    let side = gpu.device.limits().max_texture_dimension_2d;
    if side >= Grid::<f32>::MAX_SIDE {
        eprintln!("skipped: this device takes every map");
        return;
    }
    let heights = ReliefMap::new(&HeightMap::new(Grid::from_fn(side + 1, 1, |_, _| 0.5)));
    let error = HeightTexture::new(&gpu.device, &gpu.queue, &heights).unwrap_err();
    let text = error.to_string();
    assert!(matches!(error, GpuError::TextureTooLarge { .. }), "{text}");
    assert!(text.contains(&side.to_string()) && text.contains("using_resolution"), "{text}");
}
