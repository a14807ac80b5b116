//! Image formats, recognised by content: extensions may lie.

use super::error::MapError;

/// An image format that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FileFormat {
    Png,
    Jpeg,
    Tiff,
    Exr,
    Hdr,
    Tga,
    Bmp,
    WebP,
}

impl FileFormat {
    /// The name for messages.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Tiff => "TIFF",
            Self::Exr => "OpenEXR",
            Self::Hdr => "Radiance HDR",
            Self::Tga => "TGA",
            Self::Bmp => "BMP",
            Self::WebP => "WebP",
        }
    }

    /// Recognises the format of `bytes`. `name` is for messages; its extension counts only for TGA, which has no
    /// signature.
    pub(crate) fn of(name: &str, bytes: &[u8]) -> Result<Self, MapError> {
        if bytes.is_empty() {
            return Err(MapError::Empty { name: name.to_owned() });
        }
        for (signature, format) in SIGNATURES {
            if bytes.starts_with(signature) {
                return Ok(*format);
            }
        }
        if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") {
            return Ok(Self::WebP);
        }
        for (signature, offset, format) in UNREAD_SIGNATURES {
            if bytes.get(*offset..).is_some_and(|bytes| bytes.starts_with(signature)) {
                return Err(MapError::OtherFormat { name: name.to_owned(), format });
            }
        }
        if is_tga(name, bytes) {
            return Ok(Self::Tga);
        }
        // BMP's signature is two letters: only with the size of a header that exists is it one.
        if bytes.starts_with(b"BM")
            && matches!(bytes.get(14..18), Some([12 | 16 | 40 | 52 | 56 | 64 | 108 | 124, 0, 0, 0]))
        {
            return Ok(Self::Bmp);
        }
        Err(MapError::NotAnImage { name: name.to_owned(), what: describe(bytes) })
    }
}

/// Extensions of the image formats that are read, in lower case: by them folders are searched. Files themselves are
/// recognised by their content.
pub const IMAGE_EXTENSIONS: &[&str] = &["png", "jpg", "jpeg", "tif", "tiff", "exr", "hdr", "tga", "bmp", "webp"];

/// First bytes of the formats that are read.
const SIGNATURES: &[(&[u8], FileFormat)] = &[
    (b"\x89PNG\r\n\x1a\n", FileFormat::Png),
    (b"\xff\xd8\xff", FileFormat::Jpeg),
    (b"II*\0", FileFormat::Tiff),
    (b"MM\0*", FileFormat::Tiff),
    // BigTIFF.
    (b"II+\0", FileFormat::Tiff),
    (b"MM\0+", FileFormat::Tiff),
    (b"\x76\x2f\x31\x01", FileFormat::Exr),
    (b"#?RADIANCE", FileFormat::Hdr),
    (b"#?RGBE", FileFormat::Hdr),
];

/// Formats that maps come in and that are not read: signature, offset, name.
const UNREAD_SIGNATURES: &[(&[u8], usize, &str)] = &[
    (b"GIF8", 0, "a GIF image"),
    (b"DDS ", 0, "a DDS texture"),
    (b"\xabKTX 11\xbb", 0, "a KTX texture"),
    (b"\xabKTX 20\xbb", 0, "a KTX2 texture"),
    (b"8BPS", 0, "a Photoshop document"),
    (b"gimp xcf", 0, "a GIMP document"),
    (b"qoif", 0, "a QOI image"),
    (b"\xff\x0a", 0, "a JPEG XL image"),
    (b"\0\0\0\x0cJXL ", 0, "a JPEG XL image"),
    (b"\0\0\0\x0cjP  ", 0, "a JPEG 2000 image"),
    (b"ftypavif", 4, "an AVIF image"),
    (b"ftyphei", 4, "a HEIC photograph"),
    (b"ftypmif1", 4, "a HEIF photograph"),
    (b"\0\0\x01\0", 0, "a Windows icon"),
    (b"%PDF", 0, "a PDF document"),
    (b"PK\x03\x04", 0, "a ZIP archive (unpack it first)"),
    (b"glTF", 0, "a binary glTF model"),
    (b"BLENDER", 0, "a Blender file"),
    (b"<svg", 0, "an SVG drawing"),
    (b"P5\n", 0, "a PGM image"),
    (b"P6\n", 0, "a PPM image"),
    (b"PF\n", 0, "a PFM image"),
    (b"Pf\n", 0, "a PFM image"),
];

