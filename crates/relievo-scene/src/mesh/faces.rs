//! Repairing and completing triangles from files.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::indexed_mesh::area_vector;
use super::number_key::number_key;

/// Returns true if a triangle has an area; the others are dropped, they have no normal. Indices must be in range.
pub(crate) fn has_area(positions: &[Vec3], triangle: [u32; 3]) -> bool {
    let length = area_vector(positions, triangle).length_squared();
    length > 0.0 && length.is_finite()
}

/// Returns a normal per triangle corner: the triangle's own (flat shading). Triangles must have an area.
pub(crate) fn flat_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<[Vec3; 3]> {
    triangles.iter().map(|&triangle| [area_vector(positions, triangle).normalize_or_zero().as_vec3(); 3]).collect()
}

/// Returns a normal per triangle corner: the mean of the triangles around that position that meet this one at less than 45°,
/// weighted by their angle there (Thürmer and Wüthrich 1998), independent of the triangulation of a polygon. Round
/// surfaces become smooth, edges stay sharp.
pub(crate) fn crease_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<[Vec3; 3]> {
    // Beyond this many around one position each gets the mean of all: the comparison is quadratic.
    const MOST_COMPARED: usize = 256;
    let cos_limit = 45f64.to_radians().cos();
    let units: Vec<DVec3> = triangles.iter().map(|&t| area_vector(positions, t).normalize_or_zero()).collect();
    // Vertices split along uv seams lie at the same position.
    let key = |vertex: u32| number_key(positions[vertex as usize].to_array());
    let mut around: HashMap<[u32; 3], Around> = HashMap::new();
    for (index, &triangle) in triangles.iter().enumerate() {
        for (vertex, angle) in triangle.into_iter().zip(angles(positions, triangle)) {
            let around = around.entry(key(vertex)).or_default();
            around.triangles.push((index as u32, angle));
            around.sum += units[index] * angle;
        }
    }
    triangles
        .iter()
        .zip(&units)
        .map(|(triangle, &own)| {
            triangle.map(|vertex| {
                let around = &around[&key(vertex)];
                let sum = if around.triangles.len() > MOST_COMPARED {
                    around.sum
                } else {
                    let near = around.triangles.iter().map(|&(index, angle)| (units[index as usize], angle));
                    near.filter(|(unit, _)| unit.dot(own) > cos_limit).map(|(unit, angle)| unit * angle).sum()
                };
                sum.try_normalize().unwrap_or(own).as_vec3()
            })
        })
        .collect()
}

/// The triangles around a position, with their angles there, and the sum of their normals.
#[derive(Default)]
struct Around {
    triangles: Vec<(u32, f64)>,
    sum: DVec3,
}

/// Returns the angles at a triangle's corners, radians.
fn angles(positions: &[Vec3], triangle: [u32; 3]) -> [f64; 3] {
    let p = triangle.map(|index| positions[index as usize].as_dvec3());
    [0, 1, 2].map(|i| (p[(i + 1) % 3] - p[i]).angle_between(p[(i + 2) % 3] - p[i]))
}
