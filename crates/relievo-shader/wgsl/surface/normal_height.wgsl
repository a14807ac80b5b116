//! The mean normal of the height map's slopes: central differences over one texel.
//!
//! Gives relievo_normal_of_heights.
//! Needs in the place of the normal map, for level of detail, how slopes scatter within a texel of each level: variances
//! along u and v and the covariance, with slopes in height per texel of the full-size map.
//! #import tangent
//! #import surface
//! #import mean_normal

// The slope per texture repeat at a uv.
fn relievo_height_slope(field: RelievoHeightField, uv: vec2f, step: vec2f) -> vec2f {
    return vec2f(
        relievo_height_sample(field, uv + vec2f(step.x, 0.0)) - relievo_height_sample(field, uv - vec2f(step.x, 0.0)),
        relievo_height_sample(field, uv + vec2f(0.0, step.y)) - relievo_height_sample(field, uv - vec2f(0.0, step.y)),
    ) / (2.0 * step);
}

fn relievo_normal_of_heights(
    at: RelievoTangentFrame, field: RelievoHeightField, uv: vec2f, footprint: RelievoFootprint,
) -> RelievoMeanNormal {
    // The tops of columns are level.
    if RELIEVO_NEAREST && RELIEVO_TECHNIQUE_MARCHES {
        return RelievoMeanNormal(at.frame[2], 1.0);
    }
    if !RELIEVO_LOD {
        let gradient = (relievo_height_slope(field, uv, 0.5 / vec2f(field.size)) * at.to_uv) * at.full_depth;
        return RelievoMeanNormal(relievo_normalized_or(at.frame * vec3f(-gradient, 1.0), at.frame[2]), 1.0);
    }
    let size = vec2f(textureDimensions(relievo_heights));
    let probes = relievo_footprint_probes(footprint, size);
    let level = relievo_surface_level(probes.lod);
    // Over one texel between levels too.
    let step = 0.5 * exp2(probes.lod) / size;
    var sum = vec3f(0.0);
    for (var i = 0u; i < probes.count; i++) {
        let probe = relievo_probe_uv(probes, uv, i);
        let gradient = (relievo_height_slope(level, probe, step) * at.to_uv) * at.full_depth;
        let inside = relievo_surface_uv(probe, probes.lod, size);
        let scatter = textureSampleLevel(relievo_normal_map, relievo_map_sampler, inside, probes.lod);
        let moments = mat2x2f(
            vec2f(scatter.x * size.x * size.x, scatter.z * size.x * size.y),
            vec2f(scatter.z * size.x * size.y, scatter.y * size.y * size.y));
        // The trace of the moments on the surface.
        let spread = transpose(at.to_uv) * moments * at.to_uv;
        let variance = 0.5 * at.full_depth * at.full_depth * max(spread[0].x + spread[1].y, 0.0);
        sum += relievo_normalized_or(vec3f(-gradient, 1.0), vec3f(0.0)) * relievo_mean_normal_length(variance);
    }
    return RelievoMeanNormal(relievo_normalized_or(at.frame * sum, at.frame[2]), min(length(sum) / f32(probes.count), 1.0));
}
