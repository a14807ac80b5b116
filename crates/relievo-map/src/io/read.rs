//! Typed maps from image files and from images in memory.

use std::path::Path;

use super::decode::{DecodeRequest, decode};
use super::error::MapError;
use super::file::{name_of, read_bytes};
use super::limits::Limits;
use super::loaded::Loaded;
use super::raster::{Raster, Samples};
use crate::types::{
    Channel, ColorEncoding, ColorMap, Grid, HeightMap, NormalMap, NormalY, ScalarMap, White, quantize8, quantize16,
};

/// Bytes per texel of the maps, for the limits.
const SCALAR_BYTES: u64 = 4;
const NORMAL_BYTES: u64 = 12;
const COLOR_BYTES: u64 = 16;

/// Reads a height map. Heights are linear numbers: never sRGB-decoded.
///
/// Integer files give value / maximum, 16 bits keep their depth. Float files with all values in [0, 1] are taken as
/// they are; otherwise their range becomes [0, 1], and a note gives the original range. A colour file gives its Rec.
/// 709 luminance, with a note when its channels differ. The result is always 1 = highest.
///
/// # Errors
/// If the file cannot be read or decoded, is over the limits, or a height is not a finite number.
pub fn read_height(path: &Path, white: White, limits: &Limits) -> Result<Loaded<HeightMap>, MapError> {
    to_height(&name_of(path), read_raster(path, limits, SCALAR_BYTES, true)?, white)
}

/// Decodes as [`read_height`] does, from the bytes of an image file; `name` stands for it in messages.
///
/// # Errors
/// As [`read_height`].
pub fn decode_height(name: &str, bytes: &[u8], white: White, limits: &Limits) -> Result<Loaded<HeightMap>, MapError> {
    to_height(name, decode(name, bytes, DecodeRequest { limits, map_bytes: SCALAR_BYTES, upright: true })?, white)
}

/// Reads a normal map; in memory +Y is up, whatever the file's convention.
///
/// Integer files are decoded with [`NormalMap::decode8`] and its like, float files with encoded normals by 0.5 = zero; float
/// files that store the vectors themselves are recognised. Normals are not normalised. A file whose blue is constant 0
/// (two-channel normals) gets z from x and y.
///
/// # Errors
/// If the file cannot be read or decoded, is over the limits, has no three channels, or a value is not a finite number.
pub fn read_normal(path: &Path, normal_y: NormalY, limits: &Limits) -> Result<Loaded<NormalMap>, MapError> {
    to_normal(&name_of(path), read_raster(path, limits, NORMAL_BYTES, false)?, normal_y)
}

/// Decodes as [`read_normal`] does, from the bytes of an image file; `name` stands for it in messages.
///
/// # Errors
/// As [`read_normal`].
pub fn decode_normal(
    name: &str,
    bytes: &[u8],
    normal_y: NormalY,
    limits: &Limits,
) -> Result<Loaded<NormalMap>, MapError> {
    to_normal(name, decode(name, bytes, DecodeRequest { limits, map_bytes: NORMAL_BYTES, upright: false })?, normal_y)
}

/// Reads colours as they are stored: integer files are sRGB, float files linear. Grey becomes R = G = B; a missing
/// alpha is 1.
///
/// # Errors
/// If the file cannot be read or decoded, or is over the limits.
pub fn read_color(path: &Path, limits: &Limits) -> Result<Loaded<ColorMap>, MapError> {
    to_color(&name_of(path), read_raster(path, limits, COLOR_BYTES, true)?)
}

/// Decodes as [`read_color`] does, from the bytes of an image file; `name` stands for it in messages.
///
/// # Errors
/// As [`read_color`].
pub fn decode_color(name: &str, bytes: &[u8], limits: &Limits) -> Result<Loaded<ColorMap>, MapError> {
    to_color(name, decode(name, bytes, DecodeRequest { limits, map_bytes: COLOR_BYTES, upright: true })?)
}

/// Reads one number per texel: roughness, metallic, ambient occlusion, alone or packed in one file with others.
///
/// Values are linear; those of float files are clamped to [0, 1], with a note.
///
/// # Errors
/// If the file cannot be read or decoded, is over the limits, has not the channel, or a value is not a finite number.
pub fn read_scalar(path: &Path, channel: Channel, limits: &Limits) -> Result<Loaded<ScalarMap>, MapError> {
    to_scalar(&name_of(path), &read_raster(path, limits, SCALAR_BYTES, true)?, channel)
}

