//! All passes run the same march: what they leave behind is read back and compared. And what else a renderer can be asked.

use glam::Vec3;
use relievo_gpu::{GpuError, Renderer, RendererOptions, Target};
use relievo_lab::pixel_difference;
use relievo_map::{ColorEncoding, ColorMap, Grid};
use relievo_scene::{HeightRange, Scene};

use crate::common::device::{Gpu, gpu};
use crate::common::picture::{draw, draw_with, report, texels};
use crate::common::scene::{on_cpu, parse};
use crate::common::tolerances::{PICTURE_MEAN, PICTURE_OVER, PICTURE_THRESHOLD};

const PLAIN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A wall and a sphere stuck into it, before a point light that stands where the camera does.
fn scene(changes: &[&str]) -> Scene {
    let text = r#"
        [image]
        width = 256
        height = 256
        [camera]
        position = [0.3, -0.4, 1.3]
        target = [0.3, -0.4, 0.0]
        vertical_fov = 90.0
        [[lights]]
        kind = "point"
        position = [0.3, -0.4, 1.3]
        [materials.wall]
        from = "make:brick-wall"
        height_scale = 0.12
        [materials.wall.relief]
        technique = "exact"
        shadow = "exact"
        [[objects]]
        mesh = "quad"
        material = "wall"
        [[objects]]
        mesh = "sphere"
        material = "wall"
        translate = [0.5, 0.2, -0.1]
        scale = 0.35
        uv_repeat = [3, 2]
    "#;
    parse(text, changes, 128)
}

fn renderer(gpu: &Gpu, scene: &Scene, options: RendererOptions) -> Renderer {
    Renderer::new(&gpu.device, &gpu.queue, scene, PLAIN, &options).unwrap()
}

fn same(name: &str, expected: &Grid<[u8; 3]>, got: &Grid<[u8; 3]>) {
    let difference = pixel_difference(expected, got, PICTURE_THRESHOLD).unwrap();
    println!("{name}: mean {:.3}/255, {:.3} % over", difference.mean, difference.over * 100.0);
    if difference.mean > PICTURE_MEAN || difference.over > PICTURE_OVER {
        report(name, expected, got);
        panic!("{name}: {difference:?}");
    }
}

