//! The models of the README and the book: each compiles, or is wrong in just the way the book shows.
//!
//! A block marked `hyde` is a whole file, and `hyde check` finds nothing to say against it. One marked `hyde wrong` is
//! followed by what the command says of it, word by word. A block marked `console` shows commands and what they print. The pages of the diagnostics have a test of their own. Links to
//! files, those of ARCHITECTURE.md too, lead somewhere.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests open files, and unwrap what must be there"
)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

#[test]
fn every_model_compiles() {
    let scratch = tempfile::tempdir().unwrap();
    let mut found = 0;
    for (page, text) in pages() {
        write_data(&text, scratch.path());
        keep_fmu(scratch.path());
        for block in blocks(&text, "```hyde\n") {
            found += 1;
            let output = check(&block.code, scratch.path());
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(
                output.status.success() && said.is_empty(),
                "{}: `{}`:\n{said}",
                page.display(),
                package(&block.code)
            );
        }
    }
    assert!(found > 10, "only {found} models were found");
}

/// The FMU that the book uses: one to be checked, whose library cannot be loaded.
fn keep_fmu(here: &Path) {
    let fmu = root().join("tests/fixtures/errors/controller.fmu");
    std::fs::copy(fmu, here.join("controller.fmu")).unwrap();
}

#[test]
fn what_is_wrong_is_told_as_shown() {
    let scratch = tempfile::tempdir().unwrap();
    let mut found = 0;
    for (page, text) in pages() {
        for block in blocks(&text, "```hyde wrong\n") {
            found += 1;
            let output = check(&block.code, scratch.path());
            let said = String::from_utf8_lossy(&output.stderr);
            let shown = block.shown.as_deref().unwrap_or_default();
            assert_eq!(
                said.trim(),
                shown.trim(),
                "{}: `{}`",
                page.display(),
                package(&block.code)
            );
        }
    }
    assert!(found > 0, "no wrong models were found");
}

