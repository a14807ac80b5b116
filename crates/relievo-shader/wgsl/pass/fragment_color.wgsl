//! The colour pass where the polygon's own depth counts.
//!
//! Gives the entry point `fragment`.
//! Needs nothing else.
//! #import shade
//! #import coverage

@fragment
fn fragment(in: VertexOut, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let covered = covered(in);
    if covered.share == 0.0 {
        discard;
    }
    return vec4f(output_color(shade(in, covered.point, front).color), covered.share);
}
