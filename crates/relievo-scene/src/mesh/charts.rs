//! Charts: the parts of a mesh that hang together in space, texture and normals.

use std::collections::HashMap;

use glam::{Vec2, Vec3};
use relievo_march::Bounds;

use super::number_key::number_key;
use super::vertex::{Face, Vertex};

/// A part of a mesh whose triangles are connected by vertices with one position, one uv and one normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chart {
    /// Length of one texture repeat along u, scene units: the median of |dP/du| over the chart's area, so that triangles with
    /// next to no texture do not count. A height scale is a fraction of it.
    pub repeat_length: f32,
    /// Lower corner of the chart's texture range, in texture repeats.
    pub min: Vec2,
    /// Upper corner.
    pub max: Vec2,
    /// True if the chart covers all of its range: it ends where the range does.
    pub is_rectangle: bool,
    /// True if the chart lies in one plane with its normals, and the texture lies on it in one affine way.
    pub is_flat: bool,
}

impl Chart {
    /// Returns the texture range.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds { min: self.min.into(), max: self.max.into() }
    }
}

/// The largest difference between what counts as one direction or one axis, relative.
const SAME: f32 = 1e-4;

/// Finds the charts, writes their indices into the faces, and returns them with the chart of every vertex.
pub(super) fn charts(vertices: &[Vertex], triangles: &[[u32; 3]], faces: &mut [Face]) -> (Vec<Chart>, Vec<u32>) {
    let mut sets = DisjointSets::new(vertices.len());
    let mut known: HashMap<[u32; 8], u32> = HashMap::with_capacity(vertices.len());
    for (i, vertex) in vertices.iter().enumerate() {
        let [x, y, z] = vertex.position.to_array();
        let [nx, ny, nz] = vertex.normal.to_array();
        let key = number_key([x, y, z, nx, ny, nz, vertex.uv.x, vertex.uv.y]);
        let same = *known.entry(key).or_insert(i as u32);
        sets.join(i as u32, same);
    }
    for &[a, b, c] in triangles {
        sets.join(a, b);
        sets.join(b, c);
    }
    let mut number: HashMap<u32, u32> = HashMap::new();
    let mut members: Vec<Vec<u32>> = Vec::new();
    for (index, (face, &[corner, ..])) in faces.iter_mut().zip(triangles).enumerate() {
        let chart = *number.entry(sets.root(corner)).or_insert_with(|| {
            members.push(Vec::new());
            members.len() as u32 - 1
        });
        face.chart = chart;
        members[chart as usize].push(index as u32);
    }
    let area = |face: usize| area_vector(vertices, triangles[face]).length();
    let textured = |&face: &u32| Face::has_texture(triangles[face as usize].map(|i| vertices[i as usize].uv));
    let everywhere: Vec<u32> = (0..faces.len() as u32).filter(textured).collect();
    let whole = median_length(&everywhere, faces, area).unwrap_or(1.0);
    let of = |faces_of_chart: Vec<u32>| {
        let with_texture: Vec<u32> = faces_of_chart.iter().copied().filter(textured).collect();
        let repeat_length = median_length(&with_texture, faces, area).unwrap_or(whole);
        let (min, max) = faces_of_chart
            .iter()
            .flat_map(|&face| triangles[face as usize])
            .map(|i| vertices[i as usize].uv)
            .fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(min, max), uv| (min.min(uv), max.max(uv)));
        let is_rectangle = covers(&faces_of_chart, vertices, triangles, max - min);
        let is_flat = is_flat(&faces_of_chart, vertices, triangles, faces);
        Chart { repeat_length, min, max, is_rectangle, is_flat }
    };
    let charts = members.into_iter().map(of).collect();
    let of_vertex = (0..vertices.len() as u32).map(|i| number.get(&sets.root(i)).copied().unwrap_or(0)).collect();
    (charts, of_vertex)
}

/// Returns the median of |dP/du| over the area of some faces.
fn median_length(of: &[u32], faces: &[Face], area: impl Fn(usize) -> f32) -> Option<f32> {
    let mut lengths: Vec<(f32, f32)> =
        of.iter().map(|&face| (faces[face as usize].dp_du.length(), area(face as usize))).collect();
    lengths.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = lengths.iter().map(|&(_, area)| f64::from(area)).sum::<f64>() * 0.5;
    let mut sum = 0.0;
    lengths
        .iter()
        .find(|&&(_, area)| {
            sum += f64::from(area);
            sum >= half
        })
        .map(|&(length, _)| length)
        .filter(|length| *length > 0.0 && length.is_finite())
}

/// Returns true if triangles with one orientation in the texture fill a range of this size.
fn covers(of: &[u32], vertices: &[Vertex], triangles: &[[u32; 3]], size: Vec2) -> bool {
    let (mut sum, mut all) = (0.0f64, 0.0f64);
    for &face in of {
        let [a, b, c] = triangles[face as usize].map(|i| vertices[i as usize].uv.as_dvec2());
        let area = 0.5 * (b - a).perp_dot(c - a);
        sum += area;
        all += area.abs();
    }
    let whole = f64::from(size.x) * f64::from(size.y);
    (all - whole).abs() <= 1e-4 * whole && (sum.abs() - all).abs() <= 1e-4 * all
}

fn is_flat(of: &[u32], vertices: &[Vertex], triangles: &[[u32; 3]], faces: &[Face]) -> bool {
    let Some(first) = of.first().map(|&face| faces[face as usize]) else { return true };
    let normal = |face: u32| area_vector(vertices, triangles[face as usize]).normalize_or_zero();
    let plane = normal(of[0]);
    let same = |a: Vec3, b: Vec3| (a - b).length() <= SAME * b.length();
    of.iter().all(|&face| {
        let axes = &faces[face as usize];
        let corners = triangles[face as usize].map(|i| vertices[i as usize].direction);
        same(normal(face), plane)
            && corners.into_iter().all(|corner| same(corner, plane))
            && same(axes.dp_du, first.dp_du)
            && same(axes.dp_dv, first.dp_dv)
    })
}

fn area_vector(vertices: &[Vertex], [a, b, c]: [u32; 3]) -> Vec3 {
    let [a, b, c] = [a, b, c].map(|i| vertices[i as usize].position);
    (b - a).cross(c - a)
}

/// Sets of numbers that are joined step by step (union by halving paths).
struct DisjointSets(Vec<u32>);

impl DisjointSets {
    fn new(n: usize) -> Self {
        Self((0..n as u32).collect())
    }

    fn root(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let up = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = up;
            i = up;
        }
        i
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        let (low, high) = (a.min(b), a.max(b));
        self.0[high as usize] = low;
    }
}
