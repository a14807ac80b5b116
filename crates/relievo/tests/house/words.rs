//! The retired words: names that nobody in this field knew. CHANGELOG.md says what took their place.

use proc_macro2::{TokenStream, TokenTree};

use crate::source::Source;

/// Words that are no identifiers any more, in any crate.
const RETIRED: &[&str] = &[
    "ahead",
    "Among",
    "Arrivals",
    "Bench",
    "Coding",
    "Contender",
    "Cost",
    "Crossing",
    "Eye",
    "facing",
    "FEW",
    "Field",
    "gather",
    "GATHERINGS",
    "Heights",
    "how",
    "Job",
    "Judge",
    "Kernel",
    "Kind",
    "leave",
    "Look",
    "March",
    "mixed",
    "pace",
    "PassTo",
    "Patchwork",
    "Place",
    "placed",
    "Plan",
    "rise",
    "risen",
    "Row",
    "Rows",
    "sight",
    "Specimen",
    "Spread",
    "Studio",
    "Surroundings",
    "Thing",
    "toward",
    "Verdict",
    "Waiting",
    "Walk",
    "way",
    "Windows",
];

/// Words that are the field's own elsewhere (a mouse button, a key, a unit, the lab's sweeps, an image's border, a command),
/// with the crates in which they are retired.
const RETIRED_IN: &[(&str, &[&str])] = &[
    ("border", &["relievo-march", "relievo-shader"]),
    ("codes", &["relievo-march", "relievo-shader", "relievo-gpu"]),
    ("Left", &["relievo-march"]),
    ("next", &["relievo-march", "relievo-shader"]),
    ("shift", &["relievo-march", "relievo-shader", "relievo-gpu", "relievo-cpu", "relievo-scene"]),
    ("sweep", &["relievo-march", "relievo-shader", "relievo-gpu", "relievo-cpu"]),
    ("Texels", &["relievo-march", "relievo-shader", "relievo-gpu", "relievo-cpu"]),
    ("turn", &["relievo-march", "relievo-shader", "relievo-gpu", "relievo-cpu", "relievo-scene"]),
    ("View", &["relievo-march", "relievo-shader", "relievo-gpu", "relievo-cpu", "relievo-scene", "relievo-viewer"]),
];

fn is_retired(krate: &str, word: &str) -> bool {
    RETIRED.contains(&word) || RETIRED_IN.iter().any(|(retired, crates)| *retired == word && crates.contains(&krate))
}

/// The places where a file has a retired word for an identifier.
pub(crate) fn retired(source: &Source) -> Vec<String> {
    let mut found = Vec::new();
    if source.tree.is_some() {
        in_tokens(source, source.tokens(), &mut found);
    } else {
        for (number, line) in source.wgsl_code().lines().enumerate() {
            for word in line.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|w| is_retired(&source.krate, w))
            {
                found.push(format!("{}/{}:{}: {word}", source.krate, source.path, number + 1));
            }
        }
    }
    found
}

fn in_tokens(source: &Source, tokens: TokenStream, found: &mut Vec<String>) {
    // `Iterator::next`, called or implemented.
    let mut may_be_next = false;
    for token in tokens {
        match &token {
            TokenTree::Group(group) => in_tokens(source, group.stream(), found),
            TokenTree::Ident(ident) => {
                let word = ident.to_string();
                if is_retired(&source.krate, &word) && !(word == "next" && may_be_next) {
                    found.push(format!("{}/{}:{}: {word}", source.krate, source.path, ident.span().start().line));
                }
            }
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
        may_be_next = match &token {
            TokenTree::Punct(punct) => punct.as_char() == '.' || punct.as_char() == ':',
            TokenTree::Ident(ident) => ident == "fn",
            _ => false,
        };
    }
}
