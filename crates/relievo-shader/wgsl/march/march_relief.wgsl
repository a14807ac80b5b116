//! Relief mapping (Policarpo et al. 2005): `relief`, a linear search, then bisections of the last layer.
//!
//! Gives march_relief.
//! Needs what height.wgsl needs.
//! #import search

fn march_relief(field: Field, ray: Ray, how: March) -> Record {
    if sees_from_behind(field, ray, how) {
        return record_miss(ray, 1u, 1u);
    }
    let fenced = search_field(field, ray, how);
    let found = search_layers(fenced, ray, how);
    let steps = min(how.refine_steps, MAX_REFINE_STEPS);
    // Where the place lies before the end of the layer, as a fraction of it.
    var back = 0.5;
    var half = 0.5;
    for (var k = 0u; k < steps; k++) {
        half *= 0.5;
        let below = found.t - found.layer * back >= 1.0 - height_sample(fenced, found.uv - found.step * back);
        back += select(-half, half, below);
    }
    return crossing_record(found, found.uv - found.step * back, found.t - found.layer * back, steps);
}
