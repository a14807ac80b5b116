//! The scale of a heat map, drawn where the map itself has nothing to show.

use super::canvas::{Area, Canvas, Color};
use super::text::{BODY, printable};
use super::{BRIGHT, MARGIN, MAT, PADDING, PLAIN};
use crate::heat_color;
use relievo_map::Grid;

const BAR_HEIGHT: u32 = 14;

/// A panel with a heat map's name, the ramp from dark to light, and what its two ends stand for. What does not fit is left
/// out.
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
