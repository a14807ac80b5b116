//! The operations that steps can have: their parameters and what they put out.

use super::RecipeError;
use super::params::Params;
use crate::basis::{Basis, Noise};
use crate::erosion::Erosion;
use crate::formula::{self, Expr};
use crate::fractal::{Fractal, FractalKind};
use crate::masonry::{Bond, Masonry};
use crate::noise::hash3;
use relievo_toml::{did_you_mean, shorten};

/// What a step does.
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
    /// How open the input is, at a height scale.
    Occlusion(f32),
    /// Rain.
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

/// The names of all operations.
pub(super) const NAMES: [&str; 11] =
    ["noise", "cells", "hexagons", "bricks", "shape", "formula", "gradient", "blur", "warp", "occlusion", "erode"];

const VALUE: &[&str] = &["value"];
const CELL: &[&str] = &["edge", "random", "random2", "random3", "x", "y", "distance", "border"];
const BRICK: &[&str] = &["edge", "random", "random2", "random3", "along", "across", "x", "y", "stands"];
const SHAPE: &[&str] = &["distance", "random", "random2", "random3", "x", "y"];
const ERODED: &[&str] = &["height", "flow"];

impl Operation {
    /// The names of its outputs; the first is meant where none is named.
    pub(super) fn ports(&self) -> &'static [&'static str] {
        match self {
            Self::Cells { .. } | Self::Hexagons { .. } => CELL,
            Self::Bricks { .. } => BRICK,
            Self::Shape(_) => SHAPE,
            Self::Erode(_) => ERODED,
            _ => VALUE,
        }
    }

    /// Whether it puts out colours, given which inputs are.
    pub(super) fn is_color(&self, inputs: &[bool]) -> bool {
        match self {
            Self::Formula(expr) => expr.is_color(inputs),
            Self::Gradient(_) => true,
            Self::Blur(_) | Self::Warp(_) => inputs[0],
            _ => false,
        }
    }
}

/// An input as it is written: the name, the line, and whether a colour will do.
pub(super) struct Wish {
    pub(super) name: String,
    pub(super) line: usize,
    pub(super) color: bool,
}

/// Reads the operation of the step `name`; `seed` is the recipe's.
pub(super) fn read(params: &mut Params<'_>, name: &str, seed: u32) -> Result<(Operation, Vec<Wish>), RecipeError> {
    let Some((op, line)) = params.text("op")? else {
        return Err(params.missing("op", &format!("one of {}", NAMES.join(", "))));
    };
    let mut inputs = Vec::new();
    let operation = match op {
        "noise" => {
            let [columns, rows] = params.two_integers("cells", 8, 1, 4096)?;
            let noise = Noise {
                basis: params.choice("basis", &Basis::ALL, Basis::Perlin)?,
                columns,
                rows,
                seed: step_seed(params, name, seed)?,
            };
            let fractal = Fractal {
                noise,
                kind: params.choice("fractal", &FractalKind::ALL, FractalKind::Fbm)?,
                octaves: params.integer("octaves", 1, 1, Fractal::MAX_OCTAVES)?,
                gain: params.number("gain", 0.5, 0.0, 1.0)?,
            };
            Operation::Noise { fractal, warp: warp(params, &mut inputs)? }
        }
        "cells" => Operation::Cells {
            count: params.integer("count", 40, 1, 20_000)?,
            relax: params.integer("relax", 3, 0, 100)?,
            seed: step_seed(params, name, seed)?,
            warp: warp(params, &mut inputs)?,
        },
        "hexagons" => Operation::Hexagons {
            columns: params.integer("columns", 6, 1, 256)?,
            rows: even(params, "rows", 8)?,
            seed: step_seed(params, name, seed)?,
            warp: warp(params, &mut inputs)?,
        },
        "bricks" => {
            let masonry = masonry(params, name, seed)?;
            Operation::Bricks { masonry, warp: warp(params, &mut inputs)? }
        }
        "shape" => Operation::Shape(shape(params, name, seed, &mut inputs)?),
        "formula" => {
            let Some((text, line)) = params.text("formula")? else {
                return Err(params.missing("formula", "as in formula = \"0.5 + 0.5 * noise\""));
            };
            let expr = formula::parse(text, &mut |name| {
                Ok(inputs.iter().position(|wish: &Wish| wish.name == name).unwrap_or_else(|| {
                    inputs.push(Wish { name: name.to_owned(), line, color: true });
                    inputs.len() - 1
                }))
            });
            Operation::Formula(expr.map_err(|message| params.error(line, message))?)
        }
        "gradient" => {
            input(params, "input", false, &mut inputs)?;
            Operation::Gradient(stops(params)?)
        }
        "blur" => {
            input(params, "input", true, &mut inputs)?;
            Operation::Blur(params.number("radius", 0.01, 0.0, 0.5)?)
        }
        "warp" => {
            input(params, "input", true, &mut inputs)?;
            pair(params, "by", &mut inputs)?;
            if inputs.len() == 1 {
                return Err(params.missing("by", "two steps, as in by = [\"a\", \"b\"]"));
            }
            Operation::Warp(params.number("amount", 0.01, -10.0, 10.0)?)
        }
        "occlusion" => {
            input(params, "input", false, &mut inputs)?;
            Operation::Occlusion(params.number("height_scale", 0.05, 0.0, 10.0)?)
        }
        "erode" => {
            input(params, "input", false, &mut inputs)?;
            Operation::Erode(Erosion {
                drops: params.integer("drops", 60_000, 0, 1_000_000)?,
                relief: params.number("relief", 0.15, 0.001, 10.0)?,
                strength: params.number("strength", 0.3, 0.0, 1.0)?,
                seed: step_seed(params, name, seed)?,
            })
        }
        _ => {
            let near = did_you_mean(op, NAMES);
            let message = format!("op = \"{}\" is not known{near}; expected one of {}", shorten(op), NAMES.join(", "));
            return Err(params.error(line, message));
        }
    };
    Ok((operation, inputs))
}

