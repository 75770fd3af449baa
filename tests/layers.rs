//! The files of every crate import one another without a circle, so that each can be read before
//! those that stand above it.
#![allow(missing_docs)]

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;
use std::{fs, mem};

use mixer_tests::{folder, root};
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, Item, ItemMod, ItemUse, Macro, Token, UseTree, Visibility};

/// A module's path from the crate's root, which is empty.
type Module = Vec<String>;

/// The crates, each with a number of files and of imports that it surely has.
const PACKAGES: [(&str, usize); 11] = [
    ("mixer-rt", 25),
    ("mixer-compiler", 70),
    ("mixer-macros", 0),
    ("isolated-rotors", 1),
    ("mixer-identify", 30),
    ("mixer-facts", 10),
    ("mixer-files", 44),
    ("cargo-mixer", 25),
    ("simulation", 10),
    ("web", 2),
    ("python", 0),
];

/// The source files of a package with their modules.
fn sources(package: &str) -> BTreeMap<Module, syn::File> {
    let mut found = BTreeMap::new();
    files(&folder(package).join("src"), &Vec::new(), &mut found);
    // Roots of programs, and text that is compiled for other targets.
    let others = ["main", "bin::sitl", "library::support::memory"];
    found.retain(|module, _| !others.contains(&module.join("::").as_str()));
    found
}

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
            let mut file =
                syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
            file.items = file.items.into_iter().flat_map(opened).collect();
            found.insert(inner, file);
        }
    }
}

