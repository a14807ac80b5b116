//! The vertex stage: from scene space to the picture.
//!
//! Gives the entry point `relievo_vertex`, RelievoVertexOut.
//! Needs nothing else.
//! #import scene

struct RelievoVertexIn {
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) tangent: vec4f,
    @location(3) uv: vec2f,
    @location(4) jacobian: vec4f,
}

struct RelievoVertexOut {
    @invariant @builtin(position) clip: vec4f,
    // Inside the polygon also where its border crosses the pixel.
    @location(0) @interpolate(perspective, centroid) position: vec3f,
    @location(1) @interpolate(perspective, centroid) normal: vec3f,
    @location(2) @interpolate(perspective, centroid) tangent: vec4f,
    @location(3) @interpolate(perspective, centroid) uv: vec2f,
    @location(4) @interpolate(perspective, centroid) jacobian: vec4f,
}

@vertex
fn relievo_vertex(in: RelievoVertexIn) -> RelievoVertexOut {
    let offset = in.position - relievo_view.eye;
    let view_depth = dot(offset, relievo_view.forward);
    let side = vec2f(dot(offset, relievo_view.right), dot(offset, relievo_view.up));
    // Depth runs from 1 at the near plane to 0 at infinity.
    var clip = vec4f(side + relievo_view.jitter * view_depth, relievo_view.near, view_depth);
    if relievo_view.parallel != 0u {
        clip = vec4f(side + relievo_view.jitter, 1.0 - view_depth / relievo_view.far, 1.0);
    }
    return RelievoVertexOut(clip, in.position, in.normal, in.tangent, in.uv, in.jacobian);
}
