//! The normal that a tangent-space map says.
//!
//! Gives normal_of_map.
//! Needs nothing else.
//! #import tangent
//! #import surface

fn normal_of_map(at: Tangent, field: Field, uv: vec2f, footprint: Footprint) -> vec3f {
    let inside = surface_uv(uv, footprint, vec2f(textureDimensions(normal_map)));
    let stored = textureSampleGrad(normal_map, map_sampler, inside, footprint.dx, footprint.dy).xyz;
    let local = stored * surface.normal_decode.x + surface.normal_decode.y;
    // Where the map stands mirrored its normals do too.
    return normalized_or(at.decode * vec3f(local.xy * map_facing(uv), local.z), at.frame[2]);
}
