//! What is measured of the light, instead of a colour.
//!
//! Gives the entry point `relievo_fragment`.
//! Needs nothing else.
//! #import shade

struct RelievoFragmentOut {
    // The mean shadow factor over the lights, the material's number plus 1.
    @location(0) light: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn relievo_fragment(in: RelievoVertexOut, @builtin(front_facing) front_facing: bool) -> RelievoFragmentOut {
    let point = relievo_visible_point(in, 1.0);
    if !point.seen {
        discard;
    }
    return RelievoFragmentOut(
        vec4f(relievo_shade(in, point, relievo_front_is_seen(front_facing)).unshadowed, f32(relievo_surface.number + 1u), 0.0, 0.0), point.depth);
}
