//! Shaping functions of one or two numbers.

/// Interpolates linearly: `a` at t = 0, `b` at t = 1.
#[inline]
pub(crate) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// Interpolates colours linearly.
#[inline]
pub(crate) fn mix3(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    std::array::from_fn(|k| mix(a[k], b[k], t))
}

/// Smoothstep: 0 below `low`, 1 above `high`, a cubic between. `low < high`.
#[inline]
pub(crate) fn smoothstep(low: f32, high: f32, x: f32) -> f32 {
    // With constant bounds the division is done by the compiler.
    let t = ((x - low) * (1.0 / (high - low))).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Fades from 0 at t = 0 to 1 at t = 1, with no slope and no curvature at the ends (Perlin, "Improving noise", SIGGRAPH 2002).
#[inline]
pub(crate) fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// Smooth maximum: the corner is rounded where both differ by less than `k` (Quilez 2013, polynomial smooth minimum,
/// negated). Never below either, `k/4` above where they meet.
#[inline]
pub(crate) fn smooth_max(a: f32, b: f32, k: f32) -> f32 {
    let t = (k - (a - b).abs()).max(0.0) / k;
    a.max(b) + 0.25 * k * t * t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_max_is_exact_away_from_the_corner_and_rounds_it() {
        assert_eq!(smooth_max(1.0, 0.2, 0.1), 1.0);
        assert_eq!(smooth_max(0.2, 1.0, 0.1), 1.0);
        assert!((smooth_max(0.5, 0.5, 0.1) - 0.525).abs() < 1e-6);
    }
}
