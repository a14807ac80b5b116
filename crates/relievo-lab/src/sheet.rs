//! Contact sheets: pictures side by side with their titles and figures.

mod canvas;
mod card;
mod contact_sheet;
mod dimensions;
mod layout;
mod scale;
mod text;

pub(crate) use contact_sheet::check_size;
pub use contact_sheet::{SheetError, Tile, contact_sheet};
pub(crate) use scale::scale;

#[cfg(test)]
mod tests;
