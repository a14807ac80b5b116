//! `[materials.NAME.relief]`.

use relievo_march::{Cones, Shadow};

use crate::file::error::SceneError;
use crate::file::table::Table;
use crate::{Edge, Offset, Relief, SurfaceTechnique};

pub(super) fn relief(table: &Table<'_>) -> Result<Relief, SceneError> {
    let mut relief = Relief::default();
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
    relief.offset = table.choice("offset", &Offset::ALL.map(Offset::name), Offset::from_name)?.unwrap_or(relief.offset);
    relief.edge = table.choice("edge", &Edge::ALL.map(Edge::name), Edge::from_name)?.unwrap_or(relief.edge);
    grid(table, &mut relief)?;
    relief.lod = table.boolean("lod")?.unwrap_or(relief.lod);
    relief.write_depth = table.boolean("write_depth")?;
    Ok(relief)
}

/// Reads `grid`: a number of vertices, or `"texel"` or `"texel:N"`.
fn grid(table: &Table<'_>, relief: &mut Relief) -> Result<(), SceneError> {
    const EXPECTED: &str = "a whole number from 2 to 8192, \"texel\", or \"texel:N\" with N from 1 to 64";
    if let Ok(Some(text)) = table.text("grid", EXPECTED) {
        relief.vertices_per_texel = Some(vertices_per_texel(text).ok_or_else(|| {
            table.error("grid", format!("grid = \"{}\" must be {EXPECTED}", relievo_toml::shorten(text)))
        })?);
    } else {
        relief.grid = table.integer("grid", 2, 8192)?.unwrap_or(relief.grid);
    }
    Ok(())
}

fn vertices_per_texel(text: &str) -> Option<u32> {
    let count = match text.strip_prefix("texel")? {
        "" => 2,
        rest => rest.strip_prefix(':')?.parse().ok()?,
    };
    (1..=Relief::MAX_VERTICES_PER_TEXEL).contains(&count).then_some(count)
}
