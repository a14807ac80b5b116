//! The stretch of a ray that has to be looked at, and the record of a walk over it: what the marches over cells share.
//!
//! Gives RelievoSpan, relievo_span, relievo_span_record.
//! Needs what height.wgsl needs.
//! #import record
//! #import height
//! #import bounds
//! #import walk

struct RelievoSpan {
    // By depth: s = 0 on the lid.
    line: RelievoHeightLine,
    start: f32,
    end: f32,
    // The depth of the lowest texel.
    lowest: f32,
    // Not so where the ray is a miss without a walk; and what it cost to know.
    is_open: bool,
    fetches: u32,
}

// The ray is known to stay above the surface down to the depth `entry`.
fn relievo_span(field: RelievoHeightField, ray: RelievoRay, options: RelievoMarchOptions, entry: f32) -> RelievoSpan {
    let slope = relievo_ray_slope(ray);
    let uv = relievo_uv_on_lid(ray.uv, slope, options);
    // Above the highest texel there is nothing to hit, and at the lowest one everything has been hit.
    let lowest = 1.0 - field.range.x;
    let inside = relievo_depths_inside(uv, slope, options);
    let start = max(max(1.0 - field.range.y, inside.x), entry);
    let end = min(lowest, inside.y);
    let line = RelievoHeightLine(uv, slope, 1.0, -1.0);
    if !(start <= end) {
        return RelievoSpan(line, start, end, lowest, false, 0u);
    }
    if relievo_enters_below(field, uv, slope, options) {
        return RelievoSpan(line, start, end, lowest, false, 1u);
    }
    return RelievoSpan(line, start, end, lowest, true, 0u);
}

// A walk that was cut off has its hit where it is then; rounding may leave the ray a hair above the floor.
fn relievo_span_record(span: RelievoSpan, ray: RelievoRay, walk: RelievoCellWalk) -> RelievoRecord {
    if walk.hit || !walk.finished || span.end == span.lowest {
        return RelievoRecord(span.line.uv + span.line.slope * walk.s, walk.s, true, walk.fetches, walk.iterations);
    }
    return relievo_miss(ray, walk.fetches, walk.iterations);
}
