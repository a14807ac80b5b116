//! Angle × depth × technique × settings × backend × minification over materials, against the oracle and the truth.

mod backend;
mod error;
mod fields;
mod figures;
#[cfg(feature = "gpu")]
mod gpu;
mod hits;
mod options;
mod pictures;
mod rays;
mod store;

use std::path::Path;
use std::time::Instant;

use relievo_journal::{Input, Work};
use relievo_map::Wrap;
use relievo_march::{HeightField, MaxPyramid, Ray, ReliefMap, Technique, exact_loads};

pub use backend::MarchBackend;
pub(crate) use backend::Stopwatch;
pub use error::LabError;
use figures::DEFINITIONS;
pub use figures::{HitRow, Machine, MaterialRow, PictureRow, Results};
#[cfg(feature = "gpu")]
pub use gpu::GpuMarchBackend;
pub use hits::{HitEvaluator, HitFigures};
pub use options::{PictureOptions, SweepOptions};
pub(crate) use pictures::{View, file_name};
pub(crate) use rays::tiles;
pub(crate) use store::write_json;
use store::{Case, Store};

use crate::{Candidate, TestMaterial};

/// Rays that keep a GPU busy: its times are of so many.
const GPU_RAYS: u32 = 1 << 16;

/// Told what is measured next, how many cases are done, and how many there are.
pub type SweepProgress<'a> = dyn Fn(&str, usize, usize) + 'a;

/// What a sweep came to.
#[derive(Clone, Debug)]
pub struct Swept {
    /// All figures.
    pub results: Results,
    /// Cases that an earlier run had finished.
    pub skipped: usize,
    /// Notes worth a reader's while.
    pub notes: Vec<String>,
}

/// One piece of work: all angles and candidates of a material in one depth, minification and backend.
enum Kind {
    Hits { bench: usize },
    Pictures,
}

struct Job<'a> {
    material: &'a TestMaterial,
    kind: Kind,
    depth: f32,
    minification: u32,
}

impl SweepOptions {
    /// Whether they can be measured.
    ///
    /// # Errors
    /// If a list is empty, or a number outside its range.
    pub fn check(&self) -> Result<(), LabError> {
        let refused = |text: String| Err(LabError::Options(text));
        let pictures = self.pictures.as_ref();
        let angles = self.angles.iter().map(|&angle| (angle, 89.9));
        let tilts = pictures.iter().flat_map(|p| p.angles.iter().map(|&angle| (angle, 85.0)));
        if let Some((angle, most)) = angles.chain(tilts).find(|(angle, most)| !(0.0..=*most).contains(angle)) {
            return refused(format!("an angle of {angle}° cannot be measured: it must be 0 to {most}"));
        }
        let depths = || self.depths.iter().chain(pictures.iter().flat_map(|p| &p.depths));
        if let Some(depth) = depths().find(|depth| !(0.01..=1000.0).contains(*depth)) {
            return refused(format!("a depth of {depth} texels cannot be measured: it must be 0.01 to 1000"));
        }
        let minifications = || self.minifications.iter().chain(pictures.iter().flat_map(|p| &p.minifications));
        if let Some(n) = minifications().find(|n| !n.is_power_of_two() || **n > 1 << 10) {
            return refused(format!("{n} texels per pixel cannot be measured: it must be a power of two up to 1024"));
        }
        if self.candidates.is_empty()
            || self.angles.is_empty()
            || self.depths.is_empty()
            || self.minifications.is_empty()
        {
            return refused("there is nothing to measure: no technique, angle, depth or minification".to_owned());
        }
        if !(1..=1 << 22).contains(&self.rays) || !(1..=1000).contains(&self.rounds) {
            return refused("rays must be 1 to 4194304, rounds 1 to 1000".to_owned());
        }
        Ok(())
    }
}

