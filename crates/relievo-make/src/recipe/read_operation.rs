//! The `op` of a step and its keys, read into an [`Operation`].

use relievo_toml::{Value, did_you_mean, shorten};

use super::erosion::Erosion;
use super::error::RecipeError;
use super::formula;
use super::operation::{Operation, Shape, ShapeKind};
use super::params::Params;
use crate::noise::{Basis, Fractal, FractalKind, Noise, hash3};
use crate::pattern::{Bond, Masonry};

/// An input as it is written in the recipe.
pub(super) struct InputRef {
    /// `STEP` or `STEP.PORT`.
    pub(super) name: String,
    pub(super) line: usize,
    /// True if the input may be a colour.
    pub(super) accepts_color: bool,
}

/// Reads the operation of the step `name` and its inputs; `seed` is the recipe's.
pub(super) fn read_operation(
    params: &mut Params<'_>,
    name: &str,
    seed: u32,
) -> Result<(Operation, Vec<InputRef>), RecipeError> {
    let names = || READERS.iter().map(|(name, _)| *name);
    let list = || names().collect::<Vec<_>>().join(", ");
    let Some((op, line)) = params.text("op")? else {
        return Err(params.missing("op", &format!("one of {}", list())));
    };
    let Some((_, read)) = READERS.iter().find(|(known, _)| *known == op) else {
        let near = did_you_mean(op, names());
        let message = format!("op = \"{}\" is not known{near}; expected one of {}", shorten(op), list());
        return Err(params.error(line, message));
    };
    let mut reader = OperationReader { params, name, seed, inputs: Vec::new() };
    let operation = read(&mut reader)?;
    Ok((operation, reader.inputs))
}

/// Reads the keys of one operation.
type Reader = fn(&mut OperationReader<'_, '_>) -> Result<Operation, RecipeError>;

/// Every operation: its name and its reader.
const READERS: [(&str, Reader); 11] = [
    ("noise", |reader| reader.noise()),
    ("cells", |reader| reader.cells()),
    ("hexagons", |reader| reader.hexagons()),
    ("bricks", |reader| reader.bricks()),
    ("shape", |reader| reader.shape()),
    ("formula", |reader| reader.formula()),
    ("gradient", |reader| reader.gradient()),
    ("blur", |reader| reader.blur()),
    ("warp", |reader| reader.warp()),
    ("occlusion", |reader| reader.occlusion()),
    ("erode", |reader| reader.erode()),
];

struct OperationReader<'p, 'a> {
    params: &'p mut Params<'a>,
    /// The step's name.
    name: &'p str,
    /// The recipe's seed.
    seed: u32,
    inputs: Vec<InputRef>,
}

impl OperationReader<'_, '_> {
    fn noise(&mut self) -> Result<Operation, RecipeError> {
        let [columns, rows] = self.params.two_integers("cells", 8, 1, 4096)?;
        let noise = Noise {
            basis: self.params.choice("basis", &Basis::ALL, Basis::Perlin)?,
            columns,
            rows,
            seed: self.step_seed()?,
            time_cells: self.time_cells()?,
        };
        let fractal = Fractal {
            noise,
            kind: self.params.choice("fractal", &FractalKind::ALL, FractalKind::Fbm)?,
            octaves: self.params.integer("octaves", 1, 1, Fractal::MAX_OCTAVES)?,
            gain: self.params.number("gain", 0.5, 0.0, 1.0)?,
        };
        Ok(Operation::Noise { fractal, warp: self.warp_amount()? })
    }

    /// `time_cells`: 0, or two or more, since what lies between a slice and itself would stand nearly still.
    fn time_cells(&mut self) -> Result<u32, RecipeError> {
        match self.params.integer("time_cells", 0, 0, 4096)? {
            1 => Err(self.error_at(
                "time_cells",
                "time_cells must be 0 (the noise stands still) or 2 to 4096, found 1".to_owned(),
            )),
            count => Ok(count),
        }
    }

