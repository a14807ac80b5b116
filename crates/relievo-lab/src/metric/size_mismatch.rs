use relievo_map::Grid;
use thiserror::Error;

/// Error: two pictures to be compared differ in size.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error("pictures to be compared must be equal in size: one has {}×{} pixels, the other {}×{}", a.0, a.1, b.0, b.1)]
pub struct SizeMismatch {
    /// Width and height of the first picture (the reference).
    pub a: (u32, u32),
    /// Width and height of the second picture (the test).
    pub b: (u32, u32),
}

impl SizeMismatch {
    /// Returns an error unless the pictures have one size.
    pub(crate) fn check<A, B>(a: &Grid<A>, b: &Grid<B>) -> Result<(), Self> {
        let (a, b) = ((a.width(), a.height()), (b.width(), b.height()));
        if a == b { Ok(()) } else { Err(Self { a, b }) }
    }
}
