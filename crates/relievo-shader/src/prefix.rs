//! Names of the shaders under a prefix of the embedder's, so that two reliefs stand in one shader.

use crate::error::ComposeError;

/// Renames everything of ours in a WGSL text: with the prefix `wall`, `relievo_march` becomes `wall_march`, `RelievoRay`
/// becomes `WallRay` and `RELIEVO_HUGE` becomes `WALL_HUGE`. Other names stay: all names of this crate, and none else, begin
/// with `relievo_`, `Relievo` or `RELIEVO_`.
///
/// # Errors
/// If the prefix is not made of lower-case words joined by single underscores.
pub fn with_prefix(wgsl: &str, prefix: &str) -> Result<String, ComposeError> {
    let words: Vec<&str> = prefix.split('_').collect();
    let is_word = |word: &&str| !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit());
    if !words.iter().all(is_word) || !prefix.starts_with(|c: char| c.is_ascii_lowercase()) {
        return Err(ComposeError::InvalidPrefix(prefix.to_owned()));
    }
    let camel: String = words.iter().map(|word| capitalised(word)).collect();
    let forms =
        [("relievo_", format!("{prefix}_")), ("Relievo", camel), ("RELIEVO_", format!("{}_", prefix.to_uppercase()))];
    let mut renamed = String::with_capacity(wgsl.len());
    let mut rest = wgsl;
    let mut in_word = false;
    while let Some(letter) = rest.chars().next() {
        let form = forms.iter().find(|(ours, _)| !in_word && starts_name(rest, ours));
        if let Some((ours, theirs)) = form {
            renamed.push_str(theirs);
            rest = &rest[ours.len()..];
            in_word = true;
        } else {
            renamed.push(letter);
            rest = &rest[letter.len_utf8()..];
            in_word = letter.is_ascii_alphanumeric() || letter == '_';
        }
    }
    Ok(renamed)
}

/// True if a name of ours begins here, and not the word alone.
fn starts_name(text: &str, ours: &str) -> bool {
    text.strip_prefix(ours).is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_alphanumeric()))
}

fn capitalised(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_ascii_uppercase().to_string() + letters.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_ours_and_no_others_get_the_prefix() {
        let wgsl = "fn relievo_march(r: RelievoRay) -> f32 { return RELIEVO_HUGE + my_relievo_x + unrelievo_y; } // Relievo relievo-march";
        let renamed = with_prefix(wgsl, "left_wall").unwrap();
        assert_eq!(
            renamed,
            "fn left_wall_march(r: LeftWallRay) -> f32 { return LEFT_WALL_HUGE + my_relievo_x + unrelievo_y; } // Relievo relievo-march"
        );
        assert_eq!(with_prefix(wgsl, "relievo").unwrap(), wgsl);
    }

    #[test]
    fn prefixes_that_make_no_names_are_refused() {
        for prefix in ["", "_", "Wall", "wall_", "_wall", "two__walls", "2walls", "wänd", "a b"] {
            assert_eq!(with_prefix("", prefix), Err(ComposeError::InvalidPrefix(prefix.to_owned())), "{prefix:?}");
        }
    }
}
