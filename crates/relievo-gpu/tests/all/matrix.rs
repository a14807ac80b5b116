//! The renderer draws what the CPU draws: technique, shadow, edge, colour space, shading, filter and mesh against each other.

use relievo_gpu::{GpuError, Renderer, RendererOptions, Target};
use relievo_lab::{PixelDifference, pixel_difference};
use relievo_map::{Grid, Wrap};
use relievo_scene::{Filter, HeightRange, Scene};

use crate::common::device::{Gpu, gpu};
use crate::common::picture::{draw, draw_with, report, texels};
use crate::common::scene::{on_cpu, parse};
use crate::common::tolerances::{DEPTH_OF_PIXEL, PICTURE_MEAN, PICTURE_OVER, PICTURE_THRESHOLD};

const PLAIN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// A wall lit by all three kinds of light, with changes.
fn scene(changes: &[&str]) -> Scene {
    let text = r#"
        [image]
        width = 160
        height = 120
        [camera]
        position = [0.7, -1.1, 1.7]
        [[lights]]
        kind = "point"
        position = [1.5, 1.6, 1.2]
        intensity = 0.5
        [[lights]]
        kind = "directional"
        direction = [0.7, -0.3, -0.6]
        color = [0.5, 0.6, 0.8]
        intensity = 0.5
        [[lights]]
        kind = "spot"
        position = [-1.0, -1.5, 1.5]
        direction = [0.6, 0.9, -1.0]
        inner_angle = 15.0
        outer_angle = 35.0
        color = [1.0, 0.7, 0.4]
        [shading]
        model = "blinn-phong"
        [materials.wall]
        from = "make:brick-wall"
        height_scale = 0.12
        [materials.wall.relief]
        technique = "exact"
        [[objects]]
        mesh = "quad"
        material = "wall"
        [[objects]]
        mesh = "quad"
        material = "wall"
        translate = [0.4, 0.2, -0.6]
        rotate = [-20.0, 30.0, 10.0]
        uv_repeat = [3, 2]
    "#;
    parse(text, changes, 128)
}

fn compared(gpu: &Gpu, scene: &Scene) -> (PixelDifference, Grid<[u8; 3]>, Grid<[u8; 3]>) {
    let (expected, got) = (on_cpu(scene).pixels, draw(gpu, scene, PLAIN));
    (pixel_difference(&expected, &got, PICTURE_THRESHOLD).unwrap(), expected, got)
}

fn same(difference: &PixelDifference) -> bool {
    difference.mean <= PICTURE_MEAN && difference.over <= PICTURE_OVER
}

/// Fails if any of the scenes is drawn differently.
fn all_same(scenes: impl IntoIterator<Item = (String, Scene)>) {
    let Some(gpu) = gpu() else { return };
    let mut failed = Vec::new();
    let (mut count, mut mean, mut over) = (0, 0.0f64, 0.0f64);
    for (name, scene) in scenes {
        let (difference, expected, got) = compared(gpu, &scene);
        count += 1;
        mean = mean.max(difference.mean);
        over = over.max(difference.over);
        if !same(&difference) {
            println!("{name}: mean {:.3}/255, {:.3} % over", difference.mean, difference.over * 100.0);
            report(&name.replace(['=', '/', ' '], "-"), &expected, &got);
            failed.push(name);
        }
        let first = expected.texels()[0];
        assert!(expected.texels().iter().any(|&p| p != first), "an empty picture tests nothing");
    }
    println!("{count} pictures: mean at most {mean:.4}/255, at most {:.3} % of pixels over", over * 100.0);
    assert!(failed.is_empty(), "not the same: {failed:?}");
}

const TECHNIQUES: [&str; 13] = [
    "none",
    "normal",
    "basic",
    "offset-limiting",
    "unity-offset",
    "steep",
    "binary",
    "relief",
    "occlusion",
    "contact",
    "cone",
    "exact",
    "displacement",
];

fn named(changes: &[&str]) -> (String, Scene) {
    (changes.join(" ").replace("materials.wall.", "").replace("relief.", ""), scene(changes))
}

#[test]
fn techniques_edges_and_colour_spaces() {
    let mut scenes = Vec::new();
    for technique in TECHNIQUES {
        for edge in ["clip", "wrap", "clamp"] {
            for space in ["linear", "display"] {
                scenes.push(named(&[
                    &format!("materials.wall.relief.technique={technique}"),
                    &format!("materials.wall.relief.edge={edge}"),
                    &format!("shading.color_space={space}"),
                ]));
            }
        }
    }
    all_same(scenes);
}

