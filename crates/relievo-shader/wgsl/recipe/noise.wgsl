//! One octave of noise that repeats exactly and changes in the course of a loop: `noise/` of relievo-make, step by step.
//!
//! Gives RelievoOctave, RELIEVO_PERLIN and the other bases, relievo_octave_at.
//! Needs nothing.

// A noise at a moment: `OctaveEntry` of relievo-make.
struct RelievoOctave {
    // Along u and v.
    cells: vec2u,
    // Of the slices before and after.
    seeds: vec2u,
    // Time since the slice before, in slices.
    offset: f32,
    // Weight of the slice after.
    weight: f32,
    mean: f32,
    // Fraction that the texels can show.
    shown: f32,
}

const RELIEVO_PERLIN: u32 = 0u;
const RELIEVO_VALUE: u32 = 1u;
const RELIEVO_WORLEY_NEAREST: u32 = 2u;
const RELIEVO_WORLEY_SECOND: u32 = 3u;
const RELIEVO_WORLEY_EDGE: u32 = 4u;

const RELIEVO_NOISE_GAIN: f32 = 1.75;
const RELIEVO_NOISE_TIME_SLOPE: f32 = 0.84;

// Random words of a cell (pcg3d: Jarzynski and Olano, JCGT 9(3), 2020).
fn relievo_hash_words(cell: vec2u, seed: u32) -> vec3u {
    var v = vec3u(cell, seed) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> vec3u(16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// Numbers in [0, 1) of a cell.
fn relievo_cell_units(cell: vec2u, seed: u32) -> vec3f {
    return vec3f(relievo_hash_words(cell, seed) >> vec3u(8u)) / 16777216.0;
}

fn relievo_fade(t: f32) -> f32 {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

fn relievo_wrap_cell(i: vec2i, cells: vec2u) -> vec2u {
    let n = vec2i(cells);
    let rest = i - (i / n) * n;
    return vec2u(select(rest, rest + n, rest < vec2i(0)));
}

// The line `x·fx + y` that a column of a slice contributes; `since` the slice.
fn relievo_column_plane(column: u32, rows: vec2u, fy: f32, seed: u32, since: f32) -> vec2f {
    let top = 2.0 * relievo_cell_units(vec2u(column, rows.x), seed) - 1.0;
    let bottom = 2.0 * relievo_cell_units(vec2u(column, rows.y), seed) - 1.0;
    let t = relievo_fade(fy);
    let a = top.y * fy + top.z * (RELIEVO_NOISE_TIME_SLOPE * since);
    let b = bottom.y * (fy - 1.0) + bottom.z * (RELIEVO_NOISE_TIME_SLOPE * since);
    return vec2f(top.x + (bottom.x - top.x) * t, a + (b - a) * t);
}

fn relievo_moving_plane(octave: RelievoOctave, column: u32, rows: vec2u, fy: f32) -> vec2f {
    let before = relievo_column_plane(column, rows, fy, octave.seeds.x, octave.offset);
    // Noise that stands still has no slice after; the same everywhere, so that no hash is made in vain.
    if octave.offset == 0.0 {
        return before;
    }
    let after = relievo_column_plane(column, rows, fy, octave.seeds.y, octave.offset - 1.0);
    return before + (after - before) * octave.weight;
}

fn relievo_perlin(octave: RelievoOctave, at: vec2f) -> f32 {
    let cell = vec2i(floor(at));
    let f = at - vec2f(cell);
    let low = relievo_wrap_cell(cell, octave.cells);
    let high = relievo_wrap_cell(cell + 1, octave.cells);
    let rows = vec2u(low.y, high.y);
    let left = relievo_moving_plane(octave, low.x, rows, f.y);
    let right = relievo_moving_plane(octave, high.x, rows, f.y);
    let a = left.x * f.x + left.y;
    let b = right.x * (f.x - 1.0) + right.y;
    return RELIEVO_NOISE_GAIN * (a + (b - a) * relievo_fade(f.x));
}

// Two random numbers of a cell at the moment.
fn relievo_moving_units(octave: RelievoOctave, cell: vec2u) -> vec2f {
    let before = relievo_cell_units(cell, octave.seeds.x).xy;
    if octave.offset == 0.0 {
        return before;
    }
    return before + (relievo_cell_units(cell, octave.seeds.y).xy - before) * octave.weight;
}

fn relievo_value_noise(octave: RelievoOctave, at: vec2f) -> f32 {
    let cell = vec2i(floor(at));
    let f = at - vec2f(cell);
    let low = relievo_wrap_cell(cell, octave.cells);
    let high = relievo_wrap_cell(cell + 1, octave.cells);
    let a = 2.0 * relievo_moving_units(octave, low).x - 1.0;
    let b = 2.0 * relievo_moving_units(octave, vec2u(high.x, low.y)).x - 1.0;
    let c = 2.0 * relievo_moving_units(octave, vec2u(low.x, high.y)).x - 1.0;
    let d = 2.0 * relievo_moving_units(octave, high).x - 1.0;
    let x = relievo_fade(f.x);
    let above = a + (b - a) * x;
    return above + ((c + (d - c) * x) - above) * relievo_fade(f.y);
}

// Distances to the nearest and the second nearest point, in cells.
fn relievo_worley(octave: RelievoOctave, at: vec2f) -> vec2f {
    let cell = vec2i(floor(at));
    let f = at - vec2f(cell);
    var nearest = vec2f(1e30);
    for (var ring = 0; ring <= 3; ring++) {
        if ring >= 2 && nearest.y <= f32((ring - 1) * (ring - 1)) {
            break;
        }
        for (var dj = -ring; dj <= ring; dj++) {
            let step = select(max(2 * ring, 1), 1, abs(dj) == ring);
            for (var di = -ring; di <= ring; di += step) {
                let point = relievo_moving_units(octave, relievo_wrap_cell(cell + vec2i(di, dj), octave.cells));
                let away = vec2f(f32(di), f32(dj)) + point - f;
                let d = dot(away, away);
                if d < nearest.x {
                    nearest = vec2f(d, nearest.x);
                } else if d < nearest.y {
                    nearest.y = d;
                }
            }
        }
    }
    return sqrt(nearest);
}

// The noise at texture coordinates, which repeat.
fn relievo_octave_at(octave: RelievoOctave, basis: u32, uv: vec2f) -> f32 {
    let at = (uv - floor(uv)) * vec2f(octave.cells);
    switch basis {
        case RELIEVO_PERLIN: { return relievo_perlin(octave, at); }
        case RELIEVO_VALUE: { return relievo_value_noise(octave, at); }
        default: {}
    }
    let distances = relievo_worley(octave, at);
    switch basis {
        case RELIEVO_WORLEY_NEAREST: { return distances.x; }
        case RELIEVO_WORLEY_SECOND: { return distances.y; }
        default: { return distances.y - distances.x; }
    }
}
