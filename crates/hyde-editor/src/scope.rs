//! What a name means at a place: types, classes and packages of the loaded files, members of a class through `extends`, and
//! names of blocks.

use hyde_diag::FileId;
use hyde_syntax::Lookup;
use hyde_syntax::ast::{
    AccountKind, Change, Class, ClassBody, Clocked, Declaration, Declarator, Declared, Domain,
    Element, Experiment, ExperimentItem, File, Item, Measure, Modes, Name, Prefix, RecordItem,
    Reference, Study, TypeItem,
};
pub(crate) use hyde_syntax::{FileIndex, dotted};
use std::sync::Arc;

/// The most classes that extend each other, or names in one reference.
const DEEPEST: usize = 32;

/// Something that is declared.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Definition<'a> {
    pub(crate) file: FileIndex,
    /// The name, where it is declared.
    pub(crate) name: &'a Name,
    pub(crate) thing: Thing<'a>,
}

/// What is declared.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Thing<'a> {
    Package(&'a File),
    Type(&'a TypeItem),
    Class(&'a Class),
    Variable(&'a Declaration, &'a Declarator),
    Measure(&'a Measure, Option<AccountKind>),
    Domain(&'a Domain),
    /// The coordinate of a domain.
    Coordinate(&'a Domain),
    Clocked(&'a Clocked),
    Modes(&'a Modes),
    Mode,
    /// The counter of a loop or of a list.
    Counter,
    /// A parameter of a mode with its type.
    ModeParameter(&'a Reference),
    Record(&'a RecordItem),
    Experiment(&'a Experiment),
    Study(&'a Study),
}

/// Where the members of something are.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Inside<'a> {
    Class(FileIndex, &'a Class),
    Elements(FileIndex, &'a [Element]),
    /// Columns, which no text declares.
    Columns,
}

/// The loaded files.
#[derive(Clone, Copy)]
pub(crate) struct Files<'a> {
    pub(crate) files: &'a [(FileId, Arc<File>)],
}

impl<'a> Files<'a> {
    pub(crate) fn file(self, index: FileIndex) -> Option<&'a File> {
        self.files.get(index).map(|(_, tree)| &**tree)
    }

    fn lookup(self) -> Lookup<'a> {
        Lookup { files: self.files }
    }

    /// The package of a name.
    pub(crate) fn package(self, name: &str) -> Option<FileIndex> {
        self.lookup().package(name)
    }

    /// What a package is, as something declared.
    pub(crate) fn package_definition(self, file: FileIndex) -> Option<Definition<'a>> {
        let tree = self.file(file)?;
        let (path, _) = tree.package.as_ref()?;
        Some(Definition {
            file,
            name: &path.parts.last()?.name,
            thing: Thing::Package(tree),
        })
    }

    /// What the name of a type means in a file: a quantity, or else a class.
    pub(crate) fn item(self, file: FileIndex, name: &Reference) -> Option<Definition<'a>> {
        let quantity = self.lookup().type_item(file, name);
        let quantity = quantity.map(|(file, item)| Definition {
            file,
            name: &item.name,
            thing: Thing::Type(item),
        });
        quantity.or_else(|| self.class_definition(file, name))
    }

    /// The class that a name means in a file, as something declared.
    pub(crate) fn class_definition(
        self,
        file: FileIndex,
        name: &Reference,
    ) -> Option<Definition<'a>> {
        let (file, class) = self.class(file, name)?;
        Some(Definition {
            file,
            name: &class.name,
            thing: Thing::Class(class),
        })
    }

    /// The type of a declaration: a component where the compiler takes one for it, although there is a quantity of that name.
    pub(crate) fn declared(
        self,
        file: FileIndex,
        declaration: &'a Declaration,
    ) -> Option<Definition<'a>> {
        let quantity = [
            Prefix::Parameter,
            Prefix::Constant,
            Prefix::Size,
            Prefix::Shape,
            Prefix::Input,
            Prefix::Output,
            Prefix::Flow,
            Prefix::Site,
            Prefix::Field,
        ];
        let plain = !declaration
            .prefixes
            .iter()
            .any(|own| quantity.contains(own));
        let part = |own: &Declarator| own.binding.is_none() && own.is_modified();
        let class = self.class_definition(file, &declaration.type_name);
        match class {
            Some(class) if plain && declaration.declarators.iter().any(part) => Some(class),
            Some(_) | None => self.item(file, &declaration.type_name),
        }
    }

    /// The class that a name means in a file.
    pub(crate) fn class(self, file: FileIndex, name: &Reference) -> Option<(FileIndex, &'a Class)> {
        self.lookup().class(file, name)
    }

    /// An experiment of a file.
    pub(crate) fn experiment(self, file: FileIndex, word: &str) -> Option<&'a Experiment> {
        self.file(file)?.items.iter().find_map(|item| match item {
            Item::Experiment(experiment) if experiment.name.text == word => Some(experiment),
            Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
        })
    }

    /// A study of a file.
    pub(crate) fn study(self, file: FileIndex, word: &str) -> Option<&'a Study> {
        self.file(file)?.items.iter().find_map(|item| match item {
            Item::Study(study) if study.name.text == word => Some(study),
            Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
        })
    }

    /// A member by its name.
    pub(crate) fn member(self, inside: Inside<'a>, word: &str) -> Option<Definition<'a>> {
        let mut found = None;
        self.each_member(inside, &mut |member| {
            if found.is_none() && member.name.text == word {
                found = Some(member);
            }
        });
        found
    }

    /// Shows `visit` every member, those of classes that are extended too.
    pub(crate) fn each_member(self, inside: Inside<'a>, visit: &mut dyn FnMut(Definition<'a>)) {
        self.members_below(inside, DEEPEST, visit);
    }

    fn members_below(
        self,
        inside: Inside<'a>,
        depth: usize,
        visit: &mut dyn FnMut(Definition<'a>),
    ) {
        let Some(depth) = depth.checked_sub(1) else {
            return;
        };
        match inside {
            Inside::Class(file, class) => match &class.body {
                ClassBody::Long { host, elements } => {
                    self.members_below(Inside::Elements(file, elements), depth, visit);
                    if let Some((file, host)) =
                        host.as_ref().and_then(|host| self.class(file, host))
                    {
                        self.members_below(Inside::Class(file, host), depth, visit);
                    }
                }
                ClassBody::Short { base, .. } => {
                    if let Some((file, base)) = self.class(file, base) {
                        self.members_below(Inside::Class(file, base), depth, visit);
                    }
                }
            },
            Inside::Elements(file, elements) => {
                for element in elements {
                    own_members(file, element, visit);
                }
                for element in elements {
                    if let Element::Extends(base, _) = element
                        && let Some((file, base)) = self.class(file, base)
                    {
                        self.members_below(Inside::Class(file, base), depth, visit);
                    }
                }
            }
            Inside::Columns => {}
        }
    }

    /// Where the members of something declared are. `changes` are those made to what it is a member of, with their file.
    pub(crate) fn inside(
        self,
        definition: Definition<'a>,
        changes: Option<(FileIndex, &'a [Change])>,
    ) -> Option<Inside<'a>> {
        match definition.thing {
            Thing::Variable(declaration, declarator) => {
                // `redeclare GapContact contact` says which class it is.
                let other = changes.and_then(|(file, changes)| {
                    let own = |change: &&Change| {
                        change.target.as_word() == Some(declarator.name.text.as_str())
                    };
                    let change = changes.iter().find(own)?;
                    self.class(file, change.redeclare.as_ref()?)
                });
                // A quantity has no members, also where there is a component of its name: `input Force F`.
                let is_part = || {
                    let declared = self.declared(definition.file, declaration);
                    let is_type = declared.is_some_and(|own| matches!(own.thing, Thing::Type(_)));
                    !is_type || declaration.prefixes.is_empty() && declarator.binding.is_none()
                };
                let own = || self.class(definition.file, &declaration.type_name);
                let class = other.or_else(|| is_part().then(own).flatten());
                class.map(|(file, class)| Inside::Class(file, class))
            }
            Thing::Class(class) => Some(Inside::Class(definition.file, class)),
            Thing::Clocked(clocked) => Some(Inside::Elements(definition.file, &clocked.elements)),
            Thing::Record(_) => Some(Inside::Columns),
            Thing::Experiment(experiment) => {
                let (file, class) = self.class(definition.file, &experiment.model)?;
                Some(Inside::Class(file, class))
            }
            Thing::Package(_)
            | Thing::Type(_)
            | Thing::Measure(..)
            | Thing::Domain(_)
            | Thing::Coordinate(_)
            | Thing::Modes(_)
            | Thing::Mode
            | Thing::Counter
            | Thing::ModeParameter(_)
            | Thing::Study(_) => None,
        }
    }

    /// A mode of a component, or of a named block of modes, by its name.
    pub(crate) fn mode(self, definition: Definition<'a>, word: &str) -> Option<Definition<'a>> {
        if let Thing::Modes(modes) = definition.thing {
            return mode_of(definition.file, modes, word);
        }
        self.mode_inside(self.inside(definition, None)?, word, DEEPEST)
    }

    fn mode_inside(self, inside: Inside<'a>, word: &str, depth: usize) -> Option<Definition<'a>> {
        let depth = depth.checked_sub(1)?;
        let (file, elements) = match inside {
            Inside::Class(file, class) => match &class.body {
                ClassBody::Long { elements, .. } => (file, elements.as_slice()),
                ClassBody::Short { base, .. } => {
                    let (file, base) = self.class(file, base)?;
                    return self.mode_inside(Inside::Class(file, base), word, depth);
                }
            },
            Inside::Elements(file, elements) => (file, elements),
            Inside::Columns => return None,
        };
        elements.iter().find_map(|element| {
            if let Element::Modes(modes) = element {
                return mode_of(file, modes, word);
            }
            let Element::Extends(base, _) = element else {
                return None;
            };
            let (file, base) = self.class(file, base)?;
            self.mode_inside(Inside::Class(file, base), word, depth)
        })
    }
}

/// A mode of a block.
pub(crate) fn mode_of<'a>(file: FileIndex, modes: &'a Modes, word: &str) -> Option<Definition<'a>> {
    let mode = modes.modes.iter().find(|mode| mode.name.text == word)?;
    Some(Definition {
        file,
        name: &mode.name,
        thing: Thing::Mode,
    })
}

/// The names that an experiment declares itself.
pub(crate) fn own_of_experiment<'a>(
    file: FileIndex,
    experiment: &'a Experiment,
    word: &str,
) -> Option<Definition<'a>> {
    let record = experiment.records.iter().find(|r| r.name.text == word);
    if let Some(record) = record {
        return Some(Definition {
            file,
            name: &record.name,
            thing: Thing::Record(record),
        });
    }
    experiment.items.iter().find_map(|item| {
        let ExperimentItem::Measure(measure) = item else {
            return None;
        };
        (measure.name.text == word).then_some(Definition {
            file,
            name: &measure.name,
            thing: Thing::Measure(measure, None),
        })
    })
}

fn own_members<'a>(file: FileIndex, element: &'a Element, visit: &mut dyn FnMut(Definition<'a>)) {
    for (name, declared) in element.declared() {
        let thing = match declared {
            Declared::Variable(declaration, declarator) => Thing::Variable(declaration, declarator),
            Declared::Domain(domain) => Thing::Domain(domain),
            Declared::Coordinate(domain) => Thing::Coordinate(domain),
            Declared::Modes(modes) => Thing::Modes(modes),
            Declared::Clocked(clocked) => Thing::Clocked(clocked),
            Declared::Measure(measure, kind) => Thing::Measure(measure, kind),
        };
        visit(Definition { file, name, thing });
    }
}
