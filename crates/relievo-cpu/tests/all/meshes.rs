//! Reliefs on curved and stretched meshes against displaced geometry: outlines, and hits in scene space.

use glam::{Affine3A, Vec2, Vec3};
use relievo_cpu::Frame;
use relievo_lab::{DEFAULT_PIXELS_PER_DEGREE, flip};
use relievo_map::{Grid, HeightMap, Limits, Wrap};
use relievo_march::{
    HeightField, MarchOptions, Prism, Ray, ReliefMap, ShellRay, Sides, SurfaceAxes, Technique, march, march_shell,
};
use relievo_scene::{
    Edge, HeightRange, Material, Mesh, Model, Offset, Relief, Scene, SurfaceMesh, SurfaceTechnique, Vertex,
};

use crate::common::{EXACT, add, draw, relief, shape, stage, sun};

const TEXELS: u32 = 24;

/// Smooth bumps, tiling; sharp ones would put the grid's own error in the place of the march's.
fn bumps() -> HeightMap {
    let wave = |x: u32, n: f32| ((x as f32 + 0.5) / TEXELS as f32 * n * std::f32::consts::TAU).sin();
    HeightMap::new(Grid::from_fn(TEXELS, TEXELS, |x, y| 0.5 + 0.25 * wave(x, 2.0) * wave(y, 3.0) + 0.25 * wave(y, 1.0)))
}

fn mesh(corners: &[(Vec3, Vec3, Vec2)], triangles: &[[u32; 3]]) -> Mesh {
    let list = |f: &dyn Fn(&(Vec3, Vec3, Vec2)) -> Vec3| corners.iter().map(f).collect();
    let uvs = corners.iter().map(|corner| corner.2).collect();
    Mesh::with_tangents(list(&|c| c.0), list(&|c| c.1.normalize()), uvs, triangles.to_vec()).unwrap()
}

/// A cube whose vertices share the normals of their positions.
fn smooth_cube() -> Mesh {
    let mut cube = shape("cube");
    cube.normals = cube.positions.iter().map(|p| p.normalize()).collect();
    Mesh::with_tangents(cube.positions, cube.normals, cube.uvs, cube.triangles).unwrap()
}

/// A lattice over uv, from a function that gives position and normal.
fn lattice(columns: u32, rows: u32, f: impl Fn(Vec2) -> (Vec3, Vec3)) -> Mesh {
    let at = |i: u32, j: u32| {
        let uv = Vec2::new(i as f32 / columns as f32, j as f32 / rows as f32);
        let (position, normal) = f(uv);
        (position, normal, uv)
    };
    let corners: Vec<_> = (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j))).map(|(i, j)| at(i, j)).collect();
    let index = |i: u32, j: u32| j * (columns + 1) + i;
    let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
    let triangles: Vec<_> = cells
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)];
            [[a, c, b], [b, c, d]]
        })
        .collect();
    mesh(&corners, &triangles)
}

fn sin_cos_of(u: f32) -> (f32, f32) {
    (u * std::f32::consts::TAU).sin_cos()
}

fn low_sphere() -> Mesh {
    lattice(16, 8, |uv| {
        let ((s, c), (sin, cos)) = (sin_cos_of(uv.x), (uv.y * 0.9 * std::f32::consts::PI + 0.15).sin_cos());
        let n = Vec3::new(sin * s, cos, sin * c);
        (n, n)
    })
}

fn low_cylinder() -> Mesh {
    lattice(12, 1, |uv| {
        let (s, c) = sin_cos_of(uv.x);
        (Vec3::new(s, 1.0 - 2.0 * uv.y, c), Vec3::new(s, 0.0, c))
    })
}

fn low_torus() -> Mesh {
    lattice(20, 10, |uv| {
        let ((s, c), (sin, cos)) = (sin_cos_of(uv.x), sin_cos_of(-uv.y));
        let n = Vec3::new(cos * s, sin, cos * c);
        (Vec3::new(s, 0.0, c) + 0.4 * n, n)
    })
}

fn arch() -> Mesh {
    lattice(8, 2, |uv| {
        let (sin, cos) = (uv.x * std::f32::consts::PI).sin_cos();
        let n = Vec3::new(-cos, sin, 0.0);
        (n + Vec3::new(0.0, -0.5, 1.2 * uv.y - 0.6), n)
    })
}

