//! Parallax occlusion mapping (Brawley and Tatarchuk 2004): `occlusion`, a linear search, then one secant step.
//!
//! Gives march_occlusion.
//! Needs what height.wgsl needs.
//! #import search

fn march_occlusion(field: Field, ray: Ray, how: March) -> Record {
    if sees_from_behind(field, ray, how) {
        return record_miss(ray, 1u, 1u);
    }
    let fenced = search_field(field, ray, how);
    let found = search_layers(fenced, ray, how);
    let previous = found.uv - found.step;
    let after = found.surface - found.t;
    let before = (1.0 - height_sample(fenced, previous)) - found.t + found.layer;
    var weight = 0.0;
    // Equal: the surface runs along the ray, and any point between is right.
    if after != before {
        weight = after / (after - before);
    }
    return crossing_record(found, previous * weight + found.uv * (1.0 - weight), found.t - found.layer * weight, 1u);
}
