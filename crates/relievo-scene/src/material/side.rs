use relievo_map::HeightMap;
use relievo_march::ReliefMap;

use super::Material;
use crate::ColorSpace;

/// The sides of a relief. Seen from behind it is the same surface from below: a relief of its own, with heights turned
/// upside down, below a mesh whose normals are turned round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// The side that normals point to.
    Front,
    /// The other one.
    Back,
}

impl Side {
    /// Returns the height that lies on the polygon, seen from this side.
    #[must_use]
    pub fn midlevel(self, midlevel: f32) -> f32 {
        match self {
            Self::Front => midlevel,
            Self::Back => 1.0 - midlevel,
        }
    }

    /// Returns the factor on x and y of a normal map's normals: the back's normal is the front's turned round, and its frame
    /// has the front's tangent and bitangent.
    #[must_use]
    pub fn normal_sign(self) -> f32 {
        match self {
            Self::Front => 1.0,
            Self::Back => -1.0,
        }
    }
}

impl Material {
    /// Returns true if the relief is visible from both sides.
    #[must_use]
    pub fn is_two_sided(&self) -> bool {
        self.two_sided.unwrap_or(false)
    }

    /// Returns true if the back of the relief has to be marched: displaced geometry, flat surfaces and mist have two sides anyway.
    #[must_use]
    pub fn has_marched_back(&self) -> bool {
        self.is_two_sided()
            && !self.is_mist()
            && self.maps.height.is_some()
            && self.relief.technique.marched().is_some()
    }

    /// Returns the height map of a side ready for marching, as [`Material::heights`] does.
    #[must_use]
    pub fn side_heights(&self, side: Side, space: ColorSpace) -> Option<ReliefMap> {
        let map = self.maps.height.as_ref()?;
        Some(match side {
            Side::Front => self.relief_map(map, space),
            Side::Back => self.relief_map(&HeightMap::new(map.grid().map(|h| 1.0 - h)), space),
        })
    }
}
