//! The one march: every technique takes the same ray and gives the same record.
//!
//! Gives relief_march, relief_march_from.
//! Needs what height.wgsl needs.
//! #import record
//! #import height
//! #import chosen_technique

// Finds where the ray meets the relief, by the technique this shader was composed with. Ends for every input: a ray that
// runs along or away from the surface, or is no ray at all, is a miss.
fn relief_march(field: Field, ray: Ray, how: March) -> Record {
    return relief_march_from(field, ray, how, 0.0);
}

// The same for a ray that is known to stay above the surface down to the depth `entry`: the exact march begins there, the
// other techniques where they always do.
fn relief_march_from(field: Field, ray: Ray, how: March, entry: f32) -> Record {
    if !ray_is_usable(ray, field.size) {
        return record_miss(ray, 0u, 0u);
    }
    let record = technique_march(field, ray, how, entry);
    if how.bounded != 0u && !in_bounds(how.bounds, record.uv) {
        return record_miss(ray, record.fetches, record.iterations);
    }
    return record;
}
