//! The colour pass where the hit's depth is written.
//!
//! Gives the entry point `fragment`.
//! Needs nothing else.
//! #import shade
//! #import coverage

struct FragmentOut {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(in: VertexOut, @builtin(front_facing) front: bool) -> FragmentOut {
    let covered = covered(in);
    if covered.share == 0.0 {
        discard;
    }
    let color = output_color(shade(in, covered.point, front).color);
    return FragmentOut(vec4f(color, covered.share), covered.point.depth);
}
