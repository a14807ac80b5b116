//! Suggestions for misspelt names, and texts for one line of a message.

/// Returns `; did you mean "…"?` with the candidate nearest to `name`, or nothing if none is near.
#[must_use]
pub fn did_you_mean<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let plain = |name: &str| name.to_lowercase().replace('_', "-");
    let name = plain(name);
    let unlikeness = |candidate: &&str| {
        let candidate = plain(candidate);
        let distance = strsim::damerau_levenshtein(&name, &candidate);
        // A third of the letters may be wrong, of short names half; or a whole word may be missing.
        let length = candidate.chars().count();
        let near = distance <= (length / 3).max(2.min(length / 2));
        let part = name.len() >= 3 && candidate.split('-').any(|word| word == name);
        (near || part).then_some((!near, distance))
    };
    let scored = candidates.into_iter().filter_map(|candidate| Some((unlikeness(&candidate)?, candidate)));
    let nearest = scored.min_by_key(|&(unlikeness, _)| unlikeness);
    nearest.map_or_else(String::new, |(_, candidate)| format!("; did you mean \"{candidate}\"?"))
}

/// Makes a text fit for one line of a message: at most 60 characters, no control characters.
#[must_use]
pub fn shorten(text: &str) -> String {
    shorten_to(60, text)
}

/// Cuts a text to `most` characters and replaces control characters.
pub(crate) fn shorten_to(most: usize, text: &str) -> String {
    let clean: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if clean.chars().count() <= most { clean } else { clean.chars().take(most - 1).chain(['…']).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_suggested_and_a_far_one_is_not() {
        assert_eq!(did_you_mean("heigth", ["normal", "height"]), "; did you mean \"height\"?");
        assert_eq!(did_you_mean("fov", ["vertical_fov", "near"]), "; did you mean \"vertical_fov\"?");
        assert_eq!(did_you_mean("Height-Scale", ["height", "height_scale"]), "; did you mean \"height_scale\"?");
        assert_eq!(did_you_mean("zzz", ["up", "near"]), "");
        assert_eq!(did_you_mean("", ["up", "near"]), "");
    }
}
