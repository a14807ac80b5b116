//! Broken bytes must give a scene or an error, never a panic, and never a mesh that breaks its promises.

use std::path::Path;

use glam::{Vec2, Vec3};
use proptest::prelude::*;
use relievo_scene::{LoadOptions, Mesh, Model, Override, Scene};

use crate::glb::{Glb, ONE_NODE, SQUARE, SQUARE_UVS, png};
use crate::scene_files::GOOD;
use crate::{gltf_files, obj_files};

fn check_model(result: Result<Model, String>) {
    if let Ok(model) = result {
        for part in &model.parts {
            part.mesh.validate().unwrap();
        }
    }
}

fn load_scene(bytes: &[u8]) {
    // As Scene::load reads it.
    let text = String::from_utf8_lossy(bytes);
    let options = LoadOptions { make_size: 4, ..LoadOptions::default() };
    let _ = Scene::parse(&text, "scene.toml", Path::new("/nonexistent"), &options);
}

/// A GLB with most of what is read: indices, all attributes, materials, images, nodes.
fn rich_glb() -> Vec<u8> {
    let mut glb = Glb::default();
    let positions = glb.vectors(&SQUARE);
    let normals = glb.vectors(&[[0.0f32, 0.0, 1.0]; 4]);
    let uvs = glb.vectors(&SQUARE_UVS);
    let tangents = glb.vectors(&[[1.0f32, 0.0, 0.0, 1.0]; 4]);
    let indices = glb.indices(&[0, 1, 2, 0, 2, 3]);
    let picture = glb.view(&png([1, 2, 3]));
    glb.finish(&format!(
        r#""meshes":[{{"primitives":[{{"attributes":{{"POSITION":{positions},"NORMAL":{normals},"TEXCOORD_0":{uvs},"TANGENT":{tangents}}},"indices":{indices},"material":0}},{{"attributes":{{"POSITION":{positions},"TEXCOORD_0":{uvs}}},"mode":5}}]}}],"materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}},"normalTexture":{{"index":0}}}}],"textures":[{{"source":0}}],"images":[{{"bufferView":{picture},"mimeType":"image/png"}}],{ONE_NODE}"#
    ))
}

#[test]
fn the_unbroken_files_load() {
    assert_eq!(gltf_files::load(&rich_glb()).unwrap().parts.len(), 2);
    assert_eq!(obj_files::load(obj_files::SQUARE).unwrap().parts.len(), 1);
}

#[test]
fn every_truncation_is_survived() {
    let glb = rich_glb();
    for end in 0..glb.len() {
        assert!(gltf_files::load(&glb[..end]).is_err(), "{end}");
    }
    for end in 0..obj_files::SQUARE.len() {
        check_model(obj_files::load(&obj_files::SQUARE[..end]));
    }
    for end in 0..GOOD.len() {
        load_scene(&GOOD.as_bytes()[..end]);
    }
}

fn mutated(mut bytes: Vec<u8>, changes: &[(prop::sample::Index, u8)]) -> Vec<u8> {
    for (index, byte) in changes {
        let index = index.index(bytes.len());
        bytes[index] = *byte;
    }
    bytes
}

fn changes() -> impl Strategy<Value = Vec<(prop::sample::Index, u8)>> {
    prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6)
}

/// Text more likely to stay well-formed.
fn printable_changes() -> impl Strategy<Value = Vec<(prop::sample::Index, u8)>> {
    let byte = prop::sample::select(b"0123456789-.,/\"[]{}=\n #eE".to_vec());
    prop::collection::vec((any::<prop::sample::Index>(), byte), 1..6)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn flipped_bytes_of_a_glb_are_survived(changes in changes()) {
        check_model(gltf_files::load(&mutated(rich_glb(), &changes)));
    }

    #[test]
    fn other_digits_in_a_glb_are_survived(changes in printable_changes()) {
        check_model(gltf_files::load(&mutated(rich_glb(), &changes)));
    }

    #[test]
    fn flipped_bytes_of_an_obj_are_survived(changes in changes(), others in printable_changes()) {
        let bytes = obj_files::SQUARE.as_bytes().to_vec();
        check_model(obj_files::load(mutated(bytes.clone(), &changes)));
        check_model(obj_files::load(mutated(bytes, &others)));
    }

    #[test]
    fn flipped_bytes_of_a_scene_are_survived(changes in changes(), others in printable_changes()) {
        load_scene(&mutated(GOOD.as_bytes().to_vec(), &changes));
        load_scene(&mutated(GOOD.as_bytes().to_vec(), &others));
    }

    #[test]
    fn any_override_is_survived(path in "[a-z0-9_.\"]{0,12}", value in "\\PC{0,12}", real in 0..6usize) {
        let known = ["camera.position", "lights.0", "materials.wall.relief", "objects.1.mesh", "image.width", "lights"];
        for path in [path.as_str(), known[real]] {
            let change = Override { path: path.to_owned(), value: value.clone() };
            let options = LoadOptions { overrides: vec![change], make_size: 4, ..LoadOptions::default() };
            let _ = Scene::parse(GOOD, "scene.toml", Path::new("/nonexistent"), &options);
        }
    }

    #[test]
    fn any_heap_of_triangles_gets_sound_tangents(
        vertices in prop::collection::vec((0..3i8, 0..3i8, 0..2i8, 0..3i8, 0..3i8, -1..2i8), 1..12),
        corners in prop::collection::vec(any::<[prop::sample::Index; 3]>(), 1..24),
        unit in prop::sample::select(vec![1e-30f32, 1e-10, 1.0, 4e8]),
    ) {
        // Few places, so that vertices coincide, triangles overlap and have no area.
        let positions = vertices.iter().map(|v| Vec3::new(v.0.into(), v.1.into(), v.2.into()) * unit).collect();
        let uvs = vertices.iter().map(|v| Vec2::new(v.3.into(), v.4.into()) * unit).collect();
        let normals = vertices.iter().map(|v| Vec3::new(0.0, v.5.into(), 1.0) * f32::from(v.5 + 1)).collect();
        let triangles = corners.iter().map(|t| t.map(|i| i.index(vertices.len()) as u32)).collect();
        Mesh::with_tangents(positions, normals, uvs, triangles).unwrap().validate().unwrap();
    }
}
