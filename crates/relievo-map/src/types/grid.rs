use std::error::Error;
use std::fmt;

/// A rectangle of texels, row by row from the top left.
///
/// A grid is never empty: both sides are at least 1 and at most [`Grid::MAX_SIDE`].
#[derive(Clone, Debug, PartialEq)]
pub struct Grid<T> {
    width: u32,
    height: u32,
    texels: Vec<T>,
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

    /// A grid of `width × height` texels, row by row from the top left.
    ///
    /// # Errors
    /// If a side is 0 or too long, or the number of texels does not fit.
    pub fn new(width: u32, height: u32, texels: Vec<T>) -> Result<Self, GridError> {
        Self::check_size(width, height)?;
        if texels.len() as u64 != u64::from(width) * u64::from(height) {
            return Err(GridError::Count { width, height, got: texels.len() });
        }
        Ok(Self { width, height, texels })
    }

    /// A grid whose texel in column `x`, row `y` is `f(x, y)`.
    ///
    /// # Panics
    /// If a side is 0 or over [`Grid::MAX_SIDE`].
    pub fn from_fn(width: u32, height: u32, mut f: impl FnMut(u32, u32) -> T) -> Self {
        Self::check_size(width, height).unwrap_or_else(|error| panic!("{error}"));
        let mut texels = Vec::with_capacity(width as usize * height as usize);
        for y in 0..height {
            texels.extend((0..width).map(|x| f(x, y)));
        }
        Self { width, height, texels }
    }

    /// A grid with the same value everywhere.
    ///
    /// # Panics
    /// If a side is 0 or over [`Grid::MAX_SIDE`].
    pub fn filled(width: u32, height: u32, value: T) -> Self
    where
        T: Clone,
    {
        Self::check_size(width, height).unwrap_or_else(|error| panic!("{error}"));
        Self { width, height, texels: vec![value; width as usize * height as usize] }
    }

    /// A grid of a size that another grid has: there is nothing left to check.
    #[cfg(feature = "convert")]
    pub(crate) fn from_texels(width: u32, height: u32, texels: Vec<T>) -> Self {
        debug_assert_eq!(texels.len() as u64, u64::from(width) * u64::from(height));
        Self { width, height, texels }
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

    /// All texels, to be changed.
    #[inline]
    pub fn texels_mut(&mut self) -> &mut [T] {
        &mut self.texels
    }

    /// The texels, row by row, without the grid around them.
    #[must_use]
    pub fn into_texels(self) -> Vec<T> {
        self.texels
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

    /// A grid of the same size with every texel changed by `f`.
    #[must_use]
    pub fn map<U>(&self, f: impl FnMut(&T) -> U) -> Grid<U> {
        Grid { width: self.width, height: self.height, texels: self.texels.iter().map(f).collect() }
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
}
