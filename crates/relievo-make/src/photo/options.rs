//! Options of making heights of a photograph.

use relievo_map::{
    Border, DerivativeKernel, HeightMap, NormalMap, OcclusionOptions, ScalarMap, Wrap, ambient_occlusion,
    height_to_normal,
};

/// Number of bands, from fine to coarse: the first is the difference from a blur of 1/1024 of the picture's width, each
/// other one the difference between that blur and one twice as wide.
pub const BANDS: usize = 7;

/// A colour of the photograph, all of which lies higher or lower than the rest: mortar, paint, moss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorPick {
    /// Display (sRGB) colour, 0..1.
    pub color: [f32; 3],
    /// Offset, as a fraction of the range of heights; negative lowers.
    pub offset: f32,
    /// Tolerated difference of colours, in units of CIE Lab (1: hardly seen, 10: akin, 100: black to white). Lightness
    /// counts half.
    pub tolerance: f32,
}

/// Directional light in the photograph.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideLight {
    /// Direction to the light, in degrees: 0 right, 90 above, 180 left, 270 below.
    pub angle: f32,
    /// Weight of the heights from shading, as a standard deviation: 1 weighs as much as a band of weight 1.
    pub weight: f32,
}

/// Addressing beyond the photograph's border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum PhotoEdge {
    /// The photograph ends there.
    #[default]
    Open,
    /// The photograph tiles as it is.
    Tiles,
    /// The photograph is made to tile: the jumps at the border are spread smoothly over all of it.
    MakeTile,
}

/// Options of [`from_photo`](crate::from_photo).
#[derive(Clone, Debug, PartialEq)]
pub struct PhotoOptions {
    /// Light changes that are wider than this (standard deviation, as a fraction of the width) are taken as uneven
    /// lighting and removed; 0 keeps them.
    pub flatten: f32,
    /// Weights of the bands of light, fine to coarse: positive where dark is deep.
    pub light: [f32; BANDS],
    /// Weights of the bands of saturation: positive where grey is deep, as mortar between bricks.
    pub saturation: [f32; BANDS],
    /// True if only texels darker than their surroundings count: cracks on a plain.
    pub dark_only: bool,
    /// Light from one side, whose shading is integrated to heights.
    pub side_light: Option<SideLight>,
    /// Colours that lie higher or lower.
    pub picks: Vec<ColorPick>,
    /// Mask of the photograph's size: where it is 0, the height is plain.
    pub mask: Option<ScalarMap>,
    /// Radius of the smoothing that keeps edges, as a fraction of the width; 0 leaves the heights as they are.
    pub clean: f32,
    /// The shares of texels, in percent, that become 0 and 1.
    pub levels: [f32; 2],
    /// Addressing beyond the border.
    pub edge: PhotoEdge,
    /// The full range of heights as a fraction of one repeat, for normals and ambient occlusion.
    pub height_scale: f32,
    /// The mean roughness.
    pub roughness: f32,
}

impl PhotoOptions {
    /// Derives normals (+Y up) from heights that were made with these options.
    #[must_use]
    pub fn normal(&self, height: &HeightMap) -> NormalMap {
        height_to_normal(height, self.height_scale, DerivativeKernel::Central, self.border())
    }

    /// Derives ambient occlusion from heights that were made with these options.
    #[must_use]
    pub fn ao(&self, height: &HeightMap) -> ScalarMap {
        let (height_scale, border) = (self.height_scale, self.border());
        ambient_occlusion(height, &OcclusionOptions { height_scale, border, ..OcclusionOptions::default() })
    }

    pub(super) fn wrap(&self) -> Wrap {
        if self.edge == PhotoEdge::Open { Wrap::Mirror } else { Wrap::Repeat }
    }

    pub(super) fn border(&self) -> Border {
        if self.edge == PhotoEdge::Open { Border::Open } else { Border::Wrap }
    }
}
