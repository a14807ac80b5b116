use glam::{Vec2, Vec3, Vec4};
use relievo_scene::{Mesh, MeshError, SHAPE_NAMES};

/// A triangle's dP/du and dP/dv, by solving its two edges.
pub(crate) fn derivatives(mesh: &Mesh, [a, b, c]: [u32; 3]) -> Option<(Vec3, Vec3)> {
    let p = |i: u32| mesh.positions[i as usize];
    let uv = |i: u32| mesh.uvs[i as usize];
    let (e1, e2) = (p(b) - p(a), p(c) - p(a));
    let (d1, d2) = (uv(b) - uv(a), uv(c) - uv(a));
    let determinant = d1.x * d2.y - d2.x * d1.y;
    (determinant != 0.0).then(|| ((e1 * d2.y - e2 * d1.y) / determinant, (e2 * d1.x - e1 * d2.x) / determinant))
}

/// The share of corners whose tangent runs along +u and whose bitangent runs against v.
fn share_of_right_frames(mesh: &Mesh) -> f32 {
    let mut right = 0;
    for &triangle in &mesh.triangles {
        let Some((du, dv)) = derivatives(mesh, triangle) else { continue };
        for vertex in triangle {
            let (n, t) = (mesh.normals[vertex as usize], mesh.tangents[vertex as usize]);
            let bitangent = t.w * n.cross(t.truncate());
            right += usize::from(t.truncate().dot(du) > 0.0 && bitangent.dot(-dv) > 0.0);
        }
    }
    right as f32 / (3 * mesh.triangles.len()) as f32
}

fn face_normal(mesh: &Mesh, triangle: [u32; 3]) -> Vec3 {
    let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
    (b - a).cross(c - a)
}

fn mirrored(mut mesh: Mesh) -> Mesh {
    for uv in &mut mesh.uvs {
        uv.x = 1.0 - uv.x;
    }
    Mesh::with_tangents(mesh.positions, mesh.normals, mesh.uvs, mesh.triangles).unwrap()
}

#[test]
fn the_quad_faces_z_with_u_to_the_right_and_the_bitangent_up() {
    let quad = Mesh::quad();
    assert_eq!(quad.positions.len(), 4);
    for i in 0..4 {
        assert_eq!(quad.normals[i], Vec3::Z);
        assert_eq!(quad.tangents[i], Vec4::new(1.0, 0.0, 0.0, 1.0));
        assert_eq!(quad.tangents[i].w * quad.normals[i].cross(quad.tangents[i].truncate()), Vec3::Y);
        let Vec3 { x, y, z } = quad.positions[i];
        assert_eq!(quad.uvs[i], Vec2::new(0.5 + 0.5 * x, 0.5 - 0.5 * y));
        assert_eq!(z, 0.0);
    }
}

#[test]
fn the_plane_faces_y_with_its_first_corner_at_minus_x_minus_z() {
    let plane = Mesh::plane();
    for i in 0..4 {
        assert_eq!(plane.normals[i], Vec3::Y);
        assert_eq!(plane.tangents[i], Vec4::new(1.0, 0.0, 0.0, 1.0));
        let Vec3 { x, y, z } = plane.positions[i];
        assert_eq!(plane.uvs[i], Vec2::new(0.5 + 0.5 * x, 0.5 + 0.5 * z));
        assert_eq!(y, 0.0);
    }
}

#[test]
fn every_shape_is_sound_and_counter_clockwise_from_outside() {
    for name in SHAPE_NAMES {
        let mesh = Mesh::shape(name).unwrap();
        mesh.validate().unwrap();
        for &triangle in &mesh.triangles {
            let area = face_normal(&mesh, triangle);
            assert!(area.length() > 0.0, "{name}");
            for vertex in triangle {
                assert!(area.dot(mesh.normals[vertex as usize]) > 0.0, "{name}: {triangle:?}");
            }
        }
        assert!(mesh.uvs.iter().all(|uv| (0.0..=1.0).contains(&uv.x) && (0.0..=1.0).contains(&uv.y)), "{name}");
    }
    assert!(Mesh::shape("teapot").is_none());
}

