//! Scenes that nobody would draw: they end soon, without NaN, without panic.

use std::time::{Duration, Instant};

use glam::{Affine3A, Vec2, Vec3};
use relievo_cpu::{Frame, RenderError};
use relievo_map::{ColorEncoding, ColorMap, Grid, HeightMap, NormalMap};
use relievo_march::{Shadow, Technique};
use relievo_scene::{Edge, Filter, HeightRange, LightKind, Mesh, Scene, ShadingModel, SurfaceTechnique};

use crate::common::*;

fn all_techniques() -> impl Iterator<Item = SurfaceTechnique> {
    SurfaceTechnique::names().map(|name| SurfaceTechnique::from_name(name).unwrap())
}

/// No NaN anywhere, and infinity in the depth of the background only.
fn sound(frame: &Frame, what: &str) {
    let aovs = &frame.aovs;
    for (i, &hit) in aovs.hit.texels().iter().enumerate() {
        let numbers = [
            &aovs.normal.texels()[i][..],
            &aovs.uv.texels()[i],
            &[aovs.fetches.texels()[i], aovs.iterations.texels()[i], aovs.shadow.texels()[i], hit],
        ];
        assert!(numbers.iter().all(|list| list.iter().all(|x| x.is_finite())), "{what}: pixel {i}: {numbers:?}");
        let depth = aovs.depth.texels()[i];
        if hit == 1.0 {
            assert!(depth.is_finite() && depth > 0.0, "{what}: pixel {i} at depth {depth}");
            let length = Vec3::from(aovs.normal.texels()[i]).length();
            assert!((length - 1.0).abs() < 1e-3, "{what}: pixel {i}: a normal of length {length}");
        } else {
            assert!(depth > 0.0, "{what}: pixel {i} at depth {depth}");
        }
        assert!((0.0..=1.0).contains(&aovs.shadow.texels()[i]), "{what}: pixel {i}");
    }
}

fn draw_soon(scene: &Scene, what: &str) -> Frame {
    let start = Instant::now();
    let frame = draw(scene);
    // Most take milliseconds; the limit is for slow and busy machines.
    assert!(start.elapsed() < Duration::from_secs(60), "{what}: {:?}", start.elapsed());
    sound(&frame, what);
    frame
}

fn everything(mesh: &str, eye: Vec3) -> Scene {
    let mut scene = stage(32, 24, eye);
    scene.lights.push(relievo_scene::Light { radius: 0.2, ..point_light(1.0, 1.5, 2.0) });
    add(&mut scene, shape(mesh), relief(hills(32, 16), 0.1), Affine3A::IDENTITY);
    scene.materials[0].relief.grid = 12;
    scene
}

#[test]
fn every_mesh_with_every_technique_shadow_and_edge_is_sound() {
    for mesh in relievo_scene::SHAPE_NAMES {
        for technique in all_techniques() {
            let mut scene = with_technique(&everything(mesh, Vec3::new(1.2, 1.4, 2.0)), technique);
            for (i, shadow) in Shadow::ALL.into_iter().enumerate() {
                scene.materials[0].relief.edge = [Edge::Clip, Edge::Wrap, Edge::Clamp][i % 3];
                scene.materials[0].relief.shadow = shadow;
                scene.materials[0].relief.lod = i % 2 == 0;
                scene.materials[0].midlevel = [1.0, 0.5, 0.0, 0.3][i];
                let frame = draw_soon(&scene, &format!("{mesh} {technique:?} {shadow:?}"));
                assert!(frame.aovs.hit.texels().contains(&1.0), "{mesh} {technique:?}");
            }
        }
    }
}

#[test]
fn the_smallest_pictures_and_maps_are_drawn() {
    let mut scene = everything("quad", Vec3::new(0.0, 0.0, 2.0));
    (scene.image.width, scene.image.height) = (1, 1);
    for (w, h) in [(1, 1), (1, 7), (7, 1), (2, 2)] {
        let maps = &mut scene.materials[0].maps;
        maps.height = Some(HeightMap::new(Grid::from_fn(w, h, |x, y| (x + y) as f32 * 0.1)));
        maps.normal = Some(NormalMap::new(Grid::from_fn(w, h, |_, _| [0.0, 0.0, 1.0])));
        scene.materials[0].filter = Filter::Trilinear;
        scene.materials[0].relief.lod = true;
        for technique in all_techniques() {
            let frame = draw_soon(&with_technique(&scene, technique), "one pixel");
            assert_eq!(frame.pixels.texels().len(), 1);
        }
    }
}

