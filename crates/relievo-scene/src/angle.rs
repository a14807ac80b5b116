//! Angles in degrees.

/// Returns sine and cosine; exact for multiples of 90°, so that what is upright stays upright.
pub(crate) fn sin_cos_degrees(degrees: f32) -> (f32, f32) {
    let angle = f64::from(degrees).rem_euclid(360.0);
    match angle {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        _ => {
            let (sin, cos) = angle.to_radians().sin_cos();
            (sin as f32, cos as f32)
        }
    }
}