/// Several objects and all three kinds of light.
#[test]
fn objects_throw_shadows_on_each_other() {
    let mut scenes = Vec::new();
    for technique in TECHNIQUES {
        // The facets of displaced geometry are to be larger than a texel of the maps.
        let size = if technique == "displacement" { ["640", "480"] } else { ["320", "240"] };
        scenes.push(named(&[
            &format!("materials.wall.relief.technique={technique}"),
            "materials.wall.relief.shadow=exact",
            &format!("image.width={}", size[0]),
            &format!("image.height={}", size[1]),
        ]));
    }
    for (mesh, radius) in
        [("sphere", "0"), ("torus", "0"), ("cylinder", "0"), ("cube", "0"), ("cube", "0.1"), ("quad", "0.15")]
    {
        scenes.push(named(&[
            &format!("objects.1.mesh={mesh}"),
            "objects.1.translate=[0.1,-0.1,0.3]",
            "objects.1.scale=0.3",
            // A caster that a light sees along its plane has a shadow that no map from the light's middle can show.
            "objects.1.rotate=[0,0,10]",
            &format!("lights.0.radius={radius}"),
            &format!("lights.1.radius={radius}"),
            &format!("lights.2.radius={radius}"),
            "materials.wall.relief.shadow=exact",
            "image.width=320",
            "image.height=240",
        ]));
    }
    all_same(scenes);
}

#[test]
fn techniques_and_self_shadows() {
    let mut scenes = Vec::new();
    for technique in ["basic", "steep", "occlusion", "exact"] {
        for shadow in ["hard", "soft", "exact"] {
            for radius in ["0", "0.2"] {
                let changes = [
                    &format!("materials.wall.relief.technique={technique}"),
                    &format!("materials.wall.relief.shadow={shadow}"),
                    &format!("lights.0.radius={radius}"),
                    "materials.wall.relief.edge=clip",
                ];
                let (name, mut scene) = named(&changes.map(|change| change as &str));
                scene.objects.truncate(1);
                scenes.push((name, scene));
            }
        }
    }
    all_same(scenes);
}

#[test]
fn meshes_shading_models_and_depth_modes() {
    let mut scenes = Vec::new();
    for mesh in ["quad", "plane", "cube", "sphere", "cylinder", "torus"] {
        for (model, range) in [("pbr", HeightRange::Scale(0.06)), ("blinn-phong", HeightRange::Depth(0.08))] {
            for write_depth in ["false", "true"] {
                let (name, mut scene) = named(&[
                    &format!("objects.0.mesh={mesh}"),
                    "objects.0.uv_repeat=[3,2]",
                    "objects.0.rotate=[20,30,0]",
                    "objects.0.scale=[0.8,0.6,0.7]",
                    &format!("shading.model={model}"),
                    &format!("materials.wall.relief.write_depth={write_depth}"),
                ]);
                scene.materials[0].height = range;
                scenes.push((format!("{name} {range:?}"), scene));
            }
        }
    }
    all_same(scenes);
}

#[test]
fn levels_of_detail_wrap_modes_and_midlevels() {
    let mut scenes = Vec::new();
    for lod in ["true", "false"] {
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            for midlevel in [1.0, 0.4] {
                let lod = format!("materials.wall.relief.lod={lod}");
                // Where the nearest level changes some drivers fetch the neighbour pixel's: a line of pixels, however large
                // the picture.
                let size = ["image.width=320", "image.height=240"];
                let (name, mut scene) = named(&[&lod, "objects.1.uv_repeat=[7,5]", size[0], size[1]]);
                for material in &mut scene.materials {
                    material.wrap = wrap;
                    material.midlevel = midlevel;
                    material.filter = Filter::Trilinear;
                }
                scenes.push((format!("{name} {wrap:?} {midlevel}"), scene));
            }
        }
    }
    all_same(scenes);
}

