//! A material on the device.

use glam::Vec2;
use relievo_map::Wrap;
use relievo_march::{Cones, Shadow, Technique};
use relievo_scene::{ColorSpace, Filter, HeightRange, Material, ShadingModel, SurfaceTechnique};
use wgpu::util::DeviceExt;

use crate::layout::{MAX_LEVELS, SurfaceLayout};
use crate::map_texture::Uploader;
use crate::render_permutation::{Casters, NormalSource, Output, RenderPermutation};
use crate::{GpuError, HeightTexture, Permutation};

pub(crate) struct MaterialResources {
    pub(crate) bindings: wgpu::BindGroup,
    pub(crate) permutation: RenderPermutation,
    maps: Maps,
    /// How the heights were made ready: with mip levels, and with cones.
    heights: (bool, Option<Cones>),
    /// Whether the heights are the caller's.
    given: bool,
}

impl MaterialResources {
    /// Takes these heights from now on; what is bound is the old ones until the look is made anew.
    pub(crate) fn give(&mut self, heights: &HeightTexture) {
        self.maps.heights = Some(heights.clone());
        self.given = true;
    }
}

/// A material's maps, uploaded; one white texel for those that are not there.
#[derive(Clone)]
struct Maps {
    heights: Option<HeightTexture>,
    /// Instead of heights, where there are none.
    floor: wgpu::TextureView,
    no_pyramid: wgpu::TextureView,
    color: wgpu::TextureView,
    normal: Option<(wgpu::TextureView, [f32; 2])>,
    /// Instead of normals, how the heights' slopes scatter: for level of detail.
    scatter: Option<wgpu::TextureView>,
    roughness: wgpu::TextureView,
    metallic: wgpu::TextureView,
    ao: wgpu::TextureView,
    white: wgpu::TextureView,
}

/// What materials are made ready with.
pub(crate) struct MaterialUploader<'a> {
    pub(crate) device: &'a wgpu::Device,
    pub(crate) queue: &'a wgpu::Queue,
    pub(crate) layout: &'a wgpu::BindGroupLayout,
    pub(crate) space: ColorSpace,
    pub(crate) model: ShadingModel,
    pub(crate) output: Output,
    /// Whether light comes from all around.
    pub(crate) surroundings: bool,
    /// Samples along a stretched footprint, for materials with mip levels.
    pub(crate) anisotropy: u16,
    /// Whether the borders of clipped reliefs are multisampled.
    pub(crate) smooths_edges: bool,
}

