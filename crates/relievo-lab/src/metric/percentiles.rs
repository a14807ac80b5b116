use serde::{Deserialize, Serialize};

/// Mean, percentiles and maximum of a quantity over pixels, rays or frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Percentiles {
    /// The mean.
    pub mean: f64,
    /// The median: half of the values are at most this.
    pub p50: f64,
    /// The 95th percentile: 95 % of the values are at most this.
    pub p95: f64,
    /// The 99th percentile: 99 % of the values are at most this.
    pub p99: f64,
    /// The largest value.
    pub max: f64,
}

impl Percentiles {
    /// Computes nearest-rank percentiles; all zeros if there are no values. NaN counts as the largest.
    #[must_use]
    pub fn of(values: impl IntoIterator<Item = f32>) -> Self {
        let mut sorted: Vec<f32> = values.into_iter().collect();
        let Some(last) = sorted.len().checked_sub(1) else { return Self::default() };
        sorted.sort_unstable_by(f32::total_cmp);
        let rank = |p: f64| f64::from(sorted[((p * sorted.len() as f64).ceil() as usize).saturating_sub(1).min(last)]);
        Self {
            mean: sorted.iter().map(|&x| f64::from(x)).sum::<f64>() / sorted.len() as f64,
            p50: rank(0.5),
            p95: rank(0.95),
            p99: rank(0.99),
            max: f64::from(sorted[last]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_values_that_occur() {
        let percentiles = Percentiles::of((1..=100).rev().map(|x| x as f32));
        assert_eq!(percentiles, Percentiles { mean: 50.5, p50: 50.0, p95: 95.0, p99: 99.0, max: 100.0 });
        assert_eq!(Percentiles::of([7.0]), Percentiles { mean: 7.0, p50: 7.0, p95: 7.0, p99: 7.0, max: 7.0 });
        assert_eq!(Percentiles::of([]), Percentiles::default());
    }
}
