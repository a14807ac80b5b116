//! The one march: every technique takes the same ray and gives the same record.
//!
//! Gives relievo_march, relievo_march_from.
//! Needs what height.wgsl needs.
//! #import record
//! #import height
//! #import chosen_technique

// Finds where the ray meets the relief, by the technique this shader was composed with. Ends for every input: a ray that
// runs along or away from the surface, or is no ray at all, is a miss.
fn relievo_march(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> RelievoRecord {
    return relievo_march_from(field, ray, options, 0.0);
}

// The same for a ray that is known to stay above the surface down to the depth `entry`: the exact march begins there, the
// other techniques where they always do.
fn relievo_march_from(
    field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions, entry: f32,
) -> RelievoRecord {
    if !relievo_ray_is_usable(ray, field.size) {
        return relievo_miss(ray, 0u, 0u);
    }
    let record = relievo_march_by_technique(field, ray, options, entry);
    if options.bounded != 0u && !relievo_in_bounds(options.bounds, record.uv) {
        return relievo_miss(ray, record.fetches, record.iterations);
    }
    return record;
}
