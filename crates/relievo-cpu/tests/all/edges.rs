//! Ends of surfaces, the sides of them that are drawn, and their order in depth.

use glam::{Affine3A, Vec2, Vec3};
use relievo_cpu::Frame;
use relievo_map::{Grid, HeightMap};
use relievo_march::Technique;
use relievo_scene::{Edge, Scene, SurfaceTechnique};

use crate::common::*;

/// A whole wall seen at a slant, all its borders in view.
fn whole_wall(edge: Edge) -> Scene {
    let mut scene = stage(160, 120, Vec3::new(1.6, -1.0, 2.4));
    scene.lights.push(point_light(-1.0, 1.5, 2.0));
    add(&mut scene, shape("quad"), relief(stones(64, 64), 0.06), Affine3A::IDENTITY);
    scene.materials[0].relief.edge = edge;
    scene
}

fn hits(frame: &Frame) -> Vec<bool> {
    frame.aovs.hit.texels().iter().map(|&hit| hit == 1.0).collect()
}

fn outside(uv: [f32; 2], [width, height]: [f32; 2]) -> bool {
    !((0.0..=width).contains(&uv[0]) && (0.0..=height).contains(&uv[1]))
}

#[test]
fn a_clipped_wall_ends_where_real_geometry_ends() {
    for (midlevel, map) in [(1.0, stones(64, 64)), (0.5, stones(64, 64)), (1.0, hills(64, 64)), (0.5, hills(64, 64))] {
        let mut scene = whole_wall(Edge::Clip);
        scene.materials[0].maps.height = Some(map);
        scene.materials[0].midlevel = midlevel;
        let (exact, truth, polygon) =
            (draw(&scene), draw(&displaced(&scene, 129)), draw(&with_technique(&scene, FLAT)));
        let (mut through, mut wrong, mut inside) = (0, 0, 0);
        for (i, ((exact_hit, true_hit), on_polygon)) in
            hits(&exact).into_iter().zip(hits(&truth)).zip(hits(&polygon)).enumerate()
        {
            assert!(on_polygon || !exact_hit, "the polygon is where a relief can be seen");
            if !on_polygon {
                continue;
            }
            inside += 1;
            through += u32::from(!true_hit);
            let near = |k: usize| (exact.aovs.uv.texels()[i][k] - truth.aovs.uv.texels()[i][k]).abs() < 0.01;
            let same = exact_hit == true_hit && (!exact_hit || (near(0) && near(1)));
            wrong += u32::from(!same);
        }
        assert!(exact.aovs.uv.texels().iter().all(|&uv| !outside(uv, [1.0; 2])));
        println!("midlevel {midlevel}: {wrong} of {inside} pixels differ, {through} see past the border");
        assert!(
            inside > 5000 && through > 30 && wrong * 200 < inside,
            "midlevel {midlevel}: {wrong} of {inside}, {through}"
        );
    }
}

#[test]
fn every_marching_technique_is_clipped() {
    for technique in Technique::ALL.into_iter().filter(|t| !matches!(t, Technique::None | Technique::Normal)) {
        let scene = with_technique(&whole_wall(Edge::Clip), SurfaceTechnique::Marched(technique));
        let frame = draw(&scene);
        let polygon = draw(&with_technique(&scene, FLAT));
        let count = |frame: &Frame| hits(frame).into_iter().filter(|&hit| hit).count();
        assert!(count(&frame) < count(&polygon), "{technique:?}");
        assert!(count(&frame) * 10 > count(&polygon) * 9, "{technique:?}");
        assert!(frame.aovs.uv.texels().iter().all(|&uv| !outside(uv, [1.0; 2])), "{technique:?}");
    }
}

#[test]
fn a_wrapped_wall_fills_its_polygon_and_goes_on_tiling() {
    let scene = whole_wall(Edge::Wrap);
    let (frame, polygon) = (draw(&scene), draw(&with_technique(&scene, FLAT)));
    assert_eq!(hits(&frame), hits(&polygon));
    assert!(frame.aovs.uv.texels().iter().any(|&uv| outside(uv, [1.0; 2])));
}