/// Measures everything that `options` ask for on every material, and keeps figures and pictures in `folder`, which is made
/// if need be. Cases that an earlier run finished there, with the same settings, maps, version and machine, are taken over.
///
/// Whatever the number of threads, all figures but times are the same.
///
/// # Errors
/// If the options cannot be measured, two materials have one name, the folder cannot be written, or a backend fails.
pub fn sweep(
    materials: &[TestMaterial],
    options: &SweepOptions,
    benches: &mut [MarchBackend],
    folder: &Path,
    progress: Option<&SweepProgress<'_>>,
) -> Result<Swept, LabError> {
    options.check()?;
    for (i, material) in materials.iter().enumerate() {
        let name = file_name(&material.name);
        if materials[..i].iter().any(|other| file_name(&other.name) == name) {
            return Err(LabError::Options(format!("two materials are called {name}; rename one of them")));
        }
    }
    let mut store = Store::open(folder)?;
    let machine = machine(benches);
    let mut results = Results {
        relievo: env!("CARGO_PKG_VERSION").to_owned(),
        materials: materials.iter().map(material).collect(),
        definitions: DEFINITIONS.map(|(word, meaning)| (word.to_owned(), meaning.to_owned())).into(),
        machine,
        ..Results::default()
    };
    let jobs: Vec<Job<'_>> = materials.iter().flat_map(|material| jobs(material, options, benches.len())).collect();
    let mut skipped = 0;
    let mut heights: Option<(&str, ReliefMap)> = None;
    for (done, job) in jobs.iter().enumerate() {
        if let Some(progress) = progress {
            progress(&job.material.name, done, jobs.len());
        }
        let (name, work) = (job.name(benches), job.work(options, benches, &results.machine)?);
        let case = match store.finished(&name, &work) {
            Some(case) => {
                skipped += 1;
                case
            }
            None => {
                store.begin(&name)?;
                let case = match (&job.kind, &options.pictures) {
                    (Kind::Hits { bench }, _) => {
                        let ready = heights.as_ref().is_some_and(|(name, _)| *name == job.material.name);
                        if !ready {
                            let mips = ReliefMap::with_mips(&job.material.height);
                            heights = Some((&job.material.name, with_cones(mips, &options.candidates)));
                        }
                        let Some((_, heights)) = &heights else { continue };
                        Case { hits: job.hits(options, &mut benches[*bench], heights)?, ..Case::default() }
                    }
                    (Kind::Pictures, Some(pictures)) => {
                        let (folder, prefix) = store.pictures(&name)?;
                        let mut case = Case::default();
                        for &angle in &pictures.angles {
                            let view = View {
                                material: job.material,
                                depth: job.depth,
                                minification: job.minification,
                                angle,
                                options: pictures,
                            };
                            case.pictures.extend(view.judge(folder, &format!("{prefix}{angle}-"))?);
                        }
                        case
                    }
                    (Kind::Pictures, None) => continue,
                };
                store.keep(&name, work, &case)?;
                case
            }
        };
        results.hits.extend(case.hits);
        results.pictures.extend(case.pictures);
    }
    Ok(Swept { results, skipped, notes: store.note().into_iter().collect() })
}

fn machine(benches: &[MarchBackend]) -> Machine {
    let gpu = benches.iter().find(|bench| bench.backend() == "gpu");
    Machine {
        cpu: MarchBackend::Cpu.name(),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        adapter: gpu.map(MarchBackend::name),
        system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
    }
}

fn material(material: &TestMaterial) -> MaterialRow {
    let texels = material.height.grid().texels();
    let [width, height] = material.size();
    MaterialRow {
        name: material.name.clone(),
        source: material.source.clone(),
        width,
        height,
        mean_height: texels.iter().map(|&h| f64::from(h)).sum::<f64>() / texels.len() as f64,
    }
}

fn jobs<'a>(material: &'a TestMaterial, options: &SweepOptions, benches: usize) -> Vec<Job<'a>> {
    let mut jobs = Vec::new();
    for bench in 0..benches {
        for &depth in &options.depths {
            for &minification in &options.minifications {
                jobs.push(Job { material, kind: Kind::Hits { bench }, depth, minification });
            }
        }
    }
    if let Some(pictures) = &options.pictures {
        for &depth in &pictures.depths {
            for &minification in &pictures.minifications {
                jobs.push(Job { material, kind: Kind::Pictures, depth, minification });
            }
        }
    }
    jobs
}

