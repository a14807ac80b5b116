//! Names for screenshots.

use std::path::{Path, PathBuf};

/// More screenshots than this are not looked for.
const MAX_NUMBER: u32 = 99_999;

/// The first of `scene-001.png`, `scene-002.png`, … that is not there yet; `None` if all are.
pub(crate) fn free_name(folder: &Path, scene: &str) -> Option<PathBuf> {
    let usable = |c: char| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '-' };
    let stem: String = scene.chars().map(usable).take(100).collect();
    let names = (1..=MAX_NUMBER).map(|number| folder.join(format!("{stem}-{number:03}.png")));
    // A link to nowhere is there, too.
    names.into_iter().find(|path| path.symlink_metadata().is_err())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_there_is_never_named() {
        let folder = tempfile::tempdir().unwrap();
        let name = |scene| free_name(folder.path(), scene).unwrap().file_name().unwrap().to_owned();
        assert_eq!(name("wall"), "wall-001.png");
        std::fs::write(folder.path().join("wall-001.png"), "").unwrap();
        std::fs::create_dir(folder.path().join("wall-002.png")).unwrap();
        assert_eq!(name("wall"), "wall-003.png");
        assert_eq!(name("the built-in wall"), "the-built-in-wall-001.png");
        assert_eq!(name("../a/b"), "..-a-b-001.png");
    }
}
