//! Lamps that hang among the relief.

use glam::{Affine3A, Vec3};
use relievo_cpu::Frame;
use relievo_march::Shadow;
use relievo_scene::{Edge, HeightRange, Scene};

use crate::common::{add, displaced, draw, hills, point_light, relief, shape, stage, with_shadow};

const DEPTH: f32 = 0.4;

/// A quad with deep hills, and a lamp above a valley of them, at this height over the polygon.
fn valley(midlevel: f32, z: f32) -> Scene {
    let mut scene = stage(200, 150, Vec3::new(-0.5, -1.9, 1.3));
    scene.camera.vertical_fov = 50.0;
    let map = hills(128, 128);
    let grid = map.grid();
    // The deepest texel near the middle.
    let texels = (32..96).flat_map(|y| (32..96).map(move |x| (x, y)));
    let (x, y) = texels.min_by(|a, b| grid.get(a.0, a.1).total_cmp(grid.get(b.0, b.1))).unwrap();
    let at = |i: u32| (i as f32 + 0.5) / 64.0 - 1.0;
    scene.lights.push(point_light(at(x), -at(y), z));
    let mut material = relief(map, 1.0);
    (material.height, material.midlevel) = (HeightRange::Depth(DEPTH), midlevel);
    material.relief.edge = Edge::Clip;
    add(&mut scene, shape("quad"), material, Affine3A::IDENTITY);
    scene
}

/// The fraction of pixels whose shadow differs where both see the relief: (darker, lighter) than the truth.
fn shadow_differences(truth: &Frame, frame: &Frame) -> (f64, f64) {
    let (mut darker, mut lighter) = (0, 0);
    for (i, (t, f)) in truth.aovs.shadow.texels().iter().zip(frame.aovs.shadow.texels()).enumerate() {
        if truth.aovs.hit.texels()[i] > 0.5 && frame.aovs.hit.texels()[i] > 0.5 {
            darker += u32::from(t - f > 0.5);
            lighter += u32::from(f - t > 0.5);
        }
    }
    let all = truth.aovs.hit.texels().len() as f64;
    (f64::from(darker) / all, f64::from(lighter) / all)
}

#[test]
fn a_lamp_below_the_lid_lights_what_displaced_geometry_shows_lit() {
    for (midlevel, z) in [(1.0, -0.05), (1.0, -0.15), (1.0, -0.3), (0.0, 0.25)] {
        let scene = valley(midlevel, z);
        let truth = draw(&displaced(&scene, 512));
        let (darker, lighter) = shadow_differences(&truth, &draw(&scene));
        println!("midlevel {midlevel}, z {z}: {:.2} % darker, {:.2} % lighter", darker * 100.0, lighter * 100.0);
        assert!(darker + lighter <= 0.004, "midlevel {midlevel}, z {z}: {darker} darker, {lighter} lighter");
        // The judge tells a lamp that is a sixteenth of the depth too high.
        let mut raised = scene.clone();
        raised.lights[0] = valley(midlevel, z + DEPTH / 16.0).lights[0];
        let (darker, lighter) = shadow_differences(&truth, &draw(&raised));
        assert!(darker + lighter > 0.004, "midlevel {midlevel}, z {z}");
    }
}

#[test]
fn a_wide_lamp_and_the_tutorials_shadows_end_at_the_lamp_too() {
    let mut scene = valley(1.0, -0.15);
    let lit = |frame: &Frame| frame.aovs.shadow.texels().iter().map(|&s| f64::from(s)).sum::<f64>();
    let mean = |scene: &Scene| lit(&draw(scene)) / (200.0 * 150.0);
    for shadow in [Shadow::Hard, Shadow::Soft] {
        // Straight above the lamp's height the relief goes on: a march up to the lid would count it.
        let (inside, sky) = (with_shadow(&scene, shadow), with_shadow(&valley(1.0, 1e4), shadow));
        assert!(mean(&inside) > 0.5 && mean(&sky) > 0.9, "{shadow:?}: {} {}", mean(&inside), mean(&sky));
    }
    scene.lights[0].radius = 0.02;
    let (truth, wide) = (draw(&displaced(&scene, 512)).aovs, draw(&scene).aovs);
    let both = (0..200 * 150).filter(|&i| truth.hit.texels()[i] > 0.5 && wide.hit.texels()[i] > 0.5);
    let off = both.map(|i| f64::from((truth.shadow.texels()[i] - wide.shadow.texels()[i]).abs())).sum::<f64>();
    assert!(off / (200.0 * 150.0) < 0.004, "{}", off / (200.0 * 150.0));
}
