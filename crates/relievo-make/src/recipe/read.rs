//! Reading of recipes: from TOML text to steps.

use relievo_toml::{Entry, Value, did_you_mean, shorten};

use super::error::RecipeError;
use super::graph::Recipe;
use super::order::{ParsedStep, StepSorter};
use super::params::Params;
use super::read_operation::{InputRef, read_operation};
use super::tree::{merged, parse, set_location};
use crate::builtin::recipes;

impl Recipe {
    /// Reads a recipe from its text; `name` stands for it in errors. `seed` replaces the recipe's own.
    ///
    /// # Errors
    /// If it is not TOML, a key or name is not known, a parameter is out of its range, or steps need each other in a
    /// circle. The error names the line.
    pub fn parse(name: &str, text: &str, seed: Option<u32>) -> Result<Self, RecipeError> {
        recipe(name, text, seed)
    }
}

fn recipe(file: &str, text: &str, seed: Option<u32>) -> Result<Recipe, RecipeError> {
    if text.len() > Recipe::MAX_BYTES {
        let message =
            format!("the recipe has {} bytes, but {} are the most that is read", text.len(), Recipe::MAX_BYTES);
        return Err(RecipeError::new(file, 0, message));
    }
    let entries = with_base(file, parse(file, text)?)?;
    let mut top = Params::new(file, "the recipe".to_owned(), 0, &entries);
    let _ = top.get("base");
    let description = top.text("description")?.map_or("", |(text, _)| text).to_owned();
    let height_scale = top.number("height_scale", 0.05, 1e-6, 10.0)?;
    let period = top.number("period", 4.0, 0.001, 1e6)?;
    let own_seed = top.integer("seed", 0, 0, u32::MAX)?;
    let seed = seed.unwrap_or(own_seed);
    let steps = table(&mut top, "steps", "at least one step, as in [steps.noise]")?;
    let output = top.get("output").cloned();
    top.finish()?;

    if steps.len() > Recipe::MAX_STEPS {
        let message = format!("the recipe has {} steps, but {} are the most", steps.len(), Recipe::MAX_STEPS);
        return Err(RecipeError::new(file, 0, message));
    }
    let parsed = steps.iter().map(|entry| step(file, entry, seed)).collect::<Result<Vec<_>, _>>()?;

    let Some(output) = output else {
        let message = "the recipe needs a table [output] with height, color and roughness, each the name of a step";
        return Err(RecipeError::new(file, 0, message.to_owned()));
    };
    let Value::Table(outputs) = &output.value else {
        return Err(RecipeError::new(file, output.at.line(), "output must be a table, [output]".to_owned()));
    };
    let mut outputs = Params::new(file, "[output]".to_owned(), output.at.line(), outputs);
    let mut map = |key, accepts_color| match outputs.text(key)? {
        Some((name, line)) => Ok(InputRef { name: name.to_owned(), line, accepts_color }),
        None => Err(outputs.missing(key, "the name of a step")),
    };
    let maps = [map("height", false)?, map("color", true)?, map("roughness", false)?];
    outputs.finish()?;
    let (steps, [height, color, roughness]) = StepSorter::new(file, &parsed).sorted(&maps)?;
    Ok(Recipe { description, height_scale, period, steps, height, color, roughness })
}

/// Merges the entries into those of the recipe that `base` names.
fn with_base(file: &str, entries: Vec<Entry>) -> Result<Vec<Entry>, RecipeError> {
    let Some(base) = entries.iter().find(|entry| entry.key == "base") else { return Ok(entries) };
    let line = base.node.at.line();
    let Value::String(name) = &base.node.value else {
        return Err(RecipeError::new(file, line, "base must be the name of a built-in recipe".to_owned()));
    };
    let Some(text) = recipes::text(name) else {
        let near = did_you_mean(name, recipes::names());
        let message = format!("there is no built-in recipe \"{}\"{near}", shorten(name));
        return Err(RecipeError::new(file, line, message));
    };
    let mut under = parse(name, text)?;
    // A recipe that has a base is none itself: two layers are enough, and nothing can go round.
    if under.iter().any(|entry| entry.key == "base") {
        let message = format!("\"{name}\" is itself a change of another recipe; name that one as the base");
        return Err(RecipeError::new(file, line, message));
    }
    set_location(&mut under, base.node.at);
    Ok(merged(under, entries))
}

fn table<'a>(params: &mut Params<'a>, key: &'static str, what: &str) -> Result<&'a [Entry], RecipeError> {
    match params.get(key).map(|node| (node.at.line(), &node.value)) {
        Some((_, Value::Table(entries))) if !entries.is_empty() => Ok(entries),
        Some((line, _)) => Err(params.error(line, format!("{key} must be a table with {what}"))),
        None => Err(params.missing(key, what)),
    }
}

fn step(file: &str, entry: &Entry, seed: u32) -> Result<ParsedStep, RecipeError> {
    let (name, line) = (&entry.key, entry.node.at.line());
    if !name.starts_with(|c: char| c.is_ascii_alphabetic())
        || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        || ["u", "v", "texel", "phase", "pi"].contains(&name.as_str())
    {
        let message = format!(
            "a step cannot be called \"{}\"; use letters, digits and _, beginning with a letter (u, v, texel, phase and pi are taken)",
            shorten(name)
        );
        return Err(RecipeError::new(file, line, message));
    }
    let Value::Table(entries) = &entry.node.value else {
        return Err(RecipeError::new(file, line, format!("the step {name} must be a table, [steps.{name}]")));
    };
    let mut params = Params::new(file, format!("[steps.{name}]"), line, entries);
    let (operation, inputs) = read_operation(&mut params, name, seed)?;
    params.finish()?;
    Ok(ParsedStep { name: name.clone(), line, operation, inputs })
}