/// What makes this step's chance its own: the recipe's seed, and the step's own or its name.
fn step_seed(params: &mut Params<'_>, name: &str, seed: u32) -> Result<u32, RecipeError> {
    // FNV-1a.
    let named = name.bytes().fold(0x811c_9dc5u32, |h, b| (h ^ u32::from(b)).wrapping_mul(0x0100_0193));
    let own = params.integer("seed", u32::MAX, 0, u32::MAX)?;
    Ok(hash3(seed, if own == u32::MAX { named } else { own }, 0x5eed)[0])
}

fn input(params: &mut Params<'_>, key: &'static str, color: bool, inputs: &mut Vec<Wish>) -> Result<(), RecipeError> {
    let Some((name, line)) = params.text(key)? else {
        return Err(params.missing(key, "the name of a step"));
    };
    inputs.push(Wish { name: name.to_owned(), line, color });
    Ok(())
}

fn pair(params: &mut Params<'_>, key: &'static str, inputs: &mut Vec<Wish>) -> Result<(), RecipeError> {
    for (name, line) in params.texts(key, 2)?.unwrap_or_default() {
        inputs.push(Wish { name: name.to_owned(), line, color: false });
    }
    Ok(())
}

/// `warp = ["a", "b"]`, and how far.
fn warp(params: &mut Params<'_>, inputs: &mut Vec<Wish>) -> Result<f32, RecipeError> {
    pair(params, "warp", inputs)?;
    params.number("warp_amount", 0.01, -1000.0, 1000.0)
}

fn even(params: &mut Params<'_>, key: &'static str, default: u32) -> Result<u32, RecipeError> {
    let number = params.integer(key, default, 2, 256)?;
    if number.is_multiple_of(2) {
        return Ok(number);
    }
    let line = params.get(key).map_or(params.line, |node| node.at.line());
    Err(params.error(line, format!("{key} must be even, so that the pattern closes, found {number}")))
}

fn masonry(params: &mut Params<'_>, name: &str, seed: u32) -> Result<Masonry, RecipeError> {
    let masonry = Masonry {
        bond: params.choice("bond", &Bond::ALL, Bond::Running)?,
        columns: params.integer("columns", 4, 1, 500)?,
        rows: params.integer("rows", 8, 1, 500)?,
        joint: params.number("joint", 0.012, 0.0, 0.5)?,
        corner: params.number("corner", 0.004, 0.0, 0.5)?,
        shift: params.number("shift", 0.0, 0.0, 0.1)?,
        uneven: params.number("uneven", 0.0, 0.0, 0.1)?,
        turn: params.number("turn", 0.0, 0.0, 0.2)?,
        seed: step_seed(params, name, seed)?,
    };
    for (key, number, period) in
        [("columns", masonry.columns, masonry.bond.period()[0]), ("rows", masonry.rows, masonry.bond.period()[1])]
    {
        if !number.is_multiple_of(period) {
            let line = params.get(key).map_or(params.line, |node| node.at.line());
            let message = format!(
                "{key} must be a multiple of {period} in this bond, so that the pattern closes, found {number}"
            );
            return Err(params.error(line, message));
        }
    }
    Ok(masonry)
}

