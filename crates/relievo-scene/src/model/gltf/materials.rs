//! A glTF file's own materials.

use std::borrow::Cow;
use std::path::PathBuf;

use glam::Vec3;
use gltf::json::Value;
use gltf::json::material::AlphaMode;
use gltf::json::texture::WrappingMode;
use gltf::json::validation::Checked;
use relievo_map::{
    Channel, Limits, Loaded, MapError, MapSet, NormalMap, NormalY, ScalarMap, Wrap, decode_color, decode_normal,
    decode_scalar, read_color, read_normal, read_scalar,
};
use relievo_march::Technique;

use super::buffers::{Uri, resolve};
use super::document::GltfDocument;
use super::texture_transform;
use crate::model::part::ModelError;
use crate::{Material, Relief, SurfaceTechnique, UvTransform};

/// Returns the JSON of KHR_texture_transform, if the texture has one: each kind of texture reference is a type of its own.
macro_rules! transform_of {
    ($info:expr) => {
        $info.extensions.as_ref().and_then(|extensions| extensions.others.get(texture_transform::NAME))
    };
}

/// Location of the bytes of an image.
enum ImageSource<'a> {
    Memory(String, Cow<'a, [u8]>),
    File(PathBuf),
}

/// Reads a material of the file with its images.
pub(super) fn read(
    file: &GltfDocument<'_>,
    index: usize,
    limits: &Limits,
    notes: &mut Vec<String>,
) -> Result<Material, ModelError> {
    let json = file.get(&file.root.materials, index, "material")?;
    let name = json.name.clone().unwrap_or_else(|| format!("material {index}"));
    let label = format!("{}: material \"{name}\"", file.path.display());
    let mut material = Material {
        name: format!("{}:{name}", file.path.file_name().unwrap_or_default().to_string_lossy()),
        relief: Relief { technique: SurfaceTechnique::Marched(Technique::Normal), ..Relief::default() },
        ..Material::default()
    };
    let pbr = &json.pbr_metallic_roughness;
    let [r, g, b, _] = pbr.base_color_factor.0;
    material.base_color = [unit(r), unit(g), unit(b)];
    material.roughness = unit(pbr.roughness_factor.0);
    material.metallic = unit(pbr.metallic_factor.0);

    let mut textures = Textures { file, limits, notes, wraps: Vec::new(), transforms: Vec::new(), other_uvs: false };
    textures.read_maps(json, &mut material.maps)?;
    let Textures { wraps, transforms, other_uvs, notes, .. } = textures;
    if let Some((first, transform)) = transforms.first() {
        material.uv = *transform;
        let others: Vec<&str> = transforms.iter().filter(|other| other.1 != *transform).map(|other| other.0).collect();
        if !others.is_empty() {
            let others = others.join(", ");
            notes.push(format!(
                "{label}: not all its textures are moved alike (KHR_texture_transform); {others}: drawn as {first}"
            ));
        }
    }
    material.two_sided = json.double_sided.then_some(true);
    if let Some(&first) = wraps.first() {
        material.wrap = first;
        if wraps.iter().any(|&wrap| wrap != first) {
            notes.push(format!("{label}: its textures wrap in different ways; all are drawn as the first"));
        }
    }
    if other_uvs {
        notes.push(format!("{label}: it uses a second set of texture coordinates; the first is drawn"));
    }
    if json.emissive_texture.is_some() || json.emissive_factor.0.iter().any(|&x| x > 0.0) {
        notes.push(format!("{label}: its own light (emissive) is left out"));
    }
    if !matches!(json.alpha_mode, Checked::Valid(AlphaMode::Opaque)) {
        notes.push(format!("{label}: its transparency is left out"));
    }
    Ok(material)
}

/// Clamps a factor to 0..1.
fn unit(x: f32) -> f32 {
    if x.is_finite() { x.clamp(0.0, 1.0) } else { 1.0 }
}

/// The textures of a material, being read.
struct Textures<'a> {
    file: &'a GltfDocument<'a>,
    limits: &'a Limits,
    notes: &'a mut Vec<String>,
    /// Addressing modes of the textures along both axes.
    wraps: Vec<Wrap>,
    /// Transforms of the textures' coordinates, by the textures' names.
    transforms: Vec<(&'static str, UvTransform)>,
    /// True if a texture uses another set of texture coordinates than the first.
    other_uvs: bool,
}

