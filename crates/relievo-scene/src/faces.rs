//! Repairing and completing triangles from files.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use crate::mesh::area_vector;

/// Whether a triangle has an area; the others are dropped, they have no normal. Indices must be in range.
pub(crate) fn has_area(positions: &[Vec3], triangle: [u32; 3]) -> bool {
    let length = area_vector(positions, triangle).length_squared();
    length > 0.0 && length.is_finite()
}

/// A normal per triangle corner: the triangle's own (flat shading). Triangles must have an area.
pub(crate) fn flat_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<[Vec3; 3]> {
    triangles.iter().map(|&triangle| [area_vector(positions, triangle).normalize_or_zero().as_vec3(); 3]).collect()
}

/// A normal per triangle corner: the mean of the triangles around that position, weighted by area, that meet this one at
/// less than 45°. Round things become smooth, edges stay sharp.
pub(crate) fn crease_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<[Vec3; 3]> {
    // Beyond this many around one position each gets the mean of all: the comparison is quadratic.
    const MOST_COMPARED: usize = 256;
    let cos_limit = 45f64.to_radians().cos();
    let areas: Vec<DVec3> = triangles.iter().map(|&triangle| area_vector(positions, triangle)).collect();
    // Vertices split along uv seams lie at the same position.
    let mut groups: HashMap<[u32; 3], Vec<u32>> = HashMap::new();
    let key = |vertex: u32| positions[vertex as usize].to_array().map(|x| (x + 0.0).to_bits());
    for (index, triangle) in triangles.iter().enumerate() {
        for &vertex in triangle {
            groups.entry(key(vertex)).or_default().push(index as u32);
        }
    }
    triangles
        .iter()
        .zip(&areas)
        .map(|(triangle, own)| {
            let unit = own.normalize_or_zero();
            triangle.map(|vertex| {
                let around = &groups[&key(vertex)];
                let all = around.len() > MOST_COMPARED;
                let near = around.iter().map(|&index| areas[index as usize]);
                let sum: DVec3 = near.filter(|area| all || area.dot(unit) > cos_limit * area.length()).sum();
                sum.try_normalize().unwrap_or(unit).as_vec3()
            })
        })
        .collect()
}
