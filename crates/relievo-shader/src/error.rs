use std::error::Error;
use std::fmt::{self, Display, Formatter};

/// An error of composing shader modules.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ComposeError {
    /// The module to begin with is not there.
    NoSuchModule(String),
    /// An import names a module that is not there.
    UnknownImport {
        /// The module with the import.
        module: String,
        /// Its line, from 1.
        line: usize,
        /// The name that is imported.
        name: String,
    },
    /// Modules import each other in a circle.
    Circle {
        /// The module whose import closes the circle.
        module: String,
        /// Its line, from 1.
        line: usize,
        /// The modules on the circle, the first again at the end.
        chain: Vec<String>,
    },
    /// A line looks like an import but is none.
    Malformed {
        /// The module with the line.
        module: String,
        /// The line, from 1.
        line: usize,
    },
    /// The prefix for the shader's names is not one that WGSL and its translations can have.
    InvalidPrefix(String),
}

impl Display for ComposeError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchModule(name) => write!(f, "there is no shader module \"{name}\""),
            Self::UnknownImport { module, line, name } => {
                write!(f, "{module}.wgsl:{line}: there is no shader module \"{name}\" to import")
            }
            Self::Circle { module, line, chain } => {
                write!(f, "{module}.wgsl:{line}: the import goes round in a circle: {}", chain.join(" → "))
            }
            Self::Malformed { module, line } => {
                write!(
                    f,
                    "{module}.wgsl:{line}: an import is written \"//! #import name\", alone on its line, one name"
                )
            }
            Self::InvalidPrefix(prefix) => write!(
                f,
                "\"{prefix}\" is no prefix of shader names: it takes lower-case words of ASCII letters and digits joined by \
                 single underscores, as in \"wall\" or \"left_wall\", and begins with a letter"
            ),
        }
    }
}

impl Error for ComposeError {}
