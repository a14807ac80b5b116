//! How much of a map a pixel covers, and what level of detail makes of it: as footprint.rs of the crate relievo-march has it.
//!
//! Gives RelievoFootprint, relievo_footprint_lod, RelievoProbes, relievo_footprint_probes, relievo_probe_uv,
//! relievo_footprint_march_lod, relievo_footprint_points, relievo_footprint_point, relievo_footprint_fade,
//! relievo_footprint_on_relief.
//! Needs nothing else.

const RELIEVO_MAX_PROBES: f32 = 16.0;
// The part by which a footprint may be longer than wide and still count as round: rounding must not choose the samples.
const RELIEVO_ROUND: f32 = 0.0625;
// Levels that maps are finer than the pixel: two filtered levels blur more than a pixel does.
const RELIEVO_PROBE_SHARPENING: f32 = 0.5;
// Levels that the march is finer than the pixel: the relief's contrast counts for more than its noise.
const RELIEVO_MARCH_SHARPENING: f32 = 1.5;
// The most points of a footprint that are asked for their shadow.
const RELIEVO_MAX_POINTS: f32 = 8.0;
// Pixels that a whole march spans on the picture where the relief has faded to its polygon, and where it is whole.
const RELIEVO_FLAT_BELOW: f32 = 0.5;
const RELIEVO_WHOLE_ABOVE: f32 = 1.5;

// How far a step of one pixel to the right and down goes on a surface, in texture repeats.
struct RelievoFootprint {
    dx: vec2f,
    dy: vec2f,
}

// Where and at which mip level a map is sampled so that the mean covers a footprint: along its longer axis, each sample as
// wide as the shorter (McCormack et al. 1999).
struct RelievoProbes {
    count: u32,
    lod: f32,
    // The longer axis from end to end, in texture repeats.
    axis: vec2f,
}

// The axes of the ellipse that a pixel covers, in texels of a map.
struct RelievoFootprintAxes {
    along: vec2f,
    longer: f32,
    shorter: f32,
}

// The mip level at which the longer gradient spans one texel.
fn relievo_footprint_lod(footprint: RelievoFootprint, size: vec2f) -> f32 {
    let longer = max(length(footprint.dx * size), length(footprint.dy * size));
    return log2(max(longer, 1.0));
}

fn relievo_footprint_axes(footprint: RelievoFootprint, size: vec2f) -> RelievoFootprintAxes {
    let dx = footprint.dx * size;
    let dy = footprint.dy * size;
    // Of J·Jᵀ, whose eigenvalues are the squared axes.
    let a = dx.x * dx.x + dy.x * dy.x;
    let b = dx.x * dx.y + dy.x * dy.y;
    let c = dx.y * dx.y + dy.y * dy.y;
    let half = 0.5 * (a - c);
    let longer2 = 0.5 * (a + c) + sqrt(half * half + b * b);
    let longer = sqrt(longer2);
    var axes = RelievoFootprintAxes(vec2f(longer, 0.0), longer, 0.0);
    if longer > 0.0 {
        axes.shorter = abs(dx.x * dy.y - dx.y * dy.x) / longer;
    }
    // Of the two expressions for the eigenvector the one that does not cancel.
    let v = select(vec2f(b, longer2 - a), vec2f(longer2 - c, b), half >= 0.0);
    let l = length(v);
    if l > 0.0 {
        axes.along = v * (longer / l);
    }
    return axes;
}

// How a map of this size is sampled.
fn relievo_footprint_probes(footprint: RelievoFootprint, size: vec2f) -> RelievoProbes {
    let axes = relievo_footprint_axes(footprint, size);
    let count = min(max(ceil(axes.longer / max(axes.shorter, 1.0) - RELIEVO_ROUND), 1.0), RELIEVO_MAX_PROBES);
    let lod = max(log2(max(max(axes.shorter, axes.longer / count), 1.0)) - RELIEVO_PROBE_SHARPENING, 0.0);
    return RelievoProbes(u32(count), lod, axes.along / size);
}

fn relievo_probe_uv(probes: RelievoProbes, uv: vec2f, i: u32) -> vec2f {
    return uv + probes.axis * ((f32(i) + 0.5) / f32(probes.count) - 0.5);
}

// The mip level whose relief is marched, of a height map of this size: a whole one.
fn relievo_footprint_march_lod(footprint: RelievoFootprint, size: vec2f) -> f32 {
    return max(
        floor(relievo_footprint_probes(footprint, size).lod + RELIEVO_PROBE_SHARPENING - RELIEVO_MARCH_SHARPENING + 0.5), 0.0);
}

// How many points of the footprint are asked for their shadow: one for each texel of its length.
fn relievo_footprint_points(footprint: RelievoFootprint, size: vec2f) -> u32 {
    return u32(min(max(ceil(relievo_footprint_axes(footprint, size).longer), 1.0), RELIEVO_MAX_POINTS));
}

// Point `i` of the footprint around `uv`: the first in the middle, all spread evenly (the R2 sequence, Roberts 2018).
fn relievo_footprint_point(footprint: RelievoFootprint, uv: vec2f, i: u32) -> vec2f {
    let at = fract(0.5 + vec2f(0.7548777, 0.5698403) * f32(i)) - 0.5;
    return uv + footprint.dx * at.x + footprint.dy * at.y;
}

// How much of its depth a relief keeps that is as deep as `slope` is long, in texture repeats: 1 = all, 0 where the whole march
// spans less than a pixel from any side and the relief is its polygon.
fn relievo_footprint_fade(footprint: RelievoFootprint, size: vec2f, slope: vec2f) -> f32 {
    let pixel = relievo_footprint_axes(footprint, size).shorter;
    let span = length(slope * size);
    if !(pixel > 0.0) || !(span < RELIEVO_WHOLE_ABOVE * pixel) {
        return 1.0;
    }
    let t = max((span / pixel - RELIEVO_FLAT_BELOW) / (RELIEVO_WHOLE_ABOVE - RELIEVO_FLAT_BELOW), 0.0);
    return t * t * (3.0 - 2.0 * t);
}

// The footprint on the relief itself, of which this much of the depth is left. Seen slantwise a polygon's footprint is long,
// but where the relief can be seen it is the sides facing the eye that are, and on them it is as long as it is wide.
fn relievo_footprint_on_relief(footprint: RelievoFootprint, size: vec2f, fade: f32) -> RelievoFootprint {
    let axes = relievo_footprint_axes(footprint, size);
    if !(axes.longer > 0.0) {
        return footprint;
    }
    let take = fade * (1.0 - axes.shorter / axes.longer) / (axes.longer * axes.longer);
    let dx = footprint.dx * size;
    let dy = footprint.dy * size;
    return RelievoFootprint(
        (dx - axes.along * (take * dot(dx, axes.along))) / size,
        (dy - axes.along * (take * dot(dy, axes.along))) / size,
    );
}
