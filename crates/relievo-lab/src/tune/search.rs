use relievo_map::Wrap;
use relievo_march::{HeightField, ReliefMap, Technique};

use super::options::{ErrorUnit, TechniqueCost, TuneOptions};
use super::outcome::{Trial, TuneOutcome};
use crate::error::LabError;
use crate::material::{MaterialView, TestMaterial};
use crate::measure::{MarchBackend, Stopwatch, tiles, with_cones};
use crate::metric::HitEvaluator;
use crate::sweep::SweepProgress;
use crate::technique::ResolvedTechnique;

/// Angles that are tried, in degrees, up to the largest of the options, which is tried too.
const ANGLES: [f32; 9] = [0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 75.0, 80.0, 85.0];

/// Layers that are tried, along the normal and along the surface.
const LAYERS: [[u32; 2]; 9] =
    [[1, 16], [4, 16], [8, 32], [16, 64], [24, 96], [32, 128], [64, 256], [128, 512], [256, 1024]];

/// Size in pixels of the pictures for FLIP: every technique is drawn at each angle.
const FLIP_PIXELS: [u32; 2] = [96, 72];

/// Samples per pixel of the pictures for FLIP.
const FLIP_SAMPLES: u32 = 4;

/// Ratio of times up to which two techniques count as equally fast: the noise of measurement.
const EQUALLY_FAST: f64 = 1.05;

/// Fraction of misses above which the error counts as infinite.
const MAX_MISSES: f64 = 0.01;

/// Number of rays that a GPU is timed with, to be fully occupied.
const GPU_RAYS: u32 = 1 << 16;

/// The techniques that are tried, from the plainest to the finest. `none` is left out: `normal` costs the same.
fn techniques() -> Vec<ResolvedTechnique> {
    let mut list = Vec::new();
    for technique in Technique::ALL.into_iter().filter(|&technique| technique != Technique::None) {
        if ResolvedTechnique::of(technique).spec().has_layers() {
            list.extend(LAYERS.map(|layers| ResolvedTechnique::layered(technique, layers, None)));
        } else {
            list.push(ResolvedTechnique::of(technique));
        }
    }
    list
}

/// The angles that are tried, in descending order: most techniques fail at the largest.
fn angles(options: &TuneOptions) -> Vec<f32> {
    let mut angles: Vec<f32> = match options.unit {
        ErrorUnit::Flip => vec![0.0, 0.5 * options.angle_max],
        _ => ANGLES.into_iter().filter(|&angle| angle < options.angle_max).collect(),
    };
    angles.push(options.angle_max);
    angles.sort_by(|a, b| b.total_cmp(a));
    angles.dedup();
    angles
}

/// Finds the cheapest technique with settings that keeps the error at all angles up to the largest.
///
/// # Errors
/// If the options are out of range, or a backend fails.
pub fn tune(
    material: &TestMaterial,
    options: &TuneOptions,
    backend: &mut MarchBackend,
    progress: Option<&SweepProgress<'_>>,
) -> Result<TuneOutcome, LabError> {
    options.check()?;
    let mut angles = angles(options);
    let heights = with_cones(ReliefMap::new(&material.height), &techniques());
    backend.load(&heights)?;
    let mut trials: Vec<Trial> = (techniques().into_iter())
        .map(|technique| Trial { technique, error: 0.0, angle: 0.0, keeps: true, fetches: None, ns_per_ray: None })
        .collect();
    let steps = 2 * angles.len();
    let report = |step: &str, done: usize| progress.into_iter().for_each(|progress| progress(step, done, steps));
    for (done, &angle) in angles.iter().enumerate() {
        report("errors", done);
        let open: Vec<usize> = (0..trials.len()).filter(|&i| trials[i].keeps).collect();
        let list: Vec<ResolvedTechnique> = open.iter().map(|&i| trials[i].technique).collect();
        let errors = match options.unit {
            ErrorUnit::Flip => flip_errors(material, options, angle, &list)?,
            _ => hit_errors(&heights, options, angle, &list, backend)?,
        };
        for (&i, error) in open.iter().zip(errors) {
            let trial = &mut trials[i];
            if !(error <= trial.error) || done == 0 {
                (trial.error, trial.angle) = (error, angle);
            }
            trial.keeps = error <= options.max_error;
        }
    }
    // Techniques that keep the error are timed, and for comparison the default and the tutorials' rule.
    let compared = ["exact", "tutorials"].map(str::parse::<ResolvedTechnique>);
    let timed: Vec<usize> = (0..trials.len())
        .filter(|&i| trials[i].keeps || compared.iter().any(|c| c.as_ref() == Ok(&trials[i].technique)))
        .collect();
    let mut costs = vec![(0.0, 0.0); timed.len()];
    for (done, &angle) in angles.iter().enumerate() {
        report("costs", angles.len() + done);
        let list: Vec<ResolvedTechnique> = timed.iter().map(|&i| trials[i].technique).collect();
        for (sum, cost) in costs.iter_mut().zip(costs_at(&heights, options, angle, &list, backend)?) {
            *sum = (sum.0 + cost.0, sum.1 + cost.1);
        }
    }
    for (&i, (fetches, ns)) in timed.iter().zip(costs) {
        let count = angles.len() as f64;
        (trials[i].fetches, trials[i].ns_per_ray) = (Some(fetches / count), Some(ns / count));
    }
    let best = cheapest(&trials, options.cost);
    angles.reverse();
    Ok(TuneOutcome { trials, best, angles })
}

