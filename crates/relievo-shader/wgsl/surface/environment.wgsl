//! Light from all around.
//!
//! Gives relievo_environment_seen, relievo_environment_reflection; declares the bindings of the surroundings, group 0.
//! #import material_sample
//! #import tangent
//! #import chosen_reflection

// Surroundings.LEVELS of relievo-scene: the first is the picture itself.
const RELIEVO_ENVIRONMENT_LEVELS: u32 = 8u;

// Weights of the nine spherical harmonics of what a matt surface receives, over π.
struct RelievoHarmonics {
    weights: array<vec4f, 9>,
}

@group(0) @binding(4) var relievo_environment_picture: texture_2d<f32>;
@group(0) @binding(5) var relievo_environment_blurred: texture_2d_array<f32>;
@group(0) @binding(6) var relievo_environment_sampler: sampler;
@group(0) @binding(7) var<uniform> relievo_environment_harmonics: RelievoHarmonics;

// Where an equirectangular picture of this height shows a direction.
fn relievo_environment_uv(direction: vec3f, height: u32) -> vec2f {
    let u = atan2(-direction.x, direction.z) / 6.2831853;
    let v = acos(clamp(direction.y, -1.0, 1.0)) / 3.14159265;
    // Around repeats; over the poles would turn around, so v stays half a texel inside.
    let inset = 0.5 / f32(height);
    return vec2f(fract(u), clamp(v, inset, 1.0 - inset));
}

// The picture in a direction of unit length.
fn relievo_environment_seen(direction: vec3f) -> vec3f {
    let uv = relievo_environment_uv(direction, textureDimensions(relievo_environment_picture).y);
    return textureSampleLevel(relievo_environment_picture, relievo_environment_sampler, uv, 0.0).rgb;
}

fn relievo_environment_level(direction: vec3f, level: u32) -> vec3f {
    if level == 0u {
        return relievo_environment_seen(direction);
    }
    let uv = relievo_environment_uv(direction, textureDimensions(relievo_environment_blurred).y);
    return textureSampleLevel(relievo_environment_blurred, relievo_environment_sampler, uv, i32(level) - 1, 0.0).rgb;
}

// What a mirror of this roughness shows in a direction.
fn relievo_environment_mirrored(direction: vec3f, roughness: f32) -> vec3f {
    let level = clamp(roughness, 0.0, 1.0) * f32(RELIEVO_ENVIRONMENT_LEVELS - 1u);
    let lower = min(u32(level), RELIEVO_ENVIRONMENT_LEVELS - 2u);
    return mix(
        relievo_environment_level(direction, lower), relievo_environment_level(direction, lower + 1u), level - f32(lower));
}

// Irradiance over π for a surface with this normal (Ramamoorthi and Hanrahan 2001).
fn relievo_environment_received(d: vec3f) -> vec3f {
    let w = relievo_environment_harmonics.weights;
    let sum = w[0] * 0.282095 + w[1] * (0.488603 * d.y) + w[2] * (0.488603 * d.z) + w[3] * (0.488603 * d.x)
        + w[4] * (1.092548 * d.x * d.y) + w[5] * (1.092548 * d.y * d.z) + w[6] * (0.315392 * (3.0 * d.z * d.z - 1.0))
        + w[7] * (1.092548 * d.x * d.z) + w[8] * (0.546274 * (d.x * d.x - d.y * d.y));
    return max(sum.rgb, vec3f(0.0));
}

// What a surface sends of its surroundings to the eye; the split sum's second factor by an analytic fit (Karis 2014, after
// Lazarov 2013).
fn relievo_environment_reflection(material: RelievoMaterialSample, normal: vec3f, to_eye: vec3f) -> vec3f {
    let received = relievo_environment_received(normal);
    if !RELIEVO_REFLECTION_IS_PHYSICAL {
        return material.base_color * received * material.ao;
    }
    let f0 = mix(vec3f(0.04), material.base_color, material.metallic);
    let n_v = clamp(dot(normal, to_eye), 0.0, 1.0);
    let r = vec4f(
        1.0 - material.roughness, 0.0425 - 0.0275 * material.roughness, 1.04 - 0.572 * material.roughness,
        0.022 * material.roughness - 0.04);
    let a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    let mirrors = max(f0 * (-1.04 * a + r.z) + vec3f(1.04 * a + r.w), vec3f(0.0));
    let mirror = normal * (2.0 * dot(normal, to_eye)) - to_eye;
    let specular = relievo_environment_mirrored(relievo_normalized_or(mirror, normal), material.roughness) * mirrors;
    // What is mirrored does not reach the matt layer below.
    let matt = material.base_color * received * (1.0 - material.metallic) * max(vec3f(1.0) - mirrors, vec3f(0.0));
    return (matt + specular) * material.ao;
}
