//! A material on the device.

use relievo_map::{GridId, Wrap};
use relievo_march::{Bounds, Cones, Shadow, Technique};
use relievo_scene::{ColorSpace, Filter, HeightRange, Material, Shading, Side, SurfaceTechnique};
use wgpu::util::DeviceExt;

use super::layout::{MAX_LEVELS, SurfaceLayout};
use super::live_material::LiveMaterials;
use super::map_uploader::MapUploader;
use super::options::RendererOptions;
use super::permutation::{Casters, DrawnGeometry, NormalSource, Output, RenderPermutation};
use crate::device::wgpu_util::{bind_group, texture_descriptor, view, whole_view};
use crate::{GpuError, HeightTexture, LiveHeights, MarchUniforms, Permutation};

pub(crate) struct MaterialResources {
    pub(crate) bindings: wgpu::BindGroup,
    pub(crate) permutation: RenderPermutation,
    maps: Maps,
    made_of: MadeOf,
    /// True if the heights are the caller's.
    given: bool,
    /// True if it is a medium, not a surface.
    mist: bool,
}

/// The maps that textures were made of, and their form.
#[derive(Clone, Copy, PartialEq)]
struct MadeOf {
    maps: [Option<GridId>; 6],
    form: MapForm,
    cones: Option<Cones>,
    /// True if the device makes the heights.
    live: bool,
}

/// Settings on which the form of all of a material's textures depends.
#[derive(Clone, Copy, PartialEq)]
struct MapForm {
    lod: bool,
    levels: bool,
    nearest: bool,
    wrap: Wrap,
    space: ColorSpace,
}

/// Indices into the identities of a map set.
const COLOR: usize = 0;
const NORMAL: usize = 1;
const HEIGHT: usize = 2;
const ROUGHNESS: usize = 3;
const METALLIC: usize = 4;
const AO: usize = 5;

/// A side of a material, with its maps.
struct MaterialSide<'a> {
    number: usize,
    material: &'a Material,
    side: Side,
    maps: Maps,
    made_of: MadeOf,
    given: bool,
}

impl MaterialResources {
    /// True if the heights are the caller's.
    pub(crate) fn is_given(&self) -> bool {
        self.given
    }

    /// True if it is a medium, not a surface.
    pub(crate) fn is_mist(&self) -> bool {
        self.mist
    }

    /// Sets the heights; those that are bound stay until the material is made anew.
    pub(crate) fn set_heights(&mut self, heights: &HeightTexture) {
        self.maps.heights = Some(heights.clone());
        self.given = true;
    }
}

/// A material's maps, uploaded; one white texel for those that are not there.
#[derive(Clone)]
struct Maps {
    heights: Option<HeightTexture>,
    /// Stands in for heights where there are none.
    floor: wgpu::TextureView,
    no_pyramid: wgpu::TextureView,
    color: wgpu::TextureView,
    normal: Option<wgpu::TextureView>,
    /// Scatter of the heights' slopes instead of normals: for level of detail.
    scatter: Option<wgpu::TextureView>,
    roughness: wgpu::TextureView,
    metallic: wgpu::TextureView,
    ao: wgpu::TextureView,
    white: wgpu::TextureView,
}

/// Makes materials ready.
pub(crate) struct MaterialUploader<'a> {
    pub(crate) device: &'a wgpu::Device,
    pub(crate) queue: &'a wgpu::Queue,
    pub(crate) output: Output,
    /// True if light comes from all around.
    pub(crate) environment: bool,
    pub(crate) options: &'a RendererOptions,
    /// Heights that the device makes.
    pub(crate) live: &'a LiveMaterials,
    /// True if there is mist in the scene.
    pub(crate) mist: bool,
}

