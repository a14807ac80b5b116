//! Displaced geometry that is traced without being kept, against the same geometry kept, and where it must not crack.

use std::sync::Arc;

use glam::{Affine3A, Vec2, Vec3};
use relievo_cpu::{RenderOptions, Renderer, VisibleOptions, VisiblePoint};
use relievo_map::{Grid, HeightMap};
use relievo_march::Shadow;
use relievo_scene::{HeightRange, Mesh, Scene};

use crate::common::*;

/// The same scene with its reliefs displaced by at least this number of vertices per texel.
fn traced(scene: &Scene, per_texel: u32) -> Scene {
    let mut scene = displaced(scene, 2);
    for material in scene.materials.iter_mut().filter(|material| material.maps.height.is_some()) {
        material.relief.vertices_per_texel = Some(per_texel);
    }
    scene
}

fn points(scene: &Scene) -> Grid<Option<VisiblePoint>> {
    Renderer::new(scene).unwrap().visible_points(&VisibleOptions::default()).unwrap()
}

/// A cube whose eight corners have the normals of a sphere, each face with the whole map.
fn smooth_cube() -> Mesh {
    let (mut positions, mut uvs, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [-1.0f32, 1.0] {
            let first = positions.len() as u32;
            for (a, b) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                let mut p = [0.0; 3];
                (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, a * side, b);
                positions.push(Vec3::from(p));
                uvs.push(Vec2::new(a, b) * 0.5 + 0.5);
            }
            triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    let normals = positions.iter().map(|p| p.normalize()).collect();
    Mesh::with_tangents(positions, normals, uvs, triangles).unwrap()
}

/// An object with a relief, lit so that it throws shadows, seen from `eye`.
fn stage_with(mesh: impl Into<Arc<Mesh>>, height: HeightMap, range: HeightRange, eye: Vec3) -> Scene {
    let mut scene = stage(120, 90, eye);
    scene.lights.push(point_light(-2.0, 3.0, 2.5));
    let mut material = relief(height, 0.1);
    material.height = range;
    add(&mut scene, mesh, material, Affine3A::IDENTITY);
    scene
}

/// Flat and curved meshes whose sides are as long as their maps, so that both ways cut them alike.
fn scenes() -> Vec<(&'static str, Scene, u32)> {
    let flat = stage_with(shape("quad"), stones(64, 64), HeightRange::Scale(0.08), Vec3::new(0.6, -1.6, 1.2));
    let cube = stage_with(smooth_cube(), stones(32, 32), HeightRange::Depth(0.15), Vec3::new(2.6, 2.0, 4.6));
    let mut raised = stage_with(shape("quad"), hills(32, 32), HeightRange::Scale(0.2), Vec3::new(0.0, -3.0, 0.9));
    raised.materials[0].midlevel = 0.4;
    raised.objects[0].uv_repeat = Vec2::new(2.0, 2.0);
    vec![("flat", flat, 129), ("cube", cube, 65), ("raised", raised, 129)]
}

#[test]
fn what_is_traced_is_what_would_be_kept() {
    for (name, scene, grid) in scenes() {
        let (kept, fine) = (displaced(&scene, grid), traced(&scene, 2));
        let (a, b) = (points(&kept), points(&fine));
        let mut hits = 0;
        let mut differ = Vec::new();
        for (a, b) in a.texels().iter().zip(b.texels()) {
            match (a, b) {
                (Some(a), Some(b)) => {
                    hits += 1;
                    assert_eq!((a.object, b.object), (0, 0));
                    differ.push(f64::from(a.position.distance(b.position)));
                }
                (None, None) => {}
                _ => differ.push(f64::INFINITY),
            }
        }
        assert!(hits > 1000, "{name}: {hits}");
        // A ray past a crest may see either side in f32.
        let (p99, over) = (quantile(differ.clone(), 0.99), differ.iter().filter(|&&d| d > 1e-4).count());
        println!("{name}: {hits} hits, p99 {p99:.1e}, {over} differ");
        assert!(p99 < 2e-5 && over * 500 < differ.len(), "{name}: {p99} {over}");
        // Shading and shadows too.
        let (kept, drawn) = (draw(&kept), draw(&fine));
        assert!(mean_difference(&kept, &drawn) < 0.1, "{name}: {}", mean_difference(&kept, &drawn));
        let without = draw(&with_shadow(&fine, Shadow::None));
        assert!(name == "raised" || mean_difference(&without, &drawn) > 1.0, "{name}: nothing throws a shadow");
    }
}

#[test]
fn another_surface_is_told_apart() {
    // The heights of the next texel, and another direction.
    let (_, scene, _) = scenes().swap_remove(1);
    let truth = points(&traced(&scene, 4));
    let off = |scene: &Scene| {
        let found = points(&traced(scene, 4));
        let pairs = truth.texels().iter().zip(found.texels());
        let far = |(a, b): (&Option<VisiblePoint>, &Option<VisiblePoint>)| match (a, b) {
            (Some(a), Some(b)) => a.position.distance(b.position) > 0.01,
            (a, b) => a.is_some() != b.is_some(),
        };
        pairs.map(far).filter(|&far| far).count() as f64 / truth.texels().iter().flatten().count() as f64
    };
    assert_eq!(off(&scene), 0.0);
    let mut shifted = scene.clone();
    let map = stones(32, 32);
    let grid = Grid::from_fn(32, 32, |x, y| *map.grid().get((x + 1) % 32, y));
    shifted.materials[0].maps.height = Some(HeightMap::new(grid));
    assert!(off(&shifted) > 0.05, "{}", off(&shifted));
    let mut straight = scene.clone();
    let mut mesh = smooth_cube();
    for corners in mesh.triangles.clone() {
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
        for corner in corners {
            mesh.normals[corner as usize] = (b - a).cross(c - a).normalize();
        }
    }
    straight.objects[0].mesh = Arc::new(mesh);
    assert!(off(&straight) > 0.05, "{}", off(&straight));
}

#[test]
fn far_repeats_and_odd_meshes_are_drawn() {
    let mut scene = stage_with(shape("quad"), stones(64, 64), HeightRange::Scale(0.1), Vec3::new(0.0, -2.6, 0.9));
    scene.objects[0].uv_repeat = Vec2::splat(1000.0);
    let frame = draw(&traced(&scene, 2));
    let flat = draw(&with_technique(&scene, FLAT));
    assert_eq!(frame.aovs.hit.texels(), flat.aovs.hit.texels());
    // A triangle without area, uv without area, and opposite normals.
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X * 2.0, Vec3::new(1.0, 1.0, 0.0)];
    let normals = vec![Vec3::Z, -Vec3::Z, Vec3::Z, Vec3::X, Vec3::Z];
    let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::X, Vec2::X];
    let mesh = Mesh::with_tangents(positions, normals, uvs, vec![[0, 1, 3], [0, 1, 2], [1, 4, 3]]).unwrap();
    let scene = stage_with(mesh, hills(16, 16), HeightRange::Depth(0.1), Vec3::new(0.5, 0.5, 3.0));
    draw(&traced(&scene, 2));
}

