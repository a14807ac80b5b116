//! Prints the content of a scene: `cargo run -p relievo-scene --example print_scene -- scenes/wall.toml`.
//!
//! Without a file it puts a scene together in code.

// An example reports what it finds.
#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;
use std::sync::Arc;

use glam::{Affine3A, Vec2};
use relievo_scene::{
    Camera, HeightRange, ImageSettings, Light, LightKind, LoadOptions, Material, Mesh, Object, Scene, Shading,
};

fn main() -> Result<(), Box<dyn Error>> {
    let scene = match std::env::args().nth(1) {
        Some(path) => Scene::load(Path::new(&path), &LoadOptions::default())?,
        None => in_code()?,
    };
    scene.validate()?;

    let Scene { image, camera, lights, materials, objects, notes, .. } = &scene;
    println!("{} × {} pixels, seen from {}", image.width, image.height, camera.position);
    for light in lights {
        println!("{} light of intensity {}", light.kind.name(), light.intensity);
    }
    for material in materials {
        let size = material.maps.height.as_ref().map(|map| (map.grid().width(), map.grid().height()));
        println!("material \"{}\": technique {}, height map {size:?}", material.name, material.relief.technique.name());
    }
    for object in objects {
        let name = &materials[object.material].name;
        println!("object: {} triangles of material \"{name}\"", object.mesh.triangles.len());
    }
    for note in notes {
        println!("note: {note}");
    }
    Ok(())
}

/// A sphere of cobbles under one light.
fn in_code() -> Result<Scene, Box<dyn Error>> {
    let material = Material {
        name: "cobbles".to_owned(),
        maps: relievo_make::make("cobbles", 256)?,
        height: HeightRange::Scale(relievo_make::height_scale("cobbles")?),
        ..Material::default()
    };
    let sun = LightKind::Directional { direction: glam::Vec3::new(-1.0, -2.0, -1.0).normalize() };
    Ok(Scene {
        image: ImageSettings::default(),
        camera: Camera::default(),
        lights: vec![Light { kind: sun, color: [1.0; 3], intensity: 1.0, radius: 0.0 }],
        shading: Shading::default(),
        materials: vec![material],
        objects: vec![Object {
            mesh: Arc::new(Mesh::sphere()),
            material: 0,
            transform: Affine3A::IDENTITY,
            uv_repeat: Vec2::new(4.0, 2.0),
        }],
        environment: None,
        notes: Vec::new(),
    })
}
