//! Triangles with shells over them: a texture that rays walk in from one to the next, and what is drawn to begin with.

use std::collections::HashMap;
use std::ops::Range;

use glam::Vec3;
use relievo_march::Prism;
use relievo_scene::{ReliefDepth, SurfaceMesh, Vertex};

use super::layout::{ShellInstance, ShellLayout};
use crate::GpuError;
use crate::device::wgpu_util::{check_size, texture_descriptor, whole_view, write_level};

/// Stands for no neighbor across an edge.
const NOBODY: u32 = u32::MAX;

/// The least part of a triangle's area that is left of it at any offset, for rays to walk over it.
const LEAST_AREA: f32 = 0.02;

/// Triangles with shells, of all objects.
#[derive(Default)]
pub(crate) struct Shells {
    layouts: Vec<ShellLayout>,
    instances: Vec<ShellInstance>,
}

/// Shells of one object.
pub(crate) struct ShellObject {
    /// Its instances.
    pub(crate) range: Range<u32>,
    /// The six corners of each hull: the floor's, then the lid's; empty if rays cannot walk from shell to shell.
    hulls: Vec<[Vec3; 6]>,
    /// Corners of the box around all hulls.
    bounds: [Vec3; 2],
    /// True if a triangle has an edge without a neighbor.
    pub(crate) has_borders: bool,
    /// True if rays begin at the lids, as of the camera that it was last seen from.
    pub(crate) is_walked: bool,
}

impl Shells {
    /// Appends the triangles of a mesh.
    pub(crate) fn append(&mut self, mesh: &SurfaceMesh, depth: &ReliefDepth, midlevel: f32) -> ShellObject {
        let first = self.layouts.len() as u32;
        let neighbors = neighbors(mesh, first);
        let triangles = || mesh.triangles.iter().map(|triangle| triangle.map(|i| &mesh.vertices[i as usize]));
        let prisms: Vec<(Prism, f32)> = triangles()
            .map(|corners| {
                let depth = corners.map(|corner| depth.at(corner)).iter().sum::<f32>() / 3.0;
                (Prism::new(corners.map(Vertex::as_corner), depth, midlevel), depth)
            })
            .collect();
        // Heights that the caller changes later lie in the hull too.
        let offsets: Vec<[f32; 2]> =
            prisms.iter().map(|(prism, _)| prism.offsets([0.0, 1.0]).map(|offset| offset as f32)).collect();
        // Rays walk between one floor and one lid, so that lids meet at their edges.
        let common = offsets.iter().fold([0.0f32; 2], |common, own| [common[0].min(own[0]), common[1].max(own[1])]);
        let walkable = triangles().all(|corners| keeps_its_side(corners, common));
        let mut hulls = Vec::new();
        let mut bounds = [Vec3::INFINITY, Vec3::NEG_INFINITY];
        let mut has_borders = false;
        for (number, corners) in triangles().enumerate() {
            let layout = ShellLayout::new(corners, neighbors[number], prisms[number].1);
            let [floor, lid] = if walkable { common } else { offsets[number] };
            let at = |offset: f32| corners.map(|corner| corner.position + corner.direction * offset);
            let ([a, b, c], [d, e, f]) = (at(floor), at(lid));
            let hull = [a, b, c, d, e, f];
            let around = box_around(&hull);
            bounds = [bounds[0].min(around[0]), bounds[1].max(around[1])];
            if walkable {
                hulls.push(hull);
            }
            let borders = (0..3).filter(|&k| neighbors[number][k] == NOBODY).fold(0, |bits, k| bits | 1 << k);
            has_borders |= borders != 0;
            self.layouts.push(layout);
            self.instances.push(ShellInstance {
                triangle: first + number as u32,
                floor,
                lid,
                walls: folded_diagonals(&hull) | borders << 3,
            });
        }
        let range = first..self.layouts.len() as u32;
        ShellObject { range, hulls, bounds, has_borders, is_walked: walkable }
    }

    /// Returns what is drawn, one instance for a triangle; never empty, as buffers cannot be.
    pub(crate) fn instances(&mut self) -> &[ShellInstance] {
        if self.instances.is_empty() {
            self.instances.push(bytemuck::Zeroable::zeroed());
        }
        &self.instances
    }

