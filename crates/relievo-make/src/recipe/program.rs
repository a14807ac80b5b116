//! Recipes as programs for shaders.

use super::evaluate::samples_per_side;
use super::formula::{Builtin, Expr, Function};
use super::graph::RecipeStep;
use super::operation::Operation;
use crate::noise::{Basis, Fractal, FractalKind, Octave, Slices};

/// The heights of a recipe as a function in WGSL, which computes each texel from its place alone.
///
/// Its noise is that of the module `fractal` of `relievo-shader`, and all that depends on the moment stands in a table of octaves.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightProgram {
    size: u32,
    wgsl: String,
    fractals: Vec<Fractal>,
}

/// An octave of a noise at a moment of its loop, as it lies in the shaders' buffer: `RelievoOctave`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OctaveEntry {
    /// Cells along u and v.
    pub cells: [u32; 2],
    /// Seeds of the slices before and after.
    pub seeds: [u32; 2],
    /// Time since the slice before, in slices.
    pub offset: f32,
    /// Weight of the slice after.
    pub weight: f32,
    /// Mean of the noise.
    pub mean: f32,
    /// Fraction that the texels can show.
    pub shown: f32,
}

impl HeightProgram {
    /// Writes the program of these steps, whose last is the height; `None` if one of them is not a function of a texel.
    pub(super) fn new(steps: &[RecipeStep], height: usize, size: u32) -> Option<Self> {
        let mut program = Self { size, wgsl: String::new(), fractals: Vec::new() };
        let mut body = String::new();
        let mut first = 0;
        for (k, step) in steps.iter().enumerate() {
            let input = |k: usize| format!("s{}", step.inputs[k].step);
            let value = match &step.operation {
                Operation::Noise { fractal, warp } => {
                    let uv = match step.inputs.len() {
                        0 => "uv".to_owned(),
                        _ => format!("uv + {} * vec2f({}, {})", number(*warp), input(0), input(1)),
                    };
                    let count = fractal.octaves(program.texel(), 0.0).len();
                    program.fractals.push(*fractal);
                    first += count;
                    fractal_call(fractal, &uv, first - count, count)
                }
                Operation::Formula(expr) if !step.is_color && has_no_color(expr) => {
                    expression(expr, &input, program.texel())
                }
                _ => return None,
            };
            body.push_str(&format!("    let s{k} = {value};\n"));
        }
        program.wgsl =
            format!("fn relievo_recipe_height(uv: vec2f, phase: f32) -> f32 {{\n{body}    return s{height};\n}}\n");
        Some(program)
    }

    fn texel(&self) -> f32 {
        1.0 / (self.size * self.samples_per_side()) as f32
    }

    /// Texels per side.
    #[must_use]
    pub fn size(&self) -> u32 {
        self.size
    }

    /// Samples along each side of a texel, of which it is the mean.
    #[must_use]
    pub fn samples_per_side(&self) -> u32 {
        samples_per_side(self.size)
    }

    /// The function `relievo_recipe_height(uv: vec2f, phase: f32) -> f32`. It calls what the modules `fractal` and `formula` of
    /// `relievo-shader` declare.
    #[must_use]
    pub fn wgsl(&self) -> &str {
        &self.wgsl
    }

    /// Returns the table of octaves at a phase of the loop; it has the same length at every phase.
    #[must_use]
    pub fn octaves(&self, phase: f64) -> Vec<OctaveEntry> {
        let entry = |(octave, shown): (Octave, f32)| {
            let still = Slices { seeds: [octave.seed; 2], offset: 0.0, weight: 0.0 };
            let Slices { seeds, offset, weight } = octave.slices.unwrap_or(still);
            let mean = octave.basis.mean();
            OctaveEntry { cells: [octave.columns, octave.rows], seeds, offset, weight, mean, shown }
        };
        self.fractals.iter().flat_map(|fractal| fractal.octaves(self.texel(), phase)).map(entry).collect()
    }
}

