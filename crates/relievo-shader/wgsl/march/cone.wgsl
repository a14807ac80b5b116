//! The march through cones: the cells of walk.wgsl, but for those that a cone says the ray passes above. The same steps as
//! relievo-march/src/cone.rs, so that hits and costs agree.
//!
//! Gives relievo_cone_crossing.
//! Needs what height.wgsl needs, and two globals of HeightTexture: `relievo_cones: texture_2d<u32>`, whose level is that of the
//! heights, with the codes of top and slope of each cell's cone in red and green, and `relievo_pyramid: texture_2d<u32>`,
//! whose header says what codes of height mean (see descent.wgsl).
//! #import record
//! #import height
//! #import walk

// Codes are heights up to rounding, and rays too.
const RELIEVO_CONE_SLACK: f32 = 0.00390625;
// How much wider than it is the gap of a texel is taken to be, from which a cone's side rises.
const RELIEVO_CONE_RIM: f32 = 1.015625;

// How many borders the line crosses from column and row `cell` up to s.
fn relievo_borders_crossed(grid: RelievoGridLine, cell: vec2i, s: f32) -> vec2i {
    let position = grid.local + grid.d * s;
    let progress = select(vec2f(cell + 1) - position, position - vec2f(cell), grid.step > vec2i(0));
    let cells = vec2i(max(progress, vec2f(0.0)));
    // Rounding may put the position beside its cell; what counts is the borders.
    let t_at_border = relievo_grid_borders(grid, cell + grid.step * cells);
    let t_before = relievo_grid_borders(grid, cell + grid.step * (cells - 1));
    let more = select(vec2i(0), vec2i(1), t_at_border <= vec2f(s));
    let less = select(vec2i(0), vec2i(1), (t_at_border > vec2f(s)) & (cells > vec2i(0)) & (t_before > vec2f(s)));
    return cells + more - less;
}

// The s up to which the relaxed cone of a cell says something: a tile away, or the border beyond which what lies behind is
// another map's neighbourhood.
fn relievo_cone_reach(grid: RelievoGridLine, field: RelievoHeightField, cell: vec2i) -> f32 {
    let cells = vec2i(
        relievo_cells_in_reach(grid.first.x + cell.x, grid.step.x, field.size.x),
        relievo_cells_in_reach(grid.first.y + cell.y, grid.step.y, field.size.y),
    );
    let ends = relievo_grid_borders(grid, cell + grid.step * (cells - 1));
    let known = select(ends, vec2f(RELIEVO_HUGE), cells >= vec2i(1 << 30u));
    return min(known.x, known.y);
}

// The codes of the cone of a cell, any of the endless rows and columns.
fn relievo_cone_at(field: RelievoHeightField, cell: vec2i) -> vec2u {
    let index = vec2i(relievo_axis_cell(cell.x, field.size.x).x, relievo_axis_cell(cell.y, field.size.y).x);
    return textureLoad(relievo_cones, clamp(index, vec2i(0), field.size - 1), field.level).rg;
}

// A slope's code is a small float: 4 bits of exponent before 4 of mantissa.
fn relievo_cone_slope(code: u32) -> f32 {
    return select(bitcast<f32>((120u << 23u) + (code << 19u)), 0.0, code == 0u);
}

// The most cells that a march looks at.
fn relievo_cone_steps(options: RelievoMarchOptions) -> u32 {
    let layers = relievo_layer_limit(min(max(options.max_layers, 1.0), RELIEVO_MAX_LAYERS));
    return select(RELIEVO_MAX_CELLS, max(layers - 1u, 1u), options.cones == RELIEVO_CONES_RELAXED);
}

// Where the line, having come into its column and row at the s in `entered`, came into its cell. The plain walk crosses columns
// first where it crosses both, and comes in by the border it crossed last.
fn relievo_cone_entry(grid: RelievoGridLine, cell: vec2i, entered: vec2f, start: f32) -> RelievoConeEntry {
    let last_v = entered.y >= entered.x;
    let s = max(select(entered.x, entered.y, last_v), start);
    let point = grid.local + grid.d * s;
    let exact = vec2f(cell - grid.step + grid.border_offset);
    return RelievoConeEntry(s, select(vec2f(exact.x, point.y), vec2f(point.x, exact.y), last_v));
}

// A place on the line.
struct RelievoConeEntry {
    s: f32,
    point: vec2f,
}

