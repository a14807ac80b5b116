//! Reader of stroke files.

use relievo_toml::{Entry, Value};

use super::error::PaintError;
use super::stroke::{Brush, Profile, Stroke, check_work};
use crate::recipe::Recipe;
use crate::recipe::error::RecipeError;
use crate::recipe::params::Params;
use crate::recipe::tree::parse;

/// Reads the strokes of a stroke file; `name` stands for it in errors, `brush` has the defaults. Keys outside of
/// `[[strokes]]` are for all strokes, those inside for one:
///
/// ```toml
/// width = 0.01          # lengths in uv: 1 is one repeat
/// depth = -0.3          # of the range of heights; negative carves
/// profile = "sharp"     # round, sharp, flat
/// hardness = 0.2        # the part of the half width that is as deep as the middle
/// jitter = 0.004        # how far strokes stray
/// taper = true          # ends run out
///
/// [[strokes]]
/// points = [[0.1, 0.2], [0.5, 0.4], [1.1, 0.3]]     # beyond 1 it goes on at the other side
/// width = 0.02
/// ```
///
/// # Errors
/// If it is not TOML, a key is unknown, a number is out of its range, or there are no strokes. The error names the line.
pub fn strokes_from_file(name: &str, text: &str, brush: &Brush) -> Result<Vec<Stroke>, PaintError> {
    // A stroke file may be long: a hundred times a recipe.
    let most = 64 * Recipe::MAX_BYTES;
    if text.len() > most {
        return Err(
            RecipeError::new(name, 0, format!("the stroke file has over {most} bytes; cut it into several")).into()
        );
    }
    let entries = parse(name, text)?;
    let mut top = Params::new(name, "the stroke file".to_owned(), 0, &entries);
    let brush = own_brush(&mut top, brush)?;
    let Some(list) = top.get("strokes") else {
        return Err(top.missing("strokes", "one table [[strokes]] for each stroke").into());
    };
    let Value::Array(tables) = &list.value else {
        return Err(top.error(list.at.line(), "strokes must be tables; write [[strokes]]").into());
    };
    let mut strokes = Vec::new();
    let mut count = 0;
    for table in tables {
        let Value::Table(entries) = &table.value else {
            return Err(top.error(list.at.line(), "strokes must be tables; write [[strokes]]").into());
        };
        let stroke = stroke(name, table.at.line(), entries, &brush)?;
        count += stroke.points.len();
        if count > Stroke::MAX_POINTS {
            return Err(top
                .error(table.at.line(), format!("over {} points in all; cut the file", Stroke::MAX_POINTS))
                .into());
        }
        strokes.push(stroke);
    }
    top.finish()?;
    if strokes.is_empty() {
        return Err(RecipeError::new(name, list.at.line(), "there are no strokes".to_owned()).into());
    }
    check_work(&strokes).map_err(|message| RecipeError::new(name, list.at.line(), message))?;
    Ok(strokes)
}

fn own_brush(params: &mut Params<'_>, default: &Brush) -> Result<Brush, RecipeError> {
    const YES_OR_NO: [(&str, bool); 2] = [("true", true), ("false", false)];
    let taper = match params.get("taper") {
        None => default.taper,
        Some(node) => match node.value {
            Value::Boolean(value) => value,
            _ => params.choice("taper", &YES_OR_NO, false)?,
        },
    };
    Ok(Brush {
        width: params.number("width", default.width, 1e-5, 1.0)?,
        depth: params.number("depth", default.depth, -1.0, 1.0)?,
        profile: params.choice("profile", &Profile::ALL, default.profile)?,
        hardness: params.number("hardness", default.hardness, 0.0, 1.0)?,
        jitter: params.number("jitter", default.jitter, 0.0, 1.0)?,
        taper,
    })
}

fn stroke(name: &str, line: usize, entries: &[Entry], default: &Brush) -> Result<Stroke, RecipeError> {
    let mut params = Params::new(name, "[[strokes]]".to_owned(), line, entries);
    let brush = own_brush(&mut params, default)?;
    let expected = format!(
        "points must be pairs of numbers from -{0} to {0}, as in points = [[0.1, 0.2], [0.5, 0.4]]",
        Stroke::MAX_DISTANCE
    );
    let Some(node) = params.get("points") else {
        return Err(params.error(line, format!("[[strokes]] needs points: {expected}")));
    };
    let Value::Array(items) = &node.value else { return Err(params.error(node.at.line(), expected)) };
    let mut points = Vec::with_capacity(items.len());
    for item in items {
        let numbers: Option<Vec<f32>> = match &item.value {
            Value::Array(pair) => pair.iter().map(|n| n.value.number().map(|n| n as f32)).collect(),
            _ => None,
        };
        match numbers.as_deref() {
            Some(&[u, v]) if [u, v].iter().all(|x| x.abs() <= Stroke::MAX_DISTANCE) => points.push([u, v]),
            _ => return Err(params.error(item.at.line(), expected)),
        }
    }
    if points.is_empty() {
        return Err(params.error(node.at.line(), expected));
    }
    params.finish()?;
    Ok(Stroke { points, brush })
}
