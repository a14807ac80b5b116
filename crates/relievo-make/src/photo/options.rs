//! Options of making heights of a photograph.

use relievo_map::{
    Border, HeightMap, Kernel, NormalMap, OcclusionOptions, ScalarMap, Wrap, ambient_occlusion, height_to_normal,
};

/// Bands from fine to coarse: the first holds what a blur of 1/1024 of the picture's width takes away, each other one what
/// the next blur, twice as wide, takes away beyond that.
pub const BANDS: usize = 7;

/// A colour of the photograph, all of which lies higher or lower than the rest: mortar, paint, moss.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorPick {
    /// Display (sRGB) colour, 0..1.
    pub color: [f32; 3],
    /// By how much of the range of heights it is raised; negative lowers it.
    pub offset: f32,
    /// How different a colour may be, in units of CIE Lab (1: hardly seen, 10: akin, 100: black to white). Lightness
    /// counts half.
    pub tolerance: f32,
}

/// Light that came from one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideLight {
    /// Where it came from, in degrees: 0 right, 90 above, 180 left, 270 below.
    pub angle: f32,
    /// The weight of what the shading tells, as a standard deviation: 1 as much as a band of weight 1.
    pub weight: f32,
}

/// What lies beyond the photograph's border.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PhotoEdge {
    /// It ends there.
    #[default]
    Open,
    /// It tiles as it is.
    Tiles,
    /// It is made to tile: the jumps at the border are spread smoothly over all of it.
    MakeTile,
}

/// How heights are made of a photograph.
#[derive(Clone, Debug, PartialEq)]
pub struct PhotoOptions {
    /// Light changes that are wider than this (standard deviation, as a fraction of the width) are taken as uneven
    /// lighting and removed; 0 keeps them.
    pub flatten: f32,
    /// Weights of the bands of light, fine to coarse: positive where dark is deep.
    pub light: [f32; BANDS],
    /// Weights of the bands of saturation: positive where grey is deep, as mortar between bricks.
    pub saturation: [f32; BANDS],
    /// Only what is darker than its surroundings counts: cracks on a plain.
    pub dark_only: bool,
    /// Shading to slopes to heights.
    pub side_light: Option<SideLight>,
    /// Colours that lie higher or lower.
    pub picks: Vec<ColorPick>,
    /// Where it is 0, the height is plain; of the photograph's size.
    pub mask: Option<ScalarMap>,
    /// Radius of the smoothing that keeps edges, as a fraction of the width; 0 leaves the heights as they are.
    pub clean: f32,
    /// The shares of texels, in percent, that become 0 and 1.
    pub levels: [f32; 2],
    /// What lies beyond the border.
    pub edge: PhotoEdge,
    /// The full range of heights as a fraction of one repeat, for normals and ambient occlusion.
    pub height_scale: f32,
    /// The mean roughness.
    pub roughness: f32,
}

impl PhotoOptions {
    /// Normals (+Y up) of heights that were made with these options.
    #[must_use]
    pub fn normal(&self, height: &HeightMap) -> NormalMap {
        height_to_normal(height, self.height_scale, Kernel::Central, self.border())
    }

    /// Ambient occlusion of heights that were made with these options.
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
