//! What is measured of the surface and its march, instead of a colour.
//!
//! Gives the entry point `fragment`.
//! Needs nothing else.
//! #import shade

struct FragmentOut {
    // Shading normal, distance along the camera's axis.
    @location(0) surface: vec4f,
    // Displaced uv, fetches, iterations.
    @location(1) march: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(in: VertexOut, @builtin(front_facing) front: bool) -> FragmentOut {
    let point = visible(in, 1.0);
    if !point.seen {
        discard;
    }
    let record = point.record;
    return FragmentOut(
        vec4f(shading_normal(point, front).direction, point.ahead),
        vec4f(record.uv, f32(record.fetches), f32(record.iterations)),
        point.depth,
    );
}
