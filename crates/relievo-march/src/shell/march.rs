use super::curve::{Curve, CurvePoint};
use super::prism::{Prism, ShellRay};
use crate::cost::{MAX_CELLS, MarchCost};
use crate::exact::{SurfaceCrossing, first_crossing, walk_cells};
use crate::field::Negated;
use crate::grid_line::Line;
use crate::pyramid::{BITS, highest_in};
use crate::real::Real;
use crate::{HeightField, Record};

/// The distance of a chord from the curve that it stands for, in texels.
const CHORD_ERROR: f64 = 1e-3;

/// The same for the oracle.
const ORACLE_CHORD_ERROR: f64 = 1e-5;

/// The most chords that a part of the curve is cut into, as a power of two.
const MOST_CHORDS: u32 = 1 << 14;

/// The part by which a piece of the curve is continued beyond the walls, so that rounding opens no gap between neighbours.
const OVERLAP: f64 = 1e-6;

/// Sides from which a surface counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// A ray meets it from above. Over a triangle that it comes to below the surface, through an open border or from behind, it
    /// meets nothing. For pictures.
    Above,
    /// A ray meets it from either side. For shadows.
    Both,
}

/// The point where a ray meets the surface over a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShellHit {
    /// Distance along the ray, scene units.
    pub t: f32,
    /// Barycentric weights of the point of the triangle below it.
    pub weights: [f32; 3],
    /// The displaced uv, the depth below the height 1, and the cost so far.
    pub record: Record,
}

/// Marches a ray through the shell over one triangle: finds the first point of the relief with a distance in `range`.
///
/// Ends for every input; numbers that are not finite are a miss. The record holds the cost in either case. The chords of the
/// curve are within 1/1000 of a texel of it.
#[must_use]
pub fn march_shell(
    field: &impl HeightField,
    prism: &Prism,
    ray: &ShellRay,
    range: [f32; 2],
    sides: Sides,
) -> (Option<ShellHit>, Record) {
    let cross = |line: &Line<f32>, start, cells| first_crossing(field, line, start, 1.0, cells);
    march_by(field, prism, ray, (range, sides, CHORD_ERROR), cross)
}

/// Marches as [`march_shell`] does, in f64 and with chords a hundred times closer: the reference on meshes.
#[must_use]
pub fn oracle_shell(
    field: &impl HeightField,
    prism: &Prism,
    ray: &ShellRay,
    range: [f32; 2],
    sides: Sides,
) -> (Option<ShellHit>, Record) {
    let cross = |line: &Line<f64>, start, cells| walk_cells(field, line, start, 1.0, cells);
    march_by(field, prism, ray, (range, sides, ORACLE_CHORD_ERROR), cross)
}

/// A march in progress.
struct ShellMarch<'a, H> {
    field: &'a H,
    curve: Curve<'a>,
    sides: Sides,
    chord_error: f64,
    texels: [f64; 2],
    texels_per_unit: f64,
    /// The height by which a ray may be below the surface and still count as on it.
    slack: f64,
    cost: MarchCost,
}

fn march_by<F: Real>(
    field: &impl HeightField,
    prism: &Prism,
    ray: &ShellRay,
    (range, sides, chord_error): ([f32; 2], Sides, f64),
    cross: impl Fn(&Line<F>, F, u32) -> (SurfaceCrossing<F>, MarchCost),
) -> (Option<ShellHit>, Record) {
    let numbers = ray.origin.iter().chain(&ray.direction);
    if !prism.is_usable() || !numbers.into_iter().all(|x| x.is_finite()) {
        return (None, Record::default());
    }
    let curve = Curve::new(prism, ray);
    let inside = curve.inside(prism.offsets(field.range()));
    if inside.as_slice().is_empty() {
        return (None, Record::default());
    }
    let size = field.size();
    let texels_per_unit = prism.texels_per_unit(size);
    let slack = 4.0 * CHORD_ERROR / (prism.depth * texels_per_unit) + 1e-5;
    let mut march = ShellMarch {
        field,
        curve,
        sides,
        chord_error,
        texels: size.map(f64::from),
        texels_per_unit,
        slack: if slack.is_finite() { slack } else { 1.0 },
        cost: MarchCost::default(),
    };
    let hit = march.first(inside.as_slice(), range.map(f64::from), &cross);
    let cost = march.cost;
    let costs = Record { fetches: cost.fetches, iterations: cost.iterations, ..Record::default() };
    let hit = hit.map(|(point, uv, depth)| ShellHit {
        t: point.t as f32,
        weights: point.weights.map(|w| w as f32),
        record: Record { uv, depth, hit: true, ..costs },
    });
    (hit, costs)
}

