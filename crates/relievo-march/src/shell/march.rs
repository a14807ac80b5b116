use super::curve::{Curve, CurvePoint};
use super::path::CurvedPath;
use super::prism::{Prism, ShellRay};
use super::vector::two;
use crate::cost::{MAX_CELLS, MarchCost};
use crate::exact::{MAX_ITERATIONS, SurfaceCrossing, descend, first_crossing, walk_cells};
use crate::field::Negated;
use crate::grid_line::Line;
use crate::pyramid::PyramidField;
use crate::real::Real;
use crate::{HeightField, Record};

/// The distance of a chord from the curve that it stands for, in texels.
const CHORD_ERROR: f64 = 1e-3;

/// The same for the oracle.
const ORACLE_CHORD_ERROR: f64 = 1e-5;

/// The most chords that a part of the curve is cut into: a power of two.
const MOST_CHORDS: u32 = 1 << 14;

/// The most pieces without a turn: a power of two.
const MOST_PIECES: u32 = 1 << 10;

/// The part by which a piece of the curve is continued beyond the walls, so that rounding opens no gap between neighbours.
const OVERLAP: f64 = 1e-6;

/// The part of its way to the end by which a ray that has come out of the surface goes on at least.
const LEAST_CLEARANCE: f64 = 1e-4;

/// Sides from which a surface counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sides {
    /// A ray meets it from above. One that comes over a triangle below the surface, through an open border or from behind, sees
    /// what it meets after it has come out. For pictures.
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

/// The end of a march through a shell that stops where a ray comes over the triangle below the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShellOutcome {
    /// The first point of the relief.
    Hit(ShellHit),
    /// Nothing.
    Miss,
    /// The ray comes over the triangle at this distance, below the surface; [`march_shell`] tells what it meets once it is out.
    Hidden(f32),
}

/// Marches a ray through the shell over one triangle: finds the first point of the relief with a distance in `range`.
///
/// Ends for every input; numbers that are not finite are a miss. The record holds the cost in either case. Follows the curve
/// through the max pyramid; over fields without one by chords within 1/1000 of a texel.
#[must_use]
pub fn march_shell(
    field: &impl HeightField,
    prism: &Prism,
    ray: &ShellRay,
    range: [f32; 2],
    sides: Sides,
) -> (Option<ShellHit>, Record) {
    let (found, record) = march_by(field, prism, ray, (range, Below::from(sides), CHORD_ERROR), ShellMarch::forward);
    (found.hit(), record)
}

/// Marches as [`march_shell`] does with [`Sides::Above`], but leaves out what a ray meets that comes over the triangle below the
/// surface: mostly something else hides it.
#[must_use]
pub fn march_shell_from_above(
    field: &impl HeightField,
    prism: &Prism,
    ray: &ShellRay,
    range: [f32; 2],
) -> (ShellOutcome, Record) {
    march_by(field, prism, ray, (range, Below::Stops, CHORD_ERROR), ShellMarch::forward)
}

/// Marches as [`march_shell`] does, in f64 and by chords within 1/100000 of a texel: the reference on meshes.
#[must_use]
pub fn oracle_shell(
    field: &impl HeightField,
    prism: &Prism,
    ray: &ShellRay,
    range: [f32; 2],
    sides: Sides,
) -> (Option<ShellHit>, Record) {
    let settings = (range, Below::from(sides), ORACLE_CHORD_ERROR);
    let (found, record) = march_by(field, prism, ray, settings, |march, from, to| {
        march.chords::<f64>(from, to, |line, cells| walk_cells(field, line, 0.0, 1.0, cells))
    });
    (found.hit(), record)
}

impl ShellOutcome {
    fn hit(self) -> Option<ShellHit> {
        match self {
            Self::Hit(hit) => Some(hit),
            Self::Miss | Self::Hidden(_) => None,
        }
    }
}

/// What becomes of a ray that comes over the triangle below the surface.
#[derive(Clone, Copy)]
enum Below {
    /// It meets the surface where it comes out.
    Hits,
    /// It goes on from where it comes out.
    Passes,
    Stops,
}

impl From<Sides> for Below {
    fn from(sides: Sides) -> Self {
        match sides {
            Sides::Above => Self::Passes,
            Sides::Both => Self::Hits,
        }
    }
}

/// A march in progress.
struct ShellMarch<'a, H> {
    field: &'a H,
    curve: Curve<'a>,
    below: Below,
    /// The distance at which the ray was stopped first.
    hidden: Option<f64>,
    chord_error: f64,
    texels: [f64; 2],
    texels_per_unit: f64,
    /// The height by which a ray may be below the surface and still count as on it.
    slack: f64,
    cost: MarchCost,
}

