use glam::Vec3;

/// A light. `radius` makes its shadows soft where the shadow kind is exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where the light comes from.
    pub kind: LightKind,
    /// Linear RGB, usually 0..1.
    pub color: [f32; 3],
    /// Factor on the colour. With `pbr` a point or spot light's radiant intensity, falling off with the squared distance
    /// (as glTF's punctual lights); with `blinn-phong` a plain factor without falloff, as in the tutorials.
    pub intensity: f32,
    /// Point and spot: radius of the shining sphere in scene units. Directional: tangent of the half-angle it covers.
    /// 0 = sharp shadows.
    pub radius: f32,
}

/// Where a light comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// Shines in all directions from a place.
    Point {
        /// Scene units.
        position: Vec3,
    },
    /// Shines along one direction from far away.
    Directional {
        /// The way the light travels; unit length.
        direction: Vec3,
    },
    /// Shines in a cone.
    Spot {
        /// Scene units.
        position: Vec3,
        /// The axis, the way the light travels; unit length.
        direction: Vec3,
        /// Full light inside this angle from the axis, degrees.
        inner_angle: f32,
        /// No light outside this angle from the axis, degrees; above `inner_angle`, at most 90.
        outer_angle: f32,
    },
}
