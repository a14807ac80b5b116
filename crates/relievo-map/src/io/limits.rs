use super::error::MapError;
use crate::types::Grid;

/// Limits of a single image, against decompression bombs. Checked from the header, before memory for texels is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The longest side in texels. Default 16384; never more than [`Grid::MAX_SIDE`], whatever is set.
    pub max_side: u32,
    /// Bytes for the decoded file and the f32 map together, and also for the file itself. Default 1 GiB.
    pub max_bytes: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_side: 16_384, max_bytes: 1 << 30 }
    }
}

impl Limits {
    /// The longest side that is allowed and that a [`Grid`] can hold.
    fn side(&self) -> u32 {
        self.max_side.min(Grid::<()>::MAX_SIDE)
    }

    /// Refuses an image of `width × height` if a side is 0 or too long, or if its texels, `bytes_per_texel` each
    /// (decoded and as a map), are too many bytes.
    pub(crate) fn check(&self, name: &str, width: u32, height: u32, bytes_per_texel: u64) -> Result<(), MapError> {
        let max_side = self.side();
        if !(1..=max_side).contains(&width) || !(1..=max_side).contains(&height) {
            return Err(MapError::Size { name: name.to_owned(), width, height, max_side });
        }
        let needed = (u64::from(width) * u64::from(height)).saturating_mul(bytes_per_texel);
        if needed > self.max_bytes {
            let max_bytes = self.max_bytes;
            return Err(MapError::Bytes { name: name.to_owned(), width, height, needed, max_bytes });
        }
        Ok(())
    }

    /// Returns the limits for the decoder. It counts its own scratch memory too, hence a generous multiple; the exact
    /// check is [`Limits::check`].
    pub(crate) fn for_decoder(&self) -> image::Limits {
        let mut limits = image::Limits::no_limits();
        limits.max_image_width = Some(self.side());
        limits.max_image_height = Some(self.side());
        limits.max_alloc = Some(self.max_bytes.saturating_mul(2));
        limits
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_and_bytes_are_limited_and_the_limit_itself_is_allowed() {
        let limits = Limits { max_side: 100, max_bytes: 40_000 };
        assert!(limits.check("a", 100, 100, 4).is_ok());
        assert!(matches!(limits.check("a", 101, 1, 4), Err(MapError::Size { .. })));
        assert!(matches!(limits.check("a", 1, 101, 4), Err(MapError::Size { .. })));
        assert!(matches!(limits.check("a", 0, 1, 4), Err(MapError::Size { .. })));
        assert!(matches!(limits.check("a", 100, 100, 5), Err(MapError::Bytes { needed: 50_000, .. })));
    }

    #[test]
    fn no_setting_lets_a_map_be_longer_than_a_grid() {
        let limits = Limits { max_side: u32::MAX, max_bytes: u64::MAX };
        assert!(matches!(limits.check("a", (1 << 16) + 1, 1, 1), Err(MapError::Size { .. })));
    }
}
