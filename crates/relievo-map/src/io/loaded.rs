//! A map with notes on how it was read.

/// A map and what there is to say about how it was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded<T> {
    /// The map.
    pub map: T,
    /// Whole sentences that name the file: what was lost, changed or assumed. Empty if there is nothing to say.
    pub notes: Vec<String>,
}

impl<T> Loaded<T> {
    /// The same notes with another map.
    #[must_use]
    pub fn map<U>(self, f: impl FnOnce(T) -> U) -> Loaded<U> {
        Loaded { map: f(self.map), notes: self.notes }
    }
}
