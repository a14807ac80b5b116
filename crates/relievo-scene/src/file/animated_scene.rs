use std::path::{Path, PathBuf};

use relievo_map::ColorMap;
use relievo_toml::{Entry, Location, shorten};

use super::error::SceneError;
use super::heights::{KnownLayers, ReadHeights, place};
use super::instances::{KnownMeshes, instantiate};
use super::map_request::MapRequest;
use super::maps::{LoadedMap, MapCache, read_all};
use super::options::LoadOptions;
use super::read_limited::read_limited;
use super::sections::clock::{self, Moment};
use super::sections::material::{MaterialContext, PendingMaterial};
use super::sections::object::PendingObject;
use super::sections::{animate, camera, image, light, material, object, shading};
use super::source::{Source, parse};
use super::table::Table;
use super::track::Track;
use super::{keys, overrides};
use crate::{Camera, ImageSettings, Light, Material, Scene, SceneTime, Shading};

/// Largest scene file.
const MAX_BYTES: u64 = 16 << 20;

/// A scene file with its clock: gives the scene at any time, from the time alone. What does not change (maps, meshes, recipes)
/// is read once, and shared by the scenes of all times.
pub struct AnimatedScene {
    /// Without `animate`.
    tree: Vec<Entry>,
    source: Source,
    base_dir: PathBuf,
    options: LoadOptions,
    tracks: Vec<Track>,
    length: Option<SceneTime>,
    /// True if any material moves.
    moves: bool,
    maps: MapCache,
    meshes: KnownMeshes,
    layers: KnownLayers,
    notes: Vec<String>,
    /// The scene file, if it is one.
    path: Option<PathBuf>,
}

/// The text of a scene file at a moment, checked; the files that it names are still to be read.
struct Sections {
    image: ImageSettings,
    camera: Camera,
    lights: Vec<Light>,
    shading: Shading,
    environment: Option<MapRequest>,
    materials: Vec<PendingMaterial>,
    objects: Vec<PendingObject>,
    moment: Moment,
    notes: Vec<String>,
}