fn depth_texture(gpu: &Gpu, [width, height]: [u32; 2]) -> wgpu::Texture {
    gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: Renderer::DEPTH_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// One layer of the shadow maps, as a depth texture.
fn layer(gpu: &Gpu, maps: &wgpu::Texture, layer: u32) -> wgpu::Texture {
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { depth_or_array_layers: 1, ..maps.size() },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: maps.format(),
        usage: wgpu::TextureUsages::COPY_DST | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let origin = wgpu::Origin3d { x: 0, y: 0, z: layer };
    let from = wgpu::TexelCopyTextureInfo { origin, ..maps.as_image_copy() };
    encoder.copy_texture_to_texture(from, texture.as_image_copy(), texture.size());
    gpu.queue.submit([encoder.finish()]);
    texture
}

#[test]
fn the_shadow_pass_sees_what_the_colour_pass_sees_from_the_same_place_to_the_last_bit() {
    let Some(gpu) = gpu() else { return };
    if !gpu.reads_depth {
        eprintln!("skipped: depth cannot be read back on {}", gpu.name);
        return;
    }
    for technique in ["steep", "relief", "occlusion", "contact", "cone", "exact"] {
        for write_depth in ["true", "false"] {
            let mut scene = scene(&[
                &format!("materials.wall.relief.technique={technique}"),
                &format!("materials.wall.relief.write_depth={write_depth}"),
                // Behind the wall, so that it throws no shadow and the wall alone says how far the map goes.
                "objects.1.mesh=quad",
                "objects.1.translate=[1.2,0.9,-0.5]",
            ]);
            let size = [256, 256];
            let options = RendererOptions { shadow_resolution: Some(size[0]), ..RendererOptions::default() };
            let mut first = renderer(gpu, &scene, options);
            draw_with(gpu, &mut first, size, PLAIN);
            let maps = first.shadow_maps();
            assert_eq!(
                (maps.width(), maps.depth_or_array_layers()),
                (256, 7),
                "six faces, and one that keeps it an array"
            );
            // The last face looks along −z, as the camera does; depths are the same if both begin at the same near plane.
            let shadow: Vec<f32> = texels(gpu, &layer(gpu, maps, 5), wgpu::TextureAspect::DepthOnly)
                .into_iter()
                .map(f32::from_le_bytes)
                .collect();
            let reach = Vec3::new(-1.0, 1.0, 0.0).distance(scene.camera.position);
            scene.camera.near = 1e-3 * reach;
            let color = depth_texture(gpu, size);
            let view = color.create_view(&wgpu::TextureViewDescriptor::default());
            let picture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: color.size(),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: PLAIN,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            let mut second = renderer(gpu, &scene, options);
            let picture = picture.create_view(&wgpu::TextureViewDescriptor::default());
            second.draw(&Target { depth: Some(&view), ..Target::new(&picture, size) }).unwrap();
            let color = texels(gpu, &color, wgpu::TextureAspect::DepthOnly).into_iter().map(f32::from_le_bytes);
            let color: Vec<f32> = color.collect();
            let differ = color.iter().zip(&shadow).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
            assert!(color.iter().any(|&z| z > 0.0) && color.contains(&0.0));
            // Two shapes of the same formula where the polygon's own depth counts: the rasteriser's, and the shader's.
            let most = if write_depth == "true" { 0.0 } else { 1e-6 };
            let apart = color.iter().zip(&shadow).map(|(a, b)| (a - b).abs() / a.max(*b).max(1e-9)).fold(0.0, f32::max);
            println!("{technique}, write_depth = {write_depth}: {differ} texels differ, by at most {apart:e}");
            assert!(apart <= most, "{technique}, write_depth = {write_depth}: {differ} texels differ, by {apart:e}");
        }
    }
}

#[test]
fn what_is_measured_is_what_the_cpu_measures() {
    let Some(gpu) = gpu() else { return };
    if !gpu.draws_floats {
        eprintln!("skipped: float textures cannot be drawn into on {}", gpu.name);
        return;
    }
    for samples in ["1", "3"] {
        let scene = scene(&[
            "lights.0.position=[1.4,1.2,1.1]",
            "camera.position=[0.6,-1.2,1.4]",
            "camera.vertical_fov=60",
            &format!("image.samples={samples}"),
        ]);
        let expected = on_cpu(&scene).aovs;
        let got = renderer(gpu, &scene, RendererOptions::default()).measure([256, 256]).unwrap();
        let share = |name: &str, differs: &dyn Fn(usize) -> bool| {
            let share = (0..256 * 256).filter(|&i| differs(i)).count() as f64 / 65536.0;
            println!("{samples} samples, {name}: {:.3} % differ", share * 100.0);
            assert!(share <= PICTURE_OVER, "{name}: {:.3} % of the pixels differ", share * 100.0);
        };
        let far = |a: f32, b: f32, most: f32| a != b && !((a - b).abs() <= most);
        let (a, b) = (&expected, &got);
        share("depth", &|i| far(a.depth.texels()[i], b.depth.texels()[i], 1e-4));
        share("uv", &|i| (0..2).any(|k| far(a.uv.texels()[i][k], b.uv.texels()[i][k], 1e-4)));
        share("normal", &|i| (0..3).any(|k| far(a.normal.texels()[i][k], b.normal.texels()[i][k], 0.02)));
        share("material", &|i| a.material.texels()[i] != b.material.texels()[i]);
        share("hit", &|i| a.hit.texels()[i] != b.hit.texels()[i]);
        // A ray that meets two reliefs is counted for both on the CPU: where the sphere stands before the wall.
        let one = |i: usize| a.iterations.texels()[i] == b.iterations.texels()[i];
        let agreeing = (0..65536).filter(|&i| one(i)).count();
        assert!(agreeing > 65536 * 6 / 10, "only {agreeing} pixels cost the same");
        assert!(got.shadow.texels().iter().any(|&x| x < 0.5) && got.fetches.texels().iter().any(|&x| x > 1.0));
        share("shadow", &|i| far(a.shadow.texels()[i], b.shadow.texels()[i], 0.51));
    }
}

#[test]
fn other_reliefs_are_taken_over_without_a_new_renderer() {
    let Some(gpu) = gpu() else { return };
    let mut scene = scene(&["camera.position=[0.6,-1.2,1.4]", "lights.0.position=[1.4,1.2,1.1]"]);
    let mut renderer = renderer(gpu, &scene, RendererOptions::default());
    let before = draw_with(gpu, &mut renderer, [256, 256], PLAIN);
    for (technique, shadow, scale) in [
        ("occlusion", "soft", 0.05),
        ("displacement", "none", 0.08),
        ("normal", "none", 0.08),
        ("exact", "exact", 0.12),
    ] {
        let relief = &mut scene.materials[0].relief;
        relief.technique = relievo_scene::SurfaceTechnique::from_name(technique).unwrap();
        relief.shadow = relievo_march::Shadow::from_name(shadow).unwrap();
        scene.materials[0].height = HeightRange::Scale(scale);
        renderer.set_reliefs(&scene).unwrap();
        let got = draw_with(gpu, &mut renderer, [256, 256], PLAIN);
        assert_eq!(got, draw(gpu, &scene, PLAIN), "{technique}: not as a new renderer draws it");
    }
    assert_eq!(draw_with(gpu, &mut renderer, [256, 256], PLAIN), before, "back where it was");
    scene.materials[0].relief.technique = relievo_scene::SurfaceTechnique::Displacement;
    scene.materials[0].relief.grid = 1 << 15;
    assert!(renderer.set_reliefs(&scene).unwrap_err().to_string().contains("choose a smaller grid"));
    assert_eq!(draw_with(gpu, &mut renderer, [256, 256], PLAIN), before, "unharmed by what it refused");
    scene.materials[0].relief.vertices_per_texel = Some(2);
    assert!(renderer.set_reliefs(&scene).unwrap_err().to_string().contains("on the CPU"));
    scene.materials.push(scene.materials[0].clone());
    assert!(matches!(renderer.set_reliefs(&scene), Err(GpuError::Scene(_))));
    assert_eq!(draw_with(gpu, &mut renderer, [256, 256], PLAIN), before, "and again");
}

/// One layer, and six: OpenGL takes textures of these for something else than arrays.
#[test]
fn a_single_light_throws_shadows_as_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    for name in ["lamp", "sun"] {
        let mut scene = scene(&[
            "camera.position=[0.6,-1.2,1.4]",
            "objects.1.translate=[0.2,0.1,0.5]",
            "lights.0.position=[1.4,1.2,1.3]",
        ]);
        if name == "sun" {
            let direction = Vec3::new(-0.6, -0.5, -0.6).normalize();
            scene.lights[0].kind = relievo_scene::LightKind::Directional { direction };
        }
        same(name, &on_cpu(&scene).pixels, &draw(gpu, &scene, PLAIN));
        scene.materials[0].relief.shadow = relievo_march::Shadow::None;
        let without = draw(gpu, &scene, PLAIN);
        scene.materials[0].relief.shadow = relievo_march::Shadow::Exact;
        let shadows = pixel_difference(&without, &draw(gpu, &scene, PLAIN), PICTURE_THRESHOLD).unwrap();
        assert!(shadows.over > 0.05, "{name}: hardly a shadow: {shadows:?}");
    }
}

