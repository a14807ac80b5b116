//! One file, one material, or a folder of materials or loose files: what there is to do, what is done, and what is left.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use anyhow::{Context, Result, bail};
use relievo_map::{Channel, FolderMaps, find_maps, write_atomic};
use serde::{Deserialize, Serialize};

use super::output::{check_folder, make_folder};
use crate::console::{Console, with_causes};
use crate::outputs::{check_outputs, extension};

/// What a verb reads: one of a material's maps, or a recipe.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reads {
    Height,
    Normal,
    Color,
    /// One number per texel; of a material its roughness.
    Scalar,
    Recipe,
}

impl Reads {
    fn of(self, maps: &FolderMaps) -> Option<PathBuf> {
        match self {
            Self::Height => maps.height.clone(),
            Self::Normal => maps.normal.as_ref().map(|(path, _)| path.clone()),
            Self::Color => maps.base_color.clone(),
            // Only a file of its own: of a packed one the other channels would be lost.
            Self::Scalar => maps.roughness.clone().filter(|(_, c)| *c == Channel::Luminance).map(|(path, _)| path),
            Self::Recipe => None,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Height => "height",
            Self::Normal => "normal",
            Self::Color => "colour",
            Self::Scalar => "roughness",
            Self::Recipe => "recipe",
        }
    }

    /// Whether a file that stands by itself in a folder may be one.
    fn is_one(self, path: &Path) -> bool {
        const IMAGES: [&str; 10] = ["png", "jpg", "jpeg", "tif", "tiff", "exr", "hdr", "tga", "bmp", "webp"];
        let extension = extension(path);
        if self == Self::Recipe { extension == "toml" } else { IMAGES.contains(&extension.as_str()) }
    }
}

/// One map to read, and where what is made of it goes.
pub(crate) struct Job {
    pub(crate) input: PathBuf,
    /// What is known of the input if it was found in a folder by its name.
    pub(crate) found: Option<FolderMaps>,
    /// The file to write; of a material in a folder, or of a loose file, the name that its files begin with.
    pub(crate) output: Output,
}

pub(crate) enum Output {
    File(PathBuf),
    Folder { folder: PathBuf, name: String },
}

/// What the manifest says about a material.
#[derive(PartialEq, Serialize, Deserialize)]
struct Done {
    /// The verb and its options.
    command: String,
    input: PathBuf,
    /// Of the input: bytes and time of the last change, in nanoseconds since 1970.
    bytes: u64,
    changed: u64,
    outputs: Vec<String>,
}

const MANIFEST: &str = "relievo-manifest.json";

