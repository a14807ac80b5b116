use serde::Serialize;

use crate::error::LabError;
use crate::technique::ResolvedTechnique;

/// Options of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepOptions {
    /// Angles in degrees from the normal, 0 to below 90.
    pub angles: Vec<f32>,
    /// Full depths of the relief, in texels.
    pub depths: Vec<f32>,
    /// Texels per pixel, powers of two: 1 marches the full-size map.
    pub minifications: Vec<u32>,
    /// Techniques with all settings.
    pub techniques: Vec<ResolvedTechnique>,
    /// Rays per angle, depth and minification; rounded up to tiles of 32.
    pub rays: u32,
    /// Rounds in which each march is timed; the best counts.
    pub rounds: u32,
    /// Pictures; `None`: none are drawn.
    pub pictures: Option<PictureOptions>,
}

/// Options of a sweep's pictures.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PictureOptions {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel at one texel per pixel.
    pub samples: u32,
    /// Angles in degrees from the normal, 0 to 85.
    pub angles: Vec<f32>,
    /// Full depths of the relief, in texels.
    pub depths: Vec<f32>,
    /// Texels per pixel: 1 against displaced geometry, more against the oracle with many samples.
    pub minifications: Vec<u32>,
    /// Techniques with all settings.
    pub techniques: Vec<ResolvedTechnique>,
}

impl SweepOptions {
    /// Options for a minute or less per material: few angles, one depth, default settings.
    #[must_use]
    pub fn quick() -> Self {
        Self {
            angles: vec![0.0, 60.0, 82.0],
            depths: vec![25.0],
            minifications: vec![1],
            techniques: ResolvedTechnique::quick(),
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

    /// Options for hours: every angle up to 89°, six depths, distances up to 16 texels per pixel.
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

    /// Checks the ranges.
    ///
    /// # Errors
    /// If a list is empty, or a number outside its range.
    pub fn check(&self) -> Result<(), LabError> {
        let refused = |text: String| Err(LabError::Options(text));
        let pictures = self.pictures.as_ref();
        let angles = self.angles.iter().map(|&angle| (angle, 89.9));
        let tilts = pictures.iter().flat_map(|p| p.angles.iter().map(|&angle| (angle, 85.0)));
        if let Some((angle, most)) = angles.chain(tilts).find(|(angle, most)| !(0.0..=*most).contains(angle)) {
            return refused(format!("an angle of {angle}° cannot be measured: it must be 0 to {most}"));
        }
        let depths = || self.depths.iter().chain(pictures.iter().flat_map(|p| &p.depths));
        if let Some(depth) = depths().find(|depth| !(0.01..=1000.0).contains(*depth)) {
            return refused(format!("a depth of {depth} texels cannot be measured: it must be 0.01 to 1000"));
        }
        let minifications = || self.minifications.iter().chain(pictures.iter().flat_map(|p| &p.minifications));
        if let Some(n) = minifications().find(|n| !n.is_power_of_two() || **n > 1 << 10) {
            return refused(format!("{n} texels per pixel cannot be measured: it must be a power of two up to 1024"));
        }
        if self.techniques.is_empty()
            || self.angles.is_empty()
            || self.depths.is_empty()
            || self.minifications.is_empty()
        {
            return refused("there is nothing to measure: no technique, angle, depth or minification".to_owned());
        }
        if !(1..=1 << 22).contains(&self.rays) || !(1..=1000).contains(&self.rounds) {
            return refused("rays must be 1 to 4194304, rounds 1 to 1000".to_owned());
        }
        Ok(())
    }
}

impl Default for SweepOptions {
    /// Options for a few seconds per material on two cores.
    fn default() -> Self {
        Self {
            angles: vec![0.0, 30.0, 45.0, 60.0, 75.0, 82.0, 88.5],
            depths: vec![5.0, 25.0, 100.0],
            minifications: vec![1, 8],
            techniques: ResolvedTechnique::standard(),
            rays: 2048,
            rounds: 3,
            pictures: Some(PictureOptions::default()),
        }
    }
}

impl Default for PictureOptions {
    fn default() -> Self {
        let quick = ResolvedTechnique::quick().into_iter().filter(|technique| !technique.is_cell_by_cell());
        Self {
            size: [128, 96],
            samples: 4,
            angles: vec![45.0, 75.0],
            depths: vec![25.0],
            minifications: vec![1, 8],
            techniques: quick.collect(),
        }
    }
}