/// The items of an inline module with a path, whose modules are files of the folder around it.
fn opened(item: Item) -> Vec<Item> {
    match item {
        Item::Mod(ItemMod {
            attrs,
            content: Some((_, items)),
            ..
        }) if attrs.iter().any(|attribute| attribute.path().is_ident("path")) => items,
        item => vec![item],
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

/// The path from the crate's root, of a module with these children; `None` for another crate's.
fn absolute(module: &Module, children: &[String], path: &[String]) -> Option<Module> {
    let (first, rest) = path.split_first()?;
    match first.as_str() {
        "crate" => Some(rest.to_vec()),
        "self" => Some([module.as_slice(), rest].concat()),
        "super" => {
            let above = rest.iter().take_while(|part| *part == "super").count();
            let outer = &module[..module.len() - 1 - above];
            Some([outer, &rest[above..]].concat())
        }
        _ if children.contains(first) => Some([module.as_slice(), path].concat()),
        _ => None,
    }
}

/// The paths of a file from the crate's root, those in `use` and those written out.
#[derive(Default)]
struct Paths {
    /// The module that is read, and those that it declares.
    module: Module,
    children: Vec<String>,
    found: Vec<Module>,
}

impl Paths {
    fn read(&mut self, module: Module, items: &[Item]) {
        let declared = |item: &Item| match item {
            Item::Mod(item) => Some(item.ident.to_string()),
            _ => None,
        };
        let children = items.iter().filter_map(declared).collect();
        let outer = (
            mem::replace(&mut self.module, module),
            mem::replace(&mut self.children, children),
        );
        items.iter().for_each(|item| self.visit_item(item));
        (self.module, self.children) = outer;
    }

    fn add(&mut self, path: &[String]) {
        self.found.extend(absolute(&self.module, &self.children, path));
    }
}

impl Visit<'_> for Paths {
    fn visit_item_use(&mut self, item: &ItemUse) {
        let mut named = Vec::new();
        if !is_test(&item.attrs) {
            paths(&item.tree, &Vec::new(), &mut named);
        }
        named.iter().for_each(|path| self.add(path));
    }

    fn visit_item_mod(&mut self, item: &ItemMod) {
        if let Some((_, items)) = &item.content
            && !is_test(&item.attrs)
        {
            self.read(
                [self.module.as_slice(), &[item.ident.to_string()]].concat(),
                items,
            );
        }
    }

    // `pub(in crate::x)` imports nothing.
    fn visit_visibility(&mut self, _: &Visibility) {}

    fn visit_macro(&mut self, item: &Macro) {
        let parser = Punctuated::<Expr, Token![,]>::parse_terminated;
        for argument in item.parse_body_with(parser).iter().flatten() {
            self.visit_expr(argument);
        }
        visit::visit_macro(self, item);
    }

    fn visit_path(&mut self, path: &syn::Path) {
        let parts: Vec<String> = path.segments.iter().map(|part| part.ident.to_string()).collect();
        // A name alone is a variable's or was imported.
        if parts.len() > 1 {
            self.add(&parts);
        }
        visit::visit_path(self, path);
    }
}

/// The files that each file imports, also by way of the root's re-exports.
fn imports(files: &BTreeMap<Module, syn::File>) -> BTreeMap<Module, BTreeSet<Module>> {
    let named = |module: &Module, file: &syn::File| {
        let mut paths = Paths::default();
        paths.read(module.clone(), &file.items);
        paths.found
    };
    let reexports = files
        .get_key_value(&Vec::new())
        .map_or_else(Vec::new, |(root, file)| named(root, file));
    let file_of = |path: &Module| {
        (1..=path.len())
            .rev()
            .find_map(|end| files.get_key_value(&path[..end]))
    };
    let target = |path: &Module| {
        let reexport = || reexports.iter().find(|reexport| reexport.last() == path.first());
        file_of(path).or_else(|| file_of(reexport()?))
    };
    let of = |module: &Module, file: &syn::File| {
        named(module, file)
            .iter()
            .filter_map(target)
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

/// The circles: the files whose imports lead back to them, with the imports that do.
fn circles(mut imports: BTreeMap<Module, BTreeSet<Module>>) -> BTreeMap<Module, BTreeSet<Module>> {
    let mut reached = imports.clone();
    loop {
        let before = reached.clone();
        for targets in reached.values_mut() {
            let further = targets.iter().filter_map(|target| before.get(target));
            let further: Vec<Module> = further.flatten().cloned().collect();
            targets.extend(further);
        }
        if reached == before {
            break;
        }
    }
    let reaches = |from: &Module, to: &Module| reached.get(from).is_some_and(|all| all.contains(to));
    imports.retain(|module, targets| {
        targets.retain(|target| reaches(target, module));
        !targets.is_empty()
    });
    imports
}

#[test]
fn files_import_one_another_without_a_circle() {
    let mut faults = String::new();
    for (package, least) in PACKAGES {
        let found = sources(package);
        assert!(found.len() > least, "{package}: {} files", found.len());
        let imports = imports(&found);
        let edges: usize = imports.values().map(BTreeSet::len).sum();
        assert!(edges >= least, "{package}: {edges} imports");
        let circles = circles(imports);
        let arrows = circles.iter().map(|(module, targets)| {
            let targets: Vec<String> = targets.iter().map(|target| target.join("::")).collect();
            format!("\n  {} -> {}", module.join("::"), targets.join(", "))
        });
        for arrow in arrows {
            let _ = write!(faults, "\n{package}:{arrow}");
        }
    }
    assert!(faults.is_empty(), "{faults}");
}

#[test]
fn every_file_is_a_module() {
    for (package, _) in PACKAGES {
        let found = sources(package);
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

    for (module, targets) in imports(&sources("mixer-compiler")) {
        for target in targets {
            if let (Some(above), Some(below)) = (place(&module), place(&target)) {
                assert!(below <= above, "{module:?} uses {target:?}");
            }
        }
    }
}

#[test]
fn a_circle_is_found() {
    let found = |sources: &[(&str, &str)]| -> Vec<String> {
        let module = |name: &str| {
            name.split("::")
                .filter(|part| !part.is_empty())
                .map(str::to_owned)
                .collect()
        };
        let parsed = |text: &str| syn::parse_file(text).expect("Rust");
        let files = sources.iter().map(|(name, text)| (module(name), parsed(text)));
        let circles = circles(imports(&files.collect()));
        circles.into_keys().map(|module| module.join("::")).collect()
    };
    // d stands above the circle and e below it.
    let files = [
        ("a", "use crate::b::{self, C}; use crate::e;"),
        ("b", "use super::a;"),
        ("d", "use crate::a;"),
        ("e", "use std::fmt;"),
    ];
    assert_eq!(found(&files), ["a", "b"]);
    let files = [
        ("", "mod a; pub use a::C;"),
        ("a", "use crate::b::D;"),
        ("b", "use crate::C;"),
    ];
    assert_eq!(found(&files), ["a", "b"]);
    let child = ("a::b", "use super::C;");
    assert_eq!(found(&[("a", "mod b; use b::D;"), child]), ["a", "a::b"]);
    assert_eq!(
        found(&[("a", "mod b; fn f() { b::g::<u8>() }"), child]),
        ["a", "a::b"]
    );
    assert_eq!(
        found(&[("a", "mod b; fn f() { vec![b::g()] }"), child]),
        ["a", "a::b"]
    );
    assert_eq!(found(&[("a", "mod b; fn f(b: u8) -> u8 { b }"), child]), [""; 0]);
    assert_eq!(
        found(&[("a", "mod b; mod c { use super::b; }"), child]),
        ["a", "a::b"]
    );
}
