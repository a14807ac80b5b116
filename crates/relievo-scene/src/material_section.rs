//! `[materials.NAME]` and `[materials.NAME.relief]`.

use std::path::Path;

use relievo_map::{NormalY, White, Wrap};
use relievo_march::{Cones, Shadow};

use crate::error::SceneError;
use crate::keys;
use crate::maps::{Job, Request};
use crate::reader::Table;
use crate::{Edge, Filter, HeightRange, Material, Relief, SurfaceTechnique};
use relievo_toml::did_you_mean;

/// A material whose maps are still to be read.
pub(crate) struct Plan {
    /// Everything but the maps. Factors are final only once it is known which maps there are.
    pub(crate) material: Material,
    pub(crate) jobs: Vec<Job>,
    /// `metallic` as a number.
    pub(crate) metallic: Option<f32>,
    /// The file asks for a technique that needs heights.
    pub(crate) marches: bool,
}

/// All materials, in the order of the file.
pub(crate) fn materials(root: &Table<'_>, base_dir: &Path) -> Result<Vec<Plan>, SceneError> {
    root.named_tables("materials", keys::MATERIAL)?
        .into_iter()
        .map(|(name, table)| material(name, &table, base_dir))
        .collect()
}

fn material(name: &str, table: &Table<'_>, base_dir: &Path) -> Result<Plan, SceneError> {
    let mut material = Material { name: name.to_owned(), ..Material::default() };
    let mut jobs = Vec::new();
    let mut job = |key: &str, request: Request| {
        let what = format!("{key} in {}", table.label());
        jobs.push(Job { at: table.at(key), what, request });
    };
    let file = |key: &str| Ok(table.text(key, "the name of an image file")?.map(|file| base_dir.join(file)));

    let normal_y = |name: &str| match name {
        "up" => Some(NormalY::Up),
        "down" => Some(NormalY::Down),
        _ => None,
    };
    let normal_y = table.choice("normal_y", &["up", "down"], normal_y)?;
    let white = |name: &str| match name {
        "high" => Some(White::High),
        "deep" => Some(White::Deep),
        _ => None,
    };
    let white = table.choice("white", &["high", "deep"], white)?;
    let mut made = None;
    if let Some(from) = table.text("from", "a folder of maps, or \"make:\" and a name")? {
        match from.strip_prefix("make:") {
            Some(name) => {
                let names = relievo_make::names();
                if !names.contains(&name) {
                    let message = format!(
                        "from = \"make:{name}\" is not known; expected make: and one of {}{}",
                        names.join(", "),
                        did_you_mean(name, names.iter().copied())
                    );
                    return Err(table.error("from", message));
                }
                made = Some(name);
                job("from", Request::Make(name.to_owned()));
            }
            None => job("from", Request::Folder(base_dir.join(from), normal_y, white)),
        }
    }

    let unit = |x: f32| (0.0..=1.0).contains(&x);
    if is_text(table, "base_color") {
        if let Some(path) = file("base_color")? {
            job("base_color", Request::BaseColor(path));
        }
    } else {
        let color = table.numbers("base_color", "an image file or 3 numbers from 0 to 1", unit)?;
        material.base_color = color.unwrap_or(material.base_color);
    }
    match file("normal")? {
        Some(path) => job("normal", Request::Normal(path, normal_y.unwrap_or(NormalY::Up))),
        None => only_with(table, "normal_y", "normal")?,
    }
    match file("height")? {
        Some(path) => job("height", Request::Height(path, white.unwrap_or(White::High))),
        None => only_with(table, "white", "height")?,
    }
    if is_text(table, "roughness") {
        if let Some(path) = file("roughness")? {
            job("roughness", Request::Roughness(path));
        }
    } else {
        let number = table.number("roughness", "an image file or a number from 0 to 1", unit)?;
        material.roughness = number.unwrap_or(material.roughness);
    }
    let mut metallic = None;
    if is_text(table, "metallic") {
        if let Some(path) = file("metallic")? {
            job("metallic", Request::Metallic(path));
        }
    } else {
        metallic = table.number("metallic", "an image file or a number from 0 to 1", unit)?;
    }
    if let Some(path) = file("ao")? {
        job("ao", Request::Ao(path));
    }

    material.height = height_range(table, made)?;
    material.midlevel = table.number("midlevel", "a number from 0 to 1", unit)?.unwrap_or(material.midlevel);
    let filter = |name: &str| match name {
        "linear" => Some(Filter::Linear),
        "trilinear" => Some(Filter::Trilinear),
        _ => None,
    };
    material.filter = table.choice("filter", &["linear", "trilinear"], filter)?.unwrap_or_default();
    let wrap = |name: &str| match name {
        "repeat" => Some(Wrap::Repeat),
        "clamp" => Some(Wrap::Clamp),
        "mirror" => Some(Wrap::Mirror),
        _ => None,
    };
    material.wrap = table.choice("wrap", &["repeat", "clamp", "mirror"], wrap)?.unwrap_or_default();
    let label = format!("{}.relief]", table.label().trim_end_matches(']'));
    let mut marches = false;
    if let Some(table) = table.table("relief", keys::RELIEF, &label)? {
        material.relief = relief(&table)?;
        marches = table.get("technique").is_some() && material.relief.technique.needs_heights();
    }
    Ok(Plan { material, jobs, metallic, marches })
}

