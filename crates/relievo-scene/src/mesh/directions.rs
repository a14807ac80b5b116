//! Directions along which a relief rises.

use std::collections::HashMap;

use glam::Vec3;

use super::number_key::number_key;
use super::vertex::Vertex;
use crate::Offset;

/// Sets the directions of vertices with unit normals.
pub(super) fn set(vertices: &mut [Vertex], offset: Offset) {
    let mut known: HashMap<[u32; 3], Vec<Vec3>> = HashMap::new();
    let place = |vertex: &Vertex| number_key(vertex.position.to_array());
    if offset == Offset::Shared {
        for vertex in vertices.iter() {
            let normals = known.entry(place(vertex)).or_default();
            // Every direction once, however many triangles have it.
            if !normals.iter().any(|normal| normal.dot(vertex.normal) > 0.9999) {
                normals.push(vertex.normal);
            }
        }
    }
    for vertex in vertices {
        let shared = known.get(&place(vertex)).and_then(|normals| normals.iter().sum::<Vec3>().try_normalize());
        vertex.direction = shared.unwrap_or(vertex.normal);
    }
}
