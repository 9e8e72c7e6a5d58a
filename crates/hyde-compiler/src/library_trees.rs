//! The library parsed: its texts never change, so that a process parses each of them once and not at every load.

use crate::named::Sought;
use crate::parses::counted;
use hyde_diag::{Diagnostics, FileId, Sources};
use hyde_library::Package;
use hyde_syntax::ast::{self, Item};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// By name, the tree with the number that its text had among the sources: the places in a tree carry that number.
type Trees = BTreeMap<&'static str, (FileId, Arc<ast::File>)>;

static TREES: Mutex<Trees> = Mutex::new(Trees::new());

/// The tree of a package of the library, whose text is the one of that number.
pub(crate) fn tree(package: Package, sources: &Sources, id: FileId) -> Arc<ast::File> {
    let known = {
        let trees = TREES.lock().unwrap_or_else(PoisonError::into_inner);
        let own = trees.get(package.name).filter(|(own, _)| *own == id);
        own.map(|(_, tree)| Arc::clone(tree))
    };
    if let Some(tree) = known {
        return tree;
    }
    // The library has no errors: a test of its own compiles all of it.
    let tree = Arc::new(counted(sources, id, &mut Diagnostics::new()));
    let mut trees = TREES.lock().unwrap_or_else(PoisonError::into_inner);
    trees.insert(package.name, (id, Arc::clone(&tree)));
    tree
}

/// The packages of the library that declare a class of a name, or a type where it need not be a model.
pub(crate) fn declaring(word: &str, sought: Sought) -> Vec<&'static str> {
    let all = names().iter();
    let own = all.filter(|(_, names)| {
        let is = |(name, class): &(String, bool)| name == word && sought.takes(*class);
        names.iter().any(is)
    });
    own.map(|(package, _)| *package).collect()
}

/// The names that a package declares, each with whether it is a class.
type Names = (&'static str, Vec<(String, bool)>);

/// The names of all packages.
fn names() -> &'static [Names] {
    static NAMES: OnceLock<Vec<Names>> = OnceLock::new();
    NAMES.get_or_init(|| {
        let packages = hyde_library::PACKAGES.iter();
        packages
            .map(|package| {
                let mut sources = Sources::new();
                let id = sources.add(package.name, package.text);
                let tree = counted(&sources, id, &mut Diagnostics::new());
                let names = tree.items.iter().filter_map(|item| match item {
                    Item::Class(class) => Some((class.name.text.clone(), true)),
                    Item::Type(item) => Some((item.name.text.clone(), false)),
                    Item::Experiment(_) | Item::Study(_) => None,
                });
                (package.name, names.collect())
            })
            .collect()
    })
}
