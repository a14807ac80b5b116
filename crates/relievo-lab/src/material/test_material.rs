use std::path::Path;

use relievo_journal::{ContentHash, ContentHasher};
use relievo_make::MakeError;
use relievo_map::{HeightMap, Limits, Loaded, MapError, MapSet, White, read_folder, read_height};
use thiserror::Error;

use super::corpus::{corpus, corpus_description, corpus_names};

/// A material under test: a height map, and optional maps that show in its pictures.
#[derive(Clone, Debug)]
pub struct TestMaterial {
    /// Name in reports and files; unique in a sweep.
    pub name: String,
    /// Description of its origin.
    pub source: String,
    /// The height map.
    pub height: HeightMap,
    /// The other maps, without heights.
    pub maps: MapSet,
    /// Full range of heights that the generator recommends, as a fraction of one repeat along u.
    pub height_scale: Option<f32>,
    /// Notes from loading.
    pub notes: Vec<String>,
}

/// An error of loading a material.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TestMaterialError {
    /// The generated material is unknown or cannot be made.
    #[error(transparent)]
    Make(#[from] MakeError),
    /// A file cannot be read.
    #[error(transparent)]
    Map(#[from] MapError),
    /// The material has no height map.
    #[error("{name}: this material has no height map, so there is no relief to judge")]
    NoHeight {
        /// The name that was given.
        name: String,
    },
    /// The name is neither a material nor a file.
    #[error(
        "{name}: there is no such file or folder; a material is a folder of maps, a height map, make:NAME (a generated \
         material), or one of {}",
        corpus_names().join(", ")
    )]
    Unknown {
        /// The name that was given.
        name: String,
    },
}

impl TestMaterial {
    /// Creates a material from a height map alone.
    #[must_use]
    pub fn of_heights(name: &str, height: HeightMap) -> Self {
        Self {
            name: name.to_owned(),
            source: "heights".to_owned(),
            height,
            maps: MapSet::default(),
            height_scale: None,
            notes: Vec::new(),
        }
    }

    /// Loads the material called `text`: a map of the lab's corpus ([`corpus_names`]), `make:NAME`, a folder of maps, or a height
    /// map (white is high). Generated ones are `size` × `size` texels.
    ///
    /// # Errors
    /// If there is none of that name, it cannot be read, or it has no heights.
    pub fn load(text: &str, size: u32, limits: &Limits) -> Result<Self, TestMaterialError> {
        let no_height = || TestMaterialError::NoHeight { name: text.to_owned() };
        if let (Some(height), Some(description)) = (corpus(text, size), corpus_description(text)) {
            return Ok(Self { source: description.to_owned(), ..Self::of_heights(text, height) });
        }
        if let Some(name) = text.strip_prefix("make:") {
            let mut maps = relievo_make::make(name, size)?;
            return Ok(Self {
                name: name.to_owned(),
                source: text.to_owned(),
                height: maps.height.take().ok_or_else(no_height)?,
                maps,
                height_scale: Some(relievo_make::height_scale(name)?),
                notes: Vec::new(),
            });
        }
        let path = Path::new(text);
        let name = std::fs::canonicalize(path).ok();
        let name = name.as_deref().unwrap_or(path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            let Loaded { map: mut maps, notes } = read_folder(path, limits)?;
            let height = maps.height.take().ok_or_else(no_height)?;
            return Ok(Self {
                maps,
                notes,
                source: "maps from a folder".to_owned(),
                ..Self::of_heights(&name, height)
            });
        }
        if !path.exists() {
            return Err(TestMaterialError::Unknown { name: text.to_owned() });
        }
        let Loaded { map, notes } = read_height(path, White::High, limits)?;
        Ok(Self { notes, source: "a height map".to_owned(), ..Self::of_heights(&name, map) })
    }

    /// Replaces `make:all` and `corpus` by the names of all their materials.
    #[must_use]
    pub fn expand(texts: &[String]) -> Vec<String> {
        let list = |text: &String| match text.as_str() {
            "make:all" => relievo_make::names().iter().map(|name| format!("make:{name}")).collect(),
            "corpus" => corpus_names().into_iter().map(str::to_owned).collect(),
            _ => vec![text.clone()],
        };
        texts.iter().flat_map(list).collect()
    }

    /// Size in texels along u and v.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.height.grid().width(), self.height.grid().height()]
    }

    /// Hash of all its maps.
    pub(crate) fn fingerprint(&self) -> ContentHash {
        let mut hasher = ContentHasher::default();
        for side in self.size() {
            hasher.add(&side.to_le_bytes());
        }
        hasher.add_numbers(self.height.grid().texels().iter().copied());
        // Each map after its name, so that none is taken for another.
        if let Some(map) = &self.maps.base_color {
            hasher.add(b"base_color");
            hasher.add_numbers(map.grid.texels().iter().flatten().copied());
        }
        if let Some(map) = &self.maps.normal {
            hasher.add(b"normal");
            hasher.add_numbers(map.grid().texels().iter().flatten().copied());
        }
        let maps = [("roughness", &self.maps.roughness), ("metallic", &self.maps.metallic), ("ao", &self.maps.ao)];
        for (name, map) in maps {
            if let Some(map) = map {
                hasher.add(name.as_bytes());
                hasher.add_numbers(map.grid().texels().iter().copied());
            }
        }
        hasher.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_for_materials_and_odd_ones_are_explained() {
        let load = |text: &str| TestMaterial::load(text, 32, &Limits::default());
        assert_eq!(load("spikes").unwrap().size(), [32, 32]);
        assert!(load("make:brick-wall").unwrap().maps.base_color.is_some());
        assert!(load("make:brick-wal").unwrap_err().to_string().contains("did you mean"));
        let unknown = load("no/such").unwrap_err().to_string();
        assert!(unknown.contains("no/such") && unknown.contains("spikes"), "{unknown}");
        let all = TestMaterial::expand(&["make:all".to_owned(), "corpus".to_owned(), "x".to_owned()]);
        assert_eq!(all.len(), relievo_make::names().len() + 4 + 1);
    }

    #[test]
    fn one_texel_changes_the_fingerprint() {
        let map = corpus("noise", 16).unwrap();
        let mut other = map.grid().clone();
        other.texels_mut()[17] = 0.5;
        let [a, b] = [map, HeightMap::new(other)].map(|map| TestMaterial::of_heights("x", map).fingerprint());
        assert_ne!(a, b);
    }
}
