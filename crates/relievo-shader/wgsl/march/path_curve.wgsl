//! The way of a ray over the grid of cells as seen from the shell over a triangle: rational curves of degree 2 along u and v.
//! The same steps as relievo-march/src/shell/path.rs.
//!
//! Gives RelievoPath, RelievoPathPoint, relievo_path_of_line, relievo_path_at, relievo_path_crossings, relievo_path_crossing,
//! relievo_path_lowest,
//! relievo_path_height_and_speed, relievo_path_patch, relievo_path_walk.
//! Needs what height.wgsl needs.
//! #import walk

// How far a chord inside a cell may be from the curve, in texels.
const RELIEVO_CHORD_ERROR: f32 = 1e-3;
// The most chords inside a cell.
const RELIEVO_MOST_CHORDS: f32 = 32.0;

// At s in [0, 1] the position is p(s)/w(s), the height `midlevel + (offset.x + offset.y·s)·√n(s)/w(s)`; w is positive, and u and v
// rise or fall all the way.
struct RelievoPath {
    grid: RelievoGridLine,
    // Coefficients of powers of s.
    p0: vec2f,
    p1: vec2f,
    p2: vec2f,
    w: vec3f,
    // The squared length of the interpolated normal, times w².
    n: vec4f,
    n4: f32,
    offset: vec2f,
    midlevel: f32,
    // By how much the height may be below a chord of length 1.
    sag: f32,
    texels_per_height: f32,
    // The height of code 0 with the slack, and codes per unit of height.
    code: vec2f,
}

struct RelievoPathPoint {
    // In texels from the first cell.
    position: vec2f,
    // Height in codes.
    code: f32,
}

// A straight way, as shadows have it.
fn relievo_path_of_line(field: RelievoHeightField, line: RelievoHeightLine, code: vec2f) -> RelievoPath {
    let grid = relievo_grid_line(field, line);
    return RelievoPath(
        grid, grid.local, grid.d, vec2f(0.0), vec3f(1.0, 0.0, 0.0), vec4f(1.0, 0.0, 0.0, 0.0), 0.0,
        vec2f(line.height, line.dheight_ds), 0.0, 0.0, 0.0, code);
}

fn relievo_path_height(path: RelievoPath, s: f32) -> f32 {
    let n = path.n.x + s * (path.n.y + s * (path.n.z + s * (path.n.w + s * path.n4)));
    let w = path.w.x + s * (path.w.y + s * path.w.z);
    return path.midlevel + (path.offset.x + path.offset.y * s) * sqrt(max(n, 0.0)) / w;
}

fn relievo_path_position(path: RelievoPath, s: f32) -> vec2f {
    return (path.p0 + s * (path.p1 + s * path.p2)) / (path.w.x + s * (path.w.y + s * path.w.z));
}

fn relievo_path_at(path: RelievoPath, s: f32) -> RelievoPathPoint {
    return RelievoPathPoint(relievo_path_position(path, s), relievo_path_height(path, s) * path.code.y - path.code.x);
}

// Where the way crosses a column's and a row's border, HUGE if it does not. It rises or falls all the way: of the numerator less
// the border times w, in Bernstein form, the ends have two signs, and the root is x/(1 + x) with x positive.
fn relievo_path_crossings(path: RelievoPath, edge: vec2i) -> vec2f {
    let k = vec2f(edge);
    let sign = vec2f(path.grid.step);
    let f0 = (path.p0 - k * path.w.x) * sign;
    let f1 = f0 + 0.5 * (path.p1 - k * path.w.y) * sign;
    let f2 = 2.0 * f1 - f0 + (path.p2 - k * path.w.z) * sign;
    let g = max(-f0, vec2f(0.0));
    let root = sqrt(f1 * f1 + g * max(f2, vec2f(0.0)));
    let rises = f1 >= vec2f(0.0);
    let numerator = select(root - f1, g, rises);
    let more = select(f2, f1 + root, rises);
    return select(vec2f(RELIEVO_HUGE), numerator / (numerator + more), f2 > vec2f(0.0));
}

// The same for one border, of a row or a column.
fn relievo_path_crossing(path: RelievoPath, edge: i32, of_row: bool) -> f32 {
    let k = f32(edge);
    let sign = f32(select(path.grid.step.x, path.grid.step.y, of_row));
    let f0 = (select(path.p0.x, path.p0.y, of_row) - k * path.w.x) * sign;
    let f1 = f0 + 0.5 * (select(path.p1.x, path.p1.y, of_row) - k * path.w.y) * sign;
    let f2 = 2.0 * f1 - f0 + (select(path.p2.x, path.p2.y, of_row) - k * path.w.z) * sign;
    let g = max(-f0, 0.0);
    let root = sqrt(f1 * f1 + g * max(f2, 0.0));
    let numerator = select(root - f1, g, f1 >= 0.0);
    return select(RELIEVO_HUGE, numerator / (numerator + select(f2, f1 + root, f1 >= 0.0)), f2 > 0.0);
}

// A lower bound of the height in codes between two points that are `length` apart.
fn relievo_path_lowest(path: RelievoPath, a: RelievoPathPoint, b: RelievoPathPoint, length: f32) -> f32 {
    return min(a.code, b.code) - path.sag * length * length * path.code.y;
}

