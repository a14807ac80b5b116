use std::time::Instant;

use relievo_map::Wrap;
use relievo_march::{HeightField, MaxPyramid, Ray, ReliefMap, Technique, exact_loads};

use super::figures::HitRow;
use super::job::SweepJob;
use super::options::SweepOptions;
use crate::error::LabError;
use crate::measure::{MarchBackend, Stopwatch, tiles};
use crate::metric::HitEvaluator;
use crate::technique::ResolvedTechnique;

/// Smallest number of rays that a GPU is timed with, to be fully occupied.
const GPU_RAYS: u32 = 1 << 16;

/// Judges and times all techniques of a job under all angles.
pub(super) fn measure_hits(
    job: &SweepJob<'_>,
    options: &SweepOptions,
    backend: &mut MarchBackend,
    heights: &ReliefMap,
) -> Result<Vec<HitRow>, LabError> {
    let last = heights.levels().len() - 1;
    let level = (job.minification.ilog2() as usize).min(last);
    let field = heights.field(level as f32, Wrap::Repeat);
    let (full, size) = (heights.size(), field.size());
    let depth = full.map(|n| job.depth / n as f32);
    // In texels of the level.
    let level_depth = depth[0] * size[0] as f32;
    let texel_bytes = 4 * u64::from(size[0]) * u64::from(size[1]);
    let (build_ms, pyramid_bytes) = pyramid_cost(heights, level);
    backend.load(heights)?;
    let mut rows = Vec::new();
    for &angle in &options.angles {
        let rays = tiles(size, depth, angle, options.rays);
        let timed_rays = match backend.backend() {
            "gpu" => tiles(size, depth, angle, options.rays.max(GPU_RAYS)),
            _ => Vec::new(),
        };
        let evaluator = HitEvaluator::new(&field, &rays, level_depth);
        let first = rows.len();
        for technique in &options.techniques {
            let records = backend.march(heights, level as f32, technique, &rays)?;
            let mut row = HitRow {
                material: job.material.name.clone(),
                backend: backend.backend().to_owned(),
                technique: technique.to_string(),
                depth_texels: job.depth,
                minification: job.minification,
                angle,
                hits: evaluator.errors(&records),
                bytes: texel_bytes,
                ..HitRow::default()
            };
            count_fetches(&mut row, technique, &field, &rays);
            if technique.technique() == Technique::Exact && !technique.is_cell_by_cell() {
                row.bytes += pyramid_bytes;
                row.build_ms = build_ms;
            }
            rows.push(row);
        }
        // Interleaved rounds: a disturbance of the machine hits all techniques alike.
        let mut watches = vec![Stopwatch::default(); options.techniques.len()];
        for _ in 0..options.rounds {
            for (technique, watch) in options.techniques.iter().zip(&mut watches) {
                backend.time(heights, level as f32, technique, &rays, &timed_rays, watch)?;
            }
        }
        for (row, watch) in rows[first..].iter_mut().zip(&watches) {
            row.ns_per_ray = watch.ns_per_ray();
        }
    }
    Ok(rows)
}

/// Sets the mean fetches by kind. Those of a GPU equal those of the CPU, by test.
fn count_fetches(row: &mut HitRow, technique: &ResolvedTechnique, field: &impl HeightField, rays: &[Ray]) {
    let fetches = row.hits.fetches.mean;
    if technique.is_cell_by_cell() {
        row.gathers = fetches;
    } else if technique.technique() == Technique::Exact {
        let options = technique.march_options();
        let gathers: u64 = rays.iter().map(|ray| u64::from(exact_loads(field, ray, &options).gathers)).sum();
        row.gathers = gathers as f64 / rays.len().max(1) as f64;
        row.nodes = fetches - row.gathers;
    } else if technique.technique() == Technique::Cone {
        row.nodes = fetches;
    } else {
        row.samples = fetches;
    }
}

/// Time to build the pyramid of a level in milliseconds (the best of three), and its bytes.
fn pyramid_cost(heights: &ReliefMap, level: usize) -> (f64, u64) {
    let map = &heights.levels()[level];
    let exact_codes = level == 0 && heights.quantization_step() > 0.0;
    let build = || {
        let start = Instant::now();
        let bytes = MaxPyramid::build(map, exact_codes).bytes() as u64;
        (start.elapsed().as_secs_f64() * 1e3, bytes)
    };
    let first = build();
    (0..2).map(|_| build()).fold(first, |best, (ms, _)| (best.0.min(ms), best.1))
}
