//! Ways of rays over the grid of cells, as the march through the pyramid follows them.

use super::visited_cell::VisitedCell;
use crate::grid_line::{GridLine, Line, TEXEL_CENTER, inside_cell};
use crate::patch::patch_crossing;
use crate::pyramid::{MaxPyramid, SLACK};

/// A way over the cells of a map, along which each coordinate rises or falls all the way.
pub(crate) trait Path {
    /// Returns the cell that it starts in, counted from uv 0.
    fn base(&self) -> [i32; 2];
    /// Returns +1 or −1: the direction from cell to cell.
    fn step(&self) -> [i32; 2];
    /// Returns the position at s, in texels from the base cell.
    fn position(&self, s: f32) -> [f32; 2];
    /// Returns the s at which it crosses a border between columns (rows); infinite if it does not.
    fn crossing(&self, edge: i32, k: usize) -> f32;
    /// Returns the height at s.
    fn height(&self, s: f32) -> f32;
    /// Returns texels per unit of s, about.
    fn speed(&self) -> f32;
    /// Returns a lower bound of the height between two places in the pyramid's quantization steps, with the slack off.
    fn lowest(&self, s: f32, t_exit: f32) -> f32;
    /// Returns the distance beyond `s` at which it meets the patch over the corners of a cell, which it enters at `inside` in
    /// [0, 1]² and leaves at `t_exit`.
    fn patch(&self, corners: [f32; 4], cell: [i32; 2], inside: [f32; 2], s: f32, t_exit: f32) -> Option<f32>;
}

/// A cell near the surface with the part of a way that lies in it.
pub(super) struct NearCell {
    /// Heights h00, h10, h01, h11.
    pub(super) corners: [f32; 4],
    /// The position at which the way enters, and the cell, in texels from the base cell.
    pub(super) entry: [f32; 2],
    pub(super) cell: [i32; 2],
    /// The s at which the way enters and leaves.
    pub(super) s: f32,
    pub(super) t_exit: f32,
}

impl NearCell {
    /// Returns the entry in the cell, in [0, 1]².
    #[inline(always)]
    pub(super) fn inside(&self) -> [f32; 2] {
        [inside_cell(self.entry[0], self.cell[0]), inside_cell(self.entry[1], self.cell[1])]
    }
}

/// Heights in the pyramid's quantization steps.
#[derive(Clone, Copy)]
pub(crate) struct Quantization {
    low: f32,
    per_step: f32,
    slack: f32,
}

impl Quantization {
    #[inline]
    pub(crate) fn new(pyramid: &MaxPyramid) -> Self {
        let [low, step] = pyramid.quantization();
        let per_step = 1.0 / step;
        Self { low, per_step, slack: SLACK + 4.0 * f32::EPSILON * per_step }
    }

    /// Converts a height, with the slack off.
    #[inline]
    pub(crate) fn of(&self, height: f32) -> f32 {
        (height - self.low) * self.per_step - self.slack
    }
}

/// The way of a straight ray.
#[derive(Clone, Copy)]
pub(crate) struct LinePath<'a> {
    grid: GridLine<f32>,
    line: &'a Line<f32>,
    sinks: bool,
    /// Its height in quantization steps, at s = 0 and per unit of s.
    quantized: [f32; 2],
}

impl<'a> LinePath<'a> {
    #[inline]
    pub(crate) fn new(pyramid: &MaxPyramid, line: &'a Line<f32>) -> Self {
        let quantization = Quantization::new(pyramid);
        Self {
            grid: GridLine::new(pyramid.size(), TEXEL_CENTER, line),
            line,
            sinks: line.dheight_ds < 0.0,
            quantized: [quantization.of(line.height), line.dheight_ds * quantization.per_step],
        }
    }

    /// Returns a cell that it passes through.
    #[inline(always)]
    pub(super) fn visited(&self, cell: &NearCell) -> VisitedCell<f32> {
        let NearCell { corners, entry, cell, s, t_exit } = *cell;
        let lowest = self.height(self.lowest_at(s, t_exit));
        VisitedCell { corners, lowest, entry, cell, d: self.grid.d, s, t_exit }
    }

    #[inline]
    fn lowest_at(&self, s: f32, t_exit: f32) -> f32 {
        if self.sinks { t_exit } else { s }
    }
}

impl Path for LinePath<'_> {
    #[inline(always)]
    fn base(&self) -> [i32; 2] {
        self.grid.base
    }

    #[inline(always)]
    fn step(&self) -> [i32; 2] {
        self.grid.step
    }

    #[inline(always)]
    fn position(&self, s: f32) -> [f32; 2] {
        self.grid.position(s)
    }

    #[inline(always)]
    fn crossing(&self, edge: i32, k: usize) -> f32 {
        if self.grid.d[k] == 0.0 { f32::INFINITY } else { self.grid.t_at_edge(edge, k) }
    }

    #[inline(always)]
    fn height(&self, s: f32) -> f32 {
        self.line.height + self.line.dheight_ds * s
    }

    #[inline(always)]
    fn speed(&self) -> f32 {
        let d = self.grid.d;
        (d[0] * d[0] + d[1] * d[1]).sqrt()
    }

    #[inline(always)]
    fn lowest(&self, s: f32, t_exit: f32) -> f32 {
        self.quantized[0] + self.quantized[1] * self.lowest_at(s, t_exit)
    }

    #[inline(always)]
    fn patch(&self, corners: [f32; 4], _: [i32; 2], inside: [f32; 2], s: f32, t_exit: f32) -> Option<f32> {
        let lowest = self.height(self.lowest_at(s, t_exit));
        if lowest <= corners[0].max(corners[1]).max(corners[2].max(corners[3])) {
            patch_crossing(corners, inside, self.grid.d, self.line, s, t_exit - s)
        } else {
            None
        }
    }
}