/// Hit errors of each technique at an angle: the 99th percentile.
fn hit_errors(
    heights: &ReliefMap,
    options: &TuneOptions,
    angle: f32,
    techniques: &[ResolvedTechnique],
    backend: &mut MarchBackend,
) -> Result<Vec<f64>, LabError> {
    let field = heights.field(0.0, Wrap::Repeat);
    let rays = tiles(field.size(), field.size().map(|n| options.depth / n as f32), angle, options.rays);
    let evaluator = HitEvaluator::new(&field, &rays, options.depth);
    techniques
        .iter()
        .map(|technique| {
            let errors = evaluator.errors(&backend.march(heights, 0.0, technique, &rays)?);
            let error = if options.unit == ErrorUnit::Pixels { errors.pixels } else { errors.texels };
            Ok(if errors.misses > MAX_MISSES { f64::INFINITY } else { error.p99 })
        })
        .collect()
}

/// Mean FLIP of each technique's picture at an angle.
fn flip_errors(
    material: &TestMaterial,
    options: &TuneOptions,
    angle: f32,
    techniques: &[ResolvedTechnique],
) -> Result<Vec<f64>, LabError> {
    let view = MaterialView { material, depth: options.depth, minification: 1, angle, size: FLIP_PIXELS };
    let comparison = view.compare(techniques.iter().map(ResolvedTechnique::spec).collect(), FLIP_SAMPLES)?;
    Ok(comparison.entries.iter().map(|entry| entry.flip.mean).collect())
}

/// Mean fetches and nanoseconds of a ray, of each technique at an angle.
fn costs_at(
    heights: &ReliefMap,
    options: &TuneOptions,
    angle: f32,
    techniques: &[ResolvedTechnique],
    backend: &mut MarchBackend,
) -> Result<Vec<(f64, f64)>, LabError> {
    let size = heights.size();
    let scale = size.map(|n| options.depth / n as f32);
    let rays = tiles(size, scale, angle, options.rays);
    let timed_rays = if backend.backend() == "gpu" { tiles(size, scale, angle, GPU_RAYS) } else { Vec::new() };
    let mut costs = Vec::new();
    for technique in techniques {
        let records = backend.march(heights, 0.0, technique, &rays)?;
        let fetches: u64 = records.iter().map(|record| u64::from(record.fetches)).sum();
        costs.push((fetches as f64 / records.len().max(1) as f64, Stopwatch::default()));
    }
    for _ in 0..options.rounds.max(1) {
        for (technique, cost) in techniques.iter().zip(&mut costs) {
            backend.time(heights, 0.0, technique, &rays, &timed_rays, &mut cost.1)?;
        }
    }
    Ok(costs.into_iter().map(|(fetches, watch)| (fetches, watch.ns_per_ray())).collect())
}

