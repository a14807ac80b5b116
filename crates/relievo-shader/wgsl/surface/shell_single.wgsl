//! The search through one shell alone: for fragments of the hull around each.
//!
//! Gives relievo_shell_search.
//! Needs nothing else.
//! #import shell_found

fn relievo_shell_search(in: RelievoVertexOut, eye: RelievoViewRay, near: f32) -> RelievoShellFound {
    let at = relievo_shell_triangle(in.triangle, 1.0 - relievo_lid_offset(relievo_surface.options));
    let detail = relievo_shell_detail(in.triangle, at.prism, eye);
    let hit = relievo_march_shell(detail.field, detail.prism, eye.origin, -eye.to_eye, near, RELIEVO_HUGE);
    return RelievoShellFound(hit, in.triangle, at.prism);
}