// The first s in [start, end] at which a line that sinks by 1 per unit of s is on or below the surface.
fn relievo_cone_crossing(
    field: RelievoHeightField, line: RelievoHeightLine, start: f32, end: f32, options: RelievoMarchOptions,
) -> RelievoCellWalk {
    // A stretched border is not the map's; and a map without cones has one that is not of its size.
    if RELIEVO_NEAREST || (RELIEVO_FIELD_STRETCHES && relievo_is_stretched(field))
        || any(textureDimensions(relievo_cones) != textureDimensions(relievo_heights)) {
        return relievo_walk_to_crossing(field, line, start, end, RELIEVO_MAX_CELLS);
    }
    let relaxed = options.cones == RELIEVO_CONES_RELAXED;
    let most = relievo_cone_steps(options);
    let grid = relievo_grid_line(field, line);
    let speed = sqrt(grid.d.x * grid.d.x + grid.d.y * grid.d.y);
    let header = textureLoad(relievo_pyramid, vec2i(field.level, 0), 0);
    let code_step = bitcast<f32>(header.z);
    let slack = RELIEVO_CONE_SLACK * code_step + 4.0 * 1.1920929e-7;

    var at = RelievoConeEntry(start, grid.local + grid.d * start);
    var cell = vec2i(floor(at.point));
    var t_max = relievo_grid_borders(grid, cell);
    // Where the line came into its column and row; those that it started in have no such place.
    var entered = vec2f(-RELIEVO_HUGE);
    // Where the step began that ended here, and the cell it began in.
    var stepped = false;
    var begin = start;
    var begin_cell = cell;
    var fetches = 0u;
    for (var iterations = 1u; iterations <= most; iterations++) {
        fetches += 1u;
        let cone = relievo_cone_at(field, grid.first + cell);
        let along_v = t_max.y < t_max.x;
        let t_exit = min(max(select(t_max.x, t_max.y, along_v), at.s), end);
        let lowest = line.height - t_exit;
        let above = lowest - (bitcast<f32>(header.y) + f32(cone.x) * code_step) - slack;
        if above <= 0.0 {
            fetches += 1u;
            let x = relievo_cone_patch(field, grid, line, cell, at, t_exit);
            if x < RELIEVO_HUGE {
                if x <= 0.0 && stepped {
                    let found =
                        relievo_cone_bisection(field, grid, line, begin, begin_cell, at.s, cell, options.refine_steps);
                    return RelievoCellWalk(found.s, true, fetches + found.fetches, iterations + found.iterations, true);
                }
                return RelievoCellWalk(at.s + x, true, fetches, iterations, true);
            }
        }
        if t_exit >= end {
            return RelievoCellWalk(end, false, fetches, iterations, true);
        }
        // From the border on, as far as the cone allows.
        let slope = relievo_cone_slope(cone.y) * code_step;
        var target_s = t_exit + (above - RELIEVO_CONE_RIM * slope) / (1.0 + speed * slope);
        if relaxed {
            target_s = min(target_s, relievo_cone_reach(grid, field, cell));
        }
        target_s = min(target_s, end);

        entered = select(vec2f(t_max.x, entered.y), vec2f(entered.x, t_max.y), along_v);
        cell += select(vec2i(grid.step.x, 0), vec2i(0, grid.step.y), along_v);
        stepped = false;
        if target_s > t_exit {
            if !relaxed && target_s >= end {
                return RelievoCellWalk(end, false, fetches, iterations, true);
            }
            stepped = relaxed;
            begin = t_exit;
            begin_cell = cell;
            let cells = relievo_borders_crossed(grid, cell, target_s);
            cell += grid.step * cells;
            entered = select(entered, relievo_grid_borders(grid, cell - grid.step), cells > vec2i(0));
        }
        t_max = relievo_grid_borders(grid, cell);
        if stepped {
            at = RelievoConeEntry(target_s, grid.local + grid.d * target_s);
        } else {
            at = relievo_cone_entry(grid, cell, entered, start);
        }
    }
    return RelievoCellWalk(at.s, false, fetches, most, false);
}

// How far beyond its entry into a cell the line meets the cell's patch, HUGE if it does not until `t_exit`.
fn relievo_cone_patch(
    field: RelievoHeightField, grid: RelievoGridLine, line: RelievoHeightLine, cell: vec2i, entry: RelievoConeEntry,
    t_exit: f32,
) -> f32 {
    let h = relievo_height_corners(field, grid.first + cell);
    if !(line.height - t_exit <= max(max(h[0], h[1]), max(h[2], h[3]))) {
        return RELIEVO_HUGE;
    }
    let at = clamp(entry.point - vec2f(cell), vec2f(0.0), vec2f(1.0));
    return relievo_patch_crossing(h, at, grid.d, line, entry.s, t_exit - entry.s);
}

// Where the line meets the surface between a place above it and one below, both with their cells: halves the way until both
// are in one cell, whose patch tells the place, at most `steps` times.
fn relievo_cone_bisection(
    field: RelievoHeightField,
    grid: RelievoGridLine,
    line: RelievoHeightLine,
    start: f32,
    start_cell: vec2i,
    end: f32,
    end_cell: vec2i,
    steps: u32,
) -> RelievoCellWalk {
    var above = start;
    var cell_above = start_cell;
    var below = end;
    var cell_below = end_cell;
    let most = min(steps, RELIEVO_MAX_REFINE_STEPS);
    var samples = 0u;
    while any(cell_above != cell_below) {
        if samples >= most {
            return RelievoCellWalk(0.5 * (above + below), true, samples, samples, true);
        }
        samples += 1u;
        let middle = 0.5 * (above + below);
        let position = grid.local + grid.d * middle;
        let cell = vec2i(floor(position));
        let h = relievo_height_corners(field, grid.first + cell);
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
    let h = relievo_height_corners(field, grid.first + cell_below);
    let at = clamp(grid.local + grid.d * above - vec2f(cell_below), vec2f(0.0), vec2f(1.0));
    let x = relievo_patch_crossing(h, at, grid.d, line, above, below - above);
    return RelievoCellWalk(select(below, above + x, x < RELIEVO_HUGE), true, samples, samples, true);
}