#[test]
fn tangents_follow_u_and_bitangents_run_up_the_picture_on_every_shape_mirrored_or_not() {
    for name in SHAPE_NAMES {
        let mesh = Mesh::shape(name).unwrap();
        let share = share_of_right_frames(&mesh);
        assert!(share > 0.999, "{name}: {share}");
        assert!(mesh.tangents.iter().all(|t| t.w == 1.0), "{name} is not mirrored");
        let mesh = mirrored(mesh);
        let share = share_of_right_frames(&mesh);
        assert!(share > 0.999, "{name}, mirrored: {share}");
        // The poles' unused corner has no triangle to be mirrored by.
        let used = mesh.triangles.iter().flatten();
        assert!(used.copied().all(|i| mesh.tangents[i as usize].w == -1.0), "{name} is mirrored");
    }
}

#[test]
fn the_check_of_frames_notices_a_wrong_sign() {
    let mut quad = Mesh::quad();
    for tangent in &mut quad.tangents {
        tangent.w = -tangent.w;
    }
    assert_eq!(share_of_right_frames(&quad), 0.0);
}

#[test]
fn round_shapes_have_the_sizes_that_are_documented() {
    let radii = |mesh: &Mesh, f: fn(Vec3) -> f32| {
        mesh.positions.iter().map(|&p| f(p)).fold((f32::MAX, f32::MIN), |(lo, hi), r| (lo.min(r), hi.max(r)))
    };
    let close = |(lo, hi): (f32, f32), (a, b): (f32, f32)| (lo - a).abs() < 1e-5 && (hi - b).abs() < 1e-5;
    assert!(close(radii(&Mesh::sphere(), Vec3::length), (1.0, 1.0)));
    assert!(close(radii(&Mesh::cylinder(), |p| p.y), (-1.0, 1.0)));
    assert!(close(radii(&Mesh::cylinder(), |p| p.x.hypot(p.z)), (0.0, 1.0)));
    assert!(close(radii(&Mesh::torus(), |p| p.x.hypot(p.z)), (0.6, 1.4)));
    assert!(close(radii(&Mesh::torus(), |p| p.y), (-0.4, 0.4)));
    assert!(close(radii(&Mesh::cube(), |p| p.abs().max_element()), (1.0, 1.0)));
}

#[test]
fn seen_from_the_front_u_grows_to_the_right_and_v_downwards_on_round_shapes() {
    for name in ["sphere", "cylinder", "torus", "cube"] {
        let mesh = Mesh::shape(name).unwrap();
        let mut seen = 0;
        for &triangle in &mesh.triangles {
            // The far inside of the torus faces the front too, upside down.
            let in_front = mesh.positions[triangle[0] as usize].z > 0.0;
            if in_front && face_normal(&mesh, triangle).normalize().z > 0.95 {
                let (du, dv) = derivatives(&mesh, triangle).unwrap();
                assert!(du.x > 0.0 && dv.y < 0.0, "{name}");
                seen += 1;
            }
        }
        assert!(seen > 0, "{name}");
    }
}

#[test]
fn closed_shapes_have_no_holes() {
    for name in ["cube", "sphere", "cylinder", "torus"] {
        let mesh = Mesh::shape(name).unwrap();
        let key = |i: u32| mesh.positions[i as usize].to_array().map(|x| (x + 0.0).to_bits());
        let mut edges = std::collections::HashMap::new();
        for [a, b, c] in mesh.triangles.iter().copied() {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *edges.entry((key(from), key(to))).or_insert(0) += 1;
            }
        }
        for ((from, to), count) in &edges {
            assert_eq!((*count, edges.get(&(*to, *from))), (1, Some(&1)), "{name}");
        }
    }
}

