use relievo_map::Grid;

use super::canvas::{Area, Canvas};
use super::card::Card;
use super::dimensions::{GUTTER, HEADLINE_INDENT, MARGIN, MAX_PIXELS, TEXT_WIDTH};
use super::text::{BODY, HEADLINE, printable};
use crate::colors::sheet::{ACCENT, BRIGHT, DIM};

/// The aspect ratio that automatic columns aim at, width by height.
const ASPECT: f64 = 1.5;
const MAX_AUTOMATIC_COLUMNS: u32 = 64;

/// The content of a sheet, in printable text.
pub(super) struct Content {
    title: String,
    cards: Vec<Card>,
    notes: Vec<String>,
}

/// Positions and sizes on a sheet, in pixels. In u64: a sheet may be too large to be drawn.
pub(super) struct Layout {
    columns: usize,
    tile_width: u64,
    /// Height of the pictures and of the text below them, per row of tiles.
    rows: Vec<(u64, u64)>,
    notes: Vec<String>,
    pub(super) width: u64,
    pub(super) height: u64,
}

impl Layout {
    /// Returns true if the sheet is small enough to be drawn.
    pub(super) fn fits(&self) -> bool {
        let side = u64::from(Grid::<()>::MAX_SIDE);
        self.width <= side && self.height <= side && self.width * self.height <= MAX_PIXELS
    }
}

impl Content {
    pub(super) fn new(title: &str, cards: Vec<Card>, notes: &[String]) -> Self {
        Self { title: printable(title), cards, notes: notes.iter().map(|note| printable(note)).collect() }
    }

    /// The layout with this number of columns, or with the best one.
    pub(super) fn layout_for(&self, columns: Option<u32>) -> Layout {
        columns.map_or_else(|| self.best_layout(), |columns| self.layout(columns))
    }

    fn best_layout(&self) -> Layout {
        let max_columns = (self.cards.len() as u32).clamp(1, MAX_AUTOMATIC_COLUMNS);
        let mut best = self.layout(1);
        for columns in 2..=max_columns {
            let layout = self.layout(columns);
            if self.cost(&layout) < self.cost(&best) {
                best = layout;
            }
        }
        best
    }

    /// The deviation from the best aspect ratio and the share of empty cells, weighted.
    fn cost(&self, layout: &Layout) -> f64 {
        let cells = (layout.columns * layout.rows.len()).max(1) as f64;
        let empty = 1.0 - self.cards.len() as f64 / cells;
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
    pub(super) fn draw(&self, layout: &Layout, pictures: &[&Grid<[u8; 3]>], canvas: &mut Canvas<'_>) {
        let inner = layout.width as u32 - 2 * MARGIN;
        let mut y = MARGIN;
        if !self.title.is_empty() {
            canvas.fill(Area { x: MARGIN, y, width: 4, height: HEADLINE.height() }, ACCENT);
            let title = HEADLINE.fit(&self.title, inner - HEADLINE_INDENT);
            canvas.text(MARGIN + HEADLINE_INDENT, y, &title, HEADLINE, BRIGHT);
            y += HEADLINE.line_height + GUTTER;
        }
        let tile_width = layout.tile_width as u32;
        let rows = self.cards.chunks(layout.columns).zip(pictures.chunks(layout.columns));
        for ((row, pictures), &(picture_height, text)) in rows.zip(&layout.rows) {
            let (picture_height, height) = (picture_height as u32, (picture_height + text) as u32);
            for ((card, picture), column) in row.iter().zip(pictures).zip(0..) {
                let x = MARGIN + column * (tile_width + GUTTER);
                card.draw(canvas, Area { x, y, width: tile_width, height }, picture_height, picture);
            }
            y += height + GUTTER;
        }
        for note in &layout.notes {
            canvas.text(MARGIN, y, note, BODY, DIM);
            y += BODY.line_height;
        }
    }
}
