//! The colour pass where the hit's depth is written.
//!
//! Gives the entry point `relievo_fragment`.
//! Needs nothing else.
//! #import shade

struct RelievoFragmentOut {
    @location(0) color: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn relievo_fragment(in: RelievoVertexOut, @builtin(front_facing) front_facing: bool) -> RelievoFragmentOut {
    let covered = relievo_coverage(in);
    if covered.share == 0.0 {
        discard;
    }
    let color = relievo_output_color(relievo_shade(in, covered.point, relievo_front_is_seen(front_facing)).color);
    return RelievoFragmentOut(vec4f(color, covered.share), covered.point.depth);
}
