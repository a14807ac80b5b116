use std::path::Path;

use relievo_march::ReliefMap;

use super::figures::{DEFINITIONS, Machine, MaterialRow, Results};
use super::file_name::file_name;
use super::hits::measure_hits;
use super::job::{SweepJob, SweepJobKind, jobs};
use super::options::SweepOptions;
use super::pictures::judge_pictures;
use super::store::{Case, Store};
use crate::error::LabError;
use crate::material::{MaterialView, TestMaterial};
use crate::measure::{MarchBackend, with_cones};

/// Progress callback: (next case, cases done, cases in all).
pub type SweepProgress<'a> = dyn Fn(&str, usize, usize) + 'a;

/// The outcome of a sweep.
#[derive(Clone, Debug)]
pub struct SweepOutcome {
    /// All figures.
    pub results: Results,
    /// Number of cases taken over from an earlier run.
    pub skipped: usize,
    /// Notes on the folder for the user.
    pub notes: Vec<String>,
}

/// Measures all cases of `options` on every material, and writes figures and pictures to `folder`, which is created if its
/// parent exists. Cases that an earlier run finished there, with the same settings, maps, version and machine, are taken
/// over.
///
/// All figures but times are independent of the number of threads.
///
/// # Errors
/// If the options are out of range, two materials have one name, the folder cannot be written, or a backend fails.
pub fn sweep(
    materials: &[TestMaterial],
    options: &SweepOptions,
    backends: &mut [MarchBackend],
    folder: &Path,
    progress: Option<&SweepProgress<'_>>,
) -> Result<SweepOutcome, LabError> {
    options.check()?;
    check_names(materials)?;
    let mut store = Store::open(folder)?;
    let mut results = Results {
        relievo: env!("CARGO_PKG_VERSION").to_owned(),
        materials: materials.iter().map(material_row).collect(),
        definitions: DEFINITIONS.map(|(word, meaning)| (word.to_owned(), meaning.to_owned())).into(),
        machine: machine(backends),
        ..Results::default()
    };
    let jobs: Vec<SweepJob<'_>> =
        materials.iter().flat_map(|material| jobs(material, options, backends.len())).collect();
    let mut skipped = 0;
    let mut heights = HeightCache::default();
    for (done, job) in jobs.iter().enumerate() {
        if let Some(progress) = progress {
            progress(&job.material.name, done, jobs.len());
        }
        let (name, work) = (job.name(backends), job.work(options, backends, &results.machine)?);
        let case = match store.finished(&name, &work) {
            Some(case) => {
                skipped += 1;
                case
            }
            None => {
                store.begin(&name)?;
                let case = match job.kind {
                    SweepJobKind::Hits { backend } => {
                        let heights = heights.get(job.material, options);
                        let hits = measure_hits(job, options, &mut backends[backend], heights)?;
                        Case { hits, ..Case::default() }
                    }
                    SweepJobKind::Pictures => measure_pictures(job, options, &store, &name)?,
                };
                store.keep(&name, work, &case)?;
                case
            }
        };
        results.hits.extend(case.hits);
        results.pictures.extend(case.pictures);
    }
    Ok(SweepOutcome { results, skipped, notes: store.note().into_iter().collect() })
}

/// Returns an error if two materials would share file names.
fn check_names(materials: &[TestMaterial]) -> Result<(), LabError> {
    for (i, material) in materials.iter().enumerate() {
        let name = file_name(&material.name);
        if materials[..i].iter().any(|other| file_name(&other.name) == name) {
            return Err(LabError::Options(format!("two materials are called {name}; rename one of them")));
        }
    }
    Ok(())
}

/// The relief map of the material that is measured, with mip levels, pyramids and cones.
#[derive(Default)]
struct HeightCache {
    map: Option<(String, ReliefMap)>,
}

impl HeightCache {
    fn get(&mut self, material: &TestMaterial, options: &SweepOptions) -> &ReliefMap {
        let cached = self.map.take().filter(|(name, _)| *name == material.name);
        let (_, map) = self.map.insert(cached.unwrap_or_else(|| {
            let map = with_cones(ReliefMap::with_mips(&material.height), &options.techniques);
            (material.name.clone(), map)
        }));
        map
    }
}

fn measure_pictures(job: &SweepJob<'_>, options: &SweepOptions, store: &Store, name: &str) -> Result<Case, LabError> {
    let mut case = Case::default();
    let Some(pictures) = &options.pictures else { return Ok(case) };
    let (folder, prefix) = store.pictures(name)?;
    for &angle in &pictures.angles {
        let view = MaterialView {
            material: job.material,
            depth: job.depth,
            minification: job.minification,
            angle,
            size: pictures.size,
        };
        case.pictures.extend(judge_pictures(&view, pictures, folder, &format!("{prefix}{angle}-"))?);
    }
    Ok(case)
}

fn machine(backends: &[MarchBackend]) -> Machine {
    let gpu = backends.iter().find(|backend| backend.backend() == "gpu");
    Machine {
        cpu: MarchBackend::Cpu.name(),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        adapter: gpu.map(MarchBackend::name),
        system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
    }
}

fn material_row(material: &TestMaterial) -> MaterialRow {
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
