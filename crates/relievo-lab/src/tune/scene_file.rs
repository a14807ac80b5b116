//! Editing of scene files: writes a technique with its settings into the text.

use std::path::{Component, Path, PathBuf};

use thiserror::Error;
use toml::{Table, Value};

use crate::technique::ResolvedTechnique;

/// Camera, light and shading of a new scene.
const TEMPLATE: &str = include_str!("template.toml");

/// An error of writing a technique into a scene file.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum SceneEditError {
    /// The text is not valid TOML.
    #[error("this is not a scene file: {0}")]
    Syntax(String),
    /// The scene has no such material.
    #[error("the scene has no [materials.{0}]; it has {1}")]
    NoMaterial(String, String),
    /// The scene has several materials, and none was named.
    #[error("the scene has several materials; say which one is meant: {0}")]
    WhichMaterial(String),
    /// The relief is an inline table or has dotted keys.
    #[error("the relief of {0} is not a table with a header of its own; write it as [materials.{0}.relief]")]
    Shape(String),
}

/// Returns the text of a scene with the technique and settings of `technique` in the relief of one material: the one called
/// `material`, or the only one. Comments and everything else stay as they are.
///
/// # Errors
/// If the text is not valid TOML, has no such material, or has its relief as an inline table or in dotted keys.
pub fn edit_scene(text: &str, material: Option<&str>, technique: &ResolvedTechnique) -> Result<String, SceneEditError> {
    let parse =
        |text: &str| text.parse::<Table>().map_err(|error| SceneEditError::Syntax(error.to_string().trim().to_owned()));
    let mut scene = parse(text)?;
    let materials = scene.get_mut("materials").and_then(Value::as_table_mut);
    let names: Vec<String> = materials.as_ref().map_or_else(Vec::new, |table| table.keys().cloned().collect());
    let list = || if names.is_empty() { "no materials".to_owned() } else { names.join(", ") };
    let name = match (material, names.as_slice()) {
        (Some(name), _) => name.to_owned(),
        (None, [only]) => only.clone(),
        (None, []) => return Err(SceneEditError::NoMaterial("NAME".to_owned(), list())),
        (None, _) => return Err(SceneEditError::WhichMaterial(list())),
    };
    let missing = || SceneEditError::NoMaterial(name.clone(), list());
    let table = materials.and_then(|table| table.get_mut(&name)).and_then(Value::as_table_mut).ok_or_else(missing)?;
    let shape = || SceneEditError::Shape(name.clone());
    let relief = table.entry("relief").or_insert_with(|| Value::Table(Table::new()));
    let relief = relief.as_table_mut().ok_or_else(shape)?;
    let settings = settings(technique);
    relief.extend(settings.iter().map(|(key, value)| ((*key).to_owned(), value.clone())));

    let edited = write_in(text, &name, &settings).ok_or_else(shape)?;
    // The lines were found without a parser: check the outcome with one.
    if parse(&edited).is_ok_and(|found| found == scene) { Ok(edited) } else { Err(shape()) }
}

/// Writes keys into the table `materials.NAME.relief`, which is inserted after the material's table if missing.
fn write_in(text: &str, name: &str, settings: &[(&str, Value)]) -> Option<String> {
    let newline = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let of = |lines: &[String], path: &[&str]| lines.iter().position(|line| is_header(line, path));
    let (start, has_relief) = match of(&lines, &["materials", name, "relief"]) {
        Some(start) => (start, true),
        None => (of(&lines, &["materials", name])?, false),
    };
    let following = lines[start + 1..].iter().position(|line| line.trim_start().starts_with('['));
    let mut end = following.map_or(lines.len(), |offset| start + 1 + offset);
    // Comments before the following header belong to it.
    while end > start + 1 && (lines[end - 1].trim().is_empty() || lines[end - 1].trim_start().starts_with('#')) {
        end -= 1;
    }
    if !has_relief {
        let key = if is_bare(name) { name.to_owned() } else { Value::from(name).to_string() };
        lines.splice(end..end, [String::new(), format!("[materials.{key}.relief]")]);
        end += 2;
    }
    for (key, value) in settings {
        let known = lines[start + 1..end].iter_mut().find(|line| {
            has_relief && line.split_once('=').is_some_and(|(left, _)| left.trim().trim_matches(['"', '\'']) == *key)
        });
        match known {
            Some(line) => *line = replaced(line, value),
            None => {
                lines.insert(end, format!("{key} = {value}"));
                end += 1;
            }
        }
    }
    Some(lines.join(newline) + if text.ends_with('\n') { newline } else { "" })
}

/// Returns true if a line is the header of this table.
fn is_header(line: &str, path: &[&str]) -> bool {
    let Some(inside) = line.trim_start().strip_prefix('[').and_then(|rest| rest.split_once(']')) else { return false };
    let parts: Vec<&str> = inside.0.split('.').map(|part| part.trim().trim_matches(['"', '\''])).collect();
    parts == path
}

