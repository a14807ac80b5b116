//! Supersampling, mip levels and level of detail.

use glam::{Affine3A, Vec2, Vec3};
use relievo_map::{ColorEncoding, ColorMap, Grid};
use relievo_march::Shadow;
use relievo_scene::{Filter, Material, Scene};

use crate::common::*;

/// Black and white squares, eight to a side.
fn checks() -> Material {
    let grid = Grid::from_fn(128, 128, |x, y| {
        let c = if (x / 16 + y / 16) % 2 == 0 { 0.9 } else { 0.1 };
        [c, c, c, 1.0]
    });
    let mut material = plain([1.0; 3]);
    material.maps.base_color = Some(ColorMap { grid, encoding: ColorEncoding::Linear });
    material
}

/// A floor that runs far away.
fn floor(material: Material) -> Scene {
    let mut scene = stage(120, 60, Vec3::new(0.0, 1.0, 0.0));
    scene.camera.target = Vec3::new(0.0, 0.7, -2.0);
    scene.shading.ambient = 0.8;
    add(
        &mut scene,
        shape("plane"),
        material,
        transform(Vec3::new(20.0, 1.0, 20.0), Vec3::ZERO, Vec3::new(0.0, 0.0, -20.0)),
    );
    scene.objects[0].uv_repeat = Vec2::splat(10.0);
    scene
}

fn with_samples(scene: &Scene, samples: u32) -> Scene {
    let mut scene = scene.clone();
    scene.image.samples = samples;
    scene
}

#[test]
fn more_samples_come_closer_to_many() {
    let mut scene = floor(checks());
    add(&mut scene, shape("torus"), plain([0.9, 0.2, 0.1]), moved(0.0, 0.8, -5.0));
    let truth = draw(&with_samples(&scene, 400));
    let errors = [1, 4, 16, 64].map(|n| mean_difference(&draw(&with_samples(&scene, n)), &truth));
    println!("1, 4, 16, 64 samples: {errors:.3?}/255 from 400");
    assert!(errors.windows(2).all(|pair| pair[1] < 0.6 * pair[0]), "{errors:?}");
}

#[test]
fn a_plain_area_is_the_same_with_any_number_of_samples() {
    let mut scene = stage(40, 30, Vec3::new(0.0, 0.0, 1.0));
    add(&mut scene, shape("quad"), plain([0.3, 0.6, 0.9]), Affine3A::IDENTITY);
    let one = draw(&scene);
    for samples in [2, 7, 16] {
        assert_eq!(draw(&with_samples(&scene, samples)).pixels, one.pixels, "{samples} samples");
    }
}

#[test]
fn trilinear_filtering_takes_most_of_the_aliasing_away() {
    let scene = floor(checks());
    let truth = draw(&with_samples(&scene, 64));
    let linear = mean_difference(&draw(&scene), &truth);
    let mut filtered = scene.clone();
    filtered.materials[0].filter = Filter::Trilinear;
    let trilinear = mean_difference(&draw(&filtered), &truth);
    println!("linear {linear:.2}, trilinear {trilinear:.2}");
    assert!(trilinear < 0.6 * linear, "{trilinear} for {linear}");
}

#[test]
fn level_of_detail_takes_aliasing_and_work_away() {
    // A wall of small stones, seen from so far that a pixel spans several texels.
    for (tilt, shadow) in [(15.0, Shadow::None), (15.0, Shadow::Exact), (55.0, Shadow::None)] {
        let mut scene = stage(100, 75, Vec3::new(0.0, 0.0, 3.0));
        scene.lights.push(sun(-1.0, -1.0, -1.0));
        add(
            &mut scene,
            shape("quad"),
            relief(stones(64, 64), 0.04),
            transform(Vec3::splat(2.0), Vec3::new(-tilt, 0.0, 0.0), Vec3::ZERO),
        );
        scene.objects[0].uv_repeat = Vec2::splat(12.0);
        scene.materials[0].filter = Filter::Trilinear;
        scene.materials[0].relief.shadow = shadow;
        let truth = draw(&with_samples(&scene, 64));
        let plain = draw(&scene);
        scene.materials[0].relief.lod = true;
        let lod = draw(&scene);
        let errors = [&plain, &lod].map(|frame| mean_difference(frame, &truth));
        let fetches = [&plain, &lod].map(|frame| frame.aovs.fetches.texels().iter().sum::<f32>());
        println!(
            "{tilt}° {shadow:?}: {:.2}/255, {:.0} fetches; lod {:.2}/255, {:.0} fetches",
            errors[0], fetches[0], errors[1], fetches[1]
        );
        assert!(errors[1] < 0.9 * errors[0], "{errors:?}");
        assert!(fetches[1] < fetches[0], "{fetches:?}");
    }
}

#[test]
fn near_the_eye_neither_changes_the_picture() {
    let mut scene = stage(60, 40, Vec3::new(0.05, 0.1, 0.4));
    scene.lights.push(point_light(1.0, 1.0, 1.0));
    add(&mut scene, shape("quad"), relief(stones(64, 64), 0.03), Affine3A::IDENTITY);
    let sharp = draw(&scene);
    scene.materials[0].filter = Filter::Trilinear;
    scene.materials[0].relief.lod = true;
    assert_eq!(draw(&scene).pixels, sharp.pixels);
}
