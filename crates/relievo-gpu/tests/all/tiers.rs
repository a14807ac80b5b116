//! Everything but computing works on the least device.

use relievo_gpu::{ComputeMarch, GpuError, Tier};
use relievo_lab::pixel_difference;

use crate::common::device::{Gpu, gpu, open};
use crate::common::picture::draw;
use crate::common::scene::{on_cpu, parse};
use crate::common::tolerances::{PICTURE_MEAN, PICTURE_OVER, PICTURE_THRESHOLD};

fn least() -> Option<Gpu> {
    gpu()?;
    Some(pollster::block_on(open(wgpu::Limits::downlevel_webgl2_defaults(), None)).unwrap())
}

#[test]
fn a_webgl2_class_device_draws_every_technique_and_shadow() {
    let Some(gpu) = least() else { return };
    assert_eq!(Tier::of(&gpu.device), Tier::WebGl2);
    let text = r#"
        image = { width = 120, height = 90, samples = 2 }
        camera = { position = [0.6, -1.3, 1.6] }
        lights = [{ kind = "point", position = [1.0, 1.0, 1.5] }]
        shading = { model = "pbr", ambient = 0.4 }
        [materials.wall]
        from = "make:brick-wall"
        filter = "trilinear"
        relief = { edge = "clip" }
        [[objects]]
        mesh = "quad"
        material = "wall"
    "#;
    for (technique, shadow) in [
        ("normal", "none"),
        ("basic", "none"),
        ("steep", "hard"),
        ("relief", "soft"),
        ("occlusion", "soft"),
        ("cone", "exact"),
        ("exact", "exact"),
        ("displacement", "none"),
    ] {
        let changes = [format!("technique={technique}"), format!("shadow={shadow}")];
        let changes = changes.map(|change| format!("materials.wall.relief.{change}"));
        let scene = parse(text, &changes.each_ref().map(String::as_str), 128);
        let expected = on_cpu(&scene).pixels;
        let got = draw(&gpu, &scene, wgpu::TextureFormat::Rgba8Unorm);
        let difference = pixel_difference(&expected, &got, PICTURE_THRESHOLD).unwrap();
        println!("{technique}: mean {:.3}/255, {:.3} % over", difference.mean, difference.over * 100.0);
        assert!(difference.mean <= PICTURE_MEAN && difference.over <= PICTURE_OVER, "{technique}: {difference:?}");
    }
}

#[test]
fn where_there_is_no_compute_kernels_are_refused() {
    let Some(gpu) = least() else { return };
    assert_eq!(ComputeMarch::new(&gpu.device, &gpu.queue).unwrap_err(), GpuError::NoCompute);
}
