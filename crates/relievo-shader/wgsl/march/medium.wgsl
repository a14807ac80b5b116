//! The relief as a medium that fills it from its surface down: its density integrated along a line, over all stretches below the
//! surface. The same steps as relievo-march/src/medium.
//!
//! Gives RelievoMedium, RelievoScatterPlan, relievo_optical_depth, relievo_transmittance, relievo_find_scatter_distances,
//! relievo_scatter_distance, relievo_henyey_greenstein.
//! Needs what descent.wgsl needs.
//! #import descent

// One part in nine million of the light is left there.
const RELIEVO_MAX_OPTICAL_DEPTH: f32 = 16.0;
const RELIEVO_MAX_SCATTER_POINTS: u32 = 64u;

struct RelievoMedium {
    // Extinction per unit of s, where it is full.
    density: f32,
    // Depth below the surface over which the density grows from 0.
    softness: f32,
}

// A line's depth below the patch of a cell: x + y·s + z·s², and where the density changes its law.
struct RelievoCellLayer {
    depth: vec3f,
    softness: f32,
    // In order; those there are none of lie at the length.
    cuts: vec4f,
    length: f32,
}

// Where light was scattered that comes along a line: at `count` points, `offset` in [0, 1) moves them; `scattered` is the share
// of the light that is. No points: the optical depth alone is asked.
struct RelievoScatterPlan {
    count: u32,
    offset: f32,
    scattered: f32,
}

// An integral in progress, and the next point to be found.
struct RelievoMediumWalk {
    value: f32,
    found: u32,
}

// What relievo_find_scatter_distances has found.
var<private> relievo_scatter_distance: array<f32, RELIEVO_MAX_SCATTER_POINTS>;

fn relievo_layer_depth(depth: vec3f, s: f32) -> f32 {
    return depth.x + (depth.y + depth.z * s) * s;
}

// Where the depth is this one between 0 and the length; the length where it is not.
fn relievo_layer_cuts(depth: vec3f, level: f32, length: f32) -> vec2f {
    let c0 = depth.x - level;
    let discriminant = depth.y * depth.y - 4.0 * depth.z * c0;
    var cuts = vec2f(length);
    if discriminant < 0.0 {
        return cuts;
    }
    // The stable form: no cancellation. WGSL leaves division by 0 open.
    let q = -0.5 * (depth.y + select(-1.0, 1.0, depth.y >= 0.0) * sqrt(discriminant));
    if depth.z != 0.0 {
        let s = q / depth.z;
        cuts.x = select(length, s, s > 0.0 && s < length);
    }
    if q != 0.0 {
        let s = c0 / q;
        cuts.y = select(length, s, s > 0.0 && s < length);
    }
    return cuts;
}

// The layer over a cell with corners h00, h10, h01, h11, which the line enters at `at` in [0, 1]².
fn relievo_cell_layer(
    h: vec4f, at: vec2f, d: vec2f, line: RelievoHeightLine, s: f32, length: f32, softness: f32,
) -> RelievoCellLayer {
    let beta = h[1] - h[0];
    let gamma = h[2] - h[0];
    let kappa = h[0] - h[1] - h[2] + h[3];
    let depth = vec3f(
        (h[0] + beta * at.x + gamma * at.y + kappa * at.x * at.y) - (line.height + line.dheight_ds * s),
        (beta * d.x + gamma * d.y + kappa * (at.x * d.y + at.y * d.x)) - line.dheight_ds,
        kappa * d.x * d.y);
    let last = relievo_layer_depth(depth, length);
    var lowest = min(depth.x, last);
    var highest = max(depth.x, last);
    if depth.z != 0.0 {
        let vertex = -0.5 * depth.y / depth.z;
        if vertex > 0.0 && vertex < length {
            let extremum = relievo_layer_depth(depth, vertex);
            lowest = min(lowest, extremum);
            highest = max(highest, extremum);
        }
    }
    // A cell that is wholly above, below or within the soft layer has no cuts.
    var cuts = vec4f(length);
    if lowest < 0.0 && 0.0 < highest {
        let both = relievo_layer_cuts(depth, 0.0, length);
        cuts = vec4f(min(both.x, both.y), max(both.x, both.y), cuts.zw);
    }
    if lowest < softness && softness < highest {
        let both = relievo_layer_cuts(depth, softness, length);
        cuts = vec4f(cuts.xy, min(both.x, both.y), max(both.x, both.y));
    }
    // Both pairs are in order: merged.
    let low = min(cuts.xy, cuts.zw);
    let high = max(cuts.xy, cuts.zw);
    return RelievoCellLayer(
        depth, softness, vec4f(low.x, min(low.y, high.x), max(low.y, high.x), high.y), length);
}

