//! Loading: from the text of a scene file to a [`Scene`].

use std::collections::HashSet;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use relievo_map::ColorMap;
use relievo_toml::{Location, shorten};

use super::error::SceneError;
use super::instances::instantiate;
use super::map_request::MapRequest;
use super::maps::{LoadedMap, read_all};
use super::options::LoadOptions;
use super::sections::material::PendingMaterial;
use super::sections::{camera, image, light, material, object, shading};
use super::source::{Source, parse};
use super::table::Table;
use super::{keys, overrides};
use crate::io_error::plainly;
use crate::{Material, Scene};

/// Largest scene file.
const MAX_BYTES: u64 = 16 << 20;

impl Scene {
    /// Loads a scene file. The files it names are relative to its folder.
    ///
    /// # Errors
    /// If the file or one that it names cannot be read, or anything in it is wrong: see [`SceneError`].
    pub fn load(path: &Path, options: &LoadOptions) -> Result<Self, SceneError> {
        let name = path.display().to_string();
        let bytes = read_limited(path).map_err(|source| SceneError::Read { path: path.to_owned(), source })?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let valid = error.utf8_error().valid_up_to();
            let line = 1 + error.as_bytes()[..valid].iter().filter(|&&byte| byte == b'\n').count();
            let source = Source { name: name.clone(), overrides: Vec::new() };
            source.error(Location::Line(line), "this is not text in UTF-8; is it a scene file?")
        })?;
        Self::parse(&text, &name, path.parent().unwrap_or(Path::new("")), options)
    }

    /// Loads a scene from the text of a scene file. `name` stands for it in errors; the files it names are relative to
    /// `base_dir`.
    ///
    /// # Errors
    /// As [`Scene::load`].
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

        // All of the text first: a wrong key is found before the first picture is read.
        let mut notes = Vec::new();
        let image = image::image(&root)?;
        let camera = camera::camera(&root)?;
        let lights = light::lights(&root, &mut notes)?;
        let shading = shading::shading(&root)?;
        let environment = shading::environment(&root, base_dir)?;
        let mut materials = material::materials(&root, base_dir)?;
        let names: Vec<&str> = materials.iter().map(|pending| pending.material.name.as_str()).collect();
        let objects = object::objects(&root, &names, base_dir)?;

        let environment = read_maps(&mut materials, environment, options, &source, &mut notes)?;
        let mut materials: Vec<Material> = materials
            .into_iter()
            .map(|pending| pending.finish(&source, &mut notes))
            .collect::<Result<_, SceneError>>()?;
        let objects = instantiate(objects, &mut materials, options, &source, &mut notes)?;
        // One file may serve several materials.
        let mut said = HashSet::new();
        notes.extend(materials.iter().filter_map(Material::note_on_silhouette));
        notes.retain(|note| said.insert(note.clone()));
        Ok(Self { image, camera, lights, shading, materials, objects, environment, notes })
    }
}

/// Reads the maps of all materials and the environment, as many at once as there are cores; returns the environment.
fn read_maps(
    materials: &mut [PendingMaterial],
    environment: Option<MapRequest>,
    options: &LoadOptions,
    source: &Source,
    notes: &mut Vec<String>,
) -> Result<Option<ColorMap>, SceneError> {
    // The material of each map; the environment is no material's.
    let mut owners: Vec<Option<usize>> = environment.iter().map(|_| None).collect();
    let mut requests: Vec<MapRequest> = environment.into_iter().collect();
    for (index, pending) in materials.iter_mut().enumerate() {
        owners.extend(pending.maps.iter().map(|_| Some(index)));
        requests.append(&mut pending.maps);
    }
    let mut environment = None;
    for (map, owner) in read_all(&requests, options, source, notes)?.into_iter().zip(owners) {
        match (map, owner) {
            (LoadedMap::Environment(map), _) => environment = Some(map),
            (map, Some(owner)) => map.into_set(&mut materials[owner].material.maps),
            (_, None) => {}
        }
    }
    Ok(environment)
}

/// Reads a regular file of bearable size.
fn read_limited(path: &Path) -> io::Result<Vec<u8>> {
    let metadata = path.metadata().map_err(plainly)?;
    if metadata.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder; name a file (TOML) in it"));
    }
    if !metadata.is_file() {
        return Err(io::Error::other("it is not a regular file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(io::Error::other("it is far too long for a scene file"));
    }
    Ok(bytes)
}
