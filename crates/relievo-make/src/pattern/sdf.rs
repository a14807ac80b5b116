//! Signed distance functions of plane shapes and their booleans: negative inside.
//!
//! Exact distances after Quilez, "2D distance functions" (2018), except where an item says otherwise. Booleans keep the
//! zero line exact and distances a bound.

/// Distance to a disc of `radius` around the origin.
#[must_use]
pub fn circle(p: [f32; 2], radius: f32) -> f32 {
    p[0].hypot(p[1]) - radius
}

/// Distance to a rectangle around the origin with half sides `half`.
#[must_use]
pub fn rectangle(p: [f32; 2], half: [f32; 2]) -> f32 {
    let q = [p[0].abs() - half[0], p[1].abs() - half[1]];
    q[0].max(0.0).hypot(q[1].max(0.0)) + q[0].max(q[1]).min(0.0)
}

/// Distance to a regular polygon of `sides` (at least 3) around the origin, `radius` from its middle to its sides; one side
/// is at the bottom.
#[must_use]
pub fn polygon(p: [f32; 2], radius: f32, sides: u32) -> f32 {
    let step = std::f32::consts::TAU / sides.max(3) as f32;
    // Turned so that the nearest side is vertical, at x = radius.
    let angle = p[0].atan2(p[1]);
    let (sin, cos) = (angle - step * (angle / step).round()).sin_cos();
    let length = p[0].hypot(p[1]);
    let (along, across) = (length * cos - radius, (length * sin).abs() - radius * (0.5 * step).tan());
    if across > 0.0 && along > -radius { along.max(0.0).hypot(across).max(along) } else { along }
}

/// Distance to a star of `points` (at least 3) around the origin with its tips at `radius`; `inner` is the radius of its notches.
#[must_use]
pub fn star(p: [f32; 2], radius: f32, inner: f32, points: u32) -> f32 {
    let half = std::f32::consts::PI / points.max(3) as f32;
    let angle = p[0].atan2(-p[1]);
    let folded = (angle - 2.0 * half * (angle / (2.0 * half)).round()).abs();
    let (sin, cos) = folded.sin_cos();
    let length = p[0].hypot(p[1]);
    let q = [length * cos, length * sin];
    let (tip, notch) = ([radius, 0.0], [inner * half.cos(), inner * half.sin()]);
    let d = segment(q, tip, notch, 0.0);
    let side = (notch[0] - tip[0]) * (q[1] - tip[1]) - (notch[1] - tip[1]) * (q[0] - tip[0]);
    if side > 0.0 { -d } else { d }
}

/// Distance to a stroke of half width `radius` with round ends from `a` to `b`.
#[must_use]
pub fn segment(p: [f32; 2], a: [f32; 2], b: [f32; 2], radius: f32) -> f32 {
    let (pa, ba) = ([p[0] - a[0], p[1] - a[1]], [b[0] - a[0], b[1] - a[1]]);
    let length = ba[0] * ba[0] + ba[1] * ba[1];
    let t = if length > 0.0 { ((pa[0] * ba[0] + pa[1] * ba[1]) / length).clamp(0.0, 1.0) } else { 0.0 };
    (pa[0] - t * ba[0]).hypot(pa[1] - t * ba[1]) - radius
}

/// Union: inside either.
#[must_use]
pub fn union(a: f32, b: f32) -> f32 {
    a.min(b)
}

/// Intersection: inside both.
#[must_use]
pub fn intersection(a: f32, b: f32) -> f32 {
    a.max(b)
}

/// Difference: inside `a` but not `b`.
#[must_use]
pub fn difference(a: f32, b: f32) -> f32 {
    a.max(-b)
}

/// Smooth union: the inner corner is filled over a length of about `k` (> 0) (Quilez 2013, polynomial smooth minimum).
#[must_use]
pub fn smooth_union(a: f32, b: f32, k: f32) -> f32 {
    -crate::curve::smooth_max(-a, -b, k)
}

/// Grows the shape by `radius`: corners become round. To keep its size, shrink it by as much first.
#[must_use]
pub fn rounded(d: f32, radius: f32) -> f32 {
    d - radius
}

/// Keeps only the outline, as a band of half width `half`.
#[must_use]
pub fn outline(d: f32, half: f32) -> f32 {
    d.abs() - half
}