impl AnimatedScene {
    /// Opens a scene file. The files it names are relative to its folder; they are read when a scene is asked for.
    ///
    /// # Errors
    /// If the file cannot be read, or anything in it is wrong, at the time that `options` ask for or at any keyframe.
    pub fn load(path: &Path, options: &LoadOptions) -> Result<Self, SceneError> {
        let name = path.display().to_string();
        let bytes = read_limited(path, MAX_BYTES, "a scene file")
            .map_err(|source| SceneError::Read { path: path.to_owned(), source })?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let valid = error.utf8_error().valid_up_to();
            let line = 1 + error.as_bytes()[..valid].iter().filter(|&&byte| byte == b'\n').count();
            let source = Source { name: name.clone(), overrides: Vec::new() };
            source.error(Location::Line(line), "this is not text in UTF-8; is it a scene file?")
        })?;
        let scene = Self::parse(&text, &name, path.parent().unwrap_or(Path::new("")), options)?;
        Ok(Self { path: Some(path.to_owned()), ..scene })
    }

    /// Opens a scene from the text of a scene file. `name` stands for it in errors; the files it names are relative to
    /// `base_dir`.
    ///
    /// # Errors
    /// As [`AnimatedScene::load`].
    pub fn parse(text: &str, name: &str, base_dir: &Path, options: &LoadOptions) -> Result<Self, SceneError> {
        let source = Source {
            name: name.to_owned(),
            overrides: options.overrides.iter().map(|change| shorten(&change.to_string())).collect(),
        };
        let mut tree = parse(text, &source)?;
        for (number, change) in options.overrides.iter().enumerate() {
            overrides::apply(&mut tree, change, number, &source)?;
        }
        let root = Table::new(&source, keys::ROOT, keys::ROOT, Location::Whole, &tree)?;
        let (mut tracks, length) = (animate::tracks(&root)?, clock::length(&root)?);
        // A key that is set stays as it was set.
        let set: Vec<Vec<String>> = options.overrides.iter().filter_map(|o| overrides::segments(&o.path)).collect();
        tracks.retain(|track| !set.iter().any(|path| track.shares_key(path)));
        tree.retain(|entry| entry.key != "animate");
        let mut scene = Self {
            tree,
            source,
            base_dir: base_dir.to_owned(),
            options: options.clone(),
            tracks,
            length,
            moves: false,
            maps: MapCache::default(),
            meshes: KnownMeshes::default(),
            layers: KnownLayers::default(),
            notes: Vec::new(),
            path: None,
        };
        let sections = scene.sections(options.time)?;
        scene.moves = sections.materials.iter().any(|material| material.moves);
        scene.check_keyframes()?;
        scene.notes = scene.notes_on_loops();
        Ok(scene)
    }

    /// Length of the scene's loop, if it has one: everything is then as at time 0.
    #[must_use]
    pub fn length(&self) -> Option<SceneTime> {
        self.length
    }

    /// True if anything in the scene may depend on the time.
    #[must_use]
    pub fn is_animated(&self) -> bool {
        self.moves || !self.tracks.is_empty()
    }

    /// Lists the files that were read for scenes so far, by name: the scene file, maps and all files of their folders, meshes.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files: Vec<PathBuf> = self.path.iter().cloned().collect();
        files.extend(self.maps.files());
        files.extend(self.meshes.files());
        files.retain(|file| file.is_file());
        files.sort();
        files.dedup();
        files
    }

    /// Loads the scene at a time.
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn at(&self, time: SceneTime) -> Result<Scene, SceneError> {
        self.scene(time, false)
    }

    /// Loads the scene at a time as [`AnimatedScene::at`], but leaves heights that change as they were at first, for a renderer
    /// that makes them on a device: see [`Material::changing_heights`].
    ///
    /// # Errors
    /// As [`Scene::load`].
    pub fn at_without_heights(&self, time: SceneTime) -> Result<Scene, SceneError> {
        self.scene(time, true)
    }

    fn scene(&self, time: SceneTime, heights_later: bool) -> Result<Scene, SceneError> {
        // All of the text first: a wrong key is found before the first picture is read.
        let Sections { image, camera, lights, shading, environment, mut materials, objects, moment, mut notes } =
            self.sections(time)?;
        notes.extend_from_slice(&self.notes);
        let (environment, heights) = self.read_maps(&mut materials, environment, &mut notes)?;
        for (pending, read) in materials.iter_mut().zip(heights) {
            place(pending, read, moment, heights_later, (&self.layers, &self.source), &mut notes)?;
        }
        let finish = |pending: PendingMaterial| pending.finish(&self.source, &mut notes);
        let mut materials: Vec<Material> = materials.into_iter().map(finish).collect::<Result<_, SceneError>>()?;
        let objects = instantiate(objects, &mut materials, &self.options, (&self.meshes, &self.source), &mut notes)?;
        // One file may serve several materials.
        let mut said = std::collections::HashSet::new();
        notes.extend(materials.iter().filter_map(Material::note_on_silhouette));
        notes.retain(|note| said.insert(note.clone()));
        Ok(Scene { image, camera, lights, shading, materials, objects, environment, notes })
    }

    /// Reads the text of the scene at a time.
    fn sections(&self, time: SceneTime) -> Result<Sections, SceneError> {
        let moment = Moment::new(time, self.length);
        let mut tree = self.tree.clone();
        for track in &self.tracks {
            track.apply(&mut tree, moment.time, &self.source)?;
        }
        let root = Table::new(&self.source, keys::ROOT, keys::ROOT, Location::Whole, &tree)?;
        let base_dir = &self.base_dir;
        let mut notes = Vec::new();
        let (image, camera) = (image::image(&root)?, camera::camera(&root)?);
        let lights = light::lights(&root, &mut notes)?;
        let (shading, environment) = (shading::shading(&root)?, shading::environment(&root, base_dir)?);
        let context = MaterialContext { base_dir, moment, make_size: self.options.make_size };
        let materials = material::materials(&root, context, &mut notes)?;
        let names: Vec<&str> = materials.iter().map(|pending| pending.material.name.as_str()).collect();
        let objects = object::objects(&root, &names, base_dir)?;
        Ok(Sections { image, camera, lights, shading, environment, materials, objects, moment, notes })
    }

    /// Checks the values of all keyframes: better now than in the middle of a film.
    fn check_keyframes(&self) -> Result<(), SceneError> {
        let keys = self.tracks.iter().flat_map(|track| &track.keys);
        let mut times: Vec<SceneTime> = keys.map(|key| key.time).collect();
        times.sort_unstable();
        times.dedup();
        times.into_iter().try_for_each(|time| self.sections(time).map(drop))
    }

    /// Notes on tracks that are not back when the scene's loop closes.
    fn notes_on_loops(&self) -> Vec<String> {
        let Some(length) = self.length else { return Vec::new() };
        let jumps = self.tracks.iter().filter(|track| !track.closes_after(length));
        let note = |track: &Track| {
            format!(
                "{} has another value at the end of the scene's loop of {length} than at its beginning: it jumps where it closes",
                track.path.join(".")
            )
        };
        jumps.map(note).collect()
    }

    /// Reads the maps of all materials and the environment, as many at once as there are cores; returns the environment, and
    /// of each material the heights that change.
    fn read_maps(
        &self,
        materials: &mut [PendingMaterial],
        environment: Option<MapRequest>,
        notes: &mut Vec<String>,
    ) -> Result<(Option<ColorMap>, Vec<ReadHeights>), SceneError> {
        // The material of each map; the environment is no material's.
        let mut owners: Vec<Option<usize>> = environment.iter().map(|_| None).collect();
        let mut requests: Vec<MapRequest> = environment.into_iter().collect();
        for (index, pending) in materials.iter_mut().enumerate() {
            owners.extend(pending.maps.iter().map(|_| Some(index)));
            requests.append(&mut pending.maps);
        }
        let mut environment = None;
        let mut heights: Vec<ReadHeights> = materials.iter().map(|_| ReadHeights::default()).collect();
        let maps = read_all(&requests, &self.options, &self.maps, &self.source, notes)?;
        for ((map, owner), request) in maps.into_iter().zip(owners).zip(&requests) {
            match (map, owner, request.layer) {
                (LoadedMap::Environment(map), ..) => environment = Some(map),
                (LoadedMap::HeightsInLoop(map), Some(owner), _) => heights[owner].recipe = Some(map),
                (LoadedMap::Height(map), Some(owner), Some(layer)) => heights[owner].layers.push((layer, map)),
                (map, Some(owner), _) => map.into_set(&mut materials[owner].material.maps),
                (_, None, _) => {}
            }
        }
        Ok((environment, heights))
    }
}
