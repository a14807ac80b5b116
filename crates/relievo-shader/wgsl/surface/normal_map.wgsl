//! The mean normal that a tangent-space map says.
//!
//! Gives normal_of_map.
//! Needs nothing else.
//! #import tangent
//! #import surface
//! #import mean_normal

fn normal_of_map(at: Tangent, field: Field, uv: vec2f, footprint: Footprint) -> MeanNormal {
    if !LOD {
        let stored = surface_sample(normal_map, uv, footprint).xyz;
        let local = stored * surface.normal_decode.x + surface.normal_decode.y;
        // Where the map stands mirrored its normals do too.
        return MeanNormal(normalized_or(at.decode * vec3f(local.xy * map_facing(uv), local.z), at.frame[2]), 1.0);
    }
    let size = vec2f(textureDimensions(normal_map));
    let probes = footprint_probes(footprint, size);
    var sum = vec3f(0.0);
    for (var i = 0u; i < probes.count; i++) {
        let place = probe_uv(probes, uv, i);
        let inside = surface_uv(place, probes.lod, size);
        let stored = textureSampleLevel(normal_map, map_sampler, inside, probes.lod);
        sum += normalized_or(vec3f(stored.xy * map_facing(place), stored.z), vec3f(0.0)) * stored.w;
    }
    return MeanNormal(normalized_or(at.decode * sum, at.frame[2]), min(length(sum) / f32(probes.count), 1.0));
}
