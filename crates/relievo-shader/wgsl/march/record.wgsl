//! Rays into a relief, what a march finds, and how it marches: names and meaning are those of the crate relievo-march.
//!
//! Gives RelievoRay, RelievoRecord, RelievoShadowRecord, RelievoMarchOptions, relievo_default_options, and what follows
//! from them alone.
//! Needs nothing.

// More layers or bisections than these are taken as these: every loop is bounded.
const RELIEVO_MAX_LAYERS: f32 = 4096.0;
const RELIEVO_MAX_REFINE_STEPS: u32 = 64u;
// A value of RelievoMarchOptions.cones.
const RELIEVO_CONES_RELAXED: u32 = 0u;
// Stands for infinity, which WGSL cannot write.
const RELIEVO_HUGE: f32 = 3.0e38;
// The distance of a light that lies above all reliefs, in full depths: far below what becomes infinite.
const RELIEVO_FAR_LIGHT: f32 = 1e30;
// The most that a lamp may lie below the point it lights: one that is farther down lies below all of the relief.
const RELIEVO_MAX_LIGHT_DESCENT: f32 = 4.0;

// Whether a lamp that lies as low as a point, or lower, may light it.
fn relievo_light_is_beside(light: RelievoRay, reach: f32, size: vec2i) -> bool {
    return relievo_ray_is_usable(RelievoRay(light.uv, light.uv_delta * min(reach, RELIEVO_FAR_LIGHT), 1.0), size)
        && abs(light.cos) <= 1.0 && reach > 0.0 && reach < RELIEVO_FAR_LIGHT && light.cos * reach > -RELIEVO_MAX_LIGHT_DESCENT;
}

// A ray in texture space: uv(t) = uv + uv_delta/cos·t at depth t, 0 = on the lid, 1 = on the floor.
struct RelievoRay {
    // Where it crosses the polygon, in texture repeats.
    uv: vec2f,
    // The uv travelled over the full depth, before the division by `cos`.
    uv_delta: vec2f,
    // Height gained towards the eye, in parts of the way: the cosine between the ray and the normal, in (0, 1] for a ray that
    // enters from outside, above 1 only where an interpolated normal leans with it.
    cos: f32,
}

struct RelievoRecord {
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

struct RelievoShadowRecord {
    // 0 = no light arrives, 1 = all of it.
    factor: f32,
    fetches: u32,
    iterations: u32,
}

// Can stand in a uniform buffer: 48 bytes.
struct RelievoMarchOptions {
    // Layers when looking along the normal, and along the surface; 1 to RELIEVO_MAX_LAYERS.
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
    // The cones that `cone` steps through: RELIEVO_CONES_RELAXED, or any other number for conservative ones.
    cones: u32,
}

// 8 to 32 layers, 5 bisections, all of the relief below the surface, no bounds, relaxed cones.
fn relievo_default_options() -> RelievoMarchOptions {
    return RelievoMarchOptions(8.0, 32.0, 5u, 1.0, vec4f(0.0), 0u, 0u, RELIEVO_CONES_RELAXED);
}

// The uv travelled from the lid to the floor.
fn relievo_ray_slope(ray: RelievoRay) -> vec2f {
    return ray.uv_delta / ray.cos;
}

// The same for the layered techniques.
fn relievo_layered_slope(ray: RelievoRay, options: RelievoMarchOptions) -> vec2f {
    return select(ray.uv_delta / ray.cos, ray.uv_delta, options.offset_limiting != 0u);
}

// Whether the ray enters from outside, and reaches no texel beyond those that f32 and i32 can address.
fn relievo_ray_is_usable(ray: RelievoRay, size: vec2i) -> bool {
    // Twice the slope: a relief that rises above its polygon is entered before it.
    let reach = (abs(ray.uv) + 2.0 * abs(relievo_ray_slope(ray))) * vec2f(size);
    return ray.cos > 0.0 && reach.x < 1073741824.0 && reach.y < 1073741824.0;
}

// mix(max, min, |cos|), used with its fraction.
fn relievo_layer_count(options: RelievoMarchOptions, cos: f32) -> f32 {
    // Where the normal leans, the height along a ray grows faster than its length.
    let n = options.max_layers + (options.min_layers - options.max_layers) * min(abs(cos), 1.0);
    return min(max(n, 1.0), RELIEVO_MAX_LAYERS);
}

// The most samples of a search through n layers. The bound is an integer: it holds also where n is not a number.
fn relievo_layer_limit(n: f32) -> u32 {
    return min(u32(ceil(n)), u32(RELIEVO_MAX_LAYERS)) + 1u;
}

// How far the lid lies above the polygon, as a fraction of the full depth.
fn relievo_lid_offset(options: RelievoMarchOptions) -> f32 {
    return 1.0 - min(max(options.midlevel, 0.0), 1.0);
}

// The uv at which a ray of this slope through `uv` on the polygon crosses the lid.
fn relievo_uv_on_lid(uv: vec2f, slope: vec2f, options: RelievoMarchOptions) -> vec2f {
    let lid_offset = relievo_lid_offset(options);
    return select(uv - slope * lid_offset, uv, lid_offset == 0.0);
}

fn relievo_in_bounds(bounds: vec4f, uv: vec2f) -> bool {
    return uv.x >= bounds.x && uv.y >= bounds.y && uv.x <= bounds.z && uv.y <= bounds.w;
}

fn relievo_miss(ray: RelievoRay, fetches: u32, iterations: u32) -> RelievoRecord {
    return RelievoRecord(ray.uv, 0.0, false, fetches, iterations);
}
