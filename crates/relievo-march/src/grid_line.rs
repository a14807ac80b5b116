//! A line over the grid of cells: the one set-up of the plain walk, the pyramid's and the cones' marches, and the packets'.

use std::ops::{Mul, Sub};

use crate::real::Real;

/// A line through the relief: `uv(s) = uv + slope·s` at the height `height + dheight_ds·s`.
pub(crate) struct Line<F> {
    pub(crate) uv: [F; 2],
    pub(crate) slope: [F; 2],
    pub(crate) height: F,
    pub(crate) dheight_ds: F,
}

/// The distance of the first cell's lower corner from uv 0, in texels, where cells lie between texel centres: in every field
/// with a pyramid.
pub(crate) const TEXEL_CENTER: f32 = 0.5;

/// Converts a texture coordinate, in repeats, to cells: cell i lies between i and i + 1, the first one begins `texel_offset`
/// texels from uv 0. For one number or many lanes.
#[inline]
pub(crate) fn texel_coordinate<T, N>(uv: T, texels: N, texel_offset: f32) -> T
where
    T: Mul<N, Output = T> + Sub<N, Output = T>,
    N: From<f32>,
{
    uv * texels - N::from(texel_offset)
}

/// Returns a position along one axis relative to its cell, in [0, 1].
#[inline(always)]
pub(crate) fn inside_cell<F: Real>(position: F, cell: i32) -> F {
    (position - F::int(cell)).max(F::zero()).min(F::one())
}

/// A line over the cells of a map.
///
/// Cells are counted from the one the line starts in, so that no precision is lost far from the texture's origin.
#[derive(Clone, Copy)]
pub(crate) struct GridLine<F> {
    /// The cell that the line starts in.
    pub(crate) base: [i32; 2],
    /// The start inside that cell, in texels.
    pub(crate) local: [F; 2],
    /// Texels per unit of s.
    pub(crate) d: [F; 2],
    /// +1 or −1: the direction from cell to cell.
    pub(crate) step: [i32; 2],
    /// 1 if the line leaves a cell by its upper border, else 0.
    pub(crate) border_offset: [i32; 2],
    /// s per texel; infinite if the line does not move along the axis.
    inv_d: [F; 2],
}

impl<F: Real> GridLine<F> {
    /// Sets up the line over a map of this size, whose first cell begins this many texels from uv 0.
    #[inline]
    pub(crate) fn new(size: [u32; 2], texel_offset: f32, line: &Line<F>) -> Self {
        let zero = F::zero();
        let size = size.map(|n| F::int(n as i32));
        let origin = [0, 1].map(|k| texel_coordinate(line.uv[k], size[k], texel_offset));
        let base = origin.map(Real::floor_int);
        let d = [line.slope[0] * size[0], line.slope[1] * size[1]];
        Self {
            base,
            local: [origin[0] - F::int(base[0]), origin[1] - F::int(base[1])],
            d,
            step: d.map(|d| if d > zero { 1 } else { -1 }),
            border_offset: d.map(|d| i32::from(d > zero)),
            inv_d: d.map(|d| if d == zero { F::infinity() } else { F::one() / d }),
        }
    }

    /// Returns the position at s, in texels from the base cell.
    #[inline]
    pub(crate) fn position(&self, s: F) -> [F; 2] {
        [self.local[0] + self.d[0] * s, self.local[1] + self.d[1] * s]
    }

    /// Returns the s at which the line crosses a border between columns (rows), for a line that moves along the axis.
    /// Computed anew for each border: no drift.
    #[inline]
    pub(crate) fn t_at_edge(&self, edge: i32, k: usize) -> F {
        (F::int(edge) - self.local[k]) * self.inv_d[k]
    }

    /// Returns the s at which the line leaves column (row) `cell` for the next one.
    #[inline]
    pub(crate) fn t_at_border(&self, cell: i32, k: usize) -> F {
        if self.d[k] == F::zero() { F::infinity() } else { self.t_at_edge(cell.wrapping_add(self.border_offset[k]), k) }
    }

    /// Returns the coordinate of the border by which the line came into column (row) `cell`.
    #[inline]
    pub(crate) fn entry_edge(&self, cell: i32, k: usize) -> F {
        F::int(cell.wrapping_sub(self.step[k]).wrapping_add(self.border_offset[k]))
    }

    /// Returns the map's column and row of a cell, any of the endless ones.
    #[inline]
    pub(crate) fn map_cell(&self, cell: [i32; 2]) -> [i32; 2] {
        [self.base[0].wrapping_add(cell[0]), self.base[1].wrapping_add(cell[1])]
    }
}
