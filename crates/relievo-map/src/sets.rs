//! The maps of a material, found in a folder by the names of their files.

mod file_name;
mod folder;

pub use folder::{FolderMaps, find_maps, read_folder};
