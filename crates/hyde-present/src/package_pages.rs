//! The pages of packages: an index, and a page for each package, HTML that needs no other file and no network.

mod class;
mod html;
mod inherited;
mod links;

use html::{code, documentation, first_sentence, page, table};
use hyde_diag::{FileId, Sources};
use hyde_syntax::ast::{self, Class, ClassKind, Item};
use links::Links;
use std::sync::Arc;

/// Packages that are documented together.
#[derive(Default)]
pub struct Library {
    /// Heading of the index.
    pub title: String,
    /// What it is.
    pub text: String,
    /// What else there is to say of it: version, licence.
    pub facts: Vec<(&'static str, String)>,
    /// The texts.
    pub sources: Sources,
    /// The packages, those with a page first; of the others only the names are known.
    pub files: Vec<(FileId, Arc<ast::File>)>,
    /// How many have a page.
    pub documented: usize,
}

/// Every page with the name of its file; the index first.
pub fn pages(library: &Library) -> Vec<(String, String)> {
    let links = Links::new(library);
    let mut found = vec![("index.html".to_owned(), index(library))];
    for number in 0..library.documented {
        let name = library.name(number);
        found.push((format!("{name}.html"), package(library, number, &links)));
    }
    found
}

impl Library {
    /// The name of a package, or of its file where it says none.
    fn name(&self, number: usize) -> String {
        let (id, file) = &self.files[number];
        match &file.package {
            Some((path, _)) => path.dotted(),
            None => {
                let place = &self.sources.get(*id).name;
                let last = place.rsplit('/').next().unwrap_or(place);
                last.trim_end_matches(".hyde").to_owned()
            }
        }
    }

    fn doc(&self, number: usize) -> &str {
        let package = self.files[number].1.package.as_ref();
        package
            .and_then(|(_, doc)| doc.as_deref())
            .unwrap_or_default()
    }
}

/// The kinds of classes in the order of a page, with their headings.
const KINDS: [(ClassKind, &str); 4] = [
    (ClassKind::Connector, "Connectors"),
    (ClassKind::Model, "Models"),
    (ClassKind::Effect, "Effects"),
    (ClassKind::Function, "Functions"),
];

fn classes(file: &ast::File, kind: ClassKind) -> Vec<&Class> {
    fn of_class(item: &Item) -> Option<&Class> {
        match item {
            Item::Class(class) => Some(class),
            Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
        }
    }
    let all = file.items.iter().filter_map(of_class);
    all.filter(|class| class.kind == kind).collect()
}

fn index(library: &Library) -> String {
    let mut body = documentation(&library.text);
    let facts: String = library
        .facts
        .iter()
        .map(|(name, fact)| format!("<div><dt>{name}</dt><dd>{}</dd></div>", code(fact)))
        .collect();
    if !facts.is_empty() {
        body += &format!("<dl>{facts}</dl>\n");
    }
    for (number, (_, file)) in library.files[..library.documented].iter().enumerate() {
        let name = library.name(number);
        body += &format!("<h2><a href=\"{name}.html\">{name}</a></h2>\n");
        body += &documentation(library.doc(number));
        let mut rows = Vec::new();
        for (kind, heading) in KINDS {
            for class in classes(file, kind) {
                let word = class.name.text.as_str();
                rows.push(vec![
                    format!("<a href=\"{name}.html#{word}\">{word}</a>"),
                    heading.trim_end_matches('s').to_lowercase(),
                    first_sentence(class.doc.as_deref().unwrap_or_default()),
                ]);
            }
        }
        body += &table(&["name", "", ""], &rows);
    }
    page(&library.title, "", &body)
}

fn package(library: &Library, number: usize, links: &Links<'_>) -> String {
    let (id, file) = &library.files[number];
    let mut body = documentation(library.doc(number));
    let imports: Vec<String> = file
        .imports
        .iter()
        .map(|import| links.import(import))
        .collect();
    if !imports.is_empty() {
        body += &format!("<p class=\"note\">imports {}</p>\n", imports.join(", "));
    }
    let mut contents = String::new();
    let types = class::types(file);
    if !types.is_empty() {
        contents += "<li><a href=\"#types\">Types</a></li>\n";
        body += &format!("<h2 id=\"types\">Types</h2>\n{types}");
    }
    for (kind, heading) in KINDS {
        let list = classes(file, kind);
        if list.is_empty() {
            continue;
        }
        let names: Vec<String> = list
            .iter()
            .map(|class| format!("<a href=\"#{0}\">{0}</a>", class.name.text))
            .collect();
        contents += &format!("<li>{heading}: {}</li>\n", names.join(", "));
        body += &format!("<h2>{heading}</h2>\n");
        for class in list {
            body += &class::class(class, number, library, links);
        }
    }
    let experiments = class::experiments(file, number, links);
    if !experiments.is_empty() {
        contents += "<li><a href=\"#experiments\">Experiments</a></li>\n";
        body += &format!("<h2 id=\"experiments\">Experiments</h2>\n{experiments}");
    }
    let place = &library.sources.get(*id).name;
    let top = format!(
        "<nav><a href=\"index.html\">{}</a><ul>\n{contents}</ul></nav>\n",
        html::escaped(&library.title)
    );
    let foot = format!("<footer>{}</footer>\n", html::escaped(place));
    page(&library.name(number), &top, &(body + &foot))
}
