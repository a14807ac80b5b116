//! `[image]`.

use crate::ImageSettings;
use crate::file::error::SceneError;
use crate::file::keys;
use crate::file::table::Table;

pub(in crate::file) fn image(root: &Table<'_>) -> Result<ImageSettings, SceneError> {
    let mut image = ImageSettings::default();
    let Some(table) = root.table("image", keys::IMAGE, keys::IMAGE)? else { return Ok(image) };
    let max_side = ImageSettings::MAX_SIDE;
    image.width = table.integer("width", 1, max_side)?.unwrap_or(image.width);
    image.height = table.integer("height", 1, max_side)?.unwrap_or(image.height);
    if u64::from(image.width) * u64::from(image.height) > ImageSettings::MAX_PIXELS {
        let max = ImageSettings::MAX_PIXELS;
        let message = format!("{} × {} pixels are too many: at most {max} in all", image.width, image.height);
        return Err(table.error("width", message));
    }
    let unit = |x: f32| (0.0..=1.0).contains(&x);
    image.background = table.numbers("background", "3 numbers from 0 to 1", unit)?.unwrap_or(image.background);
    image.samples = table.integer("samples", 1, ImageSettings::MAX_SAMPLES)?.unwrap_or(image.samples);
    Ok(image)
}
