//! A material on the device.

use relievo_map::Wrap;
use relievo_march::{Shadow, Technique};
use relievo_scene::{ColorSpace, Edge, Filter, HeightRange, Material, ShadingModel, SurfaceTechnique};
use wgpu::util::DeviceExt;

use crate::layout::{MAX_LEVELS, SurfaceLayout};
use crate::map_texture::Uploader;
use crate::render_permutation::{NormalSource, Output, RenderPermutation};
use crate::{GpuError, HeightTexture, Permutation};

pub(crate) struct Look {
    pub(crate) bindings: wgpu::BindGroup,
    pub(crate) permutation: RenderPermutation,
}

/// What materials are made ready with.
pub(crate) struct Studio<'a> {
    pub(crate) device: &'a wgpu::Device,
    pub(crate) queue: &'a wgpu::Queue,
    pub(crate) layout: &'a wgpu::BindGroupLayout,
    pub(crate) space: ColorSpace,
    pub(crate) model: ShadingModel,
    pub(crate) output: Output,
    /// Samples along a stretched footprint, for materials with mip levels.
    pub(crate) anisotropy: u16,
}

impl Studio<'_> {
    /// `repeats`: whether an object with this material has more than one tile.
    pub(crate) fn look(&self, material: &Material, repeats: bool) -> Result<Look, GpuError> {
        let (device, queue) = (self.device, self.queue);
        let maps = &material.maps;
        let relief = &material.relief;
        let upload = Uploader { device, queue, filter: material.filter, material: &material.name };

        let heights = material.heights(self.space);
        let heights = heights.map(|heights| HeightTexture::new(device, queue, &heights)).transpose()?;
        let white = || plain(device, queue, wgpu::TextureFormat::Rgba8Unorm, &[255; 4]);
        let floor = || plain(device, queue, wgpu::TextureFormat::R32Float, &[0; 4]);
        let scalar = |what, map: &Option<_>| map.as_ref().map_or_else(|| Ok(white()), |map| upload.scalar(what, map));
        let color = maps.base_color.as_ref().map(|map| upload.color(map, self.space)).transpose()?;
        let normal = maps.normal.as_ref().map(|map| upload.normal(map)).transpose()?;
        let (roughness, metallic, ao) =
            (scalar("roughness", &maps.roughness)?, scalar("metallic", &maps.metallic)?, scalar("ao", &maps.ao)?);

        let clamps = relief.edge == Edge::Clamp;
        let wrap = if clamps && !repeats { Wrap::Clamp } else { material.wrap };
        let permutation = self.permutation(material, heights.as_ref(), wrap);
        let (depth, absolute) = match material.height {
            HeightRange::Scale(scale) => (scale, false),
            HeightRange::Depth(depth) => (depth, true),
        };
        let mut ranges = [[0.0, 1.0]; MAX_LEVELS];
        if let Some(heights) = &heights {
            // Texture limits are far below the levels there is room for.
            for (range, known) in ranges.iter_mut().zip(heights.ranges()) {
                *range = *known;
            }
        }
        let surface = SurfaceLayout {
            // The bounds are the object's.
            how: (&relief.march(material.midlevel, glam::Vec2::ONE)).into(),
            base_color: material.base_color,
            roughness: material.roughness,
            metallic: material.metallic,
            depth,
            depth_is_absolute: absolute.into(),
            last_level: heights.as_ref().map_or(0, |heights| heights.last_level() as i32),
            normal_decode: normal.as_ref().map_or([2.0, -1.0], |normal| normal.1),
            height_step: heights.as_ref().map_or(0.0, HeightTexture::step),
            lod: relief.lod.into(),
            stretched: (clamps && repeats).into(),
            levels: (material.filter == Filter::Trilinear || relief.lod).into(),
            pad: [0; 2],
            ranges,
        };
        let surface = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("relievo surface"),
            contents: bytemuck::bytes_of(&surface),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let sampler = self.sampler(wrap, material.filter);
        let heights = heights.map_or_else(floor, |heights| heights.view().clone());
        let color = color.unwrap_or_else(white);
        let normal = normal.map_or_else(white, |normal| normal.0);
        let views = [&heights, &color, &normal, &roughness, &metallic, &ao];
        let mut entries = vec![wgpu::BindGroupEntry { binding: 0, resource: surface.as_entire_binding() }];
        for (k, view) in views.into_iter().enumerate() {
            let resource = wgpu::BindingResource::TextureView(view);
            entries.push(wgpu::BindGroupEntry { binding: k as u32 + 1, resource });
        }
        entries.push(wgpu::BindGroupEntry { binding: 7, resource: wgpu::BindingResource::Sampler(&sampler) });
        let descriptor =
            wgpu::BindGroupDescriptor { label: Some("relievo surface"), layout: self.layout, entries: &entries };
        Ok(Look { bindings: device.create_bind_group(&descriptor), permutation })
    }

    fn permutation(&self, material: &Material, heights: Option<&HeightTexture>, wrap: Wrap) -> RenderPermutation {
        let relief = &material.relief;
        let flat = relief.technique == SurfaceTechnique::March(Technique::None);
        let technique = match relief.technique {
            SurfaceTechnique::March(technique) if heights.is_some() && technique != Technique::Normal => technique,
            SurfaceTechnique::March(_) | SurfaceTechnique::Displacement => Technique::None,
        };
        let marches = technique != Technique::None;
        let displaces = relief.technique == SurfaceTechnique::Displacement && heights.is_some();
        RenderPermutation {
            march: Permutation {
                technique,
                shadow: if marches { relief.shadow } else { Shadow::None },
                wrap,
                eight_bit: heights.is_some_and(HeightTexture::is_filtered_in_8_bits),
            },
            model: self.model.into(),
            normal: match (&material.maps.normal, heights) {
                _ if flat => NormalSource::Mesh,
                (Some(_), _) => NormalSource::Map,
                (None, Some(_)) => NormalSource::Heights,
                (None, None) => NormalSource::Mesh,
            },
            output: self.output,
            writes_depth: marches && relief.writes_depth(),
            one_sided: marches || displaces,
        }
    }

    fn sampler(&self, wrap: Wrap, filter: Filter) -> wgpu::Sampler {
        let mode = match wrap {
            Wrap::Repeat => wgpu::AddressMode::Repeat,
            Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
            Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        };
        self.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("relievo maps"),
            address_mode_u: mode,
            address_mode_v: mode,
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            anisotropy_clamp: if filter == Filter::Trilinear { self.anisotropy } else { 1 },
            ..wgpu::SamplerDescriptor::default()
        })
    }
}

/// One texel, for maps that are not there.
fn plain(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    format: wgpu::TextureFormat,
    texel: &[u8; 4],
) -> wgpu::TextureView {
    let descriptor = wgpu::TextureDescriptor {
        label: Some("relievo plain"),
        size: wgpu::Extent3d { width: 1, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let texture = device.create_texture_with_data(queue, &descriptor, wgpu::util::TextureDataOrder::LayerMajor, texel);
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
