//! The toy box: a wooden crate seen from above, with four painted blocks on its floor.

use super::wood::{self, Plank};
use crate::curve::{mix, mix3, smoothstep};
use crate::noise::{Fbm, GradientNoise, HashRng};
use crate::shapes::{frustum_height, hemisphere_height, pyramid_height, torus_height};
use crate::surface::{Surface, Texel};

/// The height scale that the toy box's normals are made for: 0.16 of one repeat from the cracks of the floor to the rim.
/// With it the hemisphere is a true one.
pub const TOY_BOX_HEIGHT_SCALE: f32 = 0.16;

/// Width of the boards of the rim.
const RIM: f32 = 0.085;
/// Planks of the floor, side by side.
const PLANKS: usize = 7;
const PLANK_WIDTH: f32 = (1.0 - 2.0 * RIM) / PLANKS as f32;
/// Height of the floor's planks.
const FLOOR: f32 = 0.05;
/// Distance of the blocks' middles from the box's, along u and along v.
const OFF_CENTER: f64 = 0.195;
/// Radius of the hemisphere.
const BALL: f64 = 0.145;
const PYRAMID: f64 = 0.130;
/// Sine and cosine of the pyramid's rotation.
const PYRAMID_ROTATION: [f64; 2] = [0.28, 0.96];
const FRUSTUM: [f64; 2] = [0.142, 0.078];
const TORUS: [f64; 2] = [0.096, 0.048];

const PINE: [[f32; 3]; 2] = [[0.800, 0.655, 0.470], [0.585, 0.400, 0.235]];
const OAK: [[f32; 3]; 2] = [[0.600, 0.430, 0.275], [0.370, 0.235, 0.140]];
const BEECH: [[f32; 3]; 2] = [[0.835, 0.690, 0.515], [0.720, 0.540, 0.370]];

pub(crate) struct ToyBox {
    /// Each row of the floor: the butt joint in it, and the planks left and right of it.
    floor: Vec<(f32, [Plank; 2])>,
    rim: [Plank; 4],
    block: Plank,
    /// Unevenness of paint and floor.
    dents: Fbm,
    /// Worn paint and settled dust.
    wear: Fbm,
    scuffs: Fbm,
}

pub(crate) struct NoiseRows {
    dents: Vec<f32>,
    wear: Vec<f32>,
    scuffs: Vec<f32>,
}

impl ToyBox {
    pub(crate) fn new() -> Self {
        let floor = (0..PLANKS as u32)
            .map(|row| {
                let joint = 0.5 + 0.30 * HashRng::new(row, 0xf100).signed();
                (joint, [2 * row, 2 * row + 1].map(|id| Plank::new(id, 0.5, PLANK_WIDTH)))
            })
            .collect();
        let noise = |cells, octaves, gain, seed| Fbm::new(GradientNoise::new(cells, cells, seed), octaves, gain);
        Self {
            floor,
            rim: [100, 101, 102, 103].map(|id| Plank::new(id, 1.0, RIM)),
            block: Plank::new(200, 1.0, 1.0),
            dents: noise(14, 4, 0.5, 31),
            wear: noise(9, 6, 0.65, 32),
            scuffs: noise(48, 4, 0.7, 33),
        }
    }
}

impl Surface for ToyBox {
    type Scratch = NoiseRows;

    fn scratch(&self, size: usize) -> NoiseRows {
        NoiseRows { dents: vec![0.0; size], wear: vec![0.0; size], scuffs: vec![0.0; size] }
    }

    fn height_scale(&self) -> f32 {
        TOY_BOX_HEIGHT_SCALE
    }

    fn row(&self, v: f32, rows: &mut NoiseRows, out: &mut [Texel]) {
        self.dents.row(v, &mut rows.dents);
        self.wear.row(v, &mut rows.wear);
        self.scuffs.row(v, &mut rows.scuffs);
        let texel = 1.0 / out.len() as f32;
        for (i, out) in out.iter_mut().enumerate() {
            let u = (i as f32 + 0.5) * texel;
            let n = NoiseSample { dents: rows.dents[i], wear: rows.wear[i], scuffs: rows.scuffs[i] };
            let border = u.min(1.0 - u).min(v.min(1.0 - v));
            // The inner wall leans a little, so that it has texels of its own.
            let wall = smoothstep(RIM - 0.5 * WALL, RIM + 0.5 * WALL, border);
            *out = if wall <= 0.0 {
                self.rim(u, v, border, texel, &n)
            } else if wall >= 1.0 {
                self.inside(u, v, texel, &n)
            } else {
                let (rim, floor) = (self.rim(u, v, border, texel, &n), self.inside(u, v, texel, &n));
                Texel {
                    height: mix(rim.height, floor.height, wall),
                    color: mix3(rim.color, floor.color, smoothstep(0.6, 1.0, wall)),
                    roughness: mix(rim.roughness, floor.roughness, wall),
                }
            };
        }
    }
}

