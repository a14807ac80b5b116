//! Normals that belong to a periodic height field.

use rayon::prelude::*;

/// Unit normals (x along +u, y up in the picture) of a periodic field of `size × size` heights in [0, 1].
///
/// Central differences with wrap-around; `height_scale` is the length of the full range as a fraction of one repeat.
pub(crate) fn normals(height: &[f32], size: usize, height_scale: f32) -> Vec<[f32; 3]> {
    // Difference of two neighbours of a texel, two texels apart, as a slope.
    let slope = height_scale * size as f32 / 2.0;
    let mut normals = vec![[0.0; 3]; height.len()];
    normals.par_chunks_mut(size).enumerate().for_each(|(y, out)| {
        let row = |y: usize| &height[y * size..(y + 1) * size];
        let (above, here, below) = (row((y + size - 1) % size), row(y), row((y + 1) % size));
        for (x, n) in out.iter_mut().enumerate() {
            let left = here[if x == 0 { size - 1 } else { x - 1 }];
            let right = here[if x + 1 == size { 0 } else { x + 1 }];
            // Rows run down and y up: higher below leans the normal up.
            let (nx, ny) = ((left - right) * slope, (below[x] - above[x]) * slope);
            let scale = 1.0 / (nx * nx + ny * ny + 1.0).sqrt();
            *n = [nx * scale, ny * scale, scale];
        }
    });
    normals
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bump_leans_up_on_its_top_flank_and_right_on_its_right() {
        let size = 32;
        let height: Vec<f32> = (0..size * size)
            .map(|k| {
                let (x, y) = ((k % size) as f32 - 15.5, (k / size) as f32 - 15.5);
                (1.0 - (x * x + y * y) / 200.0).max(0.0)
            })
            .collect();
        let n = normals(&height, size, 0.2);
        assert!(n[8 * size + 16][1] > 0.1);
        assert!(n[24 * size + 16][1] < -0.1);
        assert!(n[16 * size + 24][0] > 0.1);
        assert!(n[16 * size + 8][0] < -0.1);
    }

    #[test]
    fn a_sine_has_the_slope_of_its_derivative_across_the_seam_too() {
        use std::f32::consts::TAU;
        let (size, scale) = (256, 0.1);
        let height: Vec<f32> =
            (0..size * size).map(|k| 0.5 + 0.5 * (TAU * ((k % size) as f32 + 0.5) / size as f32).sin()).collect();
        let n = normals(&height, size, scale);
        for x in 0..size {
            let expected = -scale * 0.5 * TAU * (TAU * (x as f32 + 0.5) / size as f32).cos();
            assert!((n[x][0] / n[x][2] - expected).abs() < 1e-3, "texel {x}");
            assert_eq!(n[x][1], 0.0);
        }
    }
}
