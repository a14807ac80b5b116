//! Nothing upside down, nothing mirrored, and bumps that look like bumps.

use std::path::PathBuf;

use glam::{Affine3A, Vec2, Vec3};
use relievo_cpu::Frame;
use relievo_make::shapes::{hemisphere, hemisphere_height};
use relievo_map::{
    BitDepth, ColorEncoding, ColorMap, Grid, HeightMap, Limits, NormalMap, NormalY, Wrap, read_normal, write_normal,
};
use relievo_march::{Shadow, Technique};
use relievo_scene::{Edge, Material, Scene, SurfaceTechnique};

use crate::common::*;

/// Views of each mesh from outside: the eye, up, and the texture repeats that put the middle of a tile into the middle of
/// the picture.
fn views() -> Vec<(&'static str, Vec3, Vec3, Vec2)> {
    let mut views = vec![
        ("quad", Vec3::Z, Vec3::Y, Vec2::ONE),
        ("plane", Vec3::Y, Vec3::NEG_Z, Vec2::ONE),
        ("cylinder", Vec3::Y, Vec3::NEG_Z, Vec2::ONE),
        ("cylinder", Vec3::NEG_Y, Vec3::Z, Vec2::ONE),
        ("cube", Vec3::Y, Vec3::NEG_Z, Vec2::ONE),
        ("cube", Vec3::NEG_Y, Vec3::Z, Vec2::ONE),
    ];
    for eye in [Vec3::Z, Vec3::X, Vec3::NEG_Z, Vec3::NEG_X] {
        views.push(("cube", eye, Vec3::Y, Vec2::ONE));
        // u = 0.5 is towards +Z, 0.25 and 0.75 are towards −X and +X; at −Z two tiles meet.
        let [few, many] = match eye {
            Vec3::Z => [5.0, 11.0],
            Vec3::NEG_Z => continue,
            _ => [6.0, 10.0],
        };
        views.push(("sphere", eye, Vec3::Y, Vec2::new(few, 3.0)));
        views.push(("cylinder", eye, Vec3::Y, Vec2::new(few, 1.0)));
        views.push(("torus", eye, Vec3::Y, Vec2::new(many, 3.0)));
    }
    views
}

fn look_at(mesh: &str, eye: Vec3, up: Vec3, repeat: Vec2, material: Material) -> Scene {
    let mut scene = stage(81, 81, eye * 3.5);
    scene.camera.up = up;
    scene.camera.vertical_fov = 30.0;
    add(&mut scene, shape(mesh), material, Affine3A::IDENTITY);
    scene.objects[0].uv_repeat = repeat;
    scene
}

/// The letter F in black on white: no mirror image or turn of it is itself.
fn letter(u: f32, v: f32) -> bool {
    let stem = (0.3..0.42).contains(&u) && (0.2..0.8).contains(&v);
    let top = (0.3..0.7).contains(&u) && (0.2..0.32).contains(&v);
    let middle = (0.3..0.58).contains(&u) && (0.45..0.57).contains(&v);
    stem || top || middle
}

#[test]
fn a_letter_reads_upright_on_every_mesh_seen_from_outside() {
    let grid = Grid::from_fn(128, 128, |x, y| {
        let ink = letter((x as f32 + 0.5) / 128.0, (y as f32 + 0.5) / 128.0);
        if ink { [0.0, 0.0, 0.0, 1.0] } else { [1.0; 4] }
    });
    let map = ColorMap { grid, encoding: ColorEncoding::Srgb };
    for (mesh, eye, up, repeat) in views() {
        let mut material = plain([1.0; 3]);
        material.maps.base_color = Some(map.clone());
        let mut scene = look_at(mesh, eye, up, repeat, material);
        scene.shading.ambient = 1.0;
        let frame = draw(&scene);
        // Right in the picture is +u, down is +v.
        let [centre, right, below] = [(40, 40), (42, 40), (40, 42)].map(|(x, y)| Vec2::from(*frame.aovs.uv.get(x, y)));
        assert!(right.x > centre.x && (right.y - centre.y).abs() < 0.2 * (right.x - centre.x), "{mesh} from {eye}");
        assert!(below.y > centre.y && (below.x - centre.x).abs() < 0.2 * (below.y - centre.y), "{mesh} from {eye}");
        // And the ink is where the coordinates say.
        let (mut black, mut wrong, mut all) = (0, 0, 0);
        for (uv, pixel) in frame.aovs.uv.texels().iter().zip(frame.pixels.texels()) {
            let ink = letter(uv[0].rem_euclid(1.0), uv[1].rem_euclid(1.0));
            black += u32::from(ink);
            wrong += u32::from(ink != (pixel[0] < 128) && frame.aovs.hit.texels()[all] == 1.0);
            all += 1;
        }
        assert!(black > 200 && wrong * 5 < black, "{mesh} from {eye}: {wrong} wrong, {black} black");
    }
}

