//! The surroundings where nothing else is seen.
//!
//! Gives the entry points `vertex` and `fragment`.
//! Needs nothing else.
//! #import scene
//! #import environment
//! #import chosen_output

struct BackgroundOut {
    @builtin(position) clip: vec4f,
    @location(0) place: vec2f,
}

// One triangle that covers everything, infinitely far away.
@vertex
fn vertex(@builtin(vertex_index) index: u32) -> BackgroundOut {
    let place = vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return BackgroundOut(vec4f(place, 0.0, 1.0), place);
}

@fragment
fn fragment(in: BackgroundOut) -> @location(0) vec4f {
    let offset = in.place - view.shift;
    let direction = view.forward + view.right * (offset.x / dot(view.right, view.right))
        + view.up * (offset.y / dot(view.up, view.up));
    return vec4f(output_color(environment_seen(normalize(direction))), 1.0);
}
