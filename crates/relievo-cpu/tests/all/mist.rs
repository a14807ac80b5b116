//! Mist in pictures, against closed forms.

use std::f32::consts::PI;

use glam::{Affine3A, Vec3};
use relievo_cpu::{Frame, RenderOptions, Renderer};
use relievo_map::{Grid, HeightMap, MapSet, linear_to_srgb};
use relievo_march::Shadow;
use relievo_scene::{HeightRange, Material, Mist, Relief, Scene};

use crate::common::*;

/// Mist in a map of heights, with a hard surface, 1 deep.
fn mist(heights: HeightMap, density: f32) -> Material {
    Material {
        maps: MapSet { height: Some(heights), ..MapSet::default() },
        height: HeightRange::Depth(1.0),
        relief: Relief { shadow: Shadow::Exact, ..Relief::default() },
        mist: Some(Mist { density, softness: 0.0, steps: 64, ..Mist::default() }),
        ..Material::default()
    }
}

fn flat(height: f32) -> HeightMap {
    HeightMap::new(Grid::filled(8, 8, height))
}

/// A wide layer of mist on the plane z = 0, seen straight down.
fn layer(density: f32) -> Scene {
    let mut scene = stage(8, 8, Vec3::new(0.0, 0.0, 4.0));
    scene.shading.ambient = 0.0;
    scene.image.background = [0.0; 3];
    scene.camera.vertical_fov = 1.0;
    add(&mut scene, shape("quad"), mist(flat(0.75), density), Affine3A::from_scale(Vec3::new(50.0, 50.0, 1.0)));
    scene
}

fn middle(frame: &Frame) -> f32 {
    f32::from(frame.pixels.get(4, 4)[1])
}

fn shown(light: f32) -> f32 {
    linear_to_srgb(light.min(1.0)) * 255.0
}

#[test]
fn what_lies_behind_is_dimmed_by_beer_and_lamberts_law() {
    for density in [0.0, 0.3, 2.0, 40.0] {
        let mut scene = layer(density);
        scene.image.background = [1.0; 3];
        let expected = shown((-0.75 * density).exp());
        let found = middle(&draw(&scene));
        assert!((found - expected).abs() < 0.6, "{density}: {found} instead of {expected}");
        // A surface half way up ends the way through.
        add(&mut scene, shape("quad"), plain([1.0; 3]), moved(0.0, 0.0, -0.5));
        scene.shading.ambient = 1.0;
        scene.materials[0].base_color = [0.0; 3];
        let expected = shown((-0.25 * density).exp());
        let found = middle(&draw(&scene));
        assert!((found - expected).abs() < 0.6, "{density}, surface: {found} instead of {expected}");
    }
}

#[test]
fn scattered_light_is_that_of_the_closed_form() {
    for (density, albedo) in [(0.2, 1.0), (1.5, 0.6), (30.0, 0.9)] {
        let mut scene = layer(density);
        scene.lights.push(sun(0.0, 0.0, -1.0));
        scene.materials[0].base_color = [albedo; 3];
        // Evenly scattered, in Blinn-Phong's unit: ∫ e^(−2τ) dτ / 4.
        let expected = shown(albedo * 0.25 * 0.5 * (1.0 - (-2.0 * 0.75 * density).exp()));
        let found = middle(&draw(&scene));
        assert!((found - expected).abs() < 1.0, "{density}: {found} instead of {expected}");
        // Unshadowed, all that is not let through is lit.
        scene.materials[0].relief.shadow = Shadow::None;
        let expected = shown(albedo * 0.25 * (1.0 - (-0.75 * density).exp()));
        let found = middle(&draw(&scene));
        assert!((found - expected).abs() < 0.6, "{density}, unshadowed: {found} instead of {expected}");
    }
}

