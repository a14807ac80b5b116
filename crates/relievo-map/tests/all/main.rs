//! Image files in every format, damaged and refused, and the folders of map libraries.

mod common;
mod damage;
mod folders;
mod formats;
mod refusals;
mod write;
