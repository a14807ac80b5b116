/// Replaces the characters that are not fit for file names on every system.
pub(super) fn file_name(text: &str) -> String {
    text.chars().map(|c| if c.is_alphanumeric() || "-_+".contains(c) { c } else { '-' }).collect()
}