/// Width of the inner wall in plan.
const WALL: f32 = 0.012;

/// The noises at one point, each about -1..1.
struct NoiseSample {
    dents: f32,
    wear: f32,
    scuffs: f32,
}

impl ToyBox {
    /// The boards of the rim, mitred at the corners; `border` is the distance from the box's outer edge.
    fn rim(&self, u: f32, v: f32, border: f32, texel: f32, n: &NoiseSample) -> Texel {
        let (side, s) = if border == u {
            (0, v)
        } else if border == v {
            (1, u)
        } else if border == 1.0 - u {
            (2, v)
        } else {
            (3, u)
        };
        let plank = &self.rim[side];
        let grain = plank.grain(s, border, texel);
        let mut color = wood::color(plank, &grain, OAK[0], OAK[1]);
        // The joint of two boxes at the border, the mitre at the corners, edges rounded by hands.
        let miter = ((s.min(1.0 - s) - border).abs() * std::f32::consts::FRAC_1_SQRT_2) / 0.0028f32.max(texel);
        let miter = 1.0 - smoothstep(0.3, 1.0, miter);
        let outer = (1.0 - border / 0.010).max(0.0);
        let inner = (1.0 - (RIM - 0.5 * WALL - border) / 0.014).clamp(0.0, 1.0);
        // The relief fades out towards the border, where the height is the same all round.
        let relief = smoothstep(0.004, 0.014, border);
        let mut height = 0.985 - 0.045 * outer * outer - 0.05 * inner * inner
            + relief * (0.006 * n.dents + 0.004 * grain.fibre - 0.010 * grain.line + 0.006 * plank.lift - 0.06 * miter);
        let worn = smoothstep(0.2, 1.0, inner.max(outer) + 0.35 * n.scuffs);
        color = mix3(color, [0.70, 0.54, 0.37], 0.45 * worn);
        color = color.map(|c| c * (1.0 - 0.5 * miter) * (1.0 - 0.10 * smoothstep(0.2, 1.2, n.wear)));
        let mut roughness = 0.58 + 0.06 * grain.fibre + 0.10 * worn;
        // A brass screw on each side of each mitre.
        let end = s.min(1.0 - s);
        let r = ((end - 0.125).powi(2) + (border - 0.5 * RIM).powi(2)).sqrt();
        let head = 1.0 - smoothstep(0.0095 - texel, 0.0095 + texel, r);
        if head > 0.0 {
            let (slot_s, slot_t) = (end - 0.125, border - 0.5 * RIM);
            let angle = 0.4 + side as f32;
            let slot = (slot_s * angle.sin() - slot_t * angle.cos()).abs();
            let slot = 1.0 - smoothstep(0.0012, 0.0012 + 1.5 * texel, slot);
            let dome = 0.955 + 0.022 * (1.0 - (r / 0.0095).powi(2)).max(0.0) - 0.05 * slot;
            height = mix(height, dome, head);
            color = mix3(color, [0.74, 0.60, 0.32].map(|c| c * (1.0 - 0.6 * slot + 0.06 * n.scuffs)), head);
            roughness = mix(roughness, 0.34 + 0.1 * n.scuffs.abs(), head);
        }
        Texel { height, color, roughness }
    }

    fn inside(&self, u: f32, v: f32, texel: f32, n: &NoiseSample) -> Texel {
        let Some(block) = block(u, v, texel) else { return self.floor(u, v, texel, n) };
        let grain = self.block.grain(u, v, texel);
        let bare = wood::color(&self.block, &grain, BEECH[0], BEECH[1]);
        // Paint goes first where hands and other toys touch: at the edges and here and there.
        let worn = smoothstep(0.72, 0.92, 0.75 * block.edge + 0.34 * n.scuffs + 0.22 * n.wear)
            .max(0.9 * smoothstep(0.85, 0.98, n.wear + 0.30 * n.scuffs));
        let paint =
            block.paint.map(|c| c * (1.0 + 0.05 * n.dents + 0.035 * n.scuffs + 0.03 * grain.fibre + 0.05 * n.wear));
        let color = mix3(paint, bare, worn);
        let top = FLOOR
            + (1.0 - FLOOR) * 0.955 * block.height
            + smoothstep(0.0, 0.1, block.height) * (0.003 * n.dents + 0.002 * grain.fibre - 0.006 * worn);
        let painted = Texel { height: top, color, roughness: mix(0.38 + 0.04 * n.scuffs, 0.68, worn) };
        if block.cover >= 1.0 {
            return painted;
        }
        let floor = self.floor(u, v, texel, n);
        Texel {
            height: mix(floor.height, painted.height.max(floor.height), block.cover),
            color: mix3(floor.color, painted.color, block.cover),
            roughness: mix(floor.roughness, painted.roughness, block.cover),
        }
    }

