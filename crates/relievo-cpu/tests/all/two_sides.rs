//! Reliefs that are seen from behind: the same surface, from below.

use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3};
use relievo_cpu::Frame;
use relievo_map::{Grid, HeightMap, NormalMap};
use relievo_march::{Shadow, Technique};
use relievo_scene::{Edge, HeightRange, Mesh, Scene, SurfaceTechnique};

use crate::common::*;

/// A sheet seen from behind, with both sides or one.
fn sheet(midlevel: f32, two_sided: bool) -> Scene {
    let mut scene = stage(160, 120, Vec3::new(0.6, -1.0, -2.2));
    scene.lights.push(sun(0.3, 0.4, 1.0));
    add(&mut scene, shape("quad"), relief(hills(64, 64), 0.06), Affine3A::IDENTITY);
    scene.materials[0].midlevel = midlevel;
    scene.materials[0].two_sided = two_sided.then_some(true);
    scene
}

fn hits(frame: &Frame) -> Vec<bool> {
    frame.aovs.hit.texels().iter().map(|&hit| hit == 1.0).collect()
}

/// A quantile of how far apart two frames' uvs are where both hit, in texels of a map of 64².
fn uv_apart(a: &Frame, b: &Frame) -> f64 {
    let apart = |i: usize| {
        let [a, b] = [a, b].map(|frame| Vec2::from(frame.aovs.uv.texels()[i]));
        f64::from((a - b).abs().max_element() * 64.0)
    };
    let both = hits(a).into_iter().zip(hits(b)).enumerate().filter(|(_, (a, b))| *a && *b);
    quantile(both.map(|(i, _)| apart(i)).collect(), 0.99)
}

#[test]
fn from_behind_the_surface_is_that_of_displaced_geometry() {
    for (midlevel, scale) in [(1.0, Vec3::ONE), (0.5, Vec3::new(-1.0, 1.2, 1.0)), (0.0, Vec3::ONE)] {
        let mut scene = sheet(midlevel, true);
        // A mirrored sheet has its front where its normals point, too.
        scene.objects[0].transform = transform(scale, Vec3::ZERO, Vec3::ZERO);
        let exact = draw(&scene);
        let polygon = draw(&with_technique(&scene, SurfaceTechnique::Marched(Technique::Normal)));
        assert_eq!(hits(&exact), hits(&polygon), "it is seen wherever its polygon is");
        assert!(hits(&exact).iter().filter(|&&hit| hit).count() > 5000);
        let truth = draw(&displaced(&scene, 257));
        let apart = uv_apart(&exact, &truth);
        println!("midlevel {midlevel}: {apart:.5} texels");
        assert!(apart < 0.02, "midlevel {midlevel}: {apart}");
        // The controls: another surface is found out, and one side is none from here.
        let mut upside_down = displaced(&scene, 257);
        upside_down.materials[0].maps.height = Some(HeightMap::new(hills(64, 64).grid().map(|h| 1.0 - h)));
        assert!(uv_apart(&exact, &draw(&upside_down)) > 1.0);
        assert!(!hits(&draw(&sheet(midlevel, false))).contains(&true));
        assert!(!hits(&draw(&displaced(&sheet(midlevel, false), 65))).contains(&true));
    }
}

/// The sheet with its back as a one-sided relief of its own, put together by hand.
fn turned_round(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let Mesh { positions, normals, uvs, tangents, triangles } = (*scene.objects[0].mesh).clone();
    scene.objects[0].mesh = Arc::new(Mesh {
        positions,
        normals: normals.iter().map(|&n| -n).collect(),
        uvs,
        tangents: tangents.iter().map(|t| t.truncate().extend(-t.w)).collect(),
        triangles: triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
    });
    let material = &mut scene.materials[0];
    material.two_sided = None;
    material.midlevel = 1.0 - material.midlevel;
    material.maps.height = material.maps.height.as_ref().map(|map| HeightMap::new(map.grid().map(|h| 1.0 - h)));
    material.maps.normal =
        material.maps.normal.as_ref().map(|map| NormalMap::new(map.grid().map(|[x, y, z]| [-x, -y, *z])));
    scene
}

