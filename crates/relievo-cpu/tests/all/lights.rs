//! Lights and reflection, by their formulas.

use glam::{Affine3A, Vec3};
use relievo_map::{ColorEncoding, ColorMap, Grid, linear_to_srgb};
use relievo_scene::{ColorSpace, Light, LightKind, Scene, ShadingModel};

use crate::common::*;

/// A flat wall that fills the view, drawn in plain numbers.
fn board(color: [f32; 3]) -> Scene {
    let mut scene = stage(41, 31, Vec3::new(0.0, 0.0, 1.0));
    scene.shading.color_space = ColorSpace::Display;
    scene.shading.ambient = 0.0;
    add(&mut scene, shape("quad"), plain(color), transform(Vec3::splat(10.0), Vec3::ZERO, Vec3::ZERO));
    scene
}

fn pbr(mut scene: Scene, roughness: f32, metallic: f32) -> Scene {
    scene.shading.model = ShadingModel::Pbr;
    scene.materials[0].roughness = roughness;
    scene.materials[0].metallic = metallic;
    scene
}

/// The number in a channel of the middle pixel, 0..1.
fn middle(scene: &Scene, channel: usize) -> f32 {
    let frame = draw(scene);
    f32::from(frame.pixels.get(scene.image.width / 2, scene.image.height / 2)[channel]) / 255.0
}

fn close(a: f32, b: f32) -> bool {
    (a - b).abs() < 0.6 / 255.0
}

#[test]
fn blinn_phong_is_the_tutorials_formula_at_every_pixel() {
    let color = [0.7, 0.4, 0.2];
    for space in [ColorSpace::Display, ColorSpace::Linear] {
        let mut scene = board(color);
        scene.shading.color_space = space;
        scene.shading.ambient = 0.1;
        let light = Vec3::new(0.3, 0.5, 0.8);
        scene.lights.push(Light { color: [1.0, 0.5, 0.25], ..point_light(light.x, light.y, light.z) });
        let frame = draw(&scene);
        for (x, y) in [(20, 15), (0, 0), (33, 7), (12, 28)] {
            // Where the pixel's ray meets z = 0.
            let half = 22.5f32.to_radians().tan();
            let [sx, sy] = [(x as f32 + 0.5) / 41.0 * 2.0 - 1.0, 1.0 - (y as f32 + 0.5) / 31.0 * 2.0];
            let point = Vec3::new(sx * half * 41.0 / 31.0, sy * half, 0.0);
            let (l, v) = ((light - point).normalize(), (scene.camera.position - point).normalize());
            let highlight = 0.2 * (l + v).normalize().z.powi(32);
            for k in 0..3 {
                let expected = 0.1 * color[k] + (l.z * color[k] + highlight) * [1.0, 0.5, 0.25][k];
                let expected = if space == ColorSpace::Linear { linear_to_srgb(expected) } else { expected };
                let drawn = f32::from(frame.pixels.get(x, y)[k]) / 255.0;
                assert!(close(drawn, expected), "{space:?} {x},{y}: {drawn} for {expected}");
            }
        }
    }
}

#[test]
fn with_pbr_light_falls_off_with_the_squared_distance() {
    let at = |distance: f32, intensity: f32| {
        let mut scene = pbr(board([1.0; 3]), 1.0, 0.0);
        scene.lights.push(Light { intensity, ..point_light(0.0, 0.0, distance) });
        middle(&scene, 0)
    };
    let near = at(1.0, 2.0);
    assert!(near > 0.3);
    assert!(close(at(2.0, 8.0), near) && close(at(5.0, 50.0), near));
    assert!((at(2.0, 2.0) * 4.0 - near).abs() < 3.0 / 255.0);
    // The tutorials' lights do not fall off.
    let mut scene = board([0.6; 3]);
    scene.shading.specular = 0.0;
    for distance in [1.0, 7.0] {
        scene.lights = vec![point_light(0.0, 0.0, distance)];
        assert!(close(middle(&scene, 0), 0.6));
    }
}

#[test]
fn a_matt_surface_under_a_directional_light_follows_the_cosine() {
    for degrees in [0.0f32, 40.0, 70.0, 95.0] {
        let mut scene = pbr(board([0.8, 0.8, 0.8]), 1.0, 0.0);
        let (sin, cos) = degrees.to_radians().sin_cos();
        scene.lights.push(Light { intensity: std::f32::consts::PI, ..sun(sin, 0.0, -cos) });
        let value = middle(&scene, 0);
        // Lambert, less what Fresnel mirrors away, plus the faint gloss of a rough dielectric.
        let lambert = 0.8 * cos.max(0.0);
        assert!((value - lambert).abs() < 0.06 * lambert + 0.003, "{degrees}°: {value} for {lambert}");
    }
}

#[test]
fn a_mirror_shows_the_light_only_in_the_mirrored_direction() {
    let at = |degrees: f32, roughness: f32| {
        let mut scene = pbr(board([0.9, 0.5, 0.1]), roughness, 1.0);
        let (sin, cos) = degrees.to_radians().sin_cos();
        scene.lights.push(Light { intensity: 0.05, ..sun(sin, 0.0, -cos) });
        draw(&scene).pixels.get(20, 15).map(f32::from)
    };
    let [r, g, b] = at(0.0, 0.3);
    assert!(
        r > 50.0 && (g / r - 5.0 / 9.0).abs() < 0.03 && (b / r - 1.0 / 9.0).abs() < 0.03,
        "metal tints: {r} {g} {b}"
    );
    assert!(at(25.0, 0.3)[0] < 0.05 * r);
    // Rougher: the highlight is dimmer in the middle and wider.
    assert!(at(0.0, 0.5)[0] < 0.5 * r && at(25.0, 0.5)[0] > at(25.0, 0.3)[0]);
}

