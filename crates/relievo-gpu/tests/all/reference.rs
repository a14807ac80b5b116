//! The renderer draws the tutorials' own pictures, in `reference/` beside the repository, and what the CPU draws.

use relievo_lab::{PixelDifference, pixel_difference};
use relievo_scene::HeightRange;

use crate::common::device::gpu;
use crate::common::picture::{draw, report};
use crate::common::scene::on_cpu;
use crate::common::tolerances::{PICTURE_MEAN, PICTURE_OVER, PICTURE_THRESHOLD};
use crate::tutorials::scenes;

fn same(difference: &PixelDifference) -> bool {
    difference.mean <= PICTURE_MEAN && difference.over <= PICTURE_OVER
}

fn said(difference: &PixelDifference) -> String {
    let PixelDifference { mean, over, max, .. } = difference;
    format!("mean {mean:.4}/255, {:.3} % over {PICTURE_THRESHOLD}/255, at most {max}", over * 100.0)
}

#[test]
fn every_reference_scene_is_drawn_as_the_tutorials_and_the_cpu_draw_it() {
    let Some(gpu) = gpu() else { return };
    let mut failed = Vec::new();
    for (name, scene, expected) in scenes() {
        let got = draw(gpu, &scene, wgpu::TextureFormat::Rgba8Unorm);
        let cpu = on_cpu(&scene).pixels;
        let to_tutorial = pixel_difference(&expected, &got, PICTURE_THRESHOLD).unwrap();
        let to_cpu = pixel_difference(&cpu, &got, PICTURE_THRESHOLD).unwrap();
        println!("{name:20} tutorial: {}; CPU: {}", said(&to_tutorial), said(&to_cpu));
        if !same(&to_tutorial) || !same(&to_cpu) {
            report(&name, &cpu, &got);
            failed.push(name);
        }
    }
    assert!(failed.is_empty(), "not the same: {failed:?}");
}

#[test]
fn a_height_a_tenth_off_is_caught() {
    let Some(gpu) = gpu() else { return };
    for (name, mut scene, expected) in scenes() {
        if name.ends_with("normal") {
            scene.shading.specular *= 2.0;
        }
        for material in &mut scene.materials {
            if let HeightRange::Scale(scale) = &mut material.height {
                *scale *= 0.9;
            }
        }
        let got = draw(gpu, &scene, wgpu::TextureFormat::Rgba8Unorm);
        let difference = pixel_difference(&expected, &got, PICTURE_THRESHOLD).unwrap();
        assert!(!same(&difference), "{name} passes although it is drawn wrongly");
    }
}
