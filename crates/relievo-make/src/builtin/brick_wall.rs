//! The brick wall.
//!
//! Clay bricks lie as slabs with worn, chipped edges in a bed of mortar; whichever is higher shows. So chips fill with
//! mortar, and mortar laps over low edges, as on a real wall.

use crate::curve::{mix, mix3, smooth_max, smoothstep};
use crate::noise::{Fbm, GradientNoise, HashRng};
use crate::surface::{Surface, Texel};

/// The height scale that the brick wall's normals are made for: 0.05 of one repeat, from the deepest hole in the mortar
/// to the face of the proudest brick.
pub const BRICK_WALL_HEIGHT_SCALE: f32 = 0.05;

const COURSES: usize = 8;
/// Bricks in each course.
const ROW: usize = 3;
/// Distances from a brick's middle to the middle of the joints around it, in uv.
const HALF_PITCH: [f32; 2] = [0.5 / ROW as f32, 0.5 / COURSES as f32];
/// Half the width of a joint, in uv.
const HALF_JOINT: f32 = 0.0125;
/// Radius of a brick's corners in plan, in uv.
const CORNER: f32 = 0.009;

pub(crate) struct BrickWall {
    bricks: Vec<Brick>,
    wobble: Fbm,
    chips: Fbm,
    lumps: Fbm,
    grain: Fbm,
    pits: Fbm,
    folds: Fbm,
    patches: Fbm,
    stains: Fbm,
    film: Fbm,
    specks: Fbm,
    sand: Fbm,
}

struct Brick {
    color: [f32; 3],
    /// 0 an ordinary brick, 1 one burnt dark and glassy.
    burnt: f32,
    top: f32,
    /// Rise of the face from the middle to the right end and to the lower edge.
    tilt: [f32; 2],
    /// Offset from the brick's cell in the bond, in uv.
    offset: [f32; 2],
    half: [f32; 2],
    /// Sine of the rotation, small.
    angle: f32,
    /// Wear of the edges: scales chips and the width of the worn flank.
    wear: f32,
    pitted: f32,
    folded: f32,
}

impl Brick {
    fn new(id: u32) -> Self {
        let mut rng = HashRng::new(id, 0xb421);
        const CLAYS: [[f32; 3]; 6] = [
            [0.550, 0.335, 0.265],
            [0.590, 0.375, 0.290],
            [0.505, 0.295, 0.240],
            [0.630, 0.430, 0.340],
            [0.560, 0.360, 0.300],
            [0.475, 0.285, 0.240],
        ];
        let kind = (rng.unit() * CLAYS.len() as f32) as usize;
        let other = (rng.unit() * CLAYS.len() as f32) as usize;
        // One in every two courses, so that the dark ones are spread over the wall.
        let group = 2 * ROW as u32;
        let chosen = (HashRng::new(id / group, 0xda48).unit() * group as f32) as u32;
        let burnt = if id % group == chosen { 0.7 + 0.3 * rng.unit() } else { 0.25 * smoothstep(0.6, 1.0, rng.unit()) };
        let clay = mix3(CLAYS[kind], CLAYS[other], 0.5 * rng.unit());
        let light = 1.0 + 0.07 * rng.signed();
        let color = mix3(clay.map(|c| c * light), [0.285, 0.205, 0.190], 0.85 * burnt);
        Self {
            color,
            burnt,
            top: 0.84 + 0.055 * rng.signed(),
            tilt: [0.030 * rng.signed(), 0.035 * rng.signed()],
            offset: [0.0022 * rng.signed(), 0.0016 * rng.signed()],
            half: [
                HALF_PITCH[0] - HALF_JOINT + 0.0022 * rng.signed(),
                HALF_PITCH[1] - HALF_JOINT + 0.0014 * rng.signed(),
            ],
            angle: 0.007 * rng.signed(),
            wear: 0.6 + 0.9 * rng.unit() * rng.unit(),
            pitted: rng.unit(),
            folded: rng.unit(),
        }
    }

    /// Returns the distance from the brick's outline at (`x`, `y`) from its cell's middle, in uv; positive inside.
    fn inside(&self, x: f32, y: f32) -> f32 {
        let (x, y) = (x - self.offset[0], y - self.offset[1]);
        let (x, y) = (x + self.angle * y, y - self.angle * x);
        // A rounded rectangle: distances beyond the rectangle of the corners' centres.
        let qx = x.abs() - (self.half[0] - CORNER);
        let qy = y.abs() - (self.half[1] - CORNER);
        let outside = (qx.max(0.0).powi(2) + qy.max(0.0).powi(2)).sqrt();
        CORNER - outside - qx.max(qy).min(0.0)
    }
}

