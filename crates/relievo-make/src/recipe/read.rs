//! Text to recipe: the steps, the names between them, and an order in which they can be made.

use super::operation::{self, Wish};
use super::params::Params;
use super::tree::{merged, parse, stand_at};
use super::{Output, Recipe, RecipeError, Step};
use crate::builtin;
use relievo_toml::{Entry, Value, did_you_mean, shorten};

/// A step as it is written.
struct Written {
    name: String,
    line: usize,
    operation: operation::Operation,
    inputs: Vec<Wish>,
}

pub(super) fn recipe(file: &str, text: &str, seed: Option<u32>) -> Result<Recipe, RecipeError> {
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
    let own_seed = top.integer("seed", 0, 0, u32::MAX)?;
    let seed = seed.unwrap_or(own_seed);
    let steps = table(&mut top, "steps", "at least one step, as in [steps.noise]")?;
    let output = top.get("output").cloned();
    top.finish()?;

    if steps.len() > Recipe::MAX_STEPS {
        let message = format!("the recipe has {} steps, but {} are the most", steps.len(), Recipe::MAX_STEPS);
        return Err(RecipeError::new(file, 0, message));
    }
    let written = steps.iter().map(|entry| step(file, entry, seed)).collect::<Result<Vec<_>, _>>()?;

    let Some(output) = output else {
        let message = "the recipe needs a table [output] with height, color and roughness, each the name of a step";
        return Err(RecipeError::new(file, 0, message.to_owned()));
    };
    let Value::Table(outputs) = &output.value else {
        return Err(RecipeError::new(file, output.at.line(), "output must be a table, [output]".to_owned()));
    };
    let mut outputs = Params::new(file, "[output]".to_owned(), output.at.line(), outputs);
    let mut wishes = Vec::new();
    for (key, color) in [("height", false), ("color", true), ("roughness", false)] {
        let Some((name, line)) = outputs.text(key)? else {
            return Err(outputs.missing(key, "the name of a step"));
        };
        wishes.push((key, Wish { name: name.to_owned(), line, color }));
    }
    outputs.finish()?;
    Graph { file, written: &written, order: Vec::new(), state: vec![State::New; written.len()], path: Vec::new() }
        .recipe(description, height_scale, &wishes)
}

/// The entries, laid over those of the recipe that `base` names.
fn with_base(file: &str, entries: Vec<Entry>) -> Result<Vec<Entry>, RecipeError> {
    let Some(base) = entries.iter().find(|entry| entry.key == "base") else { return Ok(entries) };
    let line = base.node.at.line();
    let Value::String(name) = &base.node.value else {
        return Err(RecipeError::new(file, line, "base must be the name of a built-in recipe".to_owned()));
    };
    let Some(text) = builtin::text(name) else {
        let near = did_you_mean(name, builtin::names());
        let message = format!("there is no built-in recipe \"{}\"{near}", shorten(name));
        return Err(RecipeError::new(file, line, message));
    };
    let mut under = parse(name, text)?;
    // A recipe that has a base is none itself: two layers are enough, and nothing can go round.
    if under.iter().any(|entry| entry.key == "base") {
        let message = format!("\"{name}\" is itself a change of another recipe; name that one as the base");
        return Err(RecipeError::new(file, line, message));
    }
    stand_at(&mut under, base.node.at);
    Ok(merged(under, entries))
}

fn table<'a>(params: &mut Params<'a>, key: &'static str, what: &str) -> Result<&'a [Entry], RecipeError> {
    match params.get(key).map(|node| (node.at.line(), &node.value)) {
        Some((_, Value::Table(entries))) if !entries.is_empty() => Ok(entries),
        Some((line, _)) => Err(params.error(line, format!("{key} must be a table with {what}"))),
        None => Err(params.missing(key, what)),
    }
}

fn step(file: &str, entry: &Entry, seed: u32) -> Result<Written, RecipeError> {
    let (name, line) = (&entry.key, entry.node.at.line());
    if !name.starts_with(|c: char| c.is_ascii_alphabetic())
        || !name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        || ["u", "v", "texel", "pi"].contains(&name.as_str())
    {
        let message = format!(
            "a step cannot be called \"{}\"; use letters, digits and _, beginning with a letter (u, v, texel and pi are taken)",
            shorten(name)
        );
        return Err(RecipeError::new(file, line, message));
    }
    let Value::Table(entries) = &entry.node.value else {
        return Err(RecipeError::new(file, line, format!("the step {name} must be a table, [steps.{name}]")));
    };
    let mut params = Params::new(file, format!("[steps.{name}]"), line, entries);
    let (operation, inputs) = operation::read(&mut params, name, seed)?;
    params.finish()?;
    Ok(Written { name: name.clone(), line, operation, inputs })
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    New,
    /// Its inputs are being looked at.
    Open,
    /// It stands in the order at this place.
    Placed(usize),
}