#[derive(Clone, Copy)]
enum Outline {
    Circle,
    Rectangle,
    Polygon,
    Star,
    Line,
}

fn shape(params: &mut Params<'_>, name: &str, seed: u32, inputs: &mut Vec<Wish>) -> Result<Shape, RecipeError> {
    const OUTLINES: [(&str, Outline); 5] = [
        ("circle", Outline::Circle),
        ("rectangle", Outline::Rectangle),
        ("polygon", Outline::Polygon),
        ("star", Outline::Star),
        ("line", Outline::Line),
    ];
    let kind = match params.choice("shape", &OUTLINES, Outline::Circle)? {
        Outline::Circle => ShapeKind::Circle { radius: params.number("radius", 0.05, 0.0, 1.0)? },
        Outline::Rectangle => {
            let [w, h] = params.two_numbers("size", [0.1, 0.1], 0.0, 2.0)?;
            ShapeKind::Rectangle { half: [0.5 * w, 0.5 * h] }
        }
        Outline::Polygon => ShapeKind::Polygon {
            radius: params.number("radius", 0.05, 0.0, 1.0)?,
            sides: params.integer("sides", 6, 3, 64)?,
        },
        Outline::Star => {
            let radius = params.number("radius", 0.05, 0.0, 1.0)?;
            ShapeKind::Star {
                radius,
                inner: params.number("inner", 0.4, 0.0, 1.0)? * radius,
                points: params.integer("points", 5, 3, 64)?,
            }
        }
        Outline::Line => ShapeKind::Line {
            half_length: 0.5 * params.number("length", 0.1, 0.0, 2.0)?,
            radius: 0.5 * params.number("width", 0.01, 0.0, 1.0)?,
        },
    };
    Ok(Shape {
        kind,
        columns: params.integer("columns", 1, 1, 500)?,
        rows: params.integer("rows", 1, 1, 500)?,
        stagger: params.number("stagger", 0.0, -1.0, 1.0)?,
        offset: params.two_numbers("offset", [0.0; 2], -1.0, 1.0)?,
        angle: params.number("angle", 0.0, -360.0, 360.0)?.to_radians(),
        round: params.number("round", 0.0, 0.0, 0.5)?,
        seed: step_seed(params, name, seed)?,
        warp: warp(params, inputs)?,
    })
}

/// `stops = [[0.0, "#203040"], …]`.
fn stops(params: &mut Params<'_>) -> Result<Vec<(f32, [f32; 3])>, RecipeError> {
    use relievo_toml::Value;
    const EXPECTED: &str = "two or more stops that rise, as in stops = [[0.0, \"#203040\"], [1.0, \"#e0d0c0\"]]";
    let Some(node) = params.get("stops") else { return Err(params.missing("stops", EXPECTED)) };
    let wrong = |line| params.error(line, format!("stops must be {EXPECTED}"));
    let Value::Array(items) = &node.value else { return Err(wrong(node.at.line())) };
    let mut stops: Vec<(f32, [f32; 3])> = Vec::new();
    for item in items {
        let Value::Array(pair) = &item.value else { return Err(wrong(item.at.line())) };
        let stop = match pair.as_slice() {
            [at, color] => match (at.value.number(), &color.value) {
                (Some(at), Value::String(text)) if at.is_finite() => {
                    text.strip_prefix('#').and_then(formula::color).map(|color| (at as f32, color))
                }
                _ => None,
            },
            _ => None,
        };
        match stop {
            Some(stop) if stops.last().is_none_or(|last| last.0 < stop.0) => stops.push(stop),
            _ => return Err(wrong(item.at.line())),
        }
    }
    if stops.len() < 2 { Err(wrong(node.at.line())) } else { Ok(stops) }
}
