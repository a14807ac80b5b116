//! Shadows of reliefs on themselves and on others, and of others on reliefs.

use glam::{Affine3A, Vec3};
use relievo_cpu::Frame;
use relievo_march::Shadow;
use relievo_scene::{Light, Scene};

use crate::common::*;

fn lit(frame: &Frame) -> f64 {
    let shadow = frame.aovs.shadow.texels();
    shadow.iter().map(|&factor| f64::from(factor)).sum::<f64>() / shadow.len() as f64
}

/// The fraction of pixels whose shadow factors differ.
fn differently_lit(a: &Frame, b: &Frame) -> f64 {
    let pairs = a.aovs.shadow.texels().iter().zip(b.aovs.shadow.texels());
    pairs.filter(|(a, b)| (*a - *b).abs() > 0.1).count() as f64 / a.aovs.shadow.texels().len() as f64
}

/// The inside of a wall under a low light.
fn wall() -> Scene {
    let mut scene = stage(160, 120, Vec3::new(0.3, -0.3, 0.9));
    scene.camera.target = Vec3::new(0.05, -0.05, 0.0);
    scene.camera.vertical_fov = 40.0;
    scene.lights.push(sun(0.8, -0.5, -0.45));
    add(&mut scene, shape("quad"), relief(stones(64, 64), 0.05), Affine3A::IDENTITY);
    scene
}

#[test]
fn a_relief_shadows_itself_as_its_geometry_does() {
    for light in [sun(0.8, -0.5, -0.45), sun(-0.2, -1.0, -0.3), point_light(-0.8, 0.4, 0.25)] {
        let mut scene = wall();
        scene.lights = vec![light];
        let (exact, truth) = (draw(&scene), draw(&displaced(&scene, 129)));
        let wrong = differently_lit(&exact, &truth);
        println!("lit {:.3}, {wrong:.5} of the pixels differ", lit(&exact));
        assert!((0.3..0.95).contains(&lit(&exact)));
        assert!(wrong < 0.006, "{wrong}");
    }
}

#[test]
fn no_point_of_an_open_surface_shadows_itself() {
    // Every point of a gentle relief sees a light high above it: one dark pixel is acne.
    for midlevel in [1.0, 0.5, 0.0] {
        let mut scene = wall();
        scene.materials[0] = relief(hills(64, 64), 0.05);
        scene.materials[0].midlevel = midlevel;
        scene.lights = vec![sun(0.1, -0.1, -1.0), point_light(0.2, 0.1, 3.0)];
        for (name, frame) in [("exact", draw(&scene)), ("displaced", draw(&displaced(&scene, 129)))] {
            assert!(frame.aovs.shadow.texels().iter().all(|&factor| factor == 1.0), "{name}, midlevel {midlevel}");
        }
        scene.objects[0].transform =
            transform(Vec3::splat(1e3), Vec3::new(0.0, 30.0, 0.0), Vec3::new(1e4, 0.0, -500.0));
        scene.objects[0].uv_repeat = glam::Vec2::splat(40.0);
        scene.camera.position = Vec3::new(1e4, 0.0, 500.0);
        scene.camera.target = Vec3::new(1e4, 0.0, -500.0);
        scene.lights = vec![sun(-0.5, 0.0, -0.87)];
        let frame = draw(&scene);
        assert!(lit(&frame) > 0.999, "far away, midlevel {midlevel}: {}", lit(&frame));
    }
}

#[test]
fn curved_meshes_are_lit_up_to_their_terminator() {
    for mesh in ["sphere", "cylinder", "torus"] {
        let mut scene = stage(120, 90, Vec3::new(0.0, 0.8, 3.6));
        scene.lights.push(sun(-0.3, -0.4, -1.0));
        let mut gentle = relief(hills(64, 64), 0.004);
        gentle.maps.base_color = None;
        add(&mut scene, shape(mesh), gentle, Affine3A::IDENTITY);
        let frame = draw(&scene);
        let to_light = Vec3::new(0.3, 0.4, 1.0).normalize();
        let (mut lit, mut dark) = (0, 0);
        let flat = draw(&with_technique(&scene, FLAT));
        for i in 0..flat.aovs.hit.texels().len() {
            // Well on the light's side by the mesh's own normal; the torus may stand in its own light.
            if Vec3::from(flat.aovs.normal.texels()[i]).dot(to_light) > 0.35 && flat.aovs.shadow.texels()[i] == 1.0 {
                lit += 1;
                dark += u32::from(frame.aovs.shadow.texels()[i] < 1.0);
            }
        }
        println!("{mesh}: {dark} of {lit} pixels dark");
        assert!(lit > 1000 && dark * 200 < lit, "{mesh}: {dark} of {lit}");
    }
}

