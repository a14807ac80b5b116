//! Edit steps as users write them: `NAME` or `NAME=VALUES`.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use thiserror::Error;

use super::combine::Combine;
use super::error::MAX_MEDIAN;
use super::orientation::Orientation;

/// One edit of a map. Radii are fractions of the map's width; files are named, not read.
///
/// ```
/// use relievo_make::edit::Step;
/// let step: Step = "blur=0.002".parse()?;
/// assert_eq!(step, Step::Blur { radius: 0.002 });
/// # Ok::<(), relievo_make::edit::StepError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Step {
    /// `low` becomes 0 and `high` 1; then the power 1 / `gamma` (> 1 lightens).
    Levels {
        /// The value that becomes 0.
        low: f32,
        /// The value that becomes 1.
        high: f32,
        /// Greater than 0.
        gamma: f32,
    },
    /// A monotone curve through points (from, to).
    Curve(Vec<[f32; 2]>),
    /// A Gaussian blur.
    Blur {
        /// Standard deviation, 0..1.
        radius: f32,
    },
    /// Unsharp mask.
    Sharpen {
        /// Standard deviation of the blur, 0..1.
        radius: f32,
        /// Weight of the difference from the blur.
        amount: f32,
    },
    /// The median of the square of `2·radius + 1` texels.
    Median {
        /// In texels, at most [`MAX_MEDIAN`].
        radius: u32,
    },
    /// 1 − v.
    Invert,
    /// Combination with another map of the same size.
    Combine {
        /// The operator.
        mode: Combine,
        /// The other map.
        file: PathBuf,
    },
    /// Another map where a mask is white.
    Mask {
        /// The other map.
        file: PathBuf,
        /// The mask, one number per texel.
        mask: PathBuf,
    },
    /// Another size.
    Resize {
        /// Texels, 1 to 16384.
        width: u32,
        /// Texels, 1 to 16384.
        height: u32,
    },
    /// Rotation or flip.
    Reorient(Orientation),
    /// Periodic component: the jumps at the borders spread smoothly over the map.
    Tile,
    /// Stair-steps of 8 bits made smooth.
    Deband,
}

