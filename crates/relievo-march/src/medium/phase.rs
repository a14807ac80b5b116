/// Returns the share of scattered light that leaves per steradian at this cosine from its way before (Henyey and Greenstein
/// 1941): over the sphere it is 1. `g` in (−1, 1) is the mean cosine: 0 scatters evenly, 1 forwards.
#[inline]
#[must_use]
pub fn henyey_greenstein(cos: f32, g: f32) -> f32 {
    let g2 = g * g;
    let base = (1.0 + g2 - 2.0 * g * cos).max(1e-6);
    (1.0 - g2) / (4.0 * std::f32::consts::PI * base * base.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_light_that_is_scattered_goes_somewhere_and_g_is_its_mean_cosine() {
        for g in [-0.9, -0.3, 0.0, 0.5, 0.95] {
            let n = 2_000_000;
            let (mut sum, mut mean) = (0.0f64, 0.0f64);
            for i in 0..n {
                let cos = (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
                let share = f64::from(henyey_greenstein(cos as f32, g)) * 4.0 * std::f64::consts::PI / f64::from(n);
                sum += share;
                mean += share * cos;
            }
            assert!((sum - 1.0).abs() < 1e-4 && (mean - f64::from(g)).abs() < 1e-4, "{g}: {sum} {mean}");
        }
    }
}