/// A number that compilers do not compute with: a division by it must not stop them.
fn number(x: f32) -> String {
    format!("relievo_number({x:?}f)")
}

fn fractal_call(fractal: &Fractal, uv: &str, first: usize, count: usize) -> String {
    let basis = match fractal.noise.basis {
        Basis::Perlin => "PERLIN",
        Basis::Value => "VALUE",
        Basis::WorleyF1 => "WORLEY_NEAREST",
        Basis::WorleyF2 => "WORLEY_SECOND",
        Basis::WorleyEdge => "WORLEY_EDGE",
    };
    let kind = match fractal.kind {
        FractalKind::Fbm => "FBM",
        FractalKind::Ridged => "RIDGED",
        FractalKind::Billow => "BILLOW",
    };
    let (gain, whole) = (number(fractal.gain), number(fractal.whole()));
    format!("relievo_fractal({uv}, RELIEVO_{basis}, RELIEVO_{kind}, {first}u, {count}u, {gain}, {whole})")
}

fn has_no_color(expr: &Expr) -> bool {
    match expr {
        Expr::Color(_) => false,
        Expr::Call(Function::Rgb | Function::Luminance, _) => false,
        Expr::Call(_, arguments) => arguments.iter().all(has_no_color),
        _ => true,
    }
}

/// Writes an expression; `input` names a step's value.
fn expression(expr: &Expr, input: &dyn Fn(usize) -> String, texel: f32) -> String {
    let (function, arguments) = match expr {
        Expr::Number(x) => return number(*x),
        Expr::Color(color) => return number(color[0]),
        Expr::Input(k) => return input(*k),
        Expr::Builtin(Builtin::U) => return "uv.x".to_owned(),
        Expr::Builtin(Builtin::V) => return "uv.y".to_owned(),
        Expr::Builtin(Builtin::Texel) => return number(texel),
        Expr::Builtin(Builtin::Phase) => return "phase".to_owned(),
        Expr::Call(function, arguments) => (function, arguments),
    };
    let arguments: Vec<String> = arguments.iter().map(|argument| expression(argument, input, texel)).collect();
    let infix = |operator: &str| format!("({} {operator} {})", arguments[0], arguments[1]);
    let call = |name: &str| format!("{name}({})", arguments.join(", "));
    match function {
        Function::Negate => format!("(-{})", arguments[0]),
        Function::Add => infix("+"),
        Function::Subtract => infix("-"),
        Function::Multiply => infix("*"),
        Function::Divide => infix("/"),
        Function::Less => format!("select(0.0, 1.0, {})", infix("<")),
        Function::Greater => format!("select(0.0, 1.0, {})", infix(">")),
        Function::Abs => call("abs"),
        Function::Sign => call("sign"),
        Function::Floor => call("floor"),
        Function::Fract => call("fract"),
        Function::Sqrt => format!("sqrt(max({}, 0.0))", arguments[0]),
        Function::Exp => call("exp"),
        Function::Sin => call("sin"),
        Function::Cos => call("cos"),
        Function::Min => call("min"),
        Function::Max => call("max"),
        Function::Mod => call("relievo_modulo"),
        Function::Pow => call("relievo_power"),
        Function::Hypot => call("relievo_hypot"),
        Function::Atan2 => call("atan2"),
        Function::Step => format!("select(0.0, 1.0, {} >= {})", arguments[1], arguments[0]),
        Function::Clamp => format!("min(max({}, {}), {})", arguments[0], arguments[1], arguments[2]),
        Function::Mix => call("relievo_mix"),
        Function::Smoothstep => call("relievo_smoothstep"),
        Function::SmoothMin => call("relievo_smooth_min"),
        Function::SmoothMax => call("relievo_smooth_max"),
        // Colours are left to the CPU.
        Function::Rgb | Function::Luminance => arguments[0].clone(),
    }
}