#[test]
fn without_lights_only_the_ambient_part_is_drawn_and_without_objects_the_background() {
    let mut scene = everything("quad", Vec3::new(0.0, 0.0, 1.0));
    scene.lights.clear();
    scene.shading.ambient = 0.5;
    let dim = draw_soon(&scene, "no lights");
    assert!(dim.aovs.shadow.texels().iter().all(|&shadow| shadow == 1.0));
    assert!(dim.pixels.texels().iter().flatten().any(|&c| c > 60));
    scene.objects.clear();
    let empty = draw_soon(&scene, "no objects");
    assert!(empty.pixels.texels().iter().all(|&c| c == [26; 3]));
}

#[test]
fn a_flat_height_scale_draws_the_flat_wall() {
    let mut scene = everything("quad", Vec3::new(0.3, 0.2, 1.2));
    scene.materials[0].height = HeightRange::Scale(0.0);
    let flat = draw(&with_technique(&scene, SurfaceTechnique::Marched(Technique::Normal)));
    for technique in all_techniques().filter(|&t| t != FLAT) {
        let frame = draw_soon(&with_technique(&scene, technique), "no depth");
        for (a, b) in frame.aovs.uv.texels().iter().zip(flat.aovs.uv.texels()) {
            assert!((Vec2::from(*a) - Vec2::from(*b)).length() < 1e-5, "{technique:?}");
        }
        assert!(share_over(&frame, &flat, 2) < 0.01, "{technique:?}");
    }
}

#[test]
fn huge_and_tiny_measures_end_soon() {
    for mesh in ["quad", "torus"] {
        for technique in all_techniques() {
            let base = with_technique(&everything(mesh, Vec3::new(0.8, 0.9, 2.2)), technique);
            let mut deep = base.clone();
            deep.materials[0].height = HeightRange::Scale(1e6);
            draw_soon(&deep, &format!("{mesh} {technique:?}, a million repeats deep"));
            deep.materials[0].height = HeightRange::Depth(1e6);
            deep.materials[0].midlevel = 0.5;
            draw_soon(&deep, &format!("{mesh} {technique:?}, a million units deep"));
        }
    }
}

#[test]
fn a_scene_looks_the_same_at_any_size() {
    for technique in [EXACT, SurfaceTechnique::Displacement] {
        let mut scene = with_technique(&everything("sphere", Vec3::new(0.8, 0.9, 2.2)), technique);
        scene.lights[0].radius = 0.0;
        let truth = draw(&scene);
        for scale in [1e-4f32, 1e-2, 1e4] {
            let mut scaled = scene.clone();
            scaled.camera.position *= scale;
            scaled.camera.near *= scale;
            scaled.lights[0].kind = LightKind::Point { position: Vec3::new(1.0, 1.5, 2.0) * scale };
            scaled.objects[0].transform = Affine3A::from_scale(Vec3::splat(scale));
            let frame = draw_soon(&scaled, &format!("{technique:?} × {scale}"));
            let over = share_over(&frame, &truth, 8);
            assert!(over < 0.01, "{technique:?} × {scale}: {over}");
        }
    }
}

#[test]
fn the_camera_may_stand_anywhere() {
    for technique in all_techniques() {
        let mut scene = with_technique(&everything("quad", Vec3::Z), technique);
        scene.objects[0].uv_repeat = Vec2::splat(4.0);
        for midlevel in [1.0, 0.4] {
            scene.materials[0].midlevel = midlevel;
            for eye in [
                Vec3::new(0.1, 0.2, 0.0),
                Vec3::new(0.1, 0.2, -0.02),
                Vec3::new(0.1, 0.2, 0.01),
                Vec3::new(-0.9, 0.0, 1e-4),
                Vec3::new(0.0, 0.0, -2.0),
                Vec3::new(50.0, 0.0, 0.3),
            ] {
                scene.camera.position = eye;
                for target in [Vec3::new(0.9, 0.3, 0.0), Vec3::new(0.5, 0.0, -0.1)] {
                    scene.camera.target = target;
                    draw_soon(&scene, &format!("{technique:?} from {eye} to {target}"));
                }
            }
        }
    }
}

