use std::path::PathBuf;
use std::sync::Arc;

use anyhow::{Result, bail};
use clap::Args;
use relievo_scene::{Scene, SurfaceTechnique};
use relievo_viewer::{FrameTimes, Message, Options, SceneFile, ViewerError, run as open_window};

use crate::console::{Console, WrongUsage, print, with_causes};
use crate::memory::check_room;
use crate::scene_args::{MACHINE, OUTPUT, SCENE, SceneArguments, technique_parser, whole_number};

/// Memory for a pixel in bytes: the window's pictures, the screenshot's, and, with several samples, two of half floats.
const BYTES_PER_PIXEL: u64 = 40;

/// Look at a scene in a window: turn it, change technique, height, shadow, mesh and light
#[derive(Args)]
#[command(after_help = after_help())]
pub(crate) struct Arguments {
    /// The folder that screenshots go to
    #[arg(long, value_name = "DIR", default_value = ".", help_heading = OUTPUT)]
    screenshots: PathBuf,
    #[command(flatten)]
    scene: SceneArguments,
    /// Technique of every material's relief at first [default: the scene's]
    #[arg(long, value_name = "TECHNIQUE", value_parser = technique_parser(), help_heading = SCENE)]
    technique: Option<SurfaceTechnique>,
    /// A part of the name of the GPU adapter to draw on [default: the one most likely to be fast]
    #[arg(long, value_name = "NAME", help_heading = MACHINE)]
    adapter: Option<String>,
    /// Close after this many frames, drawn as fast as it goes, and print how long they took
    #[arg(long, value_name = "N", value_parser = whole_number(1, 1_000_000), allow_negative_numbers = true, help_heading = MACHINE)]
    frames: Option<u32>,
    /// Play mouse and keys from a file, and close at its end
    #[arg(long, value_name = "FILE", help_heading = MACHINE)]
    script: Option<PathBuf>,
}

/// Examples, keys and the steps of scripts.
fn after_help() -> String {
    format!(
        "Examples:
  relievo view
  relievo view scenes/sphere.toml --technique relief
  relievo view --size 1280x720 --frames 100

Mouse and keys (letters by their place on a US keyboard):
{}

Steps of a script, a line each:
{}

A scene file is loaded again when it changes. Without a display use relievo render.",
        indented(&relievo_viewer::help()),
        indented(relievo_viewer::SCRIPT_STEPS)
    )
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("  {line}")).collect::<Vec<_>>().join("\n")
}

pub(crate) fn run(arguments: &Arguments, console: &Console) -> Result<()> {
    if !arguments.screenshots.is_dir() {
        bail!(WrongUsage(format!(
            "--screenshots {}: there is no such folder; make it first",
            arguments.screenshots.display()
        )));
    }
    let scene = load(&arguments.scene, arguments.technique, console)?;
    let (width, height) = (scene.image.width, scene.image.height);
    check_room(
        u64::from(width) * u64::from(height) * BYTES_PER_PIXEL,
        &format!("windows of {width}×{height} pixels"),
        "a smaller --size",
    )?;
    let file = arguments.scene.path().map(|path| SceneFile { path: path.to_owned(), load: reload(arguments) });
    let console = *console;
    let print_message = move |message: Message<'_>| match message {
        // A reader that went away is no reason to close the window.
        Message::Print(text) => drop(print(format!("{text}\n").as_bytes())),
        Message::Note(text) => console.note(text),
        Message::Error(text) => console.error(&anyhow::anyhow!("{text}")),
        other => console.note(other.text()),
    };
    let options = Options {
        title: arguments.scene.title(),
        file,
        adapter: arguments.adapter.clone(),
        frames: arguments.frames,
        script: arguments.script.clone(),
        screenshots: arguments.screenshots.clone(),
        command: render_command(arguments),
        on_message: Box::new(print_message),
    };
    let summary = open_window(scene, options).map_err(|error| match error {
        ViewerError::Gpu(_) => anyhow::Error::from(error).context(arguments.scene.name()),
        _ => error.into(),
    })?;
    match (arguments.frames.is_some(), summary.times) {
        (true, Some(FrameTimes { frames, clock, min, median, max })) => print(
            format!("{frames} frames ({clock} time): median {median:.2} ms, min {min:.2} ms, max {max:.2} ms\n")
                .as_bytes(),
        ),
        _ => Ok(()),
    }
}

fn load(arguments: &SceneArguments, technique: Option<SurfaceTechnique>, console: &Console) -> Result<Scene> {
    let mut scene = arguments.load(console)?;
    if let Some(technique) = technique {
        for material in scene.materials.iter_mut().filter(|material| !material.is_mist()) {
            material.relief.technique = technique;
        }
    }
    Ok(scene)
}

/// Loads the scene as [`load`], for a thread of its own.
fn reload(arguments: &Arguments) -> Arc<dyn Fn() -> Result<Scene, String> + Send + Sync> {
    let (scene, technique) = (arguments.scene.clone(), arguments.technique);
    // The window tells the notes.
    let console = Console::new(true);
    Arc::new(move || load(&scene, technique, &console).map_err(|error| with_causes(&error)))
}

/// The command that draws the scene as it was loaded.
fn render_command(arguments: &Arguments) -> Vec<String> {
    let mut words: Vec<String> = ["relievo", "render", "-o", "picture.png"].map(str::to_owned).to_vec();
    words.extend(arguments.scene.words());
    if let Some(technique) = arguments.technique {
        words.extend(["--technique".to_owned(), technique.name().to_owned()]);
    }
    words
}
