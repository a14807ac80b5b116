use serde::Serialize;

use crate::Candidate;

/// What a sweep measures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepOptions {
    /// Degrees from the normal, 0 to below 90.
    pub angles: Vec<f32>,
    /// Full depths, in texels.
    pub depths: Vec<f32>,
    /// Texels per pixel, powers of two: 1 marches the full-size map.
    pub minifications: Vec<u32>,
    /// Techniques with their settings.
    pub candidates: Vec<Candidate>,
    /// Rays per angle, depth and minification; rounded up to tiles of 32.
    pub rays: u32,
    /// How often each march is timed; the best round counts.
    pub rounds: u32,
    /// What is drawn; `None`: nothing.
    pub pictures: Option<PictureOptions>,
}

/// What a sweep draws.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PictureOptions {
    /// Pixels.
    pub size: [u32; 2],
    /// Samples per pixel where a texel has a pixel of its own.
    pub samples: u32,
    /// Degrees from the normal, 0 to 85.
    pub angles: Vec<f32>,
    /// Full depths, in texels.
    pub depths: Vec<f32>,
    /// Texels per pixel: 1 against displaced geometry, more against the oracle with many samples.
    pub minifications: Vec<u32>,
    /// Techniques with their settings.
    pub candidates: Vec<Candidate>,
}

impl SweepOptions {
    /// A minute or less per material: few angles, one depth, default settings.
    #[must_use]
    pub fn quick() -> Self {
        Self {
            angles: vec![0.0, 60.0, 82.0],
            depths: vec![25.0],
            minifications: vec![1],
            candidates: Candidate::quick(),
            rays: 1024,
            rounds: 2,
            pictures: Some(PictureOptions {
                size: [96, 72],
                angles: vec![75.0],
                minifications: vec![1],
                ..PictureOptions::default()
            }),
        }
    }

    /// For an evening: every angle up to 89°, six depths, distances up to 16 texels per pixel.
    #[must_use]
    pub fn full() -> Self {
        Self {
            angles: vec![0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 75.0, 80.0, 82.0, 85.0, 87.0, 88.5, 89.0],
            depths: vec![1.0, 3.0, 10.0, 25.0, 50.0, 100.0],
            minifications: vec![1, 4, 16],
            rays: 16384,
            rounds: 5,
            pictures: Some(PictureOptions {
                size: [320, 240],
                angles: vec![0.0, 45.0, 60.0, 75.0, 80.0],
                depths: vec![5.0, 25.0],
                minifications: vec![1, 4, 16],
                ..PictureOptions::default()
            }),
            ..Self::default()
        }
    }
}

impl Default for SweepOptions {
    /// A few seconds per material on two cores.
    fn default() -> Self {
        Self {
            angles: vec![0.0, 30.0, 45.0, 60.0, 75.0, 82.0, 88.5],
            depths: vec![5.0, 25.0, 100.0],
            minifications: vec![1, 8],
            candidates: Candidate::standard(),
            rays: 2048,
            rounds: 3,
            pictures: Some(PictureOptions::default()),
        }
    }
}

impl Default for PictureOptions {
    fn default() -> Self {
        let quick = Candidate::quick().into_iter().filter(|candidate| !candidate.is_cell_by_cell());
        Self {
            size: [128, 96],
            samples: 4,
            angles: vec![45.0, 75.0],
            depths: vec![25.0],
            minifications: vec![1, 8],
            candidates: quick.collect(),
        }
    }
}
