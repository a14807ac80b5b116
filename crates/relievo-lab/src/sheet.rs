//! Contact sheets: pictures side by side with their titles and figures.

mod canvas;
mod scale;
mod text;

use canvas::{Area, Canvas, Color};
use relievo_map::Grid;
pub(crate) use scale::scale;
use text::{BODY, HEADLINE, TITLE, printable};
use thiserror::Error;

/// A picture on a contact sheet and what is written under it.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// The picture, 8-bit sRGB; it is shown pixel by pixel, never scaled.
    pub picture: Grid<[u8; 3]>,
    /// What is written under it; the first line is its title. In the others, what follows a tab is set at the right edge
    /// and brighter: `"FLIP\t0.012"`.
    pub lines: Vec<String>,
}

/// Why a contact sheet could not be drawn.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
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

/// Of a sheet; 768 MiB.
const MAX_PIXELS: u64 = 1 << 28;

/// Around everything.
const MARGIN: u32 = 24;
/// Between tiles.
const GUTTER: u32 = 16;
/// Room for the mark before the headline.
const HEADLINE_INDENT: u32 = 14;
/// Between the edge of a tile and its text.
const PADDING: u32 = 12;
/// Pictures narrower than their text get a wider tile, up to this.
const LABEL_WIDTH: u32 = 240;
const NARROWEST_TILE: u32 = 96;
/// The title and the notes widen a narrow sheet up to this.
const TEXT_WIDTH: u32 = 640;
/// The shape automatic columns aim at, width by height.
const ASPECT: f64 = 1.5;
const MOST_AUTOMATIC_COLUMNS: u32 = 64;

const BACKGROUND: Color = [19, 21, 26];
const CARD: Color = [31, 34, 42];
/// Around pictures smaller than their neighbours.
const MAT: Color = [13, 14, 18];
const ACCENT: Color = [240, 150, 84];
const BRIGHT: Color = [240, 242, 247];
const PLAIN: Color = [178, 186, 201];
const DIM: Color = [140, 148, 165];

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
    let layout = content.checked_layout(columns)?;
    let mut sheet = Grid::from_fn(layout.width as u32, layout.height as u32, |_, _| BACKGROUND);
    content.draw(&layout, tiles, &mut Canvas(&mut sheet));
    Ok(sheet)
}

/// Whether [`contact_sheet`] could draw `tiles` pictures of one size, each with `lines` lines under it, in columns of its
/// own choice.
///
/// # Errors
/// If the sheet would be too large.
pub(crate) fn check_size(picture: [u32; 2], tiles: usize, lines: usize) -> Result<(), SheetError> {
    let lines = vec![String::new(); lines];
    let cards = (0..tiles).map(|_| Card::new(picture, &lines)).collect();
    Content::new("", cards, &[]).checked_layout(None).map(drop)
}

/// What is on a sheet, in printable text.
struct Content {
    title: String,
    cards: Vec<Card>,
    notes: Vec<String>,
}

/// Where things are on a sheet. In u64: it may turn out too large to be drawn.
struct Layout {
    columns: usize,
    tile_width: u64,
    /// Per row of tiles: the height of its pictures and of the text below them.
    rows: Vec<(u64, u64)>,
    notes: Vec<String>,
    width: u64,
    height: u64,
}

impl Layout {
    fn fits(&self) -> bool {
        let side = u64::from(Grid::<()>::MAX_SIDE);
        self.width <= side && self.height <= side && self.width * self.height <= MAX_PIXELS
    }
}

impl Content {
    fn new(title: &str, cards: Vec<Card>, notes: &[String]) -> Self {
        Self { title: printable(title), cards, notes: notes.iter().map(|note| printable(note)).collect() }
    }

    fn checked_layout(&self, columns: Option<u32>) -> Result<Layout, SheetError> {
        let layout = match columns {
            Some(columns) => self.layout(columns),
            None => self.best_layout(),
        };
        if layout.fits() {
            Ok(layout)
        } else {
            Err(SheetError::TooLarge { width: layout.width, height: layout.height })
        }
    }

    fn best_layout(&self) -> Layout {
        let most = (self.cards.len() as u32).clamp(1, MOST_AUTOMATIC_COLUMNS);
        let mut best = self.layout(1);
        for columns in 2..=most {
            let layout = self.layout(columns);
            if self.ugliness(&layout) < self.ugliness(&best) {
                best = layout;
            }
        }
        best
    }

    fn ugliness(&self, layout: &Layout) -> f64 {
        let places = (layout.columns * layout.rows.len()).max(1) as f64;
        let empty = 1.0 - self.cards.len() as f64 / places;
        (layout.width as f64 / layout.height as f64 / ASPECT).ln().abs() + 3.0 * empty
    }

