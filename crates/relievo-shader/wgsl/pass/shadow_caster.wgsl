//! The shadow-map pass: what a light sees first, by the march of every pass, and which object it is.
//!
//! Gives the entry point `relievo_fragment`.
//! Needs nothing else.
//! #import chosen_geometry

struct RelievoFragmentOut {
    @location(0) object: u32,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn relievo_fragment(in: RelievoVertexOut, @builtin(front_facing) front_facing: bool) -> RelievoFragmentOut {
    let front = relievo_front_is_seen(front_facing);
    let point = relievo_visible_point(in, select(-1.0, 1.0, front));
    if !point.seen {
        discard;
    }
    // Seen through its back a relief ends at its polygon: what lies in front of that is in its shadow.
    let polygon = relievo_depth_at(dot(in.position - relievo_view.eye, relievo_view.forward));
    return RelievoFragmentOut(relievo_object.number, select(polygon, point.depth, front));
}
