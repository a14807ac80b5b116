//! A glTF file's own materials.

use std::borrow::Cow;
use std::path::PathBuf;

use glam::Vec3;
use gltf::json::material::AlphaMode;
use gltf::json::texture::WrappingMode;
use gltf::json::validation::Checked;
use relievo_map::{
    Channel, Limits, Loaded, MapError, NormalMap, NormalY, ScalarMap, Wrap, decode_color, decode_normal, decode_scalar,
    read_color, read_normal, read_scalar,
};
use relievo_march::Technique;

use super::GltfFile;
use super::buffers::{Uri, resolve};
use crate::model::ModelError;
use crate::{Material, Relief, SurfaceTechnique};

/// Where an image's bytes are.
enum ImageSource<'a> {
    Memory(String, Cow<'a, [u8]>),
    File(PathBuf),
}

pub(super) fn read(
    file: &GltfFile<'_>,
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
    let unit = |x: f32| if x.is_finite() { x.clamp(0.0, 1.0) } else { 1.0 };
    let [r, g, b, _] = pbr.base_color_factor.0;
    material.base_color = [unit(r), unit(g), unit(b)];
    material.roughness = unit(pbr.roughness_factor.0);
    material.metallic = unit(pbr.metallic_factor.0);

    let mut wraps = Vec::new();
    let mut other_uvs = false;
    let mut texture = |index: usize, tex_coord: u32| {
        other_uvs |= tex_coord != 0;
        let texture = file.get(&file.root.textures, index, "texture")?;
        if let Some(sampler) = texture.sampler {
            let sampler = file.get(&file.root.samplers, sampler.value(), "sampler")?;
            wraps.extend([&sampler.wrap_s, &sampler.wrap_t].map(wrap));
        }
        if texture.source.value() == u32::MAX as usize {
            let message = format!("texture {index} has no PNG or JPEG image; export it without compressed textures");
            return Err(file.error(message));
        }
        image(file, texture.source.value())
    };
    if let Some(info) = &pbr.base_color_texture {
        let source = texture(info.index.value(), info.tex_coord)?;
        let map = match &source {
            ImageSource::Memory(name, bytes) => decode_color(name, bytes, limits),
            ImageSource::File(path) => read_color(path, limits),
        };
        material.maps.base_color = Some(keep(file, map, notes)?);
    }
    if let Some(info) = &pbr.metallic_roughness_texture {
        let source = texture(info.index.value(), info.tex_coord)?;
        material.maps.roughness = Some(scalar(file, &source, Channel::Green, limits, notes)?);
        material.maps.metallic = Some(scalar(file, &source, Channel::Blue, limits, notes)?);
    }
    if let Some(info) = &json.occlusion_texture {
        let source = texture(info.index.value(), info.tex_coord)?;
        let ao = scalar(file, &source, Channel::Red, limits, notes)?;
        let strength = unit(info.strength.0);
        material.maps.ao =
            Some(if strength < 1.0 { ScalarMap::new(ao.grid().map(|x| 1.0 + strength * (x - 1.0))) } else { ao });
    }
    if let Some(info) = &json.normal_texture {
        let source = texture(info.index.value(), info.tex_coord)?;
        let map = match &source {
            ImageSource::Memory(name, bytes) => decode_normal(name, bytes, NormalY::Up, limits),
            ImageSource::File(path) => read_normal(path, NormalY::Up, limits),
        };
        let normal = keep(file, map, notes)?;
        material.maps.normal =
            Some(if info.scale.is_finite() && info.scale != 1.0 { scaled(&normal, info.scale) } else { normal });
    }
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

fn wrap(mode: &Checked<WrappingMode>) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        _ => Wrap::Repeat,
    }
}

fn image<'a>(file: &'a GltfFile<'_>, index: usize) -> Result<ImageSource<'a>, ModelError> {
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

fn scalar(
    file: &GltfFile<'_>,
    source: &ImageSource<'_>,
    channel: Channel,
    limits: &Limits,
    notes: &mut Vec<String>,
) -> Result<ScalarMap, ModelError> {
    let map = match source {
        ImageSource::Memory(name, bytes) => decode_scalar(name, bytes, channel, limits),
        ImageSource::File(path) => read_scalar(path, channel, limits),
    };
    keep(file, map, notes)
}

fn keep<T>(file: &GltfFile<'_>, map: Result<Loaded<T>, MapError>, notes: &mut Vec<String>) -> Result<T, ModelError> {
    let Loaded { map, notes: found } = map.map_err(|error| ModelError::new(file.path, error.to_string()))?;
    notes.extend(found);
    Ok(map)
}

/// Normals with x and y scaled, as `normalTexture.scale` asks.
fn scaled(normal: &NormalMap, scale: f32) -> NormalMap {
    NormalMap::new(normal.grid().map(|&[x, y, z]| Vec3::new(x * scale, y * scale, z).normalize_or(Vec3::Z).to_array()))
}