    fn floor(&self, u: f32, v: f32, texel: f32, n: &NoiseSample) -> Texel {
        let across = (v - RIM) / PLANK_WIDTH;
        let row = (across.max(0.0) as usize).min(PLANKS - 1);
        let t = v - RIM - row as f32 * PLANK_WIDTH;
        let (joint, planks) = &self.floor[row];
        let plank = &planks[usize::from(u > *joint)];
        let s = u - if u > *joint { *joint } else { 0.0 };
        let grain = plank.grain(s, t, texel);
        let mut color = wood::color(plank, &grain, PINE[0], PINE[1]);
        // Gaps between planks, their edges eased.
        let gap_v = t.min(PLANK_WIDTH - t);
        let gap_u = (u - joint).abs();
        let gap = gap_v.min(gap_u + 0.0008);
        let open = 1.0 - smoothstep(0.0014, 0.0014 + (0.0025f32).max(1.5 * texel), gap);
        let eased = (1.0 - gap / 0.009).max(0.0);
        let mut height = FLOOR + 0.007 * plank.lift + 0.003 * n.dents + 0.003 * grain.fibre
            - 0.006 * grain.line
            - 0.012 * eased * eased;
        height = mix(height, 0.004, open);
        let dust = smoothstep(0.0, 1.2, n.wear);
        color = color.map(|c| c * (1.0 - 0.13 * dust));
        color = mix3(color, [0.16, 0.11, 0.075], 0.75 * open);
        let mut roughness = 0.66 + 0.05 * grain.fibre + 0.10 * dust + 0.15 * open;
        // Two nails hold each end of a plank.
        let (ns, nt) = (gap_u.min((u - RIM).min(1.0 - RIM - u)) - 0.018, gap_v - 0.024);
        let r = (ns * ns + nt * nt).sqrt();
        let nail = 1.0 - smoothstep(0.0036 - 0.5 * texel, 0.0036 + texel, r);
        color = mix3(color, [0.30, 0.29, 0.285], 0.9 * nail);
        // Iron stains the wood around it.
        color = color.map(|c| c * (1.0 - 0.18 * (1.0 - smoothstep(0.003, 0.010, r))));
        height -= 0.012 * nail;
        roughness = mix(roughness, 0.45, nail);
        Texel { height, color, roughness }
    }
}

/// A painted block at one point.
struct Block {
    /// 0..1.
    height: f32,
    /// Coverage of the texel, 0..1.
    cover: f32,
    paint: [f32; 3],
    /// 1 at an edge that stands out, 0 a little away from it.
    edge: f32,
}

fn block(u: f32, v: f32, texel: f32) -> Option<Block> {
    let (x, y) = (f64::from(u) - 0.5, f64::from(v) - 0.5);
    // The middle of the quarter that (u, v) lies in is the origin.
    let (right, below) = (x > 0.0, y > 0.0);
    let (x, y) = (x - OFF_CENTER.copysign(x), y - OFF_CENTER.copysign(y));
    let r = x.hypot(y);
    let middle = [0.0, 0.0];
    // How far inside its outline, its height, its paint, its edges.
    let (within, height, paint, edge) = match (right, below) {
        (false, false) => (BALL - r, hemisphere_height(x, y, middle, BALL) * ball_top(), [0.770, 0.205, 0.165], 0.0),
        (true, false) => {
            let [sin, cos] = PYRAMID_ROTATION;
            let (x, y) = (x * cos + y * sin, y * cos - x * sin);
            let ridge = (x.abs() - y.abs()).abs() / 0.016;
            let tip = x.abs().max(y.abs()) / 0.02;
            (
                PYRAMID - x.abs().max(y.abs()),
                pyramid_height(x, y, middle, PYRAMID),
                [0.930, 0.700, 0.180],
                1.0 - ridge.min(tip),
            )
        }
        (false, true) => {
            let [bottom, top] = FRUSTUM;
            let height = frustum_height(x, y, middle, bottom, top);
            (bottom - r, 0.74 * height, [0.165, 0.400, 0.690], 1.0 - (r - top).abs() / 0.014)
        }
        (true, true) => {
            let [major, minor] = TORUS;
            (minor - (r - major).abs(), 0.56 * torus_height(x, y, middle, major, minor), [0.270, 0.570, 0.300], 0.0)
        }
    };
    let cover = smoothstep(-0.75 * texel, 0.75 * texel, within as f32);
    (cover > 0.0).then(|| Block { height: height as f32, cover, paint, edge: edge.max(0.0) as f32 })
}

/// The share of the blocks' range that makes the hemisphere a true one.
fn ball_top() -> f64 {
    BALL / (f64::from(TOY_BOX_HEIGHT_SCALE) * f64::from(1.0 - FLOOR) * 0.955)
}