/// One row of each noise.
pub(crate) struct NoiseRows {
    wobble: Vec<f32>,
    chips: Vec<f32>,
    lumps: Vec<f32>,
    grain: Vec<f32>,
    pits: Vec<f32>,
    folds: Vec<f32>,
    patches: Vec<f32>,
    stains: Vec<f32>,
    film: Vec<f32>,
    specks: Vec<f32>,
    sand: Vec<f32>,
}

impl BrickWall {
    pub(crate) fn new() -> Self {
        let noise =
            |columns, rows, octaves, gain, seed| Fbm::new(GradientNoise::new(columns, rows, seed), octaves, gain);
        Self {
            bricks: (0..(ROW * COURSES) as u32).map(Brick::new).collect(),
            wobble: noise(26, 26, 4, 0.55, 1),
            chips: noise(22, 26, 3, 0.5, 2),
            lumps: noise(18, 24, 3, 0.55, 3),
            grain: noise(150, 150, 3, 0.75, 4),
            pits: noise(64, 72, 2, 0.6, 5),
            folds: noise(10, 56, 3, 0.6, 6),
            patches: noise(7, 11, 4, 0.55, 7),
            stains: noise(3, 3, 4, 0.6, 8),
            film: noise(4, 5, 5, 0.65, 9),
            specks: noise(110, 110, 2, 0.8, 10),
            sand: noise(170, 170, 3, 0.9, 11),
        }
    }
}

impl Surface for BrickWall {
    type Scratch = NoiseRows;

    fn scratch(&self, size: usize) -> NoiseRows {
        let row = || vec![0.0; size];
        NoiseRows {
            wobble: row(),
            chips: row(),
            lumps: row(),
            grain: row(),
            pits: row(),
            folds: row(),
            patches: row(),
            stains: row(),
            film: row(),
            specks: row(),
            sand: row(),
        }
    }

    fn height_scale(&self) -> f32 {
        BRICK_WALL_HEIGHT_SCALE
    }

    fn row(&self, v: f32, rows: &mut NoiseRows, out: &mut [Texel]) {
        self.wobble.row(v, &mut rows.wobble);
        self.chips.row(v, &mut rows.chips);
        self.lumps.row(v, &mut rows.lumps);
        self.grain.row(v, &mut rows.grain);
        self.pits.row(v, &mut rows.pits);
        self.folds.row(v, &mut rows.folds);
        self.patches.row(v, &mut rows.patches);
        self.stains.row(v, &mut rows.stains);
        self.film.row(v, &mut rows.film);
        self.specks.row(v, &mut rows.specks);
        self.sand.row(v, &mut rows.sand);
        let course = ((v * COURSES as f32) as usize).min(COURSES - 1);
        let y = v - (2 * course + 1) as f32 * HALF_PITCH[1];
        // Running bond: every second course begins with half a brick.
        let bond = if course % 2 == 1 { HALF_PITCH[0] } else { 0.0 };
        let texel = 1.0 / out.len() as f32;
        for (i, out) in out.iter_mut().enumerate() {
            let u = (i as f32 + 0.5) * texel + bond;
            let place = (u * ROW as f32) as usize;
            let x = u - (2 * place + 1) as f32 * HALF_PITCH[0];
            let brick = &self.bricks[course * ROW + place % ROW];
            let noise = |row: &[f32]| row[i];
            *out = shade(
                brick,
                [x, y],
                texel,
                &NoiseSample {
                    wobble: noise(&rows.wobble),
                    chips: noise(&rows.chips),
                    lumps: noise(&rows.lumps),
                    grain: noise(&rows.grain),
                    pits: noise(&rows.pits),
                    folds: noise(&rows.folds),
                    patches: noise(&rows.patches),
                    stains: noise(&rows.stains),
                    film: noise(&rows.film),
                    specks: noise(&rows.specks),
                    sand: noise(&rows.sand),
                },
            );
        }
    }
}

/// The noises at one point, each about -1..1.
struct NoiseSample {
    wobble: f32,
    chips: f32,
    lumps: f32,
    grain: f32,
    pits: f32,
    folds: f32,
    patches: f32,
    stains: f32,
    film: f32,
    specks: f32,
    sand: f32,
}

