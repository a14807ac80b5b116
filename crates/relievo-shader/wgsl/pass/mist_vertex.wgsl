//! The vertex stage of passes over mist: one triangle that covers everything.
//!
//! Gives the entry point `relievo_vertex`.
//! Needs nothing.

@vertex
fn relievo_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}
