use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use relievo_lab::{Tile, contact_sheet};
use relievo_make::{MakeError, Recipe, built_in, height_scale, make, names, recipe_text};
use relievo_map::{MapSet, write_atomic, write_picture};
use serde::Serialize;

use super::batch::{self, Reads, VerbTask};
use super::job::JobOutput;
use super::output::MapOutput;
use super::pictures::swatch;
use crate::console::{Console, WrongUsage, print};
use crate::memory::check_room;
use crate::outputs::{check_outputs, extension};
use crate::scene_args::{OUTPUT, whole_number};

/// Texels per side of the pictures on a sheet, and of their maps.
const SWATCH: u32 = 256;
const SWATCH_MAPS: u32 = 512;

/// Memory for making a texel where no recipe tells, in bytes (measured: 118).
const BYTES_PER_TEXEL: u64 = 128;

/// Make a material from nothing: colour, normal, height, roughness and ambient occlusion that tile
#[derive(Args, Serialize)]
#[command(after_help = "Examples:
  relievo map make --list
  relievo map make --list -o sheet.png
  relievo map make cobbles -o cobbles --size 2048
  relievo map make cobbles --text > mine.toml
  relievo map make mine.toml -o mine --seed 7
  relievo map make recipes -o materials                                  every recipe in a folder

A recipe is a graph of steps in a TOML file; RECIPES.md of relievo-make has every operation. A larger --size shows the same design in more detail.")]
pub(crate) struct Arguments {
    /// A built-in recipe, a recipe file (.toml), or a folder of recipe files
    #[arg(required_unless_present = "list")]
    #[serde(skip)]
    recipe: Option<String>,
    /// The folder for the maps; it is made if need be. With --list: the picture sheet (PNG)
    #[arg(long, short, value_name = "FOLDER", help_heading = OUTPUT)]
    #[serde(skip)]
    output: Option<PathBuf>,
    /// Texels per side
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = whole_number(1, 8192), allow_negative_numbers = true)]
    size: u32,
    /// Another seed gives another material of the same kind [default: the recipe's]
    #[arg(long, value_name = "N", value_parser = whole_number(0, u32::MAX), allow_negative_numbers = true)]
    seed: Option<u32>,
    /// Name the built-in recipes; with -o SHEET.png draw them all
    #[arg(long, conflicts_with_all = ["recipe", "text", "seed"])]
    list: bool,
    /// Print the text of a built-in recipe, as a start for your own
    #[arg(long)]
    text: bool,
    #[command(flatten)]
    maps: MapOutput,
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    if arguments.list {
        return match &arguments.output {
            None => list(),
            Some(path) => sheet(path, console),
        };
    }
    let name = arguments.recipe.as_deref().unwrap_or_default();
    if arguments.text {
        return text(name, arguments.output.as_deref());
    }
    let Some(folder) = &arguments.output else {
        bail!(WrongUsage("nothing would be written; name a folder for the maps with -o FOLDER".to_owned()));
    };
    let recipes = Path::new(name);
    if recipes.is_dir() {
        let task = VerbTask::new("make", Reads::Recipe, arguments)?;
        return batch::run(recipes, folder, &task, console, |job| {
            let JobOutput::Folder { folder, name } = &job.output else { return Ok(Vec::new()) };
            let folder = folder.join(name);
            arguments.maps.check_material(&folder, name)?;
            arguments.maps.material(&folder, name, &maps(&job.input.to_string_lossy(), arguments)?)
        });
    }
    let stem = recipes.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    arguments.maps.check_material(folder, &stem)?;
    let maps = maps(name, arguments)?;
    arguments.maps.material(folder, &stem, &maps).map(drop)
}

/// The maps of a built-in material or of a recipe file.
fn maps(name: &str, arguments: &Arguments) -> Result<MapSet> {
    let recipe = if extension(Path::new(name)) == "toml" {
        let text = read(Path::new(name))?;
        Recipe::parse(name, &text, arguments.seed)?
    } else if let Some(text) = recipe_text(name) {
        Recipe::parse(name, text, arguments.seed)?
    } else {
        let size = arguments.size;
        if names().contains(&name) {
            if arguments.seed.is_some() {
                bail!(WrongUsage(format!(
                    "{name} is made by code, not by a recipe, and has no seed; leave out --seed"
                )));
            }
            room(u64::from(size).pow(2) * BYTES_PER_TEXEL, size)?;
        }
        return make(name, size).map_err(unknown);
    };
    room(recipe.bytes(arguments.size), arguments.size)?;
    Ok(recipe.make(arguments.size)?)
}

fn room(bytes: u64, size: u32) -> Result<()> {
    check_room(bytes, &format!("maps of {size}×{size} texels"), "a smaller --size")
}

fn unknown(error: MakeError) -> anyhow::Error {
    match error {
        MakeError::UnknownName { .. } => {
            anyhow::anyhow!("{error}; a recipe of your own is a file whose name ends in .toml")
        }
        error => error.into(),
    }
}

fn read(path: &Path) -> Result<String> {
    let metadata = std::fs::metadata(path)
        .with_context(|| format!("{}: there is no such recipe; check the spelling and the folder", path.display()));
    // The system's own words say the same.
    let metadata = metadata.map_err(|error| anyhow::anyhow!("{error}"))?;
    if !metadata.is_file() || metadata.len() > Recipe::MAX_BYTES as u64 {
        bail!("{}: a recipe is a text file of at most {} bytes", path.display(), Recipe::MAX_BYTES);
    }
    let bytes = std::fs::read(path).with_context(|| format!("{}: the recipe cannot be read", path.display()))?;
    String::from_utf8(bytes).map_err(|_| anyhow::anyhow!("{}: a recipe is a text file in UTF-8", path.display()))
}

fn text(name: &str, output: Option<&Path>) -> Result<()> {
    let text = match recipe_text(name) {
        Some(text) => text,
        None if names().contains(&name) => bail!("{name} is made by code, not by a recipe; it has no text"),
        None => return Err(unknown(built_in(name).err().unwrap_or(MakeError::Size { size: 0 }))),
    };
    match output {
        None => print(text.as_bytes()),
        Some(path) => {
            check_outputs(&[path], None)?;
            Ok(write_atomic(path, |file| file.write_all(text.as_bytes()))?)
        }
    }
}

fn description(name: &str) -> String {
    built_in(name).map_or_else(|_| "made by code of its own".to_owned(), |recipe| recipe.description().to_owned())
}

fn list() -> Result<()> {
    let lines: String = names().iter().map(|name| format!("{name:20} {}\n", description(name))).collect();
    print(lines.as_bytes())
}

fn sheet(path: &Path, console: &Console) -> Result<()> {
    if extension(path) != "png" {
        bail!(WrongUsage(format!("{}: the sheet is written as PNG; name a file that ends in .png", path.display())));
    }
    check_outputs(&[path], None)?;
    let bar = console.progress(names().len() as u64);
    let mut tiles = Vec::new();
    for name in names() {
        bar.set_message((*name).to_owned());
        let picture = swatch(&make(name, SWATCH_MAPS)?, height_scale(name)?, SWATCH)?;
        tiles.push(Tile { picture, lines: vec![(*name).to_owned(), description(name)] });
        bar.inc(1);
    }
    bar.finish_and_clear();
    let sheet = contact_sheet("Relievo: recipes", &tiles, Some(6), &[])?;
    Ok(write_picture(path, &sheet)?)
}
