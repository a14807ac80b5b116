use std::collections::HashMap;

use relievo_march::HeightField;

use super::surface_mesh::{ReliefDepth, SurfaceMesh, Vertex};
use crate::UvTransform;

impl SurfaceMesh {
    /// Displaces the mesh: every triangle is cut into a regular grid, whose vertices move along their normals by the height
    /// map. Height `midlevel` stays on the polygon.
    ///
    /// `grid` vertices stand along one side of the mesh's uv range 0..1 (of the quad: along its side), which `uvs` has mapped to
    /// the uvs here. All triangles of a mesh are cut equally often, so that neighbours share their edges' vertices.
    #[must_use]
    pub fn displaced(
        &self,
        field: &impl HeightField,
        depth: &ReliefDepth,
        midlevel: f32,
        grid: u32,
        uvs: &UvTransform,
    ) -> Self {
        let mut fine = Subdivision::new(self, segments(self, grid, uvs));
        for vertex in &mut fine.mesh.vertices {
            let height = field.sample(vertex.uv.into());
            let normal = vertex.normal.normalize_or_zero();
            vertex.position += normal * ((height - midlevel) * depth.at(vertex));
        }
        fine.mesh
    }

    /// Returns the number of triangles that [`SurfaceMesh::displaced`] makes.
    #[must_use]
    pub fn displaced_count(&self, grid: u32, uvs: &UvTransform) -> u64 {
        self.triangles.len() as u64 * u64::from(segments(self, grid, uvs)).pow(2)
    }
}

/// Returns the number of segments of each edge: the longest edge, in the mesh's own uv, decides.
fn segments(base: &SurfaceMesh, grid: u32, uvs: &UvTransform) -> u32 {
    let longest =
        base.triangles.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).fold(0.0f32, |longest, (a, b)| {
            let edge = uvs.undo(base.vertices[a as usize].uv - base.vertices[b as usize].uv);
            longest.max(edge.abs().max_element())
        });
    ((grid.saturating_sub(1)) as f32 * longest.min(1.0)).ceil().max(1.0) as u32
}

/// A mesh with every triangle cut into `n²` triangles.
struct Subdivision<'a> {
    base: &'a SurfaceMesh,
    mesh: SurfaceMesh,
    n: u32,
    /// First of the inner vertices of an edge, by its two corners in rising order.
    edges: HashMap<[u32; 2], u32>,
}

impl<'a> Subdivision<'a> {
    fn new(base: &'a SurfaceMesh, n: u32) -> Self {
        let mesh = SurfaceMesh { vertices: base.vertices.clone(), triangles: Vec::new() };
        let mut this = Self { base, mesh, n, edges: HashMap::new() };
        for &triangle in &base.triangles {
            this.cut(triangle);
        }
        this
    }

    /// Cuts a triangle. Rows of vertices run from corner `a` to the edge `b`–`c`: row r has r + 1 vertices.
    fn cut(&mut self, [a, b, c]: [u32; 3]) {
        let n = self.n;
        let mut previous = vec![a];
        for row in 1..=n {
            let mut current = Vec::with_capacity(row as usize + 1);
            for column in 0..=row {
                current.push(match (row, column) {
                    _ if row == n => self.on_edge(b, c, column),
                    (_, 0) => self.on_edge(a, b, row),
                    _ if column == row => self.on_edge(a, c, row),
                    _ => {
                        let weights = [n - row, row - column, column].map(|w| w as f32 / n as f32);
                        self.add(Vertex::interpolate([a, b, c].map(|i| &self.base.vertices[i as usize]), weights))
                    }
                });
            }
            for k in 0..row as usize {
                self.mesh.triangles.push([previous[k], current[k], current[k + 1]]);
                if k + 1 < row as usize {
                    self.mesh.triangles.push([previous[k], current[k + 1], previous[k + 1]]);
                }
            }
            previous = current;
        }
    }

    /// Returns the vertex `step` of `n` segments along the edge from `a` to `b`, shared with the triangle on the other side.
    fn on_edge(&mut self, a: u32, b: u32, step: u32) -> u32 {
        let n = self.n;
        if step == 0 {
            return a;
        }
        if step == n {
            return b;
        }
        let (low, high, step) = if a < b { (a, b, step) } else { (b, a, n - step) };
        let first = if let Some(&first) = self.edges.get(&[low, high]) {
            first
        } else {
            let first = self.mesh.vertices.len() as u32;
            let ends = [&self.base.vertices[low as usize], &self.base.vertices[high as usize]];
            for k in 1..n {
                let t = k as f32 / n as f32;
                self.mesh.vertices.push(Vertex::interpolate([ends[0], ends[1], ends[1]], [1.0 - t, t, 0.0]));
            }
            self.edges.insert([low, high], first);
            first
        };
        first + step - 1
    }

    fn add(&mut self, vertex: Vertex) -> u32 {
        self.mesh.vertices.push(vertex);
        self.mesh.vertices.len() as u32 - 1
    }
}