/// Walls whose relief is gone, going and whole, and whose normals scatter within a pixel.
fn far_away() -> Vec<(String, Scene)> {
    let mut scenes = Vec::new();
    for (technique, repeat, shadow, model, from_heights) in [
        ("normal", "[40,30]", "none", "pbr", true),
        ("occlusion", "[40,30]", "hard", "blinn-phong", false),
        ("exact", "[12,9]", "exact", "pbr", false),
        ("exact", "[40,30]", "exact", "blinn-phong", false),
        ("exact", "[40,30]", "soft", "pbr", true),
        ("exact", "[200,150]", "exact", "blinn-phong", false),
        ("displacement", "[6,4]", "none", "blinn-phong", false),
    ] {
        let (name, mut scene) = named(&[
            &format!("materials.wall.relief.technique={technique}"),
            &format!("materials.wall.relief.shadow={shadow}"),
            &format!("objects.0.uv_repeat={repeat}"),
            &format!("shading.model={model}"),
            "materials.wall.relief.lod=true",
            "materials.wall.roughness=0.5",
            "shading.specular=0.8",
            "shading.shininess=60",
        ]);
        scene.objects.truncate(1);
        if from_heights {
            scene.materials[0].maps.normal = None;
        }
        scenes.push((format!("{name} from_heights={from_heights}"), scene));
    }
    scenes
}

#[test]
fn far_away_reliefs_fade_and_highlights_widen_alike() {
    all_same(far_away());
}

#[test]
fn level_of_detail_that_only_one_of_the_two_has_is_caught() {
    let Some(gpu) = gpu() else { return };
    let mut uncaught = Vec::new();
    type Break = fn(&mut Scene);
    let breaks: [(&str, Break); 2] = [
        ("no level of detail", |scene| scene.materials[0].relief.lod = false),
        ("nothing widens", |scene| {
            let grid = Grid::filled(1, 1, [0.0, 0.0, 1.0]);
            scene.materials[0].maps.normal = Some(relievo_map::NormalMap::new(grid));
        }),
    ];
    for (name, scene) in
        far_away().into_iter().filter(|(name, _)| name.contains("technique=exact") && name.contains("[40,30]"))
    {
        let got = draw(gpu, &scene, PLAIN);
        for (what, change) in breaks {
            let mut broken = scene.clone();
            change(&mut broken);
            if same(&pixel_difference(&on_cpu(&broken).pixels, &got, PICTURE_THRESHOLD).unwrap()) {
                uncaught.push(format!("{name}: {what}"));
            }
        }
    }
    assert!(uncaught.is_empty(), "{uncaught:?}");
}

#[test]
fn several_samples_per_pixel_lie_where_the_cpus_do() {
    let mut scenes = Vec::new();
    for space in ["linear", "display"] {
        for samples in ["2", "5"] {
            let changes = [
                "materials.wall.filter=trilinear",
                &format!("shading.color_space={space}"),
                &format!("image.samples={samples}"),
            ];
            scenes.push(named(&changes));
        }
        let changes = ["image.samples=4", "lights.0.radius=0.2", "materials.wall.relief.shadow=exact"];
        let (name, mut scene) = named(&changes);
        scene.objects.truncate(1);
        scenes.push((name, scene));
    }
    all_same(scenes);
}

#[test]
fn normals_come_from_the_heights_where_there_is_no_normal_map() {
    let scenes = ["exact", "normal", "steep"].map(|technique| {
        let (name, mut scene) = named(&[&format!("materials.wall.relief.technique={technique}")]);
        scene.materials[0].maps.normal = None;
        (format!("{name} without normal map"), scene)
    });
    all_same(scenes);
}

#[test]
fn targets_that_encode_by_themselves_show_the_same_picture() {
    let Some(gpu) = gpu() else { return };
    for space in ["linear", "display"] {
        let scene = scene(&[&format!("shading.color_space={space}")]);
        let plain = draw(gpu, &scene, PLAIN);
        let encoding = draw(gpu, &scene, wgpu::TextureFormat::Rgba8UnormSrgb);
        let difference = pixel_difference(&plain, &encoding, 2).unwrap();
        // Hardware may round the curve differently, by one step.
        assert!(difference.mean < 0.5 && difference.max <= 1, "{space}: {difference:?}");
    }
}

