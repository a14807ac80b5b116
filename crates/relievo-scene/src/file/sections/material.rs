//! `[materials.NAME]`.

use std::path::{Path, PathBuf};

use relievo_map::{NormalY, White, Wrap};
use relievo_march::Shadow;
use relievo_toml::{Location, did_you_mean};

use super::mist;
use super::relief::relief;
use super::uv;
use crate::file::error::SceneError;
use crate::file::keys;
use crate::file::map_request::{MapRequest, MapSource};
use crate::file::source::Source;
use crate::file::table::Table;
use crate::{Edge, Filter, HeightRange, Material};

/// A material whose maps are still to be read.
pub(in crate::file) struct PendingMaterial {
    /// Everything but the maps. Factors are final only once it is known which maps there are.
    pub(in crate::file) material: Material,
    pub(in crate::file) maps: Vec<MapRequest>,
    /// `metallic` as a number.
    metallic: Option<f32>,
    /// True if the file asks for a technique that needs heights.
    needs_heights: bool,
    /// Location of the key `kind`.
    kind: Location,
}

impl PendingMaterial {
    /// Completes the material once its maps are read.
    pub(in crate::file) fn finish(self, source: &Source, notes: &mut Vec<String>) -> Result<Material, SceneError> {
        let Self { mut material, metallic, needs_heights, kind, .. } = self;
        // A map speaks for itself; without one nothing is metal unless the file says so.
        let default = if material.maps.metallic.is_some() { 1.0 } else { 0.0 };
        material.metallic = metallic.unwrap_or(default);
        if needs_heights && material.maps.height.is_none() {
            let (name, technique) = (&material.name, material.relief.technique.name());
            notes.push(format!("material \"{name}\" has no height map for \"{technique}\": it is flat"));
        }
        if material.uv_rect.is_some() && material.relief.edge == Edge::Wrap {
            let name = &material.name;
            notes.push(format!("material \"{name}\": its relief goes on beyond uv_rect, as edge = \"wrap\" does"));
        }
        if let Err(error) = material.check_mist() {
            let message = format!("material \"{}\" is mist, but {error}", material.name);
            return Err(source.error(kind, message));
        }
        Ok(material)
    }
}

/// Reads all materials, in the order of the file.
pub(in crate::file) fn materials(root: &Table<'_>, base_dir: &Path) -> Result<Vec<PendingMaterial>, SceneError> {
    root.named_tables("materials", keys::MATERIAL)?
        .into_iter()
        .map(|(name, table)| material(name, &table, base_dir))
        .collect()
}

fn material(name: &str, table: &Table<'_>, base_dir: &Path) -> Result<PendingMaterial, SceneError> {
    let mut material = Material { name: name.to_owned(), ..Material::default() };
    let mut maps = MapKeys { table, base_dir, requests: Vec::new() };
    let normal_y = table.one_of("normal_y", &[("up", NormalY::Up), ("down", NormalY::Down)])?;
    let white = table.one_of("white", &[("high", White::High), ("deep", White::Deep)])?;
    let made = maps.read_from(normal_y, white)?;
    material.base_color = maps.base_color()?.unwrap_or(material.base_color);
    match maps.file("normal")? {
        Some(path) => maps.request("normal", MapSource::Normal(path, normal_y.unwrap_or(NormalY::Up))),
        None => only_with(table, "normal_y", "normal")?,
    }
    match maps.file("height")? {
        Some(path) => maps.request("height", MapSource::Height(path, white.unwrap_or(White::High))),
        None => only_with(table, "white", "height")?,
    }
    material.roughness = maps.file_or_factor("roughness", MapSource::Roughness)?.unwrap_or(material.roughness);
    let metallic = maps.file_or_factor("metallic", MapSource::Metallic)?;
    if let Some(path) = maps.file("ao")? {
        maps.request("ao", MapSource::Ao(path));
    }

    material.height = height_range(table, made)?;
    material.midlevel = table.number("midlevel", "a number from 0 to 1", is_unit)?.unwrap_or(material.midlevel);
    let filters = [("linear", Filter::Linear), ("trilinear", Filter::Trilinear), ("nearest", Filter::Nearest)];
    material.filter = table.one_of("filter", &filters)?.unwrap_or_default();
    let wraps = [("repeat", Wrap::Repeat), ("clamp", Wrap::Clamp), ("mirror", Wrap::Mirror)];
    material.wrap = table.one_of("wrap", &wraps)?.unwrap_or_default();
    (material.uv, material.uv_rect) = (uv::transform(table)?, uv::rect(table)?);
    material.two_sided = table.boolean("two_sided")?;
    let label = format!("{}.relief]", table.label().trim_end_matches(']'));
    let mut needs_heights = false;
    material.mist = mist::mist(table)?;
    let settings = table.table("relief", keys::RELIEF, &label)?;
    if let Some(settings) = &settings {
        material.relief = relief(settings)?;
        needs_heights = settings.get("technique").is_some() && material.relief.technique.needs_heights();
        mist::check(table, settings, &material)?;
    }
    // Mist without its own shadow has no shape: it shadows itself unless it is told not to.
    if material.is_mist() && settings.is_none_or(|settings| settings.get("shadow").is_none()) {
        material.relief.shadow = Shadow::Exact;
    }
    Ok(PendingMaterial { material, maps: maps.requests, metallic, needs_heights, kind: table.at("kind") })
}

