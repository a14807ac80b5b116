//! Light from all around.
//!
//! Gives environment_seen, environment_reflection; declares the bindings of the surroundings, group 0.
//! #import material_sample
//! #import tangent
//! #import chosen_reflection

// Surroundings.LEVELS of relievo-scene: the first is the picture itself.
const ENVIRONMENT_LEVELS: u32 = 8u;

// Weights of the nine spherical harmonics of what a matt surface receives, over π.
struct Harmonics {
    weights: array<vec4f, 9>,
}

@group(0) @binding(4) var environment_picture: texture_2d<f32>;
@group(0) @binding(5) var environment_blurred: texture_2d_array<f32>;
@group(0) @binding(6) var environment_sampler: sampler;
@group(0) @binding(7) var<uniform> environment_harmonics: Harmonics;

// Where an equirectangular picture of this height shows a direction.
fn environment_uv(direction: vec3f, height: u32) -> vec2f {
    let u = atan2(-direction.x, direction.z) / 6.2831853;
    let v = acos(clamp(direction.y, -1.0, 1.0)) / 3.14159265;
    // Around repeats; over the poles would turn around, so v stays half a texel inside.
    let inset = 0.5 / f32(height);
    return vec2f(fract(u), clamp(v, inset, 1.0 - inset));
}

// The picture in a direction of unit length.
fn environment_seen(direction: vec3f) -> vec3f {
    let uv = environment_uv(direction, textureDimensions(environment_picture).y);
    return textureSampleLevel(environment_picture, environment_sampler, uv, 0.0).rgb;
}

fn environment_level(direction: vec3f, level: u32) -> vec3f {
    if level == 0u {
        return environment_seen(direction);
    }
    let uv = environment_uv(direction, textureDimensions(environment_blurred).y);
    return textureSampleLevel(environment_blurred, environment_sampler, uv, i32(level) - 1, 0.0).rgb;
}

// What a mirror of this roughness shows in a direction.
fn environment_mirrored(direction: vec3f, roughness: f32) -> vec3f {
    let level = clamp(roughness, 0.0, 1.0) * f32(ENVIRONMENT_LEVELS - 1u);
    let lower = min(u32(level), ENVIRONMENT_LEVELS - 2u);
    return mix(environment_level(direction, lower), environment_level(direction, lower + 1u), level - f32(lower));
}

// Irradiance over π for a surface with this normal (Ramamoorthi and Hanrahan 2001).
fn environment_received(d: vec3f) -> vec3f {
    let w = environment_harmonics.weights;
    let sum = w[0] * 0.282095 + w[1] * (0.488603 * d.y) + w[2] * (0.488603 * d.z) + w[3] * (0.488603 * d.x)
        + w[4] * (1.092548 * d.x * d.y) + w[5] * (1.092548 * d.y * d.z) + w[6] * (0.315392 * (3.0 * d.z * d.z - 1.0))
        + w[7] * (1.092548 * d.x * d.z) + w[8] * (0.546274 * (d.x * d.x - d.y * d.y));
    return max(sum.rgb, vec3f(0.0));
}

// What a surface sends of its surroundings to the eye; the split sum's second factor by an analytic fit (Karis 2014, after
// Lazarov 2013).
fn environment_reflection(texels: Texels, normal: vec3f, toward: vec3f) -> vec3f {
    let received = environment_received(normal);
    if !REFLECTION_IS_PHYSICAL {
        return texels.base_color * received * texels.ao;
    }
    let f0 = mix(vec3f(0.04), texels.base_color, texels.metallic);
    let n_v = clamp(dot(normal, toward), 0.0, 1.0);
    let r = vec4f(
        1.0 - texels.roughness, 0.0425 - 0.0275 * texels.roughness, 1.04 - 0.572 * texels.roughness,
        0.022 * texels.roughness - 0.04);
    let a = min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y;
    let mirrors = max(f0 * (-1.04 * a + r.z) + vec3f(1.04 * a + r.w), vec3f(0.0));
    let mirror = normal * (2.0 * dot(normal, toward)) - toward;
    let specular = environment_mirrored(normalized_or(mirror, normal), texels.roughness) * mirrors;
    // What is mirrored does not reach the matt layer below.
    let matt = texels.base_color * received * (1.0 - texels.metallic) * max(vec3f(1.0) - mirrors, vec3f(0.0));
    return (matt + specular) * texels.ao;
}