/// The wall at `at` from the middle of `brick`'s place.
fn shade(brick: &Brick, at: [f32; 2], texel: f32, n: &NoiseSample) -> Texel {
    let [x, y] = at;
    // Edges: a ragged outline, and here and there a piece broken off.
    let chip = smoothstep(0.25, 0.85, n.chips);
    let edge = brick.inside(x, y) + 0.0022 * n.wobble - 0.006 * brick.wear * chip;
    let flank = (0.005 + 0.007 * brick.wear + 0.006 * chip).max(1.5 * texel);

    // The face: tilted, slightly pillowed, lumpy, with folds from the mould, grain and pits.
    let (px, py) = (x / HALF_PITCH[0], y / HALF_PITCH[1]);
    let pit = smoothstep(0.42, 0.75, n.pits) * (0.25 + 0.75 * brick.pitted);
    let fold = smoothstep(0.35, 0.8, n.folds) * smoothstep(0.4, 0.8, brick.folded);
    let face = brick.top + brick.tilt[0] * px + brick.tilt[1] * py - 0.02 * (px * px + py * py)
        + 0.030 * n.lumps
        + 0.020 * n.grain
        - 0.060 * pit
        - 0.05 * fold
        - 0.16 * brick.wear * chip * (1.0 - smoothstep(0.0, 0.022, edge));
    // Rounded over at the edge, then steep: a quarter of an ellipse from the face down to half its height.
    let t = (1.0 - edge / flank).max(0.0);
    let slab = face - 0.30 * t * t;

    // Mortar: struck concave, sandy.
    let to_joint = (HALF_PITCH[0] - x.abs()).min(HALF_PITCH[1] - y.abs()).max(0.0);
    let lip = (to_joint / HALF_JOINT).min(1.5);
    let bed = 0.24 + 0.07 * lip * lip + 0.030 * n.lumps + 0.035 * n.sand + 0.03 * n.wobble;
    let height = smooth_max(slab, bed, 0.06);

    let shown = smoothstep(-0.03, 0.03, slab - bed);
    let (clay, clay_rough) = clay(brick, n, t, pit.max(fold), chip);
    let (mortar, mortar_rough) = mortar(n);
    let mut color = mix3(mortar, clay, shown);
    let mut roughness = mix(mortar_rough, clay_rough, shown);

    // The mason's trowel left a film of mortar on some edges.
    let smear = (1.0 - smoothstep(0.0, 0.016, edge)) * smoothstep(0.0, 0.6, n.film + 0.35 * n.sand);
    color = mix3(color, mortar, 0.55 * smear * shown);

    // Salts that bloomed out of the wall, and soot that settled where it is sheltered.
    let bloom = smoothstep(0.10, 0.9, n.film + 0.15 * n.sand) * (0.55 + 0.6 * n.grain).clamp(0.0, 1.0);
    color = mix3(color, [0.74, 0.715, 0.68], 0.50 * bloom);
    let soot = smoothstep(-0.1, 1.0, n.stains + 0.15 * n.grain) * mix(1.0, 0.55, smoothstep(0.3, 0.8, height));
    color = color.map(|c| c * (1.0 - 0.34 * soot));
    roughness = mix(roughness, 0.96, 0.6 * bloom);
    Texel { height, color, roughness }
}

/// Colour and roughness of fired clay; `worn` is 0 on the face and grows down the flank, `hollow` is 1 in pits.
fn clay(brick: &Brick, n: &NoiseSample, worn: f32, hollow: f32, chip: f32) -> ([f32; 3], f32) {
    let light = 1.0 + 0.10 * n.patches + 0.04 * n.lumps + 0.085 * n.grain + 0.04 * n.sand;
    let mut color = brick.color.map(|c| c * light);
    // The fire reddens and darkens in patches.
    let fired = smoothstep(0.1, 0.9, -n.patches - 0.22 * n.grain);
    color = mix3(color, [color[0] * 0.80, color[1] * 0.72, color[2] * 0.74], 0.6 * fired);
    // Grit: dark ironspots and pale grains of sand.
    color = mix3(color, [0.17, 0.135, 0.13], 0.60 * smoothstep(0.5, 0.9, n.specks));
    color = mix3(color, [0.74, 0.60, 0.48], 0.40 * smoothstep(0.45, 0.85, -n.specks));
    // Broken edges show the paler core.
    let fresh = smoothstep(0.1, 0.9, worn) * (0.25 + 0.75 * chip);
    color = mix3(color, [0.66, 0.41, 0.30], 0.35 * fresh * (1.0 - 0.6 * brick.burnt));
    color = color.map(|c| c * (1.0 - 0.28 * hollow));
    let roughness = 0.84 - 0.24 * brick.burnt + 0.05 * n.lumps + 0.05 * n.grain + 0.06 * hollow;
    (color, roughness.clamp(0.4, 0.95))
}

/// Colour and roughness of lime mortar with sand in it.
fn mortar(n: &NoiseSample) -> ([f32; 3], f32) {
    let light = 1.0 + 0.10 * n.sand + 0.07 * n.patches + 0.05 * n.lumps;
    let mut color = [0.640, 0.600, 0.535].map(|c| c * light);
    color = mix3(color, [0.40, 0.35, 0.30], 0.5 * smoothstep(0.4, 0.9, n.specks));
    color = mix3(color, [0.80, 0.77, 0.71], 0.5 * smoothstep(0.4, 0.9, -n.specks));
    (color, (0.93 + 0.04 * n.sand).clamp(0.8, 1.0))
}
