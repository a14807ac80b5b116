use relievo_map::Grid;
use thiserror::Error;

use super::canvas::Canvas;
use super::card::Card;
use super::dimensions::MAX_PIXELS;
use super::layout::{Content, Layout};
use crate::colors::sheet::BACKGROUND;

/// A picture on a contact sheet with the text under it.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// The picture, 8-bit sRGB; it is shown pixel by pixel, never scaled.
    pub picture: Grid<[u8; 3]>,
    /// The text under it; the first line is its title. In the others, the part after a tab is set at the right edge and
    /// brighter: `"FLIP\t0.012"`.
    pub lines: Vec<String>,
}

/// An error of a contact sheet.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum SheetError {
    /// The sheet would be larger than a picture can be.
    #[error(
        "a contact sheet of {width}×{height} pixels is too large (at most {side} a side and {MAX_PIXELS} in all): \
         use fewer or smaller pictures",
        side = Grid::<()>::MAX_SIDE
    )]
    TooLarge {
        /// Width it would have, in pixels.
        width: u64,
        /// Height it would have, in pixels.
        height: u64,
    },
}

/// Draws tiles on a sheet, row by row from the top left, with a headline above and notes below.
///
/// `columns` is the number of tiles per row (at least 1); `None` chooses one that makes the sheet a little wider than high
/// with few places left empty. All tiles are as wide as the widest picture; smaller ones are centred. Lines that do not fit
/// their tile end in an ellipsis; notes are wrapped. Text may be anything: what the bitmap fonts (Latin-1) lack is spelt
/// out (`≤` as `<=`) or becomes a question mark. An empty title or no notes leave no gap, and no tiles are no error.
///
/// # Errors
/// If the sheet would be larger than [`Grid::MAX_SIDE`] in width or height, or than 2²⁸ pixels.
pub fn contact_sheet(
    title: &str,
    tiles: &[Tile],
    columns: Option<u32>,
    notes: &[String],
) -> Result<Grid<[u8; 3]>, SheetError> {
    let size = |tile: &Tile| [tile.picture.width(), tile.picture.height()];
    let content = Content::new(title, tiles.iter().map(|tile| Card::new(size(tile), &tile.lines)).collect(), notes);
    let layout = checked(content.layout_for(columns))?;
    let mut sheet = Grid::from_fn(layout.width as u32, layout.height as u32, |_, _| BACKGROUND);
    let pictures: Vec<&Grid<[u8; 3]>> = tiles.iter().map(|tile| &tile.picture).collect();
    content.draw(&layout, &pictures, &mut Canvas(&mut sheet));
    Ok(sheet)
}

/// Checks that [`contact_sheet`] can draw `tiles` pictures of one size, each with `lines` lines under it, in columns of
/// its own choice.
///
/// # Errors
/// If the sheet would be too large.
pub(crate) fn check_size(picture: [u32; 2], tiles: usize, lines: usize) -> Result<(), SheetError> {
    let lines = vec![String::new(); lines];
    let cards = (0..tiles).map(|_| Card::new(picture, &lines)).collect();
    checked(Content::new("", cards, &[]).layout_for(None)).map(drop)
}

/// Returns an error if a sheet would be too large.
fn checked(layout: Layout) -> Result<Layout, SheetError> {
    if layout.fits() { Ok(layout) } else { Err(SheetError::TooLarge { width: layout.width, height: layout.height }) }
}
