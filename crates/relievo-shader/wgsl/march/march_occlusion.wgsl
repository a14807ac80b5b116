//! Parallax occlusion mapping (Brawley and Tatarchuk 2004): `occlusion`, a linear search, then one secant step.
//!
//! Gives relievo_march_occlusion.
//! Needs what height.wgsl needs.
//! #import search

fn relievo_march_occlusion(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> RelievoRecord {
    if relievo_enters_from_behind(field, ray, options) {
        return relievo_miss(ray, 1u, 1u);
    }
    let fenced = relievo_search_field(field, ray, options);
    let found = relievo_search_layers(fenced, ray, options);
    let previous = found.uv - found.step;
    let after = found.surface - found.t;
    let before = (1.0 - relievo_height_sample(fenced, previous)) - found.t + found.layer;
    var weight = 0.0;
    // Equal: the surface runs along the ray, and any point between is right.
    if after != before {
        weight = after / (after - before);
    }
    return relievo_crossing_record(
        found, previous * weight + found.uv * (1.0 - weight), found.t - found.layer * weight, 1u);
}
