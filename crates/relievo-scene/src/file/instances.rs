//! Objects of a scene from those of its file.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use relievo_map::MapSet;

use super::error::SceneError;
use super::map_request::files_in;
use super::options::LoadOptions;
use super::sections::object::{MeshSource, PendingObject};
use super::source::Source;
use crate::validate::check_mist_mesh;
use crate::{Material, Mesh, Model, ModelError, Object};
use relievo_toml::Location;

/// Meshes that were made or read: scenes at other times share them.
#[derive(Default)]
pub(super) struct KnownMeshes {
    shapes: Mutex<HashMap<&'static str, Arc<Mesh>>>,
    /// By path, with the file's own materials or without.
    models: Mutex<HashMap<(PathBuf, bool), Model>>,
}

impl KnownMeshes {
    fn shape(&self, name: &'static str) -> Arc<Mesh> {
        let mut shapes = self.shapes.lock().unwrap_or_else(PoisonError::into_inner);
        Arc::clone(shapes.entry(name).or_insert_with(|| Arc::new(Mesh::shape(name).unwrap_or_default())))
    }

    /// The files that were read; of glTF in parts all of their folder.
    pub(super) fn files(&self) -> Vec<PathBuf> {
        let models = self.models.lock().unwrap_or_else(PoisonError::into_inner);
        let is_in_parts = |path: &Path| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("gltf"));
        let files = |(path, _): &(PathBuf, bool)| match path.parent() {
            Some(folder) if is_in_parts(path) => files_in(folder),
            _ => vec![path.clone()],
        };
        models.keys().flat_map(files).collect()
    }

    fn model(&self, path: &Path, options: &LoadOptions, with_materials: bool) -> Result<Model, ModelError> {
        let key = (path.to_owned(), with_materials);
        let mut models = self.models.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(model) = models.get(&key) {
            return Ok(model.clone());
        }
        let model = Model::load(path, &options.limits, with_materials)?;
        models.insert(key, model.clone());
        Ok(model)
    }
}

/// Gives every object its meshes and materials: built-in shapes, and the parts of mesh files, each of which is read once.
pub(super) fn instantiate(
    pending: Vec<PendingObject>,
    materials: &mut Vec<Material>,
    options: &LoadOptions,
    (known, source): (&KnownMeshes, &Source),
    notes: &mut Vec<String>,
) -> Result<Vec<Object>, SceneError> {
    let scene_materials = materials.len();
    // A file's own materials are read only if some object draws with them.
    let own: Vec<PathBuf> = pending
        .iter()
        .filter_map(|object| match (&object.mesh, object.material) {
            (MeshSource::File(path), None) => Some(path.clone()),
            _ => None,
        })
        .collect();
    let mut models: HashMap<PathBuf, (Model, usize)> = HashMap::new();
    let mut grey = None;
    let mut objects = Vec::new();
    for object in pending {
        let path = match object.mesh {
            MeshSource::Shape(name) => {
                let material = object.material.unwrap_or(0);
                let shape = Object {
                    mesh: known.shape(name),
                    material,
                    transform: object.transform,
                    uv_repeat: object.uv_repeat,
                };
                check_mist(&materials[material], &shape, object.at, source)?;
                objects.push(shape);
                continue;
            }
            MeshSource::File(path) => path,
        };
        let failed = |source_error| SceneError::Model { location: source.location(object.at), source: source_error };
        if !models.contains_key(&path) {
            let with_materials = own.contains(&path);
            let mut model = known.model(&path, options, with_materials).map_err(failed)?;
            notes.append(&mut model.notes);
            let first = materials.len();
            materials.append(&mut model.materials);
            models.insert(path.clone(), (model, first));
        }
        let Some((model, first)) = models.get(&path) else { continue };
        for part in &model.parts {
            let material = match (object.material, part.material) {
                (Some(named), _) => named,
                (None, Some(own)) => first + own,
                (None, None) if scene_materials == 1 => 0,
                (None, None) => *grey.get_or_insert_with(|| {
                    materials.push(Material::grey());
                    materials.len() - 1
                }),
            };
            if !part.has_uvs && materials[material].maps != MapSet::default() {
                return Err(failed(without_uvs(&path, &materials[material].name)));
            }
            if part.two_sided {
                materials[material].two_sided.get_or_insert(true);
            }
            let transform = object.transform * part.transform;
            if !(transform.is_finite() && transform.inverse().is_finite() && transform.matrix3.determinant() != 0.0) {
                notes.push(format!(
                    "{}: a part is scaled to nothing, or out of all bounds; it is left out",
                    path.display()
                ));
                continue;
            }
            let part = Object { mesh: Arc::clone(&part.mesh), material, transform, uv_repeat: object.uv_repeat };
            check_mist(&materials[material], &part, object.at, source)?;
            objects.push(part);
        }
    }
    Ok(objects)
}

fn without_uvs(path: &Path, material: &str) -> ModelError {
    let message = format!(
        "it has no texture coordinates, which the maps of material \"{material}\" need; unwrap it and export it again, or give \
         it a material without maps"
    );
    ModelError::new(path, message)
}

/// Refuses a mesh that mist cannot lie on, at the key that names it.
fn check_mist(material: &Material, object: &Object, at: Location, source: &Source) -> Result<(), SceneError> {
    check_mist_mesh(material, object)
        .map_err(|error| source.error(at, format!("material \"{}\" is mist, but {error}", material.name)))
}
