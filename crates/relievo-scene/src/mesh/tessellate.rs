use glam::DVec2;
use relievo_march::HeightField;

use super::relief_depth::ReliefDepth;
use super::surface_mesh::SurfaceMesh;
use super::vertex::Vertex;
use crate::UvTransform;

impl SurfaceMesh {
    /// Displaces the mesh: every triangle is cut into a regular grid, whose vertices move along their normals by the height
    /// map. Height `midlevel` stays on the polygon.
    ///
    /// `grid` vertices stand along one side of the mesh's uv range 0..1 (of the quad: along its side), which `transform` has
    /// mapped to the uvs here. All triangles of a mesh are cut equally often, so that neighbours' vertices meet along their
    /// edges.
    #[must_use]
    pub fn displaced(
        mut self,
        field: &impl HeightField,
        depth: &ReliefDepth,
        midlevel: f32,
        grid: u32,
        transform: &UvTransform,
    ) -> Self {
        let uvs: Vec<DVec2> = self.vertices.iter().map(|vertex| vertex.uv.as_dvec2()).collect();
        let n = segments(&self, grid, transform);
        self.cut(n, &uvs);
        for vertex in &mut self.vertices {
            let height = field.sample(vertex.uv.into());
            let direction = vertex.direction.normalize_or_zero();
            vertex.position += direction * ((height - midlevel) * depth.at(vertex));
        }
        self
    }

    /// Returns the number of triangles that [`SurfaceMesh::displaced`] makes.
    #[must_use]
    pub fn displaced_count(&self, grid: u32, transform: &UvTransform) -> u64 {
        self.triangles.len() as u64 * u64::from(segments(self, grid, transform)).pow(2)
    }

    /// Cuts every triangle into n² triangles with vertices of their own; those on a common edge lie in the same places.
    /// Returns the new vertices' texture coordinates, interpolated between `uvs` of the old ones.
    pub(super) fn cut(&mut self, n: u32, uvs: &[DVec2]) -> Vec<DVec2> {
        let mut fine = Subdivision {
            base: &self.vertices,
            uvs,
            n,
            vertices: Vec::new(),
            fine_uvs: Vec::new(),
            triangles: Vec::new(),
        };
        let mut face_of = Vec::with_capacity(self.triangles.len() * (n * n) as usize);
        for (&triangle, &face) in self.triangles.iter().zip(&self.face_of) {
            fine.cut(triangle);
            face_of.resize(fine.triangles.len(), face);
        }
        let Subdivision { vertices, fine_uvs, triangles, .. } = fine;
        (self.vertices, self.triangles, self.face_of) = (vertices, triangles, face_of);
        fine_uvs
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

/// A mesh being cut.
struct Subdivision<'a> {
    base: &'a [Vertex],
    uvs: &'a [DVec2],
    n: u32,
    vertices: Vec<Vertex>,
    fine_uvs: Vec<DVec2>,
    triangles: Vec<[u32; 3]>,
}

impl Subdivision<'_> {
    /// Cuts a triangle. Rows of vertices run from corner `a` to the edge `b`–`c`: row r has r + 1 vertices.
    fn cut(&mut self, [a, b, c]: [u32; 3]) {
        let n = self.n;
        let mut previous = vec![self.add([a, a, a], [1.0, 0.0, 0.0])];
        for row in 1..=n {
            let mut current = Vec::with_capacity(row as usize + 1);
            for column in 0..=row {
                current.push(match (row, column) {
                    _ if row == n => self.on_edge(b, c, column),
                    (_, 0) => self.on_edge(a, b, row),
                    _ if column == row => self.on_edge(a, c, row),
                    _ => {
                        let weights = [n - row, row - column, column].map(|w| f64::from(w) / f64::from(n));
                        self.add([a, b, c], weights)
                    }
                });
            }
            for k in 0..row as usize {
                self.triangles.push([previous[k], current[k], current[k + 1]]);
                if k + 1 < row as usize {
                    self.triangles.push([previous[k], current[k + 1], previous[k + 1]]);
                }
            }
            previous = current;
        }
    }

    /// Adds the vertex `step` of `n` segments along the edge from `a` to `b`: computed from the same end whichever triangle
    /// asks.
    fn on_edge(&mut self, a: u32, b: u32, step: u32) -> u32 {
        let place = |i: u32| self.base[i as usize].position.to_array();
        let (low, high, step) = if place(a) <= place(b) { (a, b, step) } else { (b, a, self.n - step) };
        let t = f64::from(step) / f64::from(self.n);
        self.add([low, high, high], [1.0 - t, t, 0.0])
    }

    fn add(&mut self, corners: [u32; 3], weights: [f64; 3]) -> u32 {
        let uv = (0..3).map(|k| self.uvs[corners[k] as usize] * weights[k]).sum::<DVec2>();
        let vertex = Vertex::interpolate(corners.map(|i| &self.base[i as usize]), weights.map(|w| w as f32));
        self.vertices.push(Vertex { uv: uv.as_vec2(), ..vertex });
        self.fine_uvs.push(uv);
        self.vertices.len() as u32 - 1
    }
}
