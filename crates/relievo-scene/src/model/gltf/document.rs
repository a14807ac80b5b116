//! The JSON structure of a glTF file and the bytes behind it.

use std::path::Path;

use gltf::json::{Root, deserialize};

use super::buffers::Buffers;
use crate::model::part::ModelError;

/// The parsed JSON, the bytes behind it, and the file's name for errors.
pub(super) struct GltfDocument<'a> {
    pub(super) root: Root,
    pub(super) buffers: Buffers,
    pub(super) path: &'a Path,
}

impl<'a> GltfDocument<'a> {
    pub(super) fn new(bytes: &[u8], path: &'a Path) -> Result<Self, ModelError> {
        let (json, blob) = if bytes.starts_with(b"glTF") {
            split_glb(bytes).map_err(|message| ModelError::new(path, message))?
        } else {
            (bytes, None)
        };
        if bytes.is_empty() {
            return Err(ModelError::new(
                path,
                "the file is empty; was it cut short while it was copied or downloaded?",
            ));
        }
        let root: Root = deserialize::from_slice(json)
            .map_err(|error| ModelError::new(path, format!("its glTF JSON is broken: {error}; export it again")))?;
        let version = &root.asset.version;
        if !version.starts_with("2.") {
            return Err(ModelError::new(path, format!("this is glTF {version}; export it as glTF 2.0")));
        }
        let supported = |name: &str| {
            // What only changes the look may be left out; what packs the geometry cannot be.
            name == "KHR_mesh_quantization"
                || name == "KHR_texture_transform"
                || name.starts_with("KHR_materials_")
                || name.starts_with("KHR_lights_")
        };
        if let Some(name) = root.extensions_required.iter().find(|name| !supported(name)) {
            let message = format!("it needs the glTF extension {name}, which is not read; export it without");
            return Err(ModelError::new(path, message));
        }
        let buffers = Buffers::read(&root, blob, path)?;
        Ok(Self { root, buffers, path })
    }

    pub(super) fn error(&self, message: impl Into<String>) -> ModelError {
        ModelError::new(self.path, message)
    }

    /// The element of a list that an index of the file names.
    pub(super) fn get<'t, T>(&self, list: &'t [T], index: usize, what: &str) -> Result<&'t T, ModelError> {
        list.get(index).ok_or_else(|| self.error(format!("it names {what} {index}, but has {}", list.len())))
    }
}

/// The JSON and the binary chunk of a GLB container.
fn split_glb(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    let word = |offset: usize| {
        bytes.get(offset..offset + 4).and_then(|word| word.try_into().ok()).map(u32::from_le_bytes).map(|w| w as usize)
    };
    let cut = || "the GLB file is cut short; copy, download or export it again".to_owned();
    let version = word(4).ok_or_else(cut)?;
    if version != 2 {
        return Err(format!("this is glTF version {version}, only version 2 is read"));
    }
    let length = word(8).ok_or_else(cut)?;
    let bytes = bytes.get(..length).ok_or_else(cut)?;
    let mut rest = bytes.get(12..).ok_or_else(cut)?;
    let mut json = None;
    let mut blob = None;
    while rest.len() >= 8 {
        let (header, body) = rest.split_at(8);
        let length = u32::from_le_bytes([header[0], header[1], header[2], header[3]]) as usize;
        let chunk = body.get(..length).ok_or_else(cut)?;
        match &header[4..] {
            b"JSON" if json.is_none() => json = Some(chunk),
            b"BIN\0" if blob.is_none() => blob = Some(chunk),
            // Unknown chunks are to be skipped.
            _ => {}
        }
        rest = &body[length..];
    }
    Ok((json.ok_or("the GLB file has no JSON in it; export it again")?, blob))
}
