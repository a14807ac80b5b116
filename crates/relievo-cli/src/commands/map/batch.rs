//! Work on one file, one material, or a folder of materials or loose files, without what is finished.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use relievo_journal::{Input, Journal, Work};
use relievo_map::{Channel, FolderMaps, IMAGE_EXTENSIONS, find_maps};
use serde::Serialize;

use super::job::{JobOutput, MapJob, is_same};
use crate::console::{Console, with_causes};
use crate::outputs::{check_folder, check_outputs, extension, make_folder};

/// The map of a material that a verb reads, or a recipe.
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

    /// True if a file that stands by itself in a folder may be one.
    fn is_one(self, path: &Path) -> bool {
        let extension = extension(path);
        if self == Self::Recipe { extension == "toml" } else { IMAGE_EXTENSIONS.contains(&extension.as_str()) }
    }
}

/// A verb with all that its results depend on.
pub(crate) struct VerbTask {
    verb: &'static str,
    reads: Reads,
    work: Work,
}

impl VerbTask {
    /// Describes a verb by its options: the struct that clap fills, without the paths of input and output.
    pub(crate) fn new(verb: &'static str, reads: Reads, options: &impl Serialize) -> Result<Self> {
        Ok(Self { verb, reads, work: Work::new(env!("CARGO_PKG_VERSION"), options)? })
    }

    /// Adds something that is read for every material.
    pub(crate) fn reading(self, input: Input) -> Self {
        Self { work: self.work.reading(input), ..self }
    }
}

/// The kind of the journal's entries.
const KIND: &str = "map";

/// Does `work` for `input`: a file, into the file `output`; or a folder, that is one material or holds materials or loose
/// files, into the folder `output`, skipping what an earlier run has done. `work` returns the files that it wrote.
///
/// A material that fails does not stop the others; at the end the first failure is returned.
pub(crate) fn run(
    input: &Path,
    output: &Path,
    task: &VerbTask,
    console: &Console,
    work: impl Fn(&MapJob) -> Result<Vec<PathBuf>>,
) -> Result<()> {
    if !input.is_dir() {
        check_outputs(&[output], None)?;
        if is_same(input, output) {
            bail!("{}: this would overwrite the map that is read; choose another name", output.display());
        }
        let job = MapJob { input: input.to_owned(), found: None, output: JobOutput::File(output.to_owned()) };
        return work(&job).map(drop);
    }
    check_folder(output)?;
    let materials = materials(input, task.reads, console)?;
    if materials.iter().any(|material| material.found.is_none()) && is_same(input, output) {
        bail!(
            "{}: loose files are told from maps by their folder; choose another folder for the maps",
            output.display()
        );
    }
    make_folder(output)?;
    run_materials(materials, output, task, console, work)
}

/// Does `work` for each material that the journal of the folder `output` does not know as finished.
fn run_materials(
    materials: Vec<Material>,
    output: &Path,
    task: &VerbTask,
    console: &Console,
    work: impl Fn(&MapJob) -> Result<Vec<PathBuf>>,
) -> Result<()> {
    let mut journal = Journal::open(output, KIND)?;
    if let Some(note) = journal.note() {
        console.note(&note);
    }
    let bar = console.progress(materials.len() as u64);
    let mut failures = Vec::new();
    let mut skipped = 0;
    for Material { name, found, map } in materials {
        bar.set_message(name.clone());
        let entry = format!("{}/{name}", task.verb);
        let this_work = task.work.clone().reading(Input::of_file(&map)?);
        if journal.finished(&entry, &this_work).is_some() {
            skipped += 1;
            bar.inc(1);
            continue;
        }
        journal.begin(&entry)?;
        let folder = output.to_owned();
        let job = MapJob { input: map, found, output: JobOutput::Folder { folder, name: name.clone() } };
        match work(&job) {
            Ok(files) => {
                let relative = |file: &PathBuf| Some(file.strip_prefix(output).ok()?.to_string_lossy().into_owned());
                journal.finish(&entry, this_work, files.iter().filter_map(relative).collect())?;
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
        console.note(&format!("{skipped} materials were done before, as {} says", journal.path().display()));
    }
    let count = failures.len();
    match failures.into_iter().next() {
        None => Ok(()),
        Some((_, error)) if count == 1 => Err(error),
        Some((name, error)) => Err(error.context(format!("{count} materials failed, the first is {name}"))),
    }
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
