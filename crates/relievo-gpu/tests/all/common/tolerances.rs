//! How far CPU and GPU may be apart, all in one place.
//!
//! The two compute the same formulas in f32, but a GPU may divide with an error of 2.5 ulp, fuse a multiplication with an
//! addition, and flush denormals. A ray that passes a crest by less than that takes another crest: such rays are counted,
//! not measured.

/// Hits of a ray that took the same crest, in texels: 512 texels times a few ulp of uv, times the slope at 3°.
pub const UV_TEXELS: f32 = 0.02;

/// Their depth, as a fraction of the full depth.
pub const DEPTH: f32 = 1e-4;

/// Rays that may differ by more (or hit where the other misses), as a fraction of all: they grazed a crest, or a layer's
/// depth stood at the surface's within rounding.
pub const OTHER_CREST: f64 = 0.002;

/// Rays whose cost must be the same to the last fetch, as a fraction of all.
pub const SAME_COST: f64 = 0.99;

/// Shadow factors that count as equal.
pub const SHADOW: f32 = 1e-3;

/// Shadow factors that may differ by more, as a fraction of all.
pub const OTHER_SHADOW: f64 = 0.004;

/// Pictures: the mean absolute difference over all channels in 8-bit steps, and the fraction of pixels that may differ by
/// more than `PICTURE_THRESHOLD` in any channel. The project's own measure for all backends.
pub const PICTURE_MEAN: f64 = 1.0;
pub const PICTURE_OVER: f64 = 0.005;
pub const PICTURE_THRESHOLD: u8 = 8;

/// The distance of a pixel's surface, as a fraction of itself; as many pixels may be off as in a picture.
pub const DEPTH_OF_PIXEL: f32 = 1e-4;

/// Heights that a device makes of a recipe or of layers, in 0..1: noise adds up to fourteen octaves, of which the CPU rounds
/// places along a row otherwise (`a_row_equals_its_points` of relievo-make allows 1e-4).
pub const MADE_HEIGHTS: f32 = 2e-4;
