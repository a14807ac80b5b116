use glam::Vec2;
use relievo_march::Bounds;

use super::charts::Chart;
use super::vertex::{Face, Vertex};

/// The triangles of an object in scene space, as all backends draw them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceMesh {
    /// The corners.
    pub vertices: Vec<Vertex>,
    /// Indices of corners, counter-clockwise seen from the front.
    pub triangles: Vec<[u32; 3]>,
    /// Indices into `faces`, one per triangle: the triangles of a displaced mesh share those of the triangle they were cut
    /// from.
    pub face_of: Vec<u32>,
    /// The flat triangles of the mesh that was given.
    pub faces: Vec<Face>,
    /// The parts that hang together in space, texture and normals.
    pub charts: Vec<Chart>,
}

impl SurfaceMesh {
    /// Most triangles of a scene that are kept: more would take over 4 GB of memory.
    pub const MAX_TRIANGLES: u64 = 16_000_000;

    /// Returns the face of a triangle.
    #[must_use]
    pub fn face(&self, triangle: usize) -> &Face {
        &self.faces[self.face_of[triangle] as usize]
    }

    /// Returns the chart of a triangle.
    #[must_use]
    pub fn chart(&self, triangle: usize) -> &Chart {
        &self.charts[self.face(triangle).chart as usize]
    }

    /// Returns the texture range of all charts together.
    #[must_use]
    pub fn texture_range(&self) -> Bounds {
        let charts = self.charts.iter();
        let (min, max) = charts
            .fold((Vec2::INFINITY, Vec2::NEG_INFINITY), |(min, max), chart| (min.min(chart.min), max.max(chart.max)));
        Bounds { min: min.into(), max: max.into() }
    }

    /// Appends another mesh.
    pub fn append(&mut self, other: &mut Self) {
        let [vertices, faces, charts] = [self.vertices.len(), self.faces.len(), self.charts.len()].map(|n| n as u32);
        self.triangles.extend(other.triangles.drain(..).map(|corners| corners.map(|i| i + vertices)));
        self.face_of.extend(other.face_of.drain(..).map(|face| face + faces));
        self.faces.extend(other.faces.drain(..).map(|face| Face { chart: face.chart + charts, ..face }));
        self.vertices.append(&mut other.vertices);
        self.charts.append(&mut other.charts);
    }
}
