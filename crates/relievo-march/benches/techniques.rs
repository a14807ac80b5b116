//! Rays per second of every technique on one thread. Compare each with `occlusion` (8..32 layers), the common choice.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use relievo_map::Wrap;
use relievo_march::{
    Cones, MarchOptions, MaxPyramid, Ray, ReliefMap, Shadow, Technique, TexelRect, WithoutPyramid, march, shadow,
};
use relievo_testkit::generated;

const SIDE: u32 = 128;

/// A coherent picture's worth of rays, `degrees` from the normal.
fn rays(degrees: f32) -> Vec<Ray> {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let view = [sin * 0.8, sin * 0.6, cos];
    (0..SIDE * SIDE)
        .map(|i| {
            let at = |k: u32| (k as f32 + 0.5) / SIDE as f32;
            Ray::from_view([at(i % SIDE), at(i / SIDE)], view, [0.05, -0.05])
        })
        .collect()
}

fn techniques(criterion: &mut Criterion) {
    let heights = ReliefMap::new(&generated("brick-wall", 512));
    let heights = heights.with_cones(Cones::Relaxed).with_cones(Cones::Conservative);
    let field = heights.field(0.0, Wrap::Repeat);
    for degrees in [0.0, 60.0, 80.0] {
        let rays = rays(degrees);
        let mut group = criterion.benchmark_group(format!("march/{degrees}deg"));
        group.throughput(Throughput::Elements(rays.len() as u64));
        for technique in Technique::ALL {
            let options = MarchOptions { technique, ..MarchOptions::default() };
            group.bench_with_input(BenchmarkId::from_parameter(technique.name()), &options, |bencher, options| {
                bencher.iter(|| rays.iter().map(|ray| march(&field, ray, options).depth).sum::<f32>());
            });
        }
        group.bench_function("cone, conservative", |bencher| {
            let options =
                MarchOptions { technique: Technique::Cone, cones: Cones::Conservative, ..MarchOptions::default() };
            bencher.iter(|| rays.iter().map(|ray| march(&field, ray, &options).depth).sum::<f32>());
        });
        group.bench_function("exact, cell by cell", |bencher| {
            let (field, options) = (WithoutPyramid(field), MarchOptions::default());
            bencher.iter(|| rays.iter().map(|ray| march(&field, ray, &options).depth).sum::<f32>());
        });
        group.finish();
        let mut group = criterion.benchmark_group(format!("shadow/{degrees}deg"));
        group.throughput(Throughput::Elements(rays.len() as u64));
        let options = MarchOptions::default();
        let lights: Vec<(Ray, f32)> = rays
            .iter()
            .map(|ray| {
                let record = march(&field, ray, &options);
                (Ray { uv: record.uv, uv_delta: ray.uv_delta.map(|s| -s), ..*ray }, record.depth)
            })
            .collect();
        for kind in [Shadow::Hard, Shadow::Soft, Shadow::Exact] {
            group.bench_with_input(BenchmarkId::from_parameter(kind.name()), &kind, |bencher, &kind| {
                bencher
                    .iter(|| lights.iter().map(|(ray, d)| shadow(&field, kind, ray, *d, &options).factor).sum::<f32>());
            });
        }
        group.finish();
    }
}

/// The pyramid of a map of 1024² texels, on all cores.
fn pyramid(criterion: &mut Criterion) {
    let map = generated("brick-wall", 1024);
    criterion.bench_function("pyramid/build 1024²", |bencher| bencher.iter(|| MaxPyramid::build(map.grid(), false)));
    let mut built = MaxPyramid::build(map.grid(), false);
    let dirty = TexelRect { min: [300, 500], size: [64, 64] };
    criterion.bench_function("pyramid/update 64² of 1024²", |bencher| {
        bencher.iter(|| built.update(map.grid(), dirty, false));
    });
}

criterion_group!(benches, techniques, pyramid);
criterion_main!(benches);
