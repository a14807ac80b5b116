//! From a fragment of a polygon to the point of the relief that is seen through it: the one march of every pass.
//!
//! Gives Visible, visible.
//! Needs nothing else.
//! #import scene
//! #import surface
//! #import vertex
//! #import march
//! #import chosen_output

struct Visible {
    at: Tangent,
    footprint: Footprint,
    field: Field,
    how: March,
    record: Record,
    // Unit vector to the eye, and where lights are seen from.
    toward: vec3f,
    position: vec3f,
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

fn visible(in: VertexOut) -> Visible {
    // Derivatives come first, where control flow is still uniform.
    let polygon = cross(dpdx(in.position), dpdy(in.position));
    let way = in.position - view.eye;
    let distance = length(way);
    let toward = -way / distance;
    let at = tangent_frame(in.normal, in.tangent, in.jacobian, surface_depth(in.normal, in.jacobian));
    var footprint = Footprint(vec2f(0.0), vec2f(0.0));
    if surface.levels != 0u {
        footprint = pixel_footprint(at, in.position, polygon);
    }
    let field = surface_field(footprint);
    let how = surface_march();

    var record = Record(in.uv, march_rise(how), true, 0u, 0u);
    var t = distance;
    var position = in.position;
    if TECHNIQUE_MARCHES {
        let ray = tangent_ray(at, in.uv, toward);
        // Interpolated normals lean away from the eye at the rim of a curved mesh: there is nothing to march.
        if ray.cos > 0.0 {
            record = relief_march(field, ray, how);
            if WRITES_DEPTH {
                t += (record.depth - march_rise(how)) * at.depth / ray.cos;
                position = view.eye - toward * t;
            }
        }
    }
    let along_axis = t * -dot(toward, view.forward);
    let depth = clamp(view.near / along_axis, 0.0, 1.0);
    return Visible(
        at, footprint, field, how, record, toward, position, depth, record.hit && along_axis >= view.near);
}
