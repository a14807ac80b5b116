//! Pictures without a window, their times, and devices that fail.

use relievo_gpu::{AdapterChoice, ComputeField, ComputeMarch, Gpu, GpuError, HeightTexture, Offscreen, Tier};
use relievo_gpu::{Renderer, RendererOptions, Target};
use relievo_lab::pixel_difference;
use relievo_march::{MarchOptions, Ray, ReliefMap};
use relievo_scene::Scene;

use crate::common::device::{gpu, open};
use crate::common::scene::{on_cpu, parse};
use crate::common::tolerances::{PICTURE_MEAN, PICTURE_OVER, PICTURE_THRESHOLD};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

fn wall(width: u32, height: u32) -> Scene {
    let text = r#"
        camera = { position = [0.6, -0.9, 1.6] }
        lights = [{ kind = "point", position = [1.0, 1.0, 1.5] }]
        [materials.wall]
        from = "make:brick-wall"
        [[objects]]
        mesh = "quad"
        material = "wall"
    "#;
    let mut scene = parse(text, &[], 128);
    (scene.image.width, scene.image.height) = (width, height);
    scene
}

/// A device with as much as the adapter has: timestamps, if it can.
fn full() -> Option<Gpu> {
    gpu()?;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env());
    Some(pollster::block_on(Gpu::open(&instance, &AdapterChoice::default())).unwrap())
}

fn renderer(gpu: &Gpu, scene: &Scene, format: wgpu::TextureFormat) -> Result<Renderer, GpuError> {
    Renderer::new(&gpu.device, &gpu.queue, scene, format, &RendererOptions::default())
}

#[test]
fn pictures_of_any_width_come_back_whole() {
    let Some(gpu) = full() else { return };
    // A row of 64 pixels needs no padding, all others do.
    for width in [1, 63, 64, 65, 131] {
        let scene = wall(width, 40);
        let expected = on_cpu(&scene).pixels;
        for format in [FORMAT, wgpu::TextureFormat::Bgra8Unorm] {
            let offscreen = Offscreen::new(&gpu.device, &gpu.queue, [width, 40], format).unwrap();
            offscreen.draw(&mut renderer(&gpu, &scene, format).unwrap()).unwrap();
            let got = offscreen.pixels().unwrap();
            let difference = pixel_difference(&expected, &got, PICTURE_THRESHOLD).unwrap();
            // One pixel in a column of 40 is more than the share that may differ.
            let over = PICTURE_OVER.max(1.0 / 40.0);
            assert!(difference.mean <= PICTURE_MEAN && difference.over <= over, "{width} {format:?}: {difference:?}");
        }
    }
}

#[test]
fn a_full_device_times_frames_and_dispatches_by_its_own_clock() {
    let Some(gpu) = full() else { return };
    let scene = wall(64, 48);
    let offscreen = Offscreen::new(&gpu.device, &gpu.queue, [64, 48], FORMAT).unwrap();
    let frame = offscreen.time(&mut renderer(&gpu, &scene, FORMAT).unwrap()).unwrap();
    println!("{}: {frame:?}", gpu.name());
    assert_eq!(frame.gpu.is_some(), gpu.tier() == Tier::Full);
    assert!(!frame.wall.is_zero());
    if !gpu.tier().computes() {
        return;
    }
    let heights = ReliefMap::new(scene.materials[0].maps.height.as_ref().unwrap());
    let texture = HeightTexture::new(&gpu.device, &gpu.queue, &heights).unwrap();
    let field = ComputeField { heights: &texture, lod: 0.0, wrap: relievo_map::Wrap::Repeat };
    let rays = vec![Ray::from_view([0.3, 0.6], [0.6, 0.0, 0.8], [0.05, -0.05]); 1000];
    let mut march = ComputeMarch::new(&gpu.device, &gpu.queue).unwrap();
    let times = march.time(field, &rays, &MarchOptions::default(), 3).unwrap();
    println!("{times:?}");
    assert_eq!(times.len(), 3);
    assert!(times.iter().all(|time| time.gpu.is_some() == (gpu.tier() == Tier::Full) && !time.wall.is_zero()));
}

#[test]
fn pictures_that_cannot_be_are_refused() {
    let Some(gpu) = full() else { return };
    let make = |size, format| Offscreen::new(&gpu.device, &gpu.queue, size, format).unwrap_err().to_string();
    assert!(make([0, 4], FORMAT).contains("0×4"));
    assert!(make([4, 4], wgpu::TextureFormat::R32Float).contains("R32Float"));
    assert!(make([1 << 20, 1], FORMAT).contains("1048576×1"));
}

#[test]
fn maps_and_pictures_over_the_limit_are_refused_with_advice() {
    if gpu().is_none() {
        return;
    }
    let limits = wgpu::Limits::downlevel_webgl2_defaults();
    let gpu = pollster::block_on(open(limits, Some(256))).unwrap();
    let text = "materials.m = { from = \"make:brick-wall\" }\n[[objects]]\nmesh = \"quad\"\nmaterial = \"m\"";
    let large = parse(text, &[], 257);
    let error = Renderer::new(&gpu.device, &gpu.queue, &large, FORMAT, &RendererOptions::default()).err().unwrap();
    assert!(matches!(error, GpuError::TextureTooLarge { width: 257, max: 256, .. }), "{error}");
    assert!(error.to_string().contains("make the map smaller"), "{error}");
    let error = Offscreen::new(&gpu.device, &gpu.queue, [300, 8], FORMAT).unwrap_err();
    assert!(matches!(error, GpuError::TextureTooLarge { width: 300, max: 256, .. }), "{error}");
}

#[test]
fn a_lost_device_is_an_error_and_a_new_one_draws_the_same_picture() {
    let Some(lost) = full() else { return };
    let scene = wall(80, 60);
    let picture = |gpu: &Gpu| {
        let mut renderer = renderer(gpu, &scene, FORMAT)?;
        let offscreen = Offscreen::new(&gpu.device, &gpu.queue, [80, 60], FORMAT)?;
        offscreen.draw(&mut renderer)?;
        Ok::<_, GpuError>((offscreen.pixels()?, renderer, offscreen))
    };
    let (before, mut orphan, offscreen) = picture(&lost).unwrap();
    lost.device.destroy();
    let drawn = [
        ("draw", orphan.draw(&Target::new(offscreen.view(), [80, 60])).err()),
        ("time", offscreen.time(&mut orphan).err()),
        ("measure", orphan.measure([80, 60]).err()),
        ("pixels", offscreen.pixels().err()),
        ("a new renderer", renderer(&lost, &scene, FORMAT).err()),
        ("a new picture", Offscreen::new(&lost.device, &lost.queue, [80, 60], FORMAT).err()),
        ("all of it", picture(&lost).err()),
    ];
    for (what, error) in drawn {
        println!("{what}: {error:?}");
        assert!(matches!(error, Some(GpuError::Device(_))), "{what} on a lost device: {error:?}");
    }

    let (after, ..) = picture(&full().unwrap()).unwrap();
    assert!(before == after, "another picture on the new device");
}
