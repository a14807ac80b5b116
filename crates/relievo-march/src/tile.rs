//! The look-ahead for a tile of neighbouring rays: the depth down to which all of them stay above the surface.

use relievo_map::Wrap;

use crate::grid_line::texel_coordinate;
use crate::pyramid::{BITS, Node, PyramidField, PyramidLevel, child_index};
use crate::real::Real;
use crate::wrapped_axis::{CLAMP, MIRROR, NEVER, REPEAT, WrappedAxis};
use crate::{HeightField, MarchOptions, Ray};

/// The most steps: more are not worth their fetches.
const MAX_STEPS: u32 = 64;

/// The most blocks along one axis that a step may look at.
const MAX_BLOCKS: usize = 16;

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
            let (at, d) = (texel_coordinate(uv[k], size[k]), slope[k] * size[k]);
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
        let bit_shift = BITS * (level - 1);
        let axis = |k: usize| {
            let first = self.low[k] + (self.slowest[k] * start).min(self.slowest[k] * end);
            let last = self.high[k] + (self.fastest[k] * start).max(self.fastest[k] * end);
            // Rounding may have moved the rays themselves.
            let margin = 1e-3 + 4.0 * f32::EPSILON * first.abs().max(last.abs());
            [(first - margin).floor_int(), (last + margin).floor_int()]
        };
        let cells = [axis(0), axis(1)];
        if let Some([columns, rows]) = inside(map, cells) {
            let blocks = |[first, last]: [u32; 2]| [first >> bit_shift, last >> bit_shift];
            let (columns, rows) = (blocks(columns), blocks(rows));
            if (columns[1] - columns[0]).max(rows[1] - rows[0]) >= MAX_BLOCKS as u32 {
                return None;
            }
            return Some(highest_inside(map.pyramid.level(level), columns, rows));
        }
        let blocks = |k: usize| Blocks::touched(map, k, bit_shift, cells[k][0], cells[k][1]);
        let (columns, rows) = (blocks(0)?, blocks(1)?);
        let mut highest = 0;
        for &row in rows.list() {
            for &column in columns.list() {
                let node = map.node(level, [column >> BITS, row >> BITS]);
                highest = highest.max(node[child_index([column, row])]);
            }
        }
        Some((highest, columns.nodes() * rows.nodes()))
    }
}

/// Masks of a node's bytes in the columns (rows) from the first to the last of four: all bits set.
const COLUMNS: [[Node; 4]; 4] = masks(1);
const ROWS: [[Node; 4]; 4] = masks(4);

const fn masks(pitch: usize) -> [[Node; 4]; 4] {
    let mut masks = [[[0; 16]; 4]; 4];
    let mut i = 0;
    while i < 256 {
        let (first, last, k) = (i / 64, i / 16 % 4, i % 16);
        let child = k / pitch % 4;
        if first <= child && child <= last {
            masks[first][last][k] = u8::MAX;
        }
        i += 1;
    }
    masks
}

/// Returns the greatest quantized height of the blocks in these columns and rows (first and last), and the number of nodes
/// they are in.
fn highest_inside(level: PyramidLevel<'_>, [left, right]: [u32; 2], [top, bottom]: [u32; 2]) -> (u8, u32) {
    let nodes = |[first, last]: [u32; 2]| (first >> BITS)..=(last >> BITS);
    let within = |node: u32, [first, last]: [u32; 2]| {
        let start = node << BITS;
        [first.max(start) - start, last.min(start + 3) - start].map(|k| k as usize & 3)
    };
    let width = level.size()[0];
    let (mut highest, mut count) = ([0; 16], 0);
    for y in nodes([top, bottom]) {
        let [first, last] = within(y, [top, bottom]);
        let rows = &ROWS[first][last];
        for x in nodes([left, right]) {
            let [first, last] = within(x, [left, right]);
            let columns = &COLUMNS[first][last];
            let node = &level.nodes()[(y * width + x) as usize];
            for k in 0..16 {
                highest[k] = highest[k].max(node[k] & columns[k] & rows[k]);
            }
            count += 1;
        }
    }
    (highest.into_iter().fold(0, u8::max), count)
}

/// Returns the first and last cells along both axes in the map, if they do not go over its border: most do not.
fn inside(map: &PyramidField<'_>, cells: [[i32; 2]; 2]) -> Option<[[u32; 2]; 2]> {
    let mut inside = [[0; 2]; 2];
    for k in 0..2 {
        let n = map.pyramid.size()[k] as i32;
        let [mut first, mut last] = cells[k];
        if map.wrap == Wrap::Repeat && (first < 0 || last >= n) {
            let tile = first.div_euclid(n).wrapping_mul(n);
            (first, last) = (first.wrapping_sub(tile), last.wrapping_sub(tile));
        }
        if first < 0 || last < first || last >= n {
            return None;
        }
        inside[k] = [first as u32, last as u32];
    }
    Some(inside)
}

/// The blocks along one axis that a stretch of cells touches, in order.
struct Blocks {
    list: [u32; MAX_BLOCKS],
    count: usize,
}

impl Blocks {
    /// Lists the blocks of 2^`bit_shift` cells from the first to the last cell; `None` if they are too many.
    fn touched(map: &PyramidField<'_>, k: usize, bit_shift: u32, first: i32, last: i32) -> Option<Self> {
        let n = map.pyramid.size()[k] as i32;
        match map.wrap {
            Wrap::Repeat => Self::along(WrappedAxis::<REPEAT> { n }, bit_shift, first, last),
            Wrap::Clamp => Self::along(WrappedAxis::<CLAMP> { n }, bit_shift, first, last),
            Wrap::Mirror => Self::along(WrappedAxis::<MIRROR> { n }, bit_shift, first, last),
        }
    }

    fn along<const WRAP: u8>(axis: WrappedAxis<WRAP>, bit_shift: u32, first: i32, last: i32) -> Option<Self> {
        let mut blocks = Self { list: [0; MAX_BLOCKS], count: 0 };
        let mut at = axis.at(0, first);
        while at.cell <= last {
            *blocks.list.get_mut(blocks.count)? = axis.map_index(at) >> bit_shift;
            blocks.count += 1;
            match axis.cells_to_exit(at, 1, bit_shift) {
                NEVER => break,
                cells => at = axis.advanced(at, 1, cells),
            }
        }
        Some(blocks)
    }

    fn list(&self) -> &[u32] {
        &self.list[..self.count]
    }

    /// Counts the nodes that hold them.
    fn nodes(&self) -> u32 {
        let changes = self.list().windows(2).filter(|pair| pair[0] >> BITS != pair[1] >> BITS).count();
        changes as u32 + 1
    }
}
