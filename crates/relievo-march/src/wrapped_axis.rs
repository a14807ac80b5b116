//! One axis of a map with an addressing mode: the cells of the endless row, and the cells of the map that they show.

/// A cell of the endless row along one axis, with its place in the map.
#[derive(Clone, Copy)]
pub(crate) struct AxisCell {
    /// The cell, counted from the one the ray's line starts in.
    pub(crate) cell: i32,
    /// The same cell in the map: 0..n; one less is the cell before the first texel (clamped, mirrored). Clamped, all beyond.
    index: i32,
    /// −1 where the map stands mirrored, else 1.
    mirror_sign: i32,
}

/// More cells than any ray crosses: a block that goes on for ever.
pub(crate) const NEVER: i32 = 1 << 30;

/// The cells of a map along one axis, continued for ever; the wrap mode is a constant, so that loops have one each.
#[derive(Clone, Copy)]
pub(crate) struct WrappedAxis<const WRAP: u8> {
    /// Cells in the map.
    pub(crate) n: i32,
}

pub(crate) const REPEAT: u8 = 0;
pub(crate) const CLAMP: u8 = 1;
pub(crate) const MIRROR: u8 = 2;

impl<const WRAP: u8> WrappedAxis<WRAP> {
    /// Places a cell, counted from the cell `base`.
    #[inline(always)]
    pub(crate) fn at(self, base: i32, cell: i32) -> AxisCell {
        let (i, n) = (base.wrapping_add(cell), self.n);
        let (index, mirror_sign) = match WRAP {
            REPEAT if (i as u32) < n as u32 => (i, 1),
            REPEAT => (i.rem_euclid(n), 1),
            CLAMP => (i, 1),
            _ => {
                let k = i.wrapping_add(1).rem_euclid(2 * n);
                if k <= n { (k - 1, 1) } else { (2 * n - 1 - k, -1) }
            }
        };
        AxisCell { cell, index, mirror_sign }
    }

    /// Returns the cell of the map whose maximum stands for this one.
    #[inline(always)]
    pub(crate) fn map_index(self, at: AxisCell) -> u32 {
        if WRAP == REPEAT { at.index as u32 } else { at.index.max(0).min(self.n - 1) as u32 }
    }

    /// Returns the number of cells that a ray going by `step` (±1) enters until it is beyond its block of 2^`bit_shift` cells,
    /// or [`NEVER`].
    #[inline(always)]
    pub(crate) fn cells_to_exit(self, at: AxisCell, step: i32, bit_shift: u32) -> i32 {
        let (index, rest) = (at.index, (1 << bit_shift) - 1);
        let map_index = self.map_index(at) as i32;
        let (beyond, first) = (((map_index | rest) + 1).min(self.n), map_index & !rest);
        let [up, down] = match WRAP {
            REPEAT => [beyond - index, index - first + 1],
            // The first block has all cells before it, and the last all behind.
            CLAMP => [
                if bit_shift == 0 && index < 0 {
                    -index
                } else if beyond == self.n {
                    NEVER
                } else {
                    beyond - index
                },
                if first > 0 || (bit_shift == 0 && index >= 0) { index - first + 1 } else { NEVER },
            ],
            _ if bit_shift == 0 => [1, 1],
            // The first block has the cell before it.
            _ => [beyond - index, if first > 0 { index - first + 1 } else { index + 2 }],
        };
        if step * at.mirror_sign > 0 { up } else { down }
    }

    /// Goes on by this many cells, at most to the first one beyond the block.
    #[inline(always)]
    pub(crate) fn advanced(self, at: AxisCell, step: i32, cells: i32) -> AxisCell {
        let n = self.n;
        let cell = at.cell.wrapping_add(step * cells);
        let index = at.index + step * at.mirror_sign * cells;
        let (index, mirror_sign) = match WRAP {
            REPEAT => (
                if index == n {
                    0
                } else if index < 0 {
                    n - 1
                } else {
                    index
                },
                1,
            ),
            CLAMP => (index, 1),
            _ if index == n => (n - 2, -at.mirror_sign),
            _ if index == -2 => (0, -at.mirror_sign),
            _ => (index, at.mirror_sign),
        };
        AxisCell { cell, index, mirror_sign }
    }

    /// Returns the texels on both sides of the cell, in the order in which the endless row has them.
    #[inline(always)]
    pub(crate) fn texels(self, at: AxisCell) -> [usize; 2] {
        let last = self.n - 1;
        let first = self.map_index(at) as usize;
        let second = match at.index + 1 {
            after if after > last => {
                if WRAP == REPEAT {
                    0
                } else {
                    last
                }
            }
            after => after.max(0),
        } as usize;
        if at.mirror_sign > 0 { [first, second] } else { [second, first] }
    }
}
