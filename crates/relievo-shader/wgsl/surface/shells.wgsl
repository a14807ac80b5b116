//! The triangles with shells over them, of all objects: a texture.
//!
//! Gives RelievoShellTriangle, relievo_shell_triangle, relievo_shell_frame; declares its binding, in group 2.
//! Needs nothing else.
//! #import shell
//! #import tangent

// A triangle takes 13 texels side by side, all bits of numbers: positions with u, directions along which the relief rises with v
// (three each), the triangles across the edges with the depth, normals, tangents. A power of two to a row.
@group(2) @binding(1) var relievo_shells: texture_2d<u32>;

const RELIEVO_SHELL_TEXELS: u32 = 13u;
// Stands for no neighbor.
const RELIEVO_NOBODY: u32 = 0xffffffffu;

struct RelievoShellTriangle {
    prism: RelievoPrism,
    // The triangles across the edges opposite to the corners.
    neighbors: vec3u,
}

// Where a triangle lies in the texture.
fn relievo_shell_texel(triangle: u32) -> vec2i {
    let in_row = textureDimensions(relievo_shells).x / RELIEVO_SHELL_TEXELS;
    // Exact: divided by a power of two, and there are fewer triangles than f32 can count. Integers are divided one by one.
    let row = floor(f32(triangle) / f32(in_row));
    return vec2i(i32((triangle & (in_row - 1u)) * RELIEVO_SHELL_TEXELS), i32(row));
}

fn relievo_shell_load(texel: vec2i, k: i32) -> vec4f {
    return bitcast<vec4f>(textureLoad(relievo_shells, texel + vec2i(k, 0), 0));
}

fn relievo_shell_triangle(triangle: u32, midlevel: f32) -> RelievoShellTriangle {
    let texel = relievo_shell_texel(triangle);
    let a = relievo_shell_load(texel, 0);
    let b = relievo_shell_load(texel, 1);
    let c = relievo_shell_load(texel, 2);
    let along_a = relievo_shell_load(texel, 3);
    let along_b = relievo_shell_load(texel, 4);
    let along_c = relievo_shell_load(texel, 5);
    let rest = textureLoad(relievo_shells, texel + vec2i(6, 0), 0);
    let prism = RelievoPrism(
        a.xyz, b.xyz, c.xyz, along_a.xyz, along_b.xyz, along_c.xyz, vec2f(a.w, along_a.w), vec2f(b.w, along_b.w),
        vec2f(c.w, along_c.w), bitcast<f32>(rest.w), midlevel);
    return RelievoShellTriangle(prism, rest.xyz);
}

// The frame at a point of a triangle.
fn relievo_shell_frame(triangle: u32, prism: RelievoPrism, weights: vec3f) -> RelievoTangentFrame {
    let texel = relievo_shell_texel(triangle);
    let normal = relievo_shell_load(texel, 7).xyz * weights.x + relievo_shell_load(texel, 8).xyz * weights.y
        + relievo_shell_load(texel, 9).xyz * weights.z;
    let tangent_a = relievo_shell_load(texel, 10);
    let tangent = tangent_a.xyz * weights.x + relievo_shell_load(texel, 11).xyz * weights.y
        + relievo_shell_load(texel, 12).xyz * weights.z;
    let direction = prism.normal_a * weights.x + prism.normal_b * weights.y + prism.normal_c * weights.z;
    let e1 = prism.position_b - prism.position_a;
    let e2 = prism.position_c - prism.position_a;
    let d1 = prism.uv_b - prism.uv_a;
    let d2 = prism.uv_c - prism.uv_a;
    let area = d1.x * d2.y - d1.y * d2.x;
    return relievo_tangent_frame(
        normal, direction, vec4f(tangent, tangent_a.w), (e1 * d2.y - e2 * d1.y) / area, (e2 * d1.x - e1 * d2.x) / area, prism.depth);
}
