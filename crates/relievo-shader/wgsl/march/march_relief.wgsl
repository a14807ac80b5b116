//! Relief mapping (Policarpo et al. 2005): `relief`, a linear search, then bisections of the last layer.
//!
//! Gives relievo_march_relief.
//! Needs what height.wgsl needs.
//! #import search

fn relievo_march_relief(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> RelievoRecord {
    if relievo_enters_from_behind(field, ray, options) {
        return relievo_miss(ray, 1u, 1u);
    }
    let fenced = relievo_search_field(field, ray, options);
    let found = relievo_search_layers(fenced, ray, options);
    let steps = min(options.refine_steps, RELIEVO_MAX_REFINE_STEPS);
    // Where the place lies before the end of the layer, as a fraction of it.
    var back = 0.5;
    var half = 0.5;
    for (var k = 0u; k < steps; k++) {
        half *= 0.5;
        let below = found.t - found.layer * back >= 1.0 - relievo_height_sample(fenced, found.uv - found.step * back);
        back += select(-half, half, below);
    }
    return relievo_crossing_record(found, found.uv - found.step * back, found.t - found.layer * back, steps);
}
