//! From the text of a scene file to a [`Scene`].

use std::collections::{HashMap, HashSet};
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use relievo_map::{Limits, MapSet};

use crate::error::{SceneError, plainly};
use crate::maps::{Job, Map, read_all};
use crate::model::{Model, ModelError};
use crate::object_section::MeshSource;
use crate::overrides::{self, Override};
use crate::reader::Table;
use crate::source::{Source, parse};
use crate::{Material, Mesh, Object, Scene, keys, material_section, object_section, sections};
use relievo_toml::{At, shorten};

/// A scene file longer than this is a mistake.
const MAX_BYTES: u64 = 16 << 20;

/// How a scene is loaded.
#[derive(Clone, Debug)]
pub struct LoadOptions {
    /// Changes to the scene file, applied in order.
    pub overrides: Vec<Override>,
    /// How large a single image may be.
    pub limits: Limits,
    /// Texels per side of generated materials (`from = "make:…"`), at least 1.
    pub make_size: u32,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self { overrides: Vec::new(), limits: Limits::default(), make_size: 1024 }
    }
}

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
            source.error(At::Line(line), "this is not text in UTF-8; is it a scene file?")
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
        let root = Table::new(&source, keys::ROOT, keys::ROOT, At::Whole, &tree)?;

        // All of the text first: a wrong key is found before the first picture is read.
        let mut notes = Vec::new();
        let image = sections::image(&root)?;
        let camera = sections::camera(&root)?;
        let lights = sections::lights(&root, &mut notes)?;
        let shading = sections::shading(&root)?;
        let environment = sections::environment(&root, base_dir)?;
        let materials = material_section::materials(&root, base_dir)?;
        let names: Vec<&str> = materials.iter().map(|plan| plan.material.name.as_str()).collect();
        let objects = object_section::objects(&root, &names, base_dir)?;

        // Whose map each job brings; the environment is no material's.
        let mut owners: Vec<Option<usize>> = environment.iter().map(|_| None).collect();
        let mut jobs: Vec<Job> = environment.into_iter().collect();
        let mut finished = Vec::with_capacity(materials.len());
        for plan in materials {
            owners.extend(plan.jobs.iter().map(|_| Some(finished.len())));
            jobs.extend(plan.jobs);
            finished.push((plan.material, plan.metallic, plan.marches));
        }
        let mut environment = None;
        for (map, owner) in read_all(&jobs, options, &source, &mut notes)?.into_iter().zip(owners) {
            match (map, owner) {
                (Map::Environment(map), _) => environment = Some(map),
                (map, Some(owner)) => map.into_set(&mut finished[owner].0.maps),
                (_, None) => {}
            }
        }
        let mut materials: Vec<Material> = finished
            .into_iter()
            .map(|(mut material, metallic, marches)| {
                // A map speaks for itself; without one nothing is metal unless the file says so.
                let default = if material.maps.metallic.is_some() { 1.0 } else { 0.0 };
                material.metallic = metallic.unwrap_or(default);
                if marches && material.maps.height.is_none() {
                    let (name, technique) = (&material.name, material.relief.technique.name());
                    notes.push(format!("material \"{name}\" has no height map for \"{technique}\": it is flat"));
                }
                material
            })
            .collect();
        let objects = place_objects(objects, &mut materials, options, &source, &mut notes)?;
        // One file may serve several materials.
        let mut said = HashSet::new();
        notes.retain(|note| said.insert(note.clone()));
        Ok(Self { image, camera, lights, shading, materials, objects, environment, notes })
    }
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

fn place_objects(
    plans: Vec<object_section::Plan>,
    materials: &mut Vec<Material>,
    options: &LoadOptions,
    source: &Source,
    notes: &mut Vec<String>,
) -> Result<Vec<Object>, SceneError> {
    let scene_materials = materials.len();
    // A file's own materials are read only if some object draws with them.
    let own: Vec<PathBuf> = plans
        .iter()
        .filter_map(|plan| match (&plan.mesh, plan.material) {
            (MeshSource::File(path), None) => Some(path.clone()),
            _ => None,
        })
        .collect();
    let mut shapes: HashMap<&'static str, Arc<Mesh>> = HashMap::new();
    let mut models: HashMap<PathBuf, (Model, usize)> = HashMap::new();
    let mut grey = None;
    let mut objects = Vec::new();
    for plan in plans {
        let path = match plan.mesh {
            MeshSource::Shape(name) => {
                let mesh = shapes.entry(name).or_insert_with(|| Arc::new(Mesh::shape(name).unwrap_or_default()));
                let material = plan.material.unwrap_or(0);
                objects.push(Object {
                    mesh: Arc::clone(mesh),
                    material,
                    transform: plan.transform,
                    uv_repeat: plan.uv_repeat,
                });
                continue;
            }
            MeshSource::File(path) => path,
        };
        let failed = |source_error| SceneError::Model { location: source.location(plan.at), source: source_error };
        if !models.contains_key(&path) {
            let with_materials = own.contains(&path);
            let mut model = Model::load(&path, &options.limits, with_materials).map_err(failed)?;
            notes.append(&mut model.notes);
            let first = materials.len();
            materials.append(&mut model.materials);
            models.insert(path.clone(), (model, first));
        }
        let Some((model, first)) = models.get(&path) else { continue };
        for part in &model.parts {
            let material = match (plan.material, part.material) {
                (Some(named), _) => named,
                (None, Some(own)) => first + own,
                (None, None) if scene_materials == 1 => 0,
                (None, None) => *grey.get_or_insert_with(|| {
                    materials.push(Material::grey());
                    materials.len() - 1
                }),
            };
            if !part.has_uvs && materials[material].maps != MapSet::default() {
                let name = &materials[material].name;
                let message = format!(
                    "it has no texture coordinates, which the maps of material \"{name}\" need; unwrap it and export it \
                     again, or give it a material without maps"
                );
                return Err(failed(ModelError::new(&path, message)));
            }
            let transform = plan.transform * part.transform;
            if !(transform.is_finite() && transform.inverse().is_finite() && transform.matrix3.determinant() != 0.0) {
                notes.push(format!(
                    "{}: a part is scaled to nothing, or out of all bounds; it is left out",
                    path.display()
                ));
                continue;
            }
            objects.push(Object { mesh: Arc::clone(&part.mesh), material, transform, uv_repeat: plan.uv_repeat });
        }
    }
    Ok(objects)
}
