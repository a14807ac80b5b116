//! The cheapest technique that keeps an error.

mod scene_file;

use relievo_map::Wrap;
use relievo_march::{HeightField, ReliefMap, Technique};
use serde::Serialize;

pub use scene_file::{Tuning, edit_scene, new_scene};

use crate::sweep::{Stopwatch, View, tiles, with_cones};
use crate::{Candidate, HitEvaluator, LabError, MarchBackend, PictureOptions, SweepProgress, TestMaterial};

/// Angles that are tried, in degrees, up to the largest that is asked for, which is tried too.
const ANGLES: [f32; 9] = [0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 75.0, 80.0, 85.0];

/// Layers that are tried along the normal and along the surface.
const LAYERS: [[u32; 2]; 9] =
    [[1, 16], [4, 16], [8, 32], [16, 64], [24, 96], [32, 128], [64, 256], [128, 512], [256, 1024]];

/// Pixels of the pictures that FLIP judges: all candidates are drawn under each angle.
const FLIP_PIXELS: [u32; 2] = [96, 72];

/// Candidates whose times differ by less are equally fast: the rest of it is noise.
const EQUALLY_FAST: f64 = 1.05;

/// What an error is measured in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ErrorUnit {
    /// The distance in uv that 99 % of the hits keep to the oracle's, in texels.
    #[default]
    Texels,
    /// The same in pixels of one texel: what lies along the view is shortened as the screen does.
    Pixels,
    /// Mean FLIP of a picture against displaced geometry, 0 to 1.
    Flip,
}

impl ErrorUnit {
    /// All units with their names.
    pub const ALL: [(&'static str, Self); 3] =
        [("texels", Self::Texels), ("pixels", Self::Pixels), ("flip", Self::Flip)];

    /// The unit as it stands behind a number.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Texels => "texels",
            Self::Pixels => "pixels",
            Self::Flip => "FLIP",
        }
    }
}

/// What is to be low.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cost {
    /// The measured time of a ray: right for this machine, and never twice the same.
    #[default]
    Time,
    /// The mean fetches of a ray, of whatever kind: the same everywhere.
    Fetches,
}

impl Cost {
    /// All kinds with their names.
    pub const ALL: [(&'static str, Self); 2] = [("time", Self::Time), ("fetches", Self::Fetches)];
}

/// What is asked of a technique.
#[derive(Clone, Debug, PartialEq)]
pub struct TuneOptions {
    /// The largest error that is allowed, under every angle.
    pub max_error: f64,
    /// What that is measured in.
    pub unit: ErrorUnit,
    /// The largest angle from the normal, in degrees, 0 to 89.9 (85 for FLIP).
    pub angle_max: f32,
    /// The full depth, in texels along u.
    pub depth: f32,
    /// What is to be low.
    pub cost: Cost,
    /// Rays per angle.
    pub rays: u32,
    /// How often each march is timed; the best round counts.
    pub rounds: u32,
}

impl Default for TuneOptions {
    fn default() -> Self {
        Self {
            max_error: 1.0,
            unit: ErrorUnit::default(),
            angle_max: 80.0,
            depth: 25.0,
            cost: Cost::default(),
            rays: 4096,
            rounds: 5,
        }
    }
}

/// A candidate that was tried.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Trial {
    /// The candidate.
    #[serde(serialize_with = "by_name")]
    pub candidate: Candidate,
    /// Its largest error under the angles that were looked at.
    pub error: f64,
    /// The angle of that error, in degrees.
    pub angle: f32,
    /// Whether it keeps the error under every angle.
    pub keeps: bool,
    /// Mean fetches of a ray over the angles; `None` where it was not measured, as it does not keep the error.
    pub fetches: Option<f64>,
    /// Mean nanoseconds of a ray over the angles; likewise.
    pub ns_per_ray: Option<f64>,
}

fn by_name<S: serde::Serializer>(candidate: &Candidate, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(candidate)
}

/// What tuning found.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tuned {
    /// All that was tried, from the plainest to the finest.
    pub trials: Vec<Trial>,
    /// The cheapest of those that keep the error; `None` if none does.
    pub best: Option<usize>,
    /// The angles that were looked at, in degrees.
    pub angles: Vec<f32>,
}

impl Tuned {
    /// The cheapest candidate that keeps the error.
    #[must_use]
    pub fn best(&self) -> Option<&Trial> {
        self.trials.get(self.best?)
    }