fn terrain(cells: u32) -> Mesh {
    let height = |x: f32, z: f32| 0.25 * (2.3 * x).sin() * (1.9 * z).cos();
    lattice(cells, cells, |uv| {
        let (x, z) = (3.0 * uv.x - 1.5, 3.0 * uv.y - 1.5);
        let slope = |d: Vec2| (height(x + d.x, z + d.y) - height(x - d.x, z - d.y)) / 2e-3;
        let n = Vec3::new(-slope(Vec2::new(1e-3, 0.0)), 1.0, -slope(Vec2::new(0.0, 1e-3)));
        (Vec3::new(x, height(x, z), z), n)
    })
}

/// A flat wall whose texture is twice as dense on its right half.
fn density_wall() -> Mesh {
    let corner = |x: f32, y: f32, u: f32| (Vec3::new(x, y, 0.0), Vec3::Z, Vec2::new(u, 0.5 - 0.5 * y));
    let corners = [
        corner(-1.0, -1.0, 0.0),
        corner(0.0, -1.0, 0.5),
        corner(1.0, -1.0, 1.5),
        corner(-1.0, 1.0, 0.0),
        corner(0.0, 1.0, 0.5),
        corner(1.0, 1.0, 1.5),
    ];
    mesh(&corners, &[[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4]])
}

/// A cube with rounded edges: every face in 6 × 6 squares, those at its border bent round a quarter circle.
fn rounded_cube() -> Mesh {
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    let stops = [-1.0f32, -0.88, -0.6, 0.0, 0.6, 0.88, 1.0];
    for axis in 0..3 {
        for side in [-1.0f32, 1.0] {
            let first = corners.len() as u32;
            for (j, &b) in stops.iter().enumerate() {
                for (i, &a) in stops.iter().enumerate() {
                    let mut p = [0.0; 3];
                    (p[axis], p[(axis + 1) % 3], p[(axis + 2) % 3]) = (side, a * side, b);
                    let p = Vec3::from(p);
                    let inner = p.clamp(Vec3::splat(-0.6), Vec3::splat(0.6));
                    let n = (p - inner).normalize();
                    corners.push((inner + 0.4 * n, n, Vec2::new(0.5 + 0.5 * a, 0.5 - 0.5 * b)));
                    if i < 6 && j < 6 {
                        let [a, b] = [first + (j * 7 + i) as u32, first + ((j + 1) * 7 + i) as u32];
                        triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
                    }
                }
            }
        }
    }
    mesh(&corners, &triangles)
}

/// A mesh and its transform.
type PlacedMesh = (Mesh, Affine3A);

/// A part of a glTF file: a mesh, and the nodes that draw it by their scales.
type GltfPart<'a> = (&'a Mesh, &'a [[f32; 3]]);

/// The meshes of a binary glTF file that is written and read back, each with its transform.
fn through_gltf(parts: &[GltfPart<'_>]) -> Vec<PlacedMesh> {
    let (mut bin, mut views, mut accessors) = (Vec::<u8>::new(), Vec::new(), Vec::new());
    let mut accessor = |bytes: Vec<u8>, component: u32, kind: &str, count: usize| {
        let (offset, length) = (bin.len(), bytes.len());
        bin.extend(bytes);
        views.push(format!(r#"{{"buffer":0,"byteOffset":{offset},"byteLength":{length}}}"#));
        let view = views.len() - 1;
        accessors
            .push(format!(r#"{{"bufferView":{view},"componentType":{component},"count":{count},"type":"{kind}"}}"#));
        accessors.len() - 1
    };
    let floats = |values: &[Vec3]| values.iter().flat_map(Vec3::to_array).flat_map(f32::to_le_bytes).collect();
    let (mut meshes, mut nodes) = (Vec::new(), Vec::new());
    for (number, (mesh, scales)) in parts.iter().enumerate() {
        let n = mesh.positions.len();
        let positions = accessor(floats(&mesh.positions), 5126, "VEC3", n);
        let normals = accessor(floats(&mesh.normals), 5126, "VEC3", n);
        let uvs = mesh.uvs.iter().flat_map(Vec2::to_array).flat_map(f32::to_le_bytes).collect();
        let uvs = accessor(uvs, 5126, "VEC2", n);
        let indices = mesh.triangles.iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
        let indices = accessor(indices, 5125, "SCALAR", 3 * mesh.triangles.len());
        meshes.push(format!(
            r#"{{"primitives":[{{"attributes":{{"POSITION":{positions},"NORMAL":{normals},"TEXCOORD_0":{uvs}}},
            "indices":{indices}}}]}}"#
        ));
        nodes.extend(scales.iter().map(|scale| format!(r#"{{"mesh":{number},"scale":{scale:?}}}"#)));
    }
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{},"uri":"m.bin"}}],"bufferViews":[{}],"accessors":[{}],
        "meshes":[{}],"nodes":[{}],"scenes":[{{"nodes":{:?}}}],"scene":0}}"#,
        bin.len(),
        views.join(","),
        accessors.join(","),
        meshes.join(","),
        nodes.join(","),
        (0..nodes.len()).collect::<Vec<_>>(),
    );
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.bin"), bin).unwrap();
    std::fs::write(folder.path().join("m.gltf"), json).unwrap();
    let model = Model::load(&folder.path().join("m.gltf"), &Limits::default(), false).unwrap();
    model.parts.into_iter().map(|part| ((*part.mesh).clone(), part.transform)).collect()
}