impl MaterialUploader<'_> {
    /// Makes the material at `number` of its scene ready. `tiled`: whether a chart of an object with this material has another
    /// texture range than one tile. `known`: what was made of it before: maps that are the same are not uploaded again.
    pub(crate) fn make(
        &self,
        layout: &wgpu::BindGroupLayout,
        shading: &Shading,
        (number, material): (usize, &Material),
        tiled: bool,
        known: Option<&MaterialResources>,
    ) -> Result<MaterialResources, GpuError> {
        let space = shading.color_space;
        let given = known.is_some_and(|known| known.given);
        let live = self.live.heights(number).filter(|_| !given);
        let form = MapForm {
            lod: material.relief.lod,
            levels: material.has_levels(),
            nearest: material.is_nearest(),
            wrap: material.wrap,
            space,
        };
        let cones = material.relief.needed_cones();
        let made_of = MadeOf { maps: material.maps.ids(), form, cones, live: live.is_some() };
        let maps = self.maps(material, made_of, live, known)?;
        let side = MaterialSide { number, material, side: Side::Front, maps, made_of, given };
        self.bind(layout, shading, side, tiled)
    }

    /// Makes the back of a material ready, with all maps of its front but the heights. `known`: the back as it was before.
    pub(crate) fn make_back(
        &self,
        layout: &wgpu::BindGroupLayout,
        shading: &Shading,
        (number, material): (usize, &Material),
        tiled: bool,
        (front, known): (&MaterialResources, Option<&MaterialResources>),
    ) -> Result<MaterialResources, GpuError> {
        let heights = match known {
            Some(known) if known.made_of == front.made_of => known.maps.heights.clone(),
            _ => self.heights(material, Side::Back, shading.color_space)?,
        };
        let maps = Maps { heights, ..front.maps.clone() };
        let made_of = front.made_of;
        let side = MaterialSide { number, material, side: Side::Back, maps, made_of, given: false };
        self.bind(layout, shading, side, tiled)
    }

    fn bind(
        &self,
        layout: &wgpu::BindGroupLayout,
        shading: &Shading,
        side: MaterialSide<'_>,
        tiled: bool,
    ) -> Result<MaterialResources, GpuError> {
        let MaterialSide { material, maps, .. } = &side;
        let range = if tiled { Bounds { max: [2.0; 2], ..Bounds::TILE } } else { Bounds::TILE };
        let (wrap, stretched) = material.relief.addressing(material.wrap, range);
        let stretched = stretched.is_some();
        let permutation = self.permutation(material, shading, maps, wrap, stretched)?;
        let surface = surface_layout(&side, stretched);
        let surface = self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("relievo surface"),
            contents: bytemuck::bytes_of(&surface),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        let sampler = self.sampler(wrap, material.filter);
        let heights = maps.heights.as_ref().map_or(&maps.floor, HeightTexture::view);
        let normal = maps.normal.as_ref().or(maps.scatter.as_ref()).unwrap_or(&maps.white);
        let views = [heights, &maps.color, normal, &maps.roughness, &maps.metallic, &maps.ao];
        let pyramid = maps.heights.as_ref().map_or(&maps.no_pyramid, HeightTexture::pyramid);
        let cones = maps.heights.as_ref().map_or(&maps.no_pyramid, |heights| heights.cones(material.relief.cones));
        let mut resources = vec![(0, surface.as_entire_binding())];
        resources.extend((1..).zip(views.map(view)));
        resources.push((7, wgpu::BindingResource::Sampler(&sampler)));
        resources.extend([(8, view(pyramid)), (9, view(cones))]);
        let bindings = bind_group(self.device, "relievo surface", layout, resources);
        let MaterialSide { material, maps, made_of, given, .. } = side;
        Ok(MaterialResources { bindings, permutation, maps, made_of, given, mist: material.is_mist() })
    }

    fn heights(&self, material: &Material, side: Side, space: ColorSpace) -> Result<Option<HeightTexture>, GpuError> {
        let heights = material.side_heights(side, space);
        heights.map(|heights| HeightTexture::new(self.device, self.queue, &heights)).transpose()
    }

    /// Uploads the maps that `known` does not have in the same form.
    fn maps(
        &self,
        material: &Material,
        made_of: MadeOf,
        live: Option<&LiveHeights>,
        known: Option<&MaterialResources>,
    ) -> Result<Maps, GpuError> {
        let (device, queue) = (self.device, self.queue);
        let (maps, space) = (&material.maps, made_of.form.space);
        let in_form = known.filter(|known| known.made_of.form == made_of.form);
        let same =
            |map: usize| in_form.filter(|known| known.made_of.maps[map] == made_of.maps[map]).map(|known| &known.maps);
        let upload = MapUploader { device, queue, levels: made_of.form.levels, material: &material.name };
        let plain = |format, texel: &[u8; 4]| plain(device, queue, format, texel);
        let white = in_form.map_or_else(|| plain(wgpu::TextureFormat::Rgba8Unorm, &[255; 4]), |k| k.maps.white.clone());
        let scalar = |what, map: &Option<_>, known: Option<&wgpu::TextureView>| match (known, map) {
            (Some(known), _) => Ok(known.clone()),
            (None, Some(map)) => upload.scalar(what, map),
            (None, None) => Ok(white.clone()),
        };
        let as_before = (made_of.cones, false);
        let heights = match (known.filter(|known| known.given), live, same(HEIGHT)) {
            (Some(given), ..) => given.maps.heights.clone(),
            (None, Some(live), _) => Some(live.heights().clone()),
            (None, None, Some(before)) if in_form.is_some_and(|k| (k.made_of.cones, k.made_of.live) == as_before) => {
                before.heights.clone()
            }
            _ => self.heights(material, Side::Front, space)?,
        };
        let color = match (same(COLOR), &maps.base_color) {
            (Some(before), _) => before.color.clone(),
            (None, Some(map)) => upload.color(map, space)?,
            (None, None) => white.clone(),
        };
        let normal = match same(NORMAL) {
            Some(before) => before.normal.clone(),
            None => maps.normal.as_ref().map(|map| upload.normal(map, made_of.form.lod)).transpose()?,
        };
        let scatter = match same(NORMAL).and(same(HEIGHT)) {
            Some(before) => before.scatter.clone(),
            None => material.slope_scatter().map(|mips| upload.slope_scatter(&mips)).transpose()?,
        };
        Ok(Maps {
            heights,
            floor: in_form.map_or_else(|| plain(wgpu::TextureFormat::R32Float, &[0; 4]), |k| k.maps.floor.clone()),
            no_pyramid: in_form
                .map_or_else(|| plain(wgpu::TextureFormat::Rgba8Uint, &[0; 4]), |k| k.maps.no_pyramid.clone()),
            color,
            normal,
            scatter,
            roughness: scalar("roughness", &maps.roughness, same(ROUGHNESS).map(|before| &before.roughness))?,
            metallic: scalar("metallic", &maps.metallic, same(METALLIC).map(|before| &before.metallic))?,
            ao: scalar("ao", &maps.ao, same(AO).map(|before| &before.ao))?,
            white,
        })
    }

    fn permutation(
        &self,
        material: &Material,
        shading: &Shading,
        maps: &Maps,
        wrap: Wrap,
        stretched: bool,
    ) -> Result<RenderPermutation, GpuError> {
        let relief = &material.relief;
        let heights = maps.heights.as_ref();
        let flat = relief.technique.shades_flat();
        let technique = relief.technique.marched().filter(|_| heights.is_some()).unwrap_or(Technique::None);
        let marches = technique != Technique::None;
        let displaces = relief.technique == SurfaceTechnique::Displacement && heights.is_some();
        Ok(RenderPermutation {
            march: Permutation {
                technique,
                shadow: if marches { relief.shadow } else { Shadow::None },
                wrap,
                eight_bit: heights.is_some_and(HeightTexture::is_filtered_in_8_bits),
                stretched,
                without_pyramid: false,
                nearest: heights.is_some_and(HeightTexture::is_sampled_nearest),
                in_shells: false,
            },
            model: shading.model.try_into()?,
            normal: match (&material.maps.normal, heights) {
                _ if flat => NormalSource::Mesh,
                (Some(_), _) => NormalSource::Map,
                (None, Some(_)) => NormalSource::HeightField,
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
            environment: self.environment,
            smooths_edges: self.options.msaa > 1,
            one_sided: marches || (displaces && !material.is_two_sided()),
            displaced: displaces,
            lod: relief.lod,
            geometry: DrawnGeometry::Polygons,
            dimmed: self.mist && relief.shadow == Shadow::Exact && !material.is_mist(),
        })
    }

    fn sampler(&self, wrap: Wrap, filter: Filter) -> wgpu::Sampler {
        let mode = match wrap {
            Wrap::Repeat => wgpu::AddressMode::Repeat,
            Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
            Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
        };
        let between_texels =
            if filter == Filter::Nearest { wgpu::FilterMode::Nearest } else { wgpu::FilterMode::Linear };
        self.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("relievo maps"),
            address_mode_u: mode,
            address_mode_v: mode,
            mag_filter: between_texels,
            min_filter: between_texels,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            anisotropy_clamp: if filter == Filter::Trilinear { self.options.anisotropy.clamp(1, 16) } else { 1 },
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
    let descriptor = texture_descriptor("relievo plain", [1; 2], format, wgpu::TextureUsages::TEXTURE_BINDING);
    let texture = device.create_texture_with_data(queue, &descriptor, wgpu::util::TextureDataOrder::LayerMajor, texel);
    whole_view(&texture)
}

fn surface_layout(surface: &MaterialSide<'_>, stretched: bool) -> SurfaceLayout {
    let MaterialSide { number, material, side, maps, .. } = surface;
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
        options: MarchUniforms::from(&relief.march(side.midlevel(material.midlevel), Bounds::TILE)).to_bytes(),
        base_color: material.base_color,
        roughness: material.roughness,
        metallic: material.metallic,
        depth,
        depth_is_absolute: absolute.into(),
        last_level: heights.map_or(0, |heights| heights.last_level() as i32),
        height_step: heights.map_or(0.0, HeightTexture::quantization_step),
        stretched: stretched.into(),
        levels: material.has_levels().into(),
        number: *number as u32,
        normal_sign: side.normal_sign(),
        pad: [0; 3],
        ranges,
    }
}
