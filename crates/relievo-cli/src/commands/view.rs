use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use anyhow::{Result, bail};
use clap::Args;
use relievo_scene::{AnimatedScene, Scene, SurfaceTechnique};
use relievo_viewer::{Film, FrameTimes, Message, Options, SceneFile, ViewerError, run as open_window};

use crate::console::{Console, WrongUsage, print, with_causes};
use crate::memory::check_room;
use crate::scene_args::{MACHINE, OUTPUT, SCENE, SceneArguments, refused, technique_parser, whole_number};

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
    let opened = Arc::new(arguments.scene.open()?);
    let mut scene = opened.at(arguments.scene.time).map_err(refused)?;
    for note in &scene.notes {
        console.note(note);
    }
    prepare(&mut scene, &arguments.scene, arguments.technique);
    // What is drawn at other times is that of the file as it was loaded last.
    let current = Arc::new(Mutex::new(Arc::clone(&opened)));
    let (width, height) = (scene.image.width, scene.image.height);
    check_room(
        u64::from(width) * u64::from(height) * BYTES_PER_PIXEL,
        &format!("windows of {width}×{height} pixels"),
        "a smaller --size",
    )?;
    let file =
        arguments.scene.path().map(|path| SceneFile { path: path.to_owned(), load: reload(arguments, &current) });
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
        film: opened.is_animated().then(|| film(arguments, &current)),
        time: arguments.scene.time,
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

/// The changes that the command line asks for.
fn prepare(scene: &mut Scene, arguments: &SceneArguments, technique: Option<SurfaceTechnique>) {
    arguments.prepare(scene);
    if let Some(technique) = technique {
        for material in scene.materials.iter_mut().filter(|material| !material.is_mist()) {
            material.relief.technique = technique;
        }
    }
}

/// The scene file as it was loaded last.
type Current = Arc<Mutex<Arc<AnimatedScene>>>;

/// Loads the scene anew, for a thread of its own.
fn reload(arguments: &Arguments, current: &Current) -> Arc<dyn Fn() -> Result<Scene, String> + Send + Sync> {
    let (arguments, technique, current) = (arguments.scene.clone(), arguments.technique, Arc::clone(current));
    let load = move || {
        let opened = arguments.open()?;
        let mut scene = opened.at(arguments.time).map_err(refused)?;
        prepare(&mut scene, &arguments, technique);
        *current.lock().unwrap_or_else(PoisonError::into_inner) = Arc::new(opened);
        Ok(scene)
    };
    Arc::new(move || load().map_err(|error: anyhow::Error| with_causes(&error)))
}

/// Loads the scene at other times.
fn film(arguments: &Arguments, current: &Current) -> Film {
    let (arguments, technique, current) = (arguments.scene.clone(), arguments.technique, Arc::clone(current));
    Arc::new(move |time| {
        let opened = Arc::clone(&current.lock().unwrap_or_else(PoisonError::into_inner));
        let mut scene = opened.at_without_heights(time).map_err(|error| error.to_string())?;
        prepare(&mut scene, &arguments, technique);
        Ok(scene)
    })
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
