//! The textures that a shader has to declare.

use relievo_march::{Shadow, Technique};

use crate::permutation::Permutation;

/// A texture that the shader of a permutation reads, which the embedder declares where the bindings have it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureGlobal {
    /// Name of the global, before any prefix: `relievo_heights`, `relievo_pyramid` or `relievo_cones`.
    pub name: &'static str,
    /// Type of what `textureLoad` gives.
    pub sample: TextureSample,
    /// Texture that belongs there.
    pub source: TextureSource,
}

/// Type of the channels of a texture as the shader loads them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TextureSample {
    /// `texture_2d<f32>`, not filtered.
    Float,
    /// `texture_2d<u32>`.
    Uint,
}

/// Texture of a height map; see [`crate::TextureBytes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum TextureSource {
    /// The heights.
    HeightMap,
    /// The max pyramids.
    Pyramid,
    /// The cones.
    Cones,
}

impl Permutation {
    /// Textures that [`crate::shader_source`] needs, in the order of their bindings.
    #[must_use]
    pub fn textures(&self) -> Vec<TextureGlobal> {
        let (sample, source) = (TextureSample::Uint, TextureSource::Pyramid);
        let mut textures = vec![TextureGlobal {
            name: "relievo_heights",
            sample: TextureSample::Float,
            source: TextureSource::HeightMap,
        }];
        let cones = self.technique == Technique::Cone;
        if cones || self.technique == Technique::Exact || self.shadow == Shadow::Exact {
            textures.push(TextureGlobal { name: "relievo_pyramid", sample, source });
        }
        if cones {
            textures.push(TextureGlobal { name: "relievo_cones", sample, source: TextureSource::Cones });
        }
        textures
    }

    /// Declares [`Permutation::textures`] in WGSL: in this group, from `first_binding` on.
    #[must_use]
    pub fn texture_declarations(&self, group: u32, first_binding: u32) -> String {
        let declare = |(binding, global): (u32, TextureGlobal)| {
            let kind = match global.sample {
                TextureSample::Float => "f32",
                TextureSample::Uint => "u32",
            };
            format!("@group({group}) @binding({binding}) var {}: texture_2d<{kind}>;\n", global.name)
        };
        (first_binding..).zip(self.textures()).map(declare).collect()
    }
}
