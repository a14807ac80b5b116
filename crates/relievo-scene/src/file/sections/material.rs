//! `[materials.NAME]`.

use std::path::{Path, PathBuf};

use relievo_make::{LayerBlend, Recipe};
use relievo_map::{NormalY, White, Wrap};
use relievo_march::Shadow;
use relievo_toml::{Location, did_you_mean, shorten};

use super::clock::Moment;
use super::layer::{self, PendingLayer, note_on_loop, velocity};
use super::mist;
use super::relief::relief;
use super::uv;
use crate::file::error::SceneError;
use crate::file::keys;
use crate::file::map_request::{MapRequest, MapSource};
use crate::file::source::Source;
use crate::file::table::Table;
use crate::{Edge, Filter, HeightRange, Material, SceneTime};

/// A material whose maps are still to be read.
pub(in crate::file) struct PendingMaterial {
    /// Everything but the maps. Factors are final only once it is known which maps there are.
    pub(in crate::file) material: Material,
    pub(in crate::file) maps: Vec<MapRequest>,
    /// Layers of the heights, and their blending.
    pub(in crate::file) layers: Vec<PendingLayer>,
    pub(in crate::file) blend: LayerBlend,
    /// Texels per side of heights that are made.
    pub(in crate::file) height_size: Option<u32>,
    /// Length of the loop of a recipe, seconds.
    pub(in crate::file) period: Option<f32>,
    /// Location of the height map.
    pub(in crate::file) height_at: Location,
    /// True if its maps or their coordinates move.
    pub(in crate::file) moves: bool,
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

/// The surroundings of the materials' tables.
#[derive(Clone, Copy)]
pub(in crate::file) struct MaterialContext<'a> {
    pub(in crate::file) base_dir: &'a Path,
    pub(in crate::file) moment: Moment,
    /// Texels per side of generated maps.
    pub(in crate::file) make_size: u32,
}

/// Reads all materials as they are at a moment, in the order of the file.
pub(in crate::file) fn materials(
    root: &Table<'_>,
    context: MaterialContext<'_>,
    notes: &mut Vec<String>,
) -> Result<Vec<PendingMaterial>, SceneError> {
    root.named_tables("materials", keys::MATERIAL)?
        .into_iter()
        .map(|(name, table)| material(name, &table, context, notes))
        .collect()
}

/// Refuses settings of heights that are made where none are.
fn refuse_idle_keys(table: &Table<'_>, idle_size: bool, idle_period: bool) -> Result<(), SceneError> {
    let label = table.label();
    if idle_size {
        let message =
            format!("height_size is the size of heights that are made, but {label} has no recipe and no layers");
        return Err(table.error("height_size", message));
    }
    if idle_period {
        let message = format!("height_period is the length of a recipe's loop, but {label} has no recipe that changes");
        return Err(table.error("height_period", message));
    }
    Ok(())
}

fn material(
    name: &str,
    table: &Table<'_>,
    context: MaterialContext<'_>,
    notes: &mut Vec<String>,
) -> Result<PendingMaterial, SceneError> {
    let MaterialContext { base_dir, moment, make_size } = context;
    let mut material = Material { name: name.to_owned(), ..Material::default() };
    let period = table.number("height_period", "a number of seconds, 0.001 to 1e6", |x| (0.001..=1e6).contains(&x))?;
    let height_size = table.integer("height_size", 1, relievo_make::MAX_SIZE)?;
    let size = height_size.unwrap_or(make_size);
    let mut maps = MapKeys { table, base_dir, moment, period, requests: Vec::new() };
    let normal_y = table.one_of("normal_y", &[("up", NormalY::Up), ("down", NormalY::Down)])?;
    let white = table.one_of("white", &[("high", White::High), ("deep", White::Deep)])?;
    let made = maps.read_from(normal_y, white)?;
    material.base_color = maps.base_color()?.unwrap_or(material.base_color);
    match maps.file("normal")? {
        Some(path) => maps.request("normal", MapSource::Normal(path, normal_y.unwrap_or(NormalY::Up))),
        None => only_with(table, "normal_y", "normal")?,
    }
    let is_recipe = maps.height(white, size)?;
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
    let uv_velocity = velocity(table, "uv_velocity")?;
    material.uv.offset += uv::moved(uv_velocity, moment.time, material.wrap);
    note_on_loop(&format!("material \"{name}\""), uv_velocity, moment, notes);
    let (layers, blend) = layer::layers(table, base_dir, &mut maps.requests)?;
    for layer in &layers {
        note_on_loop(&format!("a layer of material \"{name}\""), layer.velocity, moment, notes);
    }
    let made_moves = maps.requests.iter().any(|request| is_animated(&request.source));
    refuse_idle_keys(
        table,
        height_size.is_some() && layers.is_empty() && !is_recipe,
        period.is_some() && !is_recipe && !made_moves,
    )?;
    let moves =
        made_moves || is_recipe || uv_velocity != [0.0; 2] || layers.iter().any(|layer| layer.velocity != [0.0; 2]);
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
    let height_at = if table.get("height").is_some() { table.at("height") } else { table.at("from") };
    let maps = maps.requests;
    Ok(PendingMaterial {
        material,
        maps,
        layers,
        blend,
        height_size,
        period,
        height_at,
        moves,
        metallic,
        needs_heights,
        kind: table.at("kind"),
    })
}

