//! What the GPU measures against the CPU and the truth: orthographic cameras, lamps among the relief, flat 8-bit normals.

use relievo_lab::pixel_difference;
use relievo_map::{Grid, NormalMap};
use relievo_scene::{Aovs, Scene};

use crate::common::device::gpu;
use crate::common::picture::draw;
use crate::common::scene::{measured, on_cpu, parse};
use crate::common::tolerances::{PICTURE_MEAN, PICTURE_OVER, PICTURE_THRESHOLD};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

fn scene(text: &str, changes: &[&str]) -> Scene {
    parse(text, changes, 128)
}

/// The fraction of pixels for which a condition holds.
fn share(size: [u32; 2], holds: impl Fn(usize) -> bool) -> f64 {
    let count = (size[0] * size[1]) as usize;
    (0..count).filter(|&i| holds(i)).count() as f64 / count as f64
}

const WALL: &str = r#"
    [image]
    width = 160
    height = 120
    [camera]
    kind = "orthographic"
    size = 2.6
    [[lights]]
    kind = "directional"
    direction = [-0.3, -0.4, -1.0]
    [materials.wall]
    from = "make:brick-wall"
    height_scale = 0.06
    [materials.wall.relief]
    shadow = "exact"
    [[objects]]
    mesh = "quad"
    material = "wall"
    [[objects]]
    mesh = "sphere"
    material = "wall"
    translate = [0.3, 0.2, 0.4]
    scale = 0.4
    uv_repeat = [3, 2]
"#;

#[test]
fn an_orthographic_camera_sees_on_the_gpu_what_it_sees_on_the_cpu_from_any_distance() {
    let Some(gpu) = gpu() else { return };
    let size = [160, 120];
    for (distance, changes) in
        [(3.0, &[][..]), (1000.0, &[]), (3.0, &["materials.wall.relief.lod=true"]), (3.0, &["image.samples=4"])]
    {
        let position = format!("camera.position=[{}, {}, {}]", -0.49 * distance, -0.76 * distance, 0.43 * distance);
        let scene = scene(WALL, &[&[position.as_str()], changes].concat());
        let (cpu, pixels) = (on_cpu(&scene), draw(gpu, &scene, FORMAT));
        let off = pixel_difference(&cpu.pixels, &pixels, PICTURE_THRESHOLD).unwrap();
        let got = measured(gpu, &scene);
        let masks = share(size, |i| (cpu.aovs.hit.texels()[i] > 0.5) != (got.hit.texels()[i] > 0.5));
        let depths = share(size, |i| {
            let (a, b) = (cpu.aovs.depth.texels()[i], got.depth.texels()[i]);
            a.is_finite() && b.is_finite() && (a - b).abs() > 1e-3
        });
        println!(
            "{distance} {changes:?}: mean {:.3}, {:.2} % over; mask {masks}, depth {depths}",
            off.mean,
            off.over * 100.0
        );
        assert!(off.mean <= PICTURE_MEAN && off.over <= PICTURE_OVER, "{distance} {changes:?}: {off:?}");
        assert!(masks <= 2e-3 && depths <= 5e-3, "{distance} {changes:?}: mask {masks}, depth {depths}");
    }
    // The judge tells the two projections apart.
    let position = "camera.position=[-1.47, -2.28, 1.29]";
    let perspective = on_cpu(&scene(WALL, &[position, "camera.kind=perspective"]));
    let off = pixel_difference(&perspective.pixels, &draw(gpu, &scene(WALL, &[position]), FORMAT), PICTURE_THRESHOLD)
        .unwrap();
    assert!(off.over > 10.0 * PICTURE_OVER);
}

const LAMP: &str = r#"
    [image]
    width = 200
    height = 150
    [camera]
    position = [-0.5, -1.9, 1.3]
    vertical_fov = 50
    [[lights]]
    kind = "point"
    position = [0.02, -0.3, -0.15]
    [materials.m]
    from = "make:toy-box"
    depth = 0.4
    [materials.m.relief]
    edge = "clip"
    shadow = "exact"
    grid = 512
    [[objects]]
    mesh = "quad"
    material = "m"
"#;

#[test]
fn shadow_rays_end_at_a_lamp_below_the_lid() {
    let Some(gpu) = gpu() else { return };
    let size = [200, 150];
    for (midlevel, z) in [(1, -0.05), (1, -0.15), (1, -0.3), (0, 0.25)] {
        let changed = |z: f32, technique: &str| {
            let changes = [
                format!("materials.m.midlevel={midlevel}"),
                format!("lights.0.position=[0.02, -0.3, {z}]"),
                format!("materials.m.relief.technique={technique}"),
            ];
            scene(LAMP, &changes.each_ref().map(String::as_str))
        };
        let truth = on_cpu(&changed(z, "displacement")).aovs;
        let differ = |got: &Aovs| {
            share(size, |i| {
                let seen = truth.hit.texels()[i] > 0.5 && got.hit.texels()[i] > 0.5;
                seen && (truth.shadow.texels()[i] - got.shadow.texels()[i]).abs() > 0.5
            })
        };
        let got = differ(&measured(gpu, &changed(z, "exact")));
        let too_high = differ(&measured(gpu, &changed(z + 0.03, "exact")));
        println!("midlevel {midlevel}, z {z}: {:.2} %; a lamp too high: {:.2} %", got * 100.0, too_high * 100.0);
        assert!(got <= 0.004, "midlevel {midlevel}, z {z}: {got}");
        assert!(too_high > 0.004, "midlevel {midlevel}, z {z}: {too_high}");
    }
}

const SEAM: &str = r#"
    [image]
    width = 40
    height = 24
    [[lights]]
    kind = "directional"
    direction = [0.0, 0.0, -1.0]
    [materials.m]
    [materials.m.relief]
    technique = "normal"
    [[objects]]
    mesh = "quad"
    material = "m"
    scale = [0.5, 1.0, 1.0]
    translate = [-0.5, 0.0, 0.0]
    [[objects]]
    mesh = "quad"
    material = "m"
    scale = [-0.5, 1.0, 1.0]
    translate = [0.5, 0.0, 0.0]
"#;

#[test]
fn flat_normals_of_eight_bits_leave_no_seam_between_mirrored_halves() {
    let Some(gpu) = gpu() else { return };
    for lod in ["false", "true"] {
        let degrees = |normal: [f32; 3]| {
            let mut scene = scene(SEAM, &[&format!("materials.m.relief.lod={lod}")]);
            scene.materials[0].maps.normal = Some(NormalMap::new(Grid::filled(8, 8, normal)));
            [on_cpu(&scene).aovs, measured(gpu, &scene)].map(|aovs| {
                let seen = aovs.normal.texels().iter().zip(aovs.hit.texels()).filter(|(_, hit)| **hit > 0.5);
                seen.map(|([x, y, _], _)| x.hypot(*y).asin().to_degrees()).fold(0.0, f32::max)
            })
        };
        assert_eq!(degrees([128, 128, 255].map(NormalMap::decode8)), [0.0; 2], "lod {lod}");
        assert_eq!(degrees([127, 128, 255].map(NormalMap::decode8)), [0.0; 2], "lod {lod}");
        // As it was decoded before.
        let leaning = degrees([128.0f32, 128.0, 255.0].map(|x| 2.0 * x / 255.0 - 1.0));
        assert!(leaning.iter().all(|&angle| angle > 0.2), "lod {lod}: {leaning:?}");
    }
}
