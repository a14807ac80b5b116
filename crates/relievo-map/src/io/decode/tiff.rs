//! TIFF files that the `image` crate refuses and that height maps come in: one channel of floats (16, 32 or
//! 64 bits), of signed or of 32-bit integers; grey with alpha.

use std::io::Cursor;

use tiff::decoder::{Decoder, DecodingResult, Limits as TiffLimits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

use super::request::DecodeRequest;
use crate::io::error::MapError;
use crate::io::raster::{Raster, Samples};

/// IEEE floats, in the tag `SampleFormat`.
const FLOAT: u16 = 3;
/// Two's complement, in the tag `SampleFormat`.
const SIGNED: u16 = 2;

/// True if the file is one that the `image` crate refuses and that is decoded here.
pub(super) fn is_decoded_here(bytes: &[u8]) -> bool {
    let inspect = || -> Result<bool, TiffError> {
        let mut decoder = Decoder::new(Cursor::new(bytes))?;
        let sample = decoder.find_tag_unsigned_vec::<u16>(Tag::SampleFormat)?.and_then(|v| v.first().copied());
        Ok(match decoder.colortype()? {
            ColorType::Gray(bits) => matches!(sample, Some(FLOAT | SIGNED)) || bits > 16,
            ColorType::Multiband { num_samples: 2, .. } => true,
            _ => false,
        })
    };
    inspect().unwrap_or(false)
}

/// Decodes such a file.
pub(super) fn decode(name: &str, bytes: &[u8], request: DecodeRequest<'_>) -> Result<Raster, MapError> {
    let failed = |error| from_tiff_error(name, error);
    let variant = |what: &str| MapError::Variant { name: name.to_owned(), format: "TIFF", what: what.to_owned() };
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(failed)?;
    let (width, height) = decoder.dimensions().map_err(failed)?;
    let color = decoder.colortype().map_err(failed)?;
    let stored = u64::from(color.bit_depth()).div_ceil(8) * u64::from(color.num_samples());
    // Four bytes more per sample, as it is turned into a float.
    let floats = 4 * u64::from(color.num_samples());
    request.limits.check(name, width, height, stored + floats + request.map_bytes)?;
    let mut limits = TiffLimits::default();
    let most = usize::try_from(request.limits.max_bytes).unwrap_or(usize::MAX);
    (limits.decoding_buffer_size, limits.intermediate_buffer_size) = (most, most);
    decoder = decoder.with_limits(limits);

    if color.num_samples() > 1 && decoder.find_tag_unsigned::<u16>(Tag::PlanarConfiguration).map_err(failed)? == Some(2)
    {
        return Err(variant("its channels are stored one after the other (planar)"));
    }
    let decoded = decoder.read_image().map_err(failed)?;
    let (channels, samples) = (usize::from(color.num_samples()), to_samples(decoded));
    let count = match &samples {
        Samples::U8(s) => s.len(),
        Samples::U16(s) => s.len(),
        Samples::F32(s) => s.len(),
    };
    if count as u64 != u64::from(width) * u64::from(height) * channels as u64 {
        return Err(MapError::Damaged {
            name: name.to_owned(),
            format: "TIFF",
            reason: format!("it holds {count} samples for {width}×{height} texels"),
        });
    }
    let bits = color.bit_depth().into();
    Ok(Raster { width, height, channels, samples, bits, notes: Vec::new() })
}

/// Converts samples: unsigned integers to fractions of the maximum, signed integers and floats as they are.
fn to_samples(decoded: DecodingResult) -> Samples {
    Samples::F32(match decoded {
        DecodingResult::U8(v) => return Samples::U8(v),
        DecodingResult::U16(v) => return Samples::U16(v),
        DecodingResult::F32(v) => v,
        DecodingResult::U32(v) => v.into_iter().map(|x| (f64::from(x) / f64::from(u32::MAX)) as f32).collect(),
        DecodingResult::U64(v) => v.into_iter().map(|x| (x as f64 / u64::MAX as f64) as f32).collect(),
        DecodingResult::F16(v) => v.into_iter().map(exr::prelude::f16::to_f32).collect(),
        DecodingResult::F64(v) => v.into_iter().map(|x| x as f32).collect(),
        DecodingResult::I8(v) => v.into_iter().map(f32::from).collect(),
        DecodingResult::I16(v) => v.into_iter().map(f32::from).collect(),
        DecodingResult::I32(v) => v.into_iter().map(|x| x as f32).collect(),
        DecodingResult::I64(v) => v.into_iter().map(|x| x as f32).collect(),
    })
}

fn from_tiff_error(name: &str, error: TiffError) -> MapError {
    let (name, format) = (name.to_owned(), "TIFF");
    match error {
        TiffError::UnsupportedError(error) => MapError::Variant { name, format, what: error.to_string() },
        TiffError::LimitsExceeded => {
            MapError::Variant { name, format, what: "decoding it takes more memory than allowed".to_owned() }
        }
        TiffError::IoError(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => {
            MapError::Damaged { name, format, reason: "it ends too early".to_owned() }
        }
        error => MapError::Damaged { name, format, reason: error.to_string() },
    }
}