fn is_unit(x: f32) -> bool {
    (0.0..=1.0).contains(&x)
}

/// The keys of a material that name maps, and the maps they ask for.
struct MapKeys<'a> {
    table: &'a Table<'a>,
    base_dir: &'a Path,
    requests: Vec<MapRequest>,
}

impl<'a> MapKeys<'a> {
    fn request(&mut self, key: &str, source: MapSource) {
        let what = format!("{key} in {}", self.table.label());
        self.requests.push(MapRequest { at: self.table.at(key), what, source });
    }

    fn file(&self, key: &str) -> Result<Option<PathBuf>, SceneError> {
        Ok(self.table.text(key, "the name of an image file")?.map(|file| self.base_dir.join(file)))
    }

    /// Reads `from`; returns the name of a generated material.
    fn read_from(&mut self, normal_y: Option<NormalY>, white: Option<White>) -> Result<Option<&'a str>, SceneError> {
        let table = self.table;
        let Some(from) = table.text("from", "a folder of maps, or \"make:\" and a name")? else { return Ok(None) };
        let Some(name) = from.strip_prefix("make:") else {
            self.request("from", MapSource::Folder(self.base_dir.join(from), normal_y, white));
            return Ok(None);
        };
        let names = relievo_make::names();
        if !names.contains(&name) {
            let message = format!(
                "from = \"make:{name}\" is not known; expected make: and one of {}{}",
                names.join(", "),
                did_you_mean(name, names.iter().copied())
            );
            return Err(table.error("from", message));
        }
        self.request("from", MapSource::Make(name.to_owned()));
        Ok(Some(name))
    }

    /// Reads `base_color`: a file, or the factor that is returned.
    fn base_color(&mut self) -> Result<Option<[f32; 3]>, SceneError> {
        if !is_text(self.table, "base_color") {
            return self.table.numbers("base_color", "an image file or 3 numbers from 0 to 1", is_unit);
        }
        if let Some(path) = self.file("base_color")? {
            self.request("base_color", MapSource::BaseColor(path));
        }
        Ok(None)
    }

    /// Reads a key that takes a file, or the factor that is returned.
    fn file_or_factor(&mut self, key: &str, source: fn(PathBuf) -> MapSource) -> Result<Option<f32>, SceneError> {
        if !is_text(self.table, key) {
            return self.table.number(key, "an image file or a number from 0 to 1", is_unit);
        }
        if let Some(path) = self.file(key)? {
            self.request(key, source(path));
        }
        Ok(None)
    }
}

fn is_text(table: &Table<'_>, key: &str) -> bool {
    table.get(key).is_some_and(|node| matches!(node.value, relievo_toml::Value::String(_)))
}

/// Refuses `key` without the file that it describes: it describes the file under `file`, or that of a folder, and would
/// silently do nothing without it.
fn only_with(table: &Table<'_>, key: &str, file: &str) -> Result<(), SceneError> {
    let from_folder = matches!(table.text("from", ""), Ok(Some(from)) if !from.starts_with("make:"));
    if table.get(key).is_none() || from_folder {
        return Ok(());
    }
    let message = format!(
        "{key} in {} says how the file under \"{file}\" is to be read, but there is none; name it, or leave {key} out",
        table.label()
    );
    Err(table.error(key, message))
}

fn height_range(table: &Table<'_>, made: Option<&str>) -> Result<HeightRange, SceneError> {
    let positive = |x: f32| x >= 0.0;
    let scale = table.number("height_scale", "a number, 0 or more (fraction of a texture repeat)", positive)?;
    let depth = table.number("depth", "a number, 0 or more (object units)", positive)?;
    match (scale, depth) {
        (Some(_), Some(_)) => Err(table.error(
            "depth",
            format!("{} has both height_scale and depth; they mean the same distance, keep one", table.label()),
        )),
        (Some(scale), None) => Ok(HeightRange::Scale(scale)),
        (None, Some(depth)) => Ok(HeightRange::Depth(depth)),
        (None, None) => {
            let recommended = made.and_then(|name| relievo_make::height_scale(name).ok());
            Ok(recommended.map_or_else(HeightRange::default, HeightRange::Scale))
        }
    }
}
