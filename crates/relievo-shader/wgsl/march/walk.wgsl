//! The exact walk: cell by cell along a line (Amanatides and Woo 1987), each cell's bilinear patch intersected in closed
//! form. The same steps as relievo-march/src/exact.rs, so that hits agree.
//!
//! Gives RelievoHeightLine, RelievoCellWalk, relievo_walk_to_crossing.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

// The longest walk, in cells.
const RELIEVO_MAX_CELLS: u32 = 65536u;

// uv(s) = uv + slope·s at height `height + dheight_ds·s`.
struct RelievoHeightLine {
    uv: vec2f,
    slope: vec2f,
    height: f32,
    dheight_ds: f32,
}

// How far beyond the border of a column its wall is met, in texels.
const RELIEVO_BESIDE_WALL: f32 = 1e-3;
// The part of the full depth that such a hit goes on at most, where a ray falls steeply along the wall.
const RELIEVO_MOST_DEEPER: f32 = 1e-3;

struct RelievoCellWalk {
    // Where the line is first on or below the surface, or where the walk ended without.
    s: f32,
    hit: bool,
    // Cells (and nodes of the pyramid) that were loaded, and turns of the loop.
    fetches: u32,
    iterations: u32,
    // Not so where the walk was cut off at RELIEVO_MAX_CELLS.
    finished: bool,
}

// The smallest x in [0, length] with c0 + c1·x + c2·x² ≤ 0, HUGE if there is none.
fn relievo_first_root(c0: f32, c1: f32, c2: f32, length: f32) -> f32 {
    if c0 <= 0.0 {
        return 0.0;
    }
    let discriminant = c1 * c1 - 4.0 * c2 * c0;
    if discriminant < 0.0 {
        return RELIEVO_HUGE;
    }
    // The stable form: no cancellation. A root at infinity, c2 or q = 0, is none; WGSL leaves division by 0 open.
    let q = -0.5 * (c1 + select(-1.0, 1.0, c1 >= 0.0) * sqrt(discriminant));
    var nearest = RELIEVO_HUGE;
    if c2 != 0.0 {
        let x = q / c2;
        if x > 0.0 && x <= length {
            nearest = x;
        }
    }
    if q != 0.0 {
        let x = c0 / q;
        if x > 0.0 && x <= length {
            nearest = min(nearest, x);
        }
    }
    return nearest;
}

// How far beyond `s`, at most `length`, the line meets the patch over the corners h00, h10, h01, h11, which it enters at
// `at` in [0, 1]² and crosses with d texels per unit of s.
fn relievo_patch_crossing(h: vec4f, at: vec2f, d: vec2f, line: RelievoHeightLine, s: f32, length: f32) -> f32 {
    let beta = h[1] - h[0];
    let gamma = h[2] - h[0];
    let kappa = h[0] - h[1] - h[2] + h[3];
    let c0 = line.height + line.dheight_ds * s - (h[0] + beta * at.x + gamma * at.y + kappa * at.x * at.y);
    let c1 = line.dheight_ds - (beta * d.x + gamma * d.y + kappa * (at.x * d.y + at.y * d.x));
    let c2 = -kappa * d.x * d.y;
    return relievo_first_root(c0, c1, c2, length);
}

// A line over the cells of a level, which are counted from the one it starts in: so no precision is lost far from the
// texture's origin.
struct RelievoGridLine {
    // The cell that counting begins at, and where the line starts in it, in texels.
    first: vec2i,
    local: vec2f,
    // Texels per unit of s, and the reverse; an axis along which the line does not move is flat.
    d: vec2f,
    inv_d: vec2f,
    flat: vec2<bool>,
    // From a cell to the next, and from a cell to the border it is left by.
    step: vec2i,
    border_offset: vec2i,
}

fn relievo_grid_line(field: RelievoHeightField, line: RelievoHeightLine) -> RelievoGridLine {
    let size = vec2f(field.size);
    // Cells lie between texel centres, or are the texels.
    let origin = line.uv * size - select(0.5, 0.0, RELIEVO_NEAREST);
    let base = floor(origin);
    let d = line.slope * size;
    let flat = d == vec2f(0.0);
    let forward = d > vec2f(0.0);
    return RelievoGridLine(
        vec2i(base), origin - base, d, 1.0 / select(d, vec2f(1.0), flat), flat, select(vec2i(-1), vec2i(1), forward),
        select(vec2i(0), vec2i(1), forward));
}

// Where the line leaves column and row `cell` for the next ones.
fn relievo_grid_borders(grid: RelievoGridLine, cell: vec2i) -> vec2f {
    return select((vec2f(cell + grid.border_offset) - grid.local) * grid.inv_d, vec2f(RELIEVO_HUGE), grid.flat);
}

// The first s in [start, end] at which the line is on or below the surface, cell by cell.
fn relievo_walk_to_crossing(
    field: RelievoHeightField, line: RelievoHeightLine, start: f32, end: f32, max_cells: u32,
) -> RelievoCellWalk {
    let grid = relievo_grid_line(field, line);
    var s = start;
    var entry = grid.local + grid.d * s;
    var cell = vec2i(floor(entry));
    // Where the line leaves its column and its row. Computed anew for each border: no drift.
    var t_max = relievo_grid_borders(grid, cell);
    for (var cells = 1u; cells <= max_cells; cells++) {
        let along_v = t_max.y < t_max.x;
        let t_exit = min(max(select(t_max.x, t_max.y, along_v), s), end);
        let h = relievo_height_corners(field, grid.first + cell);
        let lowest = line.height + line.dheight_ds * select(s, t_exit, line.dheight_ds < 0.0);
        // The patch is nowhere above its highest corner: most cells need no more than this.
        if lowest <= max(max(h[0], h[1]), max(h[2], h[3])) {
            let at = clamp(entry - vec2f(cell), vec2f(0.0), vec2f(1.0));
            var x = relievo_patch_crossing(h, at, grid.d, line, s, t_exit - s);
            if x < RELIEVO_HUGE {
                if RELIEVO_NEAREST && x == 0.0 && line.height + line.dheight_ds * s < h[0] {
                    // The wall of a column: a hair beyond its border, so that uv shows the column.
                    let beside = RELIEVO_BESIDE_WALL / max(max(abs(grid.d.x), abs(grid.d.y)), 1e-30);
                    x = min(min(beside, RELIEVO_MOST_DEEPER), t_exit - s);
                }
                return RelievoCellWalk(s + x, true, cells, cells, true);
            }
        }
        if t_exit >= end {
            return RelievoCellWalk(end, false, cells, cells, true);
        }
        if cells == max_cells {
            return RelievoCellWalk(t_exit, false, cells, cells, false);
        }
        s = t_exit;
        entry = grid.local + grid.d * s;
        // The line crosses this border exactly; rounding must not put it beside.
        if along_v {
            entry.y = f32(cell.y + grid.border_offset.y);
            cell.y += grid.step.y;
            t_max.y = (f32(cell.y + grid.border_offset.y) - grid.local.y) * grid.inv_d.y;
        } else {
            entry.x = f32(cell.x + grid.border_offset.x);
            cell.x += grid.step.x;
            t_max.x = (f32(cell.x + grid.border_offset.x) - grid.local.x) * grid.inv_d.x;
        }
    }
    return RelievoCellWalk(end, false, max_cells, max_cells, false);
}
