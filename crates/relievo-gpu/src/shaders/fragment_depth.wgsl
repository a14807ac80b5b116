//! The colour pass where the hit's depth is written.
//!
//! Gives the entry point `fragment`.
//! Needs nothing else.
//! #import shade

struct FragmentOut {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(in: VertexOut, @builtin(front_facing) front: bool) -> FragmentOut {
    let shaded = shade(in, front);
    if !shaded.seen {
        discard;
    }
    return FragmentOut(vec4f(shaded.color, 1.0), shaded.depth);
}
