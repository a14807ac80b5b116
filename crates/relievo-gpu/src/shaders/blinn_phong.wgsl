//! Blinn 1977, as the tutorials write it: the highlight is not tied to the diffuse term.
//!
//! Gives blinn_phong: what goes to the eye of a unit of light; the vectors are of unit length.
//! Needs nothing else.
//! #import texels
//! #import tangent

fn blinn_phong(texels: Texels, normal: vec3f, view: vec3f, light: vec3f, specular: f32, shininess: f32) -> vec3f {
    let diffuse = max(dot(light, normal), 0.0);
    let n_h = max(dot(normal, normalized_or(light + view, vec3f(0.0))), 0.0);
    // The power of 0 is left open where it is computed by a logarithm.
    let highlight = select(select(0.0, 1.0, shininess == 0.0), pow(n_h, shininess), n_h > 0.0);
    return texels.base_color * diffuse + vec3f(specular * highlight);
}
