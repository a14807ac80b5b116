//! Checks the source of the whole workspace: words, sentences, the length of functions, and circles of modules.
//!
//! Every check has a negative control: a small source that it must refuse.

mod circles;
mod source;
mod words;

use source::{Source, sources};

/// The longest function outside tests, in lines from `fn` to its closing brace.
const LONGEST: usize = 80;

/// The largest share of doc comments that may begin with a question word.
const QUESTIONS: f64 = 0.03;

#[test]
fn no_retired_word_is_an_identifier() {
    let found: Vec<String> = sources().iter().flat_map(words::retired).collect();
    assert!(found.is_empty(), "retired words in code:\n{}", found.join("\n"));

    let control = Source::rust("relievo-march", "control.rs", "fn march(how: u8) -> u8 { how } // how is fine here");
    assert_eq!(words::retired(&control).len(), 2);
    let control = Source::wgsl("relievo-shader", "control.wgsl", "// the pace\nlet pace = 1.0;");
    assert_eq!(words::retired(&control).len(), 1);
    let iterator = Source::rust("relievo-march", "control.rs", "fn f(x: &mut I) { x.next(); }");
    assert!(words::retired(&iterator).is_empty());
}

#[test]
fn doc_comments_begin_with_a_noun_or_a_verb() {
    let comments: Vec<(bool, String)> = sources().iter().flat_map(Source::doc_comments).collect();
    let questions: Vec<&str> = comments.iter().filter(|(asks, _)| *asks).map(|(_, text)| text.as_str()).collect();
    let share = questions.len() as f64 / comments.len() as f64;
    assert!(share <= QUESTIONS, "{:.1} % begin with a question word:\n{}", 100.0 * share, questions.join("\n"));

    let control =
        Source::rust("relievo-march", "control.rs", "/// How it goes.\nfn f() {}\n/// Goes.\n/// How?\nfn g() {}");
    assert_eq!(control.doc_comments().iter().map(|(asks, _)| *asks).collect::<Vec<_>>(), [true, false]);
}

#[test]
fn no_function_is_longer_than_a_screen() {
    let long = |source: &Source| -> Vec<String> {
        let functions = source.functions().into_iter().filter(|(_, lines)| *lines > LONGEST);
        functions.map(|(name, lines)| format!("{}: {name} has {lines} lines", source.path)).collect()
    };
    let found: Vec<String> = sources().iter().filter(|source| source.is_shipped).flat_map(long).collect();
    assert!(found.is_empty(), "functions of over {LONGEST} lines:\n{}", found.join("\n"));

    let body = "let _ = 0;\n".repeat(LONGEST - 2);
    let control = format!("impl S {{\n fn at_most() {{\n{body}}}\n fn over() {{\n{body}\n}}\n}}");
    assert_eq!(long(&Source::rust("relievo-march", "control.rs", &control)), ["control.rs: over has 81 lines"]);
    let control = format!("fn over() -> f32 {{\n{body}\n}}\n");
    assert_eq!(long(&Source::wgsl("relievo-shader", "control.wgsl", &control)), ["control.wgsl: over has 81 lines"]);
}

#[test]
fn no_modules_form_a_circle() {
    let found = circles::circles(&sources());
    assert!(found.is_empty(), "modules that need each other:\n{}", found.join("\n"));

    let file = |path, text| Source::rust("relievo-march", path, text);
    let control = [
        file("src/lib.rs", "mod a; mod b; mod c; pub use b::Thing;"),
        file("src/a.rs", "use crate::Thing; pub struct Other;"),
        file("src/b.rs", "pub struct Thing; fn f() { crate::c::g() }"),
        file("src/c.rs", "use super::a::Other; pub fn g() {}"),
    ];
    assert_eq!(circles::circles(&control), ["relievo-march: a, b, c"]);
    // A test may look at what it tests.
    let harmless = [
        file("src/lib.rs", "mod a; mod b;"),
        file("src/a.rs", "use crate::b::B; #[cfg(test)] mod tests { use crate::b::B; }"),
        file("src/b.rs", "pub struct B; #[cfg(test)] mod tests { use crate::a; }"),
    ];
    assert!(circles::circles(&harmless).is_empty());
}
