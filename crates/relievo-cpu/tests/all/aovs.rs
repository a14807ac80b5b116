//! The output variables of a frame beside its colours.

use glam::{Affine3A, Vec2, Vec3};
use relievo_scene::Scene;

use crate::common::*;

fn tilted_quad() -> (Scene, Affine3A) {
    let mut scene = stage(80, 60, Vec3::new(0.4, 0.3, 2.5));
    let transform = transform(Vec3::new(0.8, 0.5, 1.0), Vec3::new(20.0, 30.0, 10.0), Vec3::new(0.1, -0.1, 0.2));
    add(&mut scene, shape("quad"), plain([0.5; 3]), transform);
    (scene, transform)
}

/// The unit direction of a pixel's ray, from the camera's definition.
fn ray(scene: &Scene, x: u32, y: u32) -> Vec3 {
    let camera = &scene.camera;
    let forward = (camera.target - camera.position).normalize();
    let right = forward.cross(camera.up).normalize();
    let up = right.cross(forward);
    let (w, h) = (scene.image.width as f32, scene.image.height as f32);
    let half = (camera.vertical_fov.to_radians() / 2.0).tan();
    let (sx, sy) = ((x as f32 + 0.5) / w * 2.0 - 1.0, 1.0 - (y as f32 + 0.5) / h * 2.0);
    (forward + right * (sx * half * w / h) + up * (sy * half)).normalize()
}

#[test]
fn depth_normal_uv_and_hit_of_a_flat_quad_are_those_of_algebra() {
    let (scene, transform) = tilted_quad();
    let frame = draw(&scene);
    let normal = (transform.matrix3.inverse().transpose() * glam::Vec3A::Z).normalize();
    let forward = (scene.camera.target - scene.camera.position).normalize();
    let (mut inside, mut outside) = (0, 0);
    for y in 0..60 {
        for x in 0..80 {
            let direction = ray(&scene, x, y);
            let inverse = transform.inverse();
            let (o, d) = (inverse.transform_point3(scene.camera.position), inverse.transform_vector3(direction));
            let t = -o.z / d.z;
            let local = o + d * t;
            let at = |grid: &relievo_map::Grid<f32>| *grid.get(x, y);
            if local.x.abs().max(local.y.abs()) > 1.001 {
                outside += 1;
                assert_eq!(at(&frame.aovs.hit), 0.0);
                assert_eq!(at(&frame.aovs.depth), f32::INFINITY);
                assert_eq!(*frame.aovs.normal.get(x, y), [0.0; 3]);
                assert_eq!(*frame.aovs.material.get(x, y), None);
                assert_eq!(at(&frame.aovs.shadow), 1.0);
            } else if local.x.abs().max(local.y.abs()) < 0.999 {
                inside += 1;
                assert_eq!(at(&frame.aovs.hit), 1.0);
                assert!((at(&frame.aovs.depth) - t * direction.dot(forward)).abs() < 1e-5);
                assert!((Vec3::from(*frame.aovs.normal.get(x, y)) - Vec3::from(normal)).length() < 1e-5);
                let uv = Vec2::new(local.x * 0.5 + 0.5, 0.5 - local.y * 0.5);
                assert!((Vec2::from(*frame.aovs.uv.get(x, y)) - uv).length() < 1e-5);
                assert_eq!(*frame.aovs.material.get(x, y), Some(0));
            }
            assert_eq!((at(&frame.aovs.fetches), at(&frame.aovs.iterations)), (0.0, 0.0));
        }
    }
    assert!(inside > 500 && outside > 500);
}

#[test]
fn fetches_are_counted_where_a_relief_was_marched() {
    let mut scene = stage(80, 60, Vec3::new(0.0, 0.0, 3.0));
    add(&mut scene, shape("quad"), relief(hills(32, 32), 0.05), moved(-1.2, 0.0, 0.0));
    add(&mut scene, shape("quad"), plain([0.5; 3]), moved(1.2, 0.0, 0.0));
    let frame = draw(&scene);
    let mut seen = [0; 3];
    for (material, &fetches) in frame.aovs.material.texels().iter().zip(frame.aovs.fetches.texels()) {
        match material {
            Some(0) => assert!(fetches >= 1.0),
            _ => assert_eq!(fetches, 0.0),
        }
        seen[material.map_or(2, |m| m as usize)] += 1;
    }
    assert!(seen.iter().all(|&n| n > 300), "{seen:?}");
}

#[test]
fn depth_is_that_of_the_polygon_unless_the_hit_is_written() {
    let mut scene = stage(80, 60, Vec3::new(0.5, 0.3, 1.0));
    scene.camera.vertical_fov = 30.0;
    add(&mut scene, shape("quad"), relief(stones(64, 64), 0.06), Affine3A::IDENTITY);
    let flat = draw(&with_technique(&scene, FLAT));
    let written = draw(&scene);
    scene.materials[0].relief.write_depth = Some(false);
    let unwritten = draw(&scene);
    assert_eq!(unwritten.aovs.depth, flat.aovs.depth);
    assert_eq!(unwritten.aovs.uv, written.aovs.uv);
    let deeper = written.aovs.depth.texels().iter().zip(flat.aovs.depth.texels()).filter(|(a, b)| **a > *b + 0.01);
    assert!(deeper.count() > 1000);
}

#[test]
fn several_samples_leave_the_centre_in_the_aovs_and_average_the_counts() {
    let (mut scene, _) = tilted_quad();
    let one = draw(&scene);
    scene.image.samples = 5;
    let five = draw(&scene);
    assert_eq!((&one.aovs.depth, &one.aovs.uv, &one.aovs.normal), (&five.aovs.depth, &five.aovs.uv, &five.aovs.normal));
    let partly = five.aovs.hit.texels().iter().filter(|&&hit| hit > 0.0 && hit < 1.0).count();
    assert!(partly > 20, "{partly} pixels on the rim");
    assert!(five.aovs.hit.texels().iter().all(|hit| (hit * 5.0).fract() == 0.0));
}
