//! The search from shell to shell: a ray that comes in through a lid, or a wall without a neighbor, goes on across the edges
//! until it meets the surface or leaves through a lid again.
//!
//! Gives relievo_shell_search.
//! Needs nothing else.
//! #import shell_found

// More shells than this one ray does not walk through.
const RELIEVO_MOST_SHELLS: u32 = 512u;

fn relievo_shell_search(in: RelievoVertexOut, eye: RelievoViewRay, near: f32) -> RelievoShellFound {
    let midlevel = 1.0 - relievo_lid_offset(relievo_surface.options);
    var triangle = in.triangle;
    var offset = in.limits.y;
    var enters = in.face != RELIEVO_LID;
    var found = RelievoShellFound();
    for (var i = 0u; i < RELIEVO_MOST_SHELLS; i++) {
        let at = relievo_shell_triangle(triangle, midlevel);
        let detail = relievo_shell_detail(triangle, at.prism, eye);
        let field = detail.field;
        let curve = relievo_shell_curve(detail.prism, eye.origin, -eye.to_eye, vec2f(field.size));
        if enters {
            offset = relievo_shell_wall_offset(curve, detail.prism, in.face, eye.distance);
        }
        let exit = relievo_shell_exit(curve, offset, in.limits);
        let heights = relievo_shell_offsets(detail.prism, field.range, curve.shortest_normal);
        let part = clamp(vec2f(offset, exit.offset), vec2f(heights.x), vec2f(heights.y));
        var hit = RelievoShellHit();
        if part.x != part.y {
            hit = relievo_march_part(field, detail.prism, curve, part.x, part.y);
        }
        hit.record.fetches += found.hit.record.fetches;
        hit.record.iterations += found.hit.record.iterations;
        found = RelievoShellFound(hit, triangle, at.prism);
        let neighbor = select(select(at.neighbors.z, at.neighbors.y, exit.edge == 1u), at.neighbors.x, exit.edge == 0u);
        if hit.record.hit || exit.edge == 3u || neighbor == RELIEVO_NOBODY {
            break;
        }
        triangle = neighbor;
        offset = exit.offset;
        enters = false;
    }
    return found;
}
