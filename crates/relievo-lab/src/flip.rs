//! FLIP: what an eye would notice when two pictures alternate in place.

mod colors;
mod kernels;

use crate::SizeMismatch;
use colors::{Colors, hyab};
use kernels::Kernel;
use rayon::prelude::*;
use relievo_map::{Grid, srgb_to_linear};
use std::f64::consts::PI;
use thiserror::Error;

/// Pixels per degree of visual angle at 0.7 m from a 0.7 m wide display of 3840 pixels: the paper's viewing conditions.
pub const DEFAULT_PIXELS_PER_DEGREE: f32 = 67.020_64;

/// The difference between two pictures as an eye would notice it.
#[derive(Clone, Debug, PartialEq)]
pub struct Flip {
    /// Per pixel, 0 (no difference) to 1 (the largest).
    pub map: Grid<f32>,
    /// The mean of the map.
    pub mean: f64,
}

/// Why FLIP could not be computed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum FlipError {
    /// The pictures differ in size.
    #[error(transparent)]
    Size(#[from] SizeMismatch),
    /// The viewing conditions are none.
    #[error("FLIP needs 1 to 1000 pixels per degree, got {0}")]
    PixelsPerDegree(f32),
}

/// Pixels per degree of visual angle for a viewer `distance` metres from a display `width_m` metres and `width_px` pixels
/// wide.
#[must_use]
pub fn pixels_per_degree(distance: f32, width_m: f32, width_px: f32) -> f32 {
    distance * width_px / width_m * 1f32.to_radians()
}

/// Computes LDR-FLIP of two 8-bit sRGB pictures.
///
/// FLIP predicts what is noticed when flipping between the two: it blurs as the eye does at that distance, compares
/// colours, and lets differing edges and points add to the result. The order of the pictures does not matter. Beyond the
/// border the outermost pixels are repeated. The result is the same whatever the number of threads.
///
/// Pontus Andersson, Jim Nilsson, Tomas Akenine-Möller, Magnus Oskarsson, Kalle Åström, Mark D. Fairchild: *FLIP: A
/// Difference Evaluator for Alternating Images*, Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020.
///
/// # Errors
/// If the pictures differ in size, or `pixels_per_degree` is not in 1 to 1000.
pub fn flip(reference: &Grid<[u8; 3]>, test: &Grid<[u8; 3]>, pixels_per_degree: f32) -> Result<Flip, FlipError> {
    flip_with(&Method::PUBLISHED, reference, test, pixels_per_degree)
}

