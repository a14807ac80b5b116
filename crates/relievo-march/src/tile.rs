//! The look-ahead for a tile of neighbouring rays: the depth down to which all of them stay above the surface.

use crate::grid_line::{TEXEL_CENTER, texel_coordinate};
use crate::pyramid::{BITS, PyramidField, highest_in};
use crate::real::Real;
use crate::{HeightField, MarchOptions, Ray};

/// The most steps: more are not worth their fetches.
const MAX_STEPS: u32 = 64;

/// The result of [`tile_entry`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TileEntry {
    /// The depth down to which all rays are above the surface: for [`crate::march_from`].
    pub depth: f32,
    /// Nodes of the pyramid that were loaded, once for all rays.
    pub fetches: u32,
}

/// Finds a depth down to which all of these rays stay above the surface: the coarse pass before an exact march of each.
///
/// The beam that holds all rays goes down through the blocks of the max pyramid, in steps that grow where it is free and
/// shrink where it is not. The depth is a lower bound: 0 without a pyramid, or with a ray that is a miss for every march.
#[must_use]
pub fn tile_entry(field: &impl HeightField, rays: &[Ray], options: &MarchOptions) -> TileEntry {
    let Some(map) = field.pyramid() else { return TileEntry::default() };
    if rays.is_empty() || !rays.iter().all(|ray| ray.is_usable(field.size())) {
        return TileEntry::default();
    }
    let size = field.size().map(|n| n as f32);
    let mut beam = Beam::EMPTY;
    for ray in rays {
        let (uv, slope) = (options.on_lid(ray).uv, ray.slope());
        for k in 0..2 {
            let (at, d) = (texel_coordinate(uv[k], size[k], TEXEL_CENTER), slope[k] * size[k]);
            (beam.low[k], beam.high[k]) = (beam.low[k].min(at), beam.high[k].max(at));
            (beam.slowest[k], beam.fastest[k]) = (beam.slowest[k].min(d), beam.fastest[k].max(d));
        }
    }
    beam.descend(field.range(), &map)
}

/// A box of rays: positions on the lid in texel-centre coordinates, and speeds in texels per unit of depth.
struct Beam {
    low: [f32; 2],
    high: [f32; 2],
    slowest: [f32; 2],
    fastest: [f32; 2],
}

impl Beam {
    /// The box around no ray.
    const EMPTY: Self = Self {
        low: [f32::INFINITY; 2],
        high: [f32::NEG_INFINITY; 2],
        slowest: [f32::INFINITY; 2],
        fastest: [f32::NEG_INFINITY; 2],
    };

    /// Finds the depth down to which all rays stay above the surface.
    fn descend(&self, range: [f32; 2], map: &PyramidField<'_>) -> TileEntry {
        let pyramid = map.pyramid;
        let [low, step] = pyramid.quantization();
        let slack = pyramid.slack();
        let [floor, lid] = range.map(|h| 1.0 - h);
        let speed = (0..2).map(|k| self.slowest[k].abs().max(self.fastest[k].abs())).fold(0.0, f32::max);
        let width = (0..2).map(|k| self.high[k] - self.low[k]).fold(0.0, f32::max);
        let top = pyramid.top();
        // Blocks much smaller than the beam cost more than they gain.
        let finest = match width {
            w if w < 12.0 => 1,
            w if w < 48.0 => 2,
            _ => 3,
        }
        .min(top);
        let mut level = pyramid.start_level(speed * pyramid.clearance()).max(finest).min(top);
        let mut entry = TileEntry { depth: lid, fetches: 0 };
        for _ in 0..MAX_STEPS {
            let block = (1u32 << (BITS * (level - 1))) as f32;
            let end = (entry.depth + 2.0 * block / speed).min(floor);
            let Some((highest, fetches)) = self.highest(map, level, entry.depth, end) else { break };
            entry.fetches += fetches;
            // Above everything in the box until here.
            let free = 1.0 - (low + f32::from(highest) * step) - slack;
            if free >= end {
                entry.depth = end;
                level = (level + 1).min(top);
            } else {
                let half = 0.5 * (entry.depth + end);
                entry.depth = entry.depth.max(free);
                if free > half {
                    continue;
                }
                if level <= finest {
                    break;
                }
                level -= 1;
            }
            if entry.depth >= floor {
                break;
            }
        }
        entry
    }

    /// Returns the greatest quantized height of the blocks that the beam crosses between two depths, and the number of nodes
    /// they are in; `None` if there are too many.
    fn highest(&self, map: &PyramidField<'_>, level: u32, start: f32, end: f32) -> Option<(u8, u32)> {
        let axis = |k: usize| {
            let first = self.low[k] + (self.slowest[k] * start).min(self.slowest[k] * end);
            let last = self.high[k] + (self.fastest[k] * start).max(self.fastest[k] * end);
            // Rounding may have moved the rays themselves.
            let margin = 1e-3 + 4.0 * f32::EPSILON * first.abs().max(last.abs());
            [(first - margin).floor_int(), (last + margin).floor_int()]
        };
        highest_in(map, level, [axis(0), axis(1)])
    }
}
