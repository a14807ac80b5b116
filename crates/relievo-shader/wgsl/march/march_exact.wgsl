//! The first intersection with the bilinear surface: `exact`. No steps, no settings, no misses.
//!
//! Gives relievo_march_exact.
//! Needs what descent.wgsl needs.
//! #import span
//! #import descent

// The ray is known to stay above the surface down to the depth `entry`.
fn relievo_march_exact(
    field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions, entry: f32,
) -> RelievoRecord {
    let span = relievo_span(field, ray, options, entry);
    if !span.is_open {
        return relievo_miss(ray, span.fetches, span.fetches);
    }
    return relievo_span_record(span, ray, relievo_first_crossing(field, span.line, span.start, span.end));
}
