use std::f32::consts::PI;

use glam::{Vec2, Vec3};
use rayon::prelude::*;
use relievo_map::{ColorMap, Grid, MipMap, Wrap};

use crate::ColorSpace;

/// Width of a prefiltered level; its height is half of that.
const BLURRED_WIDTH: u32 = 64;
/// Number of directions per prefiltered texel.
const BLUR_SAMPLES: u32 = 256;

/// Image-based light: an equirectangular picture, +Y up, its middle column in direction −Z.
///
/// Irradiance and prefiltered reflections are computed once, the same for every backend.
#[derive(Clone, Debug)]
pub struct EnvironmentMap {
    /// Irradiance over π: second-order spherical harmonics (Ramamoorthi and Hanrahan 2001).
    harmonics: [Vec3; 9],
    /// Reflections prefiltered for each roughness (Karis 2013), the first the picture itself.
    blurred: Vec<Grid<[f32; 3]>>,
}

impl EnvironmentMap {
    /// Number of roughness levels that are prefiltered: level k is for roughness k / (LEVELS − 1).
    pub const LEVELS: usize = 8;

    /// Prepares an equirectangular picture; numbers that are not finite or below 0 count as 0.
    #[must_use]
    pub fn new(map: &ColorMap, space: ColorSpace) -> Self {
        let colors = match space {
            ColorSpace::Linear => map.to_linear(),
            ColorSpace::Display => map.to_display(),
        };
        let picture = colors.map(|&[r, g, b, _]| [r, g, b].map(|x| if x.is_finite() { x.max(0.0) } else { 0.0 }));
        let mips = MipMap::build(picture);
        let blurred = (0..Self::LEVELS).map(|level| blur(&mips, level as f32 / (Self::LEVELS - 1) as f32)).collect();
        let harmonics = project(&mips);
        Self { harmonics, blurred }
    }

    /// Returns the radiance from a direction.
    #[must_use]
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        at(&self.blurred[0], direction)
    }

    /// Returns the reflected radiance along `direction` (unit length) of a mirror of this roughness, 0..1, seen along its
    /// normal.
    #[must_use]
    pub fn prefiltered(&self, direction: Vec3, roughness: f32) -> Vec3 {
        let level = roughness.clamp(0.0, 1.0) * (Self::LEVELS - 1) as f32;
        let lower = (level as usize).min(Self::LEVELS - 2);
        let [sharp, soft] = [lower, lower + 1].map(|k| at(&self.blurred[k], direction));
        sharp.lerp(soft, level - lower as f32)
    }

    /// Returns the irradiance over π of a surface with this normal.
    #[must_use]
    pub fn irradiance(&self, normal: Vec3) -> Vec3 {
        let basis = harmonics(normal);
        (0..9).map(|k| self.harmonics[k] * basis[k]).sum::<Vec3>().max(Vec3::ZERO)
    }

    /// Returns the weights of the nine real spherical harmonics up to order two of [`EnvironmentMap::irradiance`], linear
    /// RGB, in the order 1, y, z, x, xy, yz, 3z² − 1, xz, x² − y².
    #[must_use]
    pub fn harmonics(&self) -> &[Vec3; 9] {
        &self.harmonics
    }

    /// Returns the prefiltered pictures, one per roughness level, [`EnvironmentMap::LEVELS`] of them: the first is the picture
    /// itself, the others are all of one smaller size.
    #[must_use]
    pub fn levels(&self) -> &[Grid<[f32; 3]>] {
        &self.blurred
    }
}

/// Evaluates the nine real spherical harmonics up to order two.
fn harmonics(d: Vec3) -> [f32; 9] {
    [
        0.282_095,
        0.488_603 * d.y,
        0.488_603 * d.z,
        0.488_603 * d.x,
        1.092_548 * d.x * d.y,
        1.092_548 * d.y * d.z,
        0.315_392 * (3.0 * d.z * d.z - 1.0),
        1.092_548 * d.x * d.z,
        0.546_274 * (d.x * d.x - d.y * d.y),
    ]
}

/// Projects the picture onto the harmonics; a small version is as good as the whole.
fn project(mips: &MipMap<[f32; 3]>) -> [Vec3; 9] {
    let small = mips.levels().iter().find(|level| level.width() <= 128).unwrap_or(mips.base());
    let mut sums = [Vec3::ZERO; 9];
    let texel_area = 2.0 * PI * PI / (small.width() as f32 * small.height() as f32);
    for y in 0..small.height() {
        for x in 0..small.width() {
            let direction = texel_direction(x, y, small.width(), small.height());
            let area = texel_area * (1.0 - direction.y * direction.y).max(0.0).sqrt();
            let basis = harmonics(direction);
            for k in 0..9 {
                sums[k] += Vec3::from(*small.get(x, y)) * (basis[k] * area);
            }
        }
    }
    // The cosine lobe's weights of the three bands, over π.
    const BANDS: [f32; 9] = [1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25];
    std::array::from_fn(|k| sums[k] * BANDS[k])
}

