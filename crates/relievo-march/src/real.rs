use num_traits::Float;

/// A floating-point number to march with: f32 for drawing, f64 for the oracle.
pub(crate) trait Real: Float + From<f32> {
    /// Converts an integer to the nearest number.
    fn int(i: i32) -> Self;
    /// Returns the largest integer not above; saturating, 0 for NaN.
    fn floor_int(self) -> i32;
    /// Rounds to f32.
    fn single(self) -> f32;
}

impl Real for f32 {
    #[inline]
    fn int(i: i32) -> Self {
        i as Self
    }
    #[inline]
    fn floor_int(self) -> i32 {
        // `floor` is a call on x86-64 without SSE 4.1.
        let truncated = self as i32;
        if (truncated as Self) > self { truncated.wrapping_sub(1) } else { truncated }
    }
    #[inline]
    fn single(self) -> f32 {
        self
    }
}

impl Real for f64 {
    #[inline]
    fn int(i: i32) -> Self {
        Self::from(i)
    }
    #[inline]
    fn floor_int(self) -> i32 {
        self.floor() as i32
    }
    #[inline]
    fn single(self) -> f32 {
        self as f32
    }
}