/// A cylinder whose texture is cut into three parts that lie turned in the texture, so that heights jump at its seams.
fn seamed() -> Vec<PlacedMesh> {
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for part in 0..3 {
        let first = corners.len() as u32;
        for i in 0..=4 {
            let (s, c) = sin_cos_of((part * 4 + i) as f32 / 12.0);
            for j in 0..=2 {
                let (u, v) = (i as f32 / 4.0, j as f32 / 2.0);
                let uv = [Vec2::new(u, v), Vec2::new(v, 1.0 - u), Vec2::new(1.0 - u, 1.0 - v)][part];
                corners.push((Vec3::new(s, 1.0 - 2.0 * v, c), Vec3::new(s, 0.0, c), uv));
                if i < 4 && j < 2 {
                    let a = first + (i * 3 + j) as u32;
                    triangles.extend([[a, a + 1, a + 3], [a + 1, a + 4, a + 3]]);
                }
            }
        }
    }
    through_gltf(&[(&mesh(&corners, &triangles), &[[1.0; 3]])])
}

/// Half a ball, drawn a second time by a node that mirrors it.
fn mirrored() -> Vec<PlacedMesh> {
    let half = lattice(8, 8, |uv| {
        let ((s, c), (sin, cos)) = (sin_cos_of(0.5 * uv.x), (uv.y * 0.9 * std::f32::consts::PI + 0.15).sin_cos());
        let n = Vec3::new(sin * s, cos, sin * c);
        (n, n)
    });
    through_gltf(&[(&half, &[[1.0; 3], [-1.0, 1.0, 1.0]])])
}

fn scene(mesh: Mesh, midlevel: f32, eye: Vec3) -> Scene {
    scene_of(vec![(mesh, Affine3A::IDENTITY)], midlevel, eye)
}

fn scene_of(parts: Vec<PlacedMesh>, midlevel: f32, eye: Vec3) -> Scene {
    let mut scene = stage(150, 120, eye);
    scene.camera.vertical_fov = 45.0;
    scene.lights.push(sun(-0.4, -0.7, -0.6));
    let material = Material { height: HeightRange::Depth(0.12), midlevel, ..relief(bumps(), 0.1) };
    for (mesh, transform) in parts {
        add(&mut scene, mesh, material.clone(), transform);
    }
    scene
}

fn with(scene: &Scene, change: impl Fn(&mut Relief)) -> Frame {
    let mut scene = scene.clone();
    scene.materials.iter_mut().for_each(|material| change(&mut material.relief));
    draw(&scene)
}

/// Overlap of two outlines, and the distances of the hits of both along their rays, in scene units: the 99th percentile.
fn judge(a: &Frame, b: &Frame) -> (f32, f32) {
    let (mut both, mut either, mut distances) = (0u32, 0u32, Vec::new());
    for (&a, &b) in a.aovs.depth.texels().iter().zip(b.aovs.depth.texels()) {
        either += u32::from(a.is_finite() || b.is_finite());
        if a.is_finite() && b.is_finite() {
            both += 1;
            distances.push((a - b).abs());
        }
    }
    distances.sort_by(f32::total_cmp);
    assert!(both > 1000, "{both} pixels");
    (both as f32 / either as f32, distances[distances.len() * 99 / 100])
}

