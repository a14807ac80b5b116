//! Contact refinement (Riccardi 2019): `contact`, a linear search, then the last layer again in layers n times finer.
//!
//! Gives march_contact.
//! Needs what height.wgsl needs.
//! #import search

fn march_contact(field: Field, ray: Ray, how: March) -> Record {
    if sees_from_behind(field, ray, how) {
        return record_miss(ray, 1u, 1u);
    }
    let fenced = search_field(field, ray, how);
    let coarse = search_layers(fenced, ray, how);
    if coarse.t <= 0.0 {
        return crossing_record(coarse, coarse.uv, coarse.t, 0u);
    }
    let n = march_layers(how, ray.cos);
    let start = coarse.uv - coarse.step;
    let fine = linear_search(
        fenced, start, coarse.t - coarse.layer, layered_slope(ray, how), coarse.layer / n, layer_limit(n));
    return crossing_record(fine, fine.uv, fine.t, coarse.samples);
}