#[test]
fn meshes_without_usable_texture_coordinates_are_drawn() {
    let positions = vec![Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0), Vec3::X];
    for uvs in [vec![Vec2::ZERO; 4], vec![Vec2::ZERO, Vec2::X, Vec2::X * 2.0, Vec2::Y]] {
        // The second triangle has no area.
        let triangles = vec![[0, 1, 2], [0, 1, 1]];
        let mesh = Mesh::with_tangents(positions.clone(), vec![Vec3::Z; 4], uvs, triangles).unwrap();
        for technique in all_techniques() {
            let mut scene = with_technique(&everything("quad", Vec3::new(0.2, 0.3, 2.0)), technique);
            scene.objects[0].mesh = mesh.clone().into();
            let frame = draw_soon(&scene, &format!("{technique:?} without uv"));
            assert!(frame.aovs.hit.texels().contains(&1.0), "{technique:?}");
        }
    }
}

#[test]
fn extreme_lights_colours_and_surroundings_stay_numbers() {
    for model in [ShadingModel::BlinnPhong, ShadingModel::Pbr] {
        let mut scene = everything("sphere", Vec3::new(0.8, 0.9, 2.2));
        scene.shading.model = model;
        scene.shading.shininess = 1e9;
        scene.lights = vec![point_light(0.0, 0.0, 0.0), sun(0.0, 1.0, 0.0), point_light(0.0, 0.0, 1.0)];
        scene.lights[0].intensity = 1e30;
        scene.lights[1].radius = 1e6;
        scene.lights[2].radius = 1e6;
        let odd = [f32::NAN, f32::INFINITY, -1.0, 1e30];
        let grid = Grid::from_fn(9, 5, |x, y| std::array::from_fn(|k| odd[(x as usize + y as usize + k) % 4]));
        scene.environment = Some(ColorMap { grid, encoding: ColorEncoding::Linear });
        draw_soon(&scene, &format!("{model:?}"));
    }
}

#[test]
fn what_cannot_be_drawn_is_an_error_that_says_why() {
    let mut scene = everything("sphere", Vec3::Z * 3.0);
    scene.materials[0].relief.technique = SurfaceTechnique::Displacement;
    scene.materials[0].relief.grid = 8192;
    let error = try_draw(&scene).unwrap_err();
    assert!(matches!(error, RenderError::TooManyTriangles { object: 0, grid: 8192, .. }), "{error}");
    assert!(error.to_string().contains("smaller grid"), "{error}");

    let refused = |change: &dyn Fn(&mut Scene)| {
        let mut scene = everything("quad", Vec3::Z);
        change(&mut scene);
        matches!(try_draw(&scene), Err(RenderError::Scene(_)))
    };
    assert!(!refused(&|_| {}));
    assert!(refused(&|scene| scene.image.width = 0));
    assert!(refused(&|scene| scene.image.samples = 0));
    assert!(refused(&|scene| scene.camera.target = scene.camera.position));
    assert!(refused(&|scene| scene.camera.up = Vec3::Z));
    assert!(refused(&|scene| scene.camera.position = Vec3::splat(f32::NAN)));
    assert!(refused(&|scene| scene.camera.vertical_fov = f32::NAN));
    assert!(refused(&|scene| scene.objects[0].material = 7));
    assert!(refused(&|scene| scene.objects[0].transform = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0))));
    assert!(refused(&|scene| scene.objects[0].transform.translation.x = f32::NAN));
    assert!(refused(&|scene| scene.objects[0].uv_repeat = Vec2::ZERO));
    assert!(refused(&|scene| std::sync::Arc::make_mut(&mut scene.objects[0].mesh).triangles[0] = [0, 1, 99]));
}
