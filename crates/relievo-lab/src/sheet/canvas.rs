//! Drawing of rectangles, pictures and text into a picture.

use std::convert::Infallible;

use embedded_graphics::Drawable;
use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Point, Size};
use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use embedded_graphics::text::{Baseline, Text};
use embedded_graphics::{Pixel, pixelcolor};
use relievo_map::Grid;

use super::text::{ELLIPSIS, Face};

pub(super) type Color = [u8; 3];

/// A rectangle of pixels: left, top, width, height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Area {
    pub(super) x: u32,
    pub(super) y: u32,
    pub(super) width: u32,
    pub(super) height: u32,
}

/// A picture to draw on. Drawing is clipped to it.
pub(super) struct Canvas<'a>(pub(super) &'a mut Grid<Color>);

impl Canvas<'_> {
    /// The part of row `y` from `x` on, at most `width` pixels.
    fn span(&mut self, x: u32, y: u32, width: u32) -> &mut [Color] {
        let (w, h) = (self.0.width(), self.0.height());
        if x >= w || y >= h {
            return &mut [];
        }
        let start = y as usize * w as usize + x as usize;
        let end = start + width.min(w - x) as usize;
        &mut self.0.texels_mut()[start..end]
    }

    /// Fills a rectangle.
    pub(super) fn fill(&mut self, area: Area, color: Color) {
        for y in area.y..area.y.saturating_add(area.height).min(self.0.height()) {
            self.span(area.x, y, area.width).fill(color);
        }
    }

    /// Copies a picture with its top left corner to (x, y).
    pub(super) fn picture(&mut self, x: u32, y: u32, picture: &Grid<Color>) {
        for (row, y) in picture.texels().chunks_exact(picture.width() as usize).zip(y..) {
            for (to, &from) in self.span(x, y, picture.width()).iter_mut().zip(row) {
                *to = from;
            }
        }
    }

    /// Draws a line of printable text with its top left corner at (x, y).
    pub(super) fn text(&mut self, x: u32, y: u32, text: &str, face: Face, color: Color) {
        let style = MonoTextStyle::new(face.font, Rgb888::new(color[0], color[1], color[2]));
        let mut at = x;
        let mut buffer = [0; 4];
        for c in text.chars() {
            if c == ELLIPSIS {
                self.ellipsis(at, y, face, color);
            } else {
                let glyph = c.encode_utf8(&mut buffer);
                for strike in 0..=u32::from(face.double_strike) {
                    let position = Point::new(at.saturating_add(strike) as i32, y as i32);
                    let Ok(_) = Text::with_baseline(glyph, position, style, Baseline::Top).draw(self);
                }
            }
            at = at.saturating_add(face.advance());
        }
    }

    fn ellipsis(&mut self, x: u32, y: u32, face: Face, color: Color) {
        let dot = face.height() / 10;
        let third = face.advance() / 3;
        for i in 0..3 {
            let area = Area { x: x + i * third, y: y + face.font.baseline + 1 - dot, width: dot, height: dot };
            self.fill(area, color);
        }
    }
}

impl OriginDimensions for Canvas<'_> {
    fn size(&self) -> Size {
        Size::new(self.0.width(), self.0.height())
    }
}

impl DrawTarget for Canvas<'_> {
    type Color = pixelcolor::Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(point, color) in pixels {
            if let (Ok(x), Ok(y)) = (u32::try_from(point.x), u32::try_from(point.y)) {
                self.span(x, y, 1).fill([color.r(), color.g(), color.b()]);
            }
        }
        Ok(())
    }
}
