use relievo_map::{Grid, HeightMap};

use crate::Random;

/// Generates the height map of a built-in material.
///
/// # Panics
/// If there is no such material, or it has no heights.
#[must_use]
pub fn generated(name: &str, size: u32) -> HeightMap {
    let maps = relievo_make::make(name, size).expect("the built-in material can be made");
    maps.height.expect("the built-in material has a height map")
}

/// Returns white noise.
#[must_use]
pub fn noise(size: [u32; 2], seed: u64) -> Grid<f32> {
    let mut random = Random(seed);
    Grid::from_fn(size[0], size[1], |_, _| random.unit())
}

/// Rounds heights to multiples of 1/255.
#[must_use]
pub fn in_8_bits(map: &Grid<f32>) -> Grid<f32> {
    map.map(|h| (h * 255.0).round() / 255.0)
}

/// Returns low ground with scattered spikes, one texel wide.
#[must_use]
pub fn spikes(size: [u32; 2]) -> Grid<f32> {
    Grid::from_fn(size[0], size[1], |x, y| if (x * 7 + y * 13).is_multiple_of(53) { 1.0 } else { 0.1 })
}