/// Mean FLIP of two pictures.
fn flip_of(a: &Frame, b: &Frame) -> f64 {
    flip(&a.pixels, &b.pixels, DEFAULT_PIXELS_PER_DEGREE).unwrap().mean
}

#[test]
fn shells_show_what_displaced_geometry_shows() {
    let eye = Vec3::new(1.6, 1.3, 2.8);
    let alone = |mesh: Mesh| vec![(mesh, Affine3A::IDENTITY)];
    let meshes: [(&str, Vec<PlacedMesh>, Vec3); 12] = [
        ("cube with shared normals", alone(smooth_cube()), 1.4 * eye),
        ("rounded cube", alone(rounded_cube()), 1.4 * eye),
        ("sphere of 16 × 8", alone(low_sphere()), eye),
        ("cylinder of 12 sides", alone(low_cylinder()), eye),
        ("torus of 20 × 10", alone(low_torus()), eye),
        ("arch", alone(arch()), eye),
        ("terrain of 8 × 8", alone(terrain(8)), eye),
        ("terrain of 32 × 32", alone(terrain(32)), eye),
        ("wall with two densities", alone(density_wall()), eye),
        ("wall with two densities, from aside", alone(density_wall()), Vec3::new(2.6, 0.2, 0.9)),
        ("seamed glTF", seamed(), eye),
        ("mirrored glTF", mirrored(), Vec3::new(0.4, 1.3, 3.0)),
    ];
    let (mut frame_alone, mut outlines, mut pictures) = (0, 0, 0);
    for (name, parts, eye) in meshes {
        for midlevel in [1.0, 0.3] {
            let scene = scene_of(parts.clone(), midlevel, eye);
            let truth = with(&scene, |relief| {
                relief.technique = SurfaceTechnique::Displacement;
                relief.grid = 8 * TEXELS;
            });
            let shell = with(&scene, |relief| (relief.technique, relief.edge) = (EXACT, Edge::Silhouette));
            let ((overlap, distance), differ) = (judge(&shell, &truth), flip_of(&shell, &truth));
            // A texel is 1/24 of a repeat, which is 2 units long on the cubes and 0.8 and more elsewhere.
            let texel = 0.8 / TEXELS as f32;
            eprintln!(
                "{name}, midlevel {midlevel}: outlines {overlap:.4}, hits {:.4} texels, FLIP {differ:.4}",
                distance / texel
            );
            assert!(overlap >= 0.995, "{name}, midlevel {midlevel}: outlines {overlap}");
            assert!(distance <= 0.1 * texel, "{name}, midlevel {midlevel}: hits {distance}");
            assert!(differ <= 0.02, "{name}, midlevel {midlevel}: FLIP {differ}");
            // Negative control: along the tangent instead of the curve, in the plane of each polygon, neither the outline nor the
            // hits nor the picture are right.
            let plane = with(&scene, |relief| (relief.technique, relief.edge) = (EXACT, Edge::Wrap));
            let (overlap, distance) = judge(&plane, &truth);
            frame_alone += u32::from(distance > 0.1 * texel);
            outlines += u32::from(overlap < 0.995);
            pictures += u32::from(flip_of(&plane, &truth) > 0.02);
        }
    }
    eprintln!("tangents: {frame_alone} wrong by hits, {outlines} by outlines, {pictures} by pictures, of 24");
    assert!(frame_alone >= 16 && outlines >= 16 && pictures >= 12, "{frame_alone}, {outlines}, {pictures} of 24");
}

/// The depths that a march over the triangles of a scene's first object gives, as pictures of its camera.
fn depths(scene: &Scene, mut hit: impl FnMut(&SurfaceMesh, Vec3, Vec3) -> Option<f32>) -> Grid<f32> {
    let mesh = SurfaceMesh::in_scene_space(&scene.objects[0], &scene.materials[0]);
    let (eye, camera) = (scene.camera.position, &scene.camera);
    let forward = (camera.target - eye).normalize();
    let right = forward.cross(camera.up).normalize();
    let up = right.cross(forward);
    let (width, height) = (scene.image.width, scene.image.height);
    let scale = (0.5 * camera.vertical_fov.to_radians()).tan() / (0.5 * height as f32);
    Grid::from_fn(width, height, |x, y| {
        let (a, b) = (x as f32 + 0.5 - 0.5 * width as f32, 0.5 * height as f32 - y as f32 - 0.5);
        let direction = (forward + (right * a + up * b) * scale).normalize();
        hit(&mesh, eye, direction).map_or(f32::INFINITY, |t| t * direction.dot(forward))
    })
}

