//! A technique with its settings, written into scene files.

use std::path::{Component, Path, PathBuf};

use thiserror::Error;
use toml_edit::{DocumentMut, Item, Table, TableLike, Value, value};

use crate::Candidate;

/// A scene that shows one material.
const TEMPLATE: &str = include_str!("template.toml");

/// Why a scene file cannot take a technique.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum Tuning {
    /// It is no TOML.
    #[error("this is not a scene file: {0}")]
    Syntax(String),
    /// There is nothing to write into.
    #[error("the scene has no [materials.{0}]; it has {1}")]
    NoMaterial(String, String),
    /// There are several.
    #[error("the scene has several materials; say which one is meant: {0}")]
    WhichMaterial(String),
    /// A key holds something else.
    #[error("{0} is no table")]
    NoTable(String),
}

/// The text of a scene with the technique and settings of `candidate` in the relief of one material: the one called
/// `material`, or the only one. Comments and everything else stay as they are.
///
/// # Errors
/// If the text is no TOML, or has no such material.
pub fn edit_scene(text: &str, material: Option<&str>, candidate: &Candidate) -> Result<String, Tuning> {
    let mut scene: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
        let line = error.span().map_or(1, |span| 1 + text[..span.start.min(text.len())].matches('\n').count());
        Tuning::Syntax(format!("line {line}: {}", error.message()))
    })?;
    let materials = scene.get_mut("materials").and_then(Item::as_table_like_mut);
    let names: Vec<String> =
        materials.as_ref().map_or_else(Vec::new, |table| table.iter().map(|(name, _)| name.to_owned()).collect());
    let list = || if names.is_empty() { "no materials".to_owned() } else { names.join(", ") };
    let name = match (material, names.as_slice()) {
        (Some(name), _) => name.to_owned(),
        (None, [only]) => only.clone(),
        (None, []) => return Err(Tuning::NoMaterial("NAME".to_owned(), list())),
        (None, _) => return Err(Tuning::WhichMaterial(list())),
    };
    let missing = || Tuning::NoMaterial(name.clone(), list());
    let item = materials.and_then(|table| table.get_mut(&name)).ok_or_else(missing)?;
    let material = item.as_table_like_mut().ok_or_else(|| Tuning::NoTable(format!("materials.{name}")))?;
    if material.get("relief").is_none() {
        material.insert("relief", Item::Table(Table::new()));
    }
    let relief = material.get_mut("relief").and_then(Item::as_table_like_mut);
    put(relief.ok_or_else(|| Tuning::NoTable(format!("materials.{name}.relief")))?, candidate);
    Ok(scene.to_string())
}

/// The text of a new scene, to be written to `path`, that shows the material called `source` with the technique and
/// settings of `candidate`. `source` is `make:NAME`, a folder or a height map; `notes` become comments at its top.
#[must_use]
pub fn new_scene(path: &Path, source: &str, height_scale: f32, candidate: &Candidate, notes: &[String]) -> String {
    // The template is ours; a test reads it.
    let mut scene: DocumentMut = TEMPLATE.parse().unwrap_or_default();
    let material = &mut scene["materials"]["tuned"];
    if source.starts_with("make:") {
        material["from"] = value(source);
    } else {
        let key = if Path::new(source).is_dir() { "from" } else { "height" };
        material[key] = value(relative(Path::new(source), path).to_string_lossy().replace('\\', "/"));
    }
    // The shortest decimals that are this f32.
    material["height_scale"] = value(height_scale.to_string().parse::<f64>().unwrap_or(f64::from(height_scale)));
    if let Some(relief) = material["relief"].as_table_like_mut() {
        put(relief, candidate);
    }
    let notes: String = notes.iter().map(|note| format!("# {}\n", note.replace(['\n', '\r'], " "))).collect();
    format!("{notes}{scene}")
}

fn put(relief: &mut dyn TableLike, candidate: &Candidate) {
    let contender = candidate.contender();
    set(relief, "technique", contender.technique.name().into());
    if let Some([min, max]) = contender.layers {
        set(relief, "min_layers", i64::from(min).into());
        set(relief, "max_layers", i64::from(max).into());
    }
    if let Some(steps) = contender.refine_steps {
        set(relief, "refine_steps", i64::from(steps).into());
    }
}

/// Sets a key; a comment behind its old value stays.
fn set(table: &mut dyn TableLike, key: &str, mut new: Value) {
    match table.get_mut(key).and_then(Item::as_value_mut) {
        Some(old) => {
            *new.decor_mut() = old.decor().clone();
            *old = new;
        }
        None => {
            table.insert(key, Item::Value(new));
        }
    }
}

