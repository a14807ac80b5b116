//! glTF 2.0's metallic-roughness model (appendix B): GGX (Walter et al. 2007), height-correlated Smith visibility (Heitz
//! 2014), Schlick's Fresnel (1994).
//!
//! Gives relievo_metallic_roughness: what goes to the eye of a unit of light; the vectors are of unit length.
//! Needs nothing else.
//! #import material_sample
//! #import tangent
//! #import mean_normal

const RELIEVO_PI: f32 = 3.14159265;

fn relievo_metallic_roughness(
    material: RelievoMaterialSample, mean: RelievoMeanNormal, to_eye: vec3f, light: vec3f,
) -> vec3f {
    let normal = mean.direction;
    let n_l = dot(normal, light);
    if n_l <= 0.0 {
        return vec3f(0.0);
    }
    // A normal map may turn away from the eye; the model is not defined there.
    let n_v = max(dot(normal, to_eye), 1e-4);
    let half = relievo_normalized_or(light + to_eye, vec3f(0.0));
    let n_h = clamp(dot(normal, half), 0.0, 1.0);
    let v_h = clamp(dot(to_eye, half), 0.0, 1.0);
    // Perfect mirrors would have a highlight that no sampling finds.
    let roughness = clamp(material.roughness, 0.045, 1.0);
    let a2 = roughness * roughness * roughness * roughness;
    let d = n_h * n_h * (a2 - 1.0) + 1.0;
    let distribution = a2 / (RELIEVO_PI * d * d);
    let smith = n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2);
    let f0 = mix(vec3f(0.04), material.base_color, material.metallic);
    let away = 1.0 - v_h;
    let fresnel = f0 + (1.0 - f0) * (away * away * away * away * away);
    let diffuse = (1.0 - fresnel) * (1.0 - material.metallic) * material.base_color / RELIEVO_PI;
    return (diffuse * mean.length + fresnel * (distribution * 0.5 / smith)) * n_l;
}
