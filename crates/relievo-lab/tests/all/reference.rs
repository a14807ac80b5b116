//! Comparison with the pictures in `reference/` beside the repository, drawn by the tutorials' GLSL.

use relievo_cpu::{RenderOptions, Renderer};
use relievo_lab::{PixelDifference, pixel_difference};
use relievo_map::Grid;
use relievo_march::{Shadow, Technique};
use relievo_scene::{Scene, SurfaceTechnique};

use crate::tutorials::scenes;

/// Tolerances of the project for a picture drawn by other code on other hardware: bilinear weights and square roots differ
/// in the last bits, and at a silhouette a hair decides between stone and background.
const MEAN: f64 = 1.0;
const OVER: f64 = 0.005;
const THRESHOLD: u8 = 8;

fn difference(scene: &Scene, expected: &Grid<[u8; 3]>) -> PixelDifference {
    let frame = Renderer::new(scene).unwrap().render(&RenderOptions::default()).unwrap();
    pixel_difference(expected, &frame.pixels, THRESHOLD).unwrap()
}

fn same(difference: &PixelDifference) -> bool {
    difference.mean <= MEAN && difference.over <= OVER
}

#[test]
fn every_reference_scene_matches_its_picture() {
    let mut failed = Vec::new();
    for (name, scene, expected) in scenes() {
        let difference = difference(&scene, &expected);
        println!(
            "{name:20} mean {:.4}/255, {:.3} % of pixels over {THRESHOLD}/255, at most {}",
            difference.mean,
            difference.over * 100.0,
            difference.max
        );
        if !same(&difference) {
            failed.push(name);
        }
    }
    assert!(failed.is_empty(), "not the same: {failed:?}");
}

#[test]
fn a_broken_formula_is_caught() {
    // Every scene with one formula exchanged for a neighbouring one, or one number a little off. Not every slip shows in every
    // scene (from some sides the shadows hardly do), but each must show somewhere, and no scene may be blind to most.
    let mut kinds = std::collections::BTreeMap::new();
    for (name, scene, expected) in scenes() {
        let mut caught = 0;
        for (what, broken) in breakages(&scene) {
            let shows = !same(&difference(&broken, &expected));
            *kinds.entry(what).or_insert(0) += u32::from(shows);
            caught += u32::from(shows);
        }
        assert!(caught >= 2, "{name}: only {caught} of its breakages are caught");
    }
    for (what, scenes) in kinds {
        println!("{scenes:3} scenes fail where {what}");
        assert!(scenes > 0, "nothing fails where {what}");
    }
}

/// Variants of the scene with one error each, as a slip would cause it.
fn breakages(scene: &Scene) -> Vec<(&'static str, Scene)> {
    let changed = |change: &dyn Fn(&mut Scene)| {
        let mut scene = scene.clone();
        change(&mut scene);
        scene
    };
    let relief = scene.materials[0].relief;
    let with_relief =
        |change: &dyn Fn(&mut relievo_scene::Relief)| changed(&|scene| change(&mut scene.materials[0].relief));
    let turned = changed(&|scene| {
        if let Some(normal) = &mut scene.materials[0].maps.normal {
            *normal = relievo_map::NormalMap::new(normal.grid().map(|&[x, y, z]| [x, -y, z]));
        }
    });
    let mut broken = vec![
        ("green of the normal map points the other way", turned),
        ("the light has no highlight", changed(&|scene| scene.shading.specular = 0.0)),
    ];
    let SurfaceTechnique::Marched(technique) = relief.technique else { return broken };
    let neighbour = match technique {
        Technique::None | Technique::Normal => return broken,
        Technique::Basic => Technique::OffsetLimiting,
        Technique::OffsetLimiting | Technique::UnityOffset => Technique::Basic,
        Technique::Steep => Technique::Occlusion,
        Technique::Binary => Technique::Relief,
        Technique::Relief | Technique::Occlusion | Technique::Contact => Technique::Steep,
        Technique::Cone | Technique::Exact => Technique::Occlusion,
        other => panic!("no neighbour is known for {other:?}"),
    };
    broken.push((
        "it is drawn by another technique",
        with_relief(&|r| r.technique = SurfaceTechnique::Marched(neighbour)),
    ));
    broken.push((
        "it is a tenth less deep",
        changed(&|scene| {
            if let relievo_scene::HeightRange::Scale(scale) = &mut scene.materials[0].height {
                *scale *= 0.9;
            }
        }),
    ));
    let other_shadow = match relief.shadow {
        Shadow::None | Shadow::Exact => None,
        Shadow::Hard => Some(Shadow::Soft),
        Shadow::Soft => Some(Shadow::Hard),
        other => panic!("no other shadow is known for {other:?}"),
    };
    if let Some(shadow) = other_shadow {
        broken.push(("its shadow is of another kind", with_relief(&|r| r.shadow = shadow)));
        broken.push(("it has no shadow", with_relief(&|r| r.shadow = Shadow::None)));
    }
    if technique == Technique::Steep {
        broken.push(("V.z is divided by, or not", with_relief(&|r| r.offset_limiting = !r.offset_limiting)));
    }
    broken
}
