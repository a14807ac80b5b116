//! Blinn 1977, as the tutorials write it: the highlight is not tied to the diffuse term. Scattered normals widen it and take
//! of its height what they add to its width (Toksvig 2005); the diffuse term takes the mean normal as it is.
//!
//! Gives relievo_blinn_phong: what goes to the eye of a unit of light; the vectors are of unit length.
//! Needs nothing else.
//! #import material_sample
//! #import tangent
//! #import mean_normal

fn relievo_blinn_phong(
    material: RelievoMaterialSample, normal: RelievoMeanNormal, to_eye: vec3f, light: vec3f, specular: f32, narrow: f32,
) -> vec3f {
    let diffuse = max(dot(light, normal.direction), 0.0) * normal.length;
    let shininess = narrow / (1.0 + narrow * relievo_mean_normal_variance(normal.length));
    let height = (1.0 + shininess) / (1.0 + narrow);
    let n_h = max(dot(normal.direction, relievo_normalized_or(light + to_eye, vec3f(0.0))), 0.0);
    // The power of 0 is left open where it is computed by a logarithm.
    let highlight = select(select(0.0, 1.0, shininess == 0.0), pow(n_h, shininess), n_h > 0.0);
    return material.base_color * diffuse + vec3f(specular * height * highlight);
}
