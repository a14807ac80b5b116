//! Materials: maps, factors, and how their relief is drawn.

mod changing_heights;
mod mist;
mod relief;
mod side;
mod technique;
mod uv_transform;

use relievo_map::{HeightMap, MapSet, MipMap, Wrap};
use relievo_march::{ReliefMap, Technique};

use crate::ColorSpace;
pub use changing_heights::ChangingHeights;
pub use mist::{Mist, MistError};
pub use relief::{Edge, Offset, Relief};
pub use side::Side;
pub use technique::SurfaceTechnique;
pub use uv_transform::UvTransform;

/// A surface material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the scene file.
    pub name: String,
    /// The maps; any may be missing.
    pub maps: MapSet,
    /// Heights that change in the course of time, at this moment; the height map is that of this moment, if
    /// [`Material::heights_are_made`].
    pub changing_heights: Option<ChangingHeights>,
    /// True if the height map is that of the moment of [`Material::changing_heights`]; else a renderer has to make it.
    pub heights_are_made: bool,
    /// Factor on the base colour, linear RGB (the colour itself where there is no map).
    pub base_color: [f32; 3],
    /// Factor on the roughness map (the roughness itself where there is no map), 0..1.
    pub roughness: f32,
    /// Factor on the metallic map (the value itself where there is no map), 0..1.
    pub metallic: f32,
    /// Distance between height 0 and height 1.
    pub height: HeightRange,
    /// Height that lies on the polygon: 1 = the relief lies wholly below it, 0 = wholly above.
    pub midlevel: f32,
    /// Filter of the maps; [`Relief::lod`] filters by mip level whatever this is.
    pub filter: Filter,
    /// Addressing mode of the maps.
    pub wrap: Wrap,
    /// Map from the mesh's texture coordinates, times the object's repeats, to the maps'.
    pub uv: UvTransform,
    /// Part of an atlas, u0, v0, u1, v1 in the maps' own uv: there `clip` and `clamp` end, instead of at the mesh's range.
    pub uv_rect: Option<[f32; 4]>,
    /// True if the relief is visible from both sides; `None` where nothing is said: then glTF materials that it replaces may.
    pub two_sided: Option<bool>,
    /// Settings of the relief.
    pub relief: Relief,
    /// The medium that the relief is, if it is no surface: `kind = "mist"`.
    pub mist: Option<Mist>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            name: "default".to_owned(),
            maps: MapSet::default(),
            changing_heights: None,
            heights_are_made: true,
            base_color: [1.0; 3],
            roughness: 1.0,
            metallic: 0.0,
            height: HeightRange::default(),
            midlevel: 1.0,
            filter: Filter::default(),
            wrap: Wrap::default(),
            uv: UvTransform::default(),
            uv_rect: None,
            two_sided: None,
            relief: Relief::default(),
            mist: None,
        }
    }
}

impl Material {
    /// Returns plain grey without maps: for mesh files that bring no material.
    #[must_use]
    pub fn grey() -> Self {
        Self {
            name: "grey".to_owned(),
            base_color: [0.5; 3],
            relief: Relief { technique: SurfaceTechnique::Marched(Technique::Normal), ..Relief::default() },
            ..Self::default()
        }
    }
}

impl Material {
    /// Returns the height map ready for marching, if there is one: with mip levels for `lod`, with cones for `cone`, and
    /// filtered as `space` asks.
    #[must_use]
    pub fn heights(&self, space: ColorSpace) -> Option<ReliefMap> {
        self.side_heights(Side::Front, space)
    }

    fn relief_map(&self, map: &HeightMap, space: ColorSpace) -> ReliefMap {
        let changes = self.changing_heights.is_some();
        let heights = match (self.is_nearest(), changes) {
            (true, true) => ReliefMap::nearest_of_changing(map),
            (true, false) => ReliefMap::nearest(map),
            (false, true) => ReliefMap::of_changing(map, self.relief.lod),
            (false, false) if self.relief.lod => ReliefMap::with_mips(map),
            (false, false) => ReliefMap::new(map),
        };
        let heights = match self.relief.needed_cones() {
            Some(cones) => heights.with_cones(cones),
            None => heights,
        };
        // `display` is the tutorials' world, down to how their OpenGL filtered 8-bit maps.
        let eight_bit = space == ColorSpace::Display && !changes && map.is_8_bit();
        if eight_bit { heights.filtered_in_8_bits() } else { heights }
    }

    /// Returns a note if a silhouette is asked for that the technique does not have.
    pub(crate) fn note_on_silhouette(&self) -> Option<String> {
        let technique = self.relief.technique.marched().filter(|technique| *technique != Technique::Exact)?;
        (self.relief.edge == Edge::Silhouette).then(|| {
            let (name, technique) = (&self.name, technique.name());
            format!(
                "material \"{name}\": edge = \"silhouette\" is for technique = \"exact\"; \"{technique}\" draws it as \"wrap\""
            )
        })
    }

    /// Returns true if the maps' nearest texels are taken.
    #[must_use]
    pub fn is_nearest(&self) -> bool {
        self.filter == Filter::Nearest && !self.relief.lod
    }

    /// Returns true if the maps are sampled by mip level.
    #[must_use]
    pub fn has_levels(&self) -> bool {
        self.filter == Filter::Trilinear || self.relief.lod
    }

    /// Returns the scatter of the height map's slopes within a texel of each level: for `lod` where there is no normal map.
    #[must_use]
    pub fn slope_scatter(&self) -> Option<MipMap<[f32; 3]>> {
        let heights = self.maps.height.as_ref().filter(|_| self.relief.lod && self.maps.normal.is_none())?;
        Some(heights.slope_covariance_mips(self.wrap))
    }
}

/// The distance between height 0 and height 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HeightRange {
    /// `height_scale`: as a fraction of one texture repeat along u.
    Scale(f32),
    /// `depth`: in object units.
    Depth(f32),
}

impl Default for HeightRange {
    fn default() -> Self {
        Self::Scale(0.1)
    }
}

/// Filters of maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Filter {
    /// Bilinear, in the full-size map.
    #[default]
    Linear,
    /// Bilinear in two mip levels, blended; the level from the gradients of the base uv.
    Trilinear,
    /// The nearest texel, in the full-size map: the height map's texels are columns with flat tops. Not with [`Relief::lod`].
    Nearest,
}