/// Rotates `p` by `angle` (radians; with v down, clockwise).
#[must_use]
pub fn turned(p: [f32; 2], angle: f32) -> [f32; 2] {
    let (sin, cos) = angle.sin_cos();
    [p[0] * cos + p[1] * sin, p[1] * cos - p[0] * sin]
}

/// Repeats space on a grid of `columns × rows` cells: returns the offset of (u, v) from the middle of its cell, in uv, and
/// the cell (column, row). Odd rows begin `stagger` of a cell later.
#[must_use]
pub fn repeated(uv: [f32; 2], columns: u32, rows: u32, stagger: f32) -> ([f32; 2], [u32; 2]) {
    let (columns, rows) = (columns.max(1), rows.max(1));
    let place = |x: f32, cells: u32| {
        let x = crate::noise::wrap_unit(x) * cells as f32;
        let i = (x as u32).min(cells - 1);
        ((x - i as f32 - 0.5) / cells as f32, i)
    };
    let (y, row) = place(uv[1], rows);
    let offset = if row % 2 == 1 { stagger / columns as f32 } else { 0.0 };
    let (x, column) = place(uv[0] - offset, columns);
    ([x, y], [column, row])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The distance to the zero line, found by brute force on a fine grid.
    fn brute(p: [f32; 2], shape: impl Fn([f32; 2]) -> f32) -> f32 {
        let inside = shape(p) < 0.0;
        let mut nearest = f32::MAX;
        for j in -150..=150 {
            for i in -150..=150 {
                let q = [i as f32 / 100.0, j as f32 / 100.0];
                if (shape(q) < 0.0) != inside {
                    nearest = nearest.min((p[0] - q[0]).hypot(p[1] - q[1]));
                }
            }
        }
        if inside { -nearest } else { nearest }
    }

    #[test]
    fn distances_are_those_found_by_brute_force() {
        type Shape<'a> = (&'a str, &'a dyn Fn([f32; 2]) -> f32);
        let shapes: [Shape<'_>; 6] = [
            ("circle", &|p| circle(p, 0.6)),
            ("rectangle", &|p| rectangle(p, [0.7, 0.3])),
            ("triangle", &|p| polygon(p, 0.4, 3)),
            ("hexagon", &|p| polygon(p, 0.6, 6)),
            ("star", &|p| star(p, 0.8, 0.35, 5)),
            ("segment", &|p| segment(p, [-0.4, 0.1], [0.5, -0.3], 0.2)),
        ];
        for (name, shape) in shapes {
            for p in [[0.05, 0.02], [0.4, 0.35], [-0.9, 0.2], [0.1, -0.8], [0.85, 0.9], [-0.3, -0.25]] {
                let (got, expected) = (shape(p), brute(p, shape));
                assert!((got - expected).abs() < 0.02, "{name} {p:?}: {got} for {expected}");
            }
        }
    }

    #[test]
    fn booleans_have_the_insides_that_their_names_say() {
        let (a, b) = (-0.2, 0.3);
        assert!(union(a, b) < 0.0 && intersection(a, b) > 0.0 && difference(a, b) < 0.0 && difference(b, a) > 0.0);
        assert!(smooth_union(0.01, 0.01, 0.2) < 0.0 && smooth_union(0.5, 0.1, 0.2) == 0.1);
        assert!((rounded(0.3, 0.1) - 0.2).abs() < 1e-6 && (outline(-0.3, 0.1) - 0.2).abs() < 1e-6);
    }

    #[test]
    fn repetition_closes_at_the_seam() {
        for (columns, rows, stagger) in [(3, 4, 0.5), (5, 2, 0.3), (1, 1, 0.0)] {
            for k in 0..50 {
                let v = k as f32 / 64.0;
                assert_eq!(repeated([0.0, v], columns, rows, stagger), repeated([1.0, v], columns, rows, stagger));
                let ([x, y], [i, j]) = repeated([k as f32 / 50.0, v], columns, rows, stagger);
                assert!(x.abs() <= 0.5001 / columns as f32 && y.abs() <= 0.5001 / rows as f32);
                assert!(i < columns && j < rows);
            }
        }
    }
}