/// The constants of the method.
#[derive(Clone, Debug)]
struct Method {
    /// Contrast sensitivity along Y, red-green and blue-yellow: each a sum of Gaussians, by amplitude and by width in
    /// degrees squared (`a·√(π/b)·exp(−π²x²/b)`).
    sensitivity: [&'static [(f64, f64)]; 3],
    /// Exponent on colour differences.
    color_exponent: f32,
    /// Up to this part of the largest colour difference, …
    bend: f32,
    /// … the result climbs to this part of the full scale; the rest is squeezed into what remains.
    bend_result: f32,
    /// Exponent on feature differences.
    feature_exponent: f32,
    /// Width of the features that are looked for, in degrees.
    feature_width: f64,
}

impl Method {
    const PUBLISHED: Self = Self {
        sensitivity: [&[(1.0, 0.0047)], &[(1.0, 0.0053)], &[(34.1, 0.04), (13.5, 0.025)]],
        color_exponent: 0.7,
        bend: 0.4,
        bend_result: 0.95,
        feature_exponent: 0.5,
        feature_width: 0.082,
    };
}

fn flip_with(
    method: &Method,
    reference: &Grid<[u8; 3]>,
    test: &Grid<[u8; 3]>,
    pixels_per_degree: f32,
) -> Result<Flip, FlipError> {
    SizeMismatch::check(reference, test)?;
    if !(1.0..=1000.0).contains(&pixels_per_degree) {
        return Err(FlipError::PixelsPerDegree(pixels_per_degree));
    }
    let colors = Colors::new();
    let eye = Eye::new(method, f64::from(pixels_per_degree));
    let scale = ColorScale::new(method, &colors);
    let pictures = [Opponent::new(reference, &colors), Opponent::new(test, &colors)];

    let width = reference.width() as usize;
    let mut map = reference.map(|_| 0.0f32);
    map.texels_mut().par_chunks_mut(width).enumerate().for_each_init(
        || [Seen::new(width, &eye), Seen::new(width, &eye)],
        |seen, (y, errors)| {
            for (seen, picture) in seen.iter_mut().zip(&pictures) {
                seen.look(picture, y, &eye, &colors);
            }
            let [a, b] = seen;
            for (x, error) in errors.iter_mut().enumerate() {
                let color = scale.of(hyab(a.lab[x], b.lab[x]));
                let feature = (a.edge[x] - b.edge[x]).abs().max((a.point[x] - b.point[x]).abs());
                let feature = (feature * std::f32::consts::FRAC_1_SQRT_2).clamp(0.0, 1.0).powf(method.feature_exponent);
                *error = if color > 0.0 { color.powf(1.0 - feature).min(1.0) } else { 0.0 };
            }
        },
    );
    // One after the other, so that the mean too is the same whatever the number of threads.
    let mean = map.texels().iter().map(|&e| f64::from(e)).sum::<f64>() / map.texels().len() as f64;
    Ok(Flip { map, mean })
}

/// The filters of an eye at a given distance.
///
/// All of them are products of a filter down the columns and one along the rows (or a sum of two such products).
struct Eye {
    /// Per opponent axis, Gaussians and their shares of the blur; the shares sum to 1.
    blurs: [Vec<(f32, Kernel)>; 3],
    feature_blur: Kernel,
    feature_edge: Kernel,
    feature_point: Kernel,
    /// The longest reach of them all, in pixels.
    reach: usize,
}

impl Eye {
    fn new(method: &Method, pixels_per_degree: f64) -> Self {
        let sd = |b: f64| (b / 2.0).sqrt() / PI * pixels_per_degree;
        let widest = method.sensitivity.iter().copied().flatten().fold(0.0f64, |max, &(_, b)| max.max(b));
        let radius = (3.0 * sd(widest)).ceil() as usize;
        let blurs: [Vec<(f32, Kernel)>; 3] = method.sensitivity.map(|gaussians| {
            let parts: Vec<(f64, Kernel)> = gaussians
                .iter()
                .map(|&(a, b)| {
                    let (kernel, sum) = Kernel::gaussian(sd(b), radius);
                    (a * (PI / b).sqrt() * sum * sum, kernel)
                })
                .collect();
            let total: f64 = parts.iter().map(|(share, _)| share).sum();
            parts.into_iter().map(|(share, kernel)| ((share / total) as f32, kernel)).collect()
        });

        let feature_sd = 0.5 * method.feature_width * pixels_per_degree;
        let feature_radius = (3.0 * feature_sd).ceil() as usize;
        let feature_blur = Kernel::gaussian(feature_sd, feature_radius).0;
        let feature_edge = Kernel::edge(feature_sd, feature_radius);
        let feature_point = Kernel::point(feature_sd, feature_radius);
        let features = [&feature_blur, &feature_edge, &feature_point];
        let reach = blurs.iter().flatten().map(|(_, kernel)| kernel).chain(features).map(Kernel::radius).max();
        Self { blurs, reach: reach.unwrap_or(0), feature_blur, feature_edge, feature_point }
    }
}

/// A picture on the opponent axes, one plane per axis.
struct Opponent {
    planes: [Vec<f32>; 3],
    width: usize,
    height: usize,
}

impl Opponent {
    fn new(picture: &Grid<[u8; 3]>, colors: &Colors) -> Self {
        let light: [f32; 256] = std::array::from_fn(|i| srgb_to_linear(i as f32 / 255.0));
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let mut planes: [Vec<f32>; 3] = std::array::from_fn(|_| vec![0.0; width * height]);
        let [p, q, r] = &mut planes;
        (p.par_chunks_mut(width), q.par_chunks_mut(width), r.par_chunks_mut(width), picture.texels().par_chunks(width))
            .into_par_iter()
            .for_each(|(p, q, r, texels)| {
                for (x, texel) in texels.iter().enumerate() {
                    [p[x], q[x], r[x]] = colors.opponent(texel.map(|c| light[usize::from(c)]));
                }
            });
        Self { planes, width, height }
    }