#[test]
fn no_more_light_leaves_than_arrives() {
    // Evenly lit from all around and scattering all of it, mist is at most as bright as the light, whatever its shape.
    let mut scene = stage(24, 18, Vec3::new(1.0, -3.0, 1.5));
    scene.camera.up = Vec3::Z;
    scene.shading.ambient = 1.0;
    scene.image.background = [1.0; 3];
    add(&mut scene, shape("quad"), mist(hills(64, 64), 3.0), Affine3A::IDENTITY);
    let frame = draw(&scene);
    assert!(frame.pixels.texels().iter().flatten().all(|&c| c >= 254), "a white furnace is white everywhere");
    // Over a hemisphere of directions a lit layer sends out no more than it receives; a dark floor takes the rest.
    for g in [-0.6, 0.0, 0.7] {
        let mut scene = layer(2.0);
        scene.lights.push(sun(0.5, 0.0, -0.8));
        scene.materials[0].mist.as_mut().unwrap().anisotropy = g;
        let received = 0.8f32 / (0.5f32 * 0.5 + 0.8 * 0.8).sqrt();
        let (mut sent, n) = (0.0, 12);
        for i in 0..n {
            for j in 0..n {
                // Directions spread evenly over the cosine-weighted hemisphere: the mean radiance times π is the exitance.
                let (r, angle) = (((i as f32 + 0.5) / n as f32).sqrt(), (j as f32 + 0.5) / n as f32 * 2.0 * PI);
                let out = Vec3::new(r * angle.cos(), r * angle.sin(), (1.0 - r * r).sqrt());
                scene.camera.position = out * 4.0;
                scene.camera.up = if out.z > 0.9 { Vec3::Y } else { Vec3::Z };
                (scene.image.width, scene.image.height) = (1, 1);
                let shown = f32::from(draw(&scene).pixels.get(0, 0)[1]) / 255.0;
                // In Blinn-Phong's unit radiance is π times as large.
                sent += relievo_map::srgb_to_linear(shown) / (n * n) as f32;
            }
        }
        assert!(sent > 0.01 && sent <= received, "g = {g}: {sent} of {received} leave upwards");
    }
}

#[test]
fn surfaces_in_mist_and_below_it_are_lit_through_it_and_throw_shadows_into_it() {
    let mut scene = layer(1.0);
    scene.shading.specular = 0.0;
    scene.lights.push(sun(0.0, 0.0, -1.0));
    scene.materials[0].base_color = [0.0; 3];
    add(&mut scene, shape("quad"), plain([1.0; 3]), moved(0.0, 0.0, -2.0));
    // Through the mist to the surface, and back to the eye.
    let expected = shown((-2.0f32 * 0.75).exp());
    let found = middle(&draw(&scene));
    assert!((found - expected).abs() < 1.0, "{found} instead of {expected}");
    // A roof over the mist, which the eye looks past, takes its light.
    let mut scene = layer(1.0);
    scene.lights.push(sun(1.0, 0.0, -1.0));
    let lit = middle(&draw(&scene));
    add(&mut scene, shape("quad"), plain([1.0; 3]), transform(Vec3::splat(0.8), Vec3::ZERO, Vec3::new(-1.4, 0.0, 1.0)));
    let shaded = middle(&draw(&scene));
    assert!(lit > 40.0 && shaded < 1.0, "{shaded} in the shadow, {lit} beside");
}

#[test]
fn an_eye_within_mist_and_below_it_sees_the_rest_of_the_way() {
    for (eye, target, length) in [
        (Vec3::new(0.0, 0.0, -0.5), Vec3::new(0.0, 0.0, -5.0), 0.5),
        (Vec3::new(0.0, 0.0, -0.5), Vec3::new(0.0, 0.0, 5.0), 0.25),
        (Vec3::new(0.0, 0.0, -3.0), Vec3::new(0.0, 0.0, 5.0), 0.75),
        (Vec3::new(0.0, 0.0, 3.0), Vec3::new(0.0, 0.0, 5.0), 0.0),
    ] {
        let mut scene = layer(1.0);
        (scene.camera.position, scene.camera.target, scene.camera.near) = (eye, target, 1e-4);
        scene.image.background = [1.0; 3];
        let (expected, found) = (shown((-length as f32).exp()), middle(&draw(&scene)));
        assert!((found - expected).abs() < 0.6, "from {eye} to {target}: {found} instead of {expected}");
    }
}

#[test]
fn one_thread_or_many_draw_the_same_mist() {
    let mut scene = stage(70, 50, Vec3::new(1.0, -2.5, 1.2));
    scene.camera.up = Vec3::Z;
    scene.image.samples = 2;
    scene.lights.push(sun(0.7, 0.2, -0.5));
    add(&mut scene, shape("quad"), relief(stones(64, 64), 0.2), moved(0.0, 0.0, 0.0));
    let mut fog = mist(hills(64, 64), 6.0);
    fog.height = HeightRange::Depth(0.3);
    fog.mist = fog.mist.map(|mist| Mist { softness: 0.3, steps: 9, ..mist });
    add(&mut scene, shape("quad"), fog, moved(0.0, 0.0, 0.2));
    let renderer = Renderer::new(&scene).unwrap();
    let on = |threads| renderer.render(&RenderOptions { threads: Some(threads), ..RenderOptions::default() }).unwrap();
    let one = on(1);
    assert_eq!(on(2), one);
    assert_eq!(on(5), one);
    // It is seen, and it is not all that is seen.
    scene.materials[1].mist.as_mut().unwrap().density = 0.0;
    let clear = draw(&scene);
    assert!(share_over(&clear, &one, 8) > 0.2);
    assert_eq!(clear.aovs.depth, one.aovs.depth, "AOVs are those of the surfaces");
}
