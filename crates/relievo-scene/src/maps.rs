//! Reading the maps that a scene names, several at a time.

use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use relievo_map::{
    Channel, ColorMap, HeightMap, Limits, Loaded, MapError, MapSet, NormalMap, NormalY, ScalarMap, White, find_maps,
    read_color, read_folder, read_height, read_normal, read_scalar,
};

use crate::LoadOptions;
use crate::error::SceneError;
use crate::source::Source;
use relievo_toml::At;

/// A map to be read, and where the scene names it.
pub(crate) struct Job {
    pub(crate) at: At,
    /// The key and its table, for messages.
    pub(crate) what: String,
    pub(crate) request: Request,
}

pub(crate) enum Request {
    /// A folder; what the scene says of its files goes before what their names say.
    Folder(PathBuf, Option<NormalY>, Option<White>),
    Make(String),
    BaseColor(PathBuf),
    Normal(PathBuf, NormalY),
    Height(PathBuf, White),
    Roughness(PathBuf),
    Metallic(PathBuf),
    Ao(PathBuf),
    Environment(PathBuf),
}

pub(crate) enum Map {
    /// A whole folder, or a generated material.
    Set(MapSet),
    BaseColor(ColorMap),
    Normal(NormalMap),
    Height(HeightMap),
    Roughness(ScalarMap),
    Metallic(ScalarMap),
    Ao(ScalarMap),
    Environment(ColorMap),
}

impl Map {
    /// Puts the map into its slot.
    pub(crate) fn into_set(self, maps: &mut MapSet) {
        match self {
            Self::Set(set) => *maps = set,
            Self::BaseColor(map) => maps.base_color = Some(map),
            Self::Normal(map) => maps.normal = Some(map),
            Self::Height(map) => maps.height = Some(map),
            Self::Roughness(map) => maps.roughness = Some(map),
            Self::Metallic(map) => maps.metallic = Some(map),
            Self::Ao(map) => maps.ao = Some(map),
            Self::Environment(_) => {}
        }
    }
}

type Failure = Box<dyn Error + Send + Sync>;

/// Reads all maps on all cores. Results, notes and the error that is reported come in the order of the jobs.
pub(crate) fn read_all(
    jobs: &[Job],
    options: &LoadOptions,
    source: &Source,
    notes: &mut Vec<String>,
) -> Result<Vec<Map>, SceneError> {
    let results: Vec<OnceLock<Result<Loaded<Map>, Failure>>> = jobs.iter().map(|_| OnceLock::new()).collect();
    let next = AtomicUsize::new(0);
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(job) = jobs.get(index) else { return };
            let result = read(&job.request, options);
            let failed = result.is_err();
            // Nobody else has this index.
            let _ = results[index].set(result);
            if failed {
                // Jobs before this one are already being worked on; the rest is not needed.
                next.store(jobs.len(), Ordering::Relaxed);
            }
        }
    };
    let helpers = thread::available_parallelism().map_or(1, usize::from).min(jobs.len()).saturating_sub(1);
    thread::scope(|scope| {
        for _ in 0..helpers {
            // Where threads cannot be had, this thread does all the work.
            if thread::Builder::new().spawn_scoped(scope, work).is_err() {
                break;
            }
        }
        work();
    });
    let mut maps = Vec::with_capacity(jobs.len());
    for (job, result) in jobs.iter().zip(results) {
        match result.into_inner() {
            Some(Ok(Loaded { map, notes: found })) => {
                notes.extend(found);
                maps.push(map);
            }
            Some(Err(source_error)) => {
                let location = source.location(job.at);
                return Err(SceneError::Map { location, what: job.what.clone(), source: source_error });
            }
            // Skipped: an earlier job has failed, and its error was returned.
            None => {}
        }
    }
    Ok(maps)
}

fn read(request: &Request, options: &LoadOptions) -> Result<Loaded<Map>, Failure> {
    let limits = &options.limits;
    Ok(match request {
        Request::Folder(path, normal_y, white) => folder(path, *normal_y, *white, limits)?.map(Map::Set),
        Request::Make(name) => {
            Loaded { map: Map::Set(relievo_make::make(name, options.make_size)?), notes: Vec::new() }
        }
        Request::BaseColor(path) => read_color(path, limits)?.map(Map::BaseColor),
        Request::Normal(path, normal_y) => read_normal(path, *normal_y, limits)?.map(Map::Normal),
        Request::Height(path, white) => read_height(path, *white, limits)?.map(Map::Height),
        Request::Roughness(path) => read_scalar(path, Channel::Luminance, limits)?.map(Map::Roughness),
        Request::Metallic(path) => read_scalar(path, Channel::Luminance, limits)?.map(Map::Metallic),
        Request::Ao(path) => read_scalar(path, Channel::Luminance, limits)?.map(Map::Ao),
        Request::Environment(path) => read_color(path, limits)?.map(Map::Environment),
    })
}

fn folder(
    path: &Path,
    normal_y: Option<NormalY>,
    white: Option<White>,
    limits: &Limits,
) -> Result<Loaded<MapSet>, MapError> {
    let mut loaded = read_folder(path, limits)?;
    if normal_y.is_none() && white.is_none() {
        return Ok(loaded);
    }
    let found = find_maps(path)?;
    if let (Some(said), Some((file, recognised))) = (normal_y, found.normal)
        && said != recognised
    {
        loaded.map.normal = Some(read_normal(&file, said, limits)?.map);
        let (file, y) = (file.display(), if said == NormalY::Up { "up" } else { "down" });
        loaded.notes.push(format!("{file}: +Y {y}, as normal_y says."));
    }
    if let (Some(said), Some(file)) = (white, found.height)
        && said != found.height_white
    {
        loaded.map.height = Some(read_height(&file, said, limits)?.map);
    }
    Ok(loaded)
}
