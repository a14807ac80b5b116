//! Contact refinement (Riccardi 2019): `contact`, a linear search, then the last layer again in layers n times finer.
//!
//! Gives relievo_march_contact.
//! Needs what height.wgsl needs.
//! #import search

fn relievo_march_contact(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> RelievoRecord {
    if relievo_enters_from_behind(field, ray, options) {
        return relievo_miss(ray, 1u, 1u);
    }
    let fenced = relievo_search_field(field, ray, options);
    let coarse = relievo_search_layers(fenced, ray, options);
    if coarse.t <= 0.0 {
        return relievo_crossing_record(coarse, coarse.uv, coarse.t, 0u);
    }
    let n = relievo_layer_count(options, ray.cos);
    let start = coarse.uv - coarse.step;
    let fine = relievo_linear_search(
        fenced, start, coarse.t - coarse.layer, relievo_layered_slope(ray, options), coarse.layer / n, relievo_layer_limit(n));
    return relievo_crossing_record(fine, fine.uv, fine.t, coarse.samples);
}
