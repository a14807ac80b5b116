//! From a fragment of a polygon to the point of the relief that is seen through it: the one march of every pass.
//!
//! Gives Visible, visible, seen_through, pixel_footprint.
//! Needs nothing else.
//! #import scene
//! #import surface
//! #import vertex
//! #import march
//! #import chosen_drawing

struct Visible {
    at: Tangent,
    footprint: Footprint,
    field: Field,
    how: March,
    record: Record,
    // Unit vector to the eye; a normal of the polygon, of any length and side; and where lights are seen from.
    toward: vec3f,
    polygon: vec3f,
    position: vec3f,
    // Distance along the camera's axis.
    ahead: f32,
    // 1 at the near plane, 0 at infinity.
    depth: f32,
    // Not so where the relief ends: what lies behind is seen.
    seen: bool,
}

// The footprint of the pixel on the polygon; `normal` is the polygon's, of any length.
fn pixel_footprint(at: Tangent, point: vec3f, normal: vec3f) -> Footprint {
    let way = point - view.eye;
    let ray = way / dot(way, view.forward);
    let right = ray + view.pixel_right;
    let down = ray + view.pixel_down;
    let distance = dot(way, normal);
    let dx = right * (distance / dot(right, normal)) - way;
    let dy = down * (distance / dot(down, normal)) - way;
    return Footprint(finite_or_zero(at.to_uv * (dx * at.frame).xy), finite_or_zero(at.to_uv * (dy * at.frame).xy));
}

fn finite_or_zero(v: vec2f) -> vec2f {
    if abs(v.x) < HUGE && abs(v.y) < HUGE {
        return v;
    }
    return vec2f(0.0);
}

// Whether nothing is left of the relief's depth.
fn is_faded(at: Tangent) -> bool {
    return LOD && at.depth == 0.0;
}

// What is seen through a fragment. `side` is 1, or −1 for a relief that is seen through its back: the ray is marched the
// other way then, from the front.
fn visible(in: VertexOut, side: f32) -> Visible {
    // Derivatives come first, where control flow is still uniform.
    let polygon = cross(dpdx(in.position), dpdy(in.position));
    let eye = sight(in.position);
    var at = tangent_frame(in.normal, in.tangent, in.jacobian, surface_depth(in.normal, in.jacobian));
    var footprint = Footprint(vec2f(0.0), vec2f(0.0));
    if surface.levels != 0u {
        footprint = pixel_footprint(at, in.position, polygon);
    }
    if LOD && TECHNIQUE_MARCHES {
        // What of the depth cannot be seen is taken away.
        let size = vec2f(textureDimensions(relief_heights));
        let fade = footprint_fade(footprint, size, at.to_uv[0] * at.depth);
        at.depth *= fade;
        footprint = footprint_on_relief(footprint, size, fade);
    }
    let field = surface_field(footprint);
    let how = surface_march();

    let record = Record(in.uv, march_rise(how), true, 0u, 0u);
    let on_polygon = Visible(at, footprint, field, how, record, eye.toward, polygon, in.position, 0.0, 0.0, false);
    return seen_through(on_polygon, eye, in.uv, side);
}

// The point that is seen through `uv` of the same polygon.
fn seen_through(on_polygon: Visible, eye: Sight, uv: vec2f, side: f32) -> Visible {
    var point = on_polygon;
    var t = eye.distance;
    if TECHNIQUE_MARCHES {
        let ray = tangent_ray(point.at, uv, eye.toward * side);
        // Interpolated normals lean away from the eye at the rim of a curved mesh: there is nothing to march.
        if ray.cos > 0.0 && !is_faded(point.at) {
            point.record = relief_march(point.field, ray, point.how);
            if WRITES_DEPTH {
                t += side * ((point.record.depth - march_rise(point.how)) * point.at.depth / ray.cos);
                point.position = eye.origin - eye.toward * t;
            }
        }
    }
    point.ahead = t * -dot(eye.toward, view.forward);
    point.depth = depth_ahead(point.ahead);
    // A relief may rise above where a directional light's map begins.
    point.seen = point.record.hit && (view.parallel != 0u || point.ahead >= view.near);
    return point;
}
