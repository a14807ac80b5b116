//! Hits of rays against the oracle.

use rayon::prelude::*;
use relievo_march::{HeightField, OracleHit, OracleRay, Raised, Ray, Record, oracle};
use serde::{Deserialize, Serialize};

use super::hit_error::{HitErrorSummary, WRONG_TEXELS, length, texel_offset};
use super::percentiles::Percentiles;
use crate::measure::TILE_RAYS;

/// Distance along the path, in texels, within which a hit on a crest counts as one that rounding may take for another.
const NEAR_TEXELS: f64 = 0.05;

/// Hit errors and costs of many rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RayHitErrors {
    /// Rays that were judged: those that the oracle hits.
    pub rays: u64,
    /// Fraction of rays whose hit is more than a texel of uv from the oracle's, or that hit nothing.
    pub wrong: f64,
    /// Fraction of rays whose hit lies more than a texel of path behind the first surface, or that hit nothing: they went
    /// through something.
    pub false_skips: f64,
    /// Fraction of rays whose hit lies more than a texel of path before the first surface, where nothing is.
    pub false_stops: f64,
    /// Fraction of rays that hit nothing; the percentiles of errors leave them out.
    pub misses: f64,
    /// Rays that touch a crest so closely that rounding decides whether they pass: judged by the nearer of both ends.
    pub grazing: u64,
    /// Distance of the hit's uv from the oracle's, in texels of the map that is marched.
    pub texels: Percentiles,
    /// The same in pixels of one texel seen from above: the part along the view is shortened by the angle's cosine.
    pub pixels: Percentiles,
    /// Difference in depth, in texels.
    pub depth: Percentiles,
    /// Angle between the bilinear surface's normals at both hits, in degrees.
    pub normal: Percentiles,
    /// Height look-ups of a ray.
    pub fetches: Percentiles,
    /// Loop iterations of a ray.
    pub iterations: Percentiles,
    /// Iterations of the slowest ray of an 8×4 tile over the tile's mean: the mean of all tiles.
    pub divergence: f64,
    /// The same: the worst tile.
    pub divergence_max: f64,
}

/// The oracle's hits of a set of rays, to judge the hits of marches.
#[derive(Clone, Debug)]
pub struct HitEvaluator<'a, F> {
    field: &'a F,
    rays: &'a [Ray],
    truth: Vec<Option<OracleTruth>>,
    /// The full depth, in texels.
    depth: f64,
}

#[derive(Clone, Copy, Debug)]
struct OracleTruth {
    hit: OracleHit,
    /// Depths of the hits of a surface that is higher or lower by the rounding of f32.
    range: [f64; 2],
}

impl<'a, F: HeightField + Sync> HitEvaluator<'a, F> {
    /// Traces every ray by the oracle, on all cores. `depth` is the field's full depth in texels.
    #[must_use]
    pub fn new(field: &'a F, rays: &'a [Ray], depth: f32) -> Self {
        let size = field.size().map(f64::from);
        let steepest = steepest(field);
        let truth = rays.par_iter().map(|ray| {
            let ray = OracleRay::from(ray);
            let hit = oracle(field, &ray, None)?;
            // Rounding moves a ray by a few units in the last place of its farthest coordinate, in texels; on a slope that
            // is a difference in height.
            let reach = (0..2).map(|k| (ray.uv[k].abs() + ray.slope[k].abs()) * size[k]).fold(0.0, f64::max);
            let rounding = 2e-6 + (4.0 * f64::from(f32::EPSILON) * reach) as f32 * steepest;
            let depth_at = |offset: f32| oracle(&Raised(field, offset), &ray, None).map_or(hit.depth, |hit| hit.depth);
            Some(OracleTruth { hit, range: [depth_at(rounding).min(hit.depth), depth_at(-rounding).max(hit.depth)] })
        });
        Self { field, rays, truth: truth.collect(), depth: f64::from(depth) }
    }

