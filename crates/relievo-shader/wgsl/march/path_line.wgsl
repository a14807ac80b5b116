//! The way of a straight ray over the grid of cells, as descent.wgsl follows it.
//!
//! Gives RelievoPath, RelievoPathPoint, relievo_path_of_line, relievo_path_at, relievo_path_crossings, relievo_path_crossing,
//! relievo_path_lowest,
//! relievo_path_height_and_speed, relievo_path_patch.
//! Needs what height.wgsl needs.
//! #import walk

struct RelievoPath {
    grid: RelievoGridLine,
    line: RelievoHeightLine,
    // Height in codes, at s = 0 and per unit of s.
    code: vec2f,
}

struct RelievoPathPoint {
    // In texels from the first cell.
    position: vec2f,
    // Height in codes.
    code: f32,
}

// `code`: the height of code 0 with the slack, and codes per unit of height.
fn relievo_path_of_line(field: RelievoHeightField, line: RelievoHeightLine, code: vec2f) -> RelievoPath {
    return RelievoPath(relievo_grid_line(field, line), line, vec2f(line.height * code.y - code.x, line.dheight_ds * code.y));
}

fn relievo_path_at(path: RelievoPath, s: f32) -> RelievoPathPoint {
    return RelievoPathPoint(path.grid.local + path.grid.d * s, path.code.x + path.code.y * s);
}

// Where the way crosses a column's and a row's border, HUGE if it does not.
fn relievo_path_crossings(path: RelievoPath, edge: vec2i) -> vec2f {
    return select((vec2f(edge) - path.grid.local) * path.grid.inv_d, vec2f(RELIEVO_HUGE), path.grid.flat);
}

// The same for one border, of a row or a column.
fn relievo_path_crossing(path: RelievoPath, edge: i32, of_row: bool) -> f32 {
    let grid = path.grid;
    let s = (f32(edge) - select(grid.local.x, grid.local.y, of_row)) * select(grid.inv_d.x, grid.inv_d.y, of_row);
    return select(s, RELIEVO_HUGE, select(grid.flat.x, grid.flat.y, of_row));
}

// A lower bound of the height in codes between two points that are `length` apart.
fn relievo_path_lowest(path: RelievoPath, a: RelievoPathPoint, b: RelievoPathPoint, length: f32) -> f32 {
    return min(a.code, b.code);
}

// The height at `s`, and the texels that it goes by per unit of s.
fn relievo_path_height_and_speed(path: RelievoPath, s: f32) -> vec2f {
    return vec2f(path.line.height + path.line.dheight_ds * s, length(path.grid.d));
}

// How far beyond `s` the way meets the patch of a cell that it enters at `entry`, HUGE if it does not until `t_exit`.
fn relievo_path_patch(
    path: RelievoPath, h: vec4f, cell: vec2i, entry: vec2f, s: f32, t_exit: f32,
) -> f32 {
    let line = path.line;
    let lowest = min(line.height + line.dheight_ds * s, line.height + line.dheight_ds * t_exit);
    if !(lowest <= max(max(h[0], h[1]), max(h[2], h[3]))) {
        return RELIEVO_HUGE;
    }
    let inside = clamp(entry - vec2f(cell), vec2f(0.0), vec2f(1.0));
    return relievo_patch_crossing(h, inside, path.grid.d, line, s, t_exit - s);
}
