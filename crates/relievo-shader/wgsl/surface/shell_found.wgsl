//! What a search through shells finds, and the level of detail of each.
//!
//! Gives RelievoShellFound, RelievoShellDetail, relievo_shell_detail, relievo_shell_footprint.
//! Needs nothing else.
//! #import visible
//! #import shell_vertex
//! #import shells

struct RelievoShellFound {
    hit: RelievoShellHit,
    // The last triangle that the ray was over, and the shell over it.
    triangle: u32,
    prism: RelievoPrism,
}

struct RelievoShellDetail {
    // The shell, with what of its depth is left.
    prism: RelievoPrism,
    field: RelievoHeightField,
}

// What is left of a relief's depth at least, where level of detail fades it: a shell has to have a depth.
const RELIEVO_LEAST_FADE: f32 = 1e-3;

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

// The frame and footprint of a pixel where its ray comes nearest to a triangle.
fn relievo_shell_faded(triangle: u32, prism: RelievoPrism, eye: RelievoViewRay) -> RelievoFadedRelief {
    let polygon = cross(prism.position_b - prism.position_a, prism.position_c - prism.position_a);
    let nearest = relievo_shell_nearest(prism, eye, polygon);
    let whole = relievo_shell_frame(triangle, prism, nearest);
    let point = prism.position_a * nearest.x + prism.position_b * nearest.y + prism.position_c * nearest.z;
    return relievo_faded(whole, relievo_pixel_footprint(whole, point, polygon));
}

// The shell and the heights as they are marched.
fn relievo_shell_detail(triangle: u32, prism: RelievoPrism, eye: RelievoViewRay) -> RelievoShellDetail {
    if !RELIEVO_LOD {
        return RelievoShellDetail(prism, relievo_surface_field(RelievoFootprint(vec2f(0.0), vec2f(0.0))));
    }
    let faded = relievo_shell_faded(triangle, prism, eye);
    var shell = prism;
    shell.depth = max(faded.at.depth, RELIEVO_LEAST_FADE * faded.at.full_depth);
    return RelievoShellDetail(shell, relievo_surface_field(faded.footprint));
}

// The footprint of a pixel that sees a triangle.
fn relievo_shell_footprint(triangle: u32, prism: RelievoPrism, eye: RelievoViewRay) -> RelievoFootprint {
    if relievo_surface.levels == 0u {
        return RelievoFootprint(vec2f(0.0), vec2f(0.0));
    }
    return relievo_shell_faded(triangle, prism, eye).footprint;
}
