//! Ambient occlusion of a periodic height field.

use rayon::prelude::*;

/// Directions in which the horizon is looked for.
const DIRECTIONS: usize = 16;
/// Distances looked at in each direction, as fractions of one repeat, from near to far.
const NEAREST: f32 = 0.003;
const FARTHEST: f32 = 0.11;
const STEPS: usize = 14;

/// How open each texel of a periodic field of `size × size` heights is: 1 open, 0 closed.
///
/// Finds the horizon in 16 directions (Max, "Horizon mapping", 1988) within 0.11 of a repeat. For a texel that faces
/// straight up, a horizon of slope t leaves 1 / (1 + t²) of a direction's cosine-weighted light. `height_scale` is the
/// length of the full range as a fraction of one repeat.
pub(crate) fn ambient_occlusion(height: &[f32], size: usize, height_scale: f32) -> Vec<f32> {
    let rays: Vec<Vec<Step>> = (0..DIRECTIONS).map(|k| steps(k, size, height_scale)).collect();
    let mut open = vec![0.0; height.len()];
    open.par_chunks_mut(size).enumerate().for_each_init(
        || vec![0.0f32; size],
        |horizon, (y, out)| {
            let here = &height[y * size..(y + 1) * size];
            for ray in &rays {
                horizon.fill(0.0);
                for step in ray {
                    let far_y = (y + step.dy) % size;
                    let far = &height[far_y * size..(far_y + 1) * size];
                    // Column x looks at x + dx: two straight runs, the second after the seam.
                    let (before, after) = horizon.split_at_mut(size - step.dx);
                    raise(before, here, &far[step.dx..], step.per_length);
                    raise(after, &here[size - step.dx..], far, step.per_length);
                }
                for (o, t) in out.iter_mut().zip(horizon.iter()) {
                    *o += 1.0 / (1.0 + t * t);
                }
            }
            for o in out.iter_mut() {
                *o /= DIRECTIONS as f32;
            }
        },
    );
    open
}

/// A look at the texel (`dx`, `dy`) further on, both in 0..size; a height difference × `per_length` is a slope.
struct Step {
    dx: usize,
    dy: usize,
    per_length: f32,
}

fn steps(direction: usize, size: usize, height_scale: f32) -> Vec<Step> {
    let n = size as f32;
    // Half a step off the axes, so that no direction runs along a straight edge.
    let (sin, cos) = (std::f32::consts::TAU * (direction as f32 + 0.5) / DIRECTIONS as f32).sin_cos();
    // Each direction looks at distances of its own, else a straight wall would draw bands on its floor.
    let phase = (0.618_034 * direction as f32).fract();
    let mut steps: Vec<(i32, i32)> = (0..STEPS)
        .map(|k| {
            let distance = NEAREST * (FARTHEST / NEAREST).powf((k as f32 + phase) / STEPS as f32) * n;
            ((distance * cos).round() as i32, (distance * sin).round() as i32)
        })
        .filter(|&offset| offset != (0, 0))
        .collect();
    steps.dedup();
    steps
        .into_iter()
        .map(|(dx, dy)| {
            let length = (dx as f32).hypot(dy as f32) / n;
            // What is far counts less, so that it comes into view gently.
            let weight = 1.0 - (length / FARTHEST).powi(4).min(1.0);
            Step {
                dx: dx.rem_euclid(size as i32) as usize,
                dy: dy.rem_euclid(size as i32) as usize,
                per_length: weight * height_scale / length,
            }
        })
        .collect()
}

fn raise(horizon: &mut [f32], here: &[f32], far: &[f32], per_length: f32) {
    for ((t, h), f) in horizon.iter_mut().zip(here).zip(far) {
        *t = t.max((f - h) * per_length);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_is_open_everywhere() {
        assert!(ambient_occlusion(&[0.4; 64 * 64], 64, 0.1).iter().all(|&o| o == 1.0));
    }

    #[test]
    fn the_middle_of_a_trench_is_as_dark_as_the_closed_form_says() {
        let size = 256;
        let height: Vec<f32> =
            (0..size * size).map(|k| if (120..=136).contains(&(k % size)) { 0.0 } else { 1.0 }).collect();
        for scale in [0.01, 0.04, 0.1] {
            let open = ambient_occlusion(&height, size, scale);
            // Between walls of slope k as seen across: the mean of 1 / (1 + k²cos²) over all directions.
            let k = scale * size as f32 / 9.0;
            let expected = 1.0 / (1.0 + k * k).sqrt();
            assert!((open[128] - expected).abs() < 0.12, "{} for {expected}", open[128]);
            assert_eq!(open[40], 1.0);
        }
    }

    #[test]
    fn occlusion_wraps_around_the_border() {
        let size = 64;
        let wall = |column: usize| {
            let height: Vec<f32> = (0..size * size).map(|k| if k % size == column { 1.0 } else { 0.0 }).collect();
            ambient_occlusion(&height, size, 0.1)
        };
        let (middle, border) = (wall(32), wall(0));
        assert!(border[size - 1] < 1.0);
        assert_eq!(middle[31], border[size - 1]);
    }
}
