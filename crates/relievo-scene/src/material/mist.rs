use relievo_march::{Medium, Shadow, Technique, henyey_greenstein};
use thiserror::Error;

use super::{Edge, Material, SurfaceTechnique};

/// A medium that fills a relief from its surface down to its floor: the `[materials.NAME.mist]` table.
///
/// The material's base colour is the share of the extinguished light that is scattered, the albedo.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mist {
    /// Extinction per scene unit, where the mist is full; 0 or more.
    pub density: f32,
    /// Depth below the surface, as a fraction of the relief's depth, over which the density grows from 0; 0 to 1, 0 = a hard surface.
    pub softness: f32,
    /// Mean cosine of the angle by which light is scattered, g of Henyey and Greenstein; in (−1, 1), 0 = evenly, above 0 forwards.
    pub anisotropy: f32,
    /// Points along a ray at which arriving light is looked at; 1 to [`Mist::MAX_STEPS`].
    pub steps: u32,
}

impl Default for Mist {
    fn default() -> Self {
        Self { density: 1.0, softness: 0.1, anisotropy: 0.0, steps: 16 }
    }
}

impl Mist {
    /// Most points along a ray.
    pub const MAX_STEPS: u32 = 64;

    /// Returns the medium that is marched; distances are in scene units.
    #[must_use]
    pub fn medium(&self) -> Medium {
        Medium { density: self.density, softness: self.softness }
    }

    /// Returns the share of scattered light, per steradian, that leaves at this cosine from its way before.
    #[inline]
    #[must_use]
    pub fn phase(&self, cos: f32) -> f32 {
        henyey_greenstein(cos, self.anisotropy)
    }
}

/// Reason why a material cannot be mist.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MistError {
    /// A number is out of its range or none.
    #[error("its {key} is {value}; it must be {expected}")]
    Number {
        /// Key of the scene file.
        key: &'static str,
        /// Value found.
        value: f32,
        /// Range, in words.
        expected: &'static str,
    },
    /// There is no surface that the mist begins at.
    #[error("it has no height map, from which mist fills the relief down; name one")]
    NoHeights,
    /// The technique does not find all crossings.
    #[error("its technique is \"{}\"; mist is marched by \"exact\" alone, which finds every way in and out", technique.name())]
    Technique {
        /// Technique found.
        technique: SurfaceTechnique,
    },
    /// The shadow is one of the tutorials'.
    #[error("its shadow is \"{}\"; mist has \"exact\" shadows or \"none\"", shadow.name())]
    Shadow {
        /// Shadow found.
        shadow: Shadow,
    },
    /// The edge is not that of the mesh.
    #[error("its edge is \"{}\"; mist ends where its mesh does: \"clip\", or leave it out", edge.name())]
    Edge {
        /// Edge found.
        edge: Edge,
    },
    /// Level of detail is asked for.
    #[error("it has lod = true; mist is marched in its full-size map, leave lod out")]
    LevelOfDetail,
    /// The mesh is not flat.
    #[error("its mesh is not flat with one even texture; use a quad or a plane for mist")]
    NotFlat,
    /// The mesh has an outline of too many corners.
    #[error("its mesh has an outline of {corners} corners; mist takes at most {max}", max = crate::MistVolume::MAX_CORNERS)]
    Outline {
        /// Corners found.
        corners: usize,
    },
}

impl Material {
    /// Returns true if the relief is a medium, not a surface.
    #[must_use]
    pub fn is_mist(&self) -> bool {
        self.mist.is_some()
    }

    /// Checks all that mist asks of its material; any other material passes.
    ///
    /// # Errors
    /// The first promise that does not hold.
    pub fn check_mist(&self) -> Result<(), MistError> {
        let Some(mist) = &self.mist else { return Ok(()) };
        let number = |key, value: f32, ok: bool, expected| {
            if ok { Ok(()) } else { Err(MistError::Number { key, value, expected }) }
        };
        let Mist { density, softness, anisotropy, steps } = *mist;
        number("density", density, (0.0..=f32::MAX).contains(&density), "a number, 0 or more")?;
        number("softness", softness, (0.0..=1.0).contains(&softness), "a number from 0 to 1")?;
        // Also refuses NaN.
        number("anisotropy", anisotropy, anisotropy.abs() < 1.0, "a number above -1 and below 1")?;
        number("steps", steps as f32, (1..=Mist::MAX_STEPS).contains(&steps), "a whole number from 1 to 64")?;
        let relief = &self.relief;
        let (technique, shadow, edge) = (relief.technique, relief.shadow, relief.edge);
        if technique != SurfaceTechnique::Marched(Technique::Exact) {
            return Err(MistError::Technique { technique });
        }
        if !matches!(shadow, Shadow::None | Shadow::Exact) {
            return Err(MistError::Shadow { shadow });
        }
        if !matches!(edge, Edge::Clip | Edge::Wrap) {
            return Err(MistError::Edge { edge });
        }
        if relief.lod {
            return Err(MistError::LevelOfDetail);
        }
        if self.maps.height.is_none() { Err(MistError::NoHeights) } else { Ok(()) }
    }
}