    /// Judges the results of a march for the rays, in their order.
    #[must_use]
    pub fn errors(&self, records: &[Record]) -> RayHitErrors {
        let judged: Vec<(HitError, &Record)> = (self.rays.par_iter())
            .zip(&self.truth)
            .zip(records)
            .filter_map(|((ray, truth), record)| Some((self.hit_error(ray, truth.as_ref()?, record), record)))
            .collect();
        let fraction = |is: fn(&HitError) -> bool| {
            judged.iter().filter(|(error, _)| is(error)).count() as f64 / judged.len().max(1) as f64
        };
        let summary = HitErrorSummary::new(judged.iter().map(|(error, _)| error.hit.then_some(error.texels)));
        let hits = || judged.iter().filter(|(error, _)| error.hit);
        let over_hits = |value: fn(&HitError) -> f64| Percentiles::of(hits().map(|(error, _)| value(error) as f32));
        let over_rays =
            |value: fn(&Record) -> u32| Percentiles::of(judged.iter().map(|(_, record)| value(record) as f32));
        let (divergence, divergence_max) = divergence(records);
        RayHitErrors {
            rays: judged.len() as u64,
            wrong: summary.wrong,
            false_skips: fraction(|error| !(error.path <= WRONG_TEXELS)),
            false_stops: fraction(|error| error.path < -WRONG_TEXELS),
            misses: summary.only_one_hits,
            grazing: judged.iter().filter(|(error, _)| error.grazing).count() as u64,
            texels: summary.texels,
            pixels: over_hits(|error| error.pixels),
            depth: over_hits(|error| error.depth),
            normal: over_hits(|error| error.normal),
            fetches: over_rays(|record| record.fetches),
            iterations: over_rays(|record| record.iterations),
            divergence,
            divergence_max,
        }
    }

    fn hit_error(&self, ray: &Ray, truth: &OracleTruth, record: &Record) -> HitError {
        if !record.hit {
            return HitError::MISS;
        }
        let size = self.field.size().map(f64::from);
        let slope = OracleRay::from(ray).slope;
        let slope_texels = [0, 1].map(|k| slope[k] * size[k]);
        let path_texels = length(slope_texels);
        let uv = record.uv.map(f64::from);
        let depth = f64::from(record.depth);
        let mut hit = truth.hit;
        let mut offset = texel_offset(uv, hit.uv, size);
        let mut grazing = false;
        if length(offset) > WRONG_TEXELS {
            // On the ray, and where the surface is met if it lies a rounding error higher or lower: the crest was touched.
            let near = NEAR_TEXELS / path_texels.max(1.0);
            let on_ray = [0, 1].map(|k| f64::from(ray.uv[k]) + slope[k] * depth);
            let from_ray = texel_offset(uv, on_ray, size);
            if truth.range[0] - near <= depth && depth <= truth.range[1] + near && length(from_ray) < NEAR_TEXELS {
                grazing = true;
                hit = OracleHit { uv: on_ray, depth };
                offset = from_ray;
            }
        }
        let texels = length(offset);
        let along = if path_texels > 0.0 {
            (offset[0] * slope[0] * size[0] + offset[1] * slope[1] * size[1]) / path_texels
        } else {
            0.0
        };
        let across = (texels * texels - along * along).max(0.0).sqrt();
        HitError {
            hit: true,
            grazing,
            texels,
            pixels: across.hypot(along * f64::from(ray.cos)),
            depth: (depth - hit.depth).abs() * self.depth,
            path: (depth - hit.depth) * self.depth.hypot(path_texels),
            normal: angle(self.normal(uv), self.normal(hit.uv)),
        }
    }

    /// Normal of the bilinear surface at `uv`, not normalised, in texels.
    fn normal(&self, uv: [f64; 2]) -> [f64; 3] {
        let size = self.field.size().map(f64::from);
        let at = [0, 1].map(|k| uv[k] * size[k] - 0.5);
        let cell = at.map(|x| x.floor() as i32);
        let [a, b] = [0, 1].map(|k| at[k] - f64::from(cell[k]));
        let [h00, h10, h01, h11] = self.field.corners(cell[0], cell[1]).map(f64::from);
        let along_u = (h10 - h00) * (1.0 - b) + (h11 - h01) * b;
        let along_v = (h01 - h00) * (1.0 - a) + (h11 - h10) * a;
        [-along_u * self.depth, -along_v * self.depth, 1.0]
    }
}

/// The error of one ray's hit.
struct HitError {
    hit: bool,
    grazing: bool,
    texels: f64,
    pixels: f64,
    depth: f64,
    /// Distance along the path from the first surface to the hit, in texels; negative before the surface.
    path: f64,
    normal: f64,
}

impl HitError {
    const MISS: Self = Self {
        hit: false,
        grazing: false,
        texels: f64::INFINITY,
        pixels: f64::INFINITY,
        depth: f64::INFINITY,
        path: f64::INFINITY,
        normal: 180.0,
    };
}

/// Angle between two vectors, in degrees.
fn angle(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    dot(cross, cross).sqrt().atan2(dot(a, b)).to_degrees()
}

/// The largest difference between two neighbouring texels.
fn steepest(field: &impl HeightField) -> f32 {
    let [w, h] = field.size().map(|n| n as i32);
    let mut most = 0.0f32;
    for j in 0..h {
        for i in 0..w {
            let [h00, h10, h01, _] = field.corners(i, j);
            most = most.max((h10 - h00).abs()).max((h01 - h00).abs());
        }
    }
    most
}

