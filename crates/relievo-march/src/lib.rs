//! Rays through height fields: every parallax and relief technique behind one interface, and the exact oracle.

mod technique;

pub use technique::{Shadow, Technique};