impl<H: HeightField> ShellMarch<'_, H> {
    /// Finds the first hit in any of the parts, between two distances: the point, its uv and its depth.
    fn first<F: Real>(
        &mut self,
        parts: &[[f64; 2]],
        [near, far]: [f64; 2],
        cross: &impl Fn(&Line<F>, F, u32) -> (SurfaceCrossing<F>, MarchCost),
    ) -> Option<(CurvePoint, [f32; 2], f32)> {
        let mut best: Option<(CurvePoint, [f32; 2], f32)> = None;
        for &[low, high] in parts {
            let room = OVERLAP * (high - low);
            let ends = [self.curve.at(low - room), self.curve.at(high + room)];
            if !ends.iter().all(|end| end.t.is_finite()) {
                continue;
            }
            let [mut from, to] = if ends[0].t <= ends[1].t { ends } else { [ends[1], ends[0]] };
            let limit = best.as_ref().map_or(far, |best| best.0.t);
            if to.t < near || from.t > limit {
                continue;
            }
            if from.t < near {
                from = self.curve.at(self.curve.offset_at(near, from.offset, to.offset));
            }
            let hit = self.part(from, to, cross);
            if let Some(hit) = hit.filter(|hit| hit.0.t >= near && hit.0.t <= limit) {
                best = Some(hit);
            }
        }
        best
    }

    /// Marches one part, chord by chord.
    fn part<F: Real>(
        &mut self,
        from: CurvePoint,
        to: CurvePoint,
        cross: &impl Fn(&Line<F>, F, u32) -> (SurfaceCrossing<F>, MarchCost),
    ) -> Option<(CurvePoint, [f32; 2], f32)> {
        let mut below = self.is_below(&from);
        if below && self.sides == Sides::Above {
            return None;
        }
        let at = |this: &Self, position: u32| {
            let x = f64::from(position) / f64::from(MOST_CHORDS);
            this.curve.at(from.offset + (to.offset - from.offset) * x)
        };
        let (mut position, mut start) = (0, from);
        let mut step = MOST_CHORDS;
        while position < MOST_CHORDS && self.cost.iterations < MAX_CELLS {
            // Steps stay powers of two that the position is a multiple of: halved until the chord is close to the curve, or until
            // nothing rises to it anywhere near.
            let end = if position + step == MOST_CHORDS { to } else { at(self, position + step) };
            let error = self.curve.chord_error(&start, &end, self.texels, self.texels_per_unit);
            if !(error <= self.chord_error) && step > 1 {
                if !below && self.is_clear(&start, &end, error) {
                    (position, start) = (position + step, end);
                    while position.is_multiple_of(2 * step) && step < MOST_CHORDS {
                        step *= 2;
                    }
                } else {
                    step /= 2;
                }
                continue;
            }
            if let Some(s) = self.chord(&start, &end, &mut below, cross) {
                let offset = start.offset + (end.offset - start.offset) * s;
                let point = self.curve.at(offset);
                let uv = [0, 1].map(|k| (start.uv[k] + (end.uv[k] - start.uv[k]) * s) as f32);
                let height = start.height + (end.height - start.height) * s;
                return Some((point, uv, (1.0 - height).clamp(0.0, 1.0) as f32));
            }
            (position, start) = (position + step, end);
            if position.is_multiple_of(2 * step) && step < MOST_CHORDS {
                step *= 2;
            }
        }
        None
    }

    /// Returns true if the surface stays below the curve between two points, which is this many texels from its chord at most: by the
    /// maximum over all cells near it.
    fn is_clear(&mut self, start: &CurvePoint, end: &CurvePoint, error: f64) -> bool {
        let Some(map) = self.field.pyramid().filter(|_| error.is_finite()) else { return false };
        let mut extent = 0.0f64;
        let cells = [0, 1].map(|k| {
            let [a, b] = [start.uv[k], end.uv[k]].map(|uv| uv * self.texels[k] - 0.5);
            let (first, last) = (a.min(b) - error - 0.01, a.max(b) + error + 0.01);
            extent = extent.max(last - first);
            [first.floor_int(), last.floor_int()]
        });
        let pyramid = map.pyramid;
        // Blocks about as large as the region.
        let level = (1..pyramid.top()).find(|level| f64::from(1u32 << (BITS * (level - 1))) * 4.0 >= extent);
        let Some((highest, fetches)) = highest_in(&map, level.unwrap_or(pyramid.top()), cells) else { return false };
        self.cost.fetches += fetches;
        let [low, step] = pyramid.quantization();
        let highest = f64::from(low + f32::from(highest) * step + pyramid.slack());
        start.height.min(end.height) - error / (self.texels_per_unit * self.curve.prism.depth) > highest
    }

    /// Returns the place in [0, 1] of a chord where it meets the surface.
    fn chord<F: Real>(
        &mut self,
        from: &CurvePoint,
        to: &CurvePoint,
        below: &mut bool,
        cross: &impl Fn(&Line<F>, F, u32) -> (SurfaceCrossing<F>, MarchCost),
    ) -> Option<f64> {
        let real = |x: f64| <F as num_traits::NumCast>::from(x).unwrap_or_else(F::zero);
        let slope = [0, 1].map(|k| to.uv[k] - from.uv[k]);
        let line = Line {
            uv: from.uv.map(real),
            slope: slope.map(real),
            height: real(from.height),
            dheight_ds: real(to.height - from.height),
        };
        let cells = MAX_CELLS - self.cost.iterations;
        if *below {
            let upside_down = Line { height: -line.height, dheight_ds: -line.dheight_ds, ..line };
            let (crossing, cost) = walk_cells(&Negated(self.field), &upside_down, F::zero(), F::one(), cells);
            self.add(cost);
            let SurfaceCrossing::At(s) = crossing else { return None };
            *below = false;
            return s.to_f64();
        }
        let (crossing, cost) = cross(&line, F::zero(), cells);
        self.add(cost);
        match crossing {
            SurfaceCrossing::At(s) | SurfaceCrossing::CutOff(s) => s.to_f64(),
            SurfaceCrossing::None => None,
        }
    }

    fn add(&mut self, cost: MarchCost) {
        self.cost.fetches += cost.fetches;
        self.cost.iterations = self.cost.iterations.saturating_add(cost.iterations);
    }

    /// Returns true if a point lies below the surface by more than rounding.
    fn is_below(&mut self, point: &CurvePoint) -> bool {
        self.cost.fetches += 1;
        f64::from(self.field.sample(point.uv.map(|x| x as f32))) - point.height > self.slack
    }
}