/// Decodes as [`read_scalar`] does, from the bytes of an image file; `name` stands for it in messages.
///
/// # Errors
/// As [`read_scalar`].
pub fn decode_scalar(
    name: &str,
    bytes: &[u8],
    channel: Channel,
    limits: &Limits,
) -> Result<Loaded<ScalarMap>, MapError> {
    to_scalar(name, &decode(name, bytes, DecodeRequest { limits, map_bytes: SCALAR_BYTES, upright: true })?, channel)
}

/// Reads a packed file, whose scalar maps are taken out afterwards.
pub(crate) fn read_packed(path: &Path, limits: &Limits) -> Result<Raster, MapError> {
    read_raster(path, limits, 3 * SCALAR_BYTES, true)
}

/// Reads and decodes a file. Its bytes are freed before the map is made.
fn read_raster(path: &Path, limits: &Limits, map_bytes: u64, upright: bool) -> Result<Raster, MapError> {
    let bytes = read_bytes(path, limits)?;
    decode(&name_of(path), &bytes, DecodeRequest { limits, map_bytes, upright })
}

/// Returns the Rec. 709 luminance; exactly the grey of a grey texel.
fn luminance([r, g, b, _]: [f32; 4]) -> f32 {
    if r == g && g == b { r } else { 0.2126 * r + 0.7152 * g + 0.0722 * b }
}

fn to_height(name: &str, mut raster: Raster, white: White) -> Result<Loaded<HeightMap>, MapError> {
    let (mut spread, mut transparent) = (0.0f32, false);
    let mut heights = raster.texels(name, |texel| {
        let [r, g, b, a] = texel;
        spread = spread.max(r.max(g).max(b) - r.min(g).min(b));
        transparent |= a < 1.0;
        luminance(texel)
    })?;
    let mut notes = std::mem::take(&mut raster.notes);
    let (bits, float, (width, height)) = (raster.bits, raster.is_float(), (raster.width, raster.height));
    drop(raster);
    check_finite(name, width, heights.iter().map(|h| h.is_finite()))?;
    if spread > 0.0 {
        // JPEG and conversions leave a step or two in what was grey; more is another kind of picture.
        let doubt = if spread > 0.05 { " Is it the right file?" } else { "" };
        notes.push(format!(
            "{name}: the channels of this height map differ, by up to {:.1} %: its luminance was taken.{doubt}",
            100.0 * spread
        ));
    }
    if transparent {
        notes.push(format!("{name}: the alpha channel of this height map was ignored."));
    }
    if bits <= 8 {
        notes.push(format!(
            "{name}: {bits} bits, so {} steps of height: slopes may show terraces. 16-bit PNG or EXR keep more.",
            1u32 << bits
        ));
    }
    let (low, high) = heights.iter().fold((f32::MAX, f32::MIN), |(low, high), &h| (low.min(h), high.max(h)));
    if float && (low < 0.0 || high > 1.0) {
        if low < high {
            // In f64: the difference of two large floats may be infinite in f32.
            let (from, scale) = (f64::from(low), 1.0 / (f64::from(high) - f64::from(low)));
            for h in &mut heights {
                *h = ((f64::from(*h) - from) * scale) as f32;
            }
            notes.push(format!("{name}: heights from {low} to {high} were rescaled to 0 to 1."));
        } else {
            let flat = if white == White::High { 1.0 } else { 0.0 };
            heights.fill(flat);
            notes.push(format!("{name}: all heights are {low}, outside of 0 to 1: taken as flat, at the top."));
        }
    }
    if white == White::Deep {
        for h in &mut heights {
            *h = 1.0 - *h;
        }
    }
    Ok(Loaded { map: HeightMap::new(Grid::new(width, height, heights)?), notes })
}