#[test]
fn depth_drawn_before_changes_nothing() {
    let Some(gpu) = gpu() else { return };
    let scene = scene(&["camera.position=[0.6,-1.2,1.4]", "lights.0.position=[1.4,1.2,1.1]"]);
    let prepass = RendererOptions { depth_prepass: true, ..RendererOptions::default() };
    let got = draw_with(gpu, &mut renderer(gpu, &scene, prepass), [256, 256], PLAIN);
    assert_eq!(got, draw(gpu, &scene, PLAIN));
}

#[test]
fn multisampling_smooths_the_borders_of_polygons_and_of_clipped_reliefs() {
    let Some(gpu) = gpu() else { return };
    // A wall seen at a slant, clipped where its bricks end, and nothing else that has borders.
    let changes = |samples: &str| {
        let mut scene = scene(&[
            "camera.position=[1.9,-1.2,0.7]",
            "camera.vertical_fov=60",
            "materials.wall.relief.shadow=none",
            "materials.wall.filter=trilinear",
            &format!("image.samples={samples}"),
        ]);
        scene.objects.truncate(1);
        scene.shading.specular = 0.0;
        scene
    };
    let truth = on_cpu(&changes("64")).pixels;
    let plain = draw(gpu, &changes("1"), PLAIN);
    let options = RendererOptions { msaa: 4, ..RendererOptions::default() };
    let smooth = draw_with(gpu, &mut renderer(gpu, &changes("1"), options), [256, 256], PLAIN);
    // How far the pixels are off that the wall covers in part.
    let hit = on_cpu(&changes("64")).aovs.hit;
    let off = |picture: &Grid<[u8; 3]>| {
        let pixels = (0..65536).filter(|&i| (0.02..0.98).contains(&hit.texels()[i]));
        let squares = |i: usize| {
            let (a, b) = (truth.texels()[i], picture.texels()[i]);
            (0..3).map(|k| (f64::from(a[k]) - f64::from(b[k])).powi(2)).sum::<f64>()
        };
        let (count, sum) = pixels.fold((0, 0.0), |(count, sum), i| (count + 1, sum + squares(i)));
        assert!(count > 300, "only {count} pixels are borders");
        (sum / f64::from(count)).sqrt()
    };
    let (rough, smooth_off) = (off(&plain), off(&smooth));
    println!("borders are off by {rough:.1} without and by {smooth_off:.1} with multisampling");
    assert!(smooth_off < 0.6 * rough, "{smooth_off} of {rough}");
    report("multisampled", &truth, &smooth);
    let odd = RendererOptions { msaa: 3, ..RendererOptions::default() };
    let error = Renderer::new(&gpu.device, &gpu.queue, &changes("1"), PLAIN, &odd).map(drop).unwrap_err();
    assert!(error.to_string().contains("msaa is 3"), "{error}");
}

