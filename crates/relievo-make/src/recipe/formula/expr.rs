//! The expression tree of a formula.

/// Expression of a formula.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Expr {
    Number(f32),
    /// Display RGB.
    Color([f32; 3]),
    /// A step's output, by its index among the formula's inputs.
    Input(usize),
    /// u, v, the size of a texel or the phase of the loop.
    Builtin(Builtin),
    Call(Function, Vec<Expr>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Builtin {
    U,
    V,
    Texel,
    /// Phase of the recipe's loop.
    Phase,
}

/// Functions and operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Function {
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Less,
    Greater,
    Abs,
    Sign,
    Floor,
    Fract,
    Sqrt,
    Exp,
    Sin,
    Cos,
    Min,
    Max,
    Mod,
    Pow,
    Hypot,
    Atan2,
    Step,
    Clamp,
    Mix,
    Smoothstep,
    SmoothMin,
    SmoothMax,
    Rgb,
    Luminance,
}

impl Function {
    /// The functions that are written with a name: name, function, number of arguments.
    pub(crate) const NAMED: [(&'static str, Self, usize); 22] = [
        ("abs", Self::Abs, 1),
        ("sign", Self::Sign, 1),
        ("floor", Self::Floor, 1),
        ("fract", Self::Fract, 1),
        ("sqrt", Self::Sqrt, 1),
        ("exp", Self::Exp, 1),
        ("sin", Self::Sin, 1),
        ("cos", Self::Cos, 1),
        ("min", Self::Min, 2),
        ("max", Self::Max, 2),
        ("mod", Self::Mod, 2),
        ("pow", Self::Pow, 2),
        ("hypot", Self::Hypot, 2),
        ("atan2", Self::Atan2, 2),
        ("step", Self::Step, 2),
        ("clamp", Self::Clamp, 3),
        ("mix", Self::Mix, 3),
        ("smoothstep", Self::Smoothstep, 3),
        ("smooth_min", Self::SmoothMin, 3),
        ("smooth_max", Self::SmoothMax, 3),
        ("rgb", Self::Rgb, 3),
        ("luminance", Self::Luminance, 1),
    ];
}

impl Expr {
    /// Returns the number of operations from the root to the farthest leaf.
    pub(super) fn depth(&self) -> usize {
        match self {
            Self::Call(_, arguments) => 1 + arguments.iter().map(Self::depth).max().unwrap_or(0),
            _ => 1,
        }
    }

    /// True if the result depends on the phase of the loop, beside the inputs.
    pub(crate) fn is_animated(&self) -> bool {
        match self {
            Self::Builtin(builtin) => *builtin == Builtin::Phase,
            Self::Call(_, arguments) => arguments.iter().any(Self::is_animated),
            _ => false,
        }
    }

    /// True if the result is a colour, given which inputs are.
    pub(crate) fn is_color(&self, inputs: &[bool]) -> bool {
        match self {
            Self::Number(_) | Self::Builtin(_) | Self::Call(Function::Luminance, _) => false,
            Self::Color(_) | Self::Call(Function::Rgb, _) => true,
            Self::Input(k) => inputs[*k],
            Self::Call(_, arguments) => arguments.iter().any(|a| a.is_color(inputs)),
        }
    }
}
