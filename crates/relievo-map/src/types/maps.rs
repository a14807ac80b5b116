//! Height, normal and scalar maps, and the set of maps of one material.

use super::color::ColorMap;
use super::grid::{Grid, GridId};

/// A height map: height above the deepest point, f32 in [0, 1], 1 = highest whatever the file's convention.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    grid: Grid<f32>,
}

impl HeightMap {
    /// Creates a height map from heights, 1 = highest. Values outside [0, 1] are clamped; NaN becomes 0.
    #[must_use]
    pub fn new(mut grid: Grid<f32>) -> Self {
        for h in grid.texels_mut() {
            // `max` first: it also turns NaN into 0.
            *h = h.max(0.0).min(1.0);
        }
        Self { grid }
    }

    /// The heights.
    #[inline]
    #[must_use]
    pub fn grid(&self) -> &Grid<f32> {
        &self.grid
    }

    /// Returns the heights as a grid of their own.
    #[must_use]
    pub fn into_grid(self) -> Grid<f32> {
        self.grid
    }

    /// True if every height is a multiple of 1/255, as in maps from 8-bit files.
    #[must_use]
    pub fn is_8_bit(&self) -> bool {
        // Far below the step of a 16-bit file, far above the rounding of f32.
        self.grid.texels().iter().all(|h| ((h * 255.0).round() - h * 255.0).abs() < 1e-4)
    }
}

/// Tangent-space normals: x along +u, y *up* in the picture (OpenGL and glTF), z out of the surface.
///
/// Components are in [-1, 1] as decoded from the file, not normalised: filter first, normalise last.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalMap {
    grid: Grid<[f32; 3]>,
}

impl NormalMap {
    /// Creates a normal map from vectors with +Y up. Components outside [-1, 1] are clamped; a vector with a NaN
    /// becomes (0, 0, 1).
    #[must_use]
    pub fn new(grid: Grid<[f32; 3]>) -> Self {
        Self::from_unit(Self::from_decoded(grid).grid)
    }

    /// Creates a normal map from stored normals as they were decoded: as [`NormalMap::new`], but −0 stays −0.
    pub(crate) fn from_decoded(mut grid: Grid<[f32; 3]>) -> Self {
        for n in grid.texels_mut() {
            *n = if n.iter().any(|c| c.is_nan()) { [0.0, 0.0, 1.0] } else { n.map(|c| c.clamp(-1.0, 1.0)) };
        }
        Self { grid }
    }

    /// Creates a normal map from vectors that are known to be finite and of unit length.
    pub(crate) fn from_unit(mut grid: Grid<[f32; 3]>) -> Self {
        for c in grid.texels_mut().iter_mut().flatten() {
            // What was computed as −0 is written as the neutral 128, not as 127.
            *c += 0.0;
        }
        Self { grid }
    }

    /// The normals.
    #[inline]
    #[must_use]
    pub fn grid(&self) -> &Grid<[f32; 3]> {
        &self.grid
    }

    /// Decodes a stored 8-bit component to [-1, 1]: 0 is −1, 127 and 128 are both 0, 255 is 1.
    ///
    /// `2x/255 − 1` has no zero: (128, 128, 255), which painters call flat, would lean by a third of a degree, to
    /// opposite sides where a chart is mirrored. 127 is −0, so that its byte comes back.
    ///
    /// The inverse of [`NormalMap::encode8`]: every 8-bit normal in Relievo passes through these two, so that round
    /// trips give the same bytes.
    #[inline]
    #[must_use]
    pub fn decode8(x: u8) -> f32 {
        if x >= 128 { f32::from(x - 128) / 127.0 } else { -f32::from(127 - x) / 127.0 }
    }

    /// Encodes a component in [-1, 1] in 8 bits: the nearest x of [`NormalMap::decode8`]; 0 is 128.
    #[inline]
    #[must_use]
    pub fn encode8(n: f32) -> u8 {
        let zero = if n.is_sign_negative() { 127.5 } else { 128.5 };
        (n.clamp(-1.0, 1.0) * 127.0 + zero) as u8
    }

    /// Decodes a stored 16-bit component to [-1, 1] as [`NormalMap::decode8`] does: 32767 and 32768 are both 0.
    #[inline]
    #[must_use]
    pub fn decode16(x: u16) -> f32 {
        if x >= 32768 { f32::from(x - 32768) / 32767.0 } else { -f32::from(32767 - x) / 32767.0 }
    }

    /// Encodes a component in [-1, 1] in 16 bits: the nearest x of [`NormalMap::decode16`]; 0 is 32768.
    #[inline]
    #[must_use]
    pub fn encode16(n: f32) -> u16 {
        let zero = if n.is_sign_negative() { 32767.5 } else { 32768.5 };
        (n.clamp(-1.0, 1.0) * 32767.0 + zero) as u16
    }
}

