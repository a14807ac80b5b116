//! From a fragment of a shell's hull to the point of the relief that is seen in it.
//!
//! Gives relievo_visible_point, relievo_coverage, relievo_front_is_seen.
//! Needs nothing else.
//! #import visible
//! #import shell_found
//! #import chosen_search

// Whichever side of the hull is drawn, what is seen in it is the relief's front.
fn relievo_front_is_seen(front_facing: bool) -> bool {
    return true;
}

// What is seen through a fragment of the hull.
fn relievo_visible_point(in: RelievoVertexOut, side: f32) -> RelievoVisiblePoint {
    relievo_chart_range = vec4f(0.0, 0.0, 1.0, 1.0);
    let eye = relievo_view_ray(in.position);
    let cos = -dot(eye.to_eye, relievo_view.forward);
    let found = relievo_shell_search(in, eye, relievo_view.near / cos);
    let hit = found.hit;
    let prism = found.prism;
    let polygon = cross(prism.position_b - prism.position_a, prism.position_c - prism.position_a);
    let footprint = relievo_shell_footprint(found.triangle, prism, eye);
    let at = relievo_shell_frame(found.triangle, prism, hit.weights);
    var point = RelievoVisiblePoint(
        at, footprint, relievo_surface_field(footprint), relievo_surface_options(), hit.record, eye.to_eye, polygon,
        eye.origin - eye.to_eye * hit.t, hit.t * cos, 0.0, hit.record.hit);
    point.depth = relievo_depth_at(point.view_depth);
    return point;
}

// A shell's border is found by the ray in the pixel's middle alone.
fn relievo_coverage(in: RelievoVertexOut) -> RelievoCoverage {
    let point = relievo_visible_point(in, 1.0);
    return RelievoCoverage(point, select(0.0, 1.0, point.seen));
}
