use super::prism::{Prism, ShellRay};
use super::vector::{Vector, add_scaled, dot, length, perpendicular, sub, three, two};

/// The cosine between a ray and the normal of a triangle below which it counts as running along it, and by which it is tilted
/// then: along e there would be nothing to march.
const ALONG: f64 = 1e-7;

/// Three coefficients of a quadratic: of powers, or in Bernstein form.
pub(super) type Quadratic = [f64; 3];

/// The straight ray seen from the shell: along the offset e its barycentric weights are `w[k](e)/Σw(e)`.
pub(super) struct Curve<'a> {
    pub(super) prism: &'a Prism,
    /// Signed areas, twice, that the ray's point spans with the edges of the offset triangle, seen along the ray.
    w: [Quadratic; 3],
    /// Point of the ray near the triangle, and its distance from the origin.
    anchor: Vector,
    anchor_t: f64,
    direction: Vector,
}

/// A point of the curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct CurvePoint {
    pub(super) offset: f64,
    pub(super) weights: [f64; 3],
    pub(super) uv: [f64; 2],
    pub(super) height: f64,
    /// Distance along the ray.
    pub(super) t: f64,
    /// The interpolated normal's length.
    normal_length: f64,
    normal: Vector,
}

impl<'a> Curve<'a> {
    pub(super) fn new(prism: &'a Prism, ray: &ShellRay) -> Self {
        let [a, b, c] = prism.positions;
        let origin = three(|k| f64::from(ray.origin[k]));
        let mut direction = three(|k| f64::from(ray.direction[k]));
        let middle = three(|k| (a[k] + b[k] + c[k]) / 3.0);
        let anchor_t = dot(sub(middle, origin), direction);
        let anchor = add_scaled(origin, direction, anchor_t);
        let normal = prism.area_vector();
        let area = length(normal);
        let cos = dot(direction, normal);
        if cos.abs() < ALONG * area {
            direction = add_scaled(direction, normal, 2.0 * ALONG.copysign(cos) / area);
        }
        let [right, up] = perpendicular(direction);
        let project = |v: Vector| [dot(v, right), dot(v, up)];
        let p = three(|k| project(sub(prism.positions[k], anchor)));
        let n = three(|k| project(prism.normals[k]));
        let perp = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
        // The weight of a corner is the area over the edge between the others.
        let w = three(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            [perp(p[i], p[j]), perp(p[i], n[j]) + perp(n[i], p[j]), perp(n[i], n[j])]
        });
        Self { prism, w, anchor, anchor_t, direction }
    }

    /// Returns the parts of [low, high] in which the ray is over the triangle, in rising order; at most seven.
    pub(super) fn inside(&self, [low, high]: [f64; 2]) -> Parts {
        // The least and the greatest of each weight: of its Bernstein coefficients.
        let w = self.bernstein([low, high]);
        let bounds = three(|k| [w[k][0].min(w[k][1]).min(w[k][2]), w[k][0].max(w[k][1]).max(w[k][2])]);
        let (above, below) = (|w: &[f64; 2]| w[0] > 0.0, |w: &[f64; 2]| w[1] < 0.0);
        let mut parts = Parts::default();
        if bounds.iter().any(above) && bounds.iter().any(below) {
            return parts;
        }
        if bounds.iter().all(above) || bounds.iter().all(below) {
            parts.push([low, high]);
            return parts;
        }
        let mut borders = [f64::NAN; 8];
        let mut count = 0;
        let mut add = |e: f64| {
            borders[count] = e;
            count += 1;
        };
        add(low);
        for w in &self.w {
            for root in roots(w) {
                if root > low && root < high {
                    add(root);
                }
            }
        }
        add(high);
        let borders = &mut borders[..count];
        borders.sort_unstable_by(f64::total_cmp);
        for pair in borders.windows(2) {
            let middle = 0.5 * (pair[0] + pair[1]);
            let w = three(|k| value(&self.w[k], middle));
            let inside = w.iter().all(|&w| w >= 0.0) || w.iter().all(|&w| w <= 0.0);
            if inside && pair[0] < pair[1] && w.iter().sum::<f64>() != 0.0 {
                parts.push([pair[0], pair[1]]);
            }
        }
        parts
    }

    /// Returns the weights, not divided by their sum, in Bernstein form between two offsets.
    pub(super) fn bernstein(&self, [from, to]: [f64; 2]) -> [Quadratic; 3] {
        three(|k| {
            let w = self.w[k];
            let start = value(&w, from);
            [start, start + 0.5 * (to - from) * (w[1] + 2.0 * w[2] * from), value(&w, to)]
        })
    }

    /// Returns the point at an offset.
    pub(super) fn at(&self, offset: f64) -> CurvePoint {
        let w = three(|k| value(&self.w[k], offset));
        let sum = w[0] + w[1] + w[2];
        let per_sum = 1.0 / sum;
        let weights = three(|k| w[k] * per_sum);
        let prism = self.prism;
        let interpolated =
            |of: &[Vector; 3]| three(|i| weights[0] * of[0][i] + weights[1] * of[1][i] + weights[2] * of[2][i]);
        let normal = interpolated(&prism.normals);
        let point = add_scaled(interpolated(&prism.positions), normal, offset);
        CurvePoint {
            offset,
            weights,
            uv: two(|i| weights[0] * prism.uvs[0][i] + weights[1] * prism.uvs[1][i] + weights[2] * prism.uvs[2][i]),
            height: prism.height(offset, normal),
            t: self.anchor_t + dot(sub(point, self.anchor), self.direction),
            normal_length: length(normal),
            normal,
        }
    }

    /// Returns how far the chord between two points is from the curve at most, in texels of a map with `texels` along u and v
    /// and `texels_per_unit` in scene space.
    ///
    /// With the quadratics in Bernstein form over the part, W and ΣW = S, the weights differ from those of the chord by
    /// `x(1 − x)·((1 − x)·A + x·B)/S(x)`: at most ¼·max(|A|, |B|)/min S. Lengths of normals differ by what the normals do, and by
    /// how a length bends along a line of them.
    pub(super) fn chord_error(&self, a: &CurvePoint, b: &CurvePoint, texels: [f64; 2], texels_per_unit: f64) -> f64 {
        let length_e = b.offset - a.offset;
        let bernstein = self.bernstein([a.offset, b.offset]);
        let s = three(|i| bernstein[0][i] + bernstein[1][i] + bernstein[2][i]);
        let least = s.iter().map(|x| x * s[0].signum()).fold(f64::INFINITY, f64::min);
        if !(least > 0.0) {
            return f64::INFINITY;
        }
        let error = three(|k| {
            let [w0, w1, w2] = bernstein[k];
            let (from, to) = (a.weights[k], b.weights[k]);
            let first = w0 + 2.0 * w1 - s[0] * to - 2.0 * s[1] * from;
            let second = w2 + 2.0 * w1 - s[2] * from - 2.0 * s[1] * to;
            0.25 * first.abs().max(second.abs()) / least
        });
        let prism = self.prism;
        let uv_error = |i: usize| {
            let reach = |k: usize| error[k] * (prism.uvs[k][i] - prism.uvs[0][i]).abs();
            (reach(1) + reach(2)) * texels[i]
        };
        let bend = |k: usize| error[k] * length(sub(prism.normals[k], prism.normals[0]));
        let turned = sub(b.normal, a.normal);
        let normal_error = bend(1) + bend(2) + dot(turned, turned) / (8.0 * prism.shortest_normal());
        let offset = a.offset.abs().max(b.offset.abs());
        let height_error = offset * normal_error + 0.25 * (length_e * (b.normal_length - a.normal_length)).abs();
        uv_error(0).max(uv_error(1)).max(height_error * texels_per_unit)
    }

    /// Returns the offset in [from, to] at which the ray is at distance t from its origin; t grows from `from` to `to`.
    pub(super) fn offset_at(&self, t: f64, mut from: f64, mut to: f64) -> f64 {
        for _ in 0..60 {
            let middle = 0.5 * (from + to);
            if self.at(middle).t < t {
                from = middle;
            } else {
                to = middle;
            }
        }
        0.5 * (from + to)
    }
}

/// Up to seven intervals.
#[derive(Default)]
pub(super) struct Parts {
    parts: [[f64; 2]; 7],
    count: usize,
}

impl Parts {
    /// Adds an interval, or lengthens the last one where it goes on.
    fn push(&mut self, part: [f64; 2]) {
        if self.count > 0 && self.parts[self.count - 1][1] == part[0] {
            self.parts[self.count - 1][1] = part[1];
        } else {
            self.parts[self.count] = part;
            self.count += 1;
        }
    }

    pub(super) fn as_slice(&self) -> &[[f64; 2]] {
        &self.parts[..self.count]
    }
}

fn value(q: &Quadratic, x: f64) -> f64 {
    q[0] + x * (q[1] + x * q[2])
}

/// Returns the roots of a quadratic, NaN where there are none.
fn roots(&[c, b, a]: &Quadratic) -> [f64; 2] {
    let discriminant = b * b - 4.0 * a * c;
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    [q / a, c / q]
}