/// A scalar map, one number per texel in [0, 1]: roughness, metallic, ambient occlusion.
#[derive(Clone, Debug, PartialEq)]
pub struct ScalarMap {
    grid: Grid<f32>,
}

impl ScalarMap {
    /// Creates a scalar map from values. Values outside [0, 1] are clamped; NaN becomes 0.
    #[must_use]
    pub fn new(grid: Grid<f32>) -> Self {
        // The same rule as for heights.
        Self { grid: HeightMap::new(grid).grid }
    }

    /// Returns the values as a grid of their own.
    #[must_use]
    pub fn into_grid(self) -> Grid<f32> {
        self.grid
    }

    /// The values.
    #[inline]
    #[must_use]
    pub fn grid(&self) -> &Grid<f32> {
        &self.grid
    }
}

/// The maps of one material. Maps may differ in size; each covers one texture repeat.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapSet {
    /// Base colour (albedo).
    pub base_color: Option<ColorMap>,
    /// Tangent-space normals.
    pub normal: Option<NormalMap>,
    /// Heights.
    pub height: Option<HeightMap>,
    /// Perceptual roughness: 0 mirror, 1 matt.
    pub roughness: Option<ScalarMap>,
    /// Metallic: 0 dielectric, 1 metal.
    pub metallic: Option<ScalarMap>,
    /// Ambient occlusion: 1 open, 0 closed.
    pub ao: Option<ScalarMap>,
}

impl MapSet {
    /// Identities of the maps, in the order of the fields: the same for a set whose maps are all the same.
    #[must_use]
    pub fn ids(&self) -> [Option<GridId>; 6] {
        [
            self.base_color.as_ref().map(|map| map.grid.id()),
            self.normal.as_ref().map(|map| map.grid().id()),
            self.height.as_ref().map(|map| map.grid().id()),
            self.roughness.as_ref().map(|map| map.grid().id()),
            self.metallic.as_ref().map(|map| map.grid().id()),
            self.ao.as_ref().map(|map| map.grid().id()),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eight_and_sixteen_bit_normals_survive_round_trips_and_neutral_is_128() {
        assert_eq!(NormalMap::encode8(0.0), 128);
        for x in 0..=255 {
            assert_eq!(NormalMap::encode8(NormalMap::decode8(x)), x);
        }
        for x in 0..=65535 {
            assert_eq!(NormalMap::encode16(NormalMap::decode16(x)), x);
        }
    }

    #[test]
    fn stored_normals_have_a_zero_and_mirror_about_it() {
        assert_eq!([0, 127, 128, 255].map(NormalMap::decode8), [-1.0, 0.0, 0.0, 1.0]);
        assert_eq!([0, 32767, 32768, 65535].map(NormalMap::decode16), [-1.0, 0.0, 0.0, 1.0]);
        assert!((0..=255).all(|x| NormalMap::decode8(x) == -NormalMap::decode8(255 - x)));
        assert!((0..=65535).all(|x| NormalMap::decode16(x) == -NormalMap::decode16(65535 - x)));
        assert_eq!(
            [-1.0, -0.4 / 127.0, 0.4 / 127.0, 0.6 / 127.0, 1.0].map(NormalMap::encode8),
            [0, 127, 128, 129, 255]
        );
        // Not by way of −0.
        assert_eq!(
            NormalMap::new(Grid::new(1, 1, vec![[-0.0; 3]]).unwrap()).grid().get(0, 0).map(NormalMap::encode8),
            [128; 3]
        );
    }

    #[test]
    fn nan_and_out_of_range_values_are_tamed() {
        let height = HeightMap::new(Grid::new(4, 1, vec![f32::NAN, -1.0, 2.0, 0.25]).unwrap());
        assert_eq!(height.grid().texels(), [0.0, 0.0, 1.0, 0.25]);
        let normal = NormalMap::new(Grid::new(1, 1, vec![[0.0, f32::NAN, 3.0]]).unwrap());
        assert_eq!(normal.grid().texels(), [[0.0, 0.0, 1.0]]);
    }

    #[test]
    fn heights_from_8_bit_files_are_known_by_their_steps() {
        let steps = Grid::from_fn(256, 1, |x, _| x as f32 / 255.0);
        assert!(HeightMap::new(steps.clone()).is_8_bit());
        assert!(HeightMap::new(steps.map(|h| 1.0 - h)).is_8_bit());
        assert!(!HeightMap::new(Grid::new(1, 1, vec![1.0 / 65535.0]).unwrap()).is_8_bit());
    }
}