    /// The trial of a candidate by its name.
    #[must_use]
    pub fn trial(&self, candidate: &str) -> Option<&Trial> {
        let candidate: Candidate = candidate.parse().ok()?;
        self.trials.iter().find(|trial| trial.candidate == candidate)
    }
}

/// What is tried, from the plainest to the finest. `none` is left out: where it would do, `normal` costs the same.
fn candidates() -> Vec<Candidate> {
    let mut list = Vec::new();
    for technique in Technique::ALL.into_iter().filter(|&technique| technique != Technique::None) {
        if Candidate::of(technique).contender().has_layers() {
            list.extend(LAYERS.map(|layers| Candidate::layered(technique, layers, None)));
        } else {
            list.push(Candidate::of(technique));
        }
    }
    list
}

/// Finds the cheapest technique with settings that keeps the error under all angles up to the largest.
///
/// # Errors
/// If the options cannot be, or a backend fails.
pub fn tune(
    material: &TestMaterial,
    options: &TuneOptions,
    bench: &mut MarchBackend,
    progress: Option<&SweepProgress<'_>>,
) -> Result<Tuned, LabError> {
    check(options)?;
    let mut angles: Vec<f32> = ANGLES.into_iter().filter(|&angle| angle < options.angle_max).collect();
    angles.push(options.angle_max);
    if options.unit == ErrorUnit::Flip {
        angles = vec![0.0, 0.5 * options.angle_max, options.angle_max];
    }
    // The steepest first: most fail there.
    angles.sort_by(|a, b| b.total_cmp(a));
    angles.dedup();
    let heights = with_cones(ReliefMap::new(&material.height), &candidates());
    bench.load(&heights)?;
    let mut trials: Vec<Trial> = (candidates().into_iter())
        .map(|candidate| Trial { candidate, error: 0.0, angle: 0.0, keeps: true, fetches: None, ns_per_ray: None })
        .collect();
    let steps = 2 * angles.len();
    let told = |what: &str, done: usize| progress.into_iter().for_each(|progress| progress(what, done, steps));
    for (done, &angle) in angles.iter().enumerate() {
        told("errors", done);
        let open: Vec<usize> = (0..trials.len()).filter(|&i| trials[i].keeps).collect();
        let list: Vec<Candidate> = open.iter().map(|&i| trials[i].candidate).collect();
        let errors = match options.unit {
            ErrorUnit::Flip => by_picture(material, options, angle, &list)?,
            _ => by_hits(&heights, options, angle, &list, bench)?,
        };
        for (&i, error) in open.iter().zip(errors) {
            let trial = &mut trials[i];
            if !(error <= trial.error) || done == 0 {
                (trial.error, trial.angle) = (error, angle);
            }
            trial.keeps = error <= options.max_error;
        }
    }
    // Those that keep it are timed; so are the default and the tutorials' rule, for comparison.
    let compared = ["exact", "tutorials"].map(str::parse::<Candidate>);
    let timed: Vec<usize> = (0..trials.len())
        .filter(|&i| trials[i].keeps || compared.iter().any(|c| c.as_ref() == Ok(&trials[i].candidate)))
        .collect();
    let mut costs = vec![(0.0, 0.0); timed.len()];
    for (done, &angle) in angles.iter().enumerate() {
        told("costs", angles.len() + done);
        let list: Vec<Candidate> = timed.iter().map(|&i| trials[i].candidate).collect();
        for (sum, cost) in costs.iter_mut().zip(cost_at(&heights, options, angle, &list, bench)?) {
            *sum = (sum.0 + cost.0, sum.1 + cost.1);
        }
    }
    for (&i, (fetches, ns)) in timed.iter().zip(costs) {
        let share = angles.len() as f64;
        (trials[i].fetches, trials[i].ns_per_ray) = (Some(fetches / share), Some(ns / share));
    }
    let best = cheapest(&trials, options.cost);
    angles.reverse();
    Ok(Tuned { trials, best, angles })
}

fn check(options: &TuneOptions) -> Result<(), LabError> {
    let refused = |text: String| Err(LabError::Options(text));
    let most = if options.unit == ErrorUnit::Flip { 85.0 } else { 89.9 };
    if !(0.0..=most).contains(&options.angle_max) {
        return refused(format!("the largest angle must be 0 to {most}°, not {}", options.angle_max));
    }
    if !(options.max_error >= 0.0) {
        return refused(format!("the largest error must be a number from 0 on, not {}", options.max_error));
    }
    if !(0.0..=4096.0).contains(&options.depth) {
        return refused(format!("a depth of {} texels cannot be tuned for: it must be 0 to 4096", options.depth));
    }
    Ok(())
}