    /// Makes the texture of all triangles.
    pub(crate) fn texture(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<wgpu::TextureView, GpuError> {
        let (count, largest) = (self.layouts.len().max(1), device.limits().max_texture_dimension_2d);
        // A power of two in a row: the shader shifts instead of dividing.
        let fits = |row_bits: u32| count.div_ceil(1 << row_bits) <= largest as usize;
        let row_bits = (0..16).find(|&row_bits| fits(row_bits)).unwrap_or(16);
        let size = [ShellLayout::TEXELS << row_bits, count.div_ceil(1 << row_bits) as u32];
        check_size(device, "the texture of the shells", size[0], size[1])?;
        let usage = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST;
        let descriptor = texture_descriptor("relievo shells", size, wgpu::TextureFormat::Rgba32Uint, usage);
        let texture = device.create_texture(&descriptor);
        let mut rows = self.layouts.clone();
        rows.resize((size[1] as usize) << row_bits, bytemuck::Zeroable::zeroed());
        write_level(queue, &texture, 0, size, bytemuck::cast_slice(&rows));
        Ok(whole_view(&texture))
    }
}

impl ShellObject {
    /// Returns true if rays of a camera can walk from shell to shell, beginning at the lids: its near plane crosses none.
    pub(crate) fn is_walked_from(&self, eye: &NearPlane) -> bool {
        let [min, max] = self.bounds;
        let beyond_plane = |points: &[Vec3]| points.iter().all(|&p| (p - eye.position).dot(eye.forward) > eye.near);
        let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|i| {
            let at = |k: u32| if i >> k & 1 == 0 { min } else { max };
            Vec3::new(at(0).x, at(1).y, at(2).z)
        });
        let is_beside = |[min, max]: [Vec3; 2]| (min - eye.position).max(eye.position - max).max_element() > eye.reach;
        let is_outside = |hull: &[Vec3; 6]| {
            let [a, b, c, ..] = *hull;
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let heights = hull.map(|point| (point - eye.position).dot(normal));
            beyond_plane(hull)
                || is_beside(box_around(hull))
                || heights.iter().all(|&h| h > eye.reach)
                || heights.iter().all(|&h| h < -eye.reach)
        };
        !self.hulls.is_empty()
            && (beyond_plane(&corners) || is_beside(self.bounds) || self.hulls.iter().all(is_outside))
    }
}

/// The place that rays of a camera begin at.
pub(crate) struct NearPlane {
    pub(crate) position: Vec3,
    /// Of unit length.
    pub(crate) forward: Vec3,
    /// Distance of the near plane.
    pub(crate) near: f32,
    /// The farthest that a ray begins from the position.
    pub(crate) reach: f32,
}

fn box_around(points: &[Vec3]) -> [Vec3; 2] {
    points.iter().fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[min, max], &p| [min.min(p), max.max(p)])
}

/// Returns the triangles across the edges of each one, those opposite to its corners; numbers begin at `first`. Two triangles are
/// neighbors if they alone have an edge, from opposite sides, with the same directions.
fn neighbors(mesh: &SurfaceMesh, first: u32) -> Vec<[u32; 3]> {
    // Adding 0 makes −0 and 0 one.
    let bits = |v: Vec3| v.to_array().map(|x| (x + 0.0).to_bits());
    let key = |corner: u32| {
        let vertex = &mesh.vertices[corner as usize];
        [bits(vertex.position), bits(vertex.direction)]
    };
    let edge = |triangle: &[u32; 3], k: usize| [key(triangle[(k + 1) % 3]), key(triangle[(k + 2) % 3])];
    // The triangle that has an edge in this sense, and how many do.
    let mut users: HashMap<_, (u32, u32)> = HashMap::new();
    for (number, triangle) in (first..).zip(&mesh.triangles) {
        for k in 0..3 {
            users.entry(edge(triangle, k)).or_insert((number, 0)).1 += 1;
        }
    }
    let alone = |edge| users.get(&edge).filter(|user| user.1 == 1).map(|user| user.0);
    let across = |triangle: &[u32; 3], k: usize| {
        let [from, to] = edge(triangle, k);
        alone([from, to]).and_then(|_| alone([to, from])).unwrap_or(NOBODY)
    };
    mesh.triangles.iter().map(|triangle| [0, 1, 2].map(|k| across(triangle, k))).collect()
}

/// Returns true if a triangle that is moved along its directions by offsets in this range keeps its side and some of its area,
/// everywhere on it: rays then cross the space over it once.
fn keeps_its_side(corners: [&Vertex; 3], [floor, lid]: [f32; 2]) -> bool {
    let edges = |of: fn(&Vertex) -> Vec3| [of(corners[1]) - of(corners[0]), of(corners[2]) - of(corners[0])];
    let ([p1, p2], [n1, n2]) = (edges(|corner| corner.position), edges(|corner| corner.direction));
    // The moved triangle's normal, c0 + c1·e + c2·e², in Bernstein form.
    let (c0, c1, c2) = (p1.cross(p2), p1.cross(n2) + n1.cross(p2), n1.cross(n2));
    let at = |e: f32| c0 + (c1 + c2 * e) * e;
    let middle = at(floor) + (c1 + c2 * (2.0 * floor)) * (0.5 * (lid - floor));
    let area = c0.length();
    let keeps = |normal: Vec3| corners.iter().all(|corner| normal.dot(corner.direction) > LEAST_AREA * area);
    area > 0.0 && [at(floor), middle, at(lid)].into_iter().all(keeps)
}

/// Returns which diagonals of a hull's walls run from floor j to lid i, not from floor i to lid j: as bits.
fn folded_diagonals(hull: &[Vec3; 6]) -> u32 {
    let folds = |i: usize| {
        let j = (i + 1) % 3;
        let (floor_i, floor_j, lid_j, lid_i) = (hull[i], hull[j], hull[j + 3], hull[i + 3]);
        // The fold from floor i to lid j bends outwards if lid i lies behind the plane of the other three.
        (floor_j - floor_i).cross(lid_j - floor_i).dot(lid_i - floor_i) > 0.0
    };
    (0..3).filter(|&i| folds(i)).fold(0, |bits, i| bits | 1 << i)
}