impl MaterialUploader<'_> {
    /// The material at `number` of its scene. `repeat`: the texture range of an object with this material that has more than one tile, else one tile.
    /// `known` is what was made of it before, with the same maps.
    pub(crate) fn look(
        &self,
        number: usize,
        material: &Material,
        repeat: Vec2,
        known: Option<&MaterialResources>,
    ) -> Result<MaterialResources, GpuError> {
        let heights_as = (material.relief.lod, material.relief.needed_cones());
        let given = known.is_some_and(|known| known.given);
        let maps = match known {
            Some(known) if known.heights == heights_as => known.maps.clone(),
            Some(known) if given => Maps { heights: known.maps.heights.clone(), ..self.maps(material)? },
            // Level of detail wants all maps otherwise, cones the heights alone.
            Some(known) if known.heights.0 == heights_as.0 => {
                Maps { heights: self.heights(material)?, ..known.maps.clone() }
            }
            _ => self.maps(material)?,
        };
        let (wrap, stretched) = material.relief.addressing(material.wrap, repeat);
        let stretched = stretched.is_some();
        let permutation = self.permutation(material, &maps, wrap, stretched);
        let surface = surface_layout(number, material, &maps, stretched);
        let surface = self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("relievo surface"),
            contents: bytemuck::bytes_of(&surface),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let sampler = self.sampler(wrap, material.filter);
        let heights = maps.heights.as_ref().map_or(&maps.floor, HeightTexture::view);
        let normal = maps.normal.as_ref().map(|normal| &normal.0).or(maps.scatter.as_ref()).unwrap_or(&maps.white);
        let views = [heights, &maps.color, normal, &maps.roughness, &maps.metallic, &maps.ao];
        let mut entries = vec![wgpu::BindGroupEntry { binding: 0, resource: surface.as_entire_binding() }];
        for (k, view) in views.into_iter().enumerate() {
            let resource = wgpu::BindingResource::TextureView(view);
            entries.push(wgpu::BindGroupEntry { binding: k as u32 + 1, resource });
        }
        entries.push(wgpu::BindGroupEntry { binding: 7, resource: wgpu::BindingResource::Sampler(&sampler) });
        let pyramid = maps.heights.as_ref().map_or(&maps.no_pyramid, HeightTexture::pyramid);
        let cones = maps.heights.as_ref().map_or(&maps.no_pyramid, |heights| heights.cones(material.relief.cones));
        for (binding, view) in [(8, pyramid), (9, cones)] {
            entries.push(wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) });
        }
        let descriptor =
            wgpu::BindGroupDescriptor { label: Some("relievo surface"), layout: self.layout, entries: &entries };
        let bindings = self.device.create_bind_group(&descriptor);
        Ok(MaterialResources { bindings, permutation, maps, heights: heights_as, given })
    }

    fn heights(&self, material: &Material) -> Result<Option<HeightTexture>, GpuError> {
        let heights = material.heights(self.space);
        heights.map(|heights| HeightTexture::new(self.device, self.queue, &heights)).transpose()
    }

    fn maps(&self, material: &Material) -> Result<Maps, GpuError> {
        let (device, queue) = (self.device, self.queue);
        let maps = &material.maps;
        let upload = Uploader { device, queue, levels: material.has_levels(), material: &material.name };
        let white = plain(device, queue, wgpu::TextureFormat::Rgba8Unorm, &[255; 4]);
        let scalar =
            |what, map: &Option<_>| map.as_ref().map_or_else(|| Ok(white.clone()), |map| upload.scalar(what, map));
        let color = maps.base_color.as_ref().map(|map| upload.color(map, self.space)).transpose()?;
        Ok(Maps {
            heights: self.heights(material)?,
            floor: plain(device, queue, wgpu::TextureFormat::R32Float, &[0; 4]),
            no_pyramid: plain(device, queue, wgpu::TextureFormat::Rgba8Uint, &[0; 4]),
            color: color.unwrap_or_else(|| white.clone()),
            normal: maps.normal.as_ref().map(|map| upload.normal(map, material.relief.lod)).transpose()?,
            scatter: material.slope_scatter().map(|mips| upload.slope_scatter(&mips)).transpose()?,
            roughness: scalar("roughness", &maps.roughness)?,
            metallic: scalar("metallic", &maps.metallic)?,
            ao: scalar("ao", &maps.ao)?,
            white,
        })
    }

    fn permutation(&self, material: &Material, maps: &Maps, wrap: Wrap, stretched: bool) -> RenderPermutation {
        let relief = &material.relief;
        let heights = maps.heights.as_ref();
        let flat = relief.technique.shades_flat();
        let technique = relief.technique.marched().filter(|_| heights.is_some()).unwrap_or(Technique::None);
        let marches = technique != Technique::None;
        let displaces = relief.technique == SurfaceTechnique::Displacement && heights.is_some();
        RenderPermutation {
            march: Permutation {
                technique,
                shadow: if marches { relief.shadow } else { Shadow::None },
                wrap,
                eight_bit: heights.is_some_and(HeightTexture::is_filtered_in_8_bits),
                stretched,
            },
            model: self.model.into(),
            normal: match (&material.maps.normal, heights) {
                _ if flat => NormalSource::Mesh,
                (Some(_), _) => NormalSource::Map,
                (None, Some(_)) => NormalSource::ReliefMap,
                (None, None) => NormalSource::Mesh,
            },
            output: self.output,
            writes_depth: marches && relief.writes_depth(),
            casters: match relief.shadow {
                Shadow::Exact => Casters::Everything,
                // The tutorials' shadows know the relief alone.
                Shadow::Hard | Shadow::Soft if displaces => Casters::Itself,
                _ => Casters::Nothing,
            },
            softens: relief.shadow == Shadow::Exact,
            surroundings: self.surroundings,
            smooths_edges: self.smooths_edges,
            one_sided: marches || displaces,
            displaced: displaces,
            lod: relief.lod,
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

fn surface_layout(number: usize, material: &Material, maps: &Maps, stretched: bool) -> SurfaceLayout {
    let relief = &material.relief;
    let heights = maps.heights.as_ref();
    let (depth, absolute) = match material.height {
        HeightRange::Scale(scale) => (scale, false),
        HeightRange::Depth(depth) => (depth, true),
    };
    let mut ranges = [[0.0, 1.0]; MAX_LEVELS];
    if let Some(heights) = heights {
        // Texture limits are far below the levels there is room for.
        for (range, known) in ranges.iter_mut().zip(heights.ranges()) {
            *range = *known;
        }
    }
    SurfaceLayout {
        // The bounds are the object's.
        options: (&relief.march(material.midlevel, glam::Vec2::ONE)).into(),
        base_color: material.base_color,
        roughness: material.roughness,
        metallic: material.metallic,
        depth,
        depth_is_absolute: absolute.into(),
        last_level: heights.map_or(0, |heights| heights.last_level() as i32),
        normal_decode: maps.normal.as_ref().map_or([2.0, -1.0], |normal| normal.1),
        height_step: heights.map_or(0.0, HeightTexture::quantization_step),
        stretched: stretched.into(),
        levels: material.has_levels().into(),
        number: number as u32,
        pad: [0; 2],
        ranges,
    }
}