impl<'a> Textures<'a> {
    fn read_maps(&mut self, json: &gltf::json::Material, maps: &mut MapSet) -> Result<(), ModelError> {
        let pbr = &json.pbr_metallic_roughness;
        let limits = self.limits;
        if let Some(info) = &pbr.base_color_texture {
            let map = match &self.source("base colour", info.index.value(), info.tex_coord, transform_of!(info))? {
                ImageSource::Memory(name, bytes) => decode_color(name, bytes, limits),
                ImageSource::File(path) => read_color(path, limits),
            };
            maps.base_color = Some(self.keep(map)?);
        }
        if let Some(info) = &pbr.metallic_roughness_texture {
            let source =
                self.source("metallic and roughness", info.index.value(), info.tex_coord, transform_of!(info))?;
            maps.roughness = Some(self.scalar(&source, Channel::Green)?);
            maps.metallic = Some(self.scalar(&source, Channel::Blue)?);
        }
        if let Some(info) = &json.occlusion_texture {
            let source = self.source("occlusion", info.index.value(), info.tex_coord, transform_of!(info))?;
            let ao = self.scalar(&source, Channel::Red)?;
            let strength = unit(info.strength.0);
            maps.ao =
                Some(if strength < 1.0 { ScalarMap::new(ao.grid().map(|x| 1.0 + strength * (x - 1.0))) } else { ao });
        }
        if let Some(info) = &json.normal_texture {
            let map = match &self.source("normal", info.index.value(), info.tex_coord, transform_of!(info))? {
                ImageSource::Memory(name, bytes) => decode_normal(name, bytes, NormalY::Up, limits),
                ImageSource::File(path) => read_normal(path, NormalY::Up, limits),
            };
            let normal = self.keep(map)?;
            maps.normal =
                Some(if info.scale.is_finite() && info.scale != 1.0 { scaled(&normal, info.scale) } else { normal });
        }
        Ok(())
    }

    /// Returns the image of a texture, and remembers how the texture is addressed.
    fn source(
        &mut self,
        name: &'static str,
        index: usize,
        tex_coord: u32,
        moved: Option<&Value>,
    ) -> Result<ImageSource<'a>, ModelError> {
        let file = self.file;
        let read = moved.map_or(Some((UvTransform::default(), None)), texture_transform::read);
        if read.is_none() {
            let (path, extension) = (file.path.display(), texture_transform::NAME);
            self.notes.push(format!(
                "{path}: the {name} texture is drawn unmoved: its {extension} is not finite, or scales to 0"
            ));
        }
        let (transform, other_tex_coord) = read.unwrap_or_default();
        self.transforms.push((name, transform));
        self.other_uvs |= other_tex_coord.unwrap_or(tex_coord.into()) != 0;
        let texture = file.get(&file.root.textures, index, "texture")?;
        if let Some(sampler) = texture.sampler {
            let sampler = file.get(&file.root.samplers, sampler.value(), "sampler")?;
            self.wraps.extend([&sampler.wrap_s, &sampler.wrap_t].map(wrap));
        }
        if texture.source.value() == u32::MAX as usize {
            let message = format!("texture {index} has no PNG or JPEG image; export it without compressed textures");
            return Err(file.error(message));
        }
        image(file, texture.source.value())
    }

    fn scalar(&mut self, source: &ImageSource<'_>, channel: Channel) -> Result<ScalarMap, ModelError> {
        let map = match source {
            ImageSource::Memory(name, bytes) => decode_scalar(name, bytes, channel, self.limits),
            ImageSource::File(path) => read_scalar(path, channel, self.limits),
        };
        self.keep(map)
    }

    /// Keeps the notes of a map that was read.
    fn keep<T>(&mut self, map: Result<Loaded<T>, MapError>) -> Result<T, ModelError> {
        let Loaded { map, notes } = map.map_err(|error| ModelError::new(self.file.path, error.to_string()))?;
        self.notes.extend(notes);
        Ok(map)
    }
}

fn wrap(mode: &Checked<WrappingMode>) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        _ => Wrap::Repeat,
    }
}

fn image<'a>(file: &'a GltfDocument<'_>, index: usize) -> Result<ImageSource<'a>, ModelError> {
    let image = file.get(&file.root.images, index, "image")?;
    let name = format!("{}, image {index}", file.path.display());
    match (&image.buffer_view, &image.uri) {
        (Some(view), _) => Ok(ImageSource::Memory(name, file.view(view.value())?.into())),
        (None, Some(uri)) => Ok(match resolve(uri, file.path)? {
            Uri::Bytes(bytes) => ImageSource::Memory(name, bytes.into()),
            Uri::File(path) => ImageSource::File(path),
        }),
        (None, None) => Err(file.error(format!("image {index} is nowhere"))),
    }
}

/// Normals with x and y scaled, as `normalTexture.scale` asks.
fn scaled(normal: &NormalMap, scale: f32) -> NormalMap {
    NormalMap::new(normal.grid().map(|&[x, y, z]| Vec3::new(x * scale, y * scale, z).normalize_or(Vec3::Z).to_array()))
}
