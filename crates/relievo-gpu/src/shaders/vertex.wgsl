//! The vertex stage: from scene space to the picture.
//!
//! Gives the entry point `vertex`, VertexOut.
//! Needs nothing else.
//! #import scene

struct VertexIn {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
    @location(4) jacobian: vec4f,
}

struct VertexOut {
    @invariant @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
    @location(4) jacobian: vec4f,
}

@vertex
fn vertex(in: VertexIn) -> VertexOut {
    let way = in.position - view.eye;
    // Depth runs from 1 at the near plane to 0 at infinity.
    let ahead = dot(way, view.forward);
    let clip = vec4f(vec2f(dot(way, view.right), dot(way, view.up)) + view.shift * ahead, view.near, ahead);
    return VertexOut(clip, in.position, in.normal, in.tangent, in.uv, in.jacobian);
}