/// The cheapest trial that keeps the error; of equally cheap ones the plainest.
fn cheapest(trials: &[Trial], cost: TechniqueCost) -> Option<usize> {
    let kept = || trials.iter().enumerate().filter(|(_, trial)| trial.keeps);
    let by_fetches = |trial: &Trial| trial.fetches.unwrap_or(f64::INFINITY);
    let time = |trial: &Trial| trial.ns_per_ray.unwrap_or(f64::INFINITY);
    let fastest = kept().map(|(_, trial)| time(trial)).fold(f64::INFINITY, f64::min);
    kept()
        .filter(|(_, trial)| cost == TechniqueCost::Fetches || time(trial) <= fastest * EQUALLY_FAST)
        .min_by(|a, b| by_fetches(a.1).total_cmp(&by_fetches(b.1)))
        .map(|(i, _)| i)
}

#[cfg(test)]
mod tests {
    use relievo_map::{Grid, HeightMap};

    use super::*;
    use crate::corpus;

    fn tuned(map: HeightMap, options: &TuneOptions) -> TuneOutcome {
        tune(&TestMaterial::of_heights("x", map), options, &mut MarchBackend::Cpu, None).unwrap()
    }

    fn quick() -> TuneOptions {
        TuneOptions { rays: 1024, rounds: 1, cost: TechniqueCost::Fetches, ..TuneOptions::default() }
    }

    #[test]
    fn a_flat_map_needs_no_march_and_needles_need_the_exact_one() {
        let flat = tuned(HeightMap::new(Grid::filled(32, 32, 1.0)), &quick());
        assert_eq!(flat.best().unwrap().technique.to_string(), "normal");
        for cost in [TechniqueCost::Fetches, TechniqueCost::Time] {
            let needles = tuned(corpus("spikes", 128).unwrap(), &TuneOptions { cost, ..quick() });
            assert_eq!(needles.best().unwrap().technique.to_string(), "exact");
            let tutorials = needles.trial("tutorials").unwrap();
            assert!(!tutorials.keeps && tutorials.error > 1.0 && tutorials.fetches.is_some(), "{tutorials:?}");
        }
    }

    #[test]
    fn what_is_found_keeps_the_error_under_every_angle_and_nothing_cheaper_does() {
        let options = TuneOptions { max_error: 0.5, angle_max: 60.0, ..quick() };
        let tuned = tuned(relievo_make::make("cobbles", 128).unwrap().height.unwrap(), &options);
        let best = tuned.best().unwrap();
        assert!(best.keeps && best.error <= 0.5, "{best:?}");
        for trial in tuned.trials.iter().filter(|trial| trial.keeps) {
            assert!(trial.error <= 0.5 && trial.fetches >= best.fetches, "{trial:?} beside {best:?}");
        }
        assert!(tuned.trials.iter().any(|trial| !trial.keeps));
        assert_eq!(tuned.angles, [0.0, 15.0, 30.0, 45.0, 60.0]);
    }

    #[test]
    fn an_error_of_nothing_is_kept_by_nobody() {
        let tuned = tuned(corpus("noise", 64).unwrap(), &TuneOptions { max_error: 0.0, ..quick() });
        assert!(tuned.best().is_none());
    }

    #[test]
    fn errors_that_are_seen_can_be_kept_too() {
        let options = TuneOptions { max_error: 0.05, unit: ErrorUnit::Flip, angle_max: 30.0, ..quick() };
        let tuned = tuned(relievo_make::make("cobbles", 64).unwrap().height.unwrap(), &options);
        let best = tuned.best().unwrap();
        assert!(best.error <= 0.05 && tuned.trial("normal").is_some_and(|normal| !normal.keeps), "{best:?}");
    }

    #[test]
    fn odd_wishes_are_refused() {
        let map = || TestMaterial::of_heights("x", HeightMap::new(Grid::filled(2, 2, 1.0)));
        for options in [
            TuneOptions { angle_max: 90.0, ..quick() },
            TuneOptions { angle_max: f32::NAN, ..quick() },
            TuneOptions { max_error: f64::NAN, ..quick() },
            TuneOptions { depth: -1.0, ..quick() },
            TuneOptions { unit: ErrorUnit::Flip, angle_max: 88.0, ..quick() },
        ] {
            assert!(tune(&map(), &options, &mut MarchBackend::Cpu, None).is_err(), "{options:?}");
        }
    }
}
