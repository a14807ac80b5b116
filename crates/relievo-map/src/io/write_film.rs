//! Films: animated PNG and WebP, without loss, played for ever. The same frames give the same bytes.

use std::io::{self, Write};
use std::path::Path;

use image_webp::{ColorType, WebPEncoder};

use super::atomic::write_atomic;
use super::error::MapError;
use crate::types::Grid;

/// Formats of films.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FilmFormat {
    /// Animated PNG (PNG, third edition, W3C 2025).
    Apng,
    /// Animated WebP with lossless frames (WebP container specification; RFC 9649).
    Webp,
}

/// Size and speed of a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilmShape {
    /// Pixels along each side; for WebP at most 16384.
    pub size: [u32; 2],
    /// Number of frames, at least 1.
    pub frames: u32,
    /// Frames per second: above 0, at most [`FilmShape::MAX_RATE`].
    pub per_second: f64,
}

impl FilmShape {
    /// The most frames per second: a frame lasts a millisecond, the unit of WebP.
    pub const MAX_RATE: f64 = 1000.0;

    /// Returns how long a frame lasts in an animated PNG, as a fraction of seconds.
    fn delay(&self) -> (u16, u16) {
        let whole = |x: f64| (x - x.round()).abs() < 1e-9 && (1.0..=f64::from(u16::MAX)).contains(&x.round());
        let rate = self.per_second;
        if whole(rate) {
            return (1, rate.round() as u16);
        }
        // NTSC's rates are 1000/1001 of whole ones.
        if whole(rate * 1001.0 / 1000.0) && rate < 60.0 {
            return (1001, (rate * 1001.0).round() as u16);
        }
        if rate >= 1.0 { (50, (rate * 50.0).round() as u16) } else { ((100.0 / rate).round().min(65535.0) as u16, 100) }
    }

    /// Returns the time at which a frame begins, in milliseconds.
    fn milliseconds(&self, frame: u32) -> u64 {
        (f64::from(frame) * 1000.0 / self.per_second).round() as u64
    }
}

/// Writes a film whose frames `next` gives one after the other; it appears whole or not at all ([`write_atomic`]).
///
/// # Errors
/// If `next` fails, a frame has another size, or the file cannot be written.
pub fn write_film(
    path: &Path,
    format: FilmFormat,
    shape: FilmShape,
    next: &mut dyn FnMut() -> io::Result<Grid<[u8; 3]>>,
) -> Result<(), MapError> {
    let mut checked = || {
        let frame = next()?;
        if [frame.width(), frame.height()] == shape.size {
            return Ok(frame);
        }
        Err(io::Error::new(io::ErrorKind::InvalidInput, "the frames of a film have one size"))
    };
    write_atomic(path, |out| match format {
        FilmFormat::Apng => apng(out, shape, &mut checked),
        FilmFormat::Webp => webp(out, shape, &mut checked),
    })
}

