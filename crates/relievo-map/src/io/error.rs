use std::io;

use thiserror::Error;

use crate::types::GridError;

/// Why a map could not be read, written or found. The text is a whole sentence for a person: which file, what was
/// expected, what to do.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MapError {
    /// Nothing is there.
    #[error("{name}: there is no such file; check the spelling, and what the path is relative to")]
    Missing {
        /// The file as it was asked for.
        name: String,
    },
    /// A folder, a pipe, a device, …
    #[error("{name}: this is {what}, not a regular file; give the path of an image file")]
    NotAFile {
        /// The path as it was asked for.
        name: String,
        /// What it is, with its article.
        what: &'static str,
    },
    /// A material folder was expected.
    #[error("{name}: this is not a folder; give the folder that holds the maps of one material")]
    NotAFolder {
        /// The path as it was asked for.
        name: String,
    },
    /// The operating system said no.
    #[error("{name}: cannot {doing}: {source}")]
    Io {
        /// The file.
        name: String,
        /// What was tried, as a verb: "read", "write", …
        doing: &'static str,
        /// What the operating system said.
        source: io::Error,
    },
    /// No bytes at all.
    #[error("{name}: the file is empty; was it cut short while it was copied or downloaded?")]
    Empty {
        /// The file.
        name: String,
    },
    /// The content is of no image format.
    #[error("{name}: not an image that can be read: its content is {what}; expected {READABLE}")]
    NotAnImage {
        /// The file.
        name: String,
        /// What the content looks like.
        what: &'static str,
    },
    /// An image, but of a format that is not read.
    #[error("{name}: this is {format}, which is not read; convert it to PNG or OpenEXR (expected {READABLE})")]
    OtherFormat {
        /// The file.
        name: String,
        /// The format, with its article.
        format: &'static str,
    },
    /// A known format, but a variant of it that is not read.
    #[error("{name}: this {format} file cannot be read: {what}; save it as PNG (8 or 16 bits) or as OpenEXR")]
    Variant {
        /// The file.
        name: String,
        /// The format.
        format: &'static str,
        /// What is not supported.
        what: String,
    },
    /// The file breaks the rules of its format, or ends too early.
    #[error("{name}: the {format} file is damaged or cut short: {reason}; copy, download or export it again")]
    Damaged {
        /// The file.
        name: String,
        /// The format.
        format: &'static str,
        /// What the decoder found.
        reason: String,
    },
    /// A side of the image is over [`Limits::max_side`](crate::Limits::max_side), or 0.
    #[error("{name}: the image is {width}×{height}, but each side must be 1 to {max_side}; {}", if *width == 0 || *height == 0 { "export it again" } else { "scale it down or raise the limit on sides" })]
    Size {
        /// The file.
        name: String,
        /// Texels per row.
        width: u32,
        /// Rows.
        height: u32,
        /// The longest side allowed.
        max_side: u32,
    },
    /// Decoding would need more than [`Limits::max_bytes`](crate::Limits::max_bytes).
    #[error("{name}: the image is {width}×{height} and takes {} MiB to decode, but the limit is {} MiB; scale it down or raise the limit on bytes", mib(*needed), mib(*max_bytes))]
    Bytes {
        /// The file.
        name: String,
        /// Texels per row.
        width: u32,
        /// Rows.
        height: u32,
        /// Bytes needed, the decoded file and the map together.
        needed: u64,
        /// The most bytes allowed.
        max_bytes: u64,
    },
    /// The file itself, before decoding, is over [`Limits::max_bytes`](crate::Limits::max_bytes).
    #[error("{name}: the file has {} MiB, but the limit is {} MiB; give a smaller image or raise the limit on bytes", mib(*bytes), mib(*max_bytes))]
    FileSize {
        /// The file.
        name: String,
        /// Bytes in the file (at least).
        bytes: u64,
        /// The most bytes allowed.
        max_bytes: u64,
    },
    /// The system has not enough memory for the image.
    #[error("{name}: not enough memory for {width}×{height} texels; scale the image down")]
    Memory {
        /// The file.
        name: String,
        /// Texels per row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// NaN or infinity where a number is needed.
    #[error(
        "{name}: {count} of {total} texels are not finite numbers (NaN or infinity), the first in column {x}, row {y}; repair the map where it was made"
    )]
    NotFinite {
        /// The file.
        name: String,
        /// Texels with NaN or infinity.
        count: usize,
        /// All texels.
        total: usize,
        /// Column of the first.
        x: u32,
        /// Row of the first, from the top.
        y: u32,
    },
    /// The file has not the channels that this use needs.
    #[error("{name}: {needed}, but this image has {has}; check that this is the right map")]
    Channels {
        /// The file.
        name: String,
        /// What needs which channels.
        needed: &'static str,
        /// The channels of the file.
        has: String,
    },
    /// No file in the folder is a map.
    #[error("{name}: no maps were recognised by their names here{}; expected names that end in {known}", if ignored.is_empty() { String::new() } else { format!(" (seen: {ignored})") })]
    NoMaps {
        /// The folder.
        name: String,
        /// Some of the files seen, separated by commas; may be empty.
        ignored: String,
        /// The endings that are known.
        known: &'static str,
    },
    /// The name of an output does not end in a format that this map can be written as.
    #[error("{name}: cannot tell the format to write from this name; end it in {expected}")]
    Extension {
        /// The output path.
        name: String,
        /// The endings allowed.
        expected: &'static str,
    },
    /// A map cannot have this size.
    #[error(transparent)]
    Grid(#[from] GridError),
}

/// The formats that are read, for messages.
const READABLE: &str = "PNG, JPEG, TIFF, OpenEXR, Radiance HDR, TGA, BMP or WebP";

/// Mebibytes, rounded up, so that "needs" is never shown below "limit".
fn mib(bytes: u64) -> u64 {
    bytes.div_ceil(1 << 20)
}
