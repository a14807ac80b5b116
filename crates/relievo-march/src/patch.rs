//! The intersection of a line with a bilinear patch, in closed form.

use crate::grid_line::Line;
use crate::real::Real;

/// Returns the distance beyond `s`, at most `length`, at which the line meets the bilinear patch over these corners, which
/// it enters at `at` in [0, 1]² and crosses with `d` texels per unit of s.
#[inline]
pub(crate) fn patch_crossing<F: Real>(
    corners: [F; 4],
    at: [F; 2],
    d: [F; 2],
    line: &Line<F>,
    s: F,
    length: F,
) -> Option<F> {
    let [c0, c1, c2] = clearance(corners, at, d, line, s);
    first_root(c0, c1, c2, length)
}

/// Returns the line's height above the patch as c0, c1, c2: c0 + c1·x + c2·x² at the distance x beyond `s`.
#[inline(always)]
pub(crate) fn clearance<F: Real>(
    [h00, h10, h01, h11]: [F; 4],
    [a, b]: [F; 2],
    d: [F; 2],
    line: &Line<F>,
    s: F,
) -> [F; 3] {
    let (beta, gamma, kappa) = (h10 - h00, h01 - h00, h00 - h10 - h01 + h11);
    let c0 = line.height + line.dheight_ds * s - (h00 + beta * a + gamma * b + kappa * a * b);
    let c1 = line.dheight_ds - (beta * d[0] + gamma * d[1] + kappa * (a * d[1] + b * d[0]));
    [c0, c1, -kappa * d[0] * d[1]]
}

/// Returns the smallest x in [0, length] with `c0 + c1·x + c2·x² ≤ 0`.
fn first_root<F: Real>(c0: F, c1: F, c2: F, length: F) -> Option<F> {
    if c0 <= F::zero() {
        return Some(F::zero());
    }
    let (half, four): (F, F) = (0.5.into(), 4.0.into());
    let discriminant = c1 * c1 - four * c2 * c0;
    if discriminant < F::zero() {
        return None;
    }
    // The stable form: no cancellation, and for c2 = 0 one root is infinite and the other right. signum(0) = 1.
    let q = -half * (c1 + c1.signum() * discriminant.sqrt());
    let inside = |x: F| if x > F::zero() && x <= length { x } else { F::infinity() };
    let x = inside(q / c2).min(inside(c0 / q));
    x.is_finite().then_some(x)
}
