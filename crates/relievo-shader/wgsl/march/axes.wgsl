//! Rays from a view vector and the axes of a texture on a surface, in any space.
//!
//! Gives relievo_ray_from_axes.
//! Needs nothing else.
//! #import record

// The least cosine between a face and its interpolated normal with which a relief is marched.
const RELIEVO_LEAST_LEAN: f32 = 0.05;

// The ray that sees the surface at `uv`. All vectors are in one space, of any scale:
// `to_eye`: from the surface to the eye, of unit length. For relievo_shadow: to the light.
// `dp_du`, `dp_dv`: how far the position moves along the surface for one texture repeat. Their signs are the texture's own:
//   v runs down the picture in most engines, then so does dp_dv. Their lengths are the repeat's two sides: a map that is twice
//   as wide as high needs nothing else.
// `normal`: along which the relief rises, of unit length: the face's, or one interpolated between vertices.
// `depth`: the distance between height 0 and 1.
fn relievo_ray_from_axes(
    uv: vec2f, to_eye: vec3f, dp_du: vec3f, dp_dv: vec3f, normal: vec3f, depth: f32,
) -> RelievoRay {
    // The inverse of [dP/du dP/dv N]. Where the normal runs along the face, or the face has no area, the ray goes straight
    // down.
    let across = cross(dp_du, dp_dv);
    let along = dot(across, normal);
    let squared = dot(across, across);
    if !(abs(along) > RELIEVO_LEAST_LEAN * sqrt(squared)) {
        return RelievoRay(uv, vec2f(0.0), dot(to_eye, normal));
    }
    let height = dot(across, to_eye) / along;
    let rest = to_eye - normal * height;
    let repeats = vec2f(dot(cross(dp_dv, across), rest), dot(cross(across, dp_du), rest)) / squared;
    return RelievoRay(uv, repeats * -depth, height);
}
