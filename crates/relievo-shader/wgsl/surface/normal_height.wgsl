//! The mean normal of the height map's slopes: central differences over one texel.
//!
//! Gives normal_of_heights.
//! Needs in the place of the normal map, for level of detail, how slopes scatter within a texel of each level: variances
//! along u and v and the covariance, with slopes in height per texel of the full-size map.
//! #import tangent
//! #import surface
//! #import mean_normal

// The slope per texture repeat at a uv.
fn height_slope(field: Field, uv: vec2f, step: vec2f) -> vec2f {
    return vec2f(
        height_sample(field, uv + vec2f(step.x, 0.0)) - height_sample(field, uv - vec2f(step.x, 0.0)),
        height_sample(field, uv + vec2f(0.0, step.y)) - height_sample(field, uv - vec2f(0.0, step.y)),
    ) / (2.0 * step);
}

fn normal_of_heights(at: Tangent, field: Field, uv: vec2f, footprint: Footprint) -> MeanNormal {
    if !LOD {
        let gradient = (height_slope(field, uv, 0.5 / vec2f(field.size)) * at.to_uv) * at.full_depth;
        return MeanNormal(normalized_or(at.frame * vec3f(-gradient, 1.0), at.frame[2]), 1.0);
    }
    let size = vec2f(textureDimensions(relief_heights));
    let probes = footprint_probes(footprint, size);
    let level = surface_level(probes.lod);
    // Over one texel between levels too.
    let step = 0.5 * exp2(probes.lod) / size;
    var sum = vec3f(0.0);
    for (var i = 0u; i < probes.count; i++) {
        let place = probe_uv(probes, uv, i);
        let gradient = (height_slope(level, place, step) * at.to_uv) * at.full_depth;
        let inside = surface_uv(place, probes.lod, size);
        let scatter = textureSampleLevel(normal_map, map_sampler, inside, probes.lod);
        let moments = mat2x2f(
            vec2f(scatter.x * size.x * size.x, scatter.z * size.x * size.y),
            vec2f(scatter.z * size.x * size.y, scatter.y * size.y * size.y));
        // The trace of the moments on the surface.
        let spread = transpose(at.to_uv) * moments * at.to_uv;
        let variance = 0.5 * at.full_depth * at.full_depth * max(spread[0].x + spread[1].y, 0.0);
        sum += normalized_or(vec3f(-gradient, 1.0), vec3f(0.0)) * mean_normal_length(variance);
    }
    return MeanNormal(normalized_or(at.frame * sum, at.frame[2]), min(length(sum) / f32(probes.count), 1.0));
}
