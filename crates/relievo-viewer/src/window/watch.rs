//! Loading a scene again when its file changes.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, SystemTime};

use relievo_scene::Scene;

/// Period of looking at the file.
const PERIOD: Duration = Duration::from_millis(500);

/// A scene file that may change while it is shown.
#[derive(Clone)]
pub struct SceneFile {
    /// The file that is watched.
    pub path: PathBuf,
    /// Loads it, or says in one line why it cannot.
    pub load: Arc<dyn Fn() -> Result<Scene, String> + Send + Sync>,
}

/// Tells a changed file from an unchanged one.
type Stamp = Option<(SystemTime, u64)>;

fn stamp(path: &Path) -> Stamp {
    let file = fs::metadata(path).ok()?;
    Some((file.modified().ok()?, file.len()))
}

/// Loads the file whenever it changed, in a thread of its own, until `send` returns false.
pub(crate) fn watch(file: SceneFile, send: impl Fn(Result<Scene, String>) -> bool + Send + 'static) {
    let mut watch = Watch::new(stamp(&file.path));
    let look = move || {
        loop {
            thread::sleep(PERIOD);
            if watch.changed(stamp(&file.path)) && !send((file.load)()) {
                return;
            }
        }
    };
    // Without a thread there is no reloading; the window works all the same.
    drop(thread::Builder::new().name("scene file".to_owned()).spawn(look));
}

/// Finds changes that are over: a file that is still being written is not read.
struct Watch {
    loaded: Stamp,
    before: Stamp,
}

impl Watch {
    fn new(loaded: Stamp) -> Self {
        Self { loaded, before: loaded }
    }

    /// True if the file is to be loaded, now that it has this stamp.
    fn changed(&mut self, now: Stamp) -> bool {
        let rests = now == self.before;
        self.before = now;
        // A file that is away is being replaced.
        if !rests || now.is_none() || now == self.loaded {
            return false;
        }
        self.loaded = now;
        true
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc;

    use relievo_scene::LoadOptions;

    use super::*;

    #[test]
    fn a_file_is_loaded_once_it_changed_and_rests() {
        let at = |seconds, bytes| Some((SystemTime::UNIX_EPOCH + Duration::from_secs(seconds), bytes));
        let mut watch = Watch::new(at(1, 10));
        let seen = [
            (at(1, 10), false),
            (at(2, 5), false), // being written
            (at(2, 12), false),
            (at(2, 12), true),
            (at(2, 12), false),
            (None, false), // being replaced
            (None, false),
            (at(3, 12), false),
            (at(3, 12), true),
            (None, false),
            (at(3, 12), false), // the same again
            (at(3, 12), false),
        ];
        for (number, (stamp, expected)) in seen.into_iter().enumerate() {
            assert_eq!(watch.changed(stamp), expected, "{number}");
        }
    }

    #[test]
    fn a_changed_scene_arrives_and_a_broken_one_as_its_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("s.toml");
        let text = |width: u32| {
            format!("image.width = {width}\nmaterials.a.from = \"make:brick-wall\"\n[[objects]]\nmesh = \"quad\"")
        };
        fs::write(&path, text(100)).unwrap();
        let options = LoadOptions { make_size: 16, ..LoadOptions::default() };
        let (from, (sender, receiver)) = (path.clone(), mpsc::channel());
        let load = move || Scene::load(&from, &options).map_err(|error| error.to_string());
        watch(SceneFile { path: path.clone(), load: Arc::new(load) }, move |loaded| sender.send(loaded).is_ok());
        let next = || receiver.recv_timeout(Duration::from_secs(20)).unwrap();
        fs::write(&path, text(2000)).unwrap();
        assert_eq!(next().unwrap().image.width, 2000);
        fs::write(&path, "[camera]\nfov = 3").unwrap();
        assert!(next().unwrap_err().contains("s.toml:2: unknown key"));
        fs::write(&path, text(30)).unwrap();
        assert_eq!(next().unwrap().image.width, 30);
    }
}