fn to_normal(name: &str, mut raster: Raster, normal_y: NormalY) -> Result<Loaded<NormalMap>, MapError> {
    if raster.channels < 3 {
        return Err(MapError::Channels {
            name: name.to_owned(),
            needed: "a normal map needs red, green and blue",
            has: format!("{} (a height or bump map?)", raster.channels_in_words()),
        });
    }
    let mut normals = raster.texels(name, |[x, y, z, _]| [x, y, z])?;
    let mut notes = std::mem::take(&mut raster.notes);
    let (float, width, height) = (raster.is_float(), raster.width, raster.height);
    let unpack: fn(f32) -> f32 = match raster.samples {
        Samples::U8(_) => |c| NormalMap::decode8(quantize8(c)),
        Samples::U16(_) => |c| NormalMap::decode16(quantize16(c)),
        Samples::F32(_) => |c| 2.0 * c - 1.0,
    };
    drop(raster);
    check_finite(name, width, normals.iter().map(|n| n.iter().all(|c| c.is_finite())))?;

    // The vectors themselves, or encoded as integer files must: whichever comes nearer to unit length.
    let error = |decode: fn(f32) -> f32| -> f64 {
        let off = |n: &[f32; 3]| (n.iter().map(|&c| f64::from(decode(c)).powi(2)).sum::<f64>() - 1.0).abs();
        normals.iter().map(off).sum()
    };
    if float && error(|c| c) < error(unpack) {
        notes.push(format!("{name}: this file stores the vectors themselves (-1 to 1): taken as such."));
    } else {
        for c in normals.iter_mut().flatten() {
            *c = unpack(*c);
        }
    }
    if normals.iter().all(|n| n[2] <= -1.0) {
        for [x, y, z] in &mut normals {
            *z = (1.0 - *x * *x - *y * *y).max(0.0).sqrt();
        }
        notes.push(format!("{name}: its blue channel is empty: z was made from x and y."));
    } else if normals.iter().map(|n| f64::from(n[2])).sum::<f64>() < 0.0 {
        notes.push(format!("{name}: most of these vectors point into the surface. Is it a tangent-space normal map?"));
    }
    if normal_y == NormalY::Down {
        for n in &mut normals {
            // Not −y: the neutral 0 stays what it is.
            n[1] = 0.0 - n[1];
        }
    }
    Ok(Loaded { map: NormalMap::from_decoded(Grid::new(width, height, normals)?), notes })
}

fn to_color(name: &str, mut raster: Raster) -> Result<Loaded<ColorMap>, MapError> {
    // Environment maps do have an infinite sun; one such texel would swallow every sum it takes part in.
    let mut non_finite = 0usize;
    let texels = raster.texels(name, |texel| {
        non_finite += usize::from(texel.iter().any(|c| !c.is_finite()));
        texel.map(|c| if c.is_nan() { 0.0 } else { c.clamp(-MAX_F16, MAX_F16) })
    })?;
    let mut notes = std::mem::take(&mut raster.notes);
    if non_finite > 0 {
        notes.push(format!("{name}: {non_finite} texels with NaN or infinity: NaN became 0, infinity {MAX_F16}."));
    }
    let encoding = if raster.is_float() { ColorEncoding::Linear } else { ColorEncoding::Srgb };
    let (width, height) = (raster.width, raster.height);
    Ok(Loaded { map: ColorMap { grid: Grid::new(width, height, texels)?, encoding }, notes })
}

/// Largest half float.
const MAX_F16: f32 = 65504.0;

pub(crate) fn to_scalar(name: &str, raster: &Raster, channel: Channel) -> Result<Loaded<ScalarMap>, MapError> {
    if channel == Channel::Alpha && !raster.has_alpha() {
        return Err(MapError::Channels {
            name: name.to_owned(),
            needed: "the alpha channel is asked for",
            has: raster.channels_in_words().to_owned(),
        });
    }
    let (mut low, mut high, mut spread) = (f32::MAX, f32::MIN, 0.0f32);
    let values = raster.texels(name, |texel| {
        let [r, g, b, a] = texel;
        let value = match channel {
            Channel::Luminance => {
                spread = spread.max(r.max(g).max(b) - r.min(g).min(b));
                luminance(texel)
            }
            Channel::Red => r,
            Channel::Green => g,
            Channel::Blue => b,
            Channel::Alpha => a,
        };
        (low, high) = (low.min(value), high.max(value));
        value
    })?;
    check_finite(name, raster.width, values.iter().map(|v| v.is_finite()))?;
    let mut notes = raster.notes.clone();
    if low < 0.0 || high > 1.0 {
        notes.push(format!("{name}: values from {low} to {high} were clamped to 0 to 1."));
    }
    if spread > 2.5 / 255.0 {
        notes.push(format!(
            "{name}: this map is coloured, but one number per texel is needed: its luminance was taken."
        ));
    }
    Ok(Loaded { map: ScalarMap::new(Grid::new(raster.width, raster.height, values)?), notes })
}

/// Fails with the count of texels that are not finite, if there are any.
fn check_finite(name: &str, width: u32, finite: impl Iterator<Item = bool>) -> Result<(), MapError> {
    let (mut count, mut total, mut first) = (0, 0, None);
    for (i, finite) in finite.enumerate() {
        total += 1;
        if !finite {
            count += 1;
            first = first.or(Some(i));
        }
    }
    let Some(first) = first else { return Ok(()) };
    let (x, y) = ((first % width as usize) as u32, (first / width as usize) as u32);
    Err(MapError::NotFinite { name: name.to_owned(), count, total, x, y })
}