fn relievo_layer_density(layer: RelievoCellLayer, s: f32) -> f32 {
    return clamp(relievo_layer_depth(layer.depth, s) / max(layer.softness, 1e-30), 0.0, 1.0);
}

// The integral of the density from a to b, between which it follows one law.
fn relievo_layer_piece(layer: RelievoCellLayer, a: f32, b: f32) -> f32 {
    let middle = relievo_layer_depth(layer.depth, (a + b) * 0.5);
    if middle <= 0.0 || !(a < b) {
        return 0.0;
    }
    if middle >= layer.softness {
        return b - a;
    }
    // Simpson's rule is exact for a parabola.
    return (b - a) * (relievo_layer_density(layer, a) + 4.0 * (middle / layer.softness) + relievo_layer_density(layer, b)) / 6.0;
}

// The end of a piece of a layer, 0 to 4.
fn relievo_layer_end(layer: RelievoCellLayer, piece: u32) -> f32 {
    var cuts = layer.cuts;
    return select(cuts[min(piece, 3u)], layer.length, piece == 4u);
}

fn relievo_layer_integral(layer: RelievoCellLayer) -> f32 {
    var sum = 0.0;
    var a = 0.0;
    for (var piece = 0u; piece < 5u; piece++) {
        let b = relievo_layer_end(layer, piece);
        sum += relievo_layer_piece(layer, a, b);
        a = b;
    }
    return sum;
}

// The distance at which the integral from the entry on is this one: within a soft layer by four Newton steps.
fn relievo_layer_distance(layer: RelievoCellLayer, integral: f32) -> f32 {
    var rest = integral;
    var a = 0.0;
    for (var piece = 0u; piece < 5u; piece++) {
        let b = relievo_layer_end(layer, piece);
        let whole = relievo_layer_piece(layer, a, b);
        if whole < rest || whole <= 0.0 {
            rest -= whole;
            a = b;
            continue;
        }
        var s = a + (b - a) * (rest / whole);
        for (var step = 0u; step < 4u; step++) {
            let density = clamp(relievo_layer_depth(layer.depth, s) / max(layer.softness, 1e-30), 1e-3, 1.0);
            s = clamp(s + (rest - relievo_layer_piece(layer, a, s)) / density, a, b);
        }
        return s;
    }
    return layer.length;
}

// The optical depth at which point i of a plan lies.
fn relievo_scatter_target(plan: RelievoScatterPlan, i: u32) -> f32 {
    return -log(1.0 - plan.scattered * ((f32(i) + plan.offset) / f32(plan.count)));
}

// The integral after one more cell.
fn relievo_medium_cell(
    walk: RelievoMediumWalk, layer: RelievoCellLayer, s: f32, medium: RelievoMedium, plan: RelievoScatterPlan,
) -> RelievoMediumWalk {
    let until = walk.value + medium.density * relievo_layer_integral(layer);
    var found = walk.found;
    while found < plan.count {
        let wanted = relievo_scatter_target(plan, found);
        if wanted > until {
            break;
        }
        relievo_scatter_distance[found] = s + relievo_layer_distance(layer, (wanted - walk.value) / medium.density);
        found++;
    }
    return RelievoMediumWalk(until, found);
}

