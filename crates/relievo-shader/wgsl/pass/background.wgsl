//! The surroundings where nothing else is seen.
//!
//! Gives the entry points `relievo_vertex` and `relievo_fragment`.
//! Needs nothing else.
//! #import scene
//! #import environment
//! #import chosen_output

struct RelievoBackgroundOut {
    @builtin(position) clip: vec4f,
    @location(0) ndc: vec2f,
}

// One triangle that covers everything, infinitely far away.
@vertex
fn relievo_vertex(@builtin(vertex_index) index: u32) -> RelievoBackgroundOut {
    let ndc = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return RelievoBackgroundOut(vec4f(ndc, 0.0, 1.0), ndc);
}

@fragment
fn relievo_fragment(in: RelievoBackgroundOut) -> @location(0) vec4f {
    let offset = select(in.ndc - relievo_view.jitter, vec2f(0.0), relievo_view.parallel != 0u);
    let direction = relievo_view.forward + relievo_view.right * (offset.x / dot(relievo_view.right, relievo_view.right))
        + relievo_view.up * (offset.y / dot(relievo_view.up, relievo_view.up));
    return vec4f(relievo_output_color(relievo_environment_seen(normalize(direction))), 1.0);
}