    fn cells(&mut self) -> Result<Operation, RecipeError> {
        Ok(Operation::Cells {
            count: self.params.integer("count", 40, 1, 20_000)?,
            relax: self.params.integer("relax", 3, 0, 100)?,
            seed: self.step_seed()?,
            warp: self.warp_amount()?,
        })
    }

    fn hexagons(&mut self) -> Result<Operation, RecipeError> {
        Ok(Operation::Hexagons {
            columns: self.params.integer("columns", 6, 1, 256)?,
            rows: self.even("rows", 8)?,
            seed: self.step_seed()?,
            warp: self.warp_amount()?,
        })
    }

    fn bricks(&mut self) -> Result<Operation, RecipeError> {
        let masonry = self.masonry()?;
        Ok(Operation::Bricks { masonry, warp: self.warp_amount()? })
    }

    fn masonry(&mut self) -> Result<Masonry, RecipeError> {
        let masonry = Masonry {
            bond: self.params.choice("bond", &Bond::ALL, Bond::Running)?,
            columns: self.params.integer("columns", 4, 1, 500)?,
            rows: self.params.integer("rows", 8, 1, 500)?,
            joint: self.params.number("joint", 0.012, 0.0, 0.5)?,
            corner: self.params.number("corner", 0.004, 0.0, 0.5)?,
            position_jitter: self.params.number("shift", 0.0, 0.0, 0.1)?,
            size_jitter: self.params.number("uneven", 0.0, 0.0, 0.1)?,
            rotation_jitter: self.params.number("turn", 0.0, 0.0, 0.2)?,
            seed: self.step_seed()?,
        };
        let [columns, rows] = masonry.bond.period();
        for (key, number, period) in [("columns", masonry.columns, columns), ("rows", masonry.rows, rows)] {
            if !number.is_multiple_of(period) {
                let message = format!(
                    "{key} must be a multiple of {period} in this bond, so that the pattern closes, found {number}"
                );
                return Err(self.error_at(key, message));
            }
        }
        Ok(masonry)
    }

    fn shape(&mut self) -> Result<Operation, RecipeError> {
        let kind = self.shape_kind()?;
        Ok(Operation::Shape(Shape {
            kind,
            columns: self.params.integer("columns", 1, 1, 500)?,
            rows: self.params.integer("rows", 1, 1, 500)?,
            stagger: self.params.number("stagger", 0.0, -1.0, 1.0)?,
            offset: self.params.two_numbers("offset", [0.0; 2], -1.0, 1.0)?,
            angle: self.params.number("angle", 0.0, -360.0, 360.0)?.to_radians(),
            round: self.params.number("round", 0.0, 0.0, 0.5)?,
            seed: self.step_seed()?,
            warp: self.warp_amount()?,
        }))
    }

    fn shape_kind(&mut self) -> Result<ShapeKind, RecipeError> {
        const OUTLINES: [(&str, Outline); 5] = [
            ("circle", Outline::Circle),
            ("rectangle", Outline::Rectangle),
            ("polygon", Outline::Polygon),
            ("star", Outline::Star),
            ("line", Outline::Line),
        ];
        let params = &mut *self.params;
        Ok(match params.choice("shape", &OUTLINES, Outline::Circle)? {
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
        })
    }

    fn formula(&mut self) -> Result<Operation, RecipeError> {
        let Some((text, line)) = self.params.text("formula")? else {
            return Err(self.params.missing("formula", "as in formula = \"0.5 + 0.5 * noise\""));
        };
        let inputs = &mut self.inputs;
        let expr = formula::parse(text, &mut |name| {
            Ok(inputs.iter().position(|input: &InputRef| input.name == name).unwrap_or_else(|| {
                inputs.push(InputRef { name: name.to_owned(), line, accepts_color: true });
                inputs.len() - 1
            }))
        });
        Ok(Operation::Formula(expr.map_err(|message| self.params.error(line, message))?))
    }

    fn gradient(&mut self) -> Result<Operation, RecipeError> {
        self.input("input", false)?;
        Ok(Operation::Gradient(self.stops()?))
    }

