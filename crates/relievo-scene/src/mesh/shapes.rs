//! The built-in meshes.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::indexed_mesh::Mesh;

/// Names of the built-in meshes in scene files.
pub const SHAPE_NAMES: [&str; 6] = ["quad", "plane", "cube", "sphere", "cylinder", "torus"];

impl Mesh {
    /// Returns the built-in mesh with this name (see [`SHAPE_NAMES`]), if there is one.
    #[must_use]
    pub fn shape(name: &str) -> Option<Self> {
        Some(match name {
            "quad" => Self::quad(),
            "plane" => Self::plane(),
            "cube" => Self::cube(),
            "sphere" => Self::sphere(),
            "cylinder" => Self::cylinder(),
            "torus" => Self::torus(),
            _ => return None,
        })
    }

    /// Makes a wall: 2 × 2 units at z = 0, facing +Z; u to the right (+X), v down (−Y), uv (0, 0) at (−1, 1, 0).
    #[must_use]
    pub fn quad() -> Self {
        let mut builder = Builder::default();
        builder.square(Vec3::ZERO, Vec3::X, Vec3::NEG_Y);
        builder.finish()
    }

    /// Makes a floor: 2 × 2 units at y = 0, facing +Y; u along +X, v along +Z, uv (0, 0) at (−1, 0, −1).
    #[must_use]
    pub fn plane() -> Self {
        let mut builder = Builder::default();
        builder.square(Vec3::ZERO, Vec3::X, Vec3::Z);
        builder.finish()
    }

    /// Makes a cube of 2 × 2 × 2 units around the origin. Each face carries one texture repeat; on the sides it stands upright,
    /// top and bottom have their left side at −X.
    #[must_use]
    pub fn cube() -> Self {
        let mut builder = Builder::default();
        for (u, v) in [
            (Vec3::X, Vec3::NEG_Y),
            (Vec3::NEG_Z, Vec3::NEG_Y),
            (Vec3::NEG_X, Vec3::NEG_Y),
            (Vec3::Z, Vec3::NEG_Y),
            (Vec3::X, Vec3::Z),
            (Vec3::X, Vec3::NEG_Z),
        ] {
            builder.square(v.cross(u), u, v);
        }
        builder.finish()
    }

    /// Makes a sphere of radius 1 around the origin: v = 0 at the north pole (+Y), u once around, 0.5 towards +Z. Seen from
    /// outside the texture is not mirrored.
    #[must_use]
    pub fn sphere() -> Self {
        const AROUND: u32 = 128;
        const DOWN: u32 = 64;
        let mut builder = Builder::default();
        builder.lattice(AROUND, DOWN, |uv, pole| {
            // A pole has a vertex per triangle, with u in the middle of it.
            let u = if pole { (uv.x + 0.5 / AROUND as f32).min(1.0) } else { uv.x };
            let (sin_polar, cos_polar) = polar(uv.y);
            let (sin, cos) = azimuth(u);
            let normal = Vec3::new(sin_polar * sin, cos_polar, sin_polar * cos);
            (normal, normal, Vec2::new(u, uv.y))
        });
        builder.finish()
    }

    /// Makes a cylinder of radius 1 and height 2 around the Y axis, with caps. On the side v = 0 is at the top and u runs once
    /// around, 0.5 towards +Z; each cap shows the disc inside one texture repeat, its left side at −X.
    #[must_use]
    pub fn cylinder() -> Self {
        const AROUND: u32 = 128;
        let mut builder = Builder::default();
        builder.lattice(AROUND, 1, |uv, _| {
            let (sin, cos) = azimuth(uv.x);
            (Vec3::new(sin, 1.0 - 2.0 * uv.y, cos), Vec3::new(sin, 0.0, cos), uv)
        });
        for side in [1.0, -1.0] {
            let normal = Vec3::Y * side;
            let vertex = |builder: &mut Builder, x: f32, z: f32| {
                builder.vertex(Vec3::new(x, side, z), normal, Vec2::new(0.5 + 0.5 * x, 0.5 + 0.5 * z * side))
            };
            let centre = vertex(&mut builder, 0.0, 0.0);
            let rim: Vec<u32> = (0..AROUND)
                .map(|i| azimuth(i as f32 / AROUND as f32))
                .map(|(sin, cos)| vertex(&mut builder, sin, cos))
                .collect();
            for (i, &a) in rim.iter().enumerate() {
                let b = rim[(i + 1) % rim.len()];
                builder.triangles.push(if side > 0.0 { [centre, a, b] } else { [centre, b, a] });
            }
        }
        builder.finish()
    }