#[test]
fn from_behind_it_is_drawn_as_a_sheet_that_was_turned_round() {
    let normals = NormalMap::new(Grid::from_fn(64, 64, |x, y| {
        let wave = |t: u32| (t as f32 * std::f32::consts::TAU / 32.0).sin() * 0.4;
        Vec3::new(wave(x), wave(y + 5), 1.0).normalize().to_array()
    }));
    let techniques =
        [EXACT, SurfaceTechnique::Marched(Technique::Occlusion), SurfaceTechnique::Marched(Technique::Cone)];
    for (k, mesh) in ["quad", "quad", "cube"].into_iter().enumerate() {
        for technique in techniques {
            for (lod, shadow) in [(false, Shadow::Exact), (true, Shadow::Soft)] {
                let mut scene = sheet([0.3, 0.8, 0.4][k], true);
                // The inside of a room.
                scene.objects[0].mesh = shape(mesh).into();
                scene.camera.position = [Vec3::new(0.6, -1.0, -2.2), Vec3::new(0.1, 0.2, -0.4)][k / 2];
                scene.camera.target = [Vec3::ZERO, Vec3::new(0.9, 0.4, 1.0)][k / 2];
                scene.lights = vec![point_light(0.3, 0.2, [-1.5, -1.5, 0.2][k]), sun(0.6, 0.3, 0.8)];
                let material = &mut scene.materials[0];
                material.maps.normal = (k == 1).then(|| normals.clone());
                (material.relief.technique, material.relief.lod, material.relief.shadow) = (technique, lod, shadow);
                material.relief.edge = [Edge::Clip, Edge::Wrap, Edge::Clamp][k];
                let (two_sided, by_hand) = (draw(&scene), draw(&turned_round(&scene)));
                assert!(two_sided.pixels == by_hand.pixels, "{mesh}, {technique:?}, lod {lod}");
                let (a, b) = (&two_sided.aovs, &by_hand.aovs);
                assert!(a.depth == b.depth && a.uv == b.uv && a.normal == b.normal && a.shadow == b.shadow, "{mesh}");
                assert!(a.hit == b.hit && a.material == b.material && a.fetches == b.fetches, "{mesh}, {technique:?}");
                assert!(hits(&two_sided).contains(&true));
            }
        }
    }
}

#[test]
fn a_back_throws_no_shadow_of_its_own_and_changes_nothing_in_front() {
    for midlevel in [1.0, 0.5, 0.0] {
        let [one, two] = [false, true].map(|two_sided| {
            let mut scene = sheet(midlevel, two_sided);
            scene.camera.position = Vec3::new(0.6, -1.0, 2.2);
            // One light on each side, and something for the sheet's shadow to fall on.
            scene.lights = vec![sun(0.5, -0.3, -0.6), point_light(-0.5, 1.2, -1.5)];
            add(&mut scene, shape("quad"), plain([0.8; 3]), moved(0.9, 0.3, -0.6));
            draw(&scene)
        });
        assert!(one.pixels == two.pixels && one.aovs == two.aovs, "midlevel {midlevel}");
    }
    // Every point of a gentle relief sees a light high above the side that is seen: one dark pixel is acne.
    for technique in [EXACT, SurfaceTechnique::Displacement] {
        for midlevel in [1.0, 0.5, 0.0] {
            let mut scene = with_technique(&sheet(midlevel, true), technique);
            scene.materials[0].height = HeightRange::Scale(0.03);
            scene.materials[0].relief.grid = 129;
            scene.lights = vec![sun(0.1, -0.1, 1.0), point_light(0.2, 0.1, -3.0)];
            let frame = draw(&scene);
            assert!(hits(&frame).contains(&true));
            let dark = frame.aovs.shadow.texels().iter().filter(|&&factor| factor < 1.0).count();
            assert_eq!(dark, 0, "{technique:?}, midlevel {midlevel}");
        }
    }
}

#[test]
fn the_side_that_is_seen_is_lit_and_shadowed_as_geometry_is() {
    for light in [sun(0.8, -0.5, 0.45), sun(-0.2, -1.0, 0.3)] {
        let mut scene = sheet(0.5, true);
        scene.materials[0].maps.height = Some(stones(64, 64));
        scene.lights = vec![light];
        let (exact, truth) = (draw(&scene), draw(&displaced(&scene, 257)));
        let both: Vec<usize> = (0..160 * 120).filter(|&i| hits(&exact)[i] && hits(&truth)[i]).collect();
        let normals = |frame: &Frame, i: usize| Vec3::from(frame.aovs.normal.texels()[i]);
        let turned = |i: usize| f64::from(normals(&exact, i).angle_between(normals(&truth, i)).to_degrees());
        let p95 = quantile(both.iter().map(|&i| turned(i)).collect(), 0.95);
        let lit = |frame: &Frame, i: usize| frame.aovs.shadow.texels()[i] > 0.5;
        let other = both.iter().filter(|&&i| lit(&exact, i) != lit(&truth, i)).count() as f64 / both.len() as f64;
        let dark = both.iter().filter(|&&i| !lit(&truth, i)).count() as f64 / both.len() as f64;
        println!("normals {p95:.2}° apart, {other:.4} otherwise lit, {dark:.3} in shadow");
        assert!(p95 < 2.0 && other < 0.01 && dark > 0.05, "{p95}, {other}, {dark}");
        assert!(both.iter().all(|&i| normals(&exact, i).z < 0.0), "normals face the eye");
    }
}
