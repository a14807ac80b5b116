//! One file, one material, or a folder of materials: what there is to do, what is done, and what is left.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use anyhow::{Context, Result, bail};
use relievo_map::{FolderMaps, find_maps, write_atomic};
use serde::{Deserialize, Serialize};

use super::output::{check_folder, make_folder};
use crate::console::{Console, with_causes};
use crate::outputs::check_outputs;

/// Which of a material's maps a verb reads.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reads {
    Height,
    Normal,
    Color,
}

impl Reads {
    fn of(self, maps: &FolderMaps) -> Option<PathBuf> {
        match self {
            Self::Height => maps.height.clone(),
            Self::Normal => maps.normal.as_ref().map(|(path, _)| path.clone()),
            Self::Color => maps.base_color.clone(),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Height => "height",
            Self::Normal => "normal",
            Self::Color => "colour",
        }
    }
}

/// One map to read, and where what is made of it goes.
pub(crate) struct Job {
    pub(crate) input: PathBuf,
    /// What is known of the input if it was found in a folder by its name.
    pub(crate) found: Option<FolderMaps>,
    /// The file to write; of a material in a folder, the name that its files begin with.
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

/// Does `work` for `input`: a file, into the file `output`; or a folder, that is one material or holds materials, into
/// the folder `output`, skipping what an earlier run has done. `command` is the verb with all that changes its result.
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
        if fs::canonicalize(input).ok().is_some_and(|input| fs::canonicalize(output).is_ok_and(|o| o == input)) {
            bail!("{}: this would overwrite the map that is read; choose another name", output.display());
        }
        let job = Job { input: input.to_owned(), found: None, output: Output::File(output.to_owned()) };
        return work(&job).map(drop);
    }
    check_folder(output)?;
    let materials = materials(input, reads, console)?;
    make_folder(output)?;
    let manifest = output.join(MANIFEST);
    let mut done = read_manifest(&manifest)?;
    let bar = console.progress(materials.len() as u64);
    let mut failures = Vec::new();
    let mut skipped = 0;
    for (name, found, map) in materials {
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
        let job = Job { input: map, found: Some(found), output: Output::Folder { folder, name: name.clone() } };
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

/// The materials in `folder`: itself, or the folders in it, by name; each with the map that is read.
fn materials(folder: &Path, reads: Reads, console: &Console) -> Result<Vec<(String, FolderMaps, PathBuf)>> {
    let name = |path: &Path| {
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        path.file_name().unwrap_or_default().to_string_lossy().into_owned()
    };
    if let Ok(found) = find_maps(folder) {
        return match reads.of(&found) {
            Some(map) => Ok(vec![(name(folder), found, map)]),
            None => bail!("{}: this material has no {} map", folder.display(), reads.name()),
        };
    }
    let entries = fs::read_dir(folder).and_then(Iterator::collect::<std::io::Result<Vec<_>>>);
    let mut entries = entries.with_context(|| format!("{}: the folder cannot be listed", folder.display()))?;
    entries.sort_by_key(fs::DirEntry::file_name);
    let mut materials = Vec::new();
    for path in entries.iter().map(fs::DirEntry::path).filter(|path| path.is_dir()) {
        let Ok(found) = find_maps(&path) else { continue };
        match reads.of(&found) {
            Some(map) => materials.push((name(&path), found, map)),
            None => console.note(&format!("{}: left out, as it has no {} map", path.display(), reads.name())),
        }
    }
    if materials.is_empty() {
        bail!(
            "{}: neither a material nor a folder of materials with {} maps; maps are recognised by names that end in \
             _Color, _NormalGL, _Displacement and the like",
            folder.display(),
            reads.name()
        );
    }
    Ok(materials)
}