fn march_by<'a, H: HeightField>(
    field: &'a H,
    prism: &'a Prism,
    ray: &ShellRay,
    (range, below, chord_error): ([f32; 2], Below, f64),
    forward: impl Fn(&mut ShellMarch<'a, H>, CurvePoint, CurvePoint) -> Option<f64>,
) -> (ShellOutcome, Record) {
    let numbers = ray.origin.iter().chain(&ray.direction);
    if !prism.is_usable() || !numbers.into_iter().all(|x| x.is_finite()) {
        return (ShellOutcome::Miss, Record::default());
    }
    let curve = Curve::new(prism, ray);
    let inside = curve.inside(prism.offsets(field.range()));
    if inside.as_slice().is_empty() {
        return (ShellOutcome::Miss, Record::default());
    }
    let size = field.size();
    let texels_per_unit = prism.texels_per_unit(size);
    let slack = 4.0 * CHORD_ERROR / (prism.depth * texels_per_unit) + 1e-5;
    let mut march = ShellMarch {
        field,
        curve,
        below,
        hidden: None,
        chord_error,
        texels: size.map(f64::from),
        texels_per_unit,
        slack: if slack.is_finite() { slack } else { 1.0 },
        cost: MarchCost::default(),
    };
    let hit = march.first(inside.as_slice(), range.map(f64::from), &forward);
    let cost = march.cost;
    let costs = Record { fetches: cost.fetches, iterations: cost.iterations, ..Record::default() };
    let found = match (hit, march.hidden) {
        (hit, Some(t)) if hit.is_none_or(|hit| t < hit.t) => ShellOutcome::Hidden(t as f32),
        (Some(point), _) => ShellOutcome::Hit(ShellHit {
            t: point.t as f32,
            weights: point.weights.map(|w| w as f32),
            record: Record {
                uv: point.uv.map(|x| x as f32),
                depth: (1.0 - point.height).clamp(0.0, 1.0) as f32,
                hit: true,
                ..costs
            },
        }),
        (None, _) => ShellOutcome::Miss,
    };
    (found, costs)
}

impl<'a, H: HeightField> ShellMarch<'a, H> {
    /// Finds the first hit in any of the parts, between two distances.
    fn first(
        &mut self,
        parts: &[[f64; 2]],
        [near, far]: [f64; 2],
        forward: &impl Fn(&mut Self, CurvePoint, CurvePoint) -> Option<f64>,
    ) -> Option<CurvePoint> {
        let mut best: Option<CurvePoint> = None;
        for &[low, high] in parts {
            let room = OVERLAP * (high - low);
            let ends = [self.curve.at(low - room), self.curve.at(high + room)];
            if !ends.iter().all(|end| end.t.is_finite()) {
                continue;
            }
            let [mut from, to] = if ends[0].t <= ends[1].t { ends } else { [ends[1], ends[0]] };
            let limit = best.as_ref().map_or(far, |best| best.t);
            if to.t < near || from.t > limit {
                continue;
            }
            if from.t < near {
                from = self.curve.at(self.curve.offset_at(near, from.offset, to.offset));
            }
            let hit = self.part(from, to, forward).map(|offset| self.curve.at(offset));
            if let Some(hit) = hit.filter(|hit| hit.t >= near && hit.t <= limit) {
                best = Some(hit);
            }
        }
        best
    }

    /// Marches one part; returns the offset of its first hit.
    fn part(
        &mut self,
        from: CurvePoint,
        to: CurvePoint,
        forward: &impl Fn(&mut Self, CurvePoint, CurvePoint) -> Option<f64>,
    ) -> Option<f64> {
        if !self.is_below(&from) {
            return forward(self, from, to);
        }
        if matches!(self.below, Below::Stops) {
            self.hidden = Some(self.hidden.map_or(from.t, |t| t.min(from.t)));
            return None;
        }
        let turned = Negated(self.field);
        let out = self.chords::<f64>(from, to, |line, cells| {
            let upside_down = Line { height: -line.height, dheight_ds: -line.dheight_ds, ..*line };
            walk_cells(&turned, &upside_down, 0.0, 1.0, cells)
        })?;
        if matches!(self.below, Below::Hits) {
            return Some(out);
        }
        // The point where it comes out is on the surface: on from where it is above that by more than rounding.
        let mut part = LEAST_CLEARANCE;
        loop {
            let beyond = self.curve.at(out + (to.offset - out) * part);
            if self.clearance(&beyond) > self.slack {
                return forward(self, beyond, to);
            }
            part *= 2.0;
            if part >= 1.0 {
                return None;
            }
        }
    }

