//! The height map as a surface: bilinear between texel centres, continued for ever in both directions.
//!
//! Gives RelievoHeightField, relievo_height_field, relievo_height_stretched, relievo_is_stretched, relievo_height_sample,
//! relievo_height_corners.
//! Needs a global `relievo_heights: texture_2d<f32>`, height in its red channel, 1 = highest. Heights are read by
//! textureLoad and mixed here: no format need be filterable, and weights have all the bits of f32.
//! #import record
//! #import chosen_height

// The height map as a ray sees it.
struct RelievoHeightField {
    // The mip level whose cells are marched, and its texels along u and v.
    size: vec2i,
    level: i32,
    // Filtered samples mix the two levels around this one.
    lod: f32,
    // No texel of the level falls below x, none rises above y.
    range: vec2f,
    // The smallest difference in height that the map can tell: 1/255 for 8-bit maps, else 0.
    step: f32,
    // Lower and upper corner of the uv outside of which samples see the floor.
    fence: vec4f,
    // First texels and those behind the last, beyond which the border stretches (`edge = "clamp"`); 0: the map goes on for
    // ever, and so it must be where RELIEVO_FIELD_STRETCHES is false.
    stretch: vec4i,
}

// The field for a footprint that asks for mip level `lod` (0 = full size) of a texture whose last level is `last`. Set
// `range` where it is known, the exact march starts at the highest texel, and `step`, which its shadows rise above.
fn relievo_height_field(lod: f32, last: i32) -> RelievoHeightField {
    let bounded = min(max(lod, 0.0), f32(last));
    let level = i32(floor(bounded + 0.5));
    let size = vec2i(textureDimensions(relievo_heights, level));
    return RelievoHeightField(
        size, level, bounded, vec2f(0.0, 1.0), 0.0, vec4f(-RELIEVO_HUGE, -RELIEVO_HUGE, RELIEVO_HUGE, RELIEVO_HUGE), vec4i(0));
}

// The field of a chart with this texture range (lower and upper corner), with the border stretched beyond.
fn relievo_height_stretched(field: RelievoHeightField, range: vec4f) -> RelievoHeightField {
    var stretched = field;
    let texels = vec4i(floor(range * vec4f(vec2f(field.size), vec2f(field.size)) + 0.5));
    stretched.stretch = vec4i(texels.xy, max(texels.zw, texels.xy + 1));
    return stretched;
}

fn relievo_is_stretched(field: RelievoHeightField) -> bool {
    return field.stretch.z > field.stretch.x;
}

// A relief that rises above its polygon may be entered beside it, where there is none: samples there see the floor.
fn relievo_height_fenced(field: RelievoHeightField, entry: vec2f, options: RelievoMarchOptions) -> RelievoHeightField {
    var fenced = field;
    if options.bounded != 0u && relievo_lid_offset(options) > 0.0 && !relievo_in_bounds(options.bounds, entry) {
        fenced.fence = options.bounds;
    }
    return fenced;
}

// The heights at the corners of columns (or rows) x.xy and y.xy of a level.
fn relievo_height_load(size: vec2i, level: i32, x: vec2i, y: vec2i) -> vec4f {
    let column = vec2i(relievo_height_wrap(x[0], size.x), relievo_height_wrap(x[1], size.x));
    let row = vec2i(relievo_height_wrap(y[0], size.y), relievo_height_wrap(y[1], size.y));
    return vec4f(
        textureLoad(relievo_heights, vec2i(column[0], row[0]), level).r,
        textureLoad(relievo_heights, vec2i(column[1], row[0]), level).r,
        textureLoad(relievo_heights, vec2i(column[0], row[1]), level).r,
        textureLoad(relievo_heights, vec2i(column[1], row[1]), level).r,
    );
}

// h00, h10, h01, h11 of the cell between the centres of texels (i, j) and (i + 1, j + 1): one fetch of the exact march.
fn relievo_height_corners(field: RelievoHeightField, i: vec2i) -> vec4f {
    var x = vec2i(i.x, select(i.x + 1, i.x, RELIEVO_NEAREST));
    var y = vec2i(i.y, select(i.y + 1, i.y, RELIEVO_NEAREST));
    if relievo_is_stretched(field) {
        x = clamp(x, vec2i(field.stretch.x), vec2i(field.stretch.z - 1));
        y = clamp(y, vec2i(field.stretch.y), vec2i(field.stretch.w - 1));
    }
    return relievo_height_load(field.size, field.level, x, y);
}

fn relievo_height_bilinear(level: i32, uv: vec2f) -> f32 {
    let size = vec2i(textureDimensions(relievo_heights, level));
    let x = uv * vec2f(size) - 0.5;
    let i = vec2i(floor(x));
    let h = relievo_height_load(size, level, vec2i(i.x, i.x + 1), vec2i(i.y, i.y + 1));
    let t = x - floor(x);
    let top = h[0] + (h[1] - h[0]) * t.x;
    let bottom = h[2] + (h[3] - h[2]) * t.x;
    return top + (bottom - top) * t.y;
}

// The filtered height at a uv, in [0, 1].
fn relievo_height_sample(field: RelievoHeightField, asked: vec2f) -> f32 {
    if !relievo_in_bounds(field.fence, asked) {
        return 0.0;
    }
    var uv = asked;
    if relievo_is_stretched(field) {
        // Half a texel inside, where no neighbour tile mixes in.
        let size = vec2f(field.size);
        let start = vec2f(field.stretch.xy) / size;
        let end = vec2f(field.stretch.zw) / size;
        let inset = min(0.5 / size, 0.5 * (end - start));
        uv = min(max(asked, start + inset), end - inset);
    }
    if RELIEVO_NEAREST {
        return relievo_height_corners(field, vec2i(floor(uv * vec2f(field.size))))[0];
    }
    if field.lod > 0.0 {
        let level = i32(floor(field.lod));
        let value = relievo_height_bilinear(level, uv);
        let t = field.lod - f32(level);
        if t == 0.0 {
            return value;
        }
        return value + (relievo_height_bilinear(level + 1, uv) - value) * t;
    }
    let x = uv * vec2f(field.size) - 0.5;
    let i = vec2i(floor(x));
    let h = relievo_height_load(field.size, 0, vec2i(i.x, i.x + 1), vec2i(i.y, i.y + 1));
    let t = x - floor(x);
    return relievo_height_lerp(relievo_height_lerp(h[0], h[1], t.x), relievo_height_lerp(h[2], h[3], t.x), t.y);
}
