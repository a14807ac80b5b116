//! `exact` against truly displaced geometry, which shares no code with the march.

use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3};
use relievo_cpu::{Frame, Precision, RenderOptions, Renderer};
use relievo_map::HeightMap;
use relievo_march::Shadow;
use relievo_scene::{HeightRange, Mesh, Scene};

use crate::common::*;

/// A 2×2 wall whose vertices, cut into one segment per texel, stand on the texel centres of a map of this size.
fn texel_wall(size: u32) -> Mesh {
    let (low, high) = (0.5 / size as f32, 1.0 - 0.5 / size as f32);
    wall_with_uvs([[low, low], [low, high], [high, high], [high, low]])
}

fn wall_with_uvs(uvs: [[f32; 2]; 4]) -> Mesh {
    let positions = [(-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
    let uvs = uvs.map(Vec2::from).to_vec();
    Mesh::with_tangents(positions, vec![Vec3::Z; 4], uvs, vec![[0, 1, 2], [0, 2, 3]]).unwrap()
}

/// A look at the inside of a wall under about 45°; nothing but the wall is seen.
fn wall(mesh: impl Into<Arc<Mesh>>, height: HeightMap, scale: f32) -> Scene {
    let mut scene = stage(160, 120, Vec3::new(0.75, -0.45, 0.75));
    scene.camera.target = Vec3::new(0.2, -0.05, 0.0);
    scene.camera.vertical_fov = 27.0;
    scene.lights.push(point_light(-0.6, 0.8, 0.8));
    add(&mut scene, mesh, relief(height, scale), Affine3A::IDENTITY);
    scene
}

/// The difference between the displaced uvs of two pictures, in texels: a quantile over the pixels.
fn uv_difference(a: &Frame, b: &Frame, texels: [u32; 2], q: f64) -> f64 {
    let pairs = a.aovs.uv.texels().iter().zip(b.aovs.uv.texels());
    let distance = |(a, b): (&[f32; 2], &[f32; 2])| {
        let [x, y] = [0, 1].map(|k| f64::from(a[k] - b[k]) * f64::from(texels[k]));
        x.hypot(y)
    };
    quantile(pairs.map(distance).collect(), q)
}

fn depth_difference(a: &Frame, b: &Frame, q: f64) -> f64 {
    let pairs = a.aovs.depth.texels().iter().zip(b.aovs.depth.texels());
    quantile(pairs.map(|(a, b)| f64::from((a - b).abs())).collect(), q)
}

#[test]
fn the_error_falls_with_the_grid_to_noise_at_one_vertex_per_texel() {
    for (name, size, map) in [("hills", 64, hills(64, 64)), ("stones", 128, stones(128, 128))] {
        for shadow in [Shadow::None, Shadow::Exact] {
            let scene = with_shadow(&wall(texel_wall(size), map.clone(), 0.08), shadow);
            let exact = draw(&scene);
            let grids = [size / 16, size / 8, size / 4, size / 2, size].map(|n| n + 1);
            let frames = grids.map(|grid| draw(&displaced(&scene, grid)));
            let errors = frames.each_ref().map(|frame| mean_difference(&exact, frame));
            let uvs = frames.each_ref().map(|frame| uv_difference(&exact, frame, [size; 2], 0.99));
            let over = share_over(&exact, &frames[4], 8);
            println!(
                "{name} {shadow:?}: grids {grids:?}, errors {errors:.3?}/255, uv p99 {uvs:.3?} texels, {over:.5} over 8/255"
            );
            assert!(errors.windows(2).all(|pair| pair[1] < 0.95 * pair[0]), "{name} {shadow:?}: {errors:?}");
            // Measured: 0.03 for the hills, 0.06 to 0.07 for the stones, whose silhouettes decide single pixels.
            assert!(errors[0] > 5.0 && errors[4] < 0.15, "{name} {shadow:?}: {errors:?}");
            assert!(uvs[4] < 0.04 && over < 0.004, "{name} {shadow:?}: {uvs:?}, {over}");
        }
    }
}

/// Draws the scene both ways and compares pictures, texture coordinates and depth. `grid`: two vertices per texel, one of
/// them on the texel's centre.
fn agrees(name: &str, scene: &Scene, grid: u32, texels: [u32; 2]) {
    let (exact, truth) = (draw(scene), draw(&displaced(scene, grid)));
    let everywhere = |frame: &Frame| frame.aovs.hit.texels().iter().all(|&hit| hit == 1.0);
    let error = mean_difference(&exact, &truth);
    let over = share_over(&exact, &truth, 8);
    let uv = uv_difference(&exact, &truth, texels, 0.99);
    let depth = depth_difference(&exact, &truth, 0.99);
    let shadow = exact.aovs.shadow.texels().iter().sum::<f32>() / exact.aovs.shadow.texels().len() as f32;
    println!(
        "{name}: {error:.3}/255, {over:.5} over 8/255, uv p99 {uv:.4} texels, depth p99 {depth:.6}, lit {shadow:.3}"
    );
    assert!(everywhere(&exact) && everywhere(&truth), "{name}: the wall must fill the view");
    // Measured: errors of 0.001 to 0.14, 0 to 0.35 % of pixels, at most 0.02 texels; depth follows from the slopes.
    assert!(error < 0.25 && over < 0.006, "{name}: {error}, {over}");
    assert!(uv < 0.05 && depth < 2e-3, "{name}: {uv}, {depth}");
}

#[test]
fn maps_that_are_not_square_have_the_same_depth() {
    let scene = wall(shape("quad"), stones(64, 32), 0.08);
    agrees("64x32", &scene, 129, [64, 32]);
    let scene = wall(shape("quad"), stones(32, 64), 0.08);
    agrees("32x64", &scene, 129, [32, 64]);
}

#[test]
fn stretched_rotated_and_mirrored_walls_agree() {
    let mut scene = wall(shape("quad"), stones(64, 64), 0.05);
    let place = |scale: [f32; 3], degrees: [f32; 3]| transform(scale.into(), degrees.into(), Vec3::ZERO);
    for (name, transform) in [
        ("stretched", place([2.0, 0.7, 1.0], [0.0; 3])),
        ("rotated", place([1.2, 1.2, 1.2], [12.0, -15.0, 70.0])),
        ("mirrored", place([-1.0, 1.0, 1.0], [0.0; 3])),
        ("mirrored and stretched", place([1.3, -1.0, 2.0], [0.0, 10.0, 30.0])),
    ] {
        scene.objects[0].transform = transform;
        scene.materials[0].height = HeightRange::Scale(0.05);
        agrees(name, &scene, 129, [64, 64]);
        scene.materials[0].height = HeightRange::Depth(0.09);
        agrees(&format!("{name}, in object units"), &scene, 129, [64, 64]);
    }
}

#[test]
fn repeated_and_raised_reliefs_agree() {
    let mut scene = wall(shape("quad"), stones(32, 32), 0.08);
    scene.objects[0].uv_repeat = Vec2::new(3.0, 2.0);
    agrees("repeated 3x2", &scene, 32 * 12 + 1, [32, 32]);
    let mut scene = wall(shape("quad"), stones(64, 64), 0.05);
    for midlevel in [0.5, 0.0] {
        scene.materials[0].midlevel = midlevel;
        agrees(&format!("midlevel {midlevel}"), &scene, 129, [64, 64]);
    }
}

#[test]
fn sheared_and_turned_texture_coordinates_agree() {
    let sheared = [[0.0, 0.0], [0.4, 1.0], [1.4, 1.0], [1.0, 0.0]];
    let turned = [[0.5, 0.0], [0.0, 0.5], [0.5, 1.0], [1.0, 0.5]];
    let mirrored = [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
    for (name, uvs) in [("sheared", sheared), ("turned", turned), ("mirrored uv", mirrored)] {
        let scene = wall(wall_with_uvs(uvs), hills(64, 64), 0.06);
        agrees(name, &scene, 257, [64, 64]);
    }
}

#[test]
fn a_wrong_depth_would_be_noticed() {
    // The measures above catch an error of 2 % in the depth of the relief.
    let scene = wall(shape("quad"), stones(64, 64), 0.05);
    let mut deeper = scene.clone();
    deeper.materials[0].height = HeightRange::Scale(0.051);
    let (exact, truth) = (draw(&scene), draw(&displaced(&deeper, 129)));
    assert!(mean_difference(&exact, &truth) > 0.5, "{}", mean_difference(&exact, &truth));
    assert!(uv_difference(&exact, &truth, [64; 2], 0.99) > 0.1);
}

#[test]
fn the_oracle_draws_what_exact_draws() {
    let scene = wall(shape("quad"), stones(64, 64), 0.08);
    let options = RenderOptions { precision: Precision::Oracle, ..RenderOptions::default() };
    let oracle = Renderer::new(&with_technique(&scene, FLAT)).unwrap().render(&options).unwrap();
    let flat = draw(&with_technique(&scene, FLAT));
    // A technique that does not march stays as it is: the oracle replaces the search, not the material.
    assert_eq!(oracle.pixels, flat.pixels);
    let oracle = Renderer::new(&scene).unwrap().render(&options).unwrap();
    let exact = draw(&scene);
    assert!(mean_difference(&exact, &oracle) < 0.05, "{}", mean_difference(&exact, &oracle));
    assert!(uv_difference(&exact, &oracle, [64; 2], 0.99) < 1e-3);
}
