use crate::Ray;

/// The uv axes of a surface at a point, as vectors in the space of its mesh.
///
/// The lengths count: `dp_du` is as long as one texture repeat along u is on the mesh, `dp_dv` as one along v. They need not be
/// orthogonal. For a triangle both follow from its corners' positions and uvs; for a quad they are its edges divided by their
/// repeats.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceAxes {
    /// The derivative of the position by u, object units per texture repeat.
    pub dp_du: [f32; 3],
    /// The derivative of the position by v, object units per texture repeat; down the picture where v runs down.
    pub dp_dv: [f32; 3],
    /// The unit normal along which the relief rises, towards the side from which it is seen: the face's, or one interpolated
    /// between vertices.
    pub normal: [f32; 3],
}

impl SurfaceAxes {
    /// Returns the full depth in object units of a relief whose height scale is a fraction of one repeat along u, the unit of
    /// the tutorials.
    #[must_use]
    pub fn depth_of_height_scale(&self, height_scale: f32) -> f32 {
        height_scale * dot(self.dp_du, self.dp_du).sqrt()
    }

    /// Returns a unit vector in repeats along u and v and in parts of the normal: by the inverse of [dP/du dP/dv N], the face's
    /// own axes and a normal that may be an interpolated one. Where the axes are degenerate it goes straight along the normal.
    fn coordinates(&self, v: [f32; 3]) -> ([f32; 2], f32) {
        let (u, w) = (self.dp_du, self.dp_dv);
        let across = cross(u, w);
        // Towards the side of the normal.
        let along = dot(across, self.normal);
        let area = dot(across, across).sqrt();
        if !(along.abs() > LEAST_LEAN * area) {
            return self.leaning_coordinates(v);
        }
        let height = dot(across, v) / along;
        let rest = [0, 1, 2].map(|k| v[k] - self.normal[k] * height);
        let squared = area * area;
        let coordinates = [dot(cross(w, across), rest) / squared, dot(cross(across, u), rest) / squared];
        if coordinates.iter().all(|x| x.is_finite()) { (coordinates, height) } else { ([0.0; 2], height) }
    }

    /// Returns the same where the normal runs along the face, or the face has no area: by the normal alone.
    fn leaning_coordinates(&self, v: [f32; 3]) -> ([f32; 2], f32) {
        ([0.0; 2], dot(v, self.normal))
    }
}

/// The least cosine between a face and its interpolated normal with which a relief is marched.
const LEAST_LEAN: f32 = 0.05;

impl Ray {
    /// Builds the ray through `uv` of a surface with these axes, from the unit vector `to_eye` (surface → eye, or surface →
    /// light for a shadow) in the space of the mesh. `depth` is the full depth of the relief in object units; see
    /// [`SurfaceAxes::depth_of_height_scale`] for a height scale.
    ///
    /// The rule of signs: the ray goes away from the eye, so `uv_delta = −depth · (V in repeats of u and v)`. The axes say
    /// where v runs, and how long a repeat is along each: neither a flipped v nor a texture that is not square needs a
    /// factor of its own. A 2:1 map on a mesh that it fits (`dp_dv` half as long as `dp_du`) gets twice the `uv_delta` along
    /// v, and no *doubled v scale* on top.
    ///
    /// ```
    /// use relievo_march::{Ray, SurfaceAxes};
    ///
    /// // A quad of 2 × 1 units in the xy plane with a 2:1 texture on it; v runs down.
    /// let axes = SurfaceAxes { dp_du: [2.0, 0.0, 0.0], dp_dv: [0.0, -1.0, 0.0], normal: [0.0, 0.0, 1.0] };
    /// let ray = Ray::from_surface([0.5, 0.5], [0.6, 0.0, 0.8], &axes, 0.1);
    /// // Away from the eye: 0.6 · 0.1 units are 0.03 repeats of 2 units.
    /// assert!((ray.uv_delta[0] + 0.03).abs() < 1e-6 && ray.uv_delta[1] == 0.0 && ray.cos == 0.8);
    /// ```
    #[must_use]
    pub fn from_surface(uv: [f32; 2], to_eye: [f32; 3], axes: &SurfaceAxes, depth: f32) -> Self {
        let (along, cos) = axes.coordinates(to_eye);
        Self { uv, uv_delta: along.map(|x| -depth * x), cos }
    }
}

