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
    // Inside the polygon also where its border crosses the pixel.
    @location(0) @interpolate(perspective, centroid) position: vec3f,
    @location(1) @interpolate(perspective, centroid) normal: vec3f,
    @location(2) @interpolate(perspective, centroid) tangent: vec4f,
    @location(3) @interpolate(perspective, centroid) uv: vec2f,
    @location(4) @interpolate(perspective, centroid) jacobian: vec4f,
}

@vertex
fn vertex(in: VertexIn) -> VertexOut {
    let way = in.position - view.eye;
    let ahead = dot(way, view.forward);
    let side = vec2f(dot(way, view.right), dot(way, view.up));
    // Depth runs from 1 at the near plane to 0 at infinity.
    var clip = vec4f(side + view.shift * ahead, view.near, ahead);
    if view.parallel != 0u {
        clip = vec4f(side + view.shift, 1.0 - ahead / view.far, 1.0);
    }
    return VertexOut(clip, in.position, in.normal, in.tangent, in.uv, in.jacobian);
}
