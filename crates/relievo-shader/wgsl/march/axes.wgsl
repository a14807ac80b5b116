//! Rays from a view vector and the axes of a texture on a surface, in any space.
//!
//! Gives relievo_ray_from_axes.
//! Needs nothing else.
//! #import record

// The ray that sees the surface at `uv`. All vectors are in one space, of any scale:
// `to_eye`: from the surface to the eye, of unit length. For relievo_shadow: to the light.
// `dp_du`, `dp_dv`: how far the position moves along the surface for one texture repeat. Their signs are the texture's own: v runs
//   down the picture in most engines, then so does dp_dv. Their lengths are the repeat's two sides: a map that is twice as wide
//   as high needs nothing else.
// `normal`: the surface's, of unit length, on the side of the eye.
// `depth`: the distance between height 0 and 1.
fn relievo_ray_from_axes(
    uv: vec2f, to_eye: vec3f, dp_du: vec3f, dp_dv: vec3f, normal: vec3f, depth: f32,
) -> RelievoRay {
    let across_u = cross(dp_dv, normal);
    let across_v = cross(normal, dp_du);
    let area = dot(dp_du, across_u);
    var repeats = vec2f(0.0);
    if area != 0.0 {
        repeats = vec2f(dot(to_eye, across_u), dot(to_eye, across_v)) / area;
    }
    return RelievoRay(uv, repeats * -depth, dot(to_eye, normal));
}
