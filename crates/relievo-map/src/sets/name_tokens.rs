//! The words and numbers in a file name.

/// A part of a file name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum NameToken {
    /// Letters or digits, lower case.
    Word(String),
    /// `2K`, `2048`, `2048x2048`.
    Resolution(u32),
}

impl NameToken {
    /// The word, if it is one.
    pub(super) fn word(&self) -> Option<&str> {
        if let Self::Word(word) = self { Some(word) } else { None }
    }
}

/// Cuts a name at separators, at humps (`NormalGL`) and between letters and digits.
pub(super) fn tokenize(stem: &str) -> Vec<NameToken> {
    let chars: Vec<char> = stem.chars().collect();
    let mut words: Vec<String> = Vec::new();
    let mut open = false;
    for (i, &c) in chars.iter().enumerate() {
        if !c.is_alphanumeric() {
            open = false;
            continue;
        }
        if let (true, Some(&before)) = (open, i.checked_sub(1).and_then(|i| chars.get(i))) {
            let hump = c.is_uppercase()
                && (before.is_lowercase()
                    || before.is_uppercase() && chars.get(i + 1).is_some_and(|after| after.is_lowercase()));
            open = !hump && before.is_numeric() == c.is_numeric();
        }
        if !open {
            words.push(String::new());
            open = true;
        }
        if let Some(word) = words.last_mut() {
            word.extend(c.to_lowercase());
        }
    }
    let mut tokens = Vec::new();
    let mut rest = words.as_slice();
    while let [first, after @ ..] = rest {
        let number: Option<u32> = first.parse().ok();
        let (token, left) = match (number, after) {
            (Some(n @ 1..=64), [k, after @ ..]) if k == "k" => (NameToken::Resolution(n * 1024), after),
            (Some(n), [x, m, after @ ..]) if x == "x" && m.parse::<u32>().is_ok() => {
                (NameToken::Resolution(n.max(m.parse().unwrap_or(0))), after)
            }
            (Some(n), [px, after @ ..]) if px == "px" => (NameToken::Resolution(n), after),
            (Some(n @ (256 | 512 | 1024 | 2048 | 4096 | 8192 | 16384)), after) => (NameToken::Resolution(n), after),
            (_, after) => (NameToken::Word(first.clone()), after),
        };
        tokens.push(token);
        rest = left;
    }
    tokens
}

/// True for words that say nothing about the map or the material: file formats, ways of making.
pub(super) fn is_noise(word: &str) -> bool {
    const NOISE: &[&str] = &[
        "jpg", "jpeg", "png", "exr", "tif", "tiff", "tga", "bmp", "webp", "hdr", "bit", "bits", "var", "lod", "udim",
        "seamless", "tileable", "tiled", "linear", "srgb", "raw", "copy", "lossless", "final",
    ];
    NOISE.contains(&word)
}
