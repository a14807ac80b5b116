//! A folder to run the binary in, and what a run came to.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;

/// Nothing that these tests ask for takes longer, not even when the machine is busy.
const PATIENCE: Duration = Duration::from_secs(30);

/// The picture that stood in `out.png` before the run.
pub(crate) const KNOWN: &[u8] = b"bytes that must not change";

/// A small scene without files: a generated wall under a sun.
pub(crate) const SCENE: &str = r#"
[image]
width = 64
height = 48
[camera]
position = [-0.9, -0.5, 1.3]
vertical_fov = 48.0
[[lights]]
kind = "directional"
direction = [-0.7, -0.5, -0.55]
[materials.wall]
from = "make:brick-wall"
[materials.wall.relief]
shadow = "exact"
[[objects]]
mesh = "quad"
material = "wall"
"#;

/// A folder of its own, which goes away with it. `scene.toml` and `out.png` are in it.
pub(crate) struct Room(TempDir);

/// The end of a run.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Outcome {
    /// Fails if a line on stderr is not a note of ours, but a library's.
    #[track_caller]
    #[cfg(any(feature = "gpu", feature = "view"))]
    pub(crate) fn assert_only_notes(&self) {
        let stray: Vec<&str> = self.stderr.lines().filter(|line| !line.starts_with("note: ")).collect();
        assert!(self.code == Some(0) && stray.is_empty(), "{self:?}");
    }
}

impl Room {
    pub(crate) fn new() -> Self {
        let room = Self(tempfile::tempdir().unwrap());
        room.write("scene.toml", SCENE);
        room.write("out.png", KNOWN);
        room
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file, and the folders it is in.
    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }

    /// Takes a file or a folder away, if it is there.
    pub(crate) fn remove(&self, name: &str) {
        let path = self.path(name);
        if path.is_dir() {
            fs::remove_dir_all(path).unwrap();
        } else if path.exists() {
            fs::remove_file(path).unwrap();
        }
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub(crate) fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_slice(&self.read(name)).unwrap()
    }

    pub(crate) fn picture(&self, name: &str) -> image::RgbImage {
        image::open(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}")).into_rgb8()
    }

    /// Every file and folder in the room, by its path.
    pub(crate) fn names(&self) -> Vec<String> {
        let mut names = Vec::new();
        let mut folders = vec![self.0.path().to_owned()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                names.push(path.strip_prefix(self.0.path()).unwrap().to_string_lossy().into_owned());
                if path.is_dir() && !path.is_symlink() {
                    folders.push(path);
                }
            }
        }
        names.sort();
        names
    }

    /// The binary, about to run here.
    pub(crate) fn command<S: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = S>) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_relievo"));
        command.args(arguments).current_dir(self.0.path()).stdin(Stdio::null());
        // The same on every machine: without GPUs, unless a test asks for them.
        command.env("WGPU_BACKEND", "noop");
        // As on a machine without a desktop, about which libraries would complain.
        command.env_remove("XDG_RUNTIME_DIR");
        command
    }

    /// Runs the binary here, with the GPUs that the machine has.
    #[cfg(feature = "gpu")]
    pub(crate) fn run_with_gpus(&self, arguments: &str) -> Outcome {
        let mut command = self.command(arguments.split_whitespace());
        command.env_remove("WGPU_BACKEND");
        outcome(command, PATIENCE)
    }

    /// Runs the binary here.
    pub(crate) fn run<S: AsRef<OsStr>>(&self, arguments: impl IntoIterator<Item = S>) -> Outcome {
        outcome(self.command(arguments), PATIENCE)
    }

    /// Runs a command that may take this long.
    #[cfg(feature = "view")]
    pub(crate) fn run_command(&self, command: Command, patience: Duration) -> Outcome {
        outcome(command, patience)
    }

    /// Runs the binary with arguments that are separated by spaces, and expects success.
    #[track_caller]
    pub(crate) fn ok(&self, arguments: &str) -> Outcome {
        let outcome = self.run(arguments.split_whitespace());
        assert_eq!(outcome.code, Some(0), "{arguments}: {}", outcome.stderr);
        outcome
    }
}

fn outcome(mut command: Command, patience: Duration) -> Outcome {
    // Files, not pipes: a full pipe would stop the child before its time is up. Elsewhere: they are no leftovers.
    let outside = tempfile::tempdir().unwrap();
    let file = |name: &str| outside.path().join(name);
    command.stdout(File::create(file("stdout")).unwrap()).stderr(File::create(file("stderr")).unwrap());
    let code = wait(command.spawn().unwrap(), patience);
    let text = |name| String::from_utf8(fs::read(file(name)).unwrap()).unwrap();
    Outcome { code, stdout: text("stdout"), stderr: text("stderr") }
}

/// The exit code; `None` if the run had to be ended, by us or by a signal.
fn wait(mut child: Child, patience: Duration) -> Option<i32> {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().unwrap() {
            return status.code();
        }
        if start.elapsed() > patience {
            child.kill().unwrap();
            child.wait().unwrap();
            return None;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}
