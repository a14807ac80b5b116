//! What is measured of the light, instead of a colour.
//!
//! Gives the entry point `fragment`.
//! Needs nothing else.
//! #import shade

struct FragmentOut {
    // The mean shadow factor over the lights, the material's number plus 1.
    @location(0) light: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(in: VertexOut, @builtin(front_facing) front: bool) -> FragmentOut {
    let point = visible(in, 1.0);
    if !point.seen {
        discard;
    }
    return FragmentOut(vec4f(shade(in, point, front).unshadowed, f32(surface.number + 1u), 0.0, 0.0), point.depth);
}
