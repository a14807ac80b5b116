use std::error::Error;
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A rectangle of texels, row by row from the top left.
///
/// A grid is never empty: both sides are at least 1 and at most [`Grid::MAX_SIDE`]. Clones share their texels until one of them
/// is changed.
#[derive(Clone, Debug)]
pub struct Grid<T> {
    width: u32,
    height: u32,
    texels: Arc<[T]>,
    id: GridId,
}

/// Identity of a grid's content: clones that nobody has changed have the same one, all else has another, for as long as the
/// program runs. Tells what was already made ready from what is new, without a look at the texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GridId(u64);

impl GridId {
    fn new() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }
}

/// Compares sizes and texels.
impl<T: PartialEq> PartialEq for Grid<T> {
    fn eq(&self, other: &Self) -> bool {
        (self.width, self.height) == (other.width, other.height) && self.texels == other.texels
    }
}

/// The reason why a [`Grid`] cannot be made.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GridError {
    /// A side is 0 or over [`Grid::MAX_SIDE`].
    Size {
        /// Texels per row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// The number of texels is not `width × height`.
    Count {
        /// Texels per row.
        width: u32,
        /// Rows.
        height: u32,
        /// The number of values given.
        got: usize,
    },
}

impl fmt::Display for GridError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { width, height } => {
                let max = Grid::<()>::MAX_SIDE;
                write!(f, "a map of {width}×{height} texels cannot be: each side must be 1 to {max}")
            }
            Self::Count { width, height, got } => {
                let needed = u64::from(*width) * u64::from(*height);
                write!(f, "a map of {width}×{height} texels needs {needed} values, got {got}")
            }
        }
    }
}

impl Error for GridError {}

impl<T> Grid<T> {
    /// The longest side a grid may have: texel arithmetic stays exact in f32 and i32 with wrap-around.
    pub const MAX_SIDE: u32 = 1 << 16;

    /// Creates a grid of `width × height` texels, row by row from the top left.
    ///
    /// # Errors
    /// If a side is 0 or too long, or the number of texels does not fit.
    pub fn new(width: u32, height: u32, texels: Vec<T>) -> Result<Self, GridError> {
        Self::check_size(width, height)?;
        if texels.len() as u64 != u64::from(width) * u64::from(height) {
            return Err(GridError::Count { width, height, got: texels.len() });
        }
        Ok(Self::of(width, height, texels))
    }

    fn of(width: u32, height: u32, texels: Vec<T>) -> Self {
        Self { width, height, texels: texels.into(), id: GridId::new() }
    }

    /// Creates a grid whose texel in column `x`, row `y` is `f(x, y)`.
    ///
    /// # Panics
    /// If a side is 0 or over [`Grid::MAX_SIDE`].
    pub fn from_fn(width: u32, height: u32, mut f: impl FnMut(u32, u32) -> T) -> Self {
        Self::check_size(width, height).unwrap_or_else(|error| panic!("{error}"));
        let mut texels = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            texels.extend((0..width).map(|x| f(x, y)));
        }
        Self::of(width, height, texels)
    }

    /// Creates a grid with the same value everywhere.
    ///
    /// # Panics
    /// If a side is 0 or over [`Grid::MAX_SIDE`].
    pub fn filled(width: u32, height: u32, value: T) -> Self
    where
        T: Clone,
    {
        Self::check_size(width, height).unwrap_or_else(|error| panic!("{error}"));
        Self::of(width, height, vec![value; width as usize * height as usize])
    }

    /// Creates a grid of a size that another grid has: there is nothing left to check.
    #[cfg(feature = "convert")]
    pub(crate) fn from_texels(width: u32, height: u32, texels: Vec<T>) -> Self {
        debug_assert_eq!(texels.len() as u64, u64::from(width) * u64::from(height));
        Self::of(width, height, texels)
    }

    fn check_size(width: u32, height: u32) -> Result<(), GridError> {
        let fits = |side| (1..=Self::MAX_SIDE).contains(&side);
        if fits(width) && fits(height) { Ok(()) } else { Err(GridError::Size { width, height }) }
    }

    /// Texels per row.
    #[inline]
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    #[inline]
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All texels, row by row from the top left.
    #[inline]
    #[must_use]
    pub fn texels(&self) -> &[T] {
        &self.texels
    }

    /// All texels, mutable. Copies them if a clone shares them.
    pub fn texels_mut(&mut self) -> &mut [T]
    where
        T: Clone,
    {
        self.id = GridId::new();
        Arc::make_mut(&mut self.texels)
    }

    /// Returns a copy of the texels, row by row.
    #[must_use]
    pub fn into_texels(self) -> Vec<T>
    where
        T: Clone,
    {
        self.texels.to_vec()
    }

    /// Identity of the content.
    #[must_use]
    pub fn id(&self) -> GridId {
        self.id
    }

    /// The texel in column `x`, row `y`.
    ///
    /// # Panics
    /// If it lies outside.
    #[inline]
    #[must_use]
    pub fn get(&self, x: u32, y: u32) -> &T {
        &self.texels[y as usize * self.width as usize + x as usize]
    }

    /// Returns a grid of the same size with `f` applied to every texel.
    #[must_use]
    pub fn map<U>(&self, f: impl FnMut(&T) -> U) -> Grid<U> {
        Grid::of(self.width, self.height, self.texels.iter().map(f).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn empty_and_mismatched_grids_are_refused() {
        assert_eq!(Grid::<f32>::new(0, 4, vec![]), Err(GridError::Size { width: 0, height: 4 }));
        assert_eq!(Grid::new(2, 2, vec![1.0; 3]), Err(GridError::Count { width: 2, height: 2, got: 3 }));
        assert!(Grid::new(70_000, 1, vec![0u8; 70_000]).is_err());
    }

    #[test]
    fn texels_run_row_by_row_from_the_top() {
        let grid = Grid::from_fn(3, 2, |x, y| (x, y));
        assert_eq!(grid.texels(), [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)]);
        assert_eq!(*grid.get(2, 1), (2, 1));
    }

    #[test]
    fn a_clone_is_the_same_until_it_changes() {
        let grid = Grid::filled(2, 2, 1.0);
        let mut clone = grid.clone();
        assert!(clone.id() == grid.id() && std::ptr::eq(clone.texels(), grid.texels()));
        clone.texels_mut()[0] = 2.0;
        assert!(clone.id() != grid.id() && *grid.get(0, 0) == 1.0 && clone != grid);
        assert!(Grid::filled(2, 2, 1.0) == grid && Grid::filled(2, 2, 1.0).id() != grid.id());
    }
}
