//! Errors of recipes and stroke files.

use thiserror::Error;

/// Error of a recipe or a stroke file: one sentence that names the file and the line.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("{file}{}: {message}", if *line > 0 { format!(":{line}") } else { String::new() })]
pub struct RecipeError {
    /// The recipe's name: its path, or the name of a built-in one.
    pub file: String,
    /// The line, from 1; 0 for the file as a whole.
    pub line: usize,
    /// The fault, the expected value, and the nearest name.
    pub message: String,
}

impl RecipeError {
    pub(crate) fn new(file: &str, line: usize, message: String) -> Self {
        Self { file: file.to_owned(), line, message }
    }
}