/// Does `work` for `input`: a file, into the file `output`; or a folder, that is one material or holds materials or loose
/// files, into the folder `output`, skipping what an earlier run has done. `command` is the verb with all that changes its result.
/// `work` returns the files that it wrote.
///
/// A material that fails does not stop the others; at the end the first failure is told.
pub(crate) fn run(
    input: &Path,
    output: &Path,
    reads: Reads,
    command: &str,
    console: &Console,
    work: impl Fn(&Job) -> Result<Vec<PathBuf>>,
) -> Result<()> {
    if !input.is_dir() {
        check_outputs(&[output], None)?;
        if is_same(input, output) {
            bail!("{}: this would overwrite the map that is read; choose another name", output.display());
        }
        let job = Job { input: input.to_owned(), found: None, output: Output::File(output.to_owned()) };
        return work(&job).map(drop);
    }
    check_folder(output)?;
    let materials = materials(input, reads, console)?;
    if materials.iter().any(|material| material.found.is_none()) && is_same(input, output) {
        bail!(
            "{}: loose files are told from maps by their folder; choose another folder for the maps",
            output.display()
        );
    }
    make_folder(output)?;
    let manifest = output.join(MANIFEST);
    let mut done = read_manifest(&manifest)?;
    let bar = console.progress(materials.len() as u64);
    let mut failures = Vec::new();
    let mut skipped = 0;
    for Material { name, found, map } in materials {
        bar.set_message(name.clone());
        let mut entry = describe(command, &map)?;
        let before = done.get(&name);
        let there = before.is_some_and(|b| b.outputs.iter().all(|file| output.join(file).is_file()));
        if there && before.is_some_and(|b| Done { outputs: Vec::new(), ..describe_again(b) } == entry) {
            skipped += 1;
            bar.inc(1);
            continue;
        }
        let folder = output.to_owned();
        let job = Job { input: map, found, output: Output::Folder { folder, name: name.clone() } };
        match work(&job) {
            Ok(files) => {
                entry.outputs = files
                    .iter()
                    .filter_map(|file| Some(file.strip_prefix(output).ok()?.to_string_lossy().into_owned()))
                    .collect();
                done.insert(name, entry);
                // After each material: what is done stays done, whatever comes.
                let json = serde_json::to_string_pretty(&done)?;
                write_atomic(&manifest, |file| writeln!(file, "{json}"))?;
            }
            Err(error) => {
                console.note(&format!("{name} failed: {}", with_causes(&error)));
                failures.push((name, error));
            }
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    if skipped > 0 {
        console.note(&format!("{skipped} materials were done before, as {} says", manifest.display()));
    }
    let count = failures.len();
    match failures.into_iter().next() {
        None => Ok(()),
        Some((_, error)) if count == 1 => Err(error),
        Some((name, error)) => Err(error.context(format!("{count} materials failed, the first is {name}"))),
    }
}

/// Whether two paths lead to one file or folder.
pub(crate) fn is_same(a: &Path, b: &Path) -> bool {
    fs::canonicalize(a).is_ok_and(|a| fs::canonicalize(b).is_ok_and(|b| a == b))
}

fn describe_again(done: &Done) -> Done {
    Done { command: done.command.clone(), input: done.input.clone(), outputs: Vec::new(), ..*done }
}

fn describe(command: &str, map: &Path) -> Result<Done> {
    let metadata = fs::metadata(map).with_context(|| format!("{}: cannot be read", map.display()))?;
    let changed = metadata.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    let changed = changed.map_or(0, |time| time.as_nanos() as u64);
    let input = map.to_owned();
    Ok(Done { command: command.to_owned(), input, bytes: metadata.len(), changed, outputs: Vec::new() })
}

fn read_manifest(path: &Path) -> Result<BTreeMap<String, Done>> {
    let Ok(text) = fs::read_to_string(path) else { return Ok(BTreeMap::new()) };
    serde_json::from_str(&text)
        .map_err(|error| anyhow::anyhow!("{}: this is no manifest of Relievo ({error}); move it away", path.display()))
}

/// A material, and the map of it that is read.
struct Material {
    name: String,
    /// `None` for a loose file.
    found: Option<FolderMaps>,
    map: PathBuf,
}

/// The materials in `folder`: itself, or the folders in it and the loose files that no name tells apart, by name.
fn materials(folder: &Path, reads: Reads, console: &Console) -> Result<Vec<Material>> {
    let name = |path: &Path| {
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    };
    let itself = if reads == Reads::Recipe { None } else { find_maps(folder).ok() };
    if let Some(found) = itself {
        // Another material's files would be left out: that must not stay unsaid.
        found.notes.iter().for_each(|note| console.note(note));
        return match reads.of(&found) {
            Some(map) => Ok(vec![Material { name: name(folder), found: Some(found), map }]),
            None => bail!("{}: this material has no {} map", folder.display(), reads.name()),
        };
    }
    let entries = fs::read_dir(folder).and_then(Iterator::collect::<std::io::Result<Vec<_>>>);
    let mut entries = entries.with_context(|| format!("{}: the folder cannot be listed", folder.display()))?;
    entries.sort_by_key(fs::DirEntry::file_name);
    let mut materials: Vec<Material> = Vec::new();
    for path in entries.iter().map(fs::DirEntry::path) {
        if path.is_file() && reads.is_one(&path) && !name(&path).starts_with('.') {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            // Two files of one name would be written over each other.
            let taken = |name: &str| materials.iter().any(|material| material.name == name);
            let mut name = if taken(&stem) { name(&path).replace('.', "_") } else { stem };
            while taken(&name) {
                name.push('_');
            }
            materials.push(Material { name, found: None, map: path });
        } else if path.is_dir() && reads != Reads::Recipe {
            let Ok(found) = find_maps(&path) else { continue };
            match reads.of(&found) {
                Some(map) => materials.push(Material { name: name(&path), found: Some(found), map }),
                None => console.note(&format!("{}: left out, as it has no {} map", path.display(), reads.name())),
            }
        }
    }
    if materials.is_empty() && reads == Reads::Recipe {
        bail!("{}: there are no recipes in this folder; they are files whose names end in .toml", folder.display());
    }
    if materials.is_empty() {
        bail!(
            "{}: neither a material nor a folder of materials with {} maps or of pictures; maps are recognised by names \
             that end in _Color, _NormalGL, _Displacement and the like",
            folder.display(),
            reads.name()
        );
    }
    Ok(materials)
}
