//! From scene space to texture space: the frame in which a relief is marched.
//!
//! Gives RelievoTangentFrame, relievo_tangent_frame, relievo_tangent_ray, relievo_any_orthonormal,
//! relievo_any_orthonormal_second.
//! Needs nothing else.
//! #import record
//! #import axes

struct RelievoTangentFrame {
    // Tangent, bitangent and normal as interpolated, not normalised: the inverse of how normal maps are baked (MikkTSpace).
    decode: mat3x3f,
    // The same, orthonormal.
    frame: mat3x3f,
    // Unit vector along which the relief rises.
    direction: vec3f,
    // dP/du and dP/dv of one texture repeat on the flat triangle, scene units.
    dp_du: vec3f,
    dp_dv: vec3f,
    // What one scene unit in the frame is in texture repeats.
    to_uv: mat2x2f,
    // The distance between height 0 and 1, scene units, as it is marched: less than the full one where level of detail fades
    // the relief to its polygon.
    depth: f32,
    full_depth: f32,
}

fn relievo_normalized_or(v: vec3f, otherwise: vec3f) -> vec3f {
    let length2 = dot(v, v);
    // Written so that a number that is none takes the other way.
    if length2 > 0.0 && length2 < RELIEVO_HUGE {
        return v * inverseSqrt(length2);
    }
    return otherwise;
}

// A vector at right angles to a unit vector (Duff et al. 2017).
fn relievo_any_orthonormal(n: vec3f) -> vec3f {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    return vec3f(1.0 + s * n.x * n.x * a, s * n.x * n.y * a, -s * n.x);
}

// The one at right angles to both.
fn relievo_any_orthonormal_second(n: vec3f) -> vec3f {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    return vec3f(n.x * n.y * a, s + n.y * n.y * a, -n.y);
}

// From what is interpolated over a triangle and its uv axes; `depth` is the full depth in scene units.
fn relievo_tangent_frame(
    normal: vec3f, direction: vec3f, tangent: vec4f, dp_du: vec3f, dp_dv: vec3f, depth: f32,
) -> RelievoTangentFrame {
    let hand = select(-1.0, 1.0, tangent.w >= 0.0);
    let n = relievo_normalized_or(normal, vec3f(0.0));
    let u = relievo_normalized_or(tangent.xyz - n * dot(n, tangent.xyz), relievo_any_orthonormal(n));
    let v = cross(n, u) * hand;
    let jacobian = vec4f(dot(u, dp_du), dot(v, dp_du), dot(u, dp_dv), dot(v, dp_dv));
    let determinant = jacobian.x * jacobian.w - jacobian.z * jacobian.y;
    var to_uv = mat2x2f(vec2f(0.0), vec2f(0.0));
    if determinant != 0.0 {
        to_uv = mat2x2f(
            vec2f(jacobian.w, -jacobian.y) / determinant, vec2f(-jacobian.z, jacobian.x) / determinant);
    }
    return RelievoTangentFrame(
        mat3x3f(tangent.xyz, cross(normal, tangent.xyz) * hand, normal),
        mat3x3f(u, v, n),
        relievo_normalized_or(direction, n),
        dp_du,
        dp_dv,
        to_uv,
        depth,
        depth,
    );
}

// A ray along `direction` (unit length, scene space, away from the surface) through `uv`.
fn relievo_tangent_ray(at: RelievoTangentFrame, uv: vec2f, direction: vec3f) -> RelievoRay {
    return relievo_ray_from_axes(uv, direction, at.dp_du, at.dp_dv, at.direction, at.depth);
}
