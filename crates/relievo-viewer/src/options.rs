use std::path::PathBuf;
use std::sync::Arc;

use relievo_scene::{Scene, SceneTime};

use crate::frame::times::FrameTimes;
use crate::window::watch::SceneFile;

/// Loads the scene at a time, or says in one line why it cannot. Heights that change are left to the renderer
/// (`AnimatedScene::at_without_heights`).
pub type Film = Arc<dyn Fn(SceneTime) -> Result<Scene, String> + Send + Sync>;

/// Options of a window.
pub struct Options {
    /// The scene's name, for the title and screenshots.
    pub title: String,
    /// Its file, to be loaded again when it changes.
    pub file: Option<SceneFile>,
    /// The scene at other times; `None`: it stands still.
    pub film: Option<Film>,
    /// The time at which the scene was loaded.
    pub time: SceneTime,
    /// A part of the adapter's name; `None`: the one most likely to be fast.
    pub adapter: Option<String>,
    /// Close after this many frames, drawn as fast as it goes.
    pub frames: Option<u32>,
    /// Play this [`Script`](crate::Script) instead of listening to mouse and keys, and close at its end.
    pub script: Option<PathBuf>,
    /// The folder of screenshots.
    pub screenshots: PathBuf,
    /// The command that draws the scene as it was loaded, for the one that draws it as it is shown.
    pub command: Vec<String>,
    /// Called with each message.
    pub on_message: Box<dyn Fn(Message<'_>)>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            title: "scene".to_owned(),
            file: None,
            film: None,
            time: SceneTime::default(),
            adapter: None,
            frames: None,
            script: None,
            screenshots: PathBuf::from("."),
            command: ["relievo", "render"].map(str::to_owned).to_vec(),
            on_message: Box::new(|_| {}),
        }
    }
}

/// A message to the program that opened the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Message<'a> {
    /// Output that the user asked for.
    Print(&'a str),
    /// A note.
    Note(&'a str),
    /// An error after which the window goes on.
    Error(&'a str),
}

impl<'a> Message<'a> {
    /// The message's text.
    #[must_use]
    pub fn text(&self) -> &'a str {
        match self {
            Self::Print(text) | Self::Note(text) | Self::Error(text) => text,
        }
    }
}

/// The result of a session.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Frame times; `None` if none was drawn.
    pub times: Option<FrameTimes>,
}