/// True for a plausible TGA header with one more sign: extension, footer or exact size. TGA has no signature.
fn is_tga(name: &str, bytes: &[u8]) -> bool {
    let Some(&[id, map, kind, _, _, entries_lo, entries_hi, entry_bits, .., depth, flags]) = bytes.first_chunk::<18>()
    else {
        return false;
    };
    let (width, height) = (u16::from_le_bytes([bytes[12], bytes[13]]), u16::from_le_bytes([bytes[14], bytes[15]]));
    let sane = map <= 1
        && matches!(kind, 1 | 2 | 3 | 9 | 10 | 11)
        && matches!(depth, 8 | 15 | 16 | 24 | 32)
        && matches!(entry_bits, 0 | 15 | 16 | 24 | 32)
        && flags & 0xc0 == 0;
    if !sane {
        return false;
    }
    let extension = name.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
    let named = matches!(extension.as_str(), "tga" | "vda" | "icb" | "vst");
    let signed = bytes.ends_with(b"TRUEVISION-XFILE.\0");
    let map_bytes = usize::from(u16::from_le_bytes([entries_lo, entries_hi])) * usize::from(entry_bits).div_ceil(8);
    let body = usize::from(width) * usize::from(height) * usize::from(depth).div_ceil(8);
    let exact = kind < 8 && body > 0 && bytes.len() == 18 + usize::from(id) + map_bytes + body;
    named || signed || exact
}

/// Describes content that is no image.
fn describe(bytes: &[u8]) -> &'static str {
    let start = &bytes[..bytes.len().min(512)];
    let lower = start.to_ascii_lowercase();
    let contains = |needle: &[u8]| lower.windows(needle.len()).any(|window| window == needle);
    // A cut in the middle of a character is no reason to doubt.
    let is_text = match std::str::from_utf8(start) {
        Ok(_) => true,
        Err(error) => error.error_len().is_none(),
    } && start.iter().all(|&b| b >= 0x20 || matches!(b, b'\t' | b'\n' | b'\r' | 0x0c));
    if lower.starts_with(b"version https://git-lfs") {
        "a Git LFS pointer (fetch the real file with `git lfs pull`)"
    } else if is_text && (contains(b"<html") || contains(b"<!doctype html")) {
        "a web page (a download that went wrong?)"
    } else if is_text {
        "text"
    } else if start.iter().all(|&b| b == 0) {
        "only zeros"
    } else {
        "of no known image format"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(name: &str, bytes: &[u8]) -> String {
        FileFormat::of(name, bytes).unwrap_err().to_string()
    }

    #[test]
    fn content_that_is_no_image_is_described_in_plain_words() {
        assert!(message("a.png", b"hello, world").contains("a.png") && message("a.png", b"hello").contains("is text"));
        assert!(message("a.png", b"\n<!DOCTYPE html><html>").contains("web page"));
        assert!(message("a.png", b"version https://git-lfs.github.com/spec/v1").contains("git lfs pull"));
        assert!(message("a.png", &[0; 64]).contains("only zeros"));
        assert!(message("a.png", b"\x01\x80\xfe").contains("no known image format"));
        assert!(message("a.png", b"").contains("empty"));
        assert!(message("a.txt", "BMå text, not a bitmap: a long enough line".as_bytes()).contains("is text"));
    }

    #[test]
    fn known_formats_that_are_not_read_are_named_with_a_way_out() {
        let message = message("a.png", b"DDS |\0\0\0");
        assert!(message.contains("DDS") && message.contains("convert"), "{message}");
    }

    #[test]
    fn tga_needs_a_plausible_header_and_one_more_sign() {
        let mut header = [0; 18];
        (header[2], header[12], header[14], header[16]) = (3, 2, 2, 8);
        let exact = [&header[..], &[1, 2, 3, 4]].concat();
        assert_eq!(FileFormat::of("a.png", &exact).unwrap(), FileFormat::Tga);
        assert!(FileFormat::of("a.png", &exact[..20]).is_err());
        assert_eq!(FileFormat::of("a.TGA", &exact[..20]).unwrap(), FileFormat::Tga);
        header[16] = 9;
        assert!(FileFormat::of("a.tga", &header).is_err());
    }
}
