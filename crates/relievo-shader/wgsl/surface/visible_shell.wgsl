//! From a fragment of a shell's hull to the point of the relief that is seen in it.
//!
//! Gives relievo_visible_point, relievo_coverage, relievo_front_is_seen.
//! Needs nothing else.
//! #import visible
//! #import shell_vertex
//! #import shell

// The far side of the hull is drawn, but what is seen in it is the relief's front.
fn relievo_front_is_seen(front_facing: bool) -> bool {
    return true;
}

fn relievo_shell_prism(in: RelievoVertexOut) -> RelievoPrism {
    return RelievoPrism(
        in.position_a.xyz,
        in.position_b.xyz,
        in.position_c.xyz,
        in.direction_a,
        in.direction_b,
        in.direction_c,
        vec2f(in.position_a.w, in.normal_a.w),
        vec2f(in.position_b.w, in.normal_b.w),
        vec2f(in.position_c.w, in.normal_c.w),
        relievo_surface_depth(in.direction_a, in.hull.w),
        1.0 - relievo_lid_offset(relievo_surface.options),
    );
}

// The frame at a point of the triangle.
fn relievo_shell_frame(in: RelievoVertexOut, prism: RelievoPrism, weights: vec3f) -> RelievoTangentFrame {
    let e1 = prism.position_b - prism.position_a;
    let e2 = prism.position_c - prism.position_a;
    let d1 = prism.uv_b - prism.uv_a;
    let d2 = prism.uv_c - prism.uv_a;
    let area = d1.x * d2.y - d1.y * d2.x;
    let tangent = in.tangent_a.xyz * weights.x + in.tangent_b.xyz * weights.y + in.tangent_c.xyz * weights.z;
    let normal = in.normal_a.xyz * weights.x + in.normal_b.xyz * weights.y + in.normal_c.xyz * weights.z;
    let direction = in.direction_a * weights.x + in.direction_b * weights.y + in.direction_c * weights.z;
    return relievo_tangent_frame(
        normal, direction, vec4f(tangent, in.tangent_a.w), (e1 * d2.y - e2 * d1.y) / area, (e2 * d1.x - e1 * d2.x) / area, prism.depth);
}

// Weights of the point of the triangle that is nearest to where a ray meets its plane.
fn relievo_shell_nearest(prism: RelievoPrism, eye: RelievoViewRay, polygon: vec3f) -> vec3f {
    let t = dot(prism.position_a - eye.origin, polygon) / dot(-eye.to_eye, polygon);
    let point = eye.origin - eye.to_eye * t;
    let a = prism.position_a - point;
    let b = prism.position_b - point;
    let c = prism.position_c - point;
    let inside = clamp(
        vec3f(dot(cross(b, c), polygon), dot(cross(c, a), polygon), dot(cross(a, b), polygon)) / dot(polygon, polygon), vec3f(0.0),
        vec3f(1.0));
    let sum = inside.x + inside.y + inside.z;
    if !(sum > 0.0) {
        return vec3f(1.0 / 3.0);
    }
    return inside / sum;
}

// What is seen through a fragment of the hull.
fn relievo_visible_point(in: RelievoVertexOut, side: f32) -> RelievoVisiblePoint {
    relievo_chart_range = vec4f(0.0, 0.0, 1.0, 1.0);
    let eye = relievo_view_ray(in.position);
    var prism = relievo_shell_prism(in);
    let polygon = cross(prism.position_b - prism.position_a, prism.position_c - prism.position_a);
    var footprint = RelievoFootprint(vec2f(0.0), vec2f(0.0));
    if relievo_surface.levels != 0u {
        let nearest = relievo_shell_nearest(prism, eye, polygon);
        let whole = relievo_shell_frame(in, prism, nearest);
        let point = prism.position_a * nearest.x + prism.position_b * nearest.y + prism.position_c * nearest.z;
        let faded = relievo_faded(whole, relievo_pixel_footprint(whole, point, polygon));
        footprint = faded.footprint;
        // A shell has to have a depth.
        prism.depth = max(faded.at.depth, RELIEVO_LEAST_FADE * faded.at.full_depth);
    }
    let field = relievo_surface_field(footprint);
    let options = relievo_surface_options();
    let cos = -dot(eye.to_eye, relievo_view.forward);
    let hit = relievo_march_shell(field, prism, eye.origin, -eye.to_eye, relievo_view.near / cos, RELIEVO_HUGE);
    prism.depth = relievo_surface_depth(in.direction_a, in.hull.w);
    let at = relievo_shell_frame(in, prism, hit.weights);
    var point = RelievoVisiblePoint(
        at, footprint, field, options, hit.record, eye.to_eye, polygon, eye.origin - eye.to_eye * hit.t, hit.t * cos, 0.0,
        hit.record.hit);
    point.depth = relievo_depth_at(point.view_depth);
    return point;
}

// What is left of a relief's depth at least, where level of detail fades it.
const RELIEVO_LEAST_FADE: f32 = 1e-3;

// A shell's border is found by the ray in the pixel's middle alone.
fn relievo_coverage(in: RelievoVertexOut) -> RelievoCoverage {
    let point = relievo_visible_point(in, 1.0);
    return RelievoCoverage(point, select(0.0, 1.0, point.seen));
}
