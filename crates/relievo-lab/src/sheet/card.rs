use relievo_map::Grid;

use super::canvas::{Area, Canvas, Color};
use super::dimensions::{LABEL_WIDTH, MIN_TILE_WIDTH, PADDING};
use super::text::{BODY, TITLE, printable};
use crate::colors::sheet::{BRIGHT, CARD, MAT, PLAIN};

/// A tile with its text in printable form.
pub(super) struct Card {
    /// Width and height of its picture.
    pub(super) picture: [u32; 2],
    title: Option<String>,
    /// Text at the left edge and text at the right edge.
    lines: Vec<(String, String)>,
}

impl Card {
    pub(super) fn new(picture: [u32; 2], lines: &[String]) -> Self {
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

    pub(super) fn width(&self) -> u32 {
        let line = |(left, right): &(String, String)| {
            BODY.width(left) + if right.is_empty() { 0 } else { BODY.width(right) + 2 * BODY.advance() }
        };
        let title = self.title.as_deref().map_or(0, |title| TITLE.width(title));
        let text = self.lines.iter().map(line).fold(title, u32::max);
        self.picture[0].max((text + 2 * PADDING).min(LABEL_WIDTH)).max(MIN_TILE_WIDTH)
    }

    pub(super) fn text_height(&self) -> u64 {
        let title = self.title.as_ref().map_or(0, |_| u64::from(2 * PADDING + TITLE.line_height));
        title + self.lines.len() as u64 * u64::from(BODY.line_height)
    }

    /// Draws the card into `area`, its picture amid the uppermost `picture_height` pixels.
    pub(super) fn draw(&self, canvas: &mut Canvas<'_>, area: Area, picture_height: u32, picture: &Grid<Color>) {
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
