//! The price of silhouettes: `edge = "silhouette"` against the march in the polygons' planes of the same mesh.

use std::path::Path;
use std::time::Instant;

use glam::{Vec2, Vec3};
use relievo_cpu::RenderOptions;
use relievo_gpu::{Gpu, Offscreen, Renderer, RendererOptions};
use relievo_scene::{Edge, LoadOptions, Mesh, Scene};

use crate::stage::{Result, SIZE, milliseconds, summed_up};

/// A material on a mesh, without shadows.
const SCENE: &str = r#"
    [camera]
    position = [2.0, 1.6, 3.4]
    target = [0.0, 0.0, 0.0]
    vertical_fov = 36
    [[lights]]
    kind = "directional"
    direction = [-0.5, -0.8, -0.6]
    [materials.m]
    from = "make:brick-wall"
    height_scale = 0.05
    midlevel = 0.5
    [[objects]]
    mesh = "cube"
    material = "m"
"#;

/// Meshes, and what they change in the scene.
const MESHES: [(&str, &[&str]); 5] = [
    ("cube with shared normals", &["objects.0.mesh=brick-cube.obj"]),
    ("sphere", &["objects.0.mesh=sphere", "objects.0.uv_repeat=[4, 2]"]),
    ("torus", &["objects.0.mesh=torus", "objects.0.uv_repeat=[4, 2]"]),
    ("terrain of 8²", &["camera.position=[1.0, 1.5, 3.2]"]),
    ("terrain of 32²", &["camera.position=[1.0, 1.5, 3.2]"]),
];

/// Texels of the map along u and v.
const TEXELS: u32 = 1024;

fn scene(changes: &[&str]) -> Result<Scene> {
    let mut overrides = Vec::new();
    for change in changes {
        overrides.push(change.parse()?);
    }
    let options = LoadOptions { make_size: TEXELS, overrides, ..LoadOptions::default() };
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    Ok(Scene::parse(SCENE, "shells", &folder, &options)?)
}

/// A square of 3 units over smooth hills.
fn terrain(cells: u32) -> Result<Mesh> {
    let (mut positions, mut normals, mut uvs, mut triangles) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (j, i) in (0..=cells).flat_map(|j| (0..=cells).map(move |i| (j, i))) {
        let uv = Vec2::new(i as f32, j as f32) / cells as f32;
        let [x, z] = (uv * 3.0 - 1.5).to_array();
        positions.push(Vec3::new(x, 0.25 * (2.3 * x).sin() * (1.9 * z).cos(), z));
        let slope = [0.575 * (2.3 * x).cos() * (1.9 * z).cos(), -0.475 * (2.3 * x).sin() * (1.9 * z).sin()];
        normals.push(Vec3::new(-slope[0], 1.0, -slope[1]).normalize());
        uvs.push(uv);
        if i < cells && j < cells {
            let a = j * (cells + 1) + i;
            triangles.extend([[a, a + cells + 1, a + 1], [a + 1, a + cells + 1, a + cells + 2]]);
        }
    }
    Ok(Mesh::with_tangents(positions, normals, uvs, triangles)?)
}

/// The mesh with either edge.
fn pair(name: &str, changes: &[&str]) -> Result<[Scene; 2]> {
    let mut scene = scene(changes)?;
    if let Some(cells) = name.strip_prefix("terrain of ").and_then(|rest| rest.trim_end_matches('²').parse().ok()) {
        scene.objects[0].mesh = terrain(cells)?.into();
    }
    [scene.image.width, scene.image.height] = SIZE;
    let with = |edge: Edge| {
        let mut scene = scene.clone();
        scene.materials[0].relief.edge = edge;
        scene
    };
    Ok([with(Edge::Wrap), with(Edge::Silhouette)])
}

pub(crate) fn report(gpu: &Gpu, rounds: usize) -> Result<()> {
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let target = Offscreen::new(&gpu.device, &gpu.queue, SIZE, format)?;
    println!("`exact` in the planes of the polygons and in shells, a map of {TEXELS}² texels:\n");
    println!("| | plane | shells | ratio | on the CPU: plane | shells | ratio |\n|---|---|---|---|---|---|---|");
    for (name, changes) in MESHES {
        let scenes = pair(name, changes)?;
        let mut on_gpu = Vec::new();
        let mut on_cpu = Vec::new();
        for scene in &scenes {
            on_gpu.push(Renderer::new(&gpu.device, &gpu.queue, scene, format, &RendererOptions::default())?);
            on_cpu.push(relievo_cpu::Renderer::new(scene)?);
        }
        let (mut frames, mut pictures) = (Vec::new(), Vec::new());
        for round in 0..=rounds {
            let frame = on_gpu.iter_mut().map(|renderer| target.time(renderer).map(milliseconds));
            let frame = frame.collect::<std::result::Result<Vec<_>, _>>()?;
            let mut picture = Vec::new();
            for renderer in &on_cpu {
                let start = Instant::now();
                renderer.render(&RenderOptions::default())?;
                picture.push(start.elapsed().as_secs_f64() * 1e3);
            }
            if round > 0 {
                frames.push(frame);
                pictures.push(picture);
            }
        }
        let [(plane, _), (shells, ratio)] = summed_up(&frames, 0)[..] else { continue };
        let [(cpu_plane, _), (cpu_shells, cpu_ratio)] = summed_up(&pictures, 0)[..] else { continue };
        println!(
            "| {name} | {plane:.1} ms | {shells:.1} ms | ×{ratio:.2} | {cpu_plane:.1} ms | {cpu_shells:.1} ms | ×{cpu_ratio:.2} |"
        );
    }
    println!();
    Ok(())
}