#[test]
fn the_same_renderer_draws_other_sizes_cameras_and_lights() {
    let Some(gpu) = gpu() else { return };
    let mut scene = scene(&[]);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &scene, PLAIN, &RendererOptions::default()).unwrap();
    scene.image.width = 97;
    scene.image.height = 61;
    scene.camera.position.x = -1.0;
    scene.lights.truncate(1);
    renderer.set_camera(&scene.camera).unwrap();
    renderer.set_lights(&scene.lights).unwrap();
    let got = draw_with(gpu, &mut renderer, [97, 61], PLAIN);
    assert!(same(&pixel_difference(&on_cpu(&scene).pixels, &got, PICTURE_THRESHOLD).unwrap()));
    let again = draw_with(gpu, &mut renderer, [97, 61], PLAIN);
    assert_eq!(got, again, "the same twice is the same");
}

#[test]
fn a_sphere_stuck_through_the_wall_is_cut_where_the_bricks_are() {
    let Some(gpu) = gpu() else { return };
    let stuck = |write_depth: &str| {
        scene(&[
            "objects.1.mesh=sphere",
            "objects.1.uv_repeat=[1,1]",
            "objects.1.translate=[0,0,-0.35]",
            "objects.1.scale=0.4",
            "materials.wall.height_scale=0.2",
            &format!("materials.wall.relief.write_depth={write_depth}"),
        ])
    };
    let (at_bricks, at_polygon) = (draw(gpu, &stuck("true"), PLAIN), draw(gpu, &stuck("false"), PLAIN));
    assert!(same(&pixel_difference(&on_cpu(&stuck("true")).pixels, &at_bricks, PICTURE_THRESHOLD).unwrap()));
    let cut = pixel_difference(&at_bricks, &at_polygon, PICTURE_THRESHOLD).unwrap();
    assert!(cut.over > 0.01, "the depth that is written makes no difference: {cut:?}");
}

/// The depth that the colour pass leaves, and that of the depth pass.
fn depths(gpu: &Gpu, scene: &Scene) -> [Vec<f32>; 2] {
    let size = [scene.image.width, scene.image.height];
    let texture = |format, usage| {
        gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
            view_formats: &[],
        })
    };
    let color = texture(PLAIN, wgpu::TextureUsages::empty()).create_view(&wgpu::TextureViewDescriptor::default());
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, scene, PLAIN, &RendererOptions::default()).unwrap();
    [true, false].map(|with_color| {
        let depth = texture(Renderer::DEPTH_FORMAT, wgpu::TextureUsages::COPY_SRC);
        let view = depth.create_view(&wgpu::TextureViewDescriptor::default());
        if with_color {
            renderer.draw(&Target { depth: Some(&view), ..Target::new(&color, size) }).unwrap();
        } else {
            renderer.draw_depth(&view, size).unwrap();
        }
        texels(gpu, &depth, wgpu::TextureAspect::DepthOnly).into_iter().map(f32::from_le_bytes).collect()
    })
}

#[test]
fn depth_and_colour_pass_agree_to_the_last_bit_and_with_the_cpu() {
    let Some(gpu) = gpu() else { return };
    if !gpu.reads_depth {
        eprintln!("skipped: depth cannot be read back on {}", gpu.name);
        return;
    }
    for technique in TECHNIQUES {
        for (write_depth, lod) in [("true", "false"), ("false", "false"), ("true", "true")] {
            let scene = scene(&[
                &format!("materials.wall.relief.technique={technique}"),
                &format!("materials.wall.relief.write_depth={write_depth}"),
                "materials.wall.relief.edge=clip",
                "materials.wall.filter=trilinear",
                &format!("materials.wall.relief.lod={lod}"),
            ]);
            let [with_color, alone] = depths(gpu, &scene);
            let differ = with_color.iter().zip(&alone).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
            assert_eq!(differ, 0, "{technique}, write_depth = {write_depth}: pixels of the two passes differ");
            if lod == "true" {
                // Where levels change, see the test of levels.
                continue;
            }
            let share = other_depths(&scene, &with_color);
            assert!(share <= PICTURE_OVER, "{technique}, write_depth = {write_depth}: {:.3} % differ", share * 100.0);
            assert!(with_color.iter().any(|&z| z > 0.0) && with_color.contains(&0.0), "{technique}");
        }
    }
}

/// Pixels of a picture's depth that differ from the CPU's, as a share.
fn other_depths(scene: &Scene, got: &[f32]) -> f64 {
    let frame = on_cpu(scene);
    let off = |(cpu, gpu): &(&f32, &f32)| {
        let distance = scene.camera.near / **gpu;
        // Infinite where nothing is hit, on both.
        **cpu != distance && !((*cpu - distance).abs() <= DEPTH_OF_PIXEL * *cpu)
    };
    let pairs = frame.aovs.depth.texels().iter().zip(got);
    pairs.filter(off).count() as f64 / got.len() as f64
}