    /// `stops = [[0.0, "#203040"], …]`.
    fn stops(&mut self) -> Result<Vec<(f32, [f32; 3])>, RecipeError> {
        const EXPECTED: &str = "two or more stops that rise, as in stops = [[0.0, \"#203040\"], [1.0, \"#e0d0c0\"]]";
        let Some(node) = self.params.get("stops") else { return Err(self.params.missing("stops", EXPECTED)) };
        let wrong = |line| self.params.error(line, format!("stops must be {EXPECTED}"));
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

    fn blur(&mut self) -> Result<Operation, RecipeError> {
        self.input("input", true)?;
        Ok(Operation::Blur(self.params.number("radius", 0.01, 0.0, 0.5)?))
    }

    fn warp(&mut self) -> Result<Operation, RecipeError> {
        self.input("input", true)?;
        self.pair("by")?;
        if self.inputs.len() == 1 {
            return Err(self.params.missing("by", "two steps, as in by = [\"a\", \"b\"]"));
        }
        Ok(Operation::Warp(self.params.number("amount", 0.01, -10.0, 10.0)?))
    }

    fn occlusion(&mut self) -> Result<Operation, RecipeError> {
        self.input("input", false)?;
        Ok(Operation::Occlusion(self.params.number("height_scale", 0.05, 0.0, 10.0)?))
    }

    fn erode(&mut self) -> Result<Operation, RecipeError> {
        self.input("input", false)?;
        Ok(Operation::Erode(Erosion {
            drops: self.params.integer("drops", 60_000, 0, 1_000_000)?,
            relief: self.params.number("relief", 0.15, 0.001, 10.0)?,
            strength: self.params.number("strength", 0.3, 0.0, 1.0)?,
            seed: self.step_seed()?,
        }))
    }

    /// Seed of this step: the recipe's, mixed with the step's own or a hash of its name.
    fn step_seed(&mut self) -> Result<u32, RecipeError> {
        // FNV-1a.
        let named = self.name.bytes().fold(0x811c_9dc5u32, |h, b| (h ^ u32::from(b)).wrapping_mul(0x0100_0193));
        let own = self.params.integer("seed", u32::MAX, 0, u32::MAX)?;
        Ok(hash3(self.seed, if own == u32::MAX { named } else { own }, 0x5eed)[0])
    }

    fn input(&mut self, key: &'static str, accepts_color: bool) -> Result<(), RecipeError> {
        let Some((name, line)) = self.params.text(key)? else {
            return Err(self.params.missing(key, "the name of a step"));
        };
        self.inputs.push(InputRef { name: name.to_owned(), line, accepts_color });
        Ok(())
    }

    fn pair(&mut self, key: &'static str) -> Result<(), RecipeError> {
        for (name, line) in self.params.texts(key, 2)?.unwrap_or_default() {
            self.inputs.push(InputRef { name: name.to_owned(), line, accepts_color: false });
        }
        Ok(())
    }

    /// `warp = ["a", "b"]` as two inputs, and `warp_amount`.
    fn warp_amount(&mut self) -> Result<f32, RecipeError> {
        self.pair("warp")?;
        self.params.number("warp_amount", 0.01, -1000.0, 1000.0)
    }

    fn even(&mut self, key: &'static str, default: u32) -> Result<u32, RecipeError> {
        let number = self.params.integer(key, default, 2, 256)?;
        if number.is_multiple_of(2) {
            return Ok(number);
        }
        Err(self.error_at(key, format!("{key} must be even, so that the pattern closes, found {number}")))
    }

    /// An error at the line of `key`, or of the step where the key is not given.
    fn error_at(&mut self, key: &'static str, message: String) -> RecipeError {
        let line = self.params.get(key).map_or(self.params.line, |node| node.at.line());
        self.params.error(line, message)
    }
}

#[derive(Clone, Copy)]
enum Outline {
    Circle,
    Rectangle,
    Polygon,
    Star,
    Line,
}