fn apng(out: &mut dyn Write, shape: FilmShape, next: &mut dyn FnMut() -> io::Result<Grid<[u8; 3]>>) -> io::Result<()> {
    let [width, height] = shape.size;
    let mut encoder = png::Encoder::new(out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    encoder.set_animated(shape.frames, 0)?;
    let (numerator, denominator) = shape.delay();
    encoder.set_frame_delay(numerator, denominator)?;
    let mut writer = encoder.write_header()?;
    for _ in 0..shape.frames {
        writer.write_image_data(next()?.texels().as_flattened())?;
    }
    Ok(writer.finish()?)
}

/// Writes the chunks VP8X, ANIM and an ANMF for each frame. Frames are kept compressed: the file begins with its length.
fn webp(out: &mut dyn Write, shape: FilmShape, next: &mut dyn FnMut() -> io::Result<Grid<[u8; 3]>>) -> io::Result<()> {
    const ANIMATION: u8 = 0b10;
    const DO_NOT_BLEND: u8 = 0b10;
    let [width, height] = shape.size;
    let side = |n: u32| n.wrapping_sub(1);
    let mut chunks = Vec::new();
    let mut header = vec![ANIMATION, 0, 0, 0];
    header.extend(bytes24(side(width)));
    header.extend(bytes24(side(height)));
    chunk(&mut chunks, b"VP8X", &header)?;
    // Black behind the frames, and no end.
    chunk(&mut chunks, b"ANIM", &[0, 0, 0, 255, 0, 0])?;
    for number in 0..shape.frames {
        let frame = next()?;
        let lasts = shape.milliseconds(number + 1) - shape.milliseconds(number);
        let mut data = vec![0; 6];
        data.extend(bytes24(side(width)));
        data.extend(bytes24(side(height)));
        data.extend(bytes24(u32::try_from(lasts).unwrap_or(u32::MAX).min(0x00ff_ffff)));
        data.push(DO_NOT_BLEND);
        let mut file = Vec::new();
        WebPEncoder::new(&mut file)
            .encode(frame.texels().as_flattened(), width, height, ColorType::Rgb8)
            .map_err(io::Error::other)?;
        // A file of one picture is a header of 12 bytes and the chunk that belongs here.
        data.extend_from_slice(file.get(12..).unwrap_or_default());
        chunk(&mut chunks, b"ANMF", &data)?;
    }
    out.write_all(b"RIFF")?;
    out.write_all(&length(chunks.len() + 4)?)?;
    out.write_all(b"WEBP")?;
    out.write_all(&chunks)
}

/// Appends a chunk of a RIFF file.
fn chunk(out: &mut Vec<u8>, name: &[u8; 4], data: &[u8]) -> io::Result<()> {
    out.extend_from_slice(name);
    out.extend(length(data.len())?);
    out.extend_from_slice(data);
    // Chunks begin at even bytes.
    if data.len() % 2 == 1 {
        out.push(0);
    }
    length(out.len()).map(drop)
}

fn length(bytes: usize) -> io::Result<[u8; 4]> {
    let too_long = || io::Error::other("the film takes more than the 4 GiB that WebP can have; write it as PNG files");
    u32::try_from(bytes).map(u32::to_le_bytes).map_err(|_| too_long())
}

/// The 24 low bits of a number.
fn bytes24(n: u32) -> [u8; 3] {
    let [a, b, c, _] = n.to_le_bytes();
    [a, b, c]
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::io::BufReader;

    use image::AnimationDecoder;
    use image::codecs::png::PngDecoder;
    use image::codecs::webp::WebPDecoder;

    use super::*;

    fn frame(number: u32) -> Grid<[u8; 3]> {
        Grid::from_fn(17, 5, |x, y| [(x * 9 + number * 31) as u8, (y * 40) as u8, ((x ^ y) * 7 + number) as u8])
    }

    #[test]
    fn films_are_read_back_frame_by_frame() {
        let folder = tempfile::tempdir().unwrap();
        for (format, name) in [(FilmFormat::Apng, "a.apng"), (FilmFormat::Webp, "a.webp")] {
            let path = folder.path().join(name);
            let shape = FilmShape { size: [17, 5], frames: 7, per_second: 30.0 };
            let write = || {
                let mut number = 0;
                let mut next = || {
                    number += 1;
                    Ok(frame(number - 1))
                };
                write_film(&path, format, shape, &mut next).unwrap();
                std::fs::read(&path).unwrap()
            };
            assert_eq!(write(), write(), "{name}");
            let file = BufReader::new(File::open(&path).unwrap());
            let frames = match format {
                FilmFormat::Apng => PngDecoder::new(file).unwrap().apng().unwrap().into_frames().collect_frames(),
                FilmFormat::Webp => WebPDecoder::new(file).unwrap().into_frames().collect_frames(),
            };
            let frames = frames.unwrap();
            assert_eq!(frames.len(), 7, "{name}");
            let mut sum = 0.0;
            for (number, read) in frames.iter().enumerate() {
                let pixels: Vec<[u8; 3]> = read.buffer().pixels().map(|p| [p.0[0], p.0[1], p.0[2]]).collect();
                assert_eq!(pixels, frame(number as u32).texels(), "{name} {number}");
                let (n, d) = read.delay().numer_denom_ms();
                sum += f64::from(n) / f64::from(d);
            }
            assert!((sum - 7000.0 / 30.0).abs() < 4.0, "{name}: {sum} ms");
        }
    }

    #[test]
    fn a_frame_that_fails_leaves_no_film() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.webp");
        for format in [FilmFormat::Apng, FilmFormat::Webp] {
            let shape = FilmShape { size: [17, 5], frames: 3, per_second: 10.0 };
            let mut left = 2;
            let mut next = || {
                left -= 1;
                if left > 0 { Ok(frame(0)) } else { Err(io::Error::other("no more")) }
            };
            let error = write_film(&path, format, shape, &mut next).unwrap_err().to_string();
            assert!(error.contains("no more"), "{error}");
            let wrong = FilmShape { size: [16, 5], ..shape };
            let error = write_film(&path, format, wrong, &mut || Ok(frame(0))).unwrap_err().to_string();
            assert!(error.contains("have one size"), "{error}");
            assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        }
    }

    #[test]
    fn frames_last_as_long_as_the_rate_says() {
        let delay = |per_second| FilmShape { size: [1; 2], frames: 1, per_second }.delay();
        assert_eq!((delay(30.0), delay(1000.0), delay(0.5)), ((1, 30), (1, 1000), (200, 100)));
        assert_eq!((delay(30_000.0 / 1001.0), delay(12.5)), ((1001, 30_000), (50, 625)));
        for rate in [0.01, 0.3, 1.7, 23.976, 29.97, 59.94, 144.0, 999.9] {
            let (n, d) = delay(rate);
            assert!((f64::from(d) / f64::from(n) / rate - 1.0).abs() < 0.01, "{rate}: {n}/{d}");
        }
    }
}
