//! From a fragment of a polygon to the point of the relief that is seen through it, marched in the polygon's plane.
//!
//! Gives relievo_visible_point, relievo_visible_at, relievo_front_is_seen.
//! Needs nothing else.
//! #import visible
//! #import vertex

// Whether the side that is seen is the front.
fn relievo_front_is_seen(front_facing: bool) -> bool {
    return front_facing;
}

// What is seen through a fragment. `side` is 1, or −1 for a relief that is seen through its back: the ray is marched the
// other way then, from the front.
fn relievo_visible_point(in: RelievoVertexOut, side: f32) -> RelievoVisiblePoint {
    // Derivatives come first, where control flow is still uniform.
    let polygon = cross(dpdx(in.position), dpdy(in.position));
    let eye = relievo_view_ray(in.position);
    relievo_chart_range = in.range;
    let full = relievo_surface_depth(in.direction, in.repeat_length);
    let whole = relievo_tangent_frame(in.normal, in.direction, in.tangent, in.dp_du, in.dp_dv, full);
    var footprint = RelievoFootprint(vec2f(0.0), vec2f(0.0));
    if relievo_surface.levels != 0u {
        footprint = relievo_pixel_footprint(whole, in.position, polygon);
    }
    let faded = relievo_faded(whole, footprint);
    let field = relievo_surface_field(faded.footprint);
    let options = relievo_surface_options();

    let record = RelievoRecord(in.uv, relievo_lid_offset(options), true, 0u, 0u);
    let on_polygon =
        RelievoVisiblePoint(faded.at, faded.footprint, field, options, record, eye.to_eye, polygon, in.position, 0.0, 0.0, false);
    return relievo_visible_at(on_polygon, eye, in.uv, side);
}

// The point that is seen through `uv` of the same polygon.
fn relievo_visible_at(on_polygon: RelievoVisiblePoint, eye: RelievoViewRay, uv: vec2f, side: f32) -> RelievoVisiblePoint {
    var point = on_polygon;
    var t = eye.distance;
    if RELIEVO_TECHNIQUE_MARCHES {
        let ray = relievo_tangent_ray(point.at, uv, eye.to_eye * side);
        // A face is seen from its back only by those who are not to see it.
        if ray.cos > 0.0 && !relievo_is_faded(point.at) {
            point.record = relievo_march_from(point.field, ray, point.options, relievo_depth_at_eye(point, eye, ray.cos, side));
            if RELIEVO_WRITES_DEPTH {
                t += side * ((point.record.depth - relievo_lid_offset(point.options)) * point.at.depth / ray.cos);
                point.position = eye.origin - eye.to_eye * t;
            }
        }
    }
    point.view_depth = t * -dot(eye.to_eye, relievo_view.forward);
    point.depth = relievo_depth_at(point.view_depth);
    point.seen = point.record.hit && point.view_depth >= relievo_view.near && !relievo_is_cut_off(point.options, uv);
    return point;
}

// Whether displaced geometry has a part here that lies beyond the texture range in which its relief ends.
fn relievo_is_cut_off(options: RelievoMarchOptions, uv: vec2f) -> bool {
    // Rounding must not cut a chart that ends there by itself.
    let slack = 1e-6 * (1.0 + abs(uv));
    let bounds = vec4f(options.bounds.xy - slack, options.bounds.zw + slack);
    return RELIEVO_IS_DISPLACED && options.bounded != 0u && !relievo_in_bounds(bounds, uv);
}

// The depth at which a view ray begins: below the lid where the eye is.
fn relievo_depth_at_eye(point: RelievoVisiblePoint, eye: RelievoViewRay, cos: f32, side: f32) -> f32 {
    let lid_offset = relievo_lid_offset(point.options);
    if side < 0.0 || !(point.at.depth > 0.0) {
        return 0.0;
    }
    let near = relievo_view.near / -dot(eye.to_eye, relievo_view.forward);
    return max(lid_offset - (eye.distance - near) * cos / point.at.depth, 0.0);
}