fn nearest(found: impl Iterator<Item = f32>) -> Option<f32> {
    found.reduce(f32::min)
}

/// The distance at which a ray meets a triangle, and the weights of its corners there.
fn meet([a, b, c]: [Vec3; 3], origin: Vec3, direction: Vec3) -> Option<(f32, [f32; 3])> {
    let n = (b - a).cross(c - a);
    let t = (a - origin).dot(n) / direction.dot(n);
    let p = origin + direction * t;
    let w = [(b, c), (c, a), (a, b)].map(|(q, r)| (q - p).cross(r - p).dot(n) / n.length_squared());
    (t > 0.0 && w.iter().all(|&w| w >= 0.0)).then_some((t, w))
}

#[test]
fn averaged_frames_and_shells_without_walls_are_seen_to_be_wrong() {
    let scene = scene(smooth_cube(), 0.3, 1.4 * Vec3::new(1.6, 1.3, 2.8));
    let truth = with(&scene, |relief| {
        relief.technique = SurfaceTechnique::Displacement;
        relief.grid = 8 * TEXELS;
    });
    let judged = |depth: Grid<f32>| {
        let mut frame = truth.clone();
        frame.aovs.depth = depth;
        let (overlap, distance) = judge(&frame, &truth);
        (overlap, distance / (0.8 / TEXELS as f32))
    };
    let heights = ReliefMap::new(&bumps());
    let field = heights.field(0.0, Wrap::Repeat);
    let corners = |mesh: &SurfaceMesh, triangle: [u32; 3]| triangle.map(|i| mesh.vertices[i as usize]);
    let by_shells = |with_walls: bool| {
        depths(&scene, |mesh, origin, direction| {
            let ray = ShellRay { origin: origin.into(), direction: direction.into() };
            nearest(mesh.triangles.iter().filter_map(|&triangle| {
                let prism = Prism::new(corners(mesh, triangle).map(|corner| corner.as_corner()), 0.12, 0.3);
                let [.., a, b, c] = prism.hull(field.range()).map(Vec3::from);
                let through_lid = meet([a, b, c], origin, direction).is_some();
                let hit = march_shell(&field, &prism, &ray, [0.0, f32::INFINITY], Sides::Above).0;
                hit.filter(|_| with_walls || through_lid).map(|hit| hit.t)
            }))
        })
    };
    let (overlap, distance) = judged(by_shells(true));
    assert!(overlap >= 0.995 && distance <= 0.1, "with all of its walls: {overlap}, {distance}");
    let (overlap, distance) = judged(by_shells(false));
    eprintln!("walls left out: outlines {overlap:.4}, hits {distance:.3} texels");
    assert!(overlap < 0.995, "walls left out: {overlap}");
    // As engines do it: the vertices' tangent frames, interpolated.
    let options = MarchOptions { technique: Technique::Exact, midlevel: 0.3, ..MarchOptions::default() };
    let averaged = depths(&scene, |mesh, origin, direction| {
        nearest(mesh.triangles.iter().filter_map(|&triangle| {
            let corners = corners(mesh, triangle);
            let (t, weights) = meet(corners.map(|corner| corner.position), origin, direction)?;
            let vertex = Vertex::interpolate(corners.each_ref(), weights);
            let (n, tangent) = (vertex.normal.normalize(), vertex.tangent.truncate().normalize());
            let bitangent = n.cross(tangent) * vertex.tangent.w;
            let axes =
                SurfaceAxes { dp_du: (2.0 * tangent).into(), dp_dv: (-2.0 * bitangent).into(), normal: n.into() };
            let ray = Ray::from_surface(vertex.uv.into(), (-direction).into(), &axes, 0.12);
            let record = march(&field, &ray, &options);
            record.hit.then_some(t + (record.depth - 0.7) * 0.12 / ray.cos)
        }))
    });
    let (overlap, distance) = judged(averaged);
    eprintln!("averaged frame: outlines {overlap:.4}, hits {distance:.3} texels");
    assert!(overlap < 0.995 && distance > 1.0, "averaged frame: {overlap}, {distance}");
}

