//! The depth pass where the hit's depth is written.
//!
//! Gives the entry point `relievo_fragment`.
//! Needs nothing else.
//! #import chosen_geometry

@fragment
fn relievo_fragment(in: RelievoVertexOut) -> @builtin(frag_depth) f32 {
    let point = relievo_visible_point(in, 1.0);
    if !point.seen {
        discard;
    }
    return point.depth;
}
