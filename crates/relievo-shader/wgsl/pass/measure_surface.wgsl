//! What is measured of the surface and its march, instead of a colour.
//!
//! Gives the entry point `relievo_fragment`.
//! Needs nothing else.
//! #import shade

struct RelievoFragmentOut {
    // Shading normal, distance along the camera's axis.
    @location(0) surface: vec4f,
    // Displaced uv, fetches, iterations.
    @location(1) march: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn relievo_fragment(in: RelievoVertexOut, @builtin(front_facing) front_facing: bool) -> RelievoFragmentOut {
    let point = relievo_visible_point(in, 1.0);
    if !point.seen {
        discard;
    }
    let record = point.record;
    return RelievoFragmentOut(
        vec4f(
            relievo_shading_normal(point, relievo_front_is_seen(front_facing)).direction, point.view_depth + relievo_view.skipped),
        vec4f(record.uv, f32(record.fetches), f32(record.iterations)),
        point.depth,
    );
}
