//! The mean of the normals that a pixel covers, and what their scatter does to highlights.
//!
//! Gives RelievoMeanNormal, relievo_mean_normal_length, relievo_mean_normal_variance, relievo_mean_normal_roughness.
//! Needs nothing.

struct RelievoMeanNormal {
    // Of unit length.
    direction: vec3f,
    // Of the mean of unit normals, in (0, 1]: 1 where all are one, less the more they scatter (Toksvig 2005).
    length: f32,
}

// The length of the mean where slopes have this mean variance along an axis.
fn relievo_mean_normal_length(variance: f32) -> f32 {
    return 1.0 / (1.0 + variance);
}

// The variance of the slopes along an axis that goes with a mean's length (Toksvig 2005).
fn relievo_mean_normal_variance(mean: f32) -> f32 {
    // Normals all around, or none: as rough as can be.
    return (1.0 - mean) / max(mean, 1e-3);
}

// A roughness together with the scatter of normals: both widen the highlight, their variances add up (Olano and Baker 2010;
// for GGX, Kaplanyan et al. 2016). The variance of a slope along an axis is half of α².
fn relievo_mean_normal_roughness(roughness: f32, mean: f32) -> f32 {
    if mean >= 1.0 {
        return roughness;
    }
    // As the reflection bounds it.
    let bounded = clamp(roughness, 0.045, 1.0);
    let squared = bounded * bounded;
    return sqrt(sqrt(min(squared * squared + 2.0 * relievo_mean_normal_variance(mean), 1.0)));
}
