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
    @location(4) dp_du: vec3f,
    @location(5) dp_dv: vec3f,
    // Lower and upper corner of the chart's texture range.
    @location(6) range: vec4f,
    // The length of a texture repeat along u on the chart.
    @location(7) repeat_length: f32,
    // Along which the relief rises.
    @location(8) direction: vec3f,
}

struct RelievoVertexOut {
    @invariant @builtin(position) clip: vec4f,
    // Inside the polygon also where its border crosses the pixel.
    @location(0) @interpolate(perspective, centroid) position: vec3f,
    @location(1) @interpolate(perspective, centroid) normal: vec3f,
    @location(2) @interpolate(perspective, centroid) tangent: vec4f,
    @location(3) @interpolate(perspective, centroid) uv: vec2f,
    @location(4) @interpolate(flat) dp_du: vec3f,
    @location(5) @interpolate(flat) dp_dv: vec3f,
    @location(6) @interpolate(flat) range: vec4f,
    @location(7) @interpolate(flat) repeat_length: f32,
    @location(8) @interpolate(perspective, centroid) direction: vec3f,
}

@vertex
fn relievo_vertex(in: RelievoVertexIn) -> RelievoVertexOut {
    return RelievoVertexOut(
        relievo_clip_position(in.position), in.position, in.normal, in.tangent, in.uv, in.dp_du, in.dp_dv, in.range,
        in.repeat_length, in.direction);
}
