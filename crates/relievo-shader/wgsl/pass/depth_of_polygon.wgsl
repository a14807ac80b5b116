//! The depth pass where the polygon's own depth counts.
//!
//! Gives the entry point `relievo_fragment`.
//! Needs nothing else.
//! #import chosen_geometry

@fragment
fn relievo_fragment(in: RelievoVertexOut) {
    if !relievo_visible_point(in, 1.0).seen {
        discard;
    }
}
