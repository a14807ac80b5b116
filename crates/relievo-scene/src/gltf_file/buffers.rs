//! The bytes behind a glTF file: buffers, views and accessors, every range checked.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use base64::Engine as _;
use base64::engine::general_purpose::{GeneralPurpose, NO_PAD};
use glam::{Vec2, Vec3, Vec4};
use gltf::json::Root;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;

use super::GltfFile;
use crate::model::{ModelError, read_file};

/// The file's buffers, each at least as long as the file says.
pub(super) struct Buffers(Vec<Vec<u8>>);

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

/// Where the bytes of a URI are.
pub(super) enum Uri {
    Bytes(Vec<u8>),
    File(PathBuf),
}

/// A data URI's bytes, or the file beside the glTF file.
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

/// A vector that an accessor's elements become.
pub(super) trait Element {
    const TYPE: Type;
    fn from_components(components: &[f32; 4]) -> Self;
}

impl Element for Vec2 {
    const TYPE: Type = Type::Vec2;
    fn from_components(&[x, y, _, _]: &[f32; 4]) -> Self {
        Self::new(x, y)
    }
}

impl Element for Vec3 {
    const TYPE: Type = Type::Vec3;
    fn from_components(&[x, y, z, _]: &[f32; 4]) -> Self {
        Self::new(x, y, z)
    }
}

impl Element for Vec4 {
    const TYPE: Type = Type::Vec4;
    fn from_components(components: &[f32; 4]) -> Self {
        Self::from_array(*components)
    }
}

/// Elements that lie in bytes: known to be inside.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
    count: usize,
}

impl<'a> Elements<'a> {
    fn iter(&self) -> impl Iterator<Item = &'a [u8]> {
        let Self { bytes, stride, size, count } = *self;
        (0..count).map(move |i| &bytes[i * stride..i * stride + size])
    }
}

/// Elements of an accessor without a view are zeros: a small file must not ask for much memory by them.
const MOST_ZEROS: u64 = 1 << 24;

