//! Steep parallax mapping (McGuire and McGuire 2005): `steep`, the first layer below the surface.
//!
//! Gives march_steep.
//! Needs what height.wgsl needs.
//! #import search

fn march_steep(field: Field, ray: Ray, how: March) -> Record {
    if sees_from_behind(field, ray, how) {
        return record_miss(ray, 1u, 1u);
    }
    let found = search_layers(search_field(field, ray, how), ray, how);
    return crossing_record(found, found.uv, found.t, 0u);
}
