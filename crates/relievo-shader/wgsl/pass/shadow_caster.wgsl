//! The shadow-map pass: what a light sees first, by the march of every pass, and which object it is.
//!
//! Gives the entry point `fragment`.
//! Needs nothing else.
//! #import visible

struct FragmentOut {
    @location(0) object: u32,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(in: VertexOut, @builtin(front_facing) front: bool) -> FragmentOut {
    let point = visible(in, select(-1.0, 1.0, front));
    if !point.seen {
        discard;
    }
    // Seen through its back a relief ends at its polygon: what lies in front of that is in its shadow.
    let polygon = depth_ahead(dot(in.position - view.eye, view.forward));
    return FragmentOut(object.number, select(polygon, point.depth, front));
}
