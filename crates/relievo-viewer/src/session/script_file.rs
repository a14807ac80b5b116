//! Reading a script from its file.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use crate::error::ViewerError;
use crate::input::script::Script;

/// The largest script that is read, bytes.
const MAX_SCRIPT: u64 = 16 << 20;

/// Reads a script; errors name the file and the line.
pub(super) fn read_script(path: &Path) -> Result<Script, ViewerError> {
    let failed = |line, message: String| ViewerError::Script { file: path.to_owned(), line, message };
    let mut text = String::new();
    let read = File::open(path).and_then(|file| file.take(MAX_SCRIPT + 1).read_to_string(&mut text));
    let bytes = read.map_err(|error| failed(None, format!("cannot read the script: {error}")))?;
    if bytes as u64 > MAX_SCRIPT {
        return Err(failed(None, format!("a script may have at most {} MiB", MAX_SCRIPT >> 20)));
    }
    Script::parse(&text).map_err(|error| failed(Some(error.line), error.message))
}
