//! Sawn planks: growth rings cut along the trunk, fibres and knots.

use crate::curve::{mix, smoothstep};
use crate::noise::{GradientNoise, HashRng, visible_fraction};

/// The noises wrap after this many of their cells: farther than any plank is long.
const FAR: u32 = 256;

/// One board, cut at its own place of a tree. All lengths in uv.
pub(crate) struct Plank {
    /// Lightness relative to the wood's colour.
    pub(crate) shade: f32,
    /// -1..1: more yellow or more red.
    pub(crate) hue: f32,
    /// Height relative to the other planks, -1..1.
    pub(crate) lift: f32,
    /// Offset into the noise.
    offset: [f32; 2],
    /// The tree's middle, across the plank and below its face; `run` is its slope along the plank.
    pith: [f32; 2],
    run: f32,
    ring: f32,
    /// Along, across and radius.
    knot: Option<[f32; 3]>,
}

/// The wood at one point of a plank's face.
pub(crate) struct Grain {
    /// 0 the pale wood of spring, 1 the dark line at a year's end.
    pub(crate) line: f32,
    /// Fine streaks along the fibres, -1..1.
    pub(crate) fibre: f32,
    /// Slow variation of the tone, -1..1.
    pub(crate) tone: f32,
    /// 1 in a knot.
    pub(crate) knot: f32,
}

impl Plank {
    /// Creates the plank `id`, of the given `length` and `width`.
    pub(crate) fn new(id: u32, length: f32, width: f32) -> Self {
        let mut rng = HashRng::new(id, 0x900d);
        Self {
            shade: 1.0 + 0.09 * rng.signed(),
            hue: rng.signed(),
            lift: rng.signed(),
            offset: [200.0 * rng.unit(), 200.0 * rng.unit()],
            pith: [width * (0.5 + 0.5 * rng.signed()), 0.012 + 0.05 * rng.unit()],
            run: 0.07 * rng.signed(),
            ring: 0.0085 + 0.004 * rng.unit(),
            knot: (rng.unit() < 0.55).then(|| {
                [length * (0.1 + 0.8 * rng.unit()), width * (0.25 + 0.5 * rng.unit()), 0.006 + 0.006 * rng.unit()]
            }),
        }
    }

    /// Samples the wood `s` along and `t` across the plank, for texels of the size `texel`.
    pub(crate) fn grain(&self, s: f32, t: f32, texel: f32) -> Grain {
        let noise = |along: f32, across: f32, seed: u32| {
            let (x, y) = (s * along + self.offset[0], t * across + self.offset[1]);
            GradientNoise::new(FAR, FAR, seed).at(x / FAR as f32, y / FAR as f32)
        };
        let (mut knot, mut bent) = (0.0, t);
        let mut eye = 0.0;
        if let Some([ks, kt, radius]) = self.knot {
            // Fibres run around a knot: longer along the plank than across it.
            let d = ((0.45 * (s - ks)).powi(2) + (t - kt).powi(2)).sqrt() / radius;
            bent -= 0.9 * (t - kt) * (-0.18 * d * d).exp();
            let round = ((0.8 * (s - ks)).powi(2) + (t - kt).powi(2)).sqrt() / radius;
            knot = 1.0 - smoothstep(0.75, 1.05, round);
            eye = round;
        }
        let sway = noise(3.5, 11.0, 21);
        let across = bent - self.pith[0] + 0.006 * sway;
        let below = self.pith[1] + self.run * s + 0.010 * noise(2.0, 4.0, 22);
        let years = mix((across * across + below * below).sqrt() / self.ring, 2.2 * eye, knot);
        let year = years - years.floor();
        // Slowly darker through the summer, then the winter's sudden end.
        let line = smoothstep(0.25, 0.85, year) * (1.0 - smoothstep(0.88, 1.0, year));
        let fibre = 0.7 * noise(7.0, 95.0, 23) * visible_fraction(95, texel)
            + 0.6 * noise(16.0, 230.0, 24) * visible_fraction(230, texel);
        Grain { line, fibre, tone: noise(2.5, 9.0, 25), knot }
    }
}

/// Returns the colour (display values) of `grain` in a wood between `pale` and `dark`.
pub(crate) fn color(plank: &Plank, grain: &Grain, pale: [f32; 3], dark: [f32; 3]) -> [f32; 3] {
    let depth = (0.22 + 0.55 * grain.line + 0.16 * grain.fibre + 0.10 * grain.tone).clamp(0.0, 1.0);
    let light = plank.shade * (1.0 + 0.045 * grain.fibre + 0.03 * grain.tone) * (1.0 - 0.45 * grain.knot);
    let warm = [1.0 + 0.015 * plank.hue, 1.0, 1.0 - 0.05 * plank.hue];
    std::array::from_fn(|k| mix(pale[k], dark[k], depth) * light * warm[k])
}