fn relievo_medium_is_done(walk: RelievoMediumWalk, plan: RelievoScatterPlan) -> bool {
    return walk.value >= RELIEVO_MAX_OPTICAL_DEPTH || (plan.count > 0u && walk.found >= plan.count);
}

// Cell by cell.
fn relievo_medium_walk(
    field: RelievoHeightField, line: RelievoHeightLine, end: f32, medium: RelievoMedium, plan: RelievoScatterPlan,
) -> RelievoMediumWalk {
    let grid = relievo_grid_line(field, line);
    var walk = RelievoMediumWalk(0.0, 0u);
    var s = 0.0;
    var entry = grid.local;
    var cell = vec2i(floor(entry));
    for (var cells = 1u; cells <= RELIEVO_MAX_CELLS; cells++) {
        let t_max = relievo_grid_borders(grid, cell);
        let along_v = t_max.y < t_max.x;
        let t_exit = min(max(select(t_max.x, t_max.y, along_v), s), end);
        let h = relievo_height_corners(field, grid.first + cell);
        let lowest = line.height + line.dheight_ds * select(s, t_exit, line.dheight_ds < 0.0);
        if lowest <= max(max(h[0], h[1]), max(h[2], h[3])) {
            let at = clamp(entry - vec2f(cell), vec2f(0.0), vec2f(1.0));
            let layer = relievo_cell_layer(h, at, grid.d, line, s, t_exit - s, medium.softness);
            walk = relievo_medium_cell(walk, layer, s, medium, plan);
        }
        if t_exit >= end || relievo_medium_is_done(walk, plan) {
            break;
        }
        s = t_exit;
        entry = grid.local + grid.d * s;
        // The line crosses this border exactly; rounding must not put it beside.
        if along_v {
            entry.y = f32(cell.y + grid.border_offset.y);
            cell.y += grid.step.y;
        } else {
            entry.x = f32(cell.x + grid.border_offset.x);
            cell.x += grid.step.x;
        }
    }
    return walk;
}

// Through the pyramid, as relievo_descend: but for cells in blocks that the line passes above.
fn relievo_medium_descend(
    field: RelievoHeightField, line: RelievoHeightLine, end: f32, medium: RelievoMedium, plan: RelievoScatterPlan,
) -> RelievoMediumWalk {
    let grid = relievo_grid_line(field, line);
    let header = textureLoad(relievo_pyramid, vec2i(field.level, 0), 0);
    let path = relievo_path_of_line(field, line, relievo_path_code(header));
    var walk = RelievoMediumWalk(0.0, 0u);
    var s = 0.0;
    var came = relievo_path_at(path, 0.0);
    var entry = came.position;
    var at = relievo_grid_cell(grid, vec2i(floor(entry)), field.size);
    var level = relievo_first_level(field, path, 0.0, header);
    var row = relievo_level_row(field.size, header, level);
    var here = relievo_node_texel(at, field.size) >> vec2u(2u * level);
    var node = vec4u(0u);
    var fresh = true;
    var parent = vec4u(0u);
    var has_parent = false;
    for (var iterations = 0u; iterations < RELIEVO_MAX_ITERATIONS; iterations++) {
        if fresh {
            node = relievo_load_node(row, here);
            fresh = false;
        }
        let bit_shift = 2u * (level - 1u);
        let highest = relievo_block_code(node, at, bit_shift, field.size);
        let exit = relievo_block_exit(path, at, bit_shift, field.size);
        let t_exit = min(max(exit.s, s), end);
        let out = relievo_path_at(path, t_exit);
        if relievo_path_lowest(path, came, out, t_exit - s) <= f32(highest) {
            if level > 1u {
                level -= 1u;
                row -= relievo_node_rows(field.size, level);
                here = relievo_node_texel(at, field.size) >> vec2u(2u * level);
                parent = node;
                has_parent = true;
                fresh = true;
                continue;
            }
            let h = relievo_cell_corners(field, at);
            let lowest = line.height + line.dheight_ds * select(s, t_exit, line.dheight_ds < 0.0);
            if lowest <= max(max(h[0], h[1]), max(h[2], h[3])) {
                let inside = clamp(entry - vec2f(at.cell), vec2f(0.0), vec2f(1.0));
                let layer = relievo_cell_layer(h, inside, grid.d, line, s, t_exit - s, medium.softness);
                walk = relievo_medium_cell(walk, layer, s, medium, plan);
            }
        }
        if t_exit >= end || relievo_medium_is_done(walk, plan) {
            break;
        }
        s = t_exit;
        came = out;
        at = relievo_cell_beyond(path, at, exit, out.position, field.size);
        entry = relievo_cell_entry(grid, at.cell, out.position, exit.along_v);
        let before = here;
        here = relievo_node_texel(at, field.size) >> vec2u(2u * level);
        if all(here == before) {
            continue;
        }
        let same_parent = all((before >> vec2u(2u)) == (here >> vec2u(2u)));
        fresh = !(has_parent && same_parent);
        node = select(node, parent, !fresh);
        has_parent = false;
        if (!fresh || !same_parent) && level < (header.x >> 24u) {
            row += relievo_node_rows(field.size, level);
            level += 1u;
            here = here >> vec2u(2u);
        }
    }
    return walk;
}