#[test]
fn a_clamped_wall_stretches_its_border_and_is_tiled_inside() {
    for repeat in [[1.0f32, 1.0], [3.0, 2.0], [1.5, 0.75]] {
        let mut scene = whole_wall(Edge::Clamp);
        scene.objects[0].uv_repeat = repeat.into();
        // Colours tell the place in the texture.
        let color = Grid::from_fn(64, 64, |x, y| [x as f32 / 63.0, y as f32 / 63.0, 0.5, 1.0]);
        let map = relievo_map::ColorMap { grid: color, encoding: relievo_map::ColorEncoding::Srgb };
        scene.materials[0].maps.base_color = Some(map);
        scene.shading.ambient = 1.0;
        scene.lights.clear();
        let clamped = draw(&scene);
        scene.materials[0].relief.edge = Edge::Wrap;
        let wrapped = draw(&scene);
        assert_eq!(hits(&clamped), hits(&wrapped));
        let (mut inside, mut beyond) = (0, 0);
        for (i, &uv) in clamped.aovs.uv.texels().iter().enumerate() {
            if clamped.aovs.hit.texels()[i] == 0.0 {
                continue;
            }
            if outside(uv, repeat) {
                beyond += 1;
                // The colour of the nearest point of the border, to a texel.
                for k in 0..2 {
                    let edge = uv[k].clamp(0.5 / 64.0, repeat[k] - 0.5 / 64.0).fract();
                    if !((0.02..0.98).contains(&edge) || uv[k] < 0.0 || uv[k] > repeat[k]) {
                        continue; // Between the last texel and the first one.
                    }
                    let expected = ((edge * 64.0 - 0.5) / 63.0).clamp(0.0, 1.0) * 255.0;
                    let color = f32::from(clamped.pixels.texels()[i][k]);
                    assert!((color - expected).abs() < 6.0, "{repeat:?}: {color} for {expected} at {uv:?}");
                }
            } else if (0..2).all(|k| uv[k] > 0.05 && uv[k] < repeat[k] - 0.05) {
                inside += 1;
                assert_eq!(clamped.pixels.texels()[i], wrapped.pixels.texels()[i], "{repeat:?} at {uv:?}");
            }
        }
        assert!(inside > 5000 && beyond > 50, "{repeat:?}: {inside}, {beyond}");
    }
}

#[test]
fn the_back_of_a_relief_is_not_drawn_but_that_of_a_thin_flat_surface_is() {
    let mut scene = whole_wall(Edge::Wrap);
    scene.camera.position = Vec3::new(0.3, 0.2, -3.0);
    for technique in [EXACT, SurfaceTechnique::Marched(Technique::Occlusion), SurfaceTechnique::Displacement] {
        let frame = draw(&with_technique(&scene, technique));
        assert!(frame.aovs.hit.texels().iter().all(|&hit| hit == 0.0), "{technique:?}");
    }
    // A light behind the wall, where the eye is, lights the side that is seen.
    scene.lights = vec![point_light(0.0, 0.0, -2.0)];
    let lit = draw(&with_technique(&scene, SurfaceTechnique::Marched(Technique::Normal)));
    assert!(lit.aovs.hit.texels().contains(&1.0));
    assert!(lit.aovs.normal.get(80, 60)[2] < 0.0);
    scene.lights = vec![point_light(0.0, 0.0, 2.0)];
    let unlit = draw(&with_technique(&scene, SurfaceTechnique::Marched(Technique::Normal)));
    assert!(brightness(&lit, 80, 60) > 2.0 * brightness(&unlit, 80, 60));
}

#[test]
fn of_several_objects_the_nearest_is_seen() {
    // Three walls behind one another, the nearest smallest, whatever their order in the scene.
    let walls = [(0.3, 0.6), (0.6, 0.2), (1.2, -0.4)];
    for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
        let mut scene = stage(60, 60, Vec3::new(0.0, 0.0, 3.0));
        for &i in &order {
            let (size, z) = walls[i];
            let material = if i == 1 { plain([0.5; 3]) } else { relief(hills(32, 32), 0.02) };
            add(&mut scene, shape("quad"), material, transform(Vec3::splat(size), Vec3::ZERO, Vec3::new(0.0, 0.0, z)));
        }
        let frame = draw(&scene);
        let seen = |x: u32| frame.aovs.material.get(x, 30).map(|m| order[m as usize]);
        assert_eq!([30, 17, 8, 0].map(seen), [Some(0), Some(1), Some(2), None], "{order:?}");
    }
}

/// A sphere stuck through a relief wall, seen from the side.
fn stuck_sphere() -> Scene {
    let mut scene = stage(200, 150, Vec3::new(0.9, -0.4, 0.9));
    scene.camera.target = Vec3::new(0.15, 0.0, 0.0);
    scene.camera.vertical_fov = 29.0;
    scene.lights.push(point_light(-0.6, 0.8, 0.9));
    add(&mut scene, shape("quad"), relief(stones(64, 64), 0.06), Affine3A::IDENTITY);
    add(
        &mut scene,
        shape("sphere"),
        plain([0.8, 0.2, 0.1]),
        transform(Vec3::splat(0.25), Vec3::ZERO, Vec3::new(0.1, 0.02, 0.0)),
    );
    scene
}

