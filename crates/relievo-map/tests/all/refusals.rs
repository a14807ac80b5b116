//! Files that cannot be read are refused quickly, with the file's name and a remedy.

use std::fs;
use std::io::Cursor;
use std::path::Path;
use std::time::{Duration, Instant};

use image::ImageFormat;
use relievo_map::{
    Channel, Limits, MapError, NormalY, White, decode_color, decode_height, read_color, read_height, read_normal,
    read_scalar,
};

use crate::common::{every_format, exr_file, file, gradient, ramp, raw_png};

fn refusal(path: &Path) -> MapError {
    read_height(path, White::High, &Limits::default()).unwrap_err()
}

#[test]
fn what_is_no_regular_file_with_an_image_is_explained_by_every_reader() {
    let folder = tempfile::tempdir().unwrap();
    let limits = Limits::default();
    let text = folder.path().join("words.png");
    fs::write(&text, "these are words").unwrap();
    let empty = folder.path().join("empty.png");
    fs::write(&empty, "").unwrap();
    for (path, words) in [
        (folder.path().to_owned(), "a folder"),
        (folder.path().join("none.png"), "no such file"),
        (text.join("below.png"), "no such file"),
        (text, "is text"),
        (empty, "empty"),
    ] {
        for message in [
            read_height(&path, White::High, &limits).unwrap_err().to_string(),
            read_normal(&path, NormalY::Up, &limits).unwrap_err().to_string(),
            read_color(&path, &limits).unwrap_err().to_string(),
            read_scalar(&path, Channel::Red, &limits).unwrap_err().to_string(),
        ] {
            assert!(message.contains(&path.display().to_string()) && message.contains(words), "{message}");
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn pipes_and_devices_are_refused_without_waiting_for_them() {
    use std::os::unix::net::UnixListener;
    let folder = tempfile::tempdir().unwrap();
    let socket = folder.path().join("socket.png");
    let _listener = UnixListener::bind(&socket).unwrap();
    let pipe = folder.path().join("pipe.png");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    for path in [Path::new("/dev/zero"), &socket, &pipe] {
        assert!(matches!(refusal(path), MapError::NotAFile { .. }), "{}", path.display());
    }
}

#[test]
fn content_decides_the_format_and_the_extension_does_not() {
    let folder = tempfile::tempdir().unwrap();
    for (extension, bytes) in every_format() {
        // TGA alone has no signature; ours ends in none.
        if extension != "tga" {
            let path = folder.path().join(format!("{extension}.odd"));
            fs::write(&path, bytes).unwrap();
            read_color(&path, &Limits::default()).unwrap_or_else(|e| panic!("{e}"));
        }
    }
}

/// A header that promises `width × height` texels, for every format that can promise as much.
fn bombs() -> Vec<(&'static str, Vec<u8>)> {
    let image = gradient(16, 16);
    let mut bmp = file(&image, ImageFormat::Bmp);
    bmp[18..22].copy_from_slice(&60_000u32.to_le_bytes());
    bmp[22..26].copy_from_slice(&60_000u32.to_le_bytes());
    let mut tga = file(&image, ImageFormat::Tga);
    tga[12..14].copy_from_slice(&60_000u16.to_le_bytes());
    tga[14..16].copy_from_slice(&60_000u16.to_le_bytes());
    let mut jpeg = file(&image, ImageFormat::Jpeg);
    let frame = jpeg.windows(2).position(|w| w == [0xff, 0xc0]).unwrap();
    jpeg[frame + 5..frame + 9].copy_from_slice(&[0xea, 0x60, 0xea, 0x60]);
    let hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 60000\n\x02\x02\x00\x10".to_vec();
    let mut tiff = Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut tiff).unwrap();
    encoder.write_image::<tiff::encoder::colortype::Gray32Float>(4, 4, &[0.5; 16]).unwrap();
    let mut tiff = tiff.into_inner();
    // Width and height are the tags 256 and 257, as one LONG each.
    for tag in [256u16, 257] {
        let entry = [tag.to_le_bytes(), 4u16.to_le_bytes()].concat();
        let at = tiff.windows(8).position(|w| w[..4] == entry && w[4..] == [1, 0, 0, 0]).unwrap();
        tiff[at + 8..at + 12].copy_from_slice(&60_000u32.to_le_bytes());
    }
    let mut exr = exr_file(8, 6, &[("Y", ramp(48))]);
    // Data and display window: the largest corner comes after the smallest.
    for window in ["dataWindow\0box2i\0", "displayWindow\0box2i\0"] {
        let at = exr.windows(window.len()).position(|w| w == window.as_bytes()).unwrap() + window.len() + 4;
        exr[at + 8..at + 16].copy_from_slice(&[59_999u32.to_le_bytes(), 59_999u32.to_le_bytes()].concat());
    }
    vec![
        ("bomb.png", raw_png(60_000, 60_000, 8, 2, false, &[], &[0; 100])),
        ("bomb.bmp", bmp),
        ("bomb.tga", tga),
        ("bomb.jpg", jpeg),
        ("bomb.hdr", hdr),
        ("bomb.tif", tiff),
        ("bomb.exr", exr),
    ]
}

#[test]
fn a_giant_in_the_header_is_refused_at_once_with_its_size_and_the_limit() {
    for (name, bytes) in bombs() {
        let start = Instant::now();
        let error = decode_height(name, &bytes, White::High, &Limits::default()).unwrap_err();
        // Decoding that many texels takes much longer.
        assert!(start.elapsed() < Duration::from_secs(1), "{name}");
        assert!(matches!(error, MapError::Size { width: 60_000, height: 60_000, max_side: 16384, .. }), "{error}");
        let message = error.to_string();
        for words in [name, "60000×60000", "16384", "scale it down or raise the limit"] {
            assert!(message.contains(words), "{message}");
        }
        // The sides allowed, the bytes are still too many.
        let limits = Limits { max_side: 65_536, ..Limits::default() };
        let start = Instant::now();
        let error = decode_height(name, &bytes, White::High, &limits).unwrap_err();
        assert!(matches!(error, MapError::Bytes { max_bytes: 0x4000_0000, .. }), "{error}");
        assert!(start.elapsed() < Duration::from_secs(1), "{name}");
    }
}

#[test]
fn sides_of_nothing_are_refused() {
    for (width, height) in [(0, 5), (5, 0), (0, 0)] {
        let error = decode_color("none.png", &raw_png(width, height, 8, 0, false, &[], &[]), &Limits::default());
        assert!(matches!(error, Err(MapError::Size { .. })), "{error:?}");
    }
    let hdr = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 5\n";
    assert!(decode_color("none.hdr", hdr, &Limits::default()).is_err());
    let mut tga = file(&gradient(4, 4), ImageFormat::Tga);
    tga[12] = 0;
    assert!(decode_color("none.tga", &tga, &Limits::default()).is_err());
}

#[test]
fn limits_can_be_tightened_and_count_the_map_too() {
    let bytes = file(&gradient(100, 80), ImageFormat::Png);
    let limits = |max_side, max_bytes| Limits { max_side, max_bytes };
    // 3 bytes decoded and 4 as heights, or 16 as colours.
    assert!(decode_height("a", &bytes, White::High, &limits(100, 8000 * 7)).is_ok());
    let error = decode_height("a", &bytes, White::High, &limits(100, 8000 * 7 - 1)).unwrap_err();
    assert!(matches!(error, MapError::Bytes { needed: 56_000, .. }), "{error}");
    assert!(matches!(decode_color("a", &bytes, &limits(100, 8000 * 7)), Err(MapError::Bytes { needed: 152_000, .. })));
    assert!(matches!(decode_height("a", &bytes, White::High, &limits(99, 1 << 30)), Err(MapError::Size { .. })));
}

#[test]
fn a_file_larger_than_the_limit_is_not_even_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.png");
    fs::write(&path, file(&gradient(200, 200), ImageFormat::Png)).unwrap();
    let limits = Limits { max_bytes: 100, ..Limits::default() };
    assert!(matches!(read_color(&path, &limits), Err(MapError::FileSize { max_bytes: 100, .. })));
}

#[test]
fn a_file_made_to_break_its_decoder_is_an_error() {
    // Run-length markers of length 0, each of which multiplies the next length by 256, until the number overflows.
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 9\n\x09\x09\x09\x80".to_vec();
    bytes.extend([1, 1, 1, 0].repeat(20));
    let error = decode_color("evil.hdr", &bytes, &Limits::default()).unwrap_err();
    assert!(matches!(error, MapError::Damaged { .. }) && error.to_string().contains("evil.hdr"), "{error}");
}
