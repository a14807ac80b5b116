//! Small files of every format, made here so that nothing binary lies in the repository.
#![allow(dead_code, reason = "every test file uses its own part")]

use std::io::Cursor;

use exr::prelude::*;
use image::{DynamicImage, ImageFormat};

/// An image of the given kind whose texels all differ a little.
pub(crate) fn gradient(width: u32, height: u32) -> DynamicImage {
    DynamicImage::ImageRgb8(image::RgbImage::from_fn(width, height, |x, y| {
        image::Rgb([(x * 255 / width) as u8, (y * 255 / height) as u8, ((x + y) * 7 % 256) as u8])
    }))
}

/// The same in grey.
pub(crate) fn grey(width: u32, height: u32) -> DynamicImage {
    DynamicImage::ImageLuma8(image::GrayImage::from_fn(width, height, |x, y| {
        image::Luma([(x * 200 / width + y * 50 / height) as u8])
    }))
}

/// A file of an image.
pub(crate) fn file(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

/// A small file of every format, with the extension that suits it.
pub(crate) fn every_format() -> Vec<(&'static str, Vec<u8>)> {
    let image = gradient(19, 13);
    let floats = DynamicImage::ImageRgb32F(image.to_rgb32f());
    vec![
        ("png", file(&image, ImageFormat::Png)),
        ("grey16.png", file(&DynamicImage::ImageLuma16(image.to_luma16()), ImageFormat::Png)),
        ("jpg", file(&image, ImageFormat::Jpeg)),
        ("grey.jpg", file(&grey(19, 13), ImageFormat::Jpeg)),
        ("progressive.jpg", hex(PROGRESSIVE_JPEG)),
        ("cmyk.jpg", hex(CMYK_JPEG)),
        ("tif", file(&image, ImageFormat::Tiff)),
        ("float.tif", tiff_file::<tiff::encoder::colortype::Gray32Float>(8, 6, &ramp(48))),
        ("bmp", file(&image, ImageFormat::Bmp)),
        ("tga", file(&image, ImageFormat::Tga)),
        ("webp", file(&image, ImageFormat::WebP)),
        ("lossy.webp", hex(LOSSY_WEBP)),
        ("hdr", file(&floats, ImageFormat::Hdr)),
        ("exr", file(&floats, ImageFormat::OpenExr)),
        ("grey.exr", exr_file(8, 6, &[("Y", ramp(48))])),
    ]
}

/// `n` numbers from 0 to 1.
pub(crate) fn ramp(n: usize) -> Vec<f32> {
    (0..n).map(|i| i as f32 / (n - 1) as f32).collect()
}

/// A TIFF with samples of any type.
pub(crate) fn tiff_file<C: tiff::encoder::colortype::ColorType>(
    width: u32,
    height: u32,
    samples: &[C::Inner],
) -> Vec<u8>
where
    [C::Inner]: tiff::encoder::TiffValue,
{
    let mut bytes = Cursor::new(Vec::new());
    let mut encoder = tiff::encoder::TiffEncoder::new(&mut bytes).unwrap();
    encoder.write_image::<C>(width, height, samples).unwrap();
    bytes.into_inner()
}

/// An EXR with these channels.
pub(crate) fn exr_file(width: usize, height: usize, channels: &[(&str, Vec<f32>)]) -> Vec<u8> {
    let list = channels.iter().map(|(name, v)| AnyChannel::new(*name, FlatSamples::F32(v.clone()))).collect();
    let layer =
        Layer::new((width, height), LayerAttributes::default(), Encoding::SMALL_LOSSLESS, AnyChannels::sort(list));
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

/// A PNG built by hand: `rows` are the filtered scan lines, before compression (stored, not deflated).
pub(crate) fn raw_png(
    width: u32,
    height: u32,
    bits: u8,
    color: u8,
    interlaced: bool,
    extra: &[(&[u8; 4], &[u8])],
    rows: &[u8],
) -> Vec<u8> {
    let mut png = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
    header.extend([bits, color, 0, 0, u8::from(interlaced)]);
    chunk(&mut png, b"IHDR", &header);
    for (name, data) in extra {
        chunk(&mut png, name, data);
    }
    // zlib: header, stored blocks, checksum.
    let mut zlib = vec![0x78, 0x01];
    let mut blocks = rows.chunks(65535).peekable();
    while let Some(block) = blocks.next() {
        zlib.push(u8::from(blocks.peek().is_none()));
        zlib.extend((block.len() as u16).to_le_bytes());
        zlib.extend((!(block.len() as u16)).to_le_bytes());
        zlib.extend(block);
    }
    let (mut a, mut b) = (1u32, 0u32);
    for &byte in rows {
        a = (a + u32::from(byte)) % 65521;
        b = (b + a) % 65521;
    }
    zlib.extend((b << 16 | a).to_be_bytes());
    chunk(&mut png, b"IDAT", &zlib);
    chunk(&mut png, b"IEND", &[]);
    png
}

fn chunk(png: &mut Vec<u8>, name: &[u8; 4], data: &[u8]) {
    png.extend((data.len() as u32).to_be_bytes());
    let body = [name, data].concat();
    let mut crc = u32::MAX;
    for &byte in &body {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
        }
    }
    png.extend(body);
    png.extend((!crc).to_be_bytes());
}

/// Bytes from hexadecimal digits.
fn hex(digits: &str) -> Vec<u8> {
    digits.as_bytes().chunks(2).map(|d| u8::from_str_radix(std::str::from_utf8(d).unwrap(), 16).unwrap()).collect()
}

/// A progressive JPEG, 19×13, which our encoders cannot write.
const PROGRESSIVE_JPEG: &str = "\
    ffd8ffe000104a46494600010100000100010000ffdb0043001b12141714111b1716171e1c1b2028422b28252528513a3d3042605565\
    645f555d5b6a7899816a7190735b5d85b586909ea3abadab6780bcc9baa6c799a8aba4ffdb0043011c1e1e2823284e2b2b4ea46e5d6e\
    a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4a4ffc20011\
    08000d001303012200021101031101ffc400160001010100000000000000000000000000030400ffc400150101010000000000000000\
    0000000000000204ffda000c03010002100310000001919d889b5b953fffc40018100101010101000000000000000000000000010211\
    12ffda0008010100010502994cbca448e3ffc40017110100030000000000000000000000000000020313ffda0008010301013f01858d\
    1fffc400161101010100000000000000000000000000000111ffda0008010201013f0195afffc4001410010000000000000000000000\
    0000000020ffda0008010100063f025fffc40017100101010100000000000000000000000000011011ffda0008010100013f21d5c517\
    2fffda000c03010002000300000010afff00ffc400161101010100000000000000000000000000000111ffda0008010301013f10bb6f\
    ffc40014110100000000000000000000000000000010ffda0008010201013f101fffc4001a1000020203000000000000000000000000\
    00011061112131ffda0008010100013f10acac5af276588fffd9\
    ";

/// A JPEG in four inks, 19×13.
const CMYK_JPEG: &str = "\
    ffd8ffee000e41646f626500640000000000ffdb0043001b12141714111b1716171e1c1b2028422b28252528513a3d3042605565645f\
    555d5b6a7899816a7190735b5d85b586909ea3abadab6780bcc9baa6c799a8aba4ffc0001408000d0013044311004d11005911004b11\
    00ffc40017000101010100000000000000000000000000050406ffc40020100002010305010100000000000000000000030102044114\
    152132626111ffda000e0443004d0059004b00003f008f65826edde49084fc3a62f59606dde4a084fc058a3ac0dbbc9b694f11c0389b\
    2c1d4e9566142e017acb034ab2821700b147581a559b695c7e403fffd9\
    ";

/// A lossy WebP, 19×13.
const LOSSY_WEBP: &str = "\
    524946465c0000005745425056503820500000007003009d012a13000d003eed42b756a9a2a6a41801301d896c009d32831800492676\
    b54000feeedcf5205d38820da243922001f78aebb14efde73e34bd40c695bd2823d40f1aaaa64d5cb379dd600000\
    ";
