//! Dimensions of a contact sheet, in pixels.

/// Largest number of pixels of a sheet; 768 MiB.
pub(super) const MAX_PIXELS: u64 = 1 << 28;

/// Margin around everything.
pub(super) const MARGIN: u32 = 24;
/// Gap between tiles.
pub(super) const GUTTER: u32 = 16;
/// Room for the bar before the headline.
pub(super) const HEADLINE_INDENT: u32 = 14;
/// Distance between the edge of a tile and its text.
pub(super) const PADDING: u32 = 12;
/// Largest width of a tile for the sake of its text.
pub(super) const LABEL_WIDTH: u32 = 240;
/// Smallest width of a tile.
pub(super) const MIN_TILE_WIDTH: u32 = 96;
/// Largest width of a sheet for the sake of its title and notes.
pub(super) const TEXT_WIDTH: u32 = 640;
