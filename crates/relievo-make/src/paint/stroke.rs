//! Strokes and brushes.

use crate::curve::smoothstep;

/// Cross-section of a stroke, from its middle to its rim.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Profile {
    /// A groove with a round bottom.
    #[default]
    Round,
    /// A groove with a sharp bottom.
    Sharp,
    /// Flat, with a soft rim.
    Flat,
}

impl Profile {
    /// All profiles and their names.
    pub const ALL: [(&'static str, Self); 3] = [("round", Self::Round), ("sharp", Self::Sharp), ("flat", Self::Flat)];

    /// Returns 1 in the middle (`t` 0) and 0 at the rim (`t` 1); up to `hardness` it stays 1.
    pub(super) fn at(self, t: f32, hardness: f32) -> f32 {
        let t = ((t - hardness) / (1.0 - hardness).max(1e-3)).max(0.0);
        match self {
            Self::Round => (1.0 - t * t).max(0.0),
            Self::Sharp => (1.0 - t).max(0.0),
            Self::Flat => 1.0 - smoothstep(0.0, 1.0, t),
        }
    }
}

/// Brush of a stroke. Lengths in uv.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Brush {
    /// Width of the stroke.
    pub width: f32,
    /// Height added in the middle; negative carves.
    pub depth: f32,
    /// Cross-section.
    pub profile: Profile,
    /// Fraction of the half width that is as deep as the middle, 0..1.
    pub hardness: f32,
    /// Greatest random offset of a stroke from its line.
    pub jitter: f32,
    /// True if the ends run out thin and shallow.
    pub taper: bool,
}

impl Default for Brush {
    fn default() -> Self {
        Self { width: 0.01, depth: -0.3, profile: Profile::Round, hardness: 0.0, jitter: 0.0, taper: false }
    }
}

/// A polyline drawn with a brush.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// Points in uv, v down; one is a dot. Points beyond 0..1 lie on the next repeat.
    pub points: Vec<[f32; 2]>,
    /// The brush.
    pub brush: Brush,
}

impl Stroke {
    /// The most points of all strokes of one file together.
    pub const MAX_POINTS: usize = 1 << 20;
    /// The greatest distance of points from the map, in repeats.
    pub const MAX_DISTANCE: f32 = 100.0;
    /// The greatest length of all strokes of one file together, in repeats.
    pub const MAX_LENGTH: f32 = 10_000.0;
    /// The most times that all strokes of one file together may cover the map.
    pub const MAX_COVER: f32 = 1000.0;

    pub(super) fn length(&self) -> f32 {
        self.points.windows(2).map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])).sum()
    }
}

/// Refuses strokes that would take hours to paint, or more memory than there is.
pub(super) fn check_work(strokes: &[Stroke]) -> Result<(), String> {
    let length: f32 = strokes.iter().map(Stroke::length).sum();
    if !(length <= Stroke::MAX_LENGTH) {
        return Err(format!(
            "the strokes are {length:.0} times as long as the map in all; {} times are the most",
            Stroke::MAX_LENGTH
        ));
    }
    let cover = |stroke: &Stroke| {
        let width = stroke.brush.width;
        width * (stroke.length() + width * stroke.points.len() as f32)
    };
    let cover: f32 = strokes.iter().map(cover).sum();
    if !(cover <= Stroke::MAX_COVER) {
        return Err(format!(
            "the strokes cover the map {cover:.0} times over; make them thinner or fewer, {} times are the most",
            Stroke::MAX_COVER
        ));
    }
    Ok(())
}