/// The fraction of pixels that show different materials.
fn differently_seen(a: &Frame, b: &Frame) -> f64 {
    let pairs = a.aovs.material.texels().iter().zip(b.aovs.material.texels());
    pairs.filter(|(a, b)| a != b).count() as f64 / a.aovs.material.texels().len() as f64
}

#[test]
fn a_sphere_stuck_through_a_relief_is_cut_where_the_relief_is() {
    for midlevel in [1.0, 0.5] {
        let mut scene = stuck_sphere();
        scene.materials[0].midlevel = midlevel;
        let truth = draw(&displaced(&scene, 129));
        let exact = draw(&scene);
        let mut flat = scene.clone();
        flat.materials[0].relief.write_depth = Some(false);
        let polygon = draw(&flat);
        let cut = [&exact, &polygon].map(|frame| differently_seen(frame, &truth));
        let over = share_over(&exact, &truth, 8);
        println!("midlevel {midlevel}: cut {cut:?}, {over} over 8/255");
        assert!(cut[0] < 0.0015 && cut[1] > 5.0 * cut[0] + 0.01, "midlevel {midlevel}: {cut:?}");
        assert!(over < 0.01, "midlevel {midlevel}: {over}");
    }
}

#[test]
fn a_raised_relief_hides_what_stands_behind_its_bumps_at_grazing_angles() {
    // One high ridge across the wall, and a small flat thing on the wall far behind it, nearer to where the ray meets
    // the polygon than to where it meets the ridge.
    let ridge = HeightMap::new(Grid::from_fn(128, 128, |x, _| if (70..76).contains(&x) { 1.0 } else { 0.0 }));
    let mut scene = stage(120, 60, Vec3::new(1.4, 0.0, 0.28));
    scene.camera.target = Vec3::new(-0.1, 0.0, 0.0);
    scene.camera.vertical_fov = 14.0;
    add(&mut scene, shape("quad"), relief(ridge, 0.05), Affine3A::IDENTITY);
    scene.materials[0].midlevel = 0.0;
    add(
        &mut scene,
        shape("cube"),
        plain([0.9, 0.1, 0.1]),
        transform(Vec3::new(0.02, 0.3, 0.05), Vec3::ZERO, Vec3::new(-0.05, 0.0, 0.05)),
    );
    let (exact, truth) = (draw(&scene), draw(&displaced(&scene, 257)));
    let hidden = |frame: &Frame| frame.aovs.material.texels().iter().filter(|&&m| m == Some(1)).count();
    println!("{} and {} pixels of the thing", hidden(&exact), hidden(&truth));
    assert!(hidden(&truth) > 20);
    let cut = differently_seen(&exact, &truth);
    assert!(cut < 0.004, "{cut}");
}

#[test]
fn raised_reliefs_of_fine_meshes_are_not_lost_between_their_triangles() {
    // Nearer than its polygons' boxes: a wall of many small triangles, and a plain wall between its lid and its polygons.
    let (fine, mut scene) = (fine_wall(24), stage(120, 90, Vec3::new(0.95, -0.2, 0.35)));
    scene.camera.target = Vec3::new(0.3, 0.0, 0.0);
    scene.camera.vertical_fov = 30.0;
    add(&mut scene, fine, relief(stones(64, 64), 0.06), Affine3A::IDENTITY);
    scene.materials[0].midlevel = 0.0;
    add(&mut scene, shape("quad"), plain([0.9, 0.1, 0.1]), moved(0.0, 0.0, 0.05));
    let mut coarse = scene.clone();
    coarse.objects[0].mesh = shape("quad").into();
    let (fine, coarse) = (draw(&scene), draw(&coarse));
    let cut = differently_seen(&fine, &coarse);
    assert!(cut < 0.001, "{cut}");
    let walls = fine.aovs.material.texels().iter().filter(|&&m| m == Some(0)).count();
    assert!((1000..9000).contains(&walls), "{walls} pixels of the relief");
}

/// The quad in n × n squares.
fn fine_wall(n: u32) -> relievo_scene::Mesh {
    let (mut positions, mut uvs, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for y in 0..=n {
        for x in 0..=n {
            let uv = Vec2::new(x as f32, y as f32) / n as f32;
            positions.push(Vec3::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.0));
            uvs.push(uv);
            if x < n && y < n {
                let [a, b] = [y * (n + 1) + x, (y + 1) * (n + 1) + x];
                triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]]);
            }
        }
    }
    let normals = vec![Vec3::Z; positions.len()];
    relievo_scene::Mesh::with_tangents(positions, normals, uvs, triangles).unwrap()
}
