//! Texture coordinates far from 0: whole repeats are taken off before anything is interpolated in f32.

use std::collections::HashMap;

use glam::DVec2;
use relievo_map::Wrap;

use super::surface_mesh::SurfaceMesh;
use crate::Material;

/// The repeats from 0 up to which nothing is done: an error of f32 there is below 1/1000 of a texel of a 1024² map.
const NEAR: f64 = 4.0;

/// The repeats that one triangle may span; longer ones are cut.
const LONGEST: f64 = 16.0;

/// The most triangles that a mesh is cut into for that.
const MAX_CUT: usize = 1 << 20;

/// Takes whole repeats off: of each chart the same where the relief ends at the chart's border, else of each triangle.
/// `uvs` are the vertices' texture coordinates before rounding.
pub(super) fn take_off(mesh: &mut SurfaceMesh, mut uvs: Vec<DVec2>, material: &Material) {
    if uvs.iter().all(|uv| uv.abs().max_element() <= NEAR) {
        return;
    }
    let by_chart = material.relief.edge.ends_at_charts();
    if !by_chart {
        let longest = longest_edge(mesh, &uvs);
        let wanted = (longest / LONGEST).ceil().max(1.0);
        let most = ((MAX_CUT / mesh.triangles.len().max(1)) as f64).sqrt().floor().max(1.0);
        let n = wanted.min(most) as u32;
        if n > 1 {
            uvs = mesh.cut(n, &uvs);
        }
    }
    let least_of = |corners: &[u32]| corners.iter().fold(DVec2::INFINITY, |least, &i| least.min(uvs[i as usize]));
    let offset = |least: DVec2| {
        let off = |x: f64| if x.abs() <= NEAR { 0.0 } else { whole_repeats(material.wrap, x) };
        DVec2::new(off(least.x), off(least.y))
    };
    let offsets: Vec<DVec2> = if by_chart {
        let mut least = vec![DVec2::INFINITY; mesh.charts.len()];
        for (triangle, face) in mesh.triangles.iter().zip(&mesh.faces) {
            let chart = &mut least[face.chart as usize];
            *chart = chart.min(least_of(triangle));
        }
        for (chart, &least) in mesh.charts.iter_mut().zip(&least) {
            let offset = offset(least).as_vec2();
            (chart.min, chart.max) = (chart.min - offset, chart.max - offset);
        }
        mesh.faces.iter().map(|face| offset(least[face.chart as usize])).collect()
    } else {
        mesh.triangles.iter().map(|triangle| offset(least_of(triangle))).collect()
    };
    // A vertex between triangles with different offsets is needed once for each.
    let mut known: HashMap<(u32, [u64; 2]), u32> = HashMap::new();
    let mut vertices = Vec::with_capacity(mesh.vertices.len());
    for (triangle, offset) in mesh.triangles.iter_mut().zip(&offsets) {
        *triangle = triangle.map(|i| {
            *known.entry((i, offset.to_array().map(f64::to_bits))).or_insert_with(|| {
                let mut vertex = mesh.vertices[i as usize];
                vertex.uv = (uvs[i as usize] - *offset).as_vec2();
                vertices.push(vertex);
                vertices.len() as u32 - 1
            })
        });
    }
    mesh.vertices = vertices;
}

fn longest_edge(mesh: &SurfaceMesh, uvs: &[DVec2]) -> f64 {
    let edges = mesh.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
    edges.fold(0.0f64, |longest, (a, b)| longest.max((uvs[a as usize] - uvs[b as usize]).abs().max_element()))
}

/// Returns the whole repeats that may be taken off without changing what a map shows: any with `repeat`, even ones with
/// `mirror`, none with `clamp`.
fn whole_repeats(wrap: Wrap, least: f64) -> f64 {
    match wrap {
        Wrap::Repeat => least.floor(),
        Wrap::Mirror => 2.0 * (least * 0.5).floor(),
        Wrap::Clamp => 0.0,
    }
}
