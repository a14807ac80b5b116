//! Vectors of three f64.

pub(super) type Vector = [f64; 3];

/// Makes an array of three; `map` of arrays is not inlined.
#[inline(always)]
pub(super) fn three<T>(f: impl Fn(usize) -> T) -> [T; 3] {
    [f(0), f(1), f(2)]
}

/// Makes an array of two.
#[inline(always)]
pub(super) fn two<T>(f: impl Fn(usize) -> T) -> [T; 2] {
    [f(0), f(1)]
}

#[inline]
pub(super) fn add_scaled(a: Vector, b: Vector, s: f64) -> Vector {
    three(|k| a[k] + b[k] * s)
}

#[inline]
pub(super) fn sub(a: Vector, b: Vector) -> Vector {
    add_scaled(a, b, -1.0)
}

#[inline]
pub(super) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline]
pub(super) fn length(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// Returns two unit vectors at right angles to a unit vector and to each other (Duff et al. 2017).
pub(super) fn perpendicular(n: Vector) -> [Vector; 2] {
    let s = 1f64.copysign(n[2]);
    let a = -1.0 / (s + n[2]);
    let b = n[0] * n[1] * a;
    [[1.0 + s * n[0] * n[0] * a, s * b, -s * n[0]], [b, s + n[1] * n[1] * a, -n[1]]]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn perpendicular_vectors_make_a_right_handed_basis() {
        for n in [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.6, 0.0, 0.8], [-0.48, 0.6, -0.64], [1.0, 0.0, -0.0]] {
            let [u, v] = perpendicular(n);
            assert!(dot(u, v).abs() < 1e-15 && (length(u) - 1.0).abs() < 1e-15 && (length(v) - 1.0).abs() < 1e-15);
            assert!(length(sub(cross(u, v), n)) < 1e-15, "{n:?}");
        }
    }
}
