//! glTF 2.0 (Khronos, ISO/IEC 12113:2022), text and binary.
//!
//! The `gltf` crate gives the JSON structure; every index and range in it is checked here, because its own readers trust
//! them.

mod accessors;
mod buffers;
mod document;
mod materials;
mod texture_transform;

use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;

use glam::{Affine3A, Mat4, Quat, Vec2, Vec3, Vec4};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::scene::Node;
use gltf::json::validation::Checked;
use relievo_map::Limits;

use super::part::{Model, ModelError, Part};
use super::read_file::read_file;
use crate::mesh::{flat_normals, has_area};
use crate::{Mesh, MeshError};
use document::GltfDocument;

pub(super) fn load(path: &Path, limits: &Limits, with_materials: bool) -> Result<Model, ModelError> {
    parse(&read_file(path)?, path, limits, with_materials)
}

pub(super) fn parse(bytes: &[u8], path: &Path, limits: &Limits, with_materials: bool) -> Result<Model, ModelError> {
    let file = GltfDocument::new(bytes, path)?;
    let mut loader = Loader {
        file: &file,
        with_materials,
        meshes: vec![None; file.root.meshes.len()],
        triangles: 0,
        materials: Vec::new(),
        model: Model::default(),
    };
    loader.nodes()?;
    let Loader { materials, mut model, .. } = loader;
    for index in materials {
        let material = materials::read(&file, index, limits, &mut model.notes)?;
        model.materials.push(material);
    }
    Ok(model)
}

/// A primitive of a mesh, shared by all nodes that draw it.
#[derive(Clone)]
struct Piece {
    mesh: Arc<Mesh>,
    material: Option<usize>,
    has_uvs: bool,
    two_sided: bool,
}

struct Loader<'a> {
    file: &'a GltfDocument<'a>,
    with_materials: bool,
    meshes: Vec<Option<Vec<Piece>>>,
    triangles: usize,
    /// The file's materials in use, in the order of use.
    materials: Vec<usize>,
    model: Model,
}

