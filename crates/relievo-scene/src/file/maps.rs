//! Reading the maps that a scene names, several at a time.

use std::collections::HashMap;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::thread;

use relievo_make::{HeightRecipe, Recipe};
use relievo_map::{
    Channel, ColorMap, HeightMap, Limits, Loaded, MapError, MapSet, NormalMap, NormalY, ScalarMap, White, find_maps,
    read_color, read_folder, read_height, read_normal, read_scalar,
};

use super::error::SceneError;
use super::map_request::{MapRequest, MapSource};
use super::options::LoadOptions;
use super::read_limited::read_limited;
use super::source::Source;

#[derive(Clone)]
pub(super) enum LoadedMap {
    /// A whole folder, or a generated material.
    Set(MapSet),
    BaseColor(ColorMap),
    Normal(NormalMap),
    Height(HeightMap),
    /// Heights that change.
    HeightsInLoop(HeightsInLoop),
    Roughness(ScalarMap),
    Metallic(ScalarMap),
    Ao(ScalarMap),
    Environment(ColorMap),
}

/// Heights of a recipe that changes.
#[derive(Clone)]
pub(super) struct HeightsInLoop {
    pub(super) recipe: Arc<HeightRecipe>,
    /// Texels per side.
    pub(super) size: u32,
    /// Seconds.
    pub(super) period: f32,
    /// The heights at the beginning of the loop.
    pub(super) first: HeightMap,
}

/// Maps that were read: scenes at other times share them.
#[derive(Default)]
pub(super) struct MapCache(Mutex<HashMap<MapSource, (LoadedMap, Vec<String>)>>);

impl MapCache {
    fn get(&self, source: &MapSource) -> Option<Loaded<LoadedMap>> {
        let cache = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        cache.get(source).map(|(map, notes)| Loaded { map: map.clone(), notes: notes.clone() })
    }

    /// The files that were read; of a folder all that are in it.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        let cache = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        cache.keys().flat_map(MapSource::files).collect()
    }

    fn put(&self, source: &MapSource, loaded: &Loaded<LoadedMap>) {
        if source.stands_still() {
            let entry = (loaded.map.clone(), loaded.notes.clone());
            self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(source.clone(), entry);
        }
    }
}

impl LoadedMap {
    /// Puts the map into its slot.
    pub(super) fn into_set(self, maps: &mut MapSet) {
        match self {
            Self::Set(set) => *maps = set,
            Self::BaseColor(map) => maps.base_color = Some(map),
            Self::Normal(map) => maps.normal = Some(map),
            Self::Height(map) => maps.height = Some(map),
            Self::Roughness(map) => maps.roughness = Some(map),
            Self::Metallic(map) => maps.metallic = Some(map),
            Self::Ao(map) => maps.ao = Some(map),
            Self::Environment(_) | Self::HeightsInLoop(_) => {}
        }
    }
}

type Failure = Box<dyn Error + Send + Sync>;

/// Reads all maps that the cache does not hold, on all cores. Results, notes and the error that is reported come in the order of the requests.
pub(super) fn read_all(
    requests: &[MapRequest],
    options: &LoadOptions,
    cache: &MapCache,
    source: &Source,
    notes: &mut Vec<String>,
) -> Result<Vec<LoadedMap>, SceneError> {
    let results: Vec<OnceLock<Result<Loaded<LoadedMap>, Failure>>> = requests.iter().map(|_| OnceLock::new()).collect();
    let next = AtomicUsize::new(0);
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(request) = requests.get(index) else { return };
            let result = cache.get(&request.source).map_or_else(|| read(&request.source, options), Ok);
            let failed = result.is_err();
            // Nobody else has this index.
            let _ = results[index].set(result);
            if failed {
                // Jobs before this one are already being worked on; the rest is not needed.
                next.store(requests.len(), Ordering::Relaxed);
            }
        }
    };
    let helpers = thread::available_parallelism().map_or(1, usize::from).min(requests.len()).saturating_sub(1);
    thread::scope(|scope| {
        for _ in 0..helpers {
            // Where threads cannot be had, this thread does all the work.
            if thread::Builder::new().spawn_scoped(scope, work).is_err() {
                break;
            }
        }
        work();
    });
    let mut maps = Vec::with_capacity(requests.len());
    for (request, result) in requests.iter().zip(results) {
        match result.into_inner() {
            Some(Ok(loaded)) => {
                cache.put(&request.source, &loaded);
                notes.extend(loaded.notes);
                maps.push(loaded.map);
            }
            Some(Err(source_error)) => {
                let location = source.location(request.at);
                return Err(SceneError::Map { location, what: request.what.clone(), source: source_error });
            }
            // Skipped: an earlier request has failed, and its error was returned.
            None => {}
        }
    }
    Ok(maps)
}

fn read(source: &MapSource, options: &LoadOptions) -> Result<Loaded<LoadedMap>, Failure> {
    let limits = &options.limits;
    Ok(match source {
        MapSource::Folder(path, normal_y, white) => folder(path, *normal_y, *white, limits)?.map(LoadedMap::Set),
        MapSource::Make(name, phase) => {
            let made = match f64::from_bits(*phase) {
                0.0 => relievo_make::make(name, options.make_size),
                phase => relievo_make::built_in(name)?.make_at(options.make_size, phase),
            };
            Loaded { map: LoadedMap::Set(made?), notes: Vec::new() }
        }
        MapSource::MadeHeight(name, size) => made_heights(&relievo_make::built_in(name)?, *size)?,
        MapSource::HeightRecipe(path, size) => {
            let name = path.display().to_string();
            let bytes =
                read_limited(path, Recipe::MAX_BYTES as u64, "a recipe").map_err(|error| format!("{name}: {error}"))?;
            let text = String::from_utf8(bytes).map_err(|_| format!("{name}: a recipe is a text file in UTF-8"))?;
            made_heights(&Recipe::parse(&name, &text, None)?, *size)?
        }
        MapSource::BaseColor(path) => read_color(path, limits)?.map(LoadedMap::BaseColor),
        MapSource::Normal(path, normal_y) => read_normal(path, *normal_y, limits)?.map(LoadedMap::Normal),
        MapSource::Height(path, white) => read_height(path, *white, limits)?.map(LoadedMap::Height),
        MapSource::Roughness(path) => read_scalar(path, Channel::Luminance, limits)?.map(LoadedMap::Roughness),
        MapSource::Metallic(path) => read_scalar(path, Channel::Luminance, limits)?.map(LoadedMap::Metallic),
        MapSource::Ao(path) => read_scalar(path, Channel::Luminance, limits)?.map(LoadedMap::Ao),
        MapSource::Environment(path) => read_color(path, limits)?.map(LoadedMap::Environment),
    })
}

/// The heights of a recipe at the beginning of its loop.
fn made_heights(recipe: &Recipe, size: u32) -> Result<Loaded<LoadedMap>, Failure> {
    let heights = HeightRecipe::of(recipe);
    let first = heights.heights(size, 0.0)?;
    let map = if heights.is_animated() {
        LoadedMap::HeightsInLoop(HeightsInLoop { recipe: Arc::new(heights), size, period: recipe.period(), first })
    } else {
        LoadedMap::Height(first)
    };
    Ok(Loaded { map, notes: Vec::new() })
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