#[test]
fn in_its_own_frame_a_face_is_nearly_right_and_never_flat() {
    // The march in the plane of the polygon: off by over a texel in a few hits only, where averaged axes were off in a fifth.
    let scene = scene(smooth_cube(), 1.0, Vec3::new(2.6, 2.0, 4.6));
    let truth = with(&scene, |relief| {
        relief.technique = SurfaceTechnique::Displacement;
        relief.grid = 8 * TEXELS;
    });
    let plane = with(&scene, |relief| (relief.technique, relief.edge) = (EXACT, Edge::Wrap));
    let (mut off, mut both, mut flat) = (0, 0, 0);
    for (i, (&a, &b)) in plane.aovs.uv.texels().iter().zip(truth.aovs.uv.texels()).enumerate() {
        let [a_depth, b_depth] = [&plane, &truth].map(|frame| frame.aovs.depth.texels()[i]);
        if a_depth.is_finite() && b_depth.is_finite() {
            both += 1;
            // Beside a face's border the map goes on in both.
            let texels = |k: usize| (a[k] - b[k] - (a[k] - b[k]).round()) * TEXELS as f32;
            off += u32::from(texels(0).hypot(texels(1)) > 1.0);
            flat += u32::from(plane.aovs.fetches.texels()[i] == 0.0);
        }
    }
    eprintln!("{off} of {both} hits are off by over a texel");
    assert!(off * 100 <= both * 3 && flat == 0, "{off} of {both}, {flat} flat");
}

#[test]
fn an_eye_below_the_lid_sees_the_relief_before_it() {
    // A valley along y: walls rise 0.4 above the polygon, the eye is between them.
    let valley = HeightMap::new(Grid::from_fn(64, 64, |x, _| {
        let side = ((x as f32 + 0.5) / 64.0 - 0.5).abs();
        if side < 0.2 { 0.0 } else { ((side - 0.2) * 8.0).min(1.0) }
    }));
    for (height, technique) in [(0.1, "exact"), (0.3, "exact"), (0.1, "cone")] {
        let mut scene = stage(120, 90, Vec3::new(0.02, -0.9, height));
        (scene.camera.target, scene.camera.up) = (Vec3::new(0.1, 0.3, -0.1), Vec3::Z);
        let material = Material { height: HeightRange::Depth(0.4), midlevel: 0.0, ..relief(valley.clone(), 0.1) };
        add(&mut scene, shape("quad"), material, Affine3A::IDENTITY);
        let technique = SurfaceTechnique::from_name(technique).unwrap();
        let marched = with(&scene, |relief| relief.technique = technique);
        let truth = with(&scene, |relief| {
            relief.technique = SurfaceTechnique::Displacement;
            relief.grid = 600;
        });
        let flat = with(&scene, |relief| relief.technique = SurfaceTechnique::from_name("normal").unwrap());
        let (mut holes, mut off, mut both) = (0, 0, 0);
        for (i, &depth) in marched.aovs.depth.texels().iter().enumerate() {
            // Every ray to the polygon meets the relief, at the latest there.
            if flat.aovs.depth.texels()[i].is_finite() {
                holes += u32::from(!depth.is_finite());
                both += 1;
                off += u32::from((depth - truth.aovs.depth.texels()[i]).abs() > 0.03);
            }
        }
        assert!(both > 4000 && holes == 0, "{technique:?} at {height}: {holes} holes of {both}");
        assert!(off * 200 <= both, "{technique:?} at {height}: {off} of {both} are not where displaced geometry is");
    }
}

#[test]
fn a_clipped_relief_ends_where_the_mesh_does_whatever_its_uvs() {
    let wall = |low: f32, high: f32| {
        let corner = |x: f32, y: f32| {
            let uv = Vec2::new(x, -y) * (0.5 * (high - low)) + Vec2::splat(0.5 * (high + low));
            (Vec3::new(x, y, 0.0), Vec3::Z, uv)
        };
        mesh(&[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)], &[[0, 1, 2], [0, 2, 3]])
    };
    let eye = Vec3::new(-0.9, -1.4, 0.8);
    for (low, high) in [(0.0, 3.0), (-1.0, 0.0), (0.25, 0.75)] {
        let scene = scene(wall(low, high), 1.0, eye);
        let clipped = with(&scene, |relief| (relief.technique, relief.edge) = (EXACT, Edge::Clip));
        let whole = with(&scene, |relief| (relief.technique, relief.edge) = (EXACT, Edge::Wrap));
        let (mut gone, mut kept) = (0, 0);
        for (i, &depth) in clipped.aovs.depth.texels().iter().enumerate() {
            let [u, v] = whole.aovs.uv.texels()[i];
            let inside = |x: f32| x >= low && x <= high;
            if whole.aovs.depth.texels()[i].is_finite() && inside(u) && inside(v) {
                kept += 1;
                assert_eq!((depth, clipped.aovs.uv.texels()[i]), (whole.aovs.depth.texels()[i], [u, v]));
            } else {
                gone += u32::from(whole.aovs.depth.texels()[i].is_finite());
                assert!(depth.is_infinite(), "{low} to {high}: seen beyond the border at {u}, {v}");
            }
        }
        assert!(kept > 2000 && gone > 50, "{low} to {high}: {kept} kept, {gone} gone");
    }
}