#[test]
fn surroundings_light_and_fill_the_picture_as_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let sky = Grid::from_fn(64, 32, |x, y| {
        let sun = if (20..24).contains(&x) && (6..9).contains(&y) { 30.0 } else { 0.0 };
        [0.2 + sun, 0.3 + 0.01 * y as f32 + sun, 0.9 - 0.02 * y as f32 + sun, 1.0]
    });
    for model in ["pbr", "blinn-phong"] {
        for samples in ["1", "2"] {
            for space in ["linear", "display"] {
                let mut scene = scene(&[
                    &format!("shading.model={model}"),
                    &format!("shading.color_space={space}"),
                    &format!("image.samples={samples}"),
                    "camera.position=[0.6,-1.2,1.4]",
                    "lights.0.intensity=0.2",
                ]);
                scene.environment = Some(ColorMap { grid: sky.clone(), encoding: ColorEncoding::Linear });
                scene.materials[0].roughness = 0.4;
                scene.materials[0].metallic = if samples == "1" { 0.0 } else { 1.0 };
                scene.materials[0].maps.roughness = None;
                let name = format!("surroundings-{model}-{samples}-{space}");
                same(&name, &on_cpu(&scene).pixels, &draw(gpu, &scene, PLAIN));
            }
        }
    }
}
