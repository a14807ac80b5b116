//! The march through cones: the cells of walk.wgsl, but for those that a cone says the ray passes above. The same steps as
//! relievo-march/src/cone.rs, so that hits and costs agree.
//!
//! Gives cone_crossing.
//! Needs what height.wgsl needs, and two globals of HeightTexture: `relief_cones: texture_2d<u32>`, whose level is that of the
//! heights, with the codes of top and slope of each cell's cone in red and green, and `relief_pyramid: texture_2d<u32>`,
//! whose header says what codes of height mean (see descent.wgsl).
//! #import record
//! #import height
//! #import walk

// Codes are heights up to rounding, and rays too.
const CONE_SLACK: f32 = 0.00390625;
// How much wider than it is the gap of a texel is taken to be, from which a cone's side rises.
const CONE_RIM: f32 = 1.015625;

// A line over the cells, which are counted from the one it starts in.
struct ConeView {
    first: vec2i,
    local: vec2f,
    d: vec2f,
    step: vec2i,
    ahead: vec2i,
    pace: vec2f,
    across: vec2<bool>,
}

fn cone_view(field: Field, line: Line) -> ConeView {
    let size = vec2f(field.size);
    let origin = line.uv * size - 0.5;
    let base = floor(origin);
    let d = line.slope * size;
    let across = d == vec2f(0.0);
    let forward = d > vec2f(0.0);
    let step = select(vec2i(-1), vec2i(1), forward);
    let ahead = select(vec2i(0), vec2i(1), forward);
    return ConeView(vec2i(base), origin - base, d, step, ahead, 1.0 / select(d, vec2f(1.0), across), across);
}

// Where the line leaves column and row `cell` for the next ones.
fn cone_borders(view: ConeView, cell: vec2i) -> vec2f {
    return select((vec2f(cell + view.ahead) - view.local) * view.pace, vec2f(HUGE), view.across);
}

// How many borders the line crosses from column and row `cell` up to s.
fn cone_crossed(view: ConeView, cell: vec2i, s: f32) -> vec2i {
    let position = view.local + view.d * s;
    let progress = select(vec2f(cell + 1) - position, position - vec2f(cell), view.step > vec2i(0));
    let cells = vec2i(max(progress, vec2f(0.0)));
    // Rounding may put the position beside its cell; what counts is the borders.
    let border = cone_borders(view, cell + view.step * cells);
    let before = cone_borders(view, cell + view.step * (cells - 1));
    let more = select(vec2i(0), vec2i(1), border <= vec2f(s));
    let less = select(vec2i(0), vec2i(1), (border > vec2f(s)) & (cells > vec2i(0)) & (before > vec2f(s)));
    return cells + more - less;
}

// The s up to which the relaxed cone of a cell says something: a tile away, or the border beyond which what lies behind is
// another map's neighbourhood.
fn cone_reach(view: ConeView, field: Field, cell: vec2i) -> f32 {
    let cells = vec2i(
        height_reach(view.first.x + cell.x, view.step.x, field.size.x),
        height_reach(view.first.y + cell.y, view.step.y, field.size.y),
    );
    let ends = cone_borders(view, cell + view.step * (cells - 1));
    let known = select(ends, vec2f(HUGE), cells >= vec2i(1 << 30u));
    return min(known.x, known.y);
}

// The codes of the cone of a cell, any of the endless rows and columns.
fn cone_at(field: Field, cell: vec2i) -> vec2u {
    let index = vec2i(height_place(cell.x, field.size.x).x, height_place(cell.y, field.size.y).x);
    return textureLoad(relief_cones, clamp(index, vec2i(0), field.size - 1), field.level).rg;
}

// A slope's code is a small float: 4 bits of exponent before 4 of mantissa.
fn cone_slope(code: u32) -> f32 {
    return select(bitcast<f32>((120u << 23u) + (code << 19u)), 0.0, code == 0u);
}

