//! Rays into a relief, what a march finds, and how it marches: names and meaning are those of the crate relievo-march.
//!
//! Gives Ray, Record, ShadowRecord, March, and what follows from them alone.
//! Needs nothing.

// More layers or bisections than these are taken as these: every loop is bounded.
const MAX_LAYERS: f32 = 4096.0;
const MAX_REFINE_STEPS: u32 = 64u;
// A value of March.cones.
const CONES_RELAXED: u32 = 0u;
// Stands for infinity, which WGSL cannot write.
const HUGE: f32 = 3.0e38;

// A ray in texture space: uv(t) = uv + sweep/cos·t at depth t, 0 = on the lid, 1 = on the floor.
struct Ray {
    // Where it crosses the polygon, in texture repeats.
    uv: vec2f,
    // The uv travelled over the full depth, before the division by `cos`.
    sweep: vec2f,
    // Cosine between the ray and the normal, in (0, 1] for a ray that enters from outside.
    cos: f32,
}

struct Record {
    // The displaced texture coordinates; the ray's own on a miss.
    uv: vec2f,
    // 0 = on the lid, 1 = on the floor.
    depth: f32,
    hit: bool,
    // Height look-ups: filtered samples, or nodes of the pyramid and the four corners of a cell at once.
    fetches: u32,
    // Turns of the technique's loops.
    iterations: u32,
}

struct ShadowRecord {
    // 0 = no light arrives, 1 = all of it.
    factor: f32,
    fetches: u32,
    iterations: u32,
}

// Can stand in a uniform buffer: 48 bytes.
struct March {
    // Layers when looking along the normal, and along the surface; 1 to MAX_LAYERS.
    min_layers: f32,
    max_layers: f32,
    // Bisections of `relief` and `binary`, and the most of relaxed cones, whose most steps are max_layers.
    refine_steps: u32,
    // The height that lies on the polygon: 1 = the relief lies wholly below it.
    midlevel: f32,
    // Lower and upper corner of the uv outside of which there is no surface; counts if `bounded` is not 0.
    bounds: vec4f,
    bounded: u32,
    // Not 0: drop the division by `cos` in the layered techniques and their shadows.
    offset_limiting: u32,
    // The cones that `cone` steps through: CONES_RELAXED, or any other number for conservative ones.
    cones: u32,
}

// The uv travelled from the lid to the floor.
fn ray_slope(ray: Ray) -> vec2f {
    return ray.sweep / ray.cos;
}

// The same for the layered techniques.
fn layered_slope(ray: Ray, how: March) -> vec2f {
    return select(ray.sweep / ray.cos, ray.sweep, how.offset_limiting != 0u);
}

// Whether the ray enters from outside, and reaches no texel beyond those that f32 and i32 can address.
fn ray_is_usable(ray: Ray, size: vec2i) -> bool {
    // Twice the slope: a relief that rises above its polygon is entered before it.
    let reach = (abs(ray.uv) + 2.0 * abs(ray_slope(ray))) * vec2f(size);
    return ray.cos > 0.0 && reach.x < 1073741824.0 && reach.y < 1073741824.0;
}

// mix(max, min, |cos|), used with its fraction.
fn march_layers(how: March, cos: f32) -> f32 {
    let n = how.max_layers + (how.min_layers - how.max_layers) * abs(cos);
    return min(max(n, 1.0), MAX_LAYERS);
}

// The most samples of a search through n layers. The bound is an integer: it holds also where n is not a number.
fn layer_limit(n: f32) -> u32 {
    return min(u32(ceil(n)), u32(MAX_LAYERS)) + 1u;
}

// How far the lid lies above the polygon, as a fraction of the full depth.
fn march_rise(how: March) -> f32 {
    return 1.0 - min(max(how.midlevel, 0.0), 1.0);
}

// The uv at which a ray of this slope through `uv` on the polygon crosses the lid.
fn uv_on_lid(uv: vec2f, slope: vec2f, how: March) -> vec2f {
    let rise = march_rise(how);
    return select(uv - slope * rise, uv, rise == 0.0);
}

fn in_bounds(bounds: vec4f, uv: vec2f) -> bool {
    return uv.x >= bounds.x && uv.y >= bounds.y && uv.x <= bounds.z && uv.y <= bounds.w;
}

fn record_miss(ray: Ray, fetches: u32, iterations: u32) -> Record {
    return Record(ray.uv, 0.0, false, fetches, iterations);
}
