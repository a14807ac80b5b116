//! Image files in and out.

mod atomic;
mod decode;
mod error;
mod file;
mod file_format;
mod limits;
mod loaded;
mod raster;
mod read;
mod write;
mod write_film;

pub use atomic::write_atomic;
pub use error::MapError;
pub use file_format::IMAGE_EXTENSIONS;
pub use limits::Limits;
pub use loaded::Loaded;
pub use read::{
    decode_color, decode_height, decode_normal, decode_scalar, read_color, read_height, read_normal, read_scalar,
};
pub use write::{
    BitDepth, FileTexel, encode_png, write_color, write_exr, write_height, write_normal, write_picture, write_png8,
    write_png16, write_scalar,
};
pub use write_film::{FilmFormat, FilmShape, write_film};

pub(crate) use file::name_of;
pub(crate) use read::{read_packed, to_scalar};
