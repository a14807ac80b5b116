//! Decoding of image files of every format to a [`Raster`].

mod jpeg;
mod openexr;
mod request;
mod tiff;

use std::any::Any;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

use image::codecs::{bmp::BmpDecoder, hdr::HdrDecoder, jpeg::JpegDecoder, png::PngDecoder, tga::TgaDecoder};
use image::codecs::{tiff::TiffDecoder, webp::WebPDecoder};
use image::error::{ImageError, LimitErrorKind, UnsupportedErrorKind};
use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder};

use super::error::MapError;
use super::file_format::FileFormat;
use super::raster::Raster;
pub(crate) use request::DecodeRequest;

/// Decodes an image file that is in memory. `name` is for messages (and a hint, for TGA).
pub(crate) fn decode(name: &str, bytes: &[u8], request: DecodeRequest<'_>) -> Result<Raster, MapError> {
    let format = FileFormat::of(name, bytes)?;
    let decode = || match format {
        FileFormat::Exr => openexr::decode(name, bytes, request),
        FileFormat::Tiff if tiff::is_decoded_here(bytes) => tiff::decode(name, bytes, request),
        _ => decode_image(name, format, bytes, request),
    };
    // The decoders are other people's, and what they do with a file made to break them is not ours to promise.
    catch_unwind(AssertUnwindSafe(decode)).unwrap_or_else(|cause| {
        let reason = format!("the decoder gave up ({})", panic_message(cause.as_ref()));
        Err(MapError::Damaged { name: name.to_owned(), format: format.name(), reason })
    })
}

fn panic_message(cause: &(dyn Any + Send)) -> &str {
    cause.downcast_ref::<&str>().copied().or(cause.downcast_ref::<String>().map(String::as_str)).unwrap_or("no reason")
}

/// Decodes the formats that the `image` crate handles.
fn decode_image(name: &str, format: FileFormat, bytes: &[u8], request: DecodeRequest<'_>) -> Result<Raster, MapError> {
    let failed = |error| from_image_error(name, format, error);
    let source = Cursor::new(bytes);
    match format {
        FileFormat::Png => {
            // The decoder refuses large images without telling their size.
            if let Some((width, height)) = png_size(bytes) {
                request.limits.check(name, width, height, 1)?;
            }
            let decoder = PngDecoder::with_limits(source, request.limits.for_decoder()).map_err(failed)?;
            let mut raster = read(name, format, decoder, request)?;
            // Byte 24 is the bit depth; palettes (colour type 3) hold 8-bit colours whatever their index takes.
            if let (Some(&bits), Some(&kind)) = (bytes.get(24), bytes.get(25))
                && kind != 3
            {
                raster.bits = bits.into();
            }
            Ok(raster)
        }
        FileFormat::Jpeg => {
            if !jpeg::is_complete(bytes) {
                let reason = "it stops before the end-of-image marker".to_owned();
                return Err(MapError::Damaged { name: name.to_owned(), format: format.name(), reason });
            }
            read(name, format, JpegDecoder::new(source).map_err(failed)?, request)
        }
        FileFormat::WebP => read(name, format, WebPDecoder::new(source).map_err(failed)?, request),
        FileFormat::Bmp => read(name, format, BmpDecoder::new(source).map_err(failed)?, request),
        FileFormat::Tga => read(name, format, TgaDecoder::new(source).map_err(failed)?, request),
        FileFormat::Tiff => read(name, format, TiffDecoder::new(source).map_err(failed)?, request),
        FileFormat::Hdr => {
            // Strict means the signature `#?RADIANCE`; many programs write `#?RGBE`.
            let strict = bytes.starts_with(b"#?RADIANCE");
            read(name, format, HdrDecoder::with_strictness(source, strict).map_err(failed)?, request)
        }
        FileFormat::Exr => openexr::decode(name, bytes, request),
    }
}

/// Checks the size, then decodes.
fn read(
    name: &str,
    format: FileFormat,
    mut decoder: impl ImageDecoder,
    request: DecodeRequest<'_>,
) -> Result<Raster, MapError> {
    let failed = |error| from_image_error(name, format, error);
    let (width, height) = decoder.dimensions();
    let decoded = u64::from(decoder.color_type().bytes_per_pixel());
    request.limits.check(name, width, height, decoded + request.map_bytes)?;
    decoder.set_limits(request.limits.for_decoder()).map_err(failed)?;
    // A photograph whose orientation cannot be read is a photograph all the same.
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    let mut image = DynamicImage::from_decoder(decoder).map_err(failed)?;
    let mut note = None;
    if orientation != Orientation::NoTransforms {
        if request.upright {
            image.apply_orientation(orientation);
            note = Some(format!("{name}: turned upright, as the file's orientation tag says."));
        } else {
            note =
                Some(format!("{name}: the file's orientation tag was ignored, as normals cannot be turned with it."));
        }
    }
    let mut raster = Raster::from_image(image).ok_or_else(|| MapError::Variant {
        name: name.to_owned(),
        format: format.name(),
        what: "its kind of samples is not known".to_owned(),
    })?;
    raster.notes.extend(note);
    Ok(raster)
}

/// Width and height from a PNG's first chunk.
fn png_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let number = |at: usize| bytes.get(at..)?.first_chunk().map(|b| u32::from_be_bytes(*b));
    (bytes.get(12..16)? == b"IHDR").then_some((number(16)?, number(20)?))
}

/// Converts the decoder's error.
fn from_image_error(name: &str, format: FileFormat, error: ImageError) -> MapError {
    let (name, format) = (name.to_owned(), format.name());
    match error {
        ImageError::Unsupported(error) => {
            let what = match error.kind() {
                UnsupportedErrorKind::Color(color) => format!("its kind of texels ({color:?}) is not supported"),
                UnsupportedErrorKind::GenericFeature(feature) => feature,
                _ => error.to_string(),
            };
            MapError::Variant { name, format, what }
        }
        ImageError::Limits(error) if error.kind() == LimitErrorKind::InsufficientMemory => {
            MapError::Variant { name, format, what: "decoding it takes more memory than allowed".to_owned() }
        }
        ImageError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            MapError::Damaged { name, format, reason: "it ends too early".to_owned() }
        }
        error => MapError::Damaged { name, format, reason: error.to_string() },
    }
}
