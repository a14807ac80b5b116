//! From a fragment of a polygon to the point of the relief that is seen through it: the one march of every pass.
//!
//! Gives RelievoVisiblePoint, relievo_visible_point, relievo_visible_at, relievo_pixel_footprint.
//! Needs nothing else.
//! #import scene
//! #import surface
//! #import vertex
//! #import march
//! #import chosen_drawing

struct RelievoVisiblePoint {
    at: RelievoTangentFrame,
    footprint: RelievoFootprint,
    field: RelievoHeightField,
    options: RelievoMarchOptions,
    record: RelievoRecord,
    // Unit vector to the eye; a normal of the polygon, of any length and side; and where lights are seen from.
    to_eye: vec3f,
    polygon: vec3f,
    position: vec3f,
    // Distance along the camera's axis.
    view_depth: f32,
    // 1 at the near plane, 0 at infinity.
    depth: f32,
    // Not so where the relief ends: what lies behind is seen.
    seen: bool,
}

// The footprint of the pixel on the polygon; `normal` is the polygon's, of any length.
fn relievo_pixel_footprint(at: RelievoTangentFrame, point: vec3f, normal: vec3f) -> RelievoFootprint {
    if relievo_view.parallel != 0u {
        let per_step = relievo_view.forward / dot(relievo_view.forward, normal);
        let dx = relievo_view.pixel_right - per_step * dot(relievo_view.pixel_right, normal);
        let dy = relievo_view.pixel_down - per_step * dot(relievo_view.pixel_down, normal);
        return relievo_footprint_on_polygon(at, dx, dy);
    }
    let offset = point - relievo_view.eye;
    let ray = offset / dot(offset, relievo_view.forward);
    let right = ray + relievo_view.pixel_right;
    let down = ray + relievo_view.pixel_down;
    let distance = dot(offset, normal);
    let dx = right * (distance / dot(right, normal)) - offset;
    let dy = down * (distance / dot(down, normal)) - offset;
    return relievo_footprint_on_polygon(at, dx, dy);
}

// From steps in scene space to those in texture space.
fn relievo_footprint_on_polygon(at: RelievoTangentFrame, dx: vec3f, dy: vec3f) -> RelievoFootprint {
    return RelievoFootprint(
        relievo_finite_or_zero(at.to_uv * (dx * at.frame).xy), relievo_finite_or_zero(at.to_uv * (dy * at.frame).xy));
}

fn relievo_finite_or_zero(v: vec2f) -> vec2f {
    if abs(v.x) < RELIEVO_HUGE && abs(v.y) < RELIEVO_HUGE {
        return v;
    }
    return vec2f(0.0);
}

// Whether nothing is left of the relief's depth.
fn relievo_is_faded(at: RelievoTangentFrame) -> bool {
    return RELIEVO_LOD && at.depth == 0.0;
}

// What is seen through a fragment. `side` is 1, or −1 for a relief that is seen through its back: the ray is marched the
// other way then, from the front.
fn relievo_visible_point(in: RelievoVertexOut, side: f32) -> RelievoVisiblePoint {
    // Derivatives come first, where control flow is still uniform.
    let polygon = cross(dpdx(in.position), dpdy(in.position));
    let eye = relievo_view_ray(in.position);
    var at = relievo_tangent_frame(in.normal, in.tangent, in.jacobian, relievo_surface_depth(in.normal, in.jacobian));
    var footprint = RelievoFootprint(vec2f(0.0), vec2f(0.0));
    if relievo_surface.levels != 0u {
        footprint = relievo_pixel_footprint(at, in.position, polygon);
    }
    if RELIEVO_LOD && RELIEVO_TECHNIQUE_MARCHES {
        // What of the depth cannot be seen is taken away.
        let size = vec2f(textureDimensions(relievo_heights));
        let fade = relievo_footprint_fade(footprint, size, at.to_uv[0] * at.depth);
        at.depth *= fade;
        footprint = relievo_footprint_on_relief(footprint, size, fade);
    }
    let field = relievo_surface_field(footprint);
    let options = relievo_surface_options();

    let record = RelievoRecord(in.uv, relievo_lid_offset(options), true, 0u, 0u);
    let on_polygon =
        RelievoVisiblePoint(at, footprint, field, options, record, eye.to_eye, polygon, in.position, 0.0, 0.0, false);
    return relievo_visible_at(on_polygon, eye, in.uv, side);
}

// The point that is seen through `uv` of the same polygon.
fn relievo_visible_at(on_polygon: RelievoVisiblePoint, eye: RelievoViewRay, uv: vec2f, side: f32) -> RelievoVisiblePoint {
    var point = on_polygon;
    var t = eye.distance;
    if RELIEVO_TECHNIQUE_MARCHES {
        let ray = relievo_tangent_ray(point.at, uv, eye.to_eye * side);
        // Interpolated normals lean away from the eye at the rim of a curved mesh: there is nothing to march.
        if ray.cos > 0.0 && !relievo_is_faded(point.at) {
            point.record = relievo_march(point.field, ray, point.options);
            if RELIEVO_WRITES_DEPTH {
                t += side * ((point.record.depth - relievo_lid_offset(point.options)) * point.at.depth / ray.cos);
                point.position = eye.origin - eye.to_eye * t;
            }
        }
    }
    point.view_depth = t * -dot(eye.to_eye, relievo_view.forward);
    point.depth = relievo_depth_at(point.view_depth);
    point.seen = point.record.hit && point.view_depth >= relievo_view.near;
    return point;
}
