//! Maps out of other maps: normals from heights and back, occlusion, bent normals, curvature.
//!
//! Heights are in [0, 1]; how high that is says `height_scale`, the full range as a fraction of one repeat along u.
//! Texels are taken as square.

mod curvature;
mod integrate;
mod occlusion;
mod periodic;
mod slopes;
mod strips;

pub use curvature::curvature;
pub use integrate::{HeightFromNormal, IntegrateOptions, normal_to_height};
pub use occlusion::{OcclusionOptions, ambient_occlusion, bent_normals};
pub use periodic::periodic;
pub use slopes::height_to_normal;

/// How a slope is measured on texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Kernel {
    /// Half the difference of the two neighbours.
    #[default]
    Central,
    /// The same, averaged over three rows with weights 1 2 1 (Sobel and Feldman 1968): smoother.
    Sobel,
    /// The same with weights 3 10 3 (Scharr 2000): the direction of slopes is nearly right at any angle.
    Scharr,
}

impl Kernel {
    /// All kernels and their names.
    pub const ALL: [(&'static str, Self); 3] =
        [("central", Self::Central), ("sobel", Self::Sobel), ("scharr", Self::Scharr)];

    /// The weight of the rows beside, of 1.
    fn side(self) -> f64 {
        match self {
            Self::Central => 0.0,
            Self::Sobel => 1.0 / 4.0,
            Self::Scharr => 3.0 / 16.0,
        }
    }

    /// What the average over three rows leaves of a wave of `w` radians per texel.
    fn smoothing(self, w: f64) -> f64 {
        1.0 - 2.0 * self.side() * (1.0 - w.cos())
    }
}

/// What lies beyond the border of a map that is measured or converted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Border {
    /// The map tiles.
    #[default]
    Wrap,
    /// Nothing: slopes are one-sided at the border, so that a ramp is a ramp up to its ends.
    Open,
}