fn by_hits(
    heights: &ReliefMap,
    options: &TuneOptions,
    angle: f32,
    candidates: &[Candidate],
    bench: &mut MarchBackend,
) -> Result<Vec<f64>, LabError> {
    let field = heights.field(0.0, Wrap::Repeat);
    let rays = tiles(field.size(), field.size().map(|n| options.depth / n as f32), angle, options.rays);
    let judge = HitEvaluator::new(&field, &rays, options.depth);
    candidates
        .iter()
        .map(|candidate| {
            let figures = judge.figures(&bench.march(heights, 0.0, candidate, &rays)?);
            let error = if options.unit == ErrorUnit::Pixels { figures.pixels } else { figures.texels };
            // What hits nothing is off by any distance.
            Ok(if figures.misses > 0.01 { f64::INFINITY } else { error.p99 })
        })
        .collect()
}

fn by_picture(
    material: &TestMaterial,
    options: &TuneOptions,
    angle: f32,
    candidates: &[Candidate],
) -> Result<Vec<f64>, LabError> {
    let pictures = PictureOptions { size: FLIP_PIXELS, ..PictureOptions::default() };
    let view = View { material, depth: options.depth, minification: 1, angle, options: &pictures };
    let comparison = view.compare(candidates.iter().map(Candidate::contender).collect())?;
    Ok(comparison.entries.iter().map(|entry| entry.flip.mean).collect())
}

/// Mean fetches and nanoseconds of a ray, of each candidate.
fn cost_at(
    heights: &ReliefMap,
    options: &TuneOptions,
    angle: f32,
    candidates: &[Candidate],
    bench: &mut MarchBackend,
) -> Result<Vec<(f64, f64)>, LabError> {
    let size = heights.size();
    let scale = size.map(|n| options.depth / n as f32);
    let rays = tiles(size, scale, angle, options.rays);
    let many = if bench.backend() == "gpu" { tiles(size, scale, angle, 1 << 16) } else { Vec::new() };
    let mut costs = Vec::new();
    for candidate in candidates {
        let records = bench.march(heights, 0.0, candidate, &rays)?;
        let fetches: u64 = records.iter().map(|record| u64::from(record.fetches)).sum();
        costs.push((fetches as f64 / records.len().max(1) as f64, Stopwatch::default()));
    }
    for _ in 0..options.rounds.max(1) {
        for (candidate, cost) in candidates.iter().zip(&mut costs) {
            bench.time(heights, 0.0, candidate, &rays, &many, &mut cost.1)?;
        }
    }
    Ok(costs.into_iter().map(|(fetches, watch)| (fetches, watch.ns_per_ray())).collect())
}

/// Of those that keep the error the cheapest; of equally cheap ones the plainest.
fn cheapest(trials: &[Trial], cost: Cost) -> Option<usize> {
    let kept = || trials.iter().enumerate().filter(|(_, trial)| trial.keeps);
    let by_fetches = |trial: &Trial| trial.fetches.unwrap_or(f64::INFINITY);
    let time = |trial: &Trial| trial.ns_per_ray.unwrap_or(f64::INFINITY);
    let fastest = kept().map(|(_, trial)| time(trial)).fold(f64::INFINITY, f64::min);
    kept()
        .filter(|(_, trial)| cost == Cost::Fetches || time(trial) <= fastest * EQUALLY_FAST)
        .min_by(|a, b| by_fetches(a.1).total_cmp(&by_fetches(b.1)))
        .map(|(i, _)| i)
}

#[cfg(test)]
mod tests {
    use relievo_map::{Grid, HeightMap};

    use super::*;
    use crate::corpus;

    fn tuned(map: HeightMap, options: &TuneOptions) -> Tuned {
        tune(&TestMaterial::of_heights("x", map), options, &mut MarchBackend::Cpu, None).unwrap()
    }

    fn quick() -> TuneOptions {
        TuneOptions { rays: 1024, rounds: 1, cost: Cost::Fetches, ..TuneOptions::default() }
    }

    #[test]
    fn a_flat_map_needs_no_march_and_needles_need_the_exact_one() {
        let flat = tuned(HeightMap::new(Grid::filled(32, 32, 1.0)), &quick());
        assert_eq!(flat.best().unwrap().candidate.to_string(), "normal");
        for cost in [Cost::Fetches, Cost::Time] {
            let needles = tuned(corpus("spikes", 128).unwrap(), &TuneOptions { cost, ..quick() });
            assert_eq!(needles.best().unwrap().candidate.to_string(), "exact");
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
