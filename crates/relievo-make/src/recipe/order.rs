//! The order in which steps are made: each after its inputs.

use relievo_toml::{did_you_mean, shorten};

use super::error::RecipeError;
use super::graph::{OutputRef, RecipeStep};
use super::operation::Operation;
use super::read_operation::InputRef;

/// A step as it is written, its inputs still names.
pub(super) struct ParsedStep {
    pub(super) name: String,
    pub(super) line: usize,
    pub(super) operation: Operation,
    pub(super) inputs: Vec<InputRef>,
}

#[derive(Clone, Copy, PartialEq)]
enum Visit {
    New,
    /// Its inputs are being visited.
    Open,
    /// Its index in the order.
    Done(usize),
}

/// Sorts steps topologically, by depth-first search.
pub(super) struct StepSorter<'a> {
    file: &'a str,
    parsed: &'a [ParsedStep],
    order: Vec<RecipeStep>,
    visits: Vec<Visit>,
    /// The steps from the root of the search to the current one.
    path: Vec<usize>,
}

impl<'a> StepSorter<'a> {
    pub(super) fn new(file: &'a str, parsed: &'a [ParsedStep]) -> Self {
        Self { file, parsed, order: Vec::new(), visits: vec![Visit::New; parsed.len()], path: Vec::new() }
    }

    /// Returns the steps that the three `maps` need, each after its inputs, and the maps' outputs.
    pub(super) fn sorted(mut self, maps: &[InputRef; 3]) -> Result<(Vec<RecipeStep>, [OutputRef; 3]), RecipeError> {
        let [height, color, roughness] = maps;
        let outputs = [self.output(height)?, self.output(color)?, self.output(roughness)?];
        let needed = self.order.len();
        let want = |steps: &mut Vec<RecipeStep>, output: &OutputRef| steps[output.step].wanted[output.port] = true;
        outputs.iter().for_each(|output| want(&mut self.order, output));
        for k in 0..needed {
            for input in self.order[k].inputs.clone() {
                want(&mut self.order, &input);
            }
        }
        // Steps that no map needs must be right as well: they are checked, then left out.
        for k in 0..self.parsed.len() {
            self.visit(k, self.parsed[k].line)?;
        }
        self.order.truncate(needed);
        Ok((self.order, outputs))
    }

    /// Returns the output that `input` names, after visiting its step.
    fn output(&mut self, input: &InputRef) -> Result<OutputRef, RecipeError> {
        let (name, port) = input.name.split_once('.').map_or((input.name.as_str(), None), |(n, p)| (n, Some(p)));
        let Some(k) = self.parsed.iter().position(|step| step.name == name) else {
            let near = did_you_mean(name, self.parsed.iter().map(|step| step.name.as_str()));
            return Err(self.error(input.line, format!("there is no step \"{}\"{near}", shorten(name))));
        };
        let ports = self.parsed[k].operation.ports();
        let port = match port {
            None => 0,
            Some(port) => ports.iter().position(|known| *known == port).ok_or_else(|| {
                let near = did_you_mean(port, ports.iter().copied());
                let list = ports.join(", ");
                self.error(
                    input.line,
                    format!("the step {name} has no output \"{}\"{near}; it has {list}", shorten(port)),
                )
            })?,
        };
        let step = self.visit(k, input.line)?;
        if self.order[step].is_color && !input.accepts_color {
            let message =
                format!("{name} is a colour, but a number is needed here; use a formula, as in luminance({name})");
            return Err(self.error(input.line, message));
        }
        Ok(OutputRef { step, port })
    }

    /// Returns the index of step `k` in the order, after all of its inputs; `line` is where it was named.
    fn visit(&mut self, k: usize, line: usize) -> Result<usize, RecipeError> {
        match self.visits[k] {
            Visit::Done(index) => return Ok(index),
            Visit::Open => {
                let start = self.path.iter().position(|&step| step == k).unwrap_or(0);
                let mut names: Vec<&str> = self.path[start..].iter().map(|&k| self.parsed[k].name.as_str()).collect();
                names.push(&self.parsed[k].name);
                let message = format!("these steps need each other in a circle: {}", names.join(" needs "));
                return Err(self.error(line, message));
            }
            Visit::New => {}
        }
        self.visits[k] = Visit::Open;
        self.path.push(k);
        let parsed: &ParsedStep = &self.parsed[k];
        let inputs = parsed.inputs.iter().map(|input| self.output(input)).collect::<Result<Vec<_>, _>>()?;
        self.path.pop();
        let colors: Vec<bool> = inputs.iter().map(|input| self.order[input.step].is_color).collect();
        let operation = parsed.operation.clone();
        let is_color = operation.is_color(&colors);
        let wanted = vec![false; operation.ports().len()];
        self.order.push(RecipeStep { operation, inputs, wanted, is_color });
        let index = self.order.len() - 1;
        self.visits[k] = Visit::Done(index);
        Ok(index)
    }

    fn error(&self, line: usize, message: String) -> RecipeError {
        RecipeError::new(self.file, line, message)
    }
}
