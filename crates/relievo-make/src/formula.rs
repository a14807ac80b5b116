//! Formulas of recipes: numbers and colours at every texel.

mod eval;
mod parse;

pub(crate) use eval::{CHUNK, Place, evaluate};
pub(crate) use parse::{color, parse};

/// What a formula computes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Expr {
    Number(f32),
    /// Display RGB.
    Color([f32; 3]),
    /// A step's output, by its place among the formula's inputs.
    Input(usize),
    /// u, v or the size of a texel.
    Builtin(Builtin),
    Call(Function, Vec<Expr>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Builtin {
    U,
    V,
    Texel,
}

/// Operators are functions too.
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
    /// Operations from the root to the farthest leaf.
    fn depth(&self) -> usize {
        match self {
            Self::Call(_, arguments) => 1 + arguments.iter().map(Self::depth).max().unwrap_or(0),
            _ => 1,
        }
    }

    /// Whether the result is a colour, given which inputs are.
    pub(crate) fn is_color(&self, inputs: &[bool]) -> bool {
        match self {
            Self::Number(_) | Self::Builtin(_) | Self::Call(Function::Luminance, _) => false,
            Self::Color(_) | Self::Call(Function::Rgb, _) => true,
            Self::Input(k) => inputs[*k],
            Self::Call(_, arguments) => arguments.iter().any(|a| a.is_color(inputs)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Field;

    fn parsed(text: &str) -> Result<Expr, String> {
        parse(text, &mut |name| {
            ["a", "b.x", "c"].iter().position(|known| *known == name).ok_or_else(|| format!("no \"{name}\""))
        })
    }

    /// The formula's value at the one texel of a map of 1×1.
    fn value(text: &str) -> f32 {
        let expr = parsed(text).unwrap();
        let inputs =
            [Field::Number(vec![3.0]), Field::Number(vec![0.25]), Field::Color([vec![1.0], vec![0.5], vec![0.0]])];
        let inputs: Vec<&Field> = inputs.iter().collect();
        let mut out = [0.0];
        evaluate(&expr, &inputs, Place { size: 1, row: 0, column: 0, channel: 0 }, &mut out);
        out[0]
    }

    #[test]
    fn operators_bind_as_in_school_and_functions_do_what_they_say() {
        for (text, expected) in [
            ("1 + 2 * 3 - 4 / 2", 5.0),
            ("-(1 - 3) * a", 6.0),
            ("2 - 1 - 1", 0.0),
            ("b.x * 4 > 0.5", 1.0),
            ("1 < 0.5", 0.0),
            ("max(a, 7) + min(a, 1)", 8.0),
            ("mix(2, 4, b.x)", 2.5),
            ("smoothstep(0, 1, 0.5)", 0.5),
            ("mod(0 - 1, 3)", 2.0),
            ("fract(2.75) + floor(2.75)", 2.75),
            ("hypot(3, 4) + atan2(0, 1)", 5.0),
            ("sqrt(0 - 1)", 0.0),
            ("u + v + texel", 2.0),
            ("c", 1.0),
            ("luminance(rgb(1, 1, 1))", 1.0),
            ("#804020", 128.0 / 255.0),
            ("clamp(a, 0, 1) * step(1, a) * sign(0-a)", -1.0),
        ] {
            assert!((value(text) - expected).abs() < 1e-5, "{text} = {}", value(text));
        }
    }

    #[test]
    fn a_formula_with_a_colour_in_it_is_a_colour() {
        let colors = [false, false, true];
        for (text, color) in
            [("a + 1", false), ("a * c", true), ("luminance(c)", false), ("mix(#000000, #ffffff, a)", true)]
        {
            assert_eq!(parsed(text).unwrap().is_color(&colors), color, "{text}");
        }
    }

    #[test]
    fn mistakes_name_their_column() {
        for (text, says) in [
            ("1 +", "column 4: expected a number"),
            ("1 + zz", "column 5: no \"zz\""),
            ("(1", "column 3: expected \")\""),
            ("abz(1)", "there is no function \"abz\"; did you mean \"abs\"?"),
            ("mix(1, 2)", "mix takes 3 arguments"),
            ("abs(1, 2)", "abs takes 1 argument in"),
            ("1 2", "column 3: expected an operator"),
            ("#12345", "six digits"),
            ("1..2", "\"1..2\" is not a number"),
            ("é", "column 1: expected a number"),
            ("", "found the end"),
        ] {
            let error = parsed(text).unwrap_err();
            assert!(error.contains(says), "{text}: {error}");
        }
        assert!(parsed(&"(".repeat(1000)).unwrap_err().contains("nested too deep"));
        assert!(parsed(&"-".repeat(1000)).unwrap_err().contains("nested too deep"));
        assert!(parsed(&format!("1{}", "+1".repeat(500))).unwrap_err().contains("in a row"));
    }

    proptest::proptest! {
        #[test]
        fn no_text_breaks_the_parser(text in "[-+*/()<>#.,a-c0-9 é]{0,60}") {
            let _ = parsed(&text);
        }
    }
}
