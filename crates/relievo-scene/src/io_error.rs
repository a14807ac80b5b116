use std::io;

/// Replaces the system's message for a missing file by one that says what to do.
pub(crate) fn plainly(error: io::Error) -> io::Error {
    match error.kind() {
        io::ErrorKind::NotFound => {
            io::Error::new(io::ErrorKind::NotFound, "there is no such file; check the spelling and the folder")
        }
        _ => error,
    }
}