/// The path of `file` as it is written in the scene file `scene`: relative to its folder where both are known.
fn relative(file: &Path, scene: &Path) -> PathBuf {
    let folder = scene.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (Ok(file), Ok(folder)) = (std::fs::canonicalize(file), std::fs::canonicalize(folder)) else {
        return file.to_owned();
    };
    let common = file.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    // Nothing but the root in common, or not even that: another drive.
    if common < 2 {
        return file;
    }
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    up.chain(file.components().skip(common)).collect()
}

#[cfg(test)]
mod tests {
    use relievo_march::Technique;
    use relievo_scene::{LoadOptions, Scene, SurfaceTechnique};

    use super::*;

    const COMMENTED: &str = "# A wall.\n[materials.wall]\nfrom = \"make:brick-wall\" # made\n\n[materials.wall.relief]\n\
                             technique = \"exact\"   # try others\nshadow = \"exact\"\n\n[[objects]]\nmesh = \"quad\"\n";

    fn candidate(text: &str) -> Candidate {
        text.parse().unwrap()
    }

    #[test]
    fn an_edited_scene_keeps_its_comments_and_is_taken() {
        let text = edit_scene(COMMENTED, None, &candidate("relief:16..64+6")).unwrap();
        let expected = COMMENTED.replace("\"exact\"   # try", "\"relief\"   # try").replace(
            "shadow = \"exact\"\n",
            "shadow = \"exact\"\nmin_layers = 16\nmax_layers = 64\nrefine_steps = 6\n",
        );
        assert_eq!(text, expected);
        let options = LoadOptions { make_size: 16, ..LoadOptions::default() };
        let scene = Scene::parse(&text, "x", Path::new(""), &options).unwrap();
        let relief = &scene.materials[0].relief;
        assert_eq!(relief.technique, SurfaceTechnique::March(Technique::Relief));
        assert_eq!((relief.min_layers, relief.max_layers, relief.refine_steps), (16.0, 64.0, Some(6)));
        // The same again changes nothing.
        assert_eq!(edit_scene(&text, Some("wall"), &candidate("relief:16..64+6")).unwrap(), text);
    }

    #[test]
    fn inline_and_missing_tables_are_filled() {
        let inline = "[materials]\na = { from = \"make:toy-box\", relief = { technique = \"none\" } }\n";
        let text = edit_scene(inline, Some("a"), &candidate("exact")).unwrap();
        assert!(text.contains("technique = \"exact\"") && text.lines().count() == 2, "{text}");
        let bare = "[materials.a]\nfrom = \"make:toy-box\"\n[[objects]]\nmesh = \"quad\"\n";
        let text = edit_scene(bare, None, &candidate("occlusion:8..32")).unwrap();
        assert!(text.contains("[materials.a.relief]\ntechnique = \"occlusion\"\nmin_layers = 8"), "{text}");
    }

    #[test]
    fn scenes_without_the_material_are_refused() {
        let edit = |text: &str, name| edit_scene(text, name, &candidate("exact")).unwrap_err().to_string();
        assert!(edit("[materials.a]\n[materials.b]\n", None).contains("a, b"));
        assert!(edit("[materials.a]\n", Some("c")).contains("[materials.c]; it has a"));
        assert!(edit("", None).contains("no materials"));
        assert!(edit("materials = 3", Some("c")).contains("no [materials.c]"));
        assert!(edit("[materials]\nc = 3", Some("c")).contains("materials.c is no table"));
        assert!(edit("[x]\n[mat", None).contains("line 2"));
    }

    #[test]
    fn a_new_scene_is_taken_and_says_where_it_came_from() {
        let notes = ["one".to_owned(), "two\nlines".to_owned()];
        let text = new_scene(Path::new("x.toml"), "make:cobbles", 0.05, &candidate("occlusion:24..96"), &notes);
        assert!(text.starts_with("# one\n# two lines\n") && text.contains("height_scale = 0.05\n"), "{text}");
        let options = LoadOptions { make_size: 16, ..LoadOptions::default() };
        let scene = Scene::parse(&text, "x", Path::new(""), &options).unwrap();
        assert_eq!(scene.materials[0].relief.max_layers, 96.0);
        assert!(scene.materials[0].maps.height.is_some() && !scene.lights.is_empty());
    }

    #[test]
    fn paths_lead_from_the_scenes_folder() {
        let root = tempfile::tempdir().unwrap();
        let inside = |path: &str| root.path().join(path);
        std::fs::create_dir_all(inside("maps/wall")).unwrap();
        std::fs::create_dir_all(inside("scenes")).unwrap();
        let text =
            new_scene(&inside("scenes/x.toml"), inside("maps/wall").to_str().unwrap(), 0.1, &candidate("exact"), &[]);
        assert!(text.contains("from = \"../maps/wall\""), "{text}");
    }
}
