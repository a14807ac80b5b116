//! Cone stepping: `cone`, through relaxed cones and finished by bisection (Policarpo and Oliveira 2007), or through
//! conservative ones and finished by the exact walk (Dummer 2006).
//!
//! Gives relievo_march_cone.
//! Needs what cone.wgsl needs.
//! #import span
//! #import cone

fn relievo_march_cone(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions) -> RelievoRecord {
    let span = relievo_span(field, ray, options, 0.0);
    if !span.is_open {
        return relievo_miss(ray, span.fetches, span.fetches);
    }
    return relievo_span_record(span, ray, relievo_cone_crossing(field, span.line, span.start, span.end, options));
}
