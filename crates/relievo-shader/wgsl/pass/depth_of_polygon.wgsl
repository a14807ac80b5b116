//! The depth pass where the polygon's own depth counts.
//!
//! Gives the entry point `fragment`.
//! Needs nothing else.
//! #import visible

@fragment
fn fragment(in: VertexOut) {
    if !visible(in, 1.0).seen {
        discard;
    }
}
