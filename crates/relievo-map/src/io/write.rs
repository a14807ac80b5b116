//! Image files from maps: PNG with 8 or 16 bits, OpenEXR with 32-bit floats. The same map gives the same bytes.

use std::io::{self, Cursor, Write};
use std::path::Path;

use exr::image::write::WritableImage;
use exr::image::{Encoding, Image, Layer, SpecificChannels};
use exr::meta::attribute::LineOrder;
use exr::meta::header::LayerAttributes;
use exr::prelude::{Blocks, Compression};
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};

use super::atomic::write_atomic;
use super::error::MapError;
use crate::types::{ColorMap, Grid, HeightMap, NormalMap, NormalY, ScalarMap, quantize8, quantize16};

/// A texel that can be written: 1 channel (`f32`), 3 (`[f32; 3]`) or 4 (`[f32; 4]`, alpha last).
pub trait FileTexel: sealed::Sealed + Copy + Send + Sync {
    /// The channels in order.
    fn channels(&self) -> &[f32];
    /// Number of channels.
    const CHANNELS: usize;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for [f32; 3] {}
    impl Sealed for [f32; 4] {}
}

impl FileTexel for f32 {
    fn channels(&self) -> &[f32] {
        std::slice::from_ref(self)
    }
    const CHANNELS: usize = 1;
}

impl FileTexel for [f32; 3] {
    fn channels(&self) -> &[f32] {
        self
    }
    const CHANNELS: usize = 3;
}

impl FileTexel for [f32; 4] {
    fn channels(&self) -> &[f32] {
        self
    }
    const CHANNELS: usize = 4;
}

/// Bits per channel of a PNG file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BitDepth {
    /// 256 steps.
    Eight,
    /// 65536 steps.
    Sixteen,
}

/// Writes a grid as PNG with 8 bits per channel: grey, RGB or RGBA by its texels.
///
/// Values are in [0, 1], written as they are (no sRGB curve) and rounded by [`quantize8`]; outside is clamped, NaN
/// is 0. The file appears whole or not at all ([`write_atomic`]); its extension does not matter.
///
/// # Errors
/// If the file cannot be written.
pub fn write_png8<T: FileTexel>(path: &Path, grid: &Grid<T>) -> Result<(), MapError> {
    write_atomic(path, |out| png(out, grid, BitDepth::Eight))
}

/// Writes display RGB as it is, as PNG with 8 bits per channel; otherwise as [`write_png8`].
///
/// # Errors
/// If the file cannot be written.
pub fn write_picture(path: &Path, pixels: &Grid<[u8; 3]>) -> Result<(), MapError> {
    let bytes = pixels.texels().as_flattened();
    write_atomic(path, |out| png_bytes(out, bytes, pixels.width(), pixels.height(), ExtendedColorType::Rgb8))
}

/// Writes a grid as PNG with 16 bits per channel; otherwise as [`write_png8`].
///
/// # Errors
/// If the file cannot be written.
pub fn write_png16<T: FileTexel>(path: &Path, grid: &Grid<T>) -> Result<(), MapError> {
    write_atomic(path, |out| png(out, grid, BitDepth::Sixteen))
}

/// Writes a grid as OpenEXR with 32-bit floats, any values, without loss: channel Y, or R, G, B, or R, G, B, A.
///
/// The file appears whole or not at all ([`write_atomic`]); its extension does not matter.
///
/// # Errors
/// If the file cannot be written.
pub fn write_exr<T: FileTexel>(path: &Path, grid: &Grid<T>) -> Result<(), MapError> {
    write_atomic(path, |out| out.write_all(&encode_exr(grid)?))
}

/// Returns the bytes that [`write_png8`] or [`write_png16`] would write: for textures inside other files.
///
/// # Errors
/// If the encoder refuses.
pub fn encode_png<T: FileTexel>(grid: &Grid<T>, bits: BitDepth) -> Result<Vec<u8>, MapError> {
    let mut bytes = Vec::new();
    png(&mut bytes, grid, bits).map_err(|source| MapError::Io {
        name: "PNG in memory".to_owned(),
        doing: "encode it",
        source,
    })?;
    Ok(bytes)
}

/// Writes heights: `.png` as grey with 16 bits, `.exr` as channel Y. White is high.
///
/// # Errors
/// If the name ends in neither, or the file cannot be written.
pub fn write_height(path: &Path, map: &HeightMap) -> Result<(), MapError> {
    match OutputFormat::of(path)? {
        OutputFormat::Png => write_png16(path, map.grid()),
        OutputFormat::Exr => write_exr(path, map.grid()),
    }
}