fn is_text(table: &Table<'_>, key: &str) -> bool {
    table.get(key).is_some_and(|node| matches!(node.value, relievo_toml::Value::String(_)))
}

/// `key` describes the file under `file`, or that of a folder, and would silently do nothing without it.
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

fn relief(table: &Table<'_>) -> Result<Relief, SceneError> {
    let mut relief = Relief::default();
    if matches!(table.text("edge", "a name"), Ok(Some("silhouette"))) {
        return Err(table.error("edge", "edge = \"silhouette\" is not available yet; use \"clip\"".to_owned()));
    }
    let techniques: Vec<_> = SurfaceTechnique::names().collect();
    relief.technique = table.choice("technique", &techniques, SurfaceTechnique::from_name)?.unwrap_or(relief.technique);
    relief.offset_limiting = table.boolean("offset_limiting")?.unwrap_or(relief.offset_limiting);

    let layers = |key| table.number(key, "a number from 1 to 4096", |x| (1.0..=4096.0).contains(&x));
    // Whichever is given alone keeps its value; the other one makes room.
    (relief.min_layers, relief.max_layers) = match (layers("min_layers")?, layers("max_layers")?) {
        (Some(min), Some(max)) if min > max => {
            let message = format!("min_layers ({min}) in {} must be at most max_layers ({max})", table.label());
            return Err(table.error("min_layers", message));
        }
        (Some(min), Some(max)) => (min, max),
        (Some(min), None) => (min, relief.max_layers.max(min)),
        (None, Some(max)) => (relief.min_layers.min(max), max),
        (None, None) => (relief.min_layers, relief.max_layers),
    };
    relief.refine_steps = table.integer("refine_steps", 0, 64)?;
    relief.cones = table.choice("cones", &Cones::ALL.map(Cones::name), Cones::from_name)?.unwrap_or(relief.cones);
    let shadows = Shadow::ALL.map(Shadow::name);
    relief.shadow = table.choice("shadow", &shadows, Shadow::from_name)?.unwrap_or(relief.shadow);
    let edge = |name: &str| match name {
        "clip" => Some(Edge::Clip),
        "wrap" => Some(Edge::Wrap),
        "clamp" => Some(Edge::Clamp),
        _ => None,
    };
    relief.edge = table.choice("edge", &["clip", "wrap", "clamp"], edge)?.unwrap_or(relief.edge);
    relief.grid = table.integer("grid", 2, 8192)?.unwrap_or(relief.grid);
    relief.lod = table.boolean("lod")?.unwrap_or(relief.lod);
    relief.write_depth = table.boolean("write_depth")?;
    Ok(relief)
}
