//! The scale of a heat map.

use relievo_map::Grid;

use super::canvas::{Area, Canvas, Color};
use super::dimensions::{MARGIN, PADDING};
use super::text::{BODY, printable};
use crate::colors::heat_color;
use crate::colors::sheet::{BRIGHT, MAT, PLAIN};

const BAR_HEIGHT: u32 = 14;

/// Draws a panel with a heat map's name, the ramp from dark to light, and the values of its two ends. Text that does not
/// fit is cut.
pub(crate) fn scale(name: &str, dark: &str, light: &str, width: u32, height: u32) -> Grid<Color> {
    let mut panel = Grid::from_fn(width, height, |_, _| MAT);
    let mut canvas = Canvas(&mut panel);
    let x = MARGIN.min(width / 12);
    let bar = width - 2 * x;
    let used = 2 * BODY.line_height + BAR_HEIGHT;
    let mut y = height.saturating_sub(used) / 2;
    canvas.text(x, y, &BODY.fit(&printable(name), bar), BODY, BRIGHT);
    y += BODY.line_height;
    for i in 0..bar {
        let color = heat_color(i as f32 / bar.saturating_sub(1).max(1) as f32);
        canvas.fill(Area { x: x + i, y, width: 1, height: BAR_HEIGHT }, color);
    }
    y += BAR_HEIGHT + PADDING / 3;
    let light = BODY.fit(&printable(light), bar);
    let taken = BODY.width(&light);
    canvas.text(x + bar - taken, y, &light, BODY, PLAIN);
    canvas.text(x, y, &BODY.fit(&printable(dark), bar.saturating_sub(taken + BODY.advance())), BODY, PLAIN);
    panel
}
