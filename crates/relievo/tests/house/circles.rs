//! Circles of modules: sets of files that need each other. A file needs those whose items its code names outside of
//! tests; names that a module only re-exports lead to the file that defines them.

use std::collections::{BTreeMap, BTreeSet};

use syn::visit::{self, Visit};

use crate::source::{Source, is_test};

type Module = Vec<String>;

/// What a file defines, hands on and names.
#[derive(Default)]
struct Contents {
    defined: BTreeSet<String>,
    /// Re-exports: the name, and the path it stands for.
    handed_on: BTreeMap<String, Vec<String>>,
    named: Vec<Vec<String>>,
}

/// The circles of every crate, each as "crate: modules".
pub fn circles(sources: &[Source]) -> Vec<String> {
    let mut crates: BTreeMap<&str, BTreeMap<Module, Contents>> = BTreeMap::new();
    for source in sources {
        let (Some(tree), Some(inside)) = (&source.tree, source.path.strip_prefix("src/")) else { continue };
        let mut contents = Contents::default();
        contents.visit_file(tree);
        crates.entry(&source.krate).or_default().insert(module(inside), contents);
    }
    let mut found = Vec::new();
    for (krate, modules) in &crates {
        let needs: BTreeMap<&Module, BTreeSet<Module>> = modules
            .iter()
            .map(|(module, contents)| {
                let needed = contents.named.iter().filter_map(|path| defining(modules, module, path, 0));
                (module, needed.filter(|other| other != module).collect())
            })
            .collect();
        found.extend(components(&needs).iter().map(|circle| format!("{krate}: {}", circle.join(", "))));
    }
    found
}

fn module(path: &str) -> Module {
    let path = path.trim_end_matches(".rs");
    let path = path.strip_suffix("/mod").unwrap_or(path);
    if ["lib", "main"].contains(&path) { Vec::new() } else { path.split('/').map(str::to_owned).collect() }
}

/// The module that defines what `path` names in `module`, if it is one of this crate.
fn defining(modules: &BTreeMap<Module, Contents>, module: &Module, path: &[String], depth: u32) -> Option<Module> {
    // Longer chains of re-exports are circles of their own, which the compiler refuses.
    if depth > 8 {
        return None;
    }
    let mut at = module.clone();
    let mut rest = path;
    match path.first()?.as_str() {
        "crate" => (at, rest) = (Vec::new(), &path[1..]),
        "self" => rest = &path[1..],
        "super" => {
            while rest.first().is_some_and(|name| name == "super") {
                at.pop();
                rest = &rest[1..];
            }
        }
        first => {
            let mut child = at.clone();
            child.push(first.to_owned());
            modules.get(&child)?;
        }
    }
    for name in rest {
        let mut child = at.clone();
        child.push(name.clone());
        if modules.contains_key(&child) {
            at = child;
            continue;
        }
        let here = modules.get(&at)?;
        return match here.handed_on.get(name) {
            Some(target) if !here.defined.contains(name) => defining(modules, &at, target, depth + 1).or(Some(at)),
            _ => Some(at),
        };
    }
    Some(at)
}

/// The strongly connected components of more than one module.
fn components(needs: &BTreeMap<&Module, BTreeSet<Module>>) -> Vec<Vec<String>> {
    let reached = |start: &Module| {
        let (mut reached, mut open) = (BTreeSet::new(), vec![start.clone()]);
        while let Some(module) = open.pop() {
            for other in needs.get(&module).into_iter().flatten() {
                if reached.insert(other.clone()) {
                    open.push(other.clone());
                }
            }
        }
        reached
    };
    let reach: BTreeMap<&Module, BTreeSet<Module>> = needs.keys().map(|&module| (module, reached(module))).collect();
    let mut circles = BTreeSet::new();
    for (&module, others) in reach.iter().filter(|(module, others)| others.contains(**module)) {
        let circle = others.iter().filter(|other| reach.get(other).is_some_and(|back| back.contains(module)));
        circles.insert(circle.map(|other| if other.is_empty() { "lib".to_owned() } else { other.join("/") }).collect::<Vec<_>>());
    }
    circles.into_iter().collect()
}

/// The paths of a use tree, with the names they get.
fn flatten(tree: &syn::UseTree, mut path: Vec<String>, paths: &mut Vec<(String, Vec<String>)>) {
    match tree {
        syn::UseTree::Path(part) => {
            path.push(part.ident.to_string());
            flatten(&part.tree, path, paths);
        }
        syn::UseTree::Name(name) => {
            path.push(name.ident.to_string());
            paths.push((name.ident.to_string(), path));
        }
        syn::UseTree::Rename(name) => {
            path.push(name.ident.to_string());
            paths.push((name.rename.to_string(), path));
        }
        syn::UseTree::Group(group) => group.items.iter().for_each(|tree| flatten(tree, path.clone(), paths)),
        syn::UseTree::Glob(_) => paths.push(("*".to_owned(), path)),
        _ => {}
    }
}

impl<'a> Visit<'a> for Contents {
    fn visit_item(&mut self, item: &'a syn::Item) {
        use syn::Item;
        let (attributes, name) = match item {
            Item::Const(item) => (&item.attrs, Some(&item.ident)),
            Item::Enum(item) => (&item.attrs, Some(&item.ident)),
            Item::Fn(item) => (&item.attrs, Some(&item.sig.ident)),
            Item::Static(item) => (&item.attrs, Some(&item.ident)),
            Item::Struct(item) => (&item.attrs, Some(&item.ident)),
            Item::Trait(item) => (&item.attrs, Some(&item.ident)),
            Item::Type(item) => (&item.attrs, Some(&item.ident)),
            Item::Mod(item) => (&item.attrs, None),
            Item::Impl(item) => (&item.attrs, None),
            Item::Use(item) => (&item.attrs, None),
            _ => return visit::visit_item(self, item),
        };
        if is_test(attributes) {
            return;
        }
        self.defined.extend(name.map(ToString::to_string));
        visit::visit_item(self, item);
    }

    fn visit_item_use(&mut self, item: &'a syn::ItemUse) {
        let mut paths = Vec::new();
        flatten(&item.tree, Vec::new(), &mut paths);
        let is_private = matches!(item.vis, syn::Visibility::Inherited);
        for (name, path) in paths {
            if is_private {
                self.named.push(path);
            } else {
                self.handed_on.insert(name, path);
            }
        }
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        if path.segments.len() > 1 {
            self.named.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        }
        visit::visit_path(self, path);
    }
}
