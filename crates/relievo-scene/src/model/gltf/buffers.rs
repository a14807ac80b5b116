//! The bytes behind a glTF file: its buffers, inside or beside it.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::{GeneralPurpose, NO_PAD};
use gltf::json::Root;

use crate::model::part::ModelError;
use crate::model::read_file::read_file;

/// The file's buffers, each at least as long as the file says.
pub(super) struct Buffers(pub(super) Vec<Vec<u8>>);

impl Buffers {
    pub(super) fn read(root: &Root, blob: Option<&[u8]>, path: &Path) -> Result<Self, ModelError> {
        let mut buffers = Vec::with_capacity(root.buffers.len());
        for (index, buffer) in root.buffers.iter().enumerate() {
            let bytes = match (&buffer.uri, blob) {
                (Some(uri), _) => match resolve(uri, path)? {
                    Uri::Bytes(bytes) => bytes,
                    Uri::File(file) => read_file(&file)?,
                },
                (None, Some(blob)) if index == 0 => blob.to_vec(),
                (None, _) => {
                    return Err(ModelError::new(
                        path,
                        format!("buffer {index} has no bytes anywhere; export it again"),
                    ));
                }
            };
            if (bytes.len() as u64) < buffer.byte_length.0 {
                let message = format!(
                    "buffer {index} should have {} bytes but has {}; was the file cut short?",
                    buffer.byte_length.0,
                    bytes.len()
                );
                return Err(ModelError::new(path, message));
            }
            buffers.push(bytes);
        }
        Ok(Self(buffers))
    }
}

/// Location of the bytes of a URI.
pub(super) enum Uri {
    Bytes(Vec<u8>),
    File(PathBuf),
}

/// Returns the bytes of a data URI, or the path of a file beside the glTF file.
pub(super) fn resolve(uri: &str, gltf: &Path) -> Result<Uri, ModelError> {
    if let Some(data) = uri.strip_prefix("data:") {
        let bytes = data.split_once(";base64,").and_then(|(_, text)| decode_base64(text));
        return bytes.map(Uri::Bytes).ok_or_else(|| ModelError::new(gltf, "a data URI in it is not valid base64"));
    }
    let scheme = uri.split_once(':').map(|(scheme, _)| scheme).filter(|scheme| scheme.len() > 1);
    if let Some(scheme) = scheme.filter(|scheme| scheme.chars().all(|c| c.is_ascii_alphanumeric())) {
        let message = format!("it names a file by {scheme}:, only files beside it and data URIs are read");
        return Err(ModelError::new(gltf, message));
    }
    Ok(Uri::File(gltf.parent().unwrap_or(Path::new("")).join(&*percent_decode(uri))))
}

fn percent_decode(uri: &str) -> Cow<'_, str> {
    if !uri.contains('%') {
        return Cow::Borrowed(uri);
    }
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let [first, tail @ ..] = rest {
        let code = (*first == b'%').then(|| tail.get(..2)).flatten();
        match code.and_then(|hex| std::str::from_utf8(hex).ok()).and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) => {
                bytes.push(byte);
                rest = &tail[2..];
            }
            None => {
                bytes.push(*first);
                rest = tail;
            }
        }
    }
    Cow::Owned(String::from_utf8_lossy(&bytes).into_owned())
}

/// Base64 of RFC 4648 in either alphabet, with or without padding; white space is skipped.
const BASE64: GeneralPurpose =
    GeneralPurpose::new(&base64::alphabet::STANDARD, NO_PAD.with_decode_allow_trailing_bits(true));

fn decode_base64(text: &str) -> Option<Vec<u8>> {
    let digits = text.bytes().filter(|byte| !b"\n\r ".contains(byte)).map(|byte| match byte {
        b'-' => b'+',
        b'_' => b'/',
        byte => byte,
    });
    let digits: Vec<u8> = digits.collect();
    let padding = digits.iter().rev().take_while(|&&byte| byte == b'=').count();
    BASE64.decode(&digits[..digits.len() - padding]).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_read_with_and_without_padding_and_cut_text_is_refused() {
        assert_eq!(decode_base64("cmVsaWVm").unwrap(), b"relief");
        assert_eq!(decode_base64("cmVsaQ==").unwrap(), b"reli");
        assert_eq!(decode_base64("cmVsaWU=\n").unwrap(), b"relie");
        assert_eq!(decode_base64("cmVsaWU").unwrap(), b"relie");
        assert_eq!(decode_base64("").unwrap(), b"");
        assert_eq!(decode_base64("cmVsa"), None);
        assert_eq!(decode_base64("cm*s"), None);
    }

    #[test]
    fn percent_codes_are_decoded_and_loose_percent_signs_stay() {
        assert_eq!(percent_decode("my%20wall%2.bin%"), "my wall%2.bin%");
    }
}
