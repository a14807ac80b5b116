//! The highest block in a region of cells.

use relievo_map::Wrap;

use super::{BITS, Node, PyramidField, PyramidLevel, child_index};
use crate::wrapped_axis::{CLAMP, MIRROR, NEVER, REPEAT, WrappedAxis};

/// The most blocks along an axis that are looked at.
const MAX_BLOCKS: usize = 16;

/// Returns the greatest quantized height of the blocks of a level that hold these cells (first and last along both axes, any
/// of the endless grid), and the number of nodes they are in; `None` if there are too many.
pub(crate) fn highest_in(map: &PyramidField<'_>, level: u32, cells: [[i32; 2]; 2]) -> Option<(u8, u32)> {
    let bit_shift = BITS * (level - 1);
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
