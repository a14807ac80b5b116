//! The maps of a material, found in a folder by the names of their files.

mod file_name;
mod find;
mod folder_maps;
mod listing;
mod main_material;
mod map_role;
mod map_slot;
mod name_tokens;
mod read_folder;
mod role_names;
mod selection;

pub use find::find_maps;
pub use folder_maps::FolderMaps;
pub use read_folder::read_folder;
