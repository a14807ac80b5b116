//! The normal of the height map's slope: a central difference over one texel.
//!
//! Gives normal_of_heights.
//! Needs nothing else.
//! #import tangent
//! #import surface

fn normal_of_heights(at: Tangent, field: Field, uv: vec2f, footprint: Footprint) -> vec3f {
    let step = 0.5 / vec2f(field.size);
    let slope = vec2f(
        height_sample(field, uv + vec2f(step.x, 0.0)) - height_sample(field, uv - vec2f(step.x, 0.0)),
        height_sample(field, uv + vec2f(0.0, step.y)) - height_sample(field, uv - vec2f(0.0, step.y)),
    ) / (2.0 * step);
    let gradient = (slope * at.to_uv) * at.depth;
    return normalized_or(at.frame * vec3f(-gradient, 1.0), at.frame[2]);
}