#[test]
fn reliefs_sink_into_their_polygons_alike() {
    let Some(gpu) = gpu() else { return };
    if !gpu.reads_depth {
        eprintln!("skipped: depth cannot be read back on {}", gpu.name);
        return;
    }
    // Of one height everywhere the hit's depth tells how much of the full one is left, and levels make no difference.
    let mut scene = scene(&["materials.wall.relief.lod=true", "objects.0.uv_repeat=[12,12]"]);
    scene.objects.truncate(1);
    let low = relievo_map::HeightMap::new(Grid::filled(64, 64, 0.25));
    scene.materials[0].maps.height = Some(low);
    let [with_color, alone] = depths(gpu, &scene);
    assert_eq!(with_color, alone);
    let share = other_depths(&scene, &with_color);
    assert!(share <= PICTURE_OVER, "{share}");
    // The whole depth, and none, are told apart from what is left of it.
    for technique in ["exact", "none"] {
        let mut other = scene.clone();
        other.materials[0].relief.lod = false;
        other.materials[0].relief.technique = relievo_scene::SurfaceTechnique::from_name(technique).unwrap();
        let share = other_depths(&other, &with_color);
        assert!(share > 0.2, "{technique}: only {share}");
    }
}

#[test]
fn what_cannot_be_drawn_is_an_error_that_says_so() {
    let Some(gpu) = gpu() else { return };
    let make = |scene: &Scene| {
        Renderer::new(&gpu.device, &gpu.queue, scene, PLAIN, &RendererOptions::default()).map(|_| ()).unwrap_err()
    };
    let mut looking_nowhere = scene(&[]);
    looking_nowhere.camera.target = looking_nowhere.camera.position;
    assert!(make(&looking_nowhere).to_string().contains("looks nowhere"));

    let mut bright = scene(&[]);
    bright.lights = vec![bright.lights[0]; 65];
    assert!(make(&bright).to_string().contains("65 lights"));

    let mut missing = scene(&[]);
    missing.objects[1].material = 7;
    assert!(make(&missing).to_string().contains("object 1 asks for material 7"));

    let side = gpu.device.limits().max_texture_dimension_2d;
    if side < Grid::<f32>::MAX_SIDE {
        let mut wide = scene(&[]);
        let map = relievo_map::ScalarMap::new(Grid::from_fn(side + 1, 1, |_, _| 0.5));
        wide.materials[0].maps.roughness = Some(map);
        let error = make(&wide);
        assert!(matches!(error, GpuError::TextureTooLarge { .. }) && error.to_string().contains("wall"), "{error}");
    }

    let scene = scene(&[]);
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &scene, PLAIN, &RendererOptions::default()).unwrap();
    let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 8, height: 8, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Bgra8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    assert!(renderer.draw(&Target::new(&view, [0, 8])).unwrap_err().to_string().contains("0×8"));
    // Another format than the renderer was made for.
    assert!(matches!(renderer.draw(&Target::new(&view, [8, 8])).unwrap_err(), GpuError::Device(_)));
}

#[test]
fn an_empty_scene_is_its_background_and_ten_thousand_objects_are_drawn() {
    let Some(gpu) = gpu() else { return };
    let mut scene = scene(&["materials.wall.relief.technique=none"]);
    let object = scene.objects[0].clone();
    scene.objects.clear();
    scene.image.background = [0.25, 0.5, 1.0];
    assert!(draw(gpu, &scene, PLAIN).texels().iter().all(|&p| p == [64, 128, 255]));
    scene.objects = (0..10_000)
        .map(|i| {
            let mut object = object.clone();
            object.transform.matrix3 *= 0.01;
            object.transform.translation = glam::Vec3A::new((i % 100) as f32, (i / 100) as f32, 0.0) * 0.02 - 1.0;
            object
        })
        .collect();
    let (difference, ..) = compared(gpu, &scene);
    assert!(same(&difference), "{difference:?}");
}

