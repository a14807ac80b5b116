//! Figures of a sweep, as its files hold them.

use serde::{Deserialize, Serialize};

use crate::metric::RayHitErrors;

/// Hit errors and costs of one technique at one angle and depth.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct HitRow {
    /// The material's name.
    pub material: String,
    /// `cpu` or `gpu`.
    pub backend: String,
    /// The technique with its settings.
    pub technique: String,
    /// The full depth, in texels of the full-size map.
    pub depth_texels: f32,
    /// Texels per pixel: the mip level that is marched is its binary logarithm.
    pub minification: u32,
    /// Angle in degrees from the normal.
    pub angle: f32,
    /// Errors and costs.
    pub hits: RayHitErrors,
    /// Mean fetches of a ray that are filtered samples (four heights, bilinear weights).
    pub samples: f64,
    /// Mean fetches of a ray that are gathers of a cell's four corners.
    pub gathers: f64,
    /// Mean fetches of a ray that are nodes of the max pyramid or cones (16 bytes or less).
    pub nodes: f64,
    /// Nanoseconds per ray: on one thread of the CPU, or of a whole dispatch on the GPU.
    pub ns_per_ray: f64,
    /// Milliseconds to build the structures that it needs beside the heights.
    pub build_ms: f64,
    /// Bytes of the heights (4 per texel) and of the structures built from them.
    pub bytes: u64,
}

/// Image error of one technique's picture.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PictureRow {
    /// The material's name.
    pub material: String,
    /// The technique with its settings.
    pub technique: String,
    /// The full depth, in texels.
    pub depth_texels: f32,
    /// Texels per pixel across the view.
    pub minification: u32,
    /// Angle in degrees from the normal.
    pub angle: f32,
    /// True if the mip level that fits the pixel was marched.
    pub lod: bool,
    /// Mean FLIP, 0 to 1.
    pub flip: f64,
    /// PSNR in decibels; `null` where the pictures are equal.
    pub psnr_db: Option<f64>,
    /// File of the picture, relative to the results' folder.
    pub picture: String,
    /// File of the map of hit errors: black 0, white 8 texels and more.
    pub hits: Option<String>,
    /// File of the truth.
    pub truth: String,
    /// Description of the truth.
    pub truth_is: String,
    /// Samples per pixel.
    pub samples: u32,
    /// Samples per pixel of the truth.
    pub truth_samples: u32,
}

/// A material of a sweep.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MaterialRow {
    /// The material's name.
    pub name: String,
    /// Description of its origin.
    pub source: String,
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Mean height, 0 to 1: solid reliefs lie high.
    pub mean_height: f64,
}

/// The machine of a sweep.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// The processor.
    pub cpu: String,
    /// Number of threads.
    pub threads: usize,
    /// The GPU's adapter, interface and driver, where one was measured.
    pub adapter: Option<String>,
    /// The operating system.
    pub system: String,
}

/// All figures of a sweep.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// The version of this crate.
    pub relievo: String,
    /// The machine.
    pub machine: Machine,
    /// Terms with their definitions.
    pub definitions: Vec<(String, String)>,
    /// Materials, in the order of the sweep.
    pub materials: Vec<MaterialRow>,
    /// Hit errors and costs.
    pub hits: Vec<HitRow>,
    /// Image errors.
    pub pictures: Vec<PictureRow>,
}

/// Definitions of the terms in the results.
pub(crate) const DEFINITIONS: [(&str, &str); 13] = [
    (
        "fetch",
        "one look-up in a map. A filtered sample: four heights with bilinear weights. A gather: the four corners of a cell \
         without weights. A node: 16 maxima of the pyramid in 16 bytes. The layered techniques take samples, exact takes \
         nodes and gathers, exact:cells gathers alone",
    ),
    ("wrong", "fraction of rays whose hit is more than a texel of uv from the oracle's, or that hit nothing"),
    (
        "false_skips",
        "fraction of rays that go on for more than a texel of way after the first surface, or hit nothing: they went \
         through something",
    ),
    (
        "false_stops",
        "fraction of rays that stop more than a texel of way before the first surface: they hit what is not there",
    ),
    (
        "grazing",
        "rays that touch a crest so closely that the rounding of f32 decides whether they pass; they count as right where \
         they end at either surface",
    ),
    ("texels", "distance in uv from the oracle's hit, in texels of the map that is marched"),
    (
        "pixels",
        "the same in pixels of one texel: what lies along the view is shortened by the angle's cosine, as the screen does",
    ),
    ("depth", "difference in depth from the oracle's hit, in texels"),
    ("normal", "angle between the bilinear surface's normals at both hits, in degrees"),
    ("divergence", "loop turns of the slowest ray of an 8×4 tile over the tile's mean, the mean of all tiles"),
    (
        "minification",
        "texels per pixel. Rays march the mip level of that size and are judged against its surface; pictures are judged \
         against the full-size one",
    ),
    ("ns_per_ray", "on one thread of the CPU, the best round; on a GPU the time of a dispatch over its rays"),
    ("flip", "mean FLIP of the picture, 0 equal to 1: what an eye would notice (Andersson et al. 2020)"),
];
