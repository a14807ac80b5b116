//! Sums of octaves of noise, and the functions of formulas: what recipes of relievo-make are made of.
//!
//! Gives relievo_fractal, RELIEVO_FBM and the other kinds, relievo_number, relievo_modulo, relievo_power, relievo_hypot,
//! relievo_mix, relievo_smoothstep, relievo_smooth_min, relievo_smooth_max; declares relievo_octaves.
//! #import noise

const RELIEVO_FBM: u32 = 0u;
const RELIEVO_RIDGED: u32 = 1u;
const RELIEVO_BILLOW: u32 = 2u;

@group(0) @binding(1) var<storage, read> relievo_octaves: array<RelievoOctave>;

// `count` octaves of the table from `first` on; `whole` is their energy or weight.
fn relievo_fractal(uv: vec2f, basis: u32, kind: u32, first: u32, count: u32, gain: f32, whole: f32) -> f32 {
    var amplitude = 1.0;
    var total = 0.0;
    var crest = 1.0;
    var mean = 0.0;
    for (var k = 0u; k < count; k++) {
        let octave = relievo_octaves[first + k];
        mean = octave.mean;
        var n = 0.0;
        if octave.shown > 0.0 {
            n = relievo_octave_at(octave, basis, uv);
        }
        switch kind {
            case RELIEVO_FBM: { total += amplitude * (n - mean) * octave.shown; }
            case RELIEVO_RIDGED: {
                let ridge = max(1.0 - abs(n), 0.0);
                let level = 0.52 * crest;
                let signal = level + (ridge * ridge * crest - level) * octave.shown;
                total += amplitude * signal;
                crest = min(2.0 * signal, 1.0);
            }
            default: { total += amplitude * (0.27 + (abs(n) - 0.27) * octave.shown); }
        }
        amplitude *= gain;
    }
    return total / whole + select(0.0, mean, kind == RELIEVO_FBM);
}

// A constant that compilers do not compute with: what is not defined is left to the device.
fn relievo_number(x: f32) -> f32 {
    return x;
}

fn relievo_modulo(a: f32, b: f32) -> f32 {
    return a - b * floor(a / b);
}

fn relievo_power(a: f32, b: f32) -> f32 {
    return pow(max(a, 0.0), b);
}

fn relievo_hypot(a: f32, b: f32) -> f32 {
    return sqrt(a * a + b * b);
}

fn relievo_mix(a: f32, b: f32, t: f32) -> f32 {
    return a + (b - a) * t;
}

fn relievo_smoothstep(low: f32, high: f32, x: f32) -> f32 {
    let t = min(max((x - low) / (high - low), 0.0), 1.0);
    return t * t * (3.0 - 2.0 * t);
}

fn relievo_smooth_max(a: f32, b: f32, k: f32) -> f32 {
    let width = max(k, 1e-9);
    let t = max(width - abs(a - b), 0.0) / width;
    return max(a, b) + 0.25 * width * t * t;
}

fn relievo_smooth_min(a: f32, b: f32, k: f32) -> f32 {
    return -relievo_smooth_max(-a, -b, k);
}
