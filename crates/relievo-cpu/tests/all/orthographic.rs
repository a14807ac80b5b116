//! Orthographic cameras.

use glam::{Affine3A, Vec3};
use relievo_cpu::{Frame, Precision, RenderOptions, Renderer};
use relievo_march::{Shadow, Technique};
use relievo_scene::{CameraKind, Scene, SurfaceTechnique};

use crate::common::{add, draw, hills, relief, shape, share_over, stage, sun, with_technique};

const SIDE: f32 = 128.0;

/// A relief on a quad, seen obliquely and orthographically from `distance`.
fn scene(distance: f32) -> Scene {
    let towards = Vec3::new(-0.49, -0.76, 0.43).normalize();
    let mut scene = stage(160, 120, towards * distance);
    scene.camera.kind = CameraKind::Orthographic;
    scene.camera.size = 2.8;
    scene.lights.push(sun(-0.3, -0.4, -1.0));
    add(&mut scene, shape("quad"), relief(hills(SIDE as u32, SIDE as u32), 0.08), Affine3A::IDENTITY);
    scene
}

/// The fraction of pixels in which one frame sees the relief and the other does not, and the largest distance between hits
/// in texels where both do.
fn hit_differences(a: &Frame, b: &Frame) -> (f64, f32) {
    let (mut masks, mut farthest) = (0, 0.0f32);
    for (i, (p, q)) in a.aovs.hit.texels().iter().zip(b.aovs.hit.texels()).enumerate() {
        if (*p > 0.5) != (*q > 0.5) {
            masks += 1;
        } else if *p > 0.5 {
            let [u, v] = [0, 1].map(|k| a.aovs.uv.texels()[i][k] - b.aovs.uv.texels()[i][k]);
            farthest = farthest.max(SIDE * u.hypot(v));
        }
    }
    (f64::from(masks) / a.aovs.hit.texels().len() as f64, farthest)
}

#[test]
fn the_picture_is_the_same_from_any_distance() {
    let near = draw(&scene(3.0));
    for distance in [30.0, 1e3, 1e5] {
        let far = draw(&scene(distance));
        let (masks, texels) = hit_differences(&near, &far);
        assert!(masks <= 2e-4 && texels < 0.02, "{distance}: {masks} of the mask, {texels} texels");
        assert!(share_over(&near, &far, 2) <= 1e-3, "{distance}");
        let middle = |frame: &Frame| *frame.aovs.depth.get(80, 60);
        assert!((middle(&far) - middle(&near) - (distance - 3.0)).abs() < 1e-5 * distance, "{distance}: depth");
    }
    // The judge tells a size that is a hundredth off.
    let mut larger = scene(3.0);
    larger.camera.size *= 1.01;
    assert!(hit_differences(&near, &draw(&larger)).1 > 0.3);
}

#[test]
fn a_narrow_perspective_from_afar_sees_nearly_the_same() {
    let parallel = draw(&scene(1e3));
    let mut narrow = scene(1e3);
    narrow.camera.kind = CameraKind::Perspective;
    narrow.camera.vertical_fov = 2.0 * (0.5 * narrow.camera.size / 1e3).atan().to_degrees();
    let narrow = draw(&narrow);
    let (masks, _) = hit_differences(&parallel, &narrow);
    // But for silhouettes inside the relief, where a ray's last digit decides.
    let far_off = parallel.aovs.uv.texels().iter().zip(narrow.aovs.uv.texels());
    let far_off = far_off.filter(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]) * SIDE > 0.2).count();
    assert!(masks <= 1e-3 && far_off <= 20, "{masks} of the mask, {far_off} hits");
}

#[test]
fn hits_are_the_oracles_and_level_of_detail_knows_parallel_rays() {
    let scene = scene(1e3);
    let options = RenderOptions { precision: Precision::Oracle, ..RenderOptions::default() };
    let oracle = Renderer::new(&scene).unwrap().render(&options).unwrap();
    let (masks, texels) = hit_differences(&oracle, &draw(&scene));
    assert!(masks == 0.0 && texels < 0.01, "{masks} of the mask, {texels} texels");
    // Under parallel rays every pixel of a plane has the same footprint: the same colours as from close by.
    let mut fine = with_technique(&scene, SurfaceTechnique::Marched(Technique::Exact));
    let mut close = self::scene(3.0);
    for material in fine.materials.iter_mut().chain(&mut close.materials) {
        material.relief.lod = true;
        material.relief.shadow = Shadow::None;
    }
    assert!(share_over(&draw(&fine), &draw(&close), 3) < 2e-3);
}

#[test]
fn nothing_before_the_near_plane_is_drawn() {
    let mut scene = scene(3.0);
    scene.camera.near = 10.0;
    assert!(draw(&scene).aovs.hit.texels().iter().all(|&hit| hit == 0.0));
    scene.camera.size = 0.0;
    assert!(Renderer::new(&scene).is_err());
}