impl Loader<'_> {
    fn note(&mut self, message: impl AsRef<str>) {
        let note = format!("{}: {}", self.file.path.display(), message.as_ref());
        if !self.model.notes.contains(&note) {
            self.model.notes.push(note);
        }
    }

    /// Walks the default scene, without recursion.
    fn nodes(&mut self) -> Result<(), ModelError> {
        let file = self.file;
        let root = &file.root;
        let mut stack: Vec<(usize, Affine3A)> = Vec::new();
        let scene = match root.scene {
            Some(index) => Some(file.get(&root.scenes, index.value(), "scene")?),
            None => root.scenes.first(),
        };
        match scene {
            Some(scene) => {
                stack.extend(scene.nodes.iter().rev().map(|node| (node.value(), Affine3A::IDENTITY)));
            }
            None => {
                // A library of nodes: everything that is nobody's child.
                let children = root.nodes.iter().flat_map(|node| node.children.iter().flatten());
                let children: HashSet<usize> = children.map(gltf::json::Index::value).collect();
                let roots = (0..root.nodes.len()).rev().filter(|index| !children.contains(index));
                stack.extend(roots.map(|index| (index, Affine3A::IDENTITY)));
            }
        }
        let mut seen = vec![false; root.nodes.len()];
        while let Some((index, parent)) = stack.pop() {
            let node = file.get(&root.nodes, index, "node")?;
            if std::mem::replace(&mut seen[index], true) {
                return Err(file.error(format!("node {index} is reached twice; the nodes must form a tree")));
            }
            let transform = parent * self.transform(node, index)?;
            if let Some(mesh) = node.mesh {
                if node.skin.is_some() {
                    self.note("skinned meshes are drawn as they were modelled");
                }
                self.add_parts(mesh.value(), transform)?;
            }
            let children = node.children.iter().flatten().rev();
            stack.extend(children.map(|child| (child.value(), transform)));
        }
        Ok(())
    }

    fn transform(&self, node: &Node, index: usize) -> Result<Affine3A, ModelError> {
        let transform = match node.matrix {
            Some(columns) => Affine3A::from_mat4(Mat4::from_cols_array(&columns)),
            None => {
                let rotation = node.rotation.map_or([0.0, 0.0, 0.0, 1.0], |rotation| rotation.0);
                let rotation = Vec4::from_array(rotation).as_dvec4().normalize_or(glam::DVec4::W).as_vec4();
                Affine3A::from_scale_rotation_translation(
                    node.scale.map_or(Vec3::ONE, Vec3::from_array),
                    Quat::from_vec4(rotation),
                    node.translation.map_or(Vec3::ZERO, Vec3::from_array),
                )
            }
        };
        if transform.is_finite() {
            Ok(transform)
        } else {
            Err(self.file.error(format!("node {index} has a place or turn that is not finite")))
        }
    }

    /// Adds a mesh of the file as parts with this transform.
    fn add_parts(&mut self, index: usize, transform: Affine3A) -> Result<(), ModelError> {
        let file = self.file;
        let mesh = file.get(&file.root.meshes, index, "mesh")?;
        if self.meshes[index].is_none() {
            let mut pieces = Vec::new();
            for (number, primitive) in mesh.primitives.iter().enumerate() {
                pieces.extend(self.piece(primitive, &format!("mesh {index}, primitive {number}"))?);
            }
            self.meshes[index] = Some(pieces);
        }
        for piece in self.meshes[index].iter().flatten() {
            self.model.parts.push(Part {
                mesh: Arc::clone(&piece.mesh),
                material: piece.material,
                has_uvs: piece.has_uvs,
                two_sided: piece.two_sided,
                transform,
            });
        }
        Ok(())
    }

    /// Reads the mesh of a primitive; `None` if it has no triangles.
    fn piece(&mut self, primitive: &Primitive, name: &str) -> Result<Option<Piece>, ModelError> {
        let file = self.file;
        let Checked::Valid(mode) = primitive.mode else {
            return Err(file.error(format!("{name}: unknown kind of primitive")));
        };
        if matches!(mode, Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) {
            self.note("points and lines are left out");
            return Ok(None);
        }
        if primitive.targets.is_some() {
            self.note("morph targets are left out");
        }
        let accessor = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).map(gltf::json::Index::value);
        let Some(positions) = accessor(Semantic::Positions) else {
            return Err(file.error(format!("{name}: it has no positions")));
        };
        let mut positions: Vec<Vec3> = file.read(positions, &format!("{name}, positions"))?;
        let indices = match primitive.indices {
            Some(index) => file.read_indices(index.value(), &format!("{name}, indices"))?,
            None => (0..positions.len() as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|&&index| index as usize >= positions.len()) {
            return Err(file.error(format!("{name}: it names vertex {index}, but has {}", positions.len())));
        }
        let mut triangles = triangles(&indices, mode);
        self.triangles += triangles.len();
        if self.triangles > Mesh::MAX_TRIANGLES {
            return Err(file.error(MeshError::TooManyTriangles(self.triangles).to_string()));
        }
        // NaN has no area: it must be found before the triangles without one are dropped.
        if positions.iter().any(|position| !position.is_finite()) {
            return Err(file.error(format!("{name}: a position is not a finite number")));
        }
        let before = triangles.len();
        triangles.retain(|&triangle| has_area(&positions, triangle));
        if triangles.len() < before {
            self.note(format!("{name}: {} triangles without area were left out", before - triangles.len()));
        }
        if triangles.is_empty() {
            return Ok(None);
        }

        let normals: Option<Vec<Vec3>> =
            accessor(Semantic::Normals).map(|index| file.read(index, &format!("{name}, normals"))).transpose()?;
        let uvs: Option<Vec<Vec2>> = accessor(Semantic::TexCoords(0))
            .map(|index| file.read(index, &format!("{name}, texture coordinates")))
            .transpose()?;
        let tangents: Option<Vec<Vec4>> =
            accessor(Semantic::Tangents).map(|index| file.read(index, &format!("{name}, tangents"))).transpose()?;
        let has_uvs = uvs.is_some();
        if !has_uvs {
            self.note(format!("{name}: no texture coordinates"));
        }
        let mut uvs = uvs.unwrap_or_else(|| vec![Vec2::ZERO; positions.len()]);
        // The specification: without normals flat ones, and then tangents of the file do not count.
        let tangents = tangents.filter(|_| normals.is_some() && has_uvs);
        let mesh = match (normals, tangents) {
            (Some(normals), Some(tangents)) => Mesh::from_parts(positions, normals, uvs, tangents, triangles),
            (Some(normals), None) => Mesh::with_tangents(positions, normals, uvs, triangles),
            (None, _) => {
                if uvs.len() != positions.len() {
                    let error = MeshError::Lengths { positions: positions.len(), list: "uvs", count: uvs.len() };
                    return Err(file.error(format!("{name}: {error}")));
                }
                let normals = flat_normals(&positions, &triangles).into_iter().flatten().collect();
                let corners: Vec<usize> = triangles.iter().flatten().map(|&index| index as usize).collect();
                positions = corners.iter().map(|&corner| positions[corner]).collect();
                uvs = corners.iter().map(|&corner| uvs[corner]).collect();
                let triangles = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
                Mesh::with_tangents(positions, normals, uvs, triangles)
            }
        };
        let mesh = mesh.map_err(|error| file.error(format!("{name}: {error}")))?;
        let two_sided = primitive.material.and_then(|index| file.root.materials.get(index.value()));
        let two_sided = two_sided.is_some_and(|material| material.double_sided);
        Ok(Some(Piece { mesh: Arc::new(mesh), material: self.material(primitive)?, has_uvs, two_sided }))
    }

    /// Returns the index of the primitive's material in the model's list.
    fn material(&mut self, primitive: &Primitive) -> Result<Option<usize>, ModelError> {
        let Some(index) = primitive.material.filter(|_| self.with_materials) else { return Ok(None) };
        let index = index.value();
        self.file.get(&self.file.root.materials, index, "material")?;
        Ok(Some(self.materials.iter().position(|&known| known == index).unwrap_or_else(|| {
            self.materials.push(index);
            self.materials.len() - 1
        })))
    }
}

/// Returns the triangles of a list, strip or fan, all with the same winding.
fn triangles(indices: &[u32], mode: Mode) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => indices
            .windows(3)
            .enumerate()
            .map(|(i, w)| if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[0], w[2], w[1]] })
            .collect(),
        Mode::TriangleFan => indices.windows(2).skip(1).map(|pair| [pair[0], pair[1], indices[0]]).collect(),
        // A rest of one or two indices is no triangle.
        _ => indices.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    }
}
