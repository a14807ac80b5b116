//! Relievo's window: shows a scene and lets its user change camera, relief, technique, shadow, mesh and light.
//!
//! ```text
//!  winit events ─┐            ┌─▶ State (the scene with its changes) ──Change──▶ Stage (relievo-gpu) ──▶ surface
//!                ├─▶ Input ──▶ Controls                                          │                      └▶ screenshot
//!  script lines ─┘            └─▶ Command (quit, screenshot, …)                  └▶ milliseconds, fetches ─▶ title
//! ```
//!
//! Events of a window and lines of a [`Script`] both become [`Input`] and take one path from there. Camera, lights, commands
//! and state know no window system: `window` and `session` do.
//!
//! # State and limits
//! - A native window on X11, Wayland, Windows and macOS; a browser is not supported yet.
//! - One window per program, opened on the main thread ([`run`]).
//! - Adapters are those that wgpu finds, best first; without one the window says so.
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

mod control;
mod error;
mod frame;
mod input;
mod options;
mod session;
mod state;
mod window;

pub use control::camera::{orbit, pan, walk, zoom};
pub use control::commands::{Command, command, help, walk_direction};
pub use control::controls::Controls;
pub use error::ViewerError;
pub use frame::times::{FrameTime, FrameTimes};
pub use input::event::{Button, Input, Key, Modifiers};
pub use input::script::{SCRIPT_STEPS, Script, ScriptError};
pub use options::{Film, Message, Options, Summary};
pub use state::scene_state::{Change, State};
pub use window::event_loop::run;
pub use window::watch::SceneFile;
