use std::path::{Path, PathBuf};

use relievo_map::FilmFormat;

use crate::outputs::extension;

/// The files that an animation is written to.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum FrameFiles {
    /// A file for each frame: what stands before the number, its digits at least, and what stands after.
    Numbered { before: String, digits: usize, after: String },
    /// One file for all.
    Film(FilmFormat, PathBuf),
}

impl FrameFiles {
    /// Reads the name of the output; the fault in words.
    pub(super) fn parse(output: &Path) -> Result<Self, String> {
        match extension(output).as_str() {
            "apng" => return Ok(Self::Film(FilmFormat::Apng, output.to_owned())),
            "webp" => return Ok(Self::Film(FilmFormat::Webp, output.to_owned())),
            _ => {}
        }
        const EXPECTED: &str = "an animation needs a file for each frame, with the number's place in its name as in \
                                frames/%04d.png, or one film that ends in .apng or .webp";
        let Some(text) = output.to_str() else { return Err("the name is no text in UTF-8".to_owned()) };
        let Some((before, rest)) = text.split_once('%') else { return Err(EXPECTED.to_owned()) };
        let digits = rest.trim_start_matches(|c: char| c.is_ascii_digit());
        let (width, after) = (&rest[..rest.len() - digits.len()], digits.strip_prefix('d').ok_or(EXPECTED)?);
        if after.contains('%') {
            return Err("there is one number in the name of a frame, as in frames/%04d.png".to_owned());
        }
        if after.contains('/') {
            return Err("the number belongs into the name of the file, not of its folder".to_owned());
        }
        let digits =
            if width.is_empty() { 1 } else { width.parse().ok().filter(|digits| *digits <= 20).ok_or(EXPECTED)? };
        Ok(Self::Numbered { before: before.to_owned(), digits, after: after.to_owned() })
    }

    /// The file of a frame.
    pub(super) fn path(&self, number: u32) -> PathBuf {
        match self {
            Self::Film(_, path) => path.clone(),
            Self::Numbered { before, digits, after } => PathBuf::from(format!("{before}{number:0digits$}{after}")),
        }
    }

    /// The folder of the files.
    pub(super) fn folder(&self) -> PathBuf {
        let path = self.path(0);
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        folder.map_or_else(|| PathBuf::from("."), Path::to_owned)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<FrameFiles, String> {
        FrameFiles::parse(Path::new(text))
    }

    #[test]
    fn frames_are_numbered_as_in_c() {
        let path = |text: &str, number| parse(text).unwrap().path(number);
        assert_eq!(path("frames/%04d.png", 7), Path::new("frames/0007.png"));
        assert_eq!(path("frames/%04d.png", 123_456), Path::new("frames/123456.png"));
        assert_eq!(path("a%d-b.png", 12), Path::new("a12-b.png"));
        assert_eq!(parse("a%d.png").unwrap().folder(), Path::new("."));
        assert_eq!(parse("x/loop.APNG").unwrap(), FrameFiles::Film(FilmFormat::Apng, "x/loop.APNG".into()));
        for bad in ["frame.png", "%4x.png", "%.png", "%d%d.png", "f%d/a.png", "%99999999999d.png", "%-4d.png"] {
            assert!(parse(bad).is_err(), "{bad}");
        }
    }
}