/// Iterations of the slowest ray of each tile over the tile's mean: the mean of all tiles, and the worst.
fn divergence(records: &[Record]) -> (f64, f64) {
    let tiles: Vec<f64> = records
        .chunks(TILE_RAYS as usize)
        .map(|tile| {
            let sum: u64 = tile.iter().map(|record| u64::from(record.iterations)).sum();
            let most = tile.iter().map(|record| record.iterations).max().unwrap_or(0);
            if sum > 0 { f64::from(most) * tile.len() as f64 / sum as f64 } else { 1.0 }
        })
        .collect();
    (tiles.iter().sum::<f64>() / tiles.len().max(1) as f64, tiles.iter().copied().fold(1.0, f64::max))
}

#[cfg(test)]
mod tests {
    use relievo_map::{HeightMap, Wrap};
    use relievo_march::{MarchOptions, MaxPyramid, PyramidField, ReliefMap, Technique, march};
    use relievo_testkit::WithPyramid;

    use super::*;
    use crate::corpus;
    use crate::measure::tiles;

    fn judged(
        name: &str,
        degrees: f32,
        find: impl Fn(&relievo_march::HeightFieldView<'_>, &Ray) -> Record,
    ) -> RayHitErrors {
        let heights = ReliefMap::new(&corpus(name, 128).unwrap());
        let field = heights.field(0.0, Wrap::Repeat);
        let rays = tiles([128; 2], [25.0 / 128.0; 2], degrees, 4096);
        let records: Vec<Record> = rays.iter().map(|ray| find(&field, ray)).collect();
        HitEvaluator::new(&field, &rays, 25.0).errors(&records)
    }

    fn by(technique: Technique) -> MarchOptions {
        MarchOptions { technique, ..MarchOptions::default() }
    }

    #[test]
    fn exact_is_never_wrong_and_layers_go_through_needles() {
        for degrees in [0.0, 60.0, 88.5] {
            let exact = judged("spikes", degrees, |field, ray| march(field, ray, &by(Technique::Exact)));
            assert_eq!((exact.rays, exact.wrong, exact.false_skips, exact.false_stops), (4096, 0.0, 0.0, 0.0));
            assert!(exact.texels.max < 0.1 && exact.pixels.max <= exact.texels.max, "{exact:?}");
        }
        let pom = judged("spikes", 82.0, |field, ray| march(field, ray, &by(Technique::Occlusion)));
        assert!(pom.false_skips > 0.2 && pom.wrong >= pom.false_skips * 0.9, "{pom:?}");
        assert!(pom.pixels.p99 < pom.texels.p99 && pom.normal.p99 > 10.0, "{pom:?}");
    }

    #[test]
    fn a_flat_texture_stops_before_the_surface_and_skips_nothing() {
        let flat = judged("airy", 60.0, |field, ray| march(field, ray, &by(Technique::Normal)));
        assert!(flat.false_stops > 0.9 && flat.false_skips == 0.0, "{flat:?}");
        assert_eq!((flat.fetches.max, flat.divergence), (0.0, 1.0));
    }

    #[test]
    fn a_pyramid_rounded_down_and_a_surface_that_is_lower_are_caught() {
        let map = corpus("noise", 128).unwrap();
        let lower = map.grid().map(|h| (h - 2.0 / 255.0).max(0.0));
        let pyramid = MaxPyramid::build(&lower, false);
        let errors = judged("noise", 82.0, |field, ray| {
            let rounded_down = PyramidField::new(map.grid(), &pyramid, Wrap::Repeat);
            march(&WithPyramid(*field, rounded_down), ray, &by(Technique::Exact))
        });
        assert!(errors.false_skips > 0.0 && errors.wrong > 0.0, "{errors:?}");
        let sunk = ReliefMap::new(&HeightMap::new(map.grid().map(|h| (h - 0.05).max(0.0))));
        let errors = judged("noise", 60.0, |_, ray| march(&sunk.field(0.0, Wrap::Repeat), ray, &by(Technique::Exact)));
        assert!(errors.false_skips > 0.01, "{errors:?}");
    }

    #[test]
    fn misses_count_as_skips() {
        let errors = judged("solid", 30.0, |_, _| Record::default());
        assert_eq!((errors.wrong, errors.false_skips, errors.texels), (1.0, 1.0, Percentiles::default()));
    }

    #[test]
    fn divergence_is_the_slowest_ray_over_the_mean() {
        let record = |iterations| Record { iterations, ..Record::default() };
        let tile: Vec<Record> = (0..32).map(|i| record(if i == 5 { 33 } else { 1 })).collect();
        assert_eq!(divergence(&tile), (33.0 / 2.0, 33.0 / 2.0));
        assert_eq!(divergence(&[record(0), record(0)]), (1.0, 1.0));
    }
}