#[test]
fn a_vertex_shared_by_mirrored_halves_is_split() {
    // Two squares side by side; u runs towards the shared edge in both.
    let positions: Vec<Vec3> =
        [(-1, 1), (0, 1), (1, 1), (-1, 0), (0, 0), (1, 0)].map(|(x, y)| Vec3::new(x as f32, y as f32, 0.0)).into();
    let uvs = [(0, 0), (1, 0), (0, 0), (0, 1), (1, 1), (0, 1)].map(|(u, v)| Vec2::new(u as f32, v as f32)).into();
    let triangles = vec![[0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2]];
    let mesh = Mesh::with_tangents(positions, vec![Vec3::Z; 6], uvs, triangles).unwrap();
    assert_eq!(mesh.positions.len(), 8);
    assert_eq!(share_of_right_frames(&mesh), 1.0);
    mesh.validate().unwrap();
}

#[test]
fn missing_normals_and_hopeless_texture_coordinates_are_repaired() {
    let quad = Mesh::quad();
    let vertices = quad.positions.len();
    let mesh = Mesh::with_tangents(
        quad.positions.clone(),
        vec![Vec3::ZERO; vertices],
        vec![Vec2::ZERO; vertices],
        quad.triangles.clone(),
    )
    .unwrap();
    mesh.validate().unwrap();
    assert!(mesh.normals.iter().all(|&n| n == Vec3::Z));
    // A triangle without area alone in the world.
    let mesh = Mesh::with_tangents(vec![Vec3::ONE; 3], vec![Vec3::X; 3], vec![Vec2::ZERO; 3], vec![[0, 1, 2]]).unwrap();
    mesh.validate().unwrap();
    let tangents = vec![Vec4::ZERO; vertices];
    let mesh = Mesh::from_parts(quad.positions, quad.normals, quad.uvs, tangents, quad.triangles).unwrap();
    mesh.validate().unwrap();
}

#[test]
fn broken_parts_are_refused_with_the_place() {
    let quad = Mesh::quad;
    let with = |change: fn(&mut Mesh)| {
        let mut mesh = quad();
        change(&mut mesh);
        Mesh::from_parts(mesh.positions, mesh.normals, mesh.uvs, mesh.tangents, mesh.triangles).unwrap_err()
    };
    assert_eq!(with(|m| m.triangles.clear()), MeshError::Empty);
    assert_eq!(with(|m| m.triangles[1][2] = 4), MeshError::Index { triangle: 1, index: 4, vertices: 4 });
    assert_eq!(with(|m| m.positions[2].y = f32::NAN), MeshError::Number { vertex: 2, list: "position" });
    assert_eq!(with(|m| m.uvs[3].x = f32::INFINITY), MeshError::Number { vertex: 3, list: "uv" });
    assert_eq!(with(|m| m.normals[0].x = f32::NAN), MeshError::Number { vertex: 0, list: "normal" });
    assert_eq!(with(|m| m.tangents[0].w = f32::NAN), MeshError::Number { vertex: 0, list: "tangent" });
    assert_eq!(with(|m| m.positions[1].z = 2e9), MeshError::Number { vertex: 1, list: "position" });
    let lengths = MeshError::Lengths { positions: 4, list: "normals", count: 3 };
    assert_eq!(with(|m| m.normals.truncate(3)), lengths);
}

#[test]
fn validate_finds_what_is_not_of_unit_length() {
    let with = |change: fn(&mut Mesh)| {
        let mut mesh = Mesh::quad();
        change(&mut mesh);
        mesh.validate()
    };
    assert_eq!(with(|_| {}), Ok(()));
    assert_eq!(with(|m| m.normals[1] *= 2.0), Err(MeshError::Unit { vertex: 1, list: "normal" }));
    assert_eq!(with(|m| m.tangents[2].w = 0.5), Err(MeshError::Unit { vertex: 2, list: "tangent" }));
}