// The height at `s`, and the texels that it goes by per unit of s.
fn relievo_path_height_and_speed(path: RelievoPath, s: f32) -> vec2f {
    return vec2f(relievo_path_height(path, s), length(relievo_path_position(path, 1.0) - relievo_path_position(path, 0.0)));
}

// How far the chord between two places is from the curve at most, in texels: with numerator and w in Bernstein form the position
// differs by x(1 − x)·((1 − x)·a + x·b)/w(x).
fn relievo_path_chord_error(path: RelievoPath, s: f32, length: f32, first: vec2f, last: vec2f) -> f32 {
    let end = s + length;
    let p0 = path.p0 + s * (path.p1 + s * path.p2);
    let p2 = path.p0 + end * (path.p1 + end * path.p2);
    let p1 = p0 + (path.p1 + path.p2 * (2.0 * s)) * (0.5 * length);
    let w0 = path.w.x + s * (path.w.y + s * path.w.z);
    let w2 = path.w.x + end * (path.w.y + end * path.w.z);
    let w1 = w0 + (path.w.y + path.w.z * (2.0 * s)) * (0.5 * length);
    let a = p0 + 2.0 * p1 - w0 * last - 2.0 * w1 * first;
    let b = p2 + 2.0 * p1 - w2 * first - 2.0 * w1 * last;
    let off = max(abs(a), abs(b)) * (0.25 / max(min(min(w0, w1), w2), 1e-6));
    return max(max(off.x, off.y), path.sag * length * length * path.texels_per_height);
}

// How far beyond `s` the way meets the patch of a cell that it enters at `entry`, HUGE if it does not until `t_exit`: by as many
// chords as keep close to the curve.
fn relievo_path_patch(
    path: RelievoPath, h: vec4f, cell: vec2i, entry: vec2f, s: f32, t_exit: f32,
) -> f32 {
    let length = t_exit - s;
    let highest = max(max(h[0], h[1]), max(h[2], h[3]));
    let out = relievo_path_position(path, t_exit);
    let error = relievo_path_chord_error(path, s, length, entry, out);
    let chords = clamp(ceil(sqrt(error / RELIEVO_CHORD_ERROR)), 1.0, RELIEVO_MOST_CHORDS);
    var a = entry - vec2f(cell);
    var height = relievo_path_height(path, s);
    for (var i = 0.0; i < chords; i += 1.0) {
        let end = s + length * ((i + 1.0) / chords);
        let b = relievo_path_position(path, end) - vec2f(cell);
        let height_after = relievo_path_height(path, end);
        if min(height, height_after) <= highest {
            let chord = RelievoHeightLine(vec2f(0.0), vec2f(0.0), height, height_after - height);
            let x = relievo_patch_crossing(h, clamp(a, vec2f(0.0), vec2f(1.0)), b - a, chord, 0.0, 1.0);
            if x < RELIEVO_HUGE {
                return length * ((i + x) / chords);
            }
        }
        a = b;
        height = height_after;
    }
    return RELIEVO_HUGE;
}

// Walks from cell to cell, from `start` to the first s at which the way is on or below the surface (`side` = 1), or on or above it
// (`side` = −1): for fields without a pyramid, and for ways that begin below. By `slack` below, in height, it is on it still.
fn relievo_path_walk(
    field: RelievoHeightField, path: RelievoPath, start: f32, end: f32, side: f32, slack: f32,
) -> RelievoCellWalk {
    var turned = path;
    turned.midlevel *= side;
    turned.offset *= side;
    let grid = path.grid;
    var s = start;
    var entry = relievo_path_position(path, s);
    var cell = vec2i(floor(entry));
    for (var cells = 1u; cells <= RELIEVO_MAX_CELLS; cells++) {
        let t = relievo_path_crossings(path, cell + grid.border_offset);
        let along_v = t.y < t.x;
        let t_exit = min(max(min(t.x, t.y), s), end);
        let h = relievo_height_corners(field, grid.first + cell) * side;
        if cells == 1u && side < 0.0 {
            let at = clamp(entry - vec2f(cell), vec2f(0.0), vec2f(1.0));
            let patch_height = mix(mix(h[0], h[1], at.x), mix(h[2], h[3], at.x), at.y);
            if relievo_path_height(turned, s) - patch_height <= slack {
                return RelievoCellWalk(s, true, 1u, 1u, true);
            }
        }
        var x = relievo_path_patch(turned, h, cell, entry, s, t_exit);
        if x < RELIEVO_HUGE {
            if RELIEVO_NEAREST && x == 0.0 && relievo_path_height(turned, s) < h[0] {
                // The wall of a column: a hair beyond its border, so that uv shows the column.
                x = min(min(RELIEVO_BESIDE_WALL / max(length(grid.d), 1e-30), RELIEVO_MOST_DEEPER), t_exit - s);
            }
            return RelievoCellWalk(s + x, true, cells, cells, true);
        }
        if t_exit >= end {
            return RelievoCellWalk(end, false, cells, cells, true);
        }
        s = t_exit;
        entry = relievo_path_position(path, s);
        // It crosses this border exactly; rounding must not put it beside.
        let edge = vec2f(cell + grid.border_offset);
        entry = select(vec2f(edge.x, entry.y), vec2f(entry.x, edge.y), along_v);
        cell += select(vec2i(grid.step.x, 0), vec2i(0, grid.step.y), along_v);
    }
    return RelievoCellWalk(s, false, RELIEVO_MAX_CELLS, RELIEVO_MAX_CELLS, false);
}