const RADIUS: f64 = 0.3;
const SCALE: f32 = 0.06;

/// The normals of a bump as high as [`SCALE`] in the middle of the tile.
fn bump_normals() -> NormalMap {
    NormalMap::new(Grid::from_fn(128, 128, |x, y| {
        let at = |x: f64, y: f64| hemisphere_height((x + 0.5) / 128.0, (y + 0.5) / 128.0, [0.5; 2], RADIUS);
        let (x, y) = (f64::from(x), f64::from(y));
        let slope = |a: f64, b: f64| ((b - a) * 64.0) as f32 * SCALE;
        let (du, dv) = (slope(at(x - 1.0, y), at(x + 1.0, y)), slope(at(x, y - 1.0), at(x, y + 1.0)));
        // Up in the picture is −v.
        Vec3::new(-du, dv, 1.0).normalize().to_array()
    }))
}

fn bump() -> Material {
    let mut material = relief(hemisphere(128, 128, [0.5; 2], RADIUS), SCALE);
    material.maps.base_color = None;
    material.relief.shadow = Shadow::None;
    material
}

/// Mean brightness of the bump's upper and lower half around the middle of the picture.
fn halves(frame: &Frame) -> [f64; 2] {
    let (mut sums, mut counts) = ([0.0; 2], [0; 2]);
    for y in 20..61 {
        for x in 20..61 {
            let [u, v] = frame.aovs.uv.get(x, y).map(|t| t.rem_euclid(1.0) - 0.5);
            if u.abs() < 0.1 && (0.08..0.22).contains(&v.abs()) {
                let half = usize::from(v > 0.0);
                sums[half] += brightness(frame, x, y);
                counts[half] += 1;
            }
        }
    }
    assert!(counts.iter().all(|&n| n > 10), "{counts:?}");
    [sums[0] / f64::from(counts[0]), sums[1] / f64::from(counts[1])]
}

/// The file of a normal map with Y down, read again as one with this Y.
fn stored_down(map: &NormalMap, read_as: NormalY) -> NormalMap {
    let name = format!("down-read-{read_as:?}.png");
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    write_normal(&path, map, NormalY::Down, BitDepth::Sixteen).unwrap();
    read_normal(&path, read_as, &Limits::default()).unwrap().map
}

#[test]
fn a_bump_lit_from_above_is_bright_on_top_whatever_says_its_normals() {
    let up = bump_normals();
    let normals = [
        ("normals from the heights", None, true),
        ("a map with Y up", Some(up.clone()), true),
        ("a map with Y down, read as such", Some(stored_down(&up, NormalY::Down)), true),
        // The control: read the wrong way it must look wrong.
        ("a map with Y down, read as up", Some(stored_down(&up, NormalY::Up)), false),
    ];
    for (mesh, eye, above, repeat) in views() {
        for (name, map, right) in &normals {
            for technique in [EXACT, SurfaceTechnique::Marched(Technique::Normal), SurfaceTechnique::Displacement] {
                // Building grids takes its time, and normals are looked up as for `exact`: once is enough.
                if technique == SurfaceTechnique::Displacement && map.is_some() {
                    continue;
                }
                let mut material = bump();
                material.maps.normal = map.clone();
                material.relief.technique = technique;
                // A cylinder's sides are long and thin: every vertex along them is one around, too.
                material.relief.grid = if mesh == "cylinder" { 30 } else { 130 };
                let mut scene = look_at(mesh, eye, above, repeat, material);
                let from = -(above + eye);
                scene.lights.push(sun(from.x, from.y, from.z));
                // What the bump adds to the shading of a curved mesh.
                let [ratio, flat] = [&scene, &with_technique(&scene, FLAT)].map(|scene| {
                    let [top, bottom] = halves(&draw(scene));
                    top / bottom
                });
                assert!(
                    if *right { ratio > 1.03 * flat } else { ratio < 0.97 * flat },
                    "{mesh} from {eye}, {technique:?}, {name}: {ratio}, without the bump {flat}"
                );
            }
        }
    }
}

