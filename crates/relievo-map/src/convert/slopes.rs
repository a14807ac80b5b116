use rayon::prelude::*;

use super::derivative::{Border, DerivativeKernel};
use crate::types::{Grid, HeightMap, NormalMap};

/// Returns the unit normals (+Y up) of a height field whose full range is `height_scale` of one repeat along u.
///
/// At an open border slopes are one-sided, and the rows that Sobel and Scharr average over are repeated.
#[must_use]
pub fn height_to_normal(map: &HeightMap, height_scale: f32, kernel: DerivativeKernel, border: Border) -> NormalMap {
    let grid = map.grid();
    let (w, h) = (grid.width() as usize, grid.height() as usize);
    let texels = grid.texels();
    // Difference of two texels two apart as a slope.
    let slope = height_scale * w as f32 / 2.0;
    let (side, middle) = (kernel.side_weight() as f32, 1.0 - 2.0 * kernel.side_weight() as f32);
    let mut normals = vec![[0.0f32; 3]; w * h];
    normals.par_chunks_mut(w).enumerate().for_each_init(
        // Slopes across rows and rows averaged, with a column more at each end.
        || (vec![0.0f32; w + 2], vec![0.0f32; w + 2]),
        |(down, along), (y, out)| {
            let row = |y: usize| &texels[y * w..(y + 1) * w];
            let here = row(y);
            let (above, below) = match border {
                Border::Wrap => (row((y + h - 1) % h), row((y + 1) % h)),
                Border::Open => (row(y.saturating_sub(1)), row((y + 1).min(h - 1))),
            };
            // One-sided: the row that is missing goes on straight.
            let one_sided = if border == Border::Open && h > 1 && (y == 0 || y + 1 == h) { 2.0 } else { 1.0 };
            for x in 0..w {
                down[x + 1] = (below[x] - above[x]) * one_sided;
                along[x + 1] = if side > 0.0 { side * (above[x] + below[x]) + middle * here[x] } else { here[x] };
            }
            match border {
                Border::Wrap => {
                    (down[0], down[w + 1]) = (down[w], down[1]);
                    (along[0], along[w + 1]) = (along[w], along[1]);
                }
                Border::Open => {
                    (down[0], down[w + 1]) = (down[1], down[w]);
                    (along[0], along[w + 1]) = if w > 1 {
                        (2.0 * along[1] - along[2], 2.0 * along[w] - along[w - 1])
                    } else {
                        (along[1], along[1])
                    };
                }
            }
            for (x, n) in out.iter_mut().enumerate() {
                let dy = if side > 0.0 { side * (down[x] + down[x + 2]) + middle * down[x + 1] } else { down[x + 1] };
                // Rows run down and y up: higher below leans the normal up.
                let (nx, ny) = ((along[x] - along[x + 2]) * slope, dy * slope);
                let scale = 1.0 / (nx * nx + ny * ny + 1.0).sqrt();
                *n = [nx * scale, ny * scale, scale];
            }
        },
    );
    NormalMap::from_unit(Grid::from_texels(grid.width(), grid.height(), normals))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(w: u32, h: u32, f: impl Fn(f32, f32) -> f32) -> HeightMap {
        HeightMap::new(Grid::from_fn(w, h, |x, y| f((x as f32 + 0.5) / w as f32, (y as f32 + 0.5) / h as f32)))
    }

    #[test]
    fn a_bump_leans_up_on_its_top_flank_and_right_on_its_right() {
        let bump = sampled(32, 32, |u, v| (1.0 - 8.0 * ((u - 0.5).powi(2) + (v - 0.5).powi(2))).max(0.0));
        for (_, kernel) in DerivativeKernel::ALL {
            for border in [Border::Wrap, Border::Open] {
                let n = height_to_normal(&bump, 0.2, kernel, border);
                assert!(n.grid().get(16, 8)[1] > 0.1 && n.grid().get(16, 24)[1] < -0.1);
                assert!(n.grid().get(24, 16)[0] > 0.1 && n.grid().get(8, 16)[0] < -0.1);
            }
        }
    }

    #[test]
    fn a_sine_has_the_slope_of_its_derivative_across_the_seam_too() {
        use std::f32::consts::TAU;
        let scale = 0.1;
        let wave = sampled(256, 8, |u, _| 0.5 + 0.5 * (TAU * u).sin());
        for (_, kernel) in DerivativeKernel::ALL {
            let n = height_to_normal(&wave, scale, kernel, Border::Wrap);
            for x in 0..256 {
                let expected = -scale * 0.5 * TAU * (TAU * (x as f32 + 0.5) / 256.0).cos();
                let [nx, ny, nz] = *n.grid().get(x, 3);
                assert!((nx / nz - expected).abs() < 1e-3 && ny == 0.0, "{kernel:?} {x}");
            }
        }
    }

    #[test]
    fn a_ramp_has_one_slope_up_to_an_open_border() {
        let ramp = sampled(40, 30, |u, v| 0.1 + 0.5 * u + 0.3 * v);
        for (_, kernel) in DerivativeKernel::ALL {
            let n = height_to_normal(&ramp, 0.2, kernel, Border::Open);
            for [nx, ny, nz] in n.grid().texels() {
                // A texel is as long along v as along u: 30 of them are three quarters of a repeat.
                assert!((nx / nz + 0.1).abs() < 1e-4 && (ny / nz - 0.08).abs() < 1e-4, "{kernel:?} {nx} {ny} {nz}");
            }
        }
    }

    #[test]
    fn a_single_texel_is_flat() {
        for border in [Border::Wrap, Border::Open] {
            let n = height_to_normal(&sampled(1, 1, |_, _| 0.3), 1.0, DerivativeKernel::Scharr, border);
            assert_eq!(n.grid().texels(), [[0.0, 0.0, 1.0]]);
        }
    }
}