#[test]
fn far_texture_coordinates_show_what_near_ones_show() {
    let wall = |offset: f32| {
        let corner = |x: f32, y: f32| (Vec3::new(x, y, 0.0), Vec3::Z, Vec2::new(offset + x * 0.5, offset - y * 0.5));
        mesh(&[corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)], &[[0, 1, 2], [0, 2, 3]])
    };
    let eye = Vec3::new(-0.3, -0.9, 0.6);
    let near = with(&scene(wall(1.0), 1.0, eye), |relief| relief.technique = EXACT);
    for offset in [1000.0, -10_000.0, 1e6] {
        let far = with(&scene(wall(offset), 1.0, eye), |relief| relief.technique = EXACT);
        assert_eq!(far.aovs.depth, near.aovs.depth, "{offset} repeats away");
        assert_eq!(far.pixels, near.pixels, "{offset} repeats away");
    }
    // One polygon under a thousand repeats is as right in its far corner as a small one there.
    let mut many = scene(wall(0.5), 1.0, Vec3::new(999.3, -999.9, 0.6));
    many.camera.target = Vec3::new(999.6, -999.4, 0.0);
    many.objects[0].transform = Affine3A::from_scale(Vec3::new(1000.0, 1000.0, 1.0));
    many.objects[0].uv_repeat = Vec2::splat(1000.0);
    let mut few = many.clone();
    let part = |x: f32, y: f32| (Vec3::new(x, y, 0.0), Vec3::Z, Vec2::new(0.5 * x - 498.0, -0.5 * y - 498.0));
    few.objects[0].mesh = mesh(
        &[part(990.0, -1000.0), part(1000.0, -1000.0), part(1000.0, -990.0), part(990.0, -990.0)],
        &[[0, 1, 2], [0, 2, 3]],
    )
    .into();
    (few.objects[0].transform, few.objects[0].uv_repeat) = (Affine3A::IDENTITY, Vec2::ONE);
    let [many, few] = [many, few].map(|scene| with(&scene, |relief| relief.technique = EXACT));
    let mut off = 0;
    let mut both = 0;
    for (a, b) in many.aovs.depth.texels().iter().zip(few.aovs.depth.texels()) {
        if a.is_finite() && b.is_finite() {
            both += 1;
            off += u32::from((a - b).abs() > 0.01);
        }
    }
    assert!(both > 3000 && off * 100 <= both, "{off} of {both}");
}

#[test]
fn shared_directions_close_the_gaps_of_hard_edges() {
    let scene = scene(shape("cube"), 0.0, Vec3::new(2.6, 2.0, 4.6));
    let covered = |frame: &Frame| frame.aovs.depth.texels().iter().filter(|depth| depth.is_finite()).count();
    let drawn = |technique: SurfaceTechnique, offset: Offset| {
        with(&scene, |relief| {
            (relief.technique, relief.offset) = (technique, offset);
            (relief.edge, relief.grid) = (Edge::Silhouette, 8 * TEXELS);
        })
    };
    for offset in Offset::ALL {
        let [shell, truth] = [EXACT, SurfaceTechnique::Displacement].map(|technique| drawn(technique, offset));
        let (overlap, distance) = judge(&shell, &truth);
        assert!(overlap >= 0.995 && distance < 0.003, "{offset:?}: outlines {overlap}, hits {distance}");
    }
    // Faces that rise along their own normals part at the edges; along shared ones they meet.
    let [own, shared] = Offset::ALL.map(|offset| drawn(EXACT, offset));
    let (own, shared) = (covered(&own), covered(&shared));
    assert!(shared > own + 50, "{own} pixels, {shared} with shared directions");
}