#[test]
fn moved_turned_and_mirrored_maps_look_alike() {
    let mut scenes = Vec::new();
    for technique in ["normal", "occlusion", "exact", "displacement"] {
        for (offset, rotate, scale) in
            [("[0.25,-3]", "90", "[1,1]"), ("[0,0.5]", "33", "[2,-0.5]"), ("[1,0]", "0", "[-1,1]")]
        {
            scenes.push(named(&[
                &format!("materials.wall.relief.technique={technique}"),
                &format!("materials.wall.uv_offset={offset}"),
                &format!("materials.wall.uv_rotate={rotate}"),
                &format!("materials.wall.uv_scale={scale}"),
            ]));
        }
    }
    for rect in ["[0,0,0.5,1]", "[0.25,0.3,2,0.9]"] {
        let edge = "materials.wall.relief.edge=clip";
        scenes.push(named(&[&format!("materials.wall.uv_rect={rect}"), "materials.wall.uv_scale=1.5", edge]));
    }
    all_same(scenes);
}

/// From behind, where one side would be none.
const BEHIND: [&str; 3] =
    ["camera.position=[0.7,-1.1,-2.2]", "lights.0.position=[1.5,1.6,-1.8]", "lights.1.direction=[0.7,-0.3,0.6]"];

/// A scene with these changes, seen from behind, with both sides.
fn from_behind(changes: &[&str]) -> (String, Scene) {
    named(&[changes, &["materials.wall.two_sided=true"], &BEHIND].concat())
}

#[test]
fn both_sides_of_a_relief_look_alike() {
    let mut scenes = Vec::new();
    for technique in TECHNIQUES {
        for (midlevel, edge, shadow) in [("1", "clip", "none"), ("0.4", "wrap", "soft"), ("0", "clamp", "hard")] {
            // Where another object hides displaced geometry from a light its shadow on itself is lost.
            let shadow = if technique == "displacement" { "none" } else { shadow };
            scenes.push(from_behind(&[
                &format!("materials.wall.relief.technique={technique}"),
                &format!("materials.wall.midlevel={midlevel}"),
                &format!("materials.wall.relief.edge={edge}"),
                &format!("materials.wall.relief.shadow={shadow}"),
            ]));
        }
    }
    scenes.push(from_behind(&["materials.wall.relief.lod=true", "image.width=320", "image.height=240"]));
    for mesh in ["quad", "torus"] {
        scenes.push(from_behind(&[
            &format!("objects.1.mesh={mesh}"),
            "objects.1.scale=0.4",
            "objects.1.rotate=[0,0,10]",
            "materials.wall.relief.shadow=exact",
            "image.width=320",
            "image.height=240",
        ]));
    }
    let (name, mut geometry) = from_behind(&[
        "materials.wall.relief.technique=displacement",
        "materials.wall.relief.shadow=hard",
        "materials.wall.height_scale=0.03",
        "image.width=640",
        "image.height=480",
    ]);
    geometry.objects.truncate(1);
    scenes.push((name, geometry));
    all_same(scenes);
}

#[test]
fn a_side_that_only_one_of_the_two_draws_is_caught() {
    let Some(gpu) = gpu() else { return };
    let sides = |two_sided: &str| scene(&[&[two_sided][..], &BEHIND].concat());
    let [one, two] = ["materials.wall.two_sided=false", "materials.wall.two_sided=true"].map(sides);
    let difference = pixel_difference(&on_cpu(&two).pixels, &draw(gpu, &one, PLAIN), PICTURE_THRESHOLD).unwrap();
    assert!(!same(&difference), "{difference:?}");
    // A renderer takes the sides over with the reliefs, but for heights that the caller may change.
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue, &one, PLAIN, &RendererOptions::default()).unwrap();
    let size = [one.image.width, one.image.height];
    renderer.set_reliefs(&two).unwrap();
    let expected = draw(gpu, &two, PLAIN);
    assert_eq!(draw_with(gpu, &mut renderer, size, PLAIN), expected);
    let mut flat = two.clone();
    flat.materials[0].relief.technique = relievo_scene::SurfaceTechnique::from_name("normal").unwrap();
    renderer.set_reliefs(&flat).unwrap();
    assert_eq!(draw_with(gpu, &mut renderer, size, PLAIN), draw(gpu, &flat, PLAIN));
    renderer.set_reliefs(&two).unwrap();
    assert_eq!(draw_with(gpu, &mut renderer, size, PLAIN), expected);
}