fn relievo_medium_integral(
    field: RelievoHeightField, line: RelievoHeightLine, end: f32, medium: RelievoMedium, plan: RelievoScatterPlan,
) -> f32 {
    let reach = (abs(line.uv) + abs(line.slope) * end) * vec2f(field.size);
    // Written so that numbers that are none have no optical depth.
    if !(end > 0.0 && reach.x < 1073741824.0 && reach.y < 1073741824.0 && medium.density > 0.0) {
        return 0.0;
    }
    if RELIEVO_WITHOUT_PYRAMID || (RELIEVO_FIELD_STRETCHES && relievo_is_stretched(field)) {
        return relievo_medium_walk(field, line, end, medium, plan).value;
    }
    return relievo_medium_descend(field, line, end, medium, plan).value;
}

// The integral of the extinction along a line from 0 to `end`; the most is RELIEVO_MAX_OPTICAL_DEPTH.
fn relievo_optical_depth(field: RelievoHeightField, line: RelievoHeightLine, end: f32, medium: RelievoMedium) -> f32 {
    return min(
        relievo_medium_integral(field, line, end, medium, RelievoScatterPlan(0u, 0.0, 0.0)), RELIEVO_MAX_OPTICAL_DEPTH);
}

// The share of the light that is neither absorbed nor scattered (Beer-Lambert).
fn relievo_transmittance(optical_depth: f32) -> f32 {
    return select(exp(-optical_depth), 0.0, optical_depth >= RELIEVO_MAX_OPTICAL_DEPTH);
}

// Finds where light that comes along a line was scattered, into relievo_scatter_distance: the points at which equal shares of
// all that is scattered have been.
fn relievo_find_scatter_distances(
    field: RelievoHeightField, line: RelievoHeightLine, end: f32, medium: RelievoMedium, plan: RelievoScatterPlan,
) {
    for (var i = 0u; i < min(plan.count, RELIEVO_MAX_SCATTER_POINTS); i++) {
        relievo_scatter_distance[i] = end;
    }
    relievo_medium_integral(field, line, end, medium, plan);
}

// The share of scattered light per steradian at a cosine from its way before (Henyey and Greenstein 1941).
fn relievo_henyey_greenstein(cos: f32, g: f32) -> f32 {
    let g2 = g * g;
    let base = max(1.0 + g2 - 2.0 * g * cos, 1e-6);
    return (1.0 - g2) / (12.566371 * base * sqrt(base));
}