// The first s in [start, end] at which a line that sinks by 1 per unit of s is on or below the surface.
fn cone_crossing(field: Field, line: Line, start: f32, end: f32, how: March) -> Walk {
    // A stretched border is not the map's; and a map without cones has one that is not of its size.
    if (FIELD_STRETCHES && field.stretch.x > 0) || any(textureDimensions(relief_cones) != textureDimensions(relief_heights)) {
        return walk_to_crossing(field, line, start, end, MAX_CELLS);
    }
    let relaxed = how.cones == CONES_RELAXED;
    let steps = max(layer_limit(min(max(how.max_layers, 1.0), MAX_LAYERS)) - 1u, 1u);
    let most = select(MAX_CELLS, steps, relaxed);
    let view = cone_view(field, line);
    let speed = sqrt(view.d.x * view.d.x + view.d.y * view.d.y);
    let header = textureLoad(relief_pyramid, vec2i(field.level, 0), 0);
    let low = bitcast<f32>(header.y);
    let code_step = bitcast<f32>(header.z);
    let slack = CONE_SLACK * code_step + 4.0 * 1.1920929e-7;

    var s = start;
    var entry = view.local + view.d * s;
    var cell = vec2i(floor(entry));
    var next = cone_borders(view, cell);
    // Where the line came into its column and row; those that it started in have no such place.
    var entered = vec2f(-HUGE);
    // Where the step began that ended here, and the cell it began in.
    var stepped = false;
    var begin = start;
    var begin_cell = cell;
    var fetches = 0u;
    for (var turns = 1u; turns <= most; turns++) {
        fetches += 1u;
        let cone = cone_at(field, view.first + cell);
        let along_v = next.y < next.x;
        let leave = min(max(select(next.x, next.y, along_v), s), end);
        let lowest = line.height - leave;
        let above = lowest - (low + f32(cone.x) * code_step) - slack;
        if above <= 0.0 {
            fetches += 1u;
            let h = height_corners(field, view.first + cell);
            if lowest <= max(max(h[0], h[1]), max(h[2], h[3])) {
                let at = clamp(entry - vec2f(cell), vec2f(0.0), vec2f(1.0));
                let x = patch_crossing(h, at, view.d, line, s, leave - s);
                if x < HUGE {
                    if x <= 0.0 && stepped {
                        let found = cone_bisection(field, view, line, begin, begin_cell, s, cell, how.refine_steps);
                        return Walk(found.s, true, fetches + found.fetches, turns + found.turns, true);
                    }
                    return Walk(s + x, true, fetches, turns, true);
                }
            }
        }
        if leave >= end {
            return Walk(end, false, fetches, turns, true);
        }
        // From the border on, as far as the cone allows.
        let slope = cone_slope(cone.y) * code_step;
        var target_s = leave + (above - CONE_RIM * slope) / (1.0 + speed * slope);
        if relaxed {
            target_s = min(target_s, cone_reach(view, field, cell));
        }
        target_s = min(target_s, end);

        if along_v {
            entered.y = next.y;
            cell.y += view.step.y;
        } else {
            entered.x = next.x;
            cell.x += view.step.x;
        }
        stepped = false;
        if target_s > leave {
            if !relaxed && target_s >= end {
                return Walk(end, false, fetches, turns, true);
            }
            stepped = relaxed;
            begin = leave;
            begin_cell = cell;
            let cells = cone_crossed(view, cell, target_s);
            cell += view.step * cells;
            entered = select(entered, cone_borders(view, cell - view.step), cells > vec2i(0));
        }
        next = cone_borders(view, cell);
        if stepped {
            s = target_s;
            entry = view.local + view.d * s;
        } else {
            // The plain walk crosses columns first where it crosses both, and comes in by the border it crossed last.
            let last_v = entered.y >= entered.x;
            s = max(select(entered.x, entered.y, last_v), start);
            entry = view.local + view.d * s;
            let exact = vec2f(cell - view.step + view.ahead);
            entry = select(vec2f(exact.x, entry.y), vec2f(entry.x, exact.y), last_v);
        }
    }
    return Walk(s, false, fetches, most, false);
}

// Where the line meets the surface between a place above it and one below, both with their cells: halves the way until both
// are in one cell, whose patch tells the place, at most `steps` times.
fn cone_bisection(
    field: Field,
    view: ConeView,
    line: Line,
    start: f32,
    start_cell: vec2i,
    end: f32,
    end_cell: vec2i,
    steps: u32,
) -> Walk {
    var above = start;
    var cell_above = start_cell;
    var below = end;
    var cell_below = end_cell;
    let most = min(steps, MAX_REFINE_STEPS);
    var samples = 0u;
    while any(cell_above != cell_below) {
        if samples >= most {
            return Walk(0.5 * (above + below), true, samples, samples, true);
        }
        samples += 1u;
        let middle = 0.5 * (above + below);
        let position = view.local + view.d * middle;
        let cell = vec2i(floor(position));
        let h = height_corners(field, view.first + cell);
        let at = clamp(position - vec2f(cell), vec2f(0.0), vec2f(1.0));
        let surface = h[0] + (h[1] - h[0]) * at.x + (h[2] - h[0]) * at.y + (h[0] - h[1] - h[2] + h[3]) * at.x * at.y;
        if line.height - middle <= surface {
            below = middle;
            cell_below = cell;
        } else {
            above = middle;
            cell_above = cell;
        }
    }
    // Loaded already: the place below is in the cell that was looked at last.
    let h = height_corners(field, view.first + cell_below);
    let at = clamp(view.local + view.d * above - vec2f(cell_below), vec2f(0.0), vec2f(1.0));
    let x = patch_crossing(h, at, view.d, line, above, below - above);
    return Walk(select(below, above + x, x < HUGE), true, samples, samples, true);
}
