//! Formulas of recipes: numbers and colours at every texel.

mod eval;
mod expr;
mod parse;

pub(crate) use eval::{CHUNK, ChunkLocation, evaluate};
pub(crate) use expr::{Builtin, Expr, Function};
pub(crate) use parse::{color, parse};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::value::RecipeValue;

    fn parsed(text: &str) -> Result<Expr, String> {
        parse(text, &mut |name| {
            ["a", "b.x", "c"].iter().position(|known| *known == name).ok_or_else(|| format!("no \"{name}\""))
        })
    }

    /// The formula's value at the one texel of a map of 1×1.
    fn value(text: &str) -> f32 {
        let expr = parsed(text).unwrap();
        let inputs = [
            RecipeValue::Number(vec![3.0]),
            RecipeValue::Number(vec![0.25]),
            RecipeValue::Color([vec![1.0], vec![0.5], vec![0.0]]),
        ];
        let inputs: Vec<&RecipeValue> = inputs.iter().collect();
        let mut out = [0.0];
        evaluate(&expr, &inputs, ChunkLocation { size: 1, row: 0, column: 0, channel: 0, phase: 0.25 }, &mut out);
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
            ("cos(2 * pi * phase) + phase", 0.25),
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
