//! The operations that steps can have.

use super::erosion::Erosion;
use super::formula::Expr;
use crate::noise::Fractal;
use crate::pattern::Masonry;

/// The operation of a step, with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Operation {
    /// Noise, moved by the inputs (none, or along u and v) times `warp`.
    Noise { fractal: Fractal, warp: f32 },
    /// Voronoi cells around relaxed random sites.
    Cells { count: u32, relax: u32, warp: f32, seed: u32 },
    /// Regular hexagons.
    Hexagons { columns: u32, rows: u32, warp: f32, seed: u32 },
    /// Bricks, tiles, boards.
    Bricks { masonry: Masonry, warp: f32 },
    /// One shape per cell of a grid.
    Shape(Shape),
    /// A formula of the inputs.
    Formula(Expr),
    /// A colour for every number: stops and colours, by rising stop.
    Gradient(Vec<(f32, [f32; 3])>),
    /// A Gaussian blur of the standard deviation.
    Blur(f32),
    /// The first input, looked up where the others, times `amount`, point to.
    Warp(f32),
    /// Ambient occlusion of the input, at a height scale: 1 open, 0 closed.
    Occlusion(f32),
    /// Hydraulic erosion.
    Erode(Erosion),
}

/// One shape per cell of a grid.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Shape {
    pub(super) kind: ShapeKind,
    pub(super) columns: u32,
    pub(super) rows: u32,
    pub(super) stagger: f32,
    /// From the middle of the cell, in uv.
    pub(super) offset: [f32; 2],
    pub(super) angle: f32,
    pub(super) round: f32,
    pub(super) warp: f32,
    pub(super) seed: u32,
}

/// Lengths in uv.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ShapeKind {
    Circle { radius: f32 },
    Rectangle { half: [f32; 2] },
    Polygon { radius: f32, sides: u32 },
    Star { radius: f32, inner: f32, points: u32 },
    Line { half_length: f32, radius: f32 },
}

const VALUE: &[&str] = &["value"];
const CELL: &[&str] = &["edge", "random", "random2", "random3", "x", "y", "distance", "border"];
const BRICK: &[&str] = &["edge", "random", "random2", "random3", "along", "across", "x", "y", "stands"];
const SHAPE: &[&str] = &["distance", "random", "random2", "random3", "x", "y"];
const ERODED: &[&str] = &["height", "flow"];

impl Operation {
    /// True if the outputs change in the course of the loop, beside the inputs.
    pub(super) fn is_animated(&self) -> bool {
        match self {
            Self::Noise { fractal, .. } => fractal.noise.time_cells > 0,
            Self::Formula(expr) => expr.is_animated(),
            _ => false,
        }
    }

    /// Returns the names of the outputs; the first is the default.
    pub(super) fn ports(&self) -> &'static [&'static str] {
        match self {
            Self::Cells { .. } | Self::Hexagons { .. } => CELL,
            Self::Bricks { .. } => BRICK,
            Self::Shape(_) => SHAPE,
            Self::Erode(_) => ERODED,
            _ => VALUE,
        }
    }

    /// True if the output is a colour, given which inputs are.
    pub(super) fn is_color(&self, inputs: &[bool]) -> bool {
        match self {
            Self::Formula(expr) => expr.is_color(inputs),
            Self::Gradient(_) => true,
            Self::Blur(_) | Self::Warp(_) => inputs[0],
            _ => false,
        }
    }
}
