//! The mean normal that a tangent-space map says.
//!
//! Gives relievo_normal_of_map.
//! Needs nothing else.
//! #import tangent
//! #import surface
//! #import mean_normal

fn relievo_normal_of_map(
    at: RelievoTangentFrame, field: RelievoHeightField, uv: vec2f, footprint: RelievoFootprint,
) -> RelievoMeanNormal {
    if !RELIEVO_LOD {
        let local = relievo_surface_sample(relievo_normal_map, uv, footprint).xyz;
        // Where the map stands mirrored its normals do too.
        return RelievoMeanNormal(
            relievo_normalized_or(at.decode * vec3f(local.xy * relievo_mirror_sign(uv) * relievo_surface.normal_sign, local.z), at.frame[2]), 1.0);
    }
    let size = vec2f(textureDimensions(relievo_normal_map));
    let probes = relievo_footprint_probes(footprint, size);
    var sum = vec3f(0.0);
    for (var i = 0u; i < probes.count; i++) {
        let probe = relievo_probe_uv(probes, uv, i);
        let inside = relievo_surface_uv(probe, probes.lod, size);
        let stored = textureSampleLevel(relievo_normal_map, relievo_map_sampler, inside, probes.lod);
        sum += relievo_normalized_or(vec3f(stored.xy * relievo_mirror_sign(probe) * relievo_surface.normal_sign, stored.z), vec3f(0.0)) * stored.w;
    }
    return RelievoMeanNormal(
        relievo_normalized_or(at.decode * sum, at.frame[2]), min(length(sum) / f32(probes.count), 1.0));
}