/// The steps, being brought into an order.
struct Graph<'a> {
    file: &'a str,
    written: &'a [Written],
    order: Vec<Step>,
    state: Vec<State>,
    /// The steps that led here.
    path: Vec<usize>,
}

impl Graph<'_> {
    fn recipe(
        mut self,
        description: String,
        height_scale: f32,
        wishes: &[(&str, Wish)],
    ) -> Result<Recipe, RecipeError> {
        // Steps that no map needs must be right as well; they are looked at, and left out in the end.
        let outputs = wishes.iter().map(|(_, wish)| self.output(wish)).collect::<Result<Vec<_>, _>>()?;
        let needed = self.order.len();
        let want = |steps: &mut Vec<Step>, output: &Output| steps[output.step].wanted[output.port] = true;
        outputs.iter().for_each(|output| want(&mut self.order, output));
        for k in 0..needed {
            for input in self.order[k].inputs.clone() {
                want(&mut self.order, &input);
            }
        }
        for k in 0..self.written.len() {
            self.place(k, self.written[k].line)?;
        }
        self.order.truncate(needed);
        let &[height, color, roughness] = outputs.as_slice() else { unreachable!("three outputs were read") };
        Ok(Recipe { description, height_scale, steps: self.order, height, color, roughness })
    }

    /// The step's output that `wish` names, placed in the order.
    fn output(&mut self, wish: &Wish) -> Result<Output, RecipeError> {
        let (name, port) = wish.name.split_once('.').map_or((wish.name.as_str(), None), |(n, p)| (n, Some(p)));
        let Some(k) = self.written.iter().position(|step| step.name == name) else {
            let near = did_you_mean(name, self.written.iter().map(|step| step.name.as_str()));
            return Err(self.error(wish.line, format!("there is no step \"{}\"{near}", shorten(name))));
        };
        let ports = self.written[k].operation.ports();
        let port = match port {
            None => 0,
            Some(port) => ports.iter().position(|known| *known == port).ok_or_else(|| {
                let near = did_you_mean(port, ports.iter().copied());
                let list = ports.join(", ");
                self.error(
                    wish.line,
                    format!("the step {name} has no output \"{}\"{near}; it has {list}", shorten(port)),
                )
            })?,
        };
        let step = self.place(k, wish.line)?;
        if self.order[step].is_color && !wish.color {
            let message =
                format!("{name} is a colour, but a number is needed here; use a formula, as in luminance({name})");
            return Err(self.error(wish.line, message));
        }
        Ok(Output { step, port })
    }

    /// The place of step `k` in the order, after all of its inputs.
    fn place(&mut self, k: usize, line: usize) -> Result<usize, RecipeError> {
        match self.state[k] {
            State::Placed(place) => return Ok(place),
            State::Open => {
                let start = self.path.iter().position(|&step| step == k).unwrap_or(0);
                let mut names: Vec<&str> = self.path[start..].iter().map(|&k| self.written[k].name.as_str()).collect();
                names.push(&self.written[k].name);
                let message = format!("these steps need each other in a circle: {}", names.join(" needs "));
                return Err(self.error(line, message));
            }
            State::New => {}
        }
        self.state[k] = State::Open;
        self.path.push(k);
        let written: &Written = &self.written[k];
        let inputs = written.inputs.iter().map(|wish| self.output(wish)).collect::<Result<Vec<_>, _>>()?;
        self.path.pop();
        let colors: Vec<bool> = inputs.iter().map(|input| self.order[input.step].is_color).collect();
        let operation = written.operation.clone();
        let is_color = operation.is_color(&colors);
        let wanted = vec![false; operation.ports().len()];
        self.order.push(Step { operation, inputs, wanted, is_color });
        let place = self.order.len() - 1;
        self.state[k] = State::Placed(place);
        Ok(place)
    }

    fn error(&self, line: usize, message: String) -> RecipeError {
        RecipeError::new(self.file, line, message)
    }
}
