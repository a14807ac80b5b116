//! Names that were misspelt.

/// `; did you mean "…"?` for the candidate nearest to `name`, or nothing if none is near.
pub(crate) fn did_you_mean<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> String {
    let plain = |name: &str| name.to_lowercase().replace('_', "-");
    let name = plain(name);
    let distance = |candidate: &str| {
        let candidate = plain(candidate);
        // A third of the letters may be wrong, of short names half.
        let length = candidate.chars().count();
        let distance = strsim::damerau_levenshtein(&name, &candidate);
        (distance <= (length / 3).max(2.min(length / 2))).then_some(distance)
    };
    let near = candidates.into_iter().filter_map(|candidate| Some((distance(candidate)?, candidate)));
    near.min_by_key(|&(distance, _)| distance)
        .map_or_else(String::new, |(_, candidate)| format!("; did you mean \"{candidate}\"?"))
}

/// A text fit for one line of a message.
pub(crate) fn shorten(text: &str) -> String {
    let clean: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if clean.chars().count() <= 60 { clean } else { clean.chars().take(59).chain(['…']).collect() }
}
