//! Files to feed the binary with, good ones and broken ones.

use std::io::Cursor;

use image::{DynamicImage, ImageFormat};

/// A small grey picture: a ramp from the top left.
pub(crate) fn png(width: u32, height: u32) -> Vec<u8> {
    let ramp = image::GrayImage::from_fn(width, height, |x, y| image::Luma([(x * 7 + y * 3) as u8]));
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::from(ramp).write_to(&mut bytes, ImageFormat::Png).unwrap();
    bytes.into_inner()
}

/// A PNG whose header claims another size than its data has.
pub(crate) fn png_that_claims(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = png(4, 4);
    // Signature (8), length (4), "IHDR" (4), width, height, 5 more bytes, CRC of type and data.
    bytes[16..20].copy_from_slice(&width.to_be_bytes());
    bytes[20..24].copy_from_slice(&height.to_be_bytes());
    let crc = crc32(&bytes[12..29]);
    bytes[29..33].copy_from_slice(&crc.to_be_bytes());
    bytes
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 })
    })
}

/// A grey float picture of one value.
pub(crate) fn exr(value: f32) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let picture = image::Rgb32FImage::from_pixel(4, 4, image::Rgb([value; 3]));
    DynamicImage::from(picture).write_to(&mut bytes, ImageFormat::OpenExr).unwrap();
    bytes.into_inner()
}

/// Only the first half of a file.
pub(crate) fn half(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.truncate(bytes.len() / 2);
    bytes
}

/// A binary glTF file around this JSON text, without any buffer.
pub(crate) fn glb(json: &str) -> Vec<u8> {
    let mut json = json.to_owned();
    while !json.len().is_multiple_of(4) {
        json.push(' ');
    }
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((json.len() as u32 + 20).to_le_bytes());
    bytes.extend((json.len() as u32).to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(json.as_bytes());
    bytes
}
