//! Relievo's window: look at a scene, turn it, and change its relief, technique, shadow, mesh and light.
//!
//! ```text
//!  winit events ─┐            ┌─▶ State (the scene with its changes) ──Change──▶ Stage (relievo-gpu) ──▶ surface
//!                ├─▶ Input ──▶ Controls                                          │                      └▶ screenshot
//!  script lines ─┘            └─▶ Command (quit, screenshot, …)                  └▶ milliseconds, fetches ─▶ title
//! ```
//!
//! What a user does becomes [`Input`], whether a window or a [`Script`] says it, and goes one way from there. Camera, lights,
//! commands and state know no window system: `window` alone does.
//!
//! ```no_run
//! use std::path::Path;
//!
//! use relievo_scene::{LoadOptions, Scene};
//! use relievo_viewer::{Options, run};
//!
//! let scene = Scene::load(Path::new("scenes/wall.toml"), &LoadOptions::default())?;
//! run(scene, Options { title: "wall".to_owned(), ..Options::default() })?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod camera_control;
mod commands;
mod controls;
mod display;
mod edits;
mod error;
mod frame_times;
mod input;
mod light_control;
mod picture;
mod screen;
mod screenshot;
mod script;
mod session;
mod stage;
mod state;
mod timer;
mod title;
mod watch;
mod window;

use std::path::PathBuf;

pub use camera_control::{orbit, pan, walk, zoom};
pub use commands::{Command, command, help, walks};
pub use controls::Controls;
pub use error::ViewerError;
pub use frame_times::{FrameTime, FrameTimes};
pub use input::{Button, Input, Key, Modifiers};
pub use script::{SCRIPT_STEPS, Script, ScriptError};
pub use state::{Change, State};
pub use watch::SceneFile;
pub use window::run;

/// What to show, and how.
pub struct Options {
    /// The scene's name, for the title and screenshots.
    pub title: String,
    /// Its file, to be loaded again when it changes.
    pub file: Option<SceneFile>,
    /// A part of the adapter's name; `None`: the one most likely to be fast.
    pub adapter: Option<String>,
    /// Close after this many frames, drawn as fast as it goes.
    pub frames: Option<u32>,
    /// Play this [`Script`] instead of listening to mouse and keys, and close at its end.
    pub script: Option<PathBuf>,
    /// The folder of screenshots.
    pub screenshots: PathBuf,
    /// The command that draws the scene as it was loaded, for the one that draws it as it is shown.
    pub command: Vec<String>,
    /// Hears what there is to say.
    pub talk: Box<dyn Fn(Message<'_>)>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            title: "scene".to_owned(),
            file: None,
            adapter: None,
            frames: None,
            script: None,
            screenshots: PathBuf::from("."),
            command: ["relievo", "render"].map(str::to_owned).to_vec(),
            talk: Box::new(|_| {}),
        }
    }
}

/// Something to say to who started the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Message<'a> {
    /// What was asked for.
    Print(&'a str),
    /// Worth knowing.
    Note(&'a str),
    /// Something failed, and the window goes on.
    Error(&'a str),
}

/// How a session went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// How long frames took; `None` if none was drawn.
    pub times: Option<FrameTimes>,
}