    /// Marches the curve between two points by the fastest march there is for the field; returns the offset of its first hit.
    fn forward(&mut self, from: CurvePoint, to: CurvePoint) -> Option<f64> {
        let field = self.field;
        match field.pyramid() {
            Some(map) if !self.is_straight(&from, &to) => self.pieces(&map, from, to),
            _ => self.chords::<f32>(from, to, |line, cells| first_crossing(field, line, 0.0, 1.0, cells)),
        }
    }

    /// Returns true if one chord between two points is close enough to the curve.
    fn is_straight(&self, from: &CurvePoint, to: &CurvePoint) -> bool {
        self.curve.chord_error(from, to, self.texels, self.texels_per_unit) <= self.chord_error
    }

    /// Marches the curve between two points through the pyramid, piece by piece; returns the offset of its first hit.
    fn pieces(&mut self, map: &PyramidField<'_>, from: CurvePoint, to: CurvePoint) -> Option<f64> {
        let at = |position: u32| from.offset + (to.offset - from.offset) * f64::from(position) / f64::from(MOST_PIECES);
        let (mut position, mut step) = (0, MOST_PIECES);
        while position < MOST_PIECES && self.cost.iterations < MAX_ITERATIONS {
            // Steps stay powers of two that the position is a multiple of: halved until u and v keep their directions.
            let ends = [at(position), at(position + step)];
            let path = CurvedPath::new(&self.curve, ends, map.pyramid, self.field.range()[1]);
            let Some(path) = path else {
                if step > 1 {
                    step /= 2;
                    continue;
                }
                let ends = ends.map(|offset| self.curve.at(offset));
                let cross = |line: &Line<f32>, cells| walk_cells(self.field, line, 0.0, 1.0, cells);
                if let Some(offset) = self.chords(ends[0], ends[1], cross) {
                    return Some(offset);
                }
                position += 1;
                continue;
            };
            let [start, end] = path.below_lid;
            let cells = MAX_ITERATIONS - self.cost.iterations;
            let (crossing, cost) = descend(self.field, map, &path, start, end, cells);
            self.add(cost);
            if let SurfaceCrossing::At(s) | SurfaceCrossing::CutOff(s) = crossing {
                return Some(ends[0] + (ends[1] - ends[0]) * f64::from(s));
            }
            position += step;
            if position.is_multiple_of(2 * step) && step < MOST_PIECES {
                step *= 2;
            }
        }
        None
    }

    /// Marches the curve between two points chord by chord, each by `cross`, which gets the most cells too; returns the offset of
    /// the first crossing.
    fn chords<F: Real>(
        &mut self,
        from: CurvePoint,
        to: CurvePoint,
        cross: impl Fn(&Line<F>, u32) -> (SurfaceCrossing<F>, MarchCost),
    ) -> Option<f64> {
        let at = |this: &Self, position: u32| {
            let x = f64::from(position) / f64::from(MOST_CHORDS);
            this.curve.at(from.offset + (to.offset - from.offset) * x)
        };
        let real = |x: f64| <F as num_traits::NumCast>::from(x).unwrap_or_else(F::zero);
        let (mut position, mut start) = (0, from);
        let mut step = MOST_CHORDS;
        while position < MOST_CHORDS && self.cost.iterations < MAX_CELLS {
            // Steps stay powers of two that the position is a multiple of: halved until the chord is close to the curve.
            let end = if position + step == MOST_CHORDS { to } else { at(self, position + step) };
            if step > 1 && !self.is_straight(&start, &end) {
                step /= 2;
                continue;
            }
            let line = Line {
                uv: start.uv.map(real),
                slope: two(|k| real(end.uv[k] - start.uv[k])),
                height: real(start.height),
                dheight_ds: real(end.height - start.height),
            };
            let (crossing, cost) = cross(&line, MAX_CELLS - self.cost.iterations);
            self.add(cost);
            if let SurfaceCrossing::At(s) | SurfaceCrossing::CutOff(s) = crossing {
                return s.to_f64().map(|s| start.offset + (end.offset - start.offset) * s);
            }
            (position, start) = (position + step, end);
            if position.is_multiple_of(2 * step) && step < MOST_CHORDS {
                step *= 2;
            }
        }
        None
    }

    fn add(&mut self, cost: MarchCost) {
        self.cost.fetches += cost.fetches;
        self.cost.iterations = self.cost.iterations.saturating_add(cost.iterations);
    }

    /// Returns true if a point lies below the surface by more than rounding.
    fn is_below(&mut self, point: &CurvePoint) -> bool {
        self.clearance(point) < -self.slack
    }

    /// Returns the height of a point above the surface.
    fn clearance(&mut self, point: &CurvePoint) -> f64 {
        self.cost.fetches += 1;
        point.height - f64::from(self.field.sample(two(|k| point.uv[k] as f32)))
    }
}
