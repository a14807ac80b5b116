use super::vector::{Vector, cross, dot, length, sub, three};

/// The shortest interpolated normal that is reckoned with: shorter ones point anywhere, and there is no surface to speak of.
const SHORTEST_NORMAL: f64 = 0.05;

/// A corner of a triangle that carries a relief.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner {
    /// Position, scene units.
    pub position: [f32; 3],
    /// Normal along which the relief rises; of unit length, or as interpolated between such.
    pub normal: [f32; 3],
    /// Texture coordinates, in texture repeats.
    pub uv: [f32; 2],
}

/// The shell of a relief over one triangle: between a lid above its highest point and a floor below its lowest.
#[derive(Clone, Copy, Debug)]
pub struct Prism {
    pub(super) positions: [Vector; 3],
    pub(super) normals: [Vector; 3],
    pub(super) uvs: [[f64; 2]; 3],
    /// Distance between height 0 and height 1 along a unit normal, scene units.
    pub(super) depth: f64,
    pub(super) midlevel: f64,
    /// Lower bound of the length of the interpolated normal, and upper bound.
    shortest_normal: f64,
    longest_normal: f64,
    /// The triangle's normal times twice its area.
    area_vector: Vector,
    /// Texture repeats per scene unit along the triangle, of u and v.
    repeats_per_unit: [f64; 2],
    /// True if every number is finite and there is a depth to march in.
    is_usable: bool,
}

/// A straight ray in scene space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShellRay {
    /// Origin, scene units.
    pub origin: [f32; 3],
    /// Direction, of unit length.
    pub direction: [f32; 3],
}

impl Prism {
    /// Makes the shell over a triangle. `depth` is the distance between height 0 and height 1 in scene units, `midlevel` the
    /// height that lies on the triangle.
    #[must_use]
    pub fn new(corners: [Corner; 3], depth: f32, midlevel: f32) -> Self {
        let normals = corners.map(|corner| corner.normal.map(f64::from));
        let positions = corners.map(|corner| corner.position.map(f64::from));
        let uvs = corners.map(|corner| corner.uv.map(f64::from));
        // |Σ λN|² = Σ λ|N|² − Σ λiλj·|Ni − Nj|², and Σ λiλj ≤ 1/3.
        let shortest = normals.iter().map(|&n| dot(n, n)).fold(f64::INFINITY, f64::min);
        let farthest = (0..3).map(|k| sub(normals[k], normals[(k + 1) % 3])).map(|d| dot(d, d)).fold(0.0, f64::max);
        let [a, b, c] = positions;
        let (e1, e2) = (sub(b, a), sub(c, a));
        let area_vector = cross(e1, e2);
        // The gradients of u and v on the triangle.
        let (g1, g2) = (cross(e2, area_vector), cross(area_vector, e1));
        let gradient = |k: usize| {
            let (d1, d2) = (uvs[1][k] - uvs[0][k], uvs[2][k] - uvs[0][k]);
            length(three(|i| g1[i] * d1 + g2[i] * d2)) / dot(area_vector, area_vector)
        };
        let (depth, midlevel) = (f64::from(depth), f64::from(midlevel));
        let mut numbers =
            positions.iter().chain(&normals).flatten().chain(uvs.iter().flatten()).chain([&midlevel, &depth]);
        Self {
            shortest_normal: (shortest - farthest / 3.0).max(0.0).sqrt().max(SHORTEST_NORMAL),
            longest_normal: normals.iter().map(|&n| length(n)).fold(SHORTEST_NORMAL, f64::max),
            area_vector,
            repeats_per_unit: [gradient(0), gradient(1)].map(|x| if x.is_finite() { x } else { 0.0 }),
            is_usable: depth > 0.0 && numbers.all(|x| x.is_finite()),
            positions,
            normals,
            uvs,
            depth,
            midlevel,
        }
    }

    /// Returns the same shell, of which this fraction of the depth is left.
    #[must_use]
    pub fn faded(&self, fade: f32) -> Self {
        let depth = self.depth * f64::from(fade);
        Self { depth, is_usable: self.is_usable && depth > 0.0, ..*self }
    }

    /// Returns the offsets along the interpolated normals between which the surface lies, for heights in this range; scene units.
    #[must_use]
    pub fn offsets(&self, range: [f32; 2]) -> [f64; 2] {
        let at = |height: f32| (f64::from(height) - self.midlevel) * self.depth;
        let [low, high] = [at(range[0]), at(range[1])];
        let farthest = |d: f64| d / self.shortest_normal;
        let nearest = |d: f64| d / self.longest_normal;
        // A little room, so that heights at the ends of the range lie inside.
        let room = 1e-6 * self.depth;
        [
            (if low < 0.0 { farthest(low) } else { nearest(low) }) - room,
            (if high > 0.0 { farthest(high) } else { nearest(high) }) + room,
        ]
    }

    /// Returns the six corners of a hull that contains the shell for heights in this range: the floor's, then the lid's.
    #[must_use]
    pub fn hull(&self, range: [f32; 2]) -> [[f32; 3]; 6] {
        let [floor, lid] = self.offsets(range);
        let at = |k: usize, e: f64| three(|i| (self.positions[k][i] + self.normals[k][i] * e) as f32);
        [at(0, floor), at(1, floor), at(2, floor), at(0, lid), at(1, lid), at(2, lid)]
    }

    /// Returns the height of a point at this offset, where the interpolated normal is `normal`.
    pub(super) fn height(&self, offset: f64, normal: Vector) -> f64 {
        self.midlevel + offset * length(normal) / self.depth
    }

    pub(super) fn shortest_normal(&self) -> f64 {
        self.shortest_normal
    }

    /// Returns the triangle's normal times twice its area.
    pub(super) fn area_vector(&self) -> Vector {
        self.area_vector
    }

    /// Returns true if every number is finite and there is a depth to march in.
    pub(super) fn is_usable(&self) -> bool {
        self.is_usable
    }

    /// Returns the largest number of texels per scene unit that the texture has on the triangle, for a map of this size.
    pub(super) fn texels_per_unit(&self, size: [u32; 2]) -> f64 {
        let [u, v] = self.repeats_per_unit;
        (u * f64::from(size[0])).max(v * f64::from(size[1]))
    }
}
