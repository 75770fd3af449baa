//! The files of the runtime and of the compiler import one another without a circle, so that each
//! can be read before those that stand above it.
#![allow(missing_docs)]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use mixer_tests::root;
use syn::{Attribute, Item, UseTree};

/// A module's path from the crate's root, which is empty.
type Module = Vec<String>;

/// The source files below `folder` with their modules.
fn files(folder: &Path, module: &Module, found: &mut BTreeMap<Module, syn::File>) {
    for entry in fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.expect("an entry").path();
        let stem = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let mut inner = module.clone();
        if stem != "lib" {
            inner.push(stem);
        }
        if path.is_dir() {
            files(&path, &inner, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).expect("a source file");
            let file = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            found.insert(inner, file);
        }
    }
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute
                .parse_args::<syn::Path>()
                .is_ok_and(|path| path.is_ident("test"))
    })
}

/// The paths that a `use` names.
fn paths(tree: &UseTree, prefix: &Module, found: &mut Vec<Module>) {
    let with = |name: String| [prefix.as_slice(), &[name]].concat();
    match tree {
        UseTree::Path(path) => paths(&path.tree, &with(path.ident.to_string()), found),
        UseTree::Name(name) => found.push(with(name.ident.to_string())),
        UseTree::Rename(name) => found.push(with(name.ident.to_string())),
        UseTree::Glob(_) => found.push(prefix.clone()),
        UseTree::Group(group) => group.items.iter().for_each(|tree| paths(tree, prefix, found)),
    }
}

/// The path from the crate's root; `None` for another crate's.
fn absolute(module: &Module, path: &[String]) -> Option<Module> {
    let (first, rest) = path.split_first()?;
    match first.as_str() {
        "crate" => Some(rest.to_vec()),
        "self" => Some([module.as_slice(), rest].concat()),
        "super" => {
            let above = rest.iter().take_while(|part| *part == "super").count();
            let outer = &module[..module.len() - 1 - above];
            Some([outer, &rest[above..]].concat())
        }
        _ => None,
    }
}

/// The files that each file imports. Re-exports of the crate's root are left out.
fn imports(files: &BTreeMap<Module, syn::File>) -> BTreeMap<Module, BTreeSet<Module>> {
    let of = |module: &Module, file: &syn::File| {
        let mut named = Vec::new();
        for item in &file.items {
            if let Item::Use(item) = item
                && !is_test(&item.attrs)
            {
                paths(&item.tree, &Vec::new(), &mut named);
            }
        }
        let target = |path: Module| {
            (1..=path.len())
                .rev()
                .find_map(|end| files.get_key_value(&path[..end]))
        };
        named
            .iter()
            .filter_map(|path| target(absolute(module, path)?))
            .map(|(target, _)| target.clone())
            .filter(|target| target != module)
            .collect()
    };
    files
        .iter()
        .filter(|(module, _)| !module.is_empty())
        .map(|(module, file)| (module.clone(), of(module, file)))
        .collect()
}

/// The circles: the files that remain where those that import no remaining file are taken away,
/// again and again.
fn circles(mut imports: BTreeMap<Module, BTreeSet<Module>>) -> BTreeMap<Module, BTreeSet<Module>> {
    loop {
        let left: BTreeSet<Module> = imports.keys().cloned().collect();
        for targets in imports.values_mut() {
            targets.retain(|target| left.contains(target));
        }
        imports.retain(|_, targets| !targets.is_empty());
        if imports.len() == left.len() {
            return imports;
        }
    }
}

#[test]
fn files_import_one_another_without_a_circle() {
    for (package, least) in [("mixer-rt", 25), ("mixer-compiler", 70)] {
        let mut found = BTreeMap::new();
        files(&root().join(package).join("src"), &Vec::new(), &mut found);
        assert!(found.len() > least, "{package}: {} files", found.len());
        let imports = imports(&found);
        let edges: usize = imports.values().map(BTreeSet::len).sum();
        assert!(edges > least, "{package}: {edges} imports");
        let circles = circles(imports);
        assert!(circles.is_empty(), "{package}: {circles:#?}");
    }
}

#[test]
fn every_file_is_a_module() {
    for package in ["mixer-rt", "mixer-compiler"] {
        let mut found = BTreeMap::new();
        files(&root().join(package).join("src"), &Vec::new(), &mut found);
        for module in found.keys() {
            let Some((name, above)) = module.split_last() else {
                continue;
            };
            let declares = |file: &syn::File| {
                let mut items = file.items.iter();
                items.any(|item| matches!(item, Item::Mod(item) if item.ident == name))
            };
            assert!(
                found.get(above).is_some_and(declares),
                "{package}: nothing declares {module:?}"
            );
        }
    }
}

/// The order of ARCHITECTURE.md.
#[test]
fn modules_of_the_compiler_use_only_those_before_them() {
    let page = fs::read_to_string(root().join("ARCHITECTURE.md")).expect("a page");
    let (_, order) = page
        .split_once("only those before them in this order:")
        .expect("the order");
    let (order, _) = order.split_once('.').expect("a sentence");
    let order: Vec<&str> = order
        .split(',')
        .map(|name| name.trim().trim_matches('`'))
        .collect();
    assert!(order.len() > 8, "{order:?}");
    let place = |module: &Module| order.iter().position(|name| *name == module[0]);

    let mut found = BTreeMap::new();
    files(&root().join("mixer-compiler/src"), &Vec::new(), &mut found);
    for (module, targets) in imports(&found) {
        for target in targets {
            if let (Some(above), Some(below)) = (place(&module), place(&target)) {
                assert!(below <= above, "{module:?} uses {target:?}");
            }
        }
    }
}

#[test]
fn a_circle_is_found() {
    let file = |text: &str| syn::parse_file(text).expect("Rust");
    let module = |name: &str| vec![name.to_owned()];
    let files = BTreeMap::from([
        (module("a"), file("use crate::b::{self, C};")),
        (module("b"), file("use super::a;")),
        (module("d"), file("use crate::a;")),
        (module("e"), file("use std::fmt;")),
    ]);
    // d is no part of the circle, but stands above it.
    let found: Vec<Module> = circles(imports(&files)).into_keys().collect();
    assert_eq!(found, [module("a"), module("b"), module("d")]);
}
