//! The workspace's Rust and WGSL files, read once.

use std::fs;
use std::path::Path;
use std::str::FromStr;

use proc_macro2::{Span, TokenStream};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

/// Words with which a doc comment asks instead of telling.
const QUESTION_WORDS: [&str; 10] =
    ["What", "Whether", "How", "Those", "So many", "Which", "Where", "Who", "When", "So much"];

/// A file of the workspace.
pub struct Source {
    /// The name of its crate.
    pub krate: String,
    /// The path from the crate's folder.
    pub path: String,
    /// True if users get it: not a test, a bench or an example.
    pub is_shipped: bool,
    pub text: String,
    /// The syntax tree; `None` for WGSL.
    pub tree: Option<syn::File>,
}

impl Source {
    pub fn rust(krate: &str, path: &str, text: &str) -> Self {
        let tree = syn::parse_file(text).unwrap_or_else(|error| panic!("{krate}/{path}: {error}"));
        Self { tree: Some(tree), ..Self::wgsl(krate, path, text) }
    }

    pub fn wgsl(krate: &str, path: &str, text: &str) -> Self {
        let is_shipped = !["tests/", "benches/", "examples/"].iter().any(|folder| path.starts_with(folder));
        Self { krate: krate.to_owned(), path: path.to_owned(), is_shipped, text: text.to_owned(), tree: None }
    }

    /// The tokens of a Rust file, doc comments as literals.
    pub fn tokens(&self) -> TokenStream {
        TokenStream::from_str(&self.text).expect("syn has read it before")
    }

    /// The text of a WGSL file without its comments.
    pub fn wgsl_code(&self) -> String {
        self.text.lines().map(|line| line.split("//").next().unwrap_or(line)).collect::<Vec<_>>().join("\n")
    }

    /// The first line of every doc comment, and true if it begins with a question word.
    pub fn doc_comments(&self) -> Vec<(bool, String)> {
        let doc = |line: &str| {
            let line = line.trim_start();
            line.strip_prefix("///").or(line.strip_prefix("//!")).map(|text| text.trim().to_owned())
        };
        let mut comments = Vec::new();
        let mut inside = false;
        for (number, line) in self.text.lines().enumerate() {
            let text = doc(line);
            if let Some(text) = text.as_deref().filter(|text| !inside && !text.is_empty()) {
                let asks = QUESTION_WORDS
                    .iter()
                    .any(|word| text.strip_prefix(word).is_some_and(|rest| !rest.starts_with(char::is_alphanumeric)));
                comments.push((asks, format!("{}/{}:{}: {text}", self.krate, self.path, number + 1)));
            }
            inside = text.is_some();
        }
        comments
    }

    /// The functions outside of test modules, with their lengths in lines.
    pub fn functions(&self) -> Vec<(String, usize)> {
        match &self.tree {
            Some(tree) => {
                let mut functions = Functions(Vec::new());
                functions.visit_file(tree);
                functions.0
            }
            None => wgsl_functions(&self.wgsl_code()),
        }
    }
}

/// True for items that only tests have.
pub fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let text = match &attribute.meta {
            syn::Meta::List(list) if list.path.is_ident("cfg") => list.tokens.to_string(),
            _ => return false,
        };
        text == "test"
    })
}

struct Functions(Vec<(String, usize)>);

impl Functions {
    fn add(&mut self, signature: &syn::Signature, end: Span) {
        let lines = end.end().line + 1 - signature.span().start().line;
        self.0.push((signature.ident.to_string(), lines));
    }
}

impl<'a> Visit<'a> for Functions {
    fn visit_item_mod(&mut self, module: &'a syn::ItemMod) {
        if !is_test(&module.attrs) {
            visit::visit_item_mod(self, module);
        }
    }

    fn visit_item_fn(&mut self, function: &'a syn::ItemFn) {
        self.add(&function.sig, function.block.span());
        visit::visit_item_fn(self, function);
    }

    fn visit_impl_item_fn(&mut self, function: &'a syn::ImplItemFn) {
        self.add(&function.sig, function.block.span());
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_trait_item_fn(&mut self, function: &'a syn::TraitItemFn) {
        if let Some(block) = &function.default {
            self.add(&function.sig, block.span());
        }
    }
}

/// WGSL knows functions at the outermost level alone, and each ends with a brace in the first column.
fn wgsl_functions(code: &str) -> Vec<(String, usize)> {
    let lines: Vec<&str> = code.lines().collect();
    let starts = lines.iter().enumerate().filter_map(|(k, line)| Some((k, line.strip_prefix("fn ")?)));
    starts
        .map(|(k, rest)| {
            let name = rest.split('(').next().unwrap_or(rest).to_owned();
            let length = lines[k..].iter().position(|line| line.starts_with('}') || line.ends_with(" }"));
            (name, length.map_or(lines.len() - k, |length| length + 1))
        })
        .collect()
}

/// All files of all crates.
pub fn sources() -> Vec<Source> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the crates have a folder");
    let mut sources = Vec::new();
    let mut names: Vec<_> = fs::read_dir(crates).expect("the folder of crates").map(|entry| entry.unwrap().path()).collect();
    names.sort();
    for folder in names.iter().filter(|folder| folder.join("Cargo.toml").is_file()) {
        read_folder(folder, folder, &mut sources);
    }
    assert!(sources.len() > 300, "only {} files were found", sources.len());
    sources
}

fn read_folder(krate: &Path, folder: &Path, sources: &mut Vec<Source>) {
    let mut entries: Vec<_> = fs::read_dir(folder).expect("a folder").map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            read_folder(krate, &path, sources);
            continue;
        }
        let name = krate.file_name().expect("a name").to_string_lossy();
        let inside = path.strip_prefix(krate).expect("inside").to_string_lossy().replace('\\', "/");
        let read = || fs::read_to_string(&path).expect("UTF-8");
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("rs") => sources.push(Source::rust(&name, &inside, &read())),
            Some("wgsl") => sources.push(Source::wgsl(&name, &inside, &read())),
            _ => {}
        }
    }
}
