//! Bindings of a height map in an embedder's own bind group.

use relievo_march::Cones;
use relievo_shader::{Permutation, TextureGlobal, TextureSample, TextureSource};

use super::height_texture::HeightTexture;
use crate::device::wgpu_util::texture_type;

/// Gives the bind group layout entries of the textures that a permutation's shader needs, from `first_binding` on in the order
/// of [`Permutation::textures`].
#[must_use]
pub fn texture_layout_entries(
    permutation: &Permutation,
    first_binding: u32,
    visibility: wgpu::ShaderStages,
) -> Vec<wgpu::BindGroupLayoutEntry> {
    let entry = |(binding, global): (u32, TextureGlobal)| {
        let sample_type = match global.sample {
            TextureSample::Uint => wgpu::TextureSampleType::Uint,
            _ => wgpu::TextureSampleType::Float { filterable: false },
        };
        let ty = texture_type(sample_type, wgpu::TextureViewDimension::D2);
        wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
    };
    (first_binding..).zip(permutation.textures()).map(entry).collect()
}

impl HeightTexture {
    /// Gives the bind group entries that go with [`texture_layout_entries`]. `cones` is the kind that the shader's options ask
    /// for.
    #[must_use]
    pub fn bind_group_entries(
        &self,
        permutation: &Permutation,
        first_binding: u32,
        cones: Cones,
    ) -> Vec<wgpu::BindGroupEntry<'_>> {
        let view = |source| match source {
            TextureSource::Pyramid => self.pyramid(),
            TextureSource::Cones => self.cones(cones),
            _ => self.view(),
        };
        (first_binding..)
            .zip(permutation.textures())
            .map(|(binding, global)| wgpu::BindGroupEntry {
                binding,
                resource: wgpu::BindingResource::TextureView(view(global.source)),
            })
            .collect()
    }
}
