//! Maps that a material moves, turns and mirrors: the same picture as with the same pictures turned beforehand.

use glam::{Affine3A, Vec2, Vec3};
use relievo_map::{ColorMap, Grid, HeightMap, NormalMap, Texel};
use relievo_march::{Shadow, Technique};
use relievo_scene::{Edge, HeightRange, Material, Scene, SurfaceTechnique, UvTransform};

use crate::common::*;

const SIZE: u32 = 128;

/// A picture of this picture: where the transform's image of uv is, it has what stood at uv. For whole turns and mirrors.
fn moved_grid<T: Texel>(grid: &Grid<T>, transform: &UvTransform) -> Grid<T> {
    Grid::from_fn(SIZE, SIZE, |x, y| {
        let uv = (Vec2::new(x as f32, y as f32) + 0.5) / SIZE as f32;
        let from = transform.undo(uv - transform.offset).rem_euclid(Vec2::ONE) * SIZE as f32;
        *grid.get(from.x as u32, from.y as u32)
    })
}

/// Heights without any symmetry.
fn heights() -> HeightMap {
    relievo_make::shapes::sampled(SIZE, SIZE, |u, v| {
        let bump = |x: f64, y: f64, r: f64| (1.0 - ((u - x).powi(2) + (v - y).powi(2)).sqrt() / r).clamp(0.0, 1.0);
        0.2 + (0.8 * bump(0.3, 0.35, 0.25)).max(0.4 * bump(0.75, 0.6, 0.2)).max(0.3 * bump(0.5, 0.85, 0.1))
    })
}

/// The normals of those heights on a tile two units wide.
fn normals(heights: &HeightMap, depth: f32) -> NormalMap {
    let grid = heights.grid();
    NormalMap::new(Grid::from_fn(SIZE, SIZE, |x, y| {
        let at = |dx: u32, dy: u32| *grid.get((x + SIZE + dx - 1) % SIZE, (y + SIZE + dy - 1) % SIZE);
        let slope = |a: f32, b: f32| (b - a) * 0.5 * SIZE as f32 / 2.0 * depth;
        Vec3::new(-slope(at(0, 1), at(2, 1)), slope(at(1, 0), at(1, 2)), 1.0).normalize().to_array()
    }))
}

/// The material as it is, or, with all maps turned beforehand, mapped back by `transform`.
fn material(transform: Option<&UvTransform>, with_normals: bool, turns_vectors: bool) -> Material {
    let mut material = relief(heights(), 0.1);
    material.height = HeightRange::Depth(0.2);
    material.relief.shadow = Shadow::None;
    material.maps.normal = with_normals.then(|| normals(&heights(), 0.2));
    let Some(transform) = transform else { return material };
    material.uv = *transform;
    let maps = &mut material.maps;
    maps.height = maps.height.as_ref().map(|map| HeightMap::new(moved_grid(map.grid(), transform)));
    maps.base_color = maps.base_color.as_ref().map(|map| ColorMap { grid: moved_grid(&map.grid, transform), ..*map });
    let turned = |&[x, y, z]: &[f32; 3]| {
        // Up in the picture is −v.
        let along = transform.rotation() * (Vec2::new(x, -y) * transform.scale);
        if turns_vectors { [along.x, -along.y, z] } else { [x, y, z] }
    };
    maps.normal = maps.normal.as_ref().map(|map| NormalMap::new(moved_grid(map.grid(), transform).map(turned)));
    material
}

fn scene(mesh: &str, material: Material) -> Scene {
    let mut scene = stage(120, 90, Vec3::new(0.5, -0.9, 2.6));
    scene.lights.push(sun(0.8, -0.5, -0.7));
    add(&mut scene, shape(mesh), material, Affine3A::IDENTITY);
    scene
}

fn transforms() -> [UvTransform; 5] {
    let transform = |offset: [f32; 2], rotate: f32, scale: [f32; 2]| UvTransform {
        offset: offset.into(),
        rotate,
        scale: scale.into(),
    };
    [
        transform([0.25, 0.5], 0.0, [1.0, 1.0]),
        transform([0.0, 1.0], 90.0, [1.0, 1.0]),
        transform([0.5, 0.25], -90.0, [1.0, -1.0]),
        transform([1.0, 1.0], 180.0, [1.0, 1.0]),
        transform([1.0, 0.0], 0.0, [-1.0, 1.0]),
    ]
}

#[test]
fn turned_maps_that_are_turned_back_give_the_same_picture() {
    let techniques = [EXACT, SurfaceTechnique::Marched(Technique::Normal), SurfaceTechnique::Displacement];
    for mesh in ["quad", "cube", "torus"] {
        for technique in techniques {
            for with_normals in [true, false] {
                let draw_with = |transform: Option<&UvTransform>, turns_vectors: bool| {
                    let material = material(transform, with_normals, turns_vectors);
                    let mut scene = with_technique(&scene(mesh, material), technique);
                    scene.materials[0].relief.grid = 65;
                    draw(&scene)
                };
                let expected = draw_with(None, true);
                for transform in &transforms() {
                    let off = mean_difference(&expected, &draw_with(Some(transform), true));
                    let over = share_over(&expected, &draw_with(Some(transform), true), 16);
                    assert!(off < 0.2 && over < 0.01, "{mesh}, {technique:?}, {transform:?}: {off}, {over}");
                    if with_normals && !transform.keeps_directions() {
                        let control = mean_difference(&expected, &draw_with(Some(transform), false));
                        assert!(control > 8.0 * off.max(0.1), "{mesh}, {technique:?}, {transform:?}: {control}, {off}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_map_scaled_and_moved_is_cut_where_its_part_of_the_atlas_ends() {
    let mut atlas = material(None, false, false);
    atlas.relief.edge = Edge::Clip;
    atlas.uv = UvTransform { offset: Vec2::new(0.5, 0.0), scale: Vec2::new(0.5, 1.0), ..UvTransform::default() };
    let inside = |frame: &relievo_cpu::Frame, [low, high]: [f32; 2]| {
        let hit = frame.aovs.hit.texels();
        let of_part = |i: &usize| (low..=high).contains(&frame.aovs.uv.texels()[*i][0]);
        let all = (0..hit.len()).filter(|&i| hit[i] == 1.0);
        (all.clone().count(), all.clone().filter(of_part).count())
    };
    let mut scene = scene("quad", atlas);
    scene.camera.position = Vec3::new(2.0, 0.0, 1.0);
    let (all, right) = inside(&draw(&scene), [0.5, 1.0]);
    assert!(all > 1000 && all == right, "{right} of {all}");
    // A part that is smaller than the polygon ends inside it.
    scene.materials[0].uv_rect = Some([0.5, 0.0, 0.75, 1.0]);
    let (part, first) = inside(&draw(&scene), [0.5, 0.75]);
    assert!(part > 300 && part == first && part < all * 2 / 3, "{first} of {part} of {all}");
    // The control: where nothing is cut the relief goes on.
    scene.materials[0].relief.edge = Edge::Wrap;
    let (all, first) = inside(&draw(&scene), [0.5, 0.75]);
    assert!(first < all);
}
