//! The exact walk: cell by cell along a line (Amanatides and Woo 1987), each cell's bilinear patch intersected in closed
//! form. The same steps as relievo-march/src/exact.rs, so that hits agree.
//!
//! Gives Line, Walk, walk_to_crossing.
//! Needs what height.wgsl needs.
//! #import record
//! #import height

// The longest walk, in cells.
const MAX_CELLS: u32 = 65536u;

// uv(s) = uv + slope·s at height `height + rise·s`.
struct Line {
    uv: vec2f,
    slope: vec2f,
    height: f32,
    rise: f32,
}

struct Walk {
    // Where the line is first on or below the surface, or where the walk ended without.
    s: f32,
    hit: bool,
    // Cells (and nodes of the pyramid) that were loaded, and turns of the loop.
    fetches: u32,
    turns: u32,
    // Not so where the walk was cut off at MAX_CELLS.
    finished: bool,
}

// The smallest x in [0, length] with c0 + c1·x + c2·x² ≤ 0, HUGE if there is none.
fn first_root(c0: f32, c1: f32, c2: f32, length: f32) -> f32 {
    if c0 <= 0.0 {
        return 0.0;
    }
    let discriminant = c1 * c1 - 4.0 * c2 * c0;
    if discriminant < 0.0 {
        return HUGE;
    }
    // The stable form: no cancellation. A root at infinity, c2 or q = 0, is none; WGSL leaves division by 0 open.
    let q = -0.5 * (c1 + select(-1.0, 1.0, c1 >= 0.0) * sqrt(discriminant));
    var nearest = HUGE;
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
fn patch_crossing(h: vec4f, at: vec2f, d: vec2f, line: Line, s: f32, length: f32) -> f32 {
    let beta = h[1] - h[0];
    let gamma = h[2] - h[0];
    let kappa = h[0] - h[1] - h[2] + h[3];
    let c0 = line.height + line.rise * s - (h[0] + beta * at.x + gamma * at.y + kappa * at.x * at.y);
    let c1 = line.rise - (beta * d.x + gamma * d.y + kappa * (at.x * d.y + at.y * d.x));
    let c2 = -kappa * d.x * d.y;
    return first_root(c0, c1, c2, length);
}

// The first s in [start, end] at which the line is on or below the surface, cell by cell.
fn walk_to_crossing(field: Field, line: Line, start: f32, end: f32, max_cells: u32) -> Walk {
    let size = vec2f(field.size);
    // Texel-centre coordinates. Cells are counted from the one the line starts in, so that no precision is lost far from
    // the texture's origin.
    let origin = line.uv * size - 0.5;
    let base = floor(origin);
    let first = vec2i(base);
    let local = origin - base;
    let d = line.slope * size;
    let flat = d == vec2f(0.0);
    let pace = 1.0 / select(d, vec2f(1.0), flat);
    let step = select(vec2i(-1), vec2i(1), d > vec2f(0.0));
    let ahead = select(vec2i(0), vec2i(1), d > vec2f(0.0));

    var s = start;
    var entry = local + d * s;
    var cell = vec2i(floor(entry));
    // Where the line leaves its column and its row. Computed anew for each border: no drift.
    var next = select((vec2f(cell + ahead) - local) * pace, vec2f(HUGE), flat);
    for (var cells = 1u; cells <= max_cells; cells++) {
        let along_v = next.y < next.x;
        let leave = min(max(select(next.x, next.y, along_v), s), end);
        let h = height_corners(field, first + cell);
        let lowest = line.height + line.rise * select(s, leave, line.rise < 0.0);
        // The patch is nowhere above its highest corner: most cells need no more than this.
        if lowest <= max(max(h[0], h[1]), max(h[2], h[3])) {
            let at = clamp(entry - vec2f(cell), vec2f(0.0), vec2f(1.0));
            let x = patch_crossing(h, at, d, line, s, leave - s);
            if x < HUGE {
                return Walk(s + x, true, cells, cells, true);
            }
        }
        if leave >= end {
            return Walk(end, false, cells, cells, true);
        }
        if cells == max_cells {
            return Walk(leave, false, cells, cells, false);
        }
        s = leave;
        entry = local + d * s;
        // The line crosses this border exactly; rounding must not put it beside.
        if along_v {
            entry.y = f32(cell.y + ahead.y);
            cell.y += step.y;
            next.y = (f32(cell.y + ahead.y) - local.y) * pace.y;
        } else {
            entry.x = f32(cell.x + ahead.x);
            cell.x += step.x;
            next.x = (f32(cell.x + ahead.x) - local.x) * pace.x;
        }
    }
    return Walk(end, false, max_cells, max_cells, false);
}
