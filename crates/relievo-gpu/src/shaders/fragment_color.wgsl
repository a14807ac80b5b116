//! The colour pass where the polygon's own depth counts.
//!
//! Gives the entry point `fragment`.
//! Needs nothing else.
//! #import shade

@fragment
fn fragment(in: VertexOut, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let shaded = shade(in, front);
    if !shaded.seen {
        discard;
    }
    return vec4f(shaded.color, 1.0);
}
