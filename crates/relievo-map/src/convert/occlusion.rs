//! Ambient occlusion and bent normals from the horizons of each texel.

use rayon::prelude::*;

use super::derivative::Border;
use crate::types::{Grid, HeightMap, NormalMap, ScalarMap};

/// Options of [`ambient_occlusion`] and [`bent_normals`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionOptions {
    /// The full range of heights as a fraction of one repeat along u.
    pub height_scale: f32,
    /// Search radius for horizons, as a fraction of a repeat.
    pub radius: f32,
    /// Number of directions in which the horizon is searched, at least 1.
    pub directions: u32,
    /// Border of the map: tiling or open.
    pub border: Border,
}

impl Default for OcclusionOptions {
    fn default() -> Self {
        Self { height_scale: 0.05, radius: 0.11, directions: 16, border: Border::Wrap }
    }
}

/// Samples per direction.
const SAMPLES_PER_DIRECTION: usize = 14;
/// Distance of the first sample for a radius of 0.11.
const MIN_DISTANCE: f32 = 0.003;

/// Computes ambient occlusion: 1 open, 0 closed.
///
/// Finds the horizon in some directions (Max, "Horizon mapping", 1988). For a texel that faces straight up, a horizon
/// of slope t leaves 1 / (1 + t²) of a direction's cosine-weighted light.
#[must_use]
pub fn ambient_occlusion(map: &HeightMap, options: &OcclusionOptions) -> ScalarMap {
    let grid = map.grid();
    let (w, h) = (grid.width() as usize, grid.height() as usize);
    let mut open = vec![0.0f32; w * h];
    let horizons = Horizons::new(grid, options);
    open.par_chunks_mut(w).enumerate().for_each_init(
        || vec![0.0f32; w],
        |horizon, (y, out)| {
            for ray in &horizons.rays {
                horizons.find(ray, y, horizon);
                for (o, t) in out.iter_mut().zip(horizon.iter()) {
                    *o += 1.0 / (1.0 + t * t);
                }
            }
            for o in out.iter_mut() {
                *o /= horizons.rays.len() as f32;
            }
        },
    );
    ScalarMap::new(Grid::from_texels(grid.width(), grid.height(), open))
}

/// Computes bent normals: the mean unoccluded direction of each texel, unit vectors, +Y up. Open ground gives (0, 0,
/// 1).
///
/// Uses the same horizons as [`ambient_occlusion`]; a direction counts by its solid angle from the horizon to the
/// zenith.
#[must_use]
pub fn bent_normals(map: &HeightMap, options: &OcclusionOptions) -> NormalMap {
    let grid = map.grid();
    let (w, h) = (grid.width() as usize, grid.height() as usize);
    let horizons = Horizons::new(grid, options);
    let mut bent = vec![[0.0f32; 3]; w * h];
    bent.par_chunks_mut(w).enumerate().for_each_init(
        || vec![0.0f32; w],
        |horizon, (y, out)| {
            for ray in &horizons.rays {
                horizons.find(ray, y, horizon);
                for (b, t) in out.iter_mut().zip(horizon.iter()) {
                    // The integrals of cos² and sin·cos from the horizon's angle to the zenith.
                    let angle = t.atan();
                    let flat = 0.5 * (std::f32::consts::FRAC_PI_2 - angle) - 0.25 * (2.0 * angle).sin();
                    b[0] += flat * ray.direction[0];
                    b[1] -= flat * ray.direction[1];
                    b[2] += 0.5 * angle.cos().powi(2);
                }
            }
            for b in out.iter_mut() {
                let length = b.iter().map(|c| c * c).sum::<f32>().sqrt();
                *b = if length > 1e-6 { b.map(|c| c / length) } else { [0.0, 0.0, 1.0] };
            }
        },
    );
    NormalMap::from_unit(Grid::from_texels(grid.width(), grid.height(), bent))
}

/// A direction of the search, its samples from near to far.
struct HorizonRay {
    /// Unit vector along u and down v.
    direction: [f32; 2],
    samples: Vec<HorizonSample>,
}

/// A sample at the offset (`dx`, `dy`) in texels; height difference × `per_length` is a slope.
struct HorizonSample {
    dx: i32,
    dy: i32,
    per_length: f32,
}

/// The search of horizons in all directions.
struct Horizons<'a> {
    grid: &'a Grid<f32>,
    border: Border,
    rays: Vec<HorizonRay>,
}

impl<'a> Horizons<'a> {
    fn new(grid: &'a Grid<f32>, options: &OcclusionOptions) -> Self {
        let directions = options.directions.max(1);
        let rays = (0..directions).map(|k| horizon_ray(k, directions, grid.width(), options)).collect();
        Self { grid, border: options.border, rays }
    }

