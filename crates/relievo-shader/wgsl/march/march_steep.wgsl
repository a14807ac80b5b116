//! Steep parallax mapping (McGuire and McGuire 2005): `steep`, the first layer below the surface.
//!
//! Gives relievo_march_steep.
//! Needs what height.wgsl needs.
//! #import search

fn relievo_march_steep(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> RelievoRecord {
    if relievo_enters_from_behind(field, ray, options) {
        return relievo_miss(ray, 1u, 1u);
    }
    let found = relievo_search_layers(relievo_search_field(field, ray, options), ray, options);
    return relievo_crossing_record(found, found.uv, found.t, 0u);
}