impl GltfFile<'_> {
    /// The bytes of a view.
    pub(super) fn view(&self, index: usize) -> Result<&[u8], ModelError> {
        let view = self.get(&self.root.buffer_views, index, "buffer view")?;
        let buffer = self.get(&self.buffers.0, view.buffer.value(), "buffer")?;
        let offset = view.byte_offset.unwrap_or_default().0;
        let end = offset.checked_add(view.byte_length.0);
        let range = end.and_then(|end| Some(usize::try_from(offset).ok()?..usize::try_from(end).ok()?));
        range.and_then(|range| buffer.get(range)).ok_or_else(|| {
            self.error(format!("buffer view {index} reaches beyond its buffer; was the file cut short?"))
        })
    }

    /// `count` elements of `size` bytes in a view.
    fn elements(
        &self,
        view: usize,
        offset: u64,
        count: u64,
        size: usize,
        name: &str,
    ) -> Result<Elements<'_>, ModelError> {
        let bytes = self.view(view)?;
        let stride = self.root.buffer_views.get(view).and_then(|view| view.byte_stride).map_or(0, |stride| stride.0);
        let stride = if stride == 0 { size } else { stride };
        let beyond =
            || self.error(format!("{name}: {count} elements reach beyond their buffer; was the file cut short?"));
        if stride < size {
            return Err(self.error(format!("{name}: elements of {size} bytes lie only {stride} bytes apart")));
        }
        if count == 0 {
            return Ok(Elements { bytes: &[], stride, size, count: 0 });
        }
        let offset = usize::try_from(offset).map_err(|_| beyond())?;
        let bytes = bytes.get(offset..).ok_or_else(beyond)?;
        let count = usize::try_from(count).map_err(|_| beyond())?;
        let end = (count - 1).checked_mul(stride).and_then(|last| last.checked_add(size)).ok_or_else(beyond)?;
        if end > bytes.len() {
            return Err(beyond());
        }
        Ok(Elements { bytes, stride, size, count })
    }

    /// The vectors of an accessor.
    pub(super) fn read<T: Element>(&self, index: usize, name: &str) -> Result<Vec<T>, ModelError> {
        let accessor = self.get(&self.root.accessors, index, "accessor")?;
        let component = self.component(accessor, name)?;
        if !matches!(accessor.type_, Checked::Valid(found) if found == T::TYPE) {
            return Err(self.error(format!("{name}: expected {:?}", T::TYPE)));
        }
        let components = T::TYPE.multiplicity();
        let size = component.size() * components;
        let decode = |bytes: &[u8]| {
            let mut values = [0.0; 4];
            for (value, bytes) in values.iter_mut().zip(bytes.chunks_exact(component.size())) {
                *value = decode(bytes, component, accessor.normalized);
            }
            T::from_components(&values)
        };
        let mut values: Vec<T> = match accessor.buffer_view {
            Some(view) => {
                let offset = accessor.byte_offset.unwrap_or_default().0;
                self.elements(view.value(), offset, accessor.count.0, size, name)?.iter().map(decode).collect()
            }
            None if accessor.count.0 <= MOST_ZEROS => {
                (0..accessor.count.0).map(|_| T::from_components(&[0.0; 4])).collect()
            }
            None => return Err(self.error(format!("{name}: {} elements without any bytes", accessor.count.0))),
        };
        if let Some(sparse) = &accessor.sparse {
            let Checked::Valid(index_type) = sparse.indices.component_type else {
                return Err(self.error(format!("{name}: sparse indices of an unknown type")));
            };
            let (count, view) = (sparse.count.0, &sparse.indices);
            let indices =
                self.elements(view.buffer_view.value(), view.byte_offset.0, count, index_type.0.size(), name)?;
            let view = &sparse.values;
            let replaced = self.elements(view.buffer_view.value(), view.byte_offset.0, count, size, name)?;
            for (index, bytes) in indices.iter().zip(replaced.iter()) {
                let slot = values.get_mut(decode_index(index) as usize);
                *slot.ok_or_else(|| self.error(format!("{name}: a sparse index is out of range")))? = decode(bytes);
            }
        }
        Ok(values)
    }

    /// The indices of an accessor.
    pub(super) fn read_indices(&self, index: usize, name: &str) -> Result<Vec<u32>, ModelError> {
        let accessor = self.get(&self.root.accessors, index, "accessor")?;
        let component = self.component(accessor, name)?;
        let sound = matches!(component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32)
            && matches!(accessor.type_, Checked::Valid(Type::Scalar))
            && accessor.sparse.is_none();
        let Some(view) = accessor.buffer_view.filter(|_| sound) else {
            return Err(self.error(format!("{name}: expected plain unsigned whole numbers")));
        };
        let offset = accessor.byte_offset.unwrap_or_default().0;
        let elements = self.elements(view.value(), offset, accessor.count.0, component.size(), name)?;
        Ok(elements.iter().map(decode_index).collect())
    }

    fn component(&self, accessor: &Accessor, name: &str) -> Result<ComponentType, ModelError> {
        match &accessor.component_type {
            Checked::Valid(component) => Ok(component.0),
            Checked::Invalid => Err(self.error(format!("{name}: numbers of an unknown type"))),
        }
    }
}

/// One number, little-endian; normalised ones to 0..1 or −1..1 (glTF 2.0, section 3.6.2.2).
fn decode(bytes: &[u8], component: ComponentType, normalized: bool) -> f32 {
    let (value, most) = match (component, bytes) {
        (ComponentType::I8, &[a]) => (f32::from(a as i8), 127.0),
        (ComponentType::U8, &[a]) => (f32::from(a), 255.0),
        (ComponentType::I16, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])), 32767.0),
        (ComponentType::U16, &[a, b]) => (f32::from(u16::from_le_bytes([a, b])), 65535.0),
        (ComponentType::U32, &[a, b, c, d]) => (u32::from_le_bytes([a, b, c, d]) as f32, u32::MAX as f32),
        (ComponentType::F32, &[a, b, c, d]) => return f32::from_le_bytes([a, b, c, d]),
        // The slices are as long as the type.
        _ => return 0.0,
    };
    if normalized { (value / most).max(-1.0) } else { value }
}

/// An unsigned whole number of 1, 2 or 4 bytes.
fn decode_index(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |index, &byte| index << 8 | u32::from(byte))
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

    #[test]
    fn numbers_are_little_endian_and_normalised_as_the_standard_says() {
        assert_eq!(decode(&[0x00, 0x80], ComponentType::I16, true), -1.0);
        assert_eq!(decode(&[0xff], ComponentType::U8, true), 1.0);
        assert_eq!(decode(&[0x80], ComponentType::I8, false), -128.0);
        assert_eq!(decode_index(&[0x01, 0x02, 0x03, 0x04]), 0x0403_0201);
    }
}