    fn layout(&self, columns: u32) -> Layout {
        // More columns than tiles would only widen the sheet.
        let columns = (columns as usize).clamp(1, self.cards.len().max(1));
        let tile_width = u64::from(self.cards.iter().map(Card::width).max().unwrap_or(0));
        let rows: Vec<(u64, u64)> = self
            .cards
            .chunks(columns)
            .map(|row| {
                let pictures = row.iter().map(|card| card.picture[1]).max();
                let text = row.iter().map(Card::text_height).max();
                (u64::from(pictures.unwrap_or(0)), text.unwrap_or(0))
            })
            .collect();

        let tiles = columns as u64 * (tile_width + u64::from(GUTTER)) - u64::from(GUTTER);
        let longest_note = self.notes.iter().map(|note| BODY.width(note)).max().unwrap_or(0);
        let heading = HEADLINE.width(&self.title) + HEADLINE_INDENT;
        let inner = tiles.max(u64::from(heading.max(longest_note).min(TEXT_WIDTH)));
        let wrap_at = u32::try_from(inner).unwrap_or(u32::MAX);
        let notes: Vec<String> = self.notes.iter().flat_map(|note| BODY.wrap(note, wrap_at)).collect();

        let mut parts = Vec::with_capacity(rows.len() + 2);
        if !self.title.is_empty() {
            parts.push(u64::from(HEADLINE.line_height));
        }
        parts.extend(rows.iter().map(|(pictures, text)| pictures + text));
        if !notes.is_empty() {
            parts.push(notes.len() as u64 * u64::from(BODY.line_height));
        }
        let gaps = u64::from(GUTTER) * (parts.len() as u64).saturating_sub(1);
        let margins = 2 * u64::from(MARGIN);
        Layout {
            columns,
            tile_width,
            rows,
            notes,
            width: inner + margins,
            height: parts.iter().sum::<u64>() + gaps + margins,
        }
    }

    /// Draws everything; the layout must fit the canvas.
    fn draw(&self, layout: &Layout, tiles: &[Tile], canvas: &mut Canvas<'_>) {
        let inner = layout.width as u32 - 2 * MARGIN;
        let mut y = MARGIN;
        if !self.title.is_empty() {
            canvas.fill(Area { x: MARGIN, y, width: 4, height: HEADLINE.height() }, ACCENT);
            let title = HEADLINE.fit(&self.title, inner - HEADLINE_INDENT);
            canvas.text(MARGIN + HEADLINE_INDENT, y, &title, HEADLINE, BRIGHT);
            y += HEADLINE.line_height + GUTTER;
        }
        let tile_width = layout.tile_width as u32;
        let rows = self.cards.chunks(layout.columns).zip(tiles.chunks(layout.columns));
        for ((row, tiles), &(pictures, text)) in rows.zip(&layout.rows) {
            let (pictures, height) = (pictures as u32, (pictures + text) as u32);
            for ((card, tile), column) in row.iter().zip(tiles).zip(0..) {
                let x = MARGIN + column * (tile_width + GUTTER);
                card.draw(canvas, Area { x, y, width: tile_width, height }, pictures, &tile.picture);
            }
            y += height + GUTTER;
        }
        for note in &layout.notes {
            canvas.text(MARGIN, y, note, BODY, DIM);
            y += BODY.line_height;
        }
    }
}

/// A tile with its text made printable.
struct Card {
    /// Width and height of its picture.
    picture: [u32; 2],
    title: Option<String>,
    /// Each with what goes to the right edge.
    lines: Vec<(String, String)>,
}

impl Card {
    fn new(picture: [u32; 2], lines: &[String]) -> Self {
        let mut lines = lines.iter();
        Self {
            picture,
            title: lines.next().map(|title| printable(title)),
            lines: lines
                .map(|line| line.split_once('\t').unwrap_or((line, "")))
                .map(|(left, right)| (printable(left), printable(right)))
                .collect(),
        }
    }

    fn width(&self) -> u32 {
        let line = |(left, right): &(String, String)| {
            BODY.width(left) + if right.is_empty() { 0 } else { BODY.width(right) + 2 * BODY.advance() }
        };
        let title = self.title.as_deref().map_or(0, |title| TITLE.width(title));
        let text = self.lines.iter().map(line).fold(title, u32::max);
        self.picture[0].max((text + 2 * PADDING).min(LABEL_WIDTH)).max(NARROWEST_TILE)
    }

    fn text_height(&self) -> u64 {
        let title = self.title.as_ref().map_or(0, |_| u64::from(2 * PADDING + TITLE.line_height));
        title + self.lines.len() as u64 * u64::from(BODY.line_height)
    }

    /// Draws the card into `area`, its picture amid the uppermost `picture_height` pixels.
    fn draw(&self, canvas: &mut Canvas<'_>, area: Area, picture_height: u32, picture: &Grid<Color>) {
        canvas.fill(area, CARD);
        canvas.fill(Area { height: picture_height, ..area }, MAT);
        let [w, h] = self.picture;
        canvas.picture(area.x + (area.width - w) / 2, area.y + (picture_height - h) / 2, picture);

        let (x, width) = (area.x + PADDING, area.width - 2 * PADDING);
        let mut y = area.y + picture_height + PADDING;
        if let Some(title) = &self.title {
            canvas.text(x, y, &TITLE.fit(title, width), TITLE, BRIGHT);
            y += TITLE.line_height;
        }
        for (left, right) in &self.lines {
            let right = BODY.fit(right, width);
            let taken = BODY.width(&right);
            canvas.text(x + width - taken, y, &right, BODY, BRIGHT);
            let gap = if right.is_empty() { 0 } else { BODY.advance() };
            canvas.text(x, y, &BODY.fit(left, width.saturating_sub(taken + gap)), BODY, PLAIN);
            y += BODY.line_height;
        }
    }
}

#[cfg(test)]
mod tests;