#[test]
fn threads_draw_the_same_bytes() {
    let (_, scene, _) = scenes().swap_remove(1);
    let renderer = Renderer::new(&traced(&scene, 2)).unwrap();
    let draw = |threads| renderer.render(&RenderOptions { threads, ..RenderOptions::default() }).unwrap();
    assert_eq!(draw(Some(1)), draw(Some(3)));
    let points = |threads| renderer.visible_points(&VisibleOptions { threads, ..VisibleOptions::default() }).unwrap();
    assert_eq!(points(Some(1)), points(Some(3)));
    let all = points(None);
    let only = Grid::from_fn(all.width(), all.height(), |x, y| x > 60 && y < 45);
    let some = renderer.visible_points(&VisibleOptions { only: Some(&only), ..VisibleOptions::default() }).unwrap();
    for ((all, some), only) in all.texels().iter().zip(some.texels()).zip(only.texels()) {
        assert_eq!(*some, all.filter(|_| *only));
    }
}

#[test]
fn a_raised_surface_lies_higher() {
    let (_, scene, _) = scenes().swap_remove(0);
    let renderer = Renderer::new(&traced(&scene, 2)).unwrap();
    let mean = |raise: f64| {
        let points = renderer.visible_points(&VisibleOptions { raise, ..VisibleOptions::default() }).unwrap();
        let heights: Vec<f64> = points.texels().iter().flatten().map(|p| f64::from(p.position.z)).collect();
        heights.iter().sum::<f64>() / heights.len() as f64
    };
    // A texel is 2/64 wide.
    let (low, middle, high) = (mean(-0.2), mean(0.0), mean(0.2));
    for step in [high - middle, middle - low] {
        assert!((step - 0.2 * 2.0 / 64.0).abs() < 0.002, "{low} {middle} {high}");
    }
}

#[test]
fn what_stands_before_the_near_plane_hides_nothing() {
    let (_, mut scene, _) = scenes().swap_remove(1);
    // In the cube's middle its far faces are seen from behind and its near ones are cut away: nothing is left.
    let far = points(&traced(&scene, 2));
    scene.camera.near = 5.4;
    let cut = points(&traced(&scene, 2));
    let lost = far.texels().iter().zip(cut.texels()).filter(|(far, cut)| far.is_some() && cut.is_none()).count();
    let kept = cut.texels().iter().flatten().count();
    assert!(lost > 100 && kept > 100, "{lost} {kept}");
    let kept_by_grid = points(&displaced(&scene, 65)).texels().iter().flatten().count();
    assert!(kept.abs_diff(kept_by_grid) * 200 < kept, "{kept} {kept_by_grid}");
}
