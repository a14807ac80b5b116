//! The colour pass where the polygon's own depth counts.
//!
//! Gives the entry point `relievo_fragment`.
//! Needs nothing else.
//! #import shade

@fragment
fn relievo_fragment(in: RelievoVertexOut, @builtin(front_facing) front_facing: bool) -> @location(0) vec4f {
    let covered = relievo_coverage(in);
    if covered.share == 0.0 {
        discard;
    }
    return vec4f(relievo_output_color(relievo_shade(in, covered.point, relievo_front_is_seen(front_facing)).color), covered.share);
}
