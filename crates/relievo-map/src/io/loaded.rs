//! A map with notes on how it was read.

/// A map and the notes on how it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded<T> {
    /// The map.
    pub map: T,
    /// Whole sentences that name the file, on losses, changes and assumptions. May be empty.
    pub notes: Vec<String>,
}

impl<T> Loaded<T> {
    /// Converts the map and keeps the notes.
    #[must_use]
    pub fn map<U>(self, f: impl FnOnce(T) -> U) -> Loaded<U> {
        Loaded { map: f(self.map), notes: self.notes }
    }
}