    /// Makes a torus around the Y axis: the tube of radius 0.4 runs at distance 1 from the axis. u runs once around the axis,
    /// 0.5 towards +Z; v once around the tube, 0.5 on the outside, downwards there.
    #[must_use]
    pub fn torus() -> Self {
        const TUBE: f32 = 0.4;
        let mut builder = Builder::default();
        builder.lattice(128, 64, |uv, _| {
            let (sin, cos) = azimuth(uv.x);
            // The last row lies exactly on the first.
            let v = if uv.y == 1.0 { 0.0 } else { uv.y };
            let (sin_tube, cos_tube) = (PI - TAU * v).sin_cos();
            let normal = Vec3::new(cos_tube * sin, sin_tube, cos_tube * cos);
            (Vec3::new(sin, 0.0, cos) + TUBE * normal, normal, uv)
        });
        builder.finish()
    }
}

/// Returns sine and cosine of the angle around +Y that u stands for: 0.5 is +Z, growing towards +X. Exact at the seam.
fn azimuth(u: f32) -> (f32, f32) {
    if u == 0.0 || u == 1.0 { (0.0, -1.0) } else { (TAU * (u - 0.5)).sin_cos() }
}

/// Returns sine and cosine of the angle from +Y. Exact at the poles.
fn polar(v: f32) -> (f32, f32) {
    if v == 0.0 {
        (0.0, 1.0)
    } else if v == 1.0 {
        (0.0, -1.0)
    } else {
        (PI * v).sin_cos()
    }
}

#[derive(Default)]
struct Builder {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
}

impl Builder {
    fn vertex(&mut self, position: Vec3, normal: Vec3, uv: Vec2) -> u32 {
        self.positions.push(position);
        self.normals.push(normal);
        self.uvs.push(uv);
        self.positions.len() as u32 - 1
    }

    /// Adds a square of side 2 around `centre`, one texture repeat, `u` and `v` along its sides.
    fn square(&mut self, centre: Vec3, u: Vec3, v: Vec3) {
        let normal = v.cross(u);
        let [a, b, c, d] = [(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)]
            .map(|(s, t)| self.vertex(centre + u * (2.0 * s - 1.0) + v * (2.0 * t - 1.0), normal, Vec2::new(s, t)));
        self.triangles.extend([[a, b, c], [a, c, d]]);
    }

    /// Adds a surface over the unit square of uv: `surface(uv, pole)` returns position, normal and uv of a vertex. Where a whole
    /// row falls into one point (`pole`), the triangles without area are left out.
    fn lattice(&mut self, columns: u32, rows: u32, surface: impl Fn(Vec2, bool) -> (Vec3, Vec3, Vec2)) {
        let at = |column: u32, row: u32| Vec2::new(column as f32 / columns as f32, row as f32 / rows as f32);
        let is_pole = |row: u32| surface(at(0, row), false).0 == surface(at(columns / 2, row), false).0;
        let first = self.positions.len() as u32;
        for row in 0..=rows {
            let pole = is_pole(row);
            for column in 0..=columns {
                let (position, normal, uv) = surface(at(column, row), pole);
                self.vertex(position, normal, uv);
            }
        }
        for row in 0..rows {
            let (top_pole, bottom_pole) = (is_pole(row), is_pole(row + 1));
            for column in 0..columns {
                let a = first + row * (columns + 1) + column;
                let b = a + columns + 1;
                if !bottom_pole {
                    self.triangles.push([a, b, b + 1]);
                }
                if !top_pole {
                    self.triangles.push(if bottom_pole { [a, b, a + 1] } else { [a, b + 1, a + 1] });
                }
            }
        }
    }

    fn finish(self) -> Mesh {
        match Mesh::with_tangents(self.positions, self.normals, self.uvs, self.triangles) {
            Ok(mesh) => mesh,
            Err(error) => unreachable!("a built-in mesh is sound: {error}"),
        }
    }
}