fn is_bare(key: &str) -> bool {
    !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

/// Replaces the value in a line `key = old # comment`.
fn replaced(line: &str, value: &Value) -> String {
    let Some((key, rest)) = line.split_once('=') else { return line.to_owned() };
    let mut quote = None;
    let comment = rest.char_indices().find(|(_, c)| {
        match quote {
            None if *c == '"' || *c == '\'' => quote = Some(*c),
            Some(open) if open == *c => quote = None,
            _ => {}
        }
        quote.is_none() && *c == '#'
    });
    let old = &rest[..comment.map_or(rest.len(), |(at, _)| at)];
    // With the spaces before the comment, so that columns of comments stay.
    let behind = &rest[old.trim_end().len()..];
    format!("{key}= {value}{behind}")
}

/// Returns the text of a new scene, to be written to `path`, that shows the material called `source` with the technique and
/// settings of `technique`. `source` is `make:NAME`, a folder or a height map; `notes` become comments at its top.
#[must_use]
pub fn new_scene(
    path: &Path,
    source: &str,
    height_scale: f32,
    technique: &ResolvedTechnique,
    notes: &[String],
) -> String {
    let (key, file) = if source.starts_with("make:") {
        ("from", source.to_owned())
    } else {
        let key = if Path::new(source).is_dir() { "from" } else { "height" };
        (key, relative(Path::new(source), path).to_string_lossy().replace('\\', "/"))
    };
    let notes: String = notes.iter().map(|note| format!("# {}\n", note.replace(['\n', '\r'], " "))).collect();
    let settings: String = settings(technique).iter().map(|(key, value)| format!("{key} = {value}\n")).collect();
    format!(
        "{notes}{TEMPLATE}\n[materials.tuned]\n{key} = {}\nheight_scale = {height_scale:?}\n\n\
         [materials.tuned.relief]\n{settings}shadow = \"exact\"\nedge = \"clip\"\n\n\
         [[objects]]\nmesh = \"quad\"\nmaterial = \"tuned\"\n",
        Value::from(file)
    )
}

/// The keys and values of a relief for a technique with its settings.
fn settings(technique: &ResolvedTechnique) -> Vec<(&'static str, Value)> {
    let spec = technique.spec();
    let mut settings = vec![("technique", Value::from(spec.technique.name()))];
    if let Some([min, max]) = spec.layers {
        settings.extend([("min_layers", Value::from(min)), ("max_layers", Value::from(max))]);
    }
    settings.extend(spec.refine_steps.map(|steps| ("refine_steps", Value::from(steps))));
    settings
}

/// The path of `file` relative to the folder of the scene file `scene`, where both exist.
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

    fn technique(text: &str) -> ResolvedTechnique {
        text.parse().unwrap()
    }

    #[test]
    fn an_edited_scene_keeps_its_comments_and_is_taken() {
        let text = edit_scene(COMMENTED, None, &technique("relief:16..64+6")).unwrap();
        let expected = COMMENTED.replace("\"exact\"   # try", "\"relief\"   # try").replace(
            "shadow = \"exact\"\n",
            "shadow = \"exact\"\nmin_layers = 16\nmax_layers = 64\nrefine_steps = 6\n",
        );
        assert_eq!(text, expected);
        let options = LoadOptions { make_size: 16, ..LoadOptions::default() };
        let scene = Scene::parse(&text, "x", Path::new(""), &options).unwrap();
        let relief = &scene.materials[0].relief;
        assert_eq!(relief.technique, SurfaceTechnique::Marched(Technique::Relief));
        assert_eq!((relief.min_layers, relief.max_layers, relief.refine_steps), (16.0, 64.0, Some(6)));
        // The same again changes nothing.
        assert_eq!(edit_scene(&text, Some("wall"), &technique("relief:16..64+6")).unwrap(), text);
    }

    #[test]
    fn a_missing_table_is_made_behind_its_material() {
        let bare = "[materials.a]\nfrom = \"make:toy-box\"\n[[objects]]\nmesh = \"quad\"\n";
        let text = edit_scene(bare, None, &technique("occlusion:8..32")).unwrap();
        assert!(
            text.contains("\"make:toy-box\"\n\n[materials.a.relief]\ntechnique = \"occlusion\"\nmin_layers = 8"),
            "{text}"
        );
        let odd = "[ materials . 'a b' ]\r\nheight_scale = 1 # x\r\n# of the objects\r\n[[objects]]\r\nmesh = 'quad'";
        let text = edit_scene(odd, None, &technique("exact")).unwrap();
        let made = "# x\r\n\r\n[materials.\"a b\".relief]\r\ntechnique = \"exact\"\r\n# of";
        assert!(text.contains(made) && text.ends_with("'quad'"), "{text}");
    }

    #[test]
    fn scenes_without_the_material_are_refused() {
        let edit = |text: &str, name| edit_scene(text, name, &technique("exact")).unwrap_err().to_string();
        assert!(edit("[materials.a]\n[materials.b]\n", None).contains("a, b"));
        assert!(edit("[materials.a]\n", Some("c")).contains("[materials.c]; it has a"));
        assert!(edit("", None).contains("no materials"));
        assert!(edit("materials = 3", Some("c")).contains("no [materials.c]"));
        assert!(edit("[materials]\nc = 3", Some("c")).contains("no [materials.c]"));
        assert!(edit("[x]\n[mat", None).contains("line 2"));
        let inline = "[materials.a]\nrelief = { technique = \"none\" }\n";
        assert!(edit(inline, None).contains("write it as [materials.a.relief]"));
        assert!(edit("[materials.a]\nrelief.technique = \"none\"\n", None).contains("write it as"));
        // What only looks like a header in a text of several lines is none.
        assert!(edit("x = \"\"\"\n[materials.a.relief]\n\"\"\"\n[materials]\na = {}\n", None).contains("write it as"));
    }

    #[test]
    fn a_new_scene_is_taken_and_says_where_it_came_from() {
        let notes = ["one".to_owned(), "two\nlines".to_owned()];
        let text = new_scene(Path::new("x.toml"), "make:cobbles", 0.05, &technique("occlusion:24..96"), &notes);
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
            new_scene(&inside("scenes/x.toml"), inside("maps/wall").to_str().unwrap(), 0.1, &technique("exact"), &[]);
        assert!(text.contains("from = \"../maps/wall\""), "{text}");
    }
}