/// Writes normals, +Y up or down: `.png` encoded by [`NormalMap::encode8`] or [`NormalMap::encode16`]; `.exr` as
/// floats, encoded by 0.5 = zero (`bits` does not matter).
///
/// # Errors
/// If the name ends in neither, or the file cannot be written.
pub fn write_normal(path: &Path, map: &NormalMap, normal_y: NormalY, bits: BitDepth) -> Result<(), MapError> {
    // Not −y: the neutral 0 stays what it is.
    let oriented = move |y: f32| if normal_y == NormalY::Up { y } else { 0.0 - y };
    let (width, height) = (map.grid().width(), map.grid().height());
    let components = || map.grid().texels().iter().flat_map(move |&[x, y, z]| [x, oriented(y), z]);
    match (OutputFormat::of(path)?, bits) {
        (OutputFormat::Png, BitDepth::Eight) => {
            let bytes: Vec<u8> = components().map(NormalMap::encode8).collect();
            write_atomic(path, |out| png_bytes(out, &bytes, width, height, ExtendedColorType::Rgb8))
        }
        (OutputFormat::Png, BitDepth::Sixteen) => {
            // In the machine's byte order, as the encoder wants it.
            let bytes: Vec<u8> = components().flat_map(|n| NormalMap::encode16(n).to_ne_bytes()).collect();
            write_atomic(path, |out| png_bytes(out, &bytes, width, height, ExtendedColorType::Rgb16))
        }
        (OutputFormat::Exr, _) => {
            write_exr(path, &map.grid().map(|&[x, y, z]| [x, oriented(y), z].map(|n| (n + 1.0) * 0.5)))
        }
    }
}

/// Writes colours: `.png` as sRGB with 8 bits, without alpha where it is 1 everywhere; `.exr` as linear RGBA floats.
///
/// # Errors
/// If the name ends in neither, or the file cannot be written.
pub fn write_color(path: &Path, map: &ColorMap) -> Result<(), MapError> {
    match OutputFormat::of(path)? {
        OutputFormat::Exr => write_exr(path, &map.to_linear()),
        OutputFormat::Png if map.grid.texels().iter().all(|c| c[3] >= 1.0) => {
            write_png8(path, &map.to_display().map(|&[r, g, b, _]| [r, g, b]))
        }
        OutputFormat::Png => write_png8(path, &map.to_display()),
    }
}

/// Writes one number per texel: `.png` as grey with 8 bits, `.exr` as channel Y.
///
/// # Errors
/// If the name ends in neither, or the file cannot be written.
pub fn write_scalar(path: &Path, map: &ScalarMap) -> Result<(), MapError> {
    match OutputFormat::of(path)? {
        OutputFormat::Png => write_png8(path, map.grid()),
        OutputFormat::Exr => write_exr(path, map.grid()),
    }
}

/// A format that is written.
enum OutputFormat {
    Png,
    Exr,
}

impl OutputFormat {
    /// The format of a path, by its extension.
    fn of(path: &Path) -> Result<Self, MapError> {
        let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        match extension.as_deref() {
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            _ => Err(MapError::Extension { name: path.display().to_string(), expected: ".png or .exr" }),
        }
    }
}

fn png<T: FileTexel>(out: &mut dyn Write, grid: &Grid<T>, bits: BitDepth) -> io::Result<()> {
    let values = grid.texels().iter().flat_map(FileTexel::channels);
    let (bytes, color): (Vec<u8>, _) = match (bits, T::CHANNELS) {
        (BitDepth::Eight, n) => (
            values.map(|&v| quantize8(v)).collect(),
            [ExtendedColorType::L8, ExtendedColorType::Rgb8, ExtendedColorType::Rgba8][color_index(n)],
        ),
        (BitDepth::Sixteen, n) => (
            values.flat_map(|&v| quantize16(v).to_ne_bytes()).collect(),
            [ExtendedColorType::L16, ExtendedColorType::Rgb16, ExtendedColorType::Rgba16][color_index(n)],
        ),
    };
    png_bytes(out, &bytes, grid.width(), grid.height(), color)
}

/// Maps 1, 3 and 4 channels to 0, 1 and 2.
fn color_index(channels: usize) -> usize {
    channels.saturating_sub(2)
}

fn png_bytes(out: &mut dyn Write, bytes: &[u8], width: u32, height: u32, color: ExtendedColorType) -> io::Result<()> {
    // A tenth of the time of the default, for files a few per cent larger.
    PngEncoder::new_with_quality(out, CompressionType::Fast, FilterType::Adaptive)
        .write_image(bytes, width, height, color)
        .map_err(io::Error::other)
}

/// Encodes an EXR in memory: its writer seeks back to fill in offsets, which a stream cannot.
fn encode_exr<T: FileTexel>(grid: &Grid<T>) -> io::Result<Vec<u8>> {
    let size = (grid.width() as usize, grid.height() as usize);
    let texel = |x: usize, y: usize| grid.get(x as u32, y as u32).channels();
    // Blocks in a fixed order: threads must not decide the bytes.
    let encoding =
        Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let attributes = LayerAttributes::default();
    let mut file = Cursor::new(Vec::new());
    let written = match T::CHANNELS {
        1 => {
            let channels = SpecificChannels::build()
                .with_channel("Y")
                .with_pixel_fn(|p: exr::math::Vec2<usize>| (texel(p.x(), p.y())[0],));
            Image::from_layer(Layer::new(size, attributes, encoding, channels)).write().to_buffered(&mut file)
        }
        3 => {
            let channels = SpecificChannels::rgb(|p: exr::math::Vec2<usize>| {
                let t = texel(p.x(), p.y());
                (t[0], t[1], t[2])
            });
            Image::from_layer(Layer::new(size, attributes, encoding, channels)).write().to_buffered(&mut file)
        }
        _ => {
            let channels = SpecificChannels::rgba(|p: exr::math::Vec2<usize>| {
                let t = texel(p.x(), p.y());
                (t[0], t[1], t[2], t[3])
            });
            Image::from_layer(Layer::new(size, attributes, encoding, channels)).write().to_buffered(&mut file)
        }
    };
    written.map_err(io::Error::other)?;
    Ok(file.into_inner())
}