#[test]
fn a_spot_shines_inside_its_cone_and_fades_to_its_border() {
    let mut scene = board([1.0; 3]);
    (scene.image.width, scene.image.height) = (201, 201);
    scene.shading.specular = 0.0;
    let kind = |position| LightKind::Spot { position, direction: Vec3::NEG_Z, inner_angle: 8.0, outer_angle: 16.0 };
    scene.lights.push(Light { kind: kind(Vec3::Z), ..point_light(0.0, 0.0, 1.0) });
    let frame = draw(&scene);
    let half = 22.5f32.to_radians().tan();
    let mut seen = [0; 3];
    for x in 100..201 {
        let angle = ((x as f32 + 0.5) / 201.0 * 2.0 - 1.0) * half;
        let degrees = angle.atan().to_degrees();
        let value = f32::from(frame.pixels.get(x, 100)[0]) / 255.0 / degrees.to_radians().cos();
        let zone = if degrees < 7.9 {
            assert!(value > 0.99);
            0
        } else if degrees > 16.1 {
            assert_eq!(value, 0.0);
            2
        } else {
            assert!((0.0..1.01).contains(&value));
            1
        };
        seen[zone] += 1;
        if x > 100 {
            assert!(value <= f32::from(frame.pixels.get(x - 1, 100)[0]) / 255.0 / degrees.to_radians().cos() + 0.01);
        }
    }
    assert!(seen.iter().all(|&n| n > 10), "{seen:?}");
}

#[test]
fn white_surroundings_hide_a_white_matt_thing_and_a_mirror() {
    for (roughness, metallic) in [(1.0, 0.0), (0.0, 1.0), (0.5, 1.0), (0.3, 0.0)] {
        let mut scene = stage(60, 60, Vec3::new(0.0, 0.0, 3.5));
        scene.shading.color_space = ColorSpace::Display;
        scene.shading.ambient = 0.0;
        add(&mut scene, shape("sphere"), plain([1.0; 3]), Affine3A::IDENTITY);
        let grid = Grid::from_fn(16, 8, |_, _| [0.5, 0.5, 0.5, 1.0]);
        scene.environment = Some(ColorMap { grid, encoding: ColorEncoding::Srgb });
        let frame = draw(&pbr(scene, roughness, metallic));
        assert!(frame.aovs.hit.texels().contains(&1.0));
        for &[value, _, _] in frame.pixels.texels() {
            let value = f32::from(value) / 127.5;
            // Rough metals lose light between their facets; nothing may gain more than rounding and the fit's error.
            let least = if metallic == 1.0 && roughness > 0.0 { 0.7 } else { 0.93 };
            assert!(value > least && value < 1.06, "roughness {roughness}, metallic {metallic}: {value}");
        }
    }
}

#[test]
fn surroundings_stand_upright_behind_and_in_a_mirror() {
    // A bright sky over a dark ground, a red patch to the right (+X) of a view along −Z.
    let grid = Grid::from_fn(64, 32, |x, y| {
        if (44..52).contains(&x) && (14..18).contains(&y) {
            [1.0, 0.0, 0.0, 1.0]
        } else if y < 14 {
            [0.8, 0.8, 0.8, 1.0]
        } else {
            [0.1, 0.1, 0.1, 1.0]
        }
    });
    let mut scene = stage(60, 60, Vec3::new(0.0, 0.0, 3.0));
    scene.environment = Some(ColorMap { grid, encoding: ColorEncoding::Linear });
    scene.shading.ambient = 0.0;
    scene.camera.target = Vec3::new(6.0, 0.0, 3.0);
    let sky = draw(&scene);
    assert!(brightness(&sky, 30, 2) > 2.0 * brightness(&sky, 30, 57));
    let [r, g, _] = *sky.pixels.get(30, 30);
    assert!(r > 200 && g < 50, "{r} {g}");
    // A mirror ball: its upper half shows the sky, its right half what lies to the right.
    scene.camera.target = Vec3::ZERO;
    add(&mut scene, shape("sphere"), plain([1.0; 3]), Affine3A::IDENTITY);
    let ball = draw(&pbr(scene, 0.0, 1.0));
    assert!(brightness(&ball, 30, 20) > 2.0 * brightness(&ball, 30, 40));
    let reddest = (0..60).max_by_key(|&x| i32::from(ball.pixels.get(x, 30)[0]) - i32::from(ball.pixels.get(x, 30)[1]));
    assert!(reddest.is_some_and(|x| (36..58).contains(&x)), "{reddest:?}");
}

#[test]
fn occlusion_darkens_what_comes_from_all_around_and_not_the_lights() {
    let mut scene = board([0.8; 3]);
    scene.shading.ambient = 0.5;
    let open = middle(&scene, 0);
    scene.materials[0].maps.ao = Some(relievo_map::ScalarMap::new(Grid::from_fn(4, 4, |_, _| 0.5)));
    assert!(close(middle(&scene, 0), open / 2.0));
    scene.shading.ambient = 0.0;
    scene.lights.push(sun(0.0, 0.0, -1.0));
    scene.shading.specular = 0.0;
    assert!(close(middle(&scene, 0), 0.8));
}