#[test]
fn other_things_cast_their_shadows_on_the_relief_where_it_is() {
    let mut scene = wall();
    scene.lights = vec![point_light(-0.9, 0.9, 1.2)];
    let alone = draw(&scene);
    add(
        &mut scene,
        shape("sphere"),
        plain([0.8, 0.3, 0.2]),
        transform(Vec3::splat(0.12), Vec3::ZERO, Vec3::new(-0.15, 0.1, 0.25)),
    );
    let (exact, truth) = (draw(&scene), draw(&displaced(&scene, 129)));
    let wrong = differently_lit(&exact, &truth);
    println!("lit {:.3} of {:.3}, {wrong:.5} differ", lit(&exact), lit(&alone));
    assert!(lit(&exact) < lit(&alone) - 0.02);
    assert!(wrong < 0.008, "{wrong}");
}

#[test]
fn a_relief_casts_its_shadows_on_other_things() {
    // A sphere and a flat board half sunk into the wall: below the lid the stones stand in their light.
    for midlevel in [1.0, 0.5, 0.0] {
        let mut scene = wall();
        scene.materials[0].midlevel = midlevel;
        let low = -0.1 * (midlevel - 0.35);
        add(
            &mut scene,
            shape("quad"),
            plain([0.9; 3]),
            transform(Vec3::splat(0.25), Vec3::ZERO, Vec3::new(0.1, 0.0, low)),
        );
        add(
            &mut scene,
            shape("sphere"),
            plain([0.9; 3]),
            transform(Vec3::splat(0.12), Vec3::ZERO, Vec3::new(-0.1, -0.12, low - 0.05)),
        );
        let (exact, truth) = (draw(&scene), draw(&displaced(&scene, 129)));
        let (mut dark, mut seen, mut wrong) = (0, 0, 0);
        for i in 0..exact.aovs.hit.texels().len() {
            if [&exact, &truth].iter().all(|frame| frame.aovs.material.texels()[i].is_some_and(|m| m > 0)) {
                seen += 1;
                let [a, b] = [&exact, &truth].map(|frame| frame.aovs.shadow.texels()[i]);
                dark += u32::from(b == 0.0);
                wrong += u32::from(a != b);
            }
        }
        println!("midlevel {midlevel}: {seen} pixels of other things, {dark} dark, {wrong} differ");
        assert!(seen > 1000 && dark > 100 && wrong * 50 < seen, "midlevel {midlevel}: {seen} {dark} {wrong}");
    }
}

#[test]
fn a_wide_light_gives_a_penumbra_between_light_and_shade() {
    let mut scene = wall();
    scene.lights = vec![point_light(-0.9, 0.9, 1.2)];
    add(
        &mut scene,
        shape("sphere"),
        plain([0.8, 0.3, 0.2]),
        transform(Vec3::splat(0.12), Vec3::ZERO, Vec3::new(-0.15, 0.1, 0.3)),
    );
    let sharp = draw(&scene);
    scene.lights[0].radius = 0.15;
    let soft = draw(&scene);
    let between = |frame: &Frame| frame.aovs.shadow.texels().iter().filter(|&&f| f > 0.0 && f < 1.0).count();
    assert_eq!(between(&sharp), 0);
    assert!(between(&soft) > 500, "{}", between(&soft));
    assert!((lit(&sharp) - lit(&soft)).abs() < 0.03);
    // The two shadows of the tutorials know no size.
    for shadow in [Shadow::Hard, Shadow::Soft] {
        let wide = draw(&with_shadow(&scene, shadow));
        let mut narrow = with_shadow(&scene, shadow);
        narrow.lights[0] = Light { radius: 0.0, ..scene.lights[0] };
        assert_eq!(wide, draw(&narrow), "{shadow:?}");
    }
}

#[test]
fn hard_and_soft_shadows_are_those_of_the_relief_alone() {
    let mut scene = wall();
    let ball = transform(Vec3::splat(0.12), Vec3::ZERO, Vec3::new(-1.0, 0.6, 0.7));
    add(&mut scene, shape("sphere"), plain([0.8, 0.3, 0.2]), ball);
    let mut alone = scene.clone();
    alone.objects.truncate(1);
    for shadow in Shadow::ALL {
        let (with, without) = (draw(&with_shadow(&scene, shadow)), draw(&with_shadow(&alone, shadow)));
        // The ball itself is out of view.
        assert!(with.aovs.material.texels().iter().all(|&m| m == Some(0)));
        assert_eq!(with == without, shadow != Shadow::Exact, "{shadow:?}");
        assert_eq!(lit(&with) == 1.0, shadow == Shadow::None, "{shadow:?}");
    }
}

#[test]
fn the_shadow_picture_is_the_mean_over_the_lights() {
    let mut scene = wall();
    scene.lights = vec![sun(0.8, -0.5, -0.45)];
    let one = draw(&scene);
    scene.lights.push(sun(0.0, 0.0, -1.0));
    let two = draw(&scene);
    for (a, b) in one.aovs.shadow.texels().iter().zip(two.aovs.shadow.texels()) {
        assert_eq!((a + 1.0) / 2.0, *b);
    }
    assert!(lit(&one) < 0.9);
}
