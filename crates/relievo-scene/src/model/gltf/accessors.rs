//! The numbers of a glTF file: views and accessors, every range checked.

use glam::{Vec2, Vec3, Vec4};
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;

use super::document::GltfDocument;
use crate::model::part::ModelError;

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

/// The elements of an accessor in their bytes; the range is checked.
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

/// Most elements of an accessor without a view, which are zeros: a small file must not ask for much memory by them.
const MOST_ZEROS: u64 = 1 << 24;

impl GltfDocument<'_> {
    /// Returns the bytes of a view.
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

    /// Reads the vectors of an accessor.
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

    /// Reads the indices of an accessor.
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

/// Decodes one number, little-endian; normalised ones to 0..1 or −1..1 (glTF 2.0, section 3.6.2.2).
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

/// Decodes an unsigned whole number of 1, 2 or 4 bytes.
fn decode_index(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |index, &byte| index << 8 | u32::from(byte))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_little_endian_and_normalised_as_the_standard_says() {
        assert_eq!(decode(&[0x00, 0x80], ComponentType::I16, true), -1.0);
        assert_eq!(decode(&[0xff], ComponentType::U8, true), 1.0);
        assert_eq!(decode(&[0x80], ComponentType::I8, false), -128.0);
        assert_eq!(decode_index(&[0x01, 0x02, 0x03, 0x04]), 0x0403_0201);
    }
}