fn cross(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close<const N: usize>(a: [f32; N], b: [f32; N]) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6)
    }

    fn normalized(v: [f32; 3]) -> [f32; 3] {
        v.map(|x| x / dot(v, v).sqrt())
    }

    /// Unit vectors above the xy plane, from many sides.
    fn views() -> impl Iterator<Item = [f32; 3]> {
        (0..64).map(|i| {
            let (angle, z) = (i as f32 * 0.7, 0.1 + 0.9 * (i % 9) as f32 / 8.0);
            normalized([angle.cos(), angle.sin(), z])
        })
    }

    #[test]
    fn on_a_square_quad_the_ray_is_that_of_the_tangent_space_view() {
        let axes = SurfaceAxes { dp_du: [1.0, 0.0, 0.0], dp_dv: [0.0, -1.0, 0.0], normal: [0.0, 0.0, 1.0] };
        for view in views() {
            let (ray, expected) =
                (Ray::from_surface([0.3, 0.7], view, &axes, 0.08), Ray::from_view([0.3, 0.7], view, [0.08, -0.08]));
            assert!(close(ray.uv_delta, expected.uv_delta) && ray.cos == expected.cos && ray.uv == expected.uv);
        }
    }

    #[test]
    fn on_a_stretched_slanted_quad_the_displaced_point_lies_on_the_line_of_sight() {
        // Axes of different lengths, not orthogonal, tilted in space.
        let (dp_du, dp_dv) = ([2.0, 0.5, 0.1], [0.3, -0.6, 0.2]);
        let cross: [f32; 3] =
            [0, 1, 2].map(|k| dp_du[(k + 2) % 3] * dp_dv[(k + 1) % 3] - dp_du[(k + 1) % 3] * dp_dv[(k + 2) % 3]);
        let axes = SurfaceAxes { dp_du, dp_dv, normal: normalized(cross) };
        let depth = 0.25;
        for view in views() {
            // From the xy plane to the quad's own frame: any vector above it will do.
            let to_eye = normalized([0, 1, 2].map(|k| axes.normal[k] * (0.2 + view[2]) + dp_du[k] * view[0] * 0.4));
            let ray = Ray::from_surface([0.2, 0.4], to_eye, &axes, depth);
            for t in [0.1, 0.5, 1.0] {
                let uv = ray.at(t);
                let moved: [f32; 3] = [0, 1, 2].map(|k| {
                    dp_du[k] * (uv[0] - ray.uv[0]) + dp_dv[k] * (uv[1] - ray.uv[1]) - axes.normal[k] * depth * t
                });
                // Straight away from the eye, as far as the depth takes it.
                let expected = to_eye.map(|x| -x * depth * t / ray.cos);
                assert!(close(moved, expected), "{to_eye:?} {t}: {moved:?} for {expected:?}");
            }
        }
    }

    #[test]
    fn a_2_to_1_map_on_a_quad_that_fits_it_needs_no_scale_of_its_own() {
        // One repeat is 2 × 1 units, so along v the same distance is twice as many repeats.
        let axes = SurfaceAxes { dp_du: [2.0, 0.0, 0.0], dp_dv: [0.0, -1.0, 0.0], normal: [0.0, 0.0, 1.0] };
        let depth = axes.depth_of_height_scale(0.05);
        assert_eq!(depth, 0.1);
        for view in views() {
            let ray = Ray::from_surface([0.5; 2], view, &axes, depth);
            let expected = Ray::from_view([0.5; 2], view, [0.05, -0.1]);
            assert!(close(ray.uv_delta, expected.uv_delta), "{view:?}: {ray:?} for {expected:?}");
        }
    }

    #[test]
    fn degenerate_axes_give_a_ray_straight_down() {
        let axes = SurfaceAxes { dp_du: [0.0; 3], dp_dv: [0.0, 1.0, 0.0], normal: [0.0, 0.0, 1.0] };
        let ray = Ray::from_surface([0.5; 2], [0.6, 0.0, 0.8], &axes, 0.1);
        assert_eq!((ray.uv_delta, ray.cos), ([0.0; 2], 0.8));
    }
}