    /// Fills `horizon` with the slopes of the horizon of row `y`, at least 0.
    fn find(&self, ray: &HorizonRay, y: usize, horizon: &mut [f32]) {
        let (w, h) = (self.grid.width() as usize, self.grid.height() as usize);
        let texels = self.grid.texels();
        let here = &texels[y * w..(y + 1) * w];
        horizon.fill(0.0);
        for sample in &ray.samples {
            let far_y = y as i64 + i64::from(sample.dy);
            match self.border {
                Border::Wrap => {
                    let far_y = far_y.rem_euclid(h as i64) as usize;
                    let dx = i64::from(sample.dx).rem_euclid(w as i64) as usize;
                    let far = &texels[far_y * w..(far_y + 1) * w];
                    // Column x looks at x + dx: two straight runs, the second after the seam.
                    let (before, after) = horizon.split_at_mut(w - dx);
                    raise(before, here, &far[dx..], sample.per_length);
                    raise(after, &here[w - dx..], far, sample.per_length);
                }
                Border::Open if (0..h as i64).contains(&far_y) => {
                    let far = &texels[far_y as usize * w..(far_y as usize + 1) * w];
                    let dx = sample.dx.unsigned_abs() as usize;
                    if dx < w && sample.dx >= 0 {
                        raise(&mut horizon[..w - dx], here, &far[dx..], sample.per_length);
                    } else if dx < w {
                        raise(&mut horizon[dx..], &here[dx..], far, sample.per_length);
                    }
                }
                Border::Open => {}
            }
        }
    }
}

/// Raises each horizon to the slope towards `far`.
fn raise(horizon: &mut [f32], here: &[f32], far: &[f32], per_length: f32) {
    for ((t, h), f) in horizon.iter_mut().zip(here).zip(far) {
        *t = t.max((f - h) * per_length);
    }
}

/// Lays out the samples of a direction.
fn horizon_ray(direction: u32, directions: u32, width: u32, options: &OcclusionOptions) -> HorizonRay {
    let n = width as f32;
    let radius = options.radius.max(0.0).min(1.0);
    // Half a step off the axes, so that no direction runs along a straight edge.
    let (sin, cos) = (std::f32::consts::TAU * (direction as f32 + 0.5) / directions as f32).sin_cos();
    // Distances differ between directions, else a straight wall would draw bands on its floor.
    let phase = (0.618_034 * direction as f32).fract();
    let nearest = MIN_DISTANCE * (radius / 0.11);
    let mut offsets: Vec<(i32, i32)> = (0..SAMPLES_PER_DIRECTION)
        .map(|k| {
            let distance = nearest * (radius / nearest).powf((k as f32 + phase) / SAMPLES_PER_DIRECTION as f32) * n;
            ((distance * cos).round() as i32, (distance * sin).round() as i32)
        })
        .filter(|&offset| offset != (0, 0))
        .collect();
    offsets.dedup();
    let samples = offsets
        .into_iter()
        .map(|(dx, dy)| {
            let length = (dx as f32).hypot(dy as f32) / n;
            // Distant samples count less, so that occlusion fades in.
            let weight = 1.0 - (length / radius).powi(4).min(1.0);
            HorizonSample { dx, dy, per_length: weight * options.height_scale / length }
        })
        .collect();
    HorizonRay { direction: [cos, sin], samples }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(height_scale: f32) -> OcclusionOptions {
        OcclusionOptions { height_scale, ..OcclusionOptions::default() }
    }

    fn columns(w: u32, h: u32, f: impl Fn(u32) -> f32) -> HeightMap {
        HeightMap::new(Grid::from_fn(w, h, |x, _| f(x)))
    }

    #[test]
    fn a_plane_is_open_everywhere() {
        for border in [Border::Wrap, Border::Open] {
            let options = OcclusionOptions { border, ..options(0.1) };
            let plane = columns(64, 48, |_| 0.4);
            assert!(ambient_occlusion(&plane, &options).grid().texels().iter().all(|&o| o == 1.0));
            for n in bent_normals(&plane, &options).grid().texels() {
                assert!(n[2] > 0.999_999);
            }
        }
    }

    #[test]
    fn the_middle_of_a_trench_is_as_dark_as_the_closed_form_says() {
        let trench = columns(256, 256, |x| if (120..=136).contains(&x) { 0.0 } else { 1.0 });
        for scale in [0.01, 0.04, 0.1] {
            let open = ambient_occlusion(&trench, &options(scale));
            // Between walls of slope k as seen across: the mean of 1 / (1 + k²cos²) over all directions.
            let k = scale * 256.0 / 9.0;
            let expected = 1.0 / (1.0 + k * k).sqrt();
            let got = *open.grid().get(128, 9);
            assert!((got - expected).abs() < 0.12, "{got} for {expected}");
            assert_eq!(*open.grid().get(40, 3), 1.0);
        }
    }

    #[test]
    fn occlusion_wraps_around_the_border_or_ends_there() {
        let wall = |at: u32, border| {
            let map = columns(64, 64, |x| if x == at { 1.0 } else { 0.0 });
            ambient_occlusion(&map, &OcclusionOptions { border, ..options(0.1) })
        };
        let at = |map: &ScalarMap, x| *map.grid().get(x, 20);
        assert_eq!(at(&wall(32, Border::Wrap), 31), at(&wall(0, Border::Wrap), 63));
        assert!(at(&wall(0, Border::Wrap), 63) < 1.0);
        assert_eq!(at(&wall(0, Border::Open), 63), 1.0);
        assert!(at(&wall(0, Border::Open), 1) < 1.0);
    }

    #[test]
    fn normals_bend_away_from_walls() {
        let wall = HeightMap::new(Grid::from_fn(64, 64, |x, y| if x > 40 && y < 20 { 1.0 } else { 0.0 }));
        let bent = bent_normals(&wall, &options(0.1));
        assert!(bent.grid().get(39, 10)[0] < -0.1, "the wall is on the right");
        // Above in the picture is up: the normal leans down.
        assert!(bent.grid().get(50, 22)[1] < -0.1, "the wall is above");
    }
}
