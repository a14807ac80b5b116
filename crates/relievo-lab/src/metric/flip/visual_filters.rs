use std::f64::consts::PI;

use rayon::prelude::*;
use relievo_map::{Grid, srgb_to_linear};

use super::color_space::ColorSpace;
use super::filter_kernel::FilterKernel;
use super::method::Method;

/// The filters of human vision at a given number of pixels per degree.
///
/// All are separable: products of a filter down the columns and one along the rows (or a sum of two such products).
pub(super) struct VisualFilters {
    /// Per opponent axis, Gaussians and their shares of the blur; the shares sum to 1.
    blurs: [Vec<(f32, FilterKernel)>; 3],
    feature_blur: FilterKernel,
    feature_edge: FilterKernel,
    feature_point: FilterKernel,
    /// The largest radius, in pixels.
    radius: usize,
}

impl VisualFilters {
    pub(super) fn new(method: &Method, pixels_per_degree: f64) -> Self {
        let sd = |b: f64| (b / 2.0).sqrt() / PI * pixels_per_degree;
        let widest = method.sensitivity.iter().copied().flatten().fold(0.0f64, |max, &(_, b)| max.max(b));
        let blur_radius = (3.0 * sd(widest)).ceil() as usize;
        let blurs: [Vec<(f32, FilterKernel)>; 3] = method.sensitivity.map(|gaussians| {
            let parts: Vec<(f64, FilterKernel)> = gaussians
                .iter()
                .map(|&(a, b)| {
                    let (kernel, sum) = FilterKernel::gaussian(sd(b), blur_radius);
                    (a * (PI / b).sqrt() * sum * sum, kernel)
                })
                .collect();
            let total: f64 = parts.iter().map(|(share, _)| share).sum();
            parts.into_iter().map(|(share, kernel)| ((share / total) as f32, kernel)).collect()
        });

        let feature_sd = 0.5 * method.feature_width * pixels_per_degree;
        let feature_radius = (3.0 * feature_sd).ceil() as usize;
        let feature_blur = FilterKernel::gaussian(feature_sd, feature_radius).0;
        let feature_edge = FilterKernel::edge(feature_sd, feature_radius);
        let feature_point = FilterKernel::point(feature_sd, feature_radius);
        let features = [&feature_blur, &feature_edge, &feature_point];
        let radius = blurs.iter().flatten().map(|(_, kernel)| kernel).chain(features).map(FilterKernel::radius).max();
        Self { blurs, radius: radius.unwrap_or(0), feature_blur, feature_edge, feature_point }
    }
}

/// A picture in the opponent colour space, one plane per axis.
pub(super) struct OpponentPlanes {
    planes: [Vec<f32>; 3],
    width: usize,
    height: usize,
}

impl OpponentPlanes {
    pub(super) fn new(picture: &Grid<[u8; 3]>, colors: &ColorSpace) -> Self {
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

    /// Row `y` of a plane; the outermost rows are repeated beyond the border.
    fn row(&self, plane: usize, y: isize) -> &[f32] {
        let y = y.clamp(0, self.height as isize - 1) as usize;
        &self.planes[plane][y * self.width..][..self.width]
    }
}

/// One row of a picture after the filters, with scratch buffers.
pub(super) struct FilteredRow {
    /// Hunt-adjusted CIELab of the blurred picture.
    pub(super) lab: Vec<[f32; 3]>,
    /// Strength of edges in lightness.
    pub(super) edge: Vec<f32>,
    /// Strength of points and lines in lightness.
    pub(super) point: Vec<f32>,
    /// A row filtered down the columns, with the repeated border on either side.
    padded: Vec<f32>,
    along: Vec<f32>,
    blurred: [Vec<f32>; 3],
}

impl FilteredRow {
    pub(super) fn new(width: usize, filters: &VisualFilters) -> Self {
        let row = || vec![0.0; width];
        Self {
            lab: vec![[0.0; 3]; width],
            edge: row(),
            point: row(),
            padded: vec![0.0; width + 2 * filters.radius],
            along: row(),
            blurred: [row(), row(), row()],
        }
    }

    pub(super) fn filter(&mut self, picture: &OpponentPlanes, y: usize, filters: &VisualFilters, colors: &ColorSpace) {
        for (axis, parts) in filters.blurs.iter().enumerate() {
            self.blurred[axis].fill(0.0);
            for (share, kernel) in parts {
                self.filter_plane(picture, axis, y, kernel, &[kernel], |row, _| {
                    add(&mut row.blurred[axis], &row.along, |x| share * x);
                });
            }
        }
        for (x, lab) in self.lab.iter_mut().enumerate() {
            *lab = colors.hunt_lab_of_opponent([self.blurred[0][x], self.blurred[1][x], self.blurred[2][x]]);
        }

        self.edge.fill(0.0);
        self.point.fill(0.0);
        let (blur, edge, point) = (&filters.feature_blur, &filters.feature_edge, &filters.feature_point);
        self.filter_plane(picture, 0, y, blur, &[edge, point], |row, i| {
            add([&mut row.edge, &mut row.point][i], &row.along, |x| x * x);
        });
        self.filter_plane(picture, 0, y, edge, &[blur], |row, _| add(&mut row.edge, &row.along, |x| x * x));
        self.filter_plane(picture, 0, y, point, &[blur], |row, _| add(&mut row.point, &row.along, |x| x * x));
        for strength in self.edge.iter_mut().chain(&mut self.point) {
            *strength = strength.sqrt();
        }
    }

    /// Filters a plane down the columns once, and the result along the row by each kernel of `along`; calls `take` with the
    /// kernel's index after each, with the result in `self.along`.
    fn filter_plane(
        &mut self,
        picture: &OpponentPlanes,
        plane: usize,
        y: usize,
        down: &FilterKernel,
        along: &[&FilterKernel],
        take: impl Fn(&mut Self, usize),
    ) {
        let pad = (self.padded.len() - picture.width) / 2;
        let (before, rest) = self.padded.split_at_mut(pad);
        let (row, after) = rest.split_at_mut(picture.width);
        down.filter_columns(row, |i| picture.row(plane, y as isize + i));
        before.fill(row[0]);
        after.fill(row[row.len() - 1]);
        for (i, kernel) in along.iter().enumerate() {
            kernel.filter_row(&mut self.along, &self.padded, pad);
            take(self, i);
        }
    }
}

fn add(sums: &mut [f32], row: &[f32], f: impl Fn(f32) -> f32) {
    for (sum, &x) in sums.iter_mut().zip(row) {
        *sum += f(x);
    }
}