#[test]
fn normals_from_the_heights_are_those_of_the_surface() {
    // On a stretched, turned, sheared or mirrored wall: the facets of the displaced mesh know nothing of tangents.
    let transforms = [
        transform(Vec3::ONE, Vec3::ZERO, Vec3::ZERO),
        transform(Vec3::new(2.0, 0.7, 1.0), Vec3::new(10.0, 20.0, 30.0), Vec3::ZERO),
        transform(Vec3::new(-1.0, 1.5, 1.0), Vec3::ZERO, Vec3::ZERO),
    ];
    for transform in transforms {
        let mut scene = stage(80, 60, Vec3::new(0.2, 0.3, 1.0));
        scene.camera.vertical_fov = 30.0;
        add(&mut scene, shape("quad"), relief(hills(64, 64), 0.05), transform);
        let truth = draw(&displaced(&scene, 129));
        let frame = draw(&scene);
        let position = |x: u32, y: u32| {
            let half = 15f32.to_radians().tan();
            let forward = (scene.camera.target - scene.camera.position).normalize();
            let right = forward.cross(Vec3::Y).normalize();
            let up = right.cross(forward);
            let [sx, sy] = [(x as f32 + 0.5) / 40.0 - 1.0, 1.0 - (y as f32 + 0.5) / 30.0];
            let direction = forward + (right * sx * 80.0 / 60.0 + up * sy) * half;
            scene.camera.position + direction * *truth.aovs.depth.get(x, y)
        };
        let mut errors = Vec::new();
        for y in 1..59 {
            for x in 1..79 {
                let (dx, dy) = (position(x + 1, y) - position(x - 1, y), position(x, y - 1) - position(x, y + 1));
                let normal = dx.cross(dy).normalize();
                errors.push(f64::from(normal.angle_between(Vec3::from(*frame.aovs.normal.get(x, y))).to_degrees()));
            }
        }
        let (median, p95) = (quantile(errors.clone(), 0.5), quantile(errors, 0.95));
        println!("{median:.2}° and {p95:.2}° off");
        assert!(median < 1.0 && p95 < 4.0, "{median}, {p95}");
    }
}

#[test]
fn a_normal_map_agrees_with_its_heights_in_every_tile_of_every_addressing() {
    for wrap in [Wrap::Repeat, Wrap::Mirror] {
        for edge in [Edge::Wrap, Edge::Clip] {
            let mut material = bump();
            // Off the middle of its tile, so that a tile and its mirror image differ.
            material.maps.height = Some(hemisphere(128, 128, [0.4, 0.55], RADIUS));
            (material.wrap, material.relief.edge) = (wrap, edge);
            let normal_of = |normal: Option<NormalMap>| {
                let mut scene = stage(120, 120, Vec3::new(0.0, 0.0, 1.2));
                scene.camera.vertical_fov = 80.0;
                let mut material = material.clone();
                material.maps.normal = normal;
                add(&mut scene, shape("quad"), material, moved(0.0, 0.0, 0.0));
                scene.objects[0].uv_repeat = Vec2::new(3.0, 2.0);
                draw(&scene).aovs.normal
            };
            let heights = normal_of(None);
            let map = normal_of(Some(normals_of(&hemisphere(128, 128, [0.4, 0.55], RADIUS))));
            let off =
                |a: &[f32; 3], b: &[f32; 3]| f64::from(Vec3::from(*a).dot(Vec3::from(*b)).min(1.0).acos().to_degrees());
            let errors: Vec<f64> = heights
                .texels()
                .iter()
                .zip(map.texels())
                .filter(|(n, _)| **n != [0.0; 3])
                .map(|(a, b)| off(a, b))
                .collect();
            let p95 = quantile(errors, 0.95);
            assert!(p95 < 6.0, "{wrap:?}, {edge:?}: {p95}° apart");
        }
    }
}

/// The normals of a height map whose tile is three wide to two high on the quad, as in the test above.
fn normals_of(map: &HeightMap) -> NormalMap {
    let grid = map.grid();
    let (w, h) = (grid.width(), grid.height());
    NormalMap::new(Grid::from_fn(w, h, |x, y| {
        let at = |dx: i32, dy: i32| *grid.get(Wrap::Clamp.index(x as i32 + dx, w), Wrap::Clamp.index(y as i32 + dy, h));
        // The relief is SCALE of a repeat along u deep: 2/3 of a unit; along v a repeat is one unit.
        let depth = SCALE * 2.0 / 3.0;
        let (du, dv) = ((at(1, 0) - at(-1, 0)) * 0.5 * w as f32 / (2.0 / 3.0), (at(0, 1) - at(0, -1)) * 0.5 * h as f32);
        Vec3::new(-du * depth, dv * depth, 1.0).normalize().to_array()
    }))
}
