use glam::Vec3;

/// A light. `radius` makes its shadows soft where the shadow kind is exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Kind and position of the light.
    pub kind: LightKind,
    /// Linear RGB, usually 0..1.
    pub color: [f32; 3],
    /// Factor on the colour. With `pbr` a point or spot light's radiant intensity, falling off with the squared distance
    /// (as glTF's punctual lights); with `blinn-phong` a plain factor without falloff, as in the tutorials.
    pub intensity: f32,
    /// Point and spot: radius of the emitting sphere in scene units. Directional: tangent of the half-angle it covers.
    /// 0 = sharp shadows.
    pub radius: f32,
}

/// Kinds of light.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LightKind {
    /// Shines in all directions from a point.
    Point {
        /// Position, scene units.
        position: Vec3,
    },
    /// Shines along one direction from far away.
    Directional {
        /// Direction in which the light travels; unit length.
        direction: Vec3,
    },
    /// Shines in a cone.
    Spot {
        /// Position, scene units.
        position: Vec3,
        /// Axis: the direction in which the light travels; unit length.
        direction: Vec3,
        /// Full light inside this angle from the axis, degrees.
        inner_angle: f32,
        /// No light outside this angle from the axis, degrees; above `inner_angle`, at most 90.
        outer_angle: f32,
    },
}

impl LightKind {
    /// Returns the name in scene files.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Self::Point { .. } => "point",
            Self::Directional { .. } => "directional",
            Self::Spot { .. } => "spot",
        }
    }

    /// Returns the position, scene units; `None` for directional lights.
    #[must_use]
    pub fn position(&self) -> Option<Vec3> {
        match *self {
            Self::Point { position } | Self::Spot { position, .. } => Some(position),
            Self::Directional { .. } => None,
        }
    }

    /// Returns the direction in which the light travels, unit length; `None` for lights that shine in all directions.
    #[must_use]
    pub fn direction(&self) -> Option<Vec3> {
        match *self {
            Self::Directional { direction } | Self::Spot { direction, .. } => Some(direction),
            Self::Point { .. } => None,
        }
    }

    /// Returns the inner and the outer angle of a cone of light, degrees from its axis.
    #[must_use]
    pub fn cone_angles(&self) -> Option<[f32; 2]> {
        match *self {
            Self::Spot { inner_angle, outer_angle, .. } => Some([inner_angle, outer_angle]),
            Self::Point { .. } | Self::Directional { .. } => None,
        }
    }
}