/// Prefilters the picture for a surface of this roughness, seen along its normal.
fn blur(mips: &MipMap<[f32; 3]>, roughness: f32) -> Grid<[f32; 3]> {
    if roughness == 0.0 {
        return mips.base().clone();
    }
    let (width, height) = (BLURRED_WIDTH, BLURRED_WIDTH / 2);
    let alpha = roughness * roughness;
    // Samples stand for whole patches of the sky: taking them from a smaller version keeps small suns from speckling.
    let small = mips.levels().iter().find(|level| level.width() <= 256).unwrap_or(mips.base());
    let rows: Vec<Vec<[f32; 3]>> = (0..height)
        .into_par_iter()
        .map(|y| {
            (0..width)
                .map(|x| {
                    let normal = texel_direction(x, y, width, height);
                    let (side, up) = normal.any_orthonormal_pair();
                    let (mut sum, mut weight) = (Vec3::ZERO, 0.0);
                    for i in 0..BLUR_SAMPLES {
                        // Half vectors spread as GGX says.
                        let u = (i as f32 + 0.5) / BLUR_SAMPLES as f32;
                        let cos = ((1.0 - u) / (1.0 + (alpha * alpha - 1.0) * u)).sqrt();
                        let ring = Vec2::from_angle(i as f32 * 2.399_963_2) * (1.0 - cos * cos).max(0.0).sqrt();
                        let half = side * ring.x + up * ring.y + normal * cos;
                        let light = half * (2.0 * cos) - normal;
                        let n_l = light.dot(normal);
                        if n_l > 0.0 {
                            sum += at(small, light) * n_l;
                            weight += n_l;
                        }
                    }
                    (sum / weight.max(1e-6)).to_array()
                })
                .collect()
        })
        .collect();
    Grid::from_fn(width, height, |x, y| rows[y as usize][x as usize])
}

/// Returns the direction of a texel's centre.
fn texel_direction(x: u32, y: u32, width: u32, height: u32) -> Vec3 {
    let phi = (x as f32 + 0.5) / width as f32 * 2.0 * PI;
    let (sin, cos) = ((y as f32 + 0.5) / height as f32 * PI).sin_cos();
    Vec3::new(-sin * phi.sin(), cos, sin * phi.cos())
}

/// Samples the picture in a direction: the inverse of [`texel_direction`].
fn at(picture: &Grid<[f32; 3]>, direction: Vec3) -> Vec3 {
    let u = (-direction.x).atan2(direction.z) / (2.0 * PI);
    let v = direction.y.clamp(-1.0, 1.0).acos() / PI;
    // Around repeats; over the poles would turn around, so v stays half a texel inside.
    let inset = 0.5 / picture.height() as f32;
    Vec3::from(picture.sample([u.rem_euclid(1.0), v.clamp(inset, 1.0 - inset)], Wrap::Repeat))
}

#[cfg(test)]
mod tests {
    use relievo_map::ColorEncoding;

    use super::*;

    fn uniform(color: [f32; 4]) -> EnvironmentMap {
        let grid = Grid::from_fn(32, 16, |_, _| color);
        EnvironmentMap::new(&ColorMap { grid, encoding: ColorEncoding::Linear }, ColorSpace::Linear)
    }

    #[test]
    fn a_matt_white_surface_under_a_uniform_sky_has_the_skys_colour() {
        let sky = uniform([0.5, 0.25, 1.0, 1.0]);
        for normal in [Vec3::X, Vec3::Y, Vec3::NEG_Z, Vec3::new(0.6, -0.64, 0.48)] {
            let received = sky.irradiance(normal);
            assert!((received - Vec3::new(0.5, 0.25, 1.0)).length() < 0.01, "{received}");
        }
    }

    #[test]
    fn directions_and_texels_are_inverse() {
        let picture = Grid::from_fn(64, 32, |x, y| [x as f32, y as f32, 0.0]);
        for (x, y) in [(0, 0), (13, 7), (40, 16), (63, 31)] {
            let texel = at(&picture, texel_direction(x, y, 64, 32));
            assert!((texel - Vec3::new(x as f32, y as f32, 0.0)).length() < 1e-2, "{x},{y}: {texel}");
        }
        // The middle of the picture lies ahead of a camera that looks along −Z.
        assert!((at(&picture, Vec3::NEG_Z).x - 31.5).abs() < 0.1);
    }
}