fn is_unit(x: f32) -> bool {
    (0.0..=1.0).contains(&x)
}

/// The keys of a material that name maps, and the maps they ask for.
struct MapKeys<'a> {
    table: &'a Table<'a>,
    base_dir: &'a Path,
    moment: Moment,
    /// `height_period`.
    period: Option<f32>,
    requests: Vec<MapRequest>,
}

impl<'a> MapKeys<'a> {
    fn request(&mut self, key: &str, source: MapSource) {
        let what = format!("{key} in {}", self.table.label());
        self.requests.push(MapRequest { at: self.table.at(key), what, source, layer: None });
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
            return Err(self.unknown("from", name, names));
        }
        let phase = relievo_make::built_in(name).ok().filter(Recipe::is_animated).map_or(0.0, |recipe| {
            let own = SceneTime::from_seconds(f64::from(self.period.unwrap_or_else(|| recipe.period())));
            let length = self.period.map_or(self.moment.length, |_| None).or(own).unwrap_or_default();
            self.moment.time.phase(length)
        });
        self.request("from", MapSource::Make(name.to_owned(), phase.to_bits()));
        Ok(Some(name))
    }

    fn unknown(&self, key: &str, name: &str, known: &[&str]) -> SceneError {
        let message = format!(
            "{key} = \"make:{}\" is not known; expected make: and one of {}{}",
            shorten(name),
            known.join(", "),
            did_you_mean(name, known.iter().copied())
        );
        self.table.error(key, message)
    }

    /// Reads `height`; true if it is a recipe, which makes `size` texels per side.
    fn height(&mut self, white: Option<White>, size: u32) -> Result<bool, SceneError> {
        let text =
            self.table.text("height", "the name of an image file, a recipe file (.toml), or \"make:\" and a name")?;
        let made = text.and_then(|text| text.strip_prefix("make:"));
        let source = match (text, made) {
            (_, Some(name)) => {
                let known: Vec<&str> = relievo_make::names()
                    .iter()
                    .copied()
                    .filter(|name| relievo_make::recipe_text(name).is_some())
                    .collect();
                if !known.contains(&name) {
                    return Err(self.unknown("height", name, &known));
                }
                MapSource::MadeHeight(name.to_owned(), size)
            }
            (Some(file), None) if file.to_lowercase().ends_with(".toml") => {
                MapSource::HeightRecipe(self.base_dir.join(file), size)
            }
            (Some(file), None) => MapSource::Height(self.base_dir.join(file), white.unwrap_or(White::High)),
            (None, None) => {
                only_with(self.table, "white", "height")?;
                return Ok(false);
            }
        };
        let is_recipe = !matches!(source, MapSource::Height(..));
        if is_recipe && white.is_some() {
            let from_folder = matches!(self.table.text("from", ""), Ok(Some(from)) if !from.starts_with("make:"));
            if !from_folder {
                return Err(self.table.error(
                    "white",
                    "white says how an image file is to be read, but height is a recipe; leave it out",
                ));
            }
        }
        self.request("height", source);
        Ok(is_recipe)
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

/// True for a generated material that changes in the course of time.
fn is_animated(source: &MapSource) -> bool {
    matches!(source, MapSource::Make(name, _) if relievo_make::built_in(name).is_ok_and(|recipe| recipe.is_animated()))
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