    /// Row `y` of a plane, the outermost rows going on for ever.
    fn row(&self, plane: usize, y: isize) -> &[f32] {
        let y = y.clamp(0, self.height as isize - 1) as usize;
        &self.planes[plane][y * self.width..][..self.width]
    }
}

/// One row of a picture as the eye sees it, with the room needed to find out.
struct Seen {
    /// Hunt-adjusted CIELab of the blurred picture.
    lab: Vec<[f32; 3]>,
    /// Strength of edges in lightness.
    edge: Vec<f32>,
    /// Strength of points and lines in lightness.
    point: Vec<f32>,
    /// A row filtered down the columns, with room for the repeated border on either side.
    padded: Vec<f32>,
    along: Vec<f32>,
    blurred: [Vec<f32>; 3],
}

impl Seen {
    fn new(width: usize, eye: &Eye) -> Self {
        let row = || vec![0.0; width];
        Self {
            lab: vec![[0.0; 3]; width],
            edge: row(),
            point: row(),
            padded: vec![0.0; width + 2 * eye.reach],
            along: row(),
            blurred: [row(), row(), row()],
        }
    }

    fn look(&mut self, picture: &Opponent, y: usize, eye: &Eye, colors: &Colors) {
        for (axis, parts) in eye.blurs.iter().enumerate() {
            self.blurred[axis].fill(0.0);
            for (share, kernel) in parts {
                self.filter(picture, axis, y, kernel, &[kernel], |seen, _| {
                    add(&mut seen.blurred[axis], &seen.along, |x| share * x);
                });
            }
        }
        for (x, lab) in self.lab.iter_mut().enumerate() {
            *lab = colors.hunt_lab_of_opponent([self.blurred[0][x], self.blurred[1][x], self.blurred[2][x]]);
        }

        self.edge.fill(0.0);
        self.point.fill(0.0);
        let (blur, edge, point) = (&eye.feature_blur, &eye.feature_edge, &eye.feature_point);
        self.filter(picture, 0, y, blur, &[edge, point], |seen, i| {
            add([&mut seen.edge, &mut seen.point][i], &seen.along, |x| x * x);
        });
        self.filter(picture, 0, y, edge, &[blur], |seen, _| add(&mut seen.edge, &seen.along, |x| x * x));
        self.filter(picture, 0, y, point, &[blur], |seen, _| add(&mut seen.point, &seen.along, |x| x * x));
        for strength in self.edge.iter_mut().chain(&mut self.point) {
            *strength = strength.sqrt();
        }
    }

    /// Filters a plane down the columns once, and that along the row with each of `along`; after each the result lies in
    /// `self.along` and `take` is called with the index of the kernel.
    fn filter(
        &mut self,
        picture: &Opponent,
        plane: usize,
        y: usize,
        down: &Kernel,
        along: &[&Kernel],
        take: impl Fn(&mut Self, usize),
    ) {
        let pad = (self.padded.len() - picture.width) / 2;
        let (before, rest) = self.padded.split_at_mut(pad);
        let (row, after) = rest.split_at_mut(picture.width);
        down.down(row, |i| picture.row(plane, y as isize + i));
        before.fill(row[0]);
        after.fill(row[row.len() - 1]);
        for (i, kernel) in along.iter().enumerate() {
            kernel.along(&mut self.along, &self.padded, pad);
            take(self, i);
        }
    }
}

fn add(sums: &mut [f32], row: &[f32], f: impl Fn(f32) -> f32) {
    for (sum, &x) in sums.iter_mut().zip(row) {
        *sum += f(x);
    }
}

/// Brings colour differences to 0..1, giving most of that range to the small ones.
struct ColorScale {
    exponent: f32,
    bend_at: f32,
    bend_result: f32,
    largest: f32,
}

impl ColorScale {
    fn new(method: &Method, colors: &Colors) -> Self {
        // The paper's largest difference between displayable colours: green to blue.
        let largest =
            hyab(colors.hunt_lab([0.0, 1.0, 0.0]), colors.hunt_lab([0.0, 0.0, 1.0])).powf(method.color_exponent);
        Self {
            exponent: method.color_exponent,
            bend_at: method.bend * largest,
            bend_result: method.bend_result,
            largest,
        }
    }

    #[inline]
    fn of(&self, distance: f32) -> f32 {
        let d = distance.powf(self.exponent);
        if d < self.bend_at {
            self.bend_result * d / self.bend_at
        } else {
            self.bend_result + (1.0 - self.bend_result) * (d - self.bend_at) / (self.largest - self.bend_at)
        }
    }
}

#[cfg(test)]
mod tests;