/// Another map that a [`Step`] names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OtherMap<'a> {
    /// A map of the same kind as the edited one.
    Map(&'a Path),
    /// A mask, one number per texel.
    Mask(&'a Path),
}

/// Error of a step that cannot be read: names the step and the expected form.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("\"{step}\": expected {expected}")]
pub struct StepError {
    /// The step as it was written.
    pub step: String,
    /// The expected form, with an example or the range.
    pub expected: String,
}

impl Step {
    /// Every step's form and meaning, in the order of the help.
    pub const SYNTAX: &'static [StepSyntax] = &SYNTAX;

    /// Returns the rotation or flip, the only edit that normals allow.
    #[must_use]
    pub fn orientation(&self) -> Option<Orientation> {
        if let Self::Reorient(orientation) = self { Some(*orientation) } else { None }
    }

    /// Returns the width and height that the step gives to every map.
    #[must_use]
    pub fn output_size(&self) -> Option<[u32; 2]> {
        if let Self::Resize { width, height } = *self { Some([width, height]) } else { None }
    }

    /// True if the step moves texels and leaves their values: the only edits of an alpha channel.
    #[must_use]
    pub fn is_geometric(&self) -> bool {
        matches!(self, Self::Resize { .. } | Self::Reorient(_))
    }
}

impl FromStr for Step {
    type Err = StepError;

    /// Reads `NAME` or `NAME=VALUES`.
    fn from_str(text: &str) -> Result<Self, StepError> {
        let (name, value) = text.split_once('=').unwrap_or((text, ""));
        let syntax = SYNTAX.iter().find(|syntax| syntax.name == name);
        syntax.and_then(|syntax| (syntax.parse)(value)).ok_or_else(|| {
            let expected = match syntax {
                Some(StepSyntax { expected: Some(expected), .. }) => (*expected).to_owned(),
                _ => format!("one of the steps {}", SYNTAX.map(|syntax| syntax.name).join(", ")),
            };
            StepError { step: text.to_owned(), expected }
        })
    }
}

/// The written form of a kind of [`Step`], for help texts.
#[derive(Clone, Copy, Debug)]
pub struct StepSyntax {
    /// The name before `=`.
    pub name: &'static str,
    /// The whole form: `blur=R`.
    pub usage: &'static str,
    /// The effect, in one line.
    pub summary: &'static str,
    /// The form for errors; none where the list of all steps says more.
    expected: Option<&'static str>,
    parse: fn(&str) -> Option<Step>,
}

const SYNTAX: [StepSyntax; 16] = [
    StepSyntax {
        name: "levels",
        usage: "levels=LOW,HIGH[,GAMMA]",
        summary: "LOW becomes black, HIGH white",
        expected: Some("levels=LOW,HIGH or levels=LOW,HIGH,GAMMA, as in levels=0.1,0.9"),
        parse: levels,
    },
    StepSyntax {
        name: "curve",
        usage: "curve=X:Y,X:Y,…",
        summary: "a curve through these points",
        expected: Some("curve=X:Y,X:Y,…, as in curve=0:0,0.5:0.7,1:1"),
        parse: curve,
    },
    StepSyntax {
        name: "blur",
        usage: "blur=R",
        summary: "with a Gaussian; R is a fraction of the width",
        expected: Some("blur=R, R a fraction of the width from 0 to 1"),
        parse: |value| match numbers(value)?[..] {
            [radius] if (0.0..=1.0).contains(&radius) => Some(Step::Blur { radius }),
            _ => None,
        },
    },
    StepSyntax {
        name: "sharpen",
        usage: "sharpen=R,AMOUNT",
        summary: "adds AMOUNT times what a blur takes away",
        expected: Some("sharpen=R,AMOUNT, as in sharpen=0.002,1"),
        parse: |value| match numbers(value)?[..] {
            [radius, amount] if (0.0..=1.0).contains(&radius) => Some(Step::Sharpen { radius, amount }),
            _ => None,
        },
    },
    StepSyntax {
        name: "median",
        usage: "median=N",
        summary: "of the N texels around, at most 16",
        expected: Some("median=N, N from 0 to 16"),
        parse: |value| {
            let radius = value.parse().ok().filter(|radius| *radius <= MAX_MEDIAN)?;
            Some(Step::Median { radius })
        },
    },
    StepSyntax {
        name: "invert",
        usage: "invert",
        summary: "black becomes white",
        expected: None,
        parse: |value| value.is_empty().then_some(Step::Invert),
    },
    StepSyntax {
        name: "max",
        usage: "max=FILE",
        summary: "the higher of both maps",
        expected: None,
        parse: |value| (!value.is_empty()).then(|| combine(Combine::Max, value)),
    },
    StepSyntax {
        name: "min",
        usage: "min=FILE",
        summary: "the lower of both maps",
        expected: None,
        parse: |value| (!value.is_empty()).then(|| combine(Combine::Min, value)),
    },
    StepSyntax {
        name: "add",
        usage: "add=FILE[,WEIGHT]",
        summary: "the sum of both maps",
        expected: None,
        parse: |value| {
            let (file, weight) = file_and_number(value).unwrap_or((value, 1.0));
            (!value.is_empty()).then(|| combine(Combine::Add(weight), file))
        },
    },
    StepSyntax {
        name: "blend",
        usage: "blend=FILE,SOFTNESS",
        summary: "the higher of both, with soft corners",
        expected: Some("blend=FILE,SOFTNESS, as in blend=sand.png,0.05"),
        parse: |value| {
            let (file, softness) = file_and_number(value).filter(|(_, softness)| *softness > 0.0)?;
            Some(combine(Combine::Blend(softness), file))
        },
    },
    StepSyntax {
        name: "mask",
        usage: "mask=FILE,MASK",
        summary: "FILE where MASK is white",
        expected: Some("mask=FILE,MASK"),
        parse: |value| {
            let (file, mask) = value.rsplit_once(',')?;
            Some(Step::Mask { file: file.into(), mask: mask.into() })
        },
    },
    StepSyntax {
        name: "resize",
        usage: "resize=WxH",
        summary: "what tiles goes on tiling",
        expected: Some("resize=WIDTHxHEIGHT, each from 1 to 16384"),
        parse: |value| {
            let side = |text: &str| text.parse::<u32>().ok().filter(|n| (1..=16384).contains(n));
            let (width, height) = value.split_once('x')?;
            Some(Step::Resize { width: side(width)?, height: side(height)? })
        },
    },
    StepSyntax {
        name: "rotate",
        usage: "rotate=90|180|270",
        summary: "clockwise; normals rotate too",
        expected: Some("rotate=90, 180 or 270"),
        parse: |value| orientation(value, &["90", "180", "270"]),
    },
    StepSyntax {
        name: "flip",
        usage: "flip=x|y",
        summary: "left to right, or upside down; normals too",
        expected: Some("flip=x or flip=y"),
        parse: |value| orientation(value, &["x", "y"]),
    },
    StepSyntax {
        name: "tile",
        usage: "tile",
        summary: "spreads the jumps at the borders, so that it tiles",
        expected: None,
        parse: |value| value.is_empty().then_some(Step::Tile),
    },
    StepSyntax {
        name: "deband",
        usage: "deband",
        summary: "stair-steps of 8 bits become smooth",
        expected: None,
        parse: |value| value.is_empty().then_some(Step::Deband),
    },
];

fn levels(value: &str) -> Option<Step> {
    match numbers(value)?[..] {
        [low, high] => Some(Step::Levels { low, high, gamma: 1.0 }),
        [low, high, gamma] if gamma > 0.0 => Some(Step::Levels { low, high, gamma }),
        _ => None,
    }
}

fn curve(value: &str) -> Option<Step> {
    let point = |text: &str| numbers(&text.replace(':', ",")).and_then(|p| <[f32; 2]>::try_from(p).ok());
    let points = value.split(',').map(point).collect::<Option<Vec<_>>>()?;
    (points.len() > 1).then_some(Step::Curve(points))
}

fn combine(mode: Combine, file: &str) -> Step {
    Step::Combine { mode, file: file.into() }
}

fn orientation(value: &str, allowed: &[&str]) -> Option<Step> {
    let (_, orientation) = Orientation::ALL.iter().find(|(name, _)| *name == value && allowed.contains(name))?;
    Some(Step::Reorient(*orientation))
}

/// Numbers between commas, each of at most 10⁶.
fn numbers(text: &str) -> Option<Vec<f32>> {
    text.split(',').map(|n| n.trim().parse::<f32>().ok().filter(|n| n.is_finite() && n.abs() <= 1e6)).collect()
}

/// A file's name and the number after the last comma.
fn file_and_number(text: &str) -> Option<(&str, f32)> {
    let (file, number) = text.rsplit_once(',')?;
    Some((file, *numbers(number)?.first()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Step {
        text.parse().unwrap()
    }

    #[test]
    fn steps_are_read_as_they_are_written() {
        assert_eq!(parsed("levels=0.1,0.9"), Step::Levels { low: 0.1, high: 0.9, gamma: 1.0 });
        assert_eq!(parsed("levels=0.1, 0.9, 1.2"), Step::Levels { low: 0.1, high: 0.9, gamma: 1.2 });
        assert_eq!(parsed("curve=0:0,1:0.5"), Step::Curve(vec![[0.0, 0.0], [1.0, 0.5]]));
        assert_eq!(parsed("median=3"), Step::Median { radius: 3 });
        assert_eq!(parsed("max=a=b.png"), Step::Combine { mode: Combine::Max, file: "a=b.png".into() });
        assert_eq!(parsed("resize=32x64").output_size(), Some([32, 64]));
        assert_eq!(parsed("rotate=270").orientation(), Some(Orientation::Rotate270));
        assert_eq!(parsed("flip=y").orientation(), Some(Orientation::FlipY));
        assert!(parsed("flip=y").is_geometric() && !parsed("tile").is_geometric());
    }

    #[test]
    fn a_number_behind_the_last_comma_is_the_weight_all_else_the_name() {
        let add = |weight, file: &str| Step::Combine { mode: Combine::Add(weight), file: file.into() };
        assert_eq!(parsed("add=a.png"), add(1.0, "a.png"));
        assert_eq!(parsed("add=a,b.png"), add(1.0, "a,b.png"));
        assert_eq!(parsed("add=a,b.png,-0.2"), add(-0.2, "a,b.png"));
        assert_eq!(parsed("mask=a,b.png,m.png"), Step::Mask { file: "a,b.png".into(), mask: "m.png".into() });
    }

    #[test]
    fn every_step_has_a_form_that_begins_with_its_name() {
        for syntax in Step::SYNTAX {
            assert!(syntax.usage.starts_with(syntax.name) && !syntax.summary.is_empty(), "{}", syntax.name);
        }
    }

    #[test]
    fn wrong_steps_name_the_expected_form() {
        for (step, says) in [
            ("blur=2", "\"blur=2\": expected blur=R, R a fraction of the width from 0 to 1"),
            ("blur=nan", "expected blur=R"),
            ("levels=0,1,0", "levels=LOW,HIGH,GAMMA"),
            ("curve=0:1", "curve=0:0,0.5:0.7,1:1"),
            ("median=17", "median=N, N from 0 to 16"),
            ("blend=a.png,0", "blend=sand.png,0.05"),
            ("resize=0x5", "each from 1 to 16384"),
            ("rotate=x", "rotate=90, 180 or 270"),
            ("invert=1", "one of the steps levels, curve, blur, sharpen, median, invert, max, min, add, blend, mask, "),
            ("max", "resize, rotate, flip, tile, deband"),
            ("sharpn=1", "one of the steps"),
        ] {
            let said = step.parse::<Step>().unwrap_err().to_string();
            assert!(said.contains(says), "{said}\n  {says}");
        }
    }
}
