//! The depth pass where the hit's depth is written.
//!
//! Gives the entry point `fragment`.
//! Needs nothing else.
//! #import visible

@fragment
fn fragment(in: VertexOut) -> @builtin(frag_depth) f32 {
    let point = visible(in, 1.0);
    if !point.seen {
        discard;
    }
    return point.depth;
}