impl Job<'_> {
    /// Unique in a folder, and fit for a file's name.
    fn name(&self, benches: &[MarchBackend]) -> String {
        let kind = match self.kind {
            Kind::Hits { bench } => benches[bench].backend(),
            Kind::Pictures => "pictures",
        };
        format!("{}-{kind}-{}-{}", file_name(&self.material.name), self.depth, self.minification)
    }

    /// All that its figures depend on: of the options those of this case alone, so that the other cases may change.
    fn work(&self, options: &SweepOptions, benches: &[MarchBackend], machine: &Machine) -> Result<Work, LabError> {
        let (depths, minifications) = (vec![self.depth], vec![self.minification]);
        let product = env!("CARGO_PKG_VERSION");
        let work = match (&self.kind, &options.pictures) {
            (Kind::Hits { bench }, _) => {
                let options = SweepOptions { depths, minifications, pictures: None, ..options.clone() };
                Work::new(product, &(benches[*bench].name(), machine.threads, options))
            }
            (Kind::Pictures, Some(pictures)) => {
                Work::new(product, &PictureOptions { depths, minifications, ..pictures.clone() })
            }
            (Kind::Pictures, None) => Work::new(product, &()),
        };
        Ok(work?.reading(Input::of_content(&self.material.name, self.material.fingerprint())))
    }

    fn hits(
        &self,
        options: &SweepOptions,
        bench: &mut MarchBackend,
        heights: &ReliefMap,
    ) -> Result<Vec<HitRow>, LabError> {
        let last = heights.levels().len() - 1;
        let level = (self.minification.ilog2() as usize).min(last);
        let field = heights.field(level as f32, Wrap::Repeat);
        let (full, size) = (heights.size(), field.size());
        let depth = full.map(|n| self.depth / n as f32);
        // In texels of the level.
        let level_depth = depth[0] * size[0] as f32;
        let texel_bytes = 4 * u64::from(size[0]) * u64::from(size[1]);
        let (build_ms, pyramid_bytes) = pyramid_cost(heights, level);
        bench.load(heights)?;
        let mut rows = Vec::new();
        for &angle in &options.angles {
            let rays = tiles(size, depth, angle, options.rays);
            let many = match bench.backend() {
                "gpu" => tiles(size, depth, angle, options.rays.max(GPU_RAYS)),
                _ => Vec::new(),
            };
            let judge = HitEvaluator::new(&field, &rays, level_depth);
            let first = rows.len();
            for candidate in &options.candidates {
                let records = bench.march(heights, level as f32, candidate, &rays)?;
                let mut row = HitRow {
                    material: self.material.name.clone(),
                    backend: bench.backend().to_owned(),
                    technique: candidate.to_string(),
                    depth_texels: self.depth,
                    minification: self.minification,
                    angle,
                    hits: judge.figures(&records),
                    bytes: texel_bytes,
                    ..HitRow::default()
                };
                count_kinds(&mut row, candidate, &field, &rays);
                if candidate.technique() == Technique::Exact && !candidate.is_cell_by_cell() {
                    row.bytes += pyramid_bytes;
                    row.build_ms = build_ms;
                }
                rows.push(row);
            }
            // All in turn, again and again: what disturbs the machine hits them alike.
            let mut watches = vec![Stopwatch::default(); options.candidates.len()];
            for _ in 0..options.rounds {
                for (candidate, watch) in options.candidates.iter().zip(&mut watches) {
                    bench.time(heights, level as f32, candidate, &rays, &many, watch)?;
                }
            }
            for (row, watch) in rows[first..].iter_mut().zip(&watches) {
                row.ns_per_ray = watch.ns_per_ray();
            }
        }
        Ok(rows)
    }
}

/// With the cones that the candidates step through.
pub(crate) fn with_cones(heights: ReliefMap, candidates: &[Candidate]) -> ReliefMap {
    let needed = candidates.iter().filter(|candidate| candidate.technique() == Technique::Cone);
    needed.fold(heights, |heights, candidate| heights.with_cones(candidate.march().cones))
}

/// Mean fetches by kind. Those of a GPU are those of the CPU, by test.
fn count_kinds(row: &mut HitRow, candidate: &Candidate, field: &impl HeightField, rays: &[Ray]) {
    let fetches = row.hits.fetches.mean;
    if candidate.is_cell_by_cell() {
        row.gathers = fetches;
    } else if candidate.technique() == Technique::Exact {
        let options = candidate.march();
        let gathers: u64 = rays.iter().map(|ray| u64::from(exact_loads(field, ray, &options).gathers)).sum();
        row.gathers = gathers as f64 / rays.len().max(1) as f64;
        row.nodes = fetches - row.gathers;
    } else if candidate.technique() == Technique::Cone {
        row.nodes = fetches;
    } else {
        row.samples = fetches;
    }
}

/// Milliseconds to build the pyramid of a level (the best of three), and its bytes.
fn pyramid_cost(heights: &ReliefMap, level: usize) -> (f64, u64) {
    let map = &heights.levels()[level];
    let exact_codes = level == 0 && heights.quantization_step() > 0.0;
    let build = || {
        let start = Instant::now();
        let bytes = MaxPyramid::build(map, exact_codes).bytes() as u64;
        (start.elapsed().as_secs_f64() * 1e3, bytes)
    };
    let first = build();
    (0..2).map(|_| build()).fold(first, |best, next| (best.0.min(next.0), best.1))
}