#[test]
fn commands_print_what_is_shown() {
    let scratch = tempfile::tempdir().unwrap();
    let here = scratch.path();
    link_command(here);
    let mut pages = pages();
    // What the first steps leave, later pages plot.
    pages.sort_by_key(|(path, _)| {
        let first = ["README.md", "getting-started.md"];
        first
            .iter()
            .position(|name| path.ends_with(name))
            .unwrap_or(first.len())
    });
    for (_, text) in &pages {
        write_data(text, here);
        for block in blocks(text, "```hyde\n") {
            keep(&block.code, here);
        }
    }
    let mut found = 0;
    let mut wrong = Vec::new();
    for (page, text) in &pages {
        // A page with a manifest is a package of its own.
        let own = tempfile::tempdir().unwrap();
        let here = match blocks(text, "```toml\n").first() {
            Some(manifest) if page.ends_with("your-library.md") => {
                link_command(own.path());
                std::fs::write(own.path().join("hyde.toml"), &manifest.code).unwrap();
                for block in blocks(text, "```hyde\n") {
                    keep(&block.code, own.path());
                }
                own.path()
            }
            Some(_) | None => here,
        };
        for block in blocks(text, "```console\n") {
            let mut status = 0;
            for command in block.code.split("$ ").skip(1) {
                let (line, shown) = command.split_once('\n').unwrap();
                found += 1;
                let printed = printed(line, here, &mut status);
                let (printed, shown) = (timeless(&printed), timeless(shown));
                // A command shown without what it prints must succeed.
                let as_shown = if shown.is_empty() {
                    status == 0
                } else {
                    printed == shown
                };
                if !as_shown {
                    let page = page.display();
                    wrong.push(format!(
                        "{page}: {line}\n{printed}\n--- instead of\n{shown}\n"
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(found > 20, "only {found} commands were found");
}

#[test]
fn every_block_of_the_language_is_marked_in_a_way_that_is_tested() {
    for (page, text) in pages() {
        for line in text.lines().filter(|line| line.starts_with("```hyde")) {
            let known = matches!(line, "```hyde" | "```hyde wrong");
            assert!(known, "{}: `{line}`", page.display());
        }
    }
}

#[test]
fn every_page_is_in_the_table_of_contents() {
    let folder = root().join("book/src");
    let summary = read(&folder.join("SUMMARY.md"));
    for folder in [folder.clone(), folder.join("errors"), folder.join("how")] {
        for path in markdown(&folder) {
            let name = path.strip_prefix(root().join("book/src")).unwrap();
            let name = name.to_string_lossy().replace('\\', "/");
            let listed = name == "SUMMARY.md" || summary.contains(&format!("({name})"));
            assert!(listed, "{name} is not in SUMMARY.md");
        }
    }
}

#[test]
fn every_file_that_a_page_links_to_is_there() {
    let mut paths = markdown(&root());
    for folder in ["book/src", "book/src/how", "tests"] {
        paths.extend(markdown(&root().join(folder)));
    }
    let mut found = 0;
    for path in paths {
        let folder = path.parent().unwrap();
        for target in links(&read(&path)) {
            found += 1;
            let there = folder.join(&target).exists();
            assert!(there, "{}: `{target}` is not there", path.display());
        }
    }
    assert!(found > 50, "only {found} links were found");
}

/// Every promise has a figure, or tests of a module, that are there.
#[test]
fn every_proof_of_a_promise_exists() {
    let page = read(&root().join("book/src/how/promises.md"));
    let proofs: Vec<&str> = page
        .lines()
        .filter_map(|line| line.strip_prefix("| ")?.split(" | `").nth(1))
        .filter_map(|proof| proof.strip_suffix("` |"))
        .collect();
    assert!(proofs.len() > 20, "only {} proofs were found", proofs.len());
    for proof in proofs {
        if let Some(names) = proof.strip_prefix("./dev figures ") {
            for name in names.split(' ') {
                let known = hyde_tests::figures::FIGURES.iter();
                let known = known.filter(|figure| figure.name == name).count();
                assert_eq!(known, 1, "there is no figure `{name}`");
            }
            continue;
        }
        if proof == "./dev fuzz" {
            assert!(root().join("fuzz/Cargo.toml").is_file());
            continue;
        }
        let words: Vec<&str> = proof.split(' ').collect();
        let ["cargo", "test", "-p", package, rest @ ..] = words.as_slice() else {
            panic!("`{proof}` is neither a figure nor a test");
        };
        let folder = match *package {
            "hyde-tests" => root().join("tests"),
            package => root().join("crates").join(package),
        };
        let tests = folder.join("tests");
        match rest {
            ["--test", target, module] => {
                let module = tests.join(target).join(module).with_extension("rs");
                assert!(module.exists(), "{} is not there", module.display());
            }
            ["--test", target] => {
                let file = tests.join(target).with_extension("rs");
                assert!(file.exists(), "{} is not there", file.display());
            }
            _ => assert!(tests.exists(), "{} is not there", tests.display()),
        }
    }
}

/// A model as printed, and the block that follows it at once.
struct Block {
    code: String,
    shown: Option<String>,
}

/// The blocks that open with this fence.
fn blocks(text: &str, fence: &str) -> Vec<Block> {
    let text = format!("\n{text}");
    text.split(&format!("\n{fence}"))
        .skip(1)
        .filter_map(|rest| {
            let (code, after) = rest.split_once("```")?;
            let shown = after
                .strip_prefix("\n\n```text\n")
                .and_then(|rest| Some(rest.split_once("\n```")?.0.to_owned()));
            Some(Block {
                code: code.to_owned(),
                shown,
            })
        })
        .collect()
}

/// Writes the data of a page, blocks marked with the name of their file, where its models look for them.
fn write_data(text: &str, folder: &Path) {
    for block in text.split("\n```csv ").skip(1) {
        let (name, rest) = block.split_once('\n').unwrap();
        let content = rest.split("```").next().unwrap();
        std::fs::write(folder.join(name), content).unwrap();
    }
}

/// The targets of a page's links within the project, without the place on their page; brackets in code are no links.
fn links(text: &str) -> Vec<String> {
    let prose = text.split("\n```").step_by(2);
    prose
        .flat_map(|part| part.split("](").skip(1))
        .filter_map(|rest| rest.split_once(')'))
        .filter_map(|(target, _)| target.split('#').next())
        .filter(|target| !target.is_empty() && !target.contains("://"))
        .map(str::to_owned)
        .collect()
}

/// What a command of the book prints on both streams, and its exit status, given that of the command before it.
fn printed(line: &str, folder: &Path, status: &mut i32) -> String {
    let script = format!("PATH=.:$PATH; (exit {status}); {{ {line}; }} 2>&1");
    let shell = Command::new("sh")
        .args(["-c", &script])
        .current_dir(folder)
        .output();
    let output = shell.unwrap();
    *status = output.status.code().unwrap_or(-1);
    String::from_utf8(output.stdout).unwrap()
}

/// Puts the command and the examples into a folder.
fn link_command(folder: &Path) {
    std::os::unix::fs::symlink(root().join("examples"), folder.join("examples")).unwrap();
    std::os::unix::fs::symlink(env!("CARGO_BIN_EXE_hyde-tested"), folder.join("hyde")).unwrap();
}

/// Without what differs from run to run or is the solver's business: times, its counts, and what rounding leaves.
fn timeless(text: &str) -> String {
    let masked = |line: &str| {
        if line.ends_with(" times real time") {
            return line.split(" s in ").next().unwrap().to_owned();
        }
        let counted = line.split_once(" unknowns, ");
        if let Some((unknowns, counts)) = counted.or_else(|| line.split_once(" unknown, "))
            && counts.contains(" steps, ")
        {
            return unknowns.to_owned();
        }
        if line.ends_with(" a second") {
            return line.split("; ").next().unwrap().to_owned();
        }
        let line = line.split("; balance error ").next().unwrap();
        line.trim_end().to_owned()
    };
    let lines: Vec<String> = text.lines().map(masked).collect();
    lines.join("\n").trim_end().to_owned()
}

/// Checks a model in a file called as its package, `lib/parts.hyde` for `lib.parts`, so that a later model of the book can
/// import it. Its records are those of the bench.
fn check(code: &str, folder: &Path) -> Output {
    let name = keep(code, folder);
    let strokes = root().join("examples/bench_axis/strokes.csv");
    std::fs::copy(strokes, folder.join("strokes.csv")).unwrap();
    Command::new(env!("CARGO_BIN_EXE_hyde-tested"))
        .current_dir(folder)
        .args(["check", &name])
        .output()
        .unwrap()
}

/// Keeps a model in its file.
fn keep(code: &str, folder: &Path) -> String {
    let name = format!("{}.hyde", package(code).replace('.', "/"));
    let place = folder.join(&name);
    std::fs::create_dir_all(place.parent().unwrap()).unwrap();
    std::fs::write(place, code).unwrap();
    name
}

/// The name in `package name …` or `package folder.name …`.
fn package(code: &str) -> &str {
    let rest = code.strip_prefix("package ").unwrap_or("model");
    let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '.'));
    &rest[..end.unwrap_or(rest.len())]
}

/// The README and the chapters of the book.
fn pages() -> Vec<(PathBuf, String)> {
    let mut paths = vec![root().join("README.md")];
    paths.extend(markdown(&root().join("book/src")));
    paths
        .into_iter()
        .map(|path| {
            let text = read(&path);
            (path, text)
        })
        .collect()
}

/// The pages in a folder, in the order of their names.
fn markdown(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut found: Vec<PathBuf> = entries
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .collect();
    found.sort();
    found
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

fn root() -> PathBuf {
    hyde_tests::root()
}
