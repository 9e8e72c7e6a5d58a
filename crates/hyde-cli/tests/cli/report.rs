//! `hyde report`: the page of a batch, as text and in a browser.

use crate::command::{Folder, errors, hyde, read, status, text};
use std::io::Write as _;
use std::path::Path;
use std::process::Command;

/// A spring pressed by a force: x = F/k at once, and a choice that fails for stiff springs.
const SPRING: &str = r#"package press "a spring that a force presses";
import SI.*;

model Spring
  input Force F;
  parameter Stiffness k = 1e6 [N/m];
  parameter Time T = 10 [ms];
  Length x(start = 0, fixed = true);
equation
  T*der(x) = F/k - x;
  assert(x < 190 [um], "the stop is hit");
end Spring;

model Bent = Spring(T = 20 [ms]);

experiment press of Spring
  stimulus F = 100 [N];
  measure Length highest = max(x);
  measure Time late = T;
  expect max(x) < 180 [um] "within reach";
  stop 100 [ms] every 1 [ms];
end press;

sweep soft of press
  vary model = {Spring, Bent};
  vary k in 0.5e6 .. 2e6 [N/m], T in 5 .. 15 [ms];
  latin 40;
  keep x;
end soft;
"#;

/// A batch of the spring, and its page.
fn page(folder: &Folder, form: &str) -> String {
    let model = folder.file("press.hyde", SPRING);
    let out = folder.path("batch");
    let sweep = hyde(&[
        "sweep", &model, "soft", "--out", &out, "--quiet", "--format", form,
    ]);
    assert_eq!(status(&sweep), 0, "{}", errors(&sweep));
    let report = hyde(&["report", &out]);
    assert_eq!(status(&report), 0, "{}", errors(&report));
    let page = format!("{out}/report.html");
    assert_eq!(text(&report).trim(), page);
    page
}

/// The texts between the tags, those of figures apart, a line each.
pub(crate) fn outline(html: &str) -> Vec<String> {
    let mut lines = Vec::new();
    let body = &html[html.find("<body>").unwrap()..];
    let mut rest = body;
    while let Some(open) = rest.find('<') {
        let words = rest[..open].trim();
        if !words.is_empty() {
            lines.push(unescaped(words));
        }
        rest = &rest[open..];
        let end = if rest.starts_with("<svg") {
            rest.find("</svg>").unwrap() + "</svg>".len()
        } else {
            rest.find('>').unwrap() + 1
        };
        rest = &rest[end..];
    }
    lines
}

/// A page without the minute in which it was made.
pub(crate) fn undated(html: &str) -> String {
    let made = "<dt>Made</dt><dd>";
    let at = html.find(made).unwrap() + made.len();
    let rest = &html[at..];
    let end = rest.find(" by Hyde").unwrap();
    format!("{}{}", &html[..at], &rest[end..])
}

/// What a browser writes in full and the page need not, and the other way round.
fn unescaped(words: &str) -> String {
    let marks = [
        ("&#39;", "'"),
        ("&quot;", "\""),
        ("&lt;", "<"),
        ("&gt;", ">"),
        ("&amp;", "&"),
    ];
    let replaced = |words: String, (mark, plain): (&str, &str)| words.replace(mark, plain);
    marks.into_iter().fold(words.to_owned(), replaced)
}

#[test]
fn the_page_has_all_that_was_found() {
    let folder = Folder::new();
    let html = read(&page(&folder, "parquet"));
    let lines = outline(&html);
    let has = |word: &str| lines.iter().any(|line| line == word);
    for word in [
        "soft of press of Spring",
        "Sweep",
        "press",
        "Verdict",
        "Measures",
        "highest",
        "median",
        "Distribution of highest",
        "Distribution of highest by model",
        "Inputs against measures",
        "Over time",
        "Cases to look at",
        "Failed cases",
        "Spring, Bent",
    ] {
        assert!(has(word), "{word}: {lines:#?}");
    }
    // Steady state is F/k: the softer the spring, the farther.
    let over = |words: &str| lines.iter().find(|line| line.starts_with(words)).unwrap();
    let correlation = over("highest over k: ").rsplit(' ').next().unwrap();
    let correlation: f64 = correlation.replace('−', "-").parse().unwrap();
    assert!(correlation < -0.95, "{correlation}");
    assert!(over("late over T: ").ends_with("+1.00"));
    // Springs softer than 100 N/190 um = 0.526 MN/m hit the stop: 2 of 40 strata, in each model.
    assert!(lines.iter().any(|line| line.contains("the stop is hit")));
    let rerun = format!("hyde sweep {} --case ", folder.path("batch"));
    let runs: Vec<&String> = lines
        .iter()
        .filter(|line| line.starts_with(&rerun))
        .collect();
    assert!(runs.len() > 6, "{runs:?}");
    let words: Vec<&str> = runs[0].split(' ').skip(1).collect();
    // The case with the largest way is beyond the 180 um that it is expected to keep.
    assert_eq!(status(&hyde(&words)), 4, "{words:?}");
    // Nothing is fetched.
    for word in ["http://", "https://", "src=", "@import", "<script"] {
        let found = html.replace("http://www.w3.org/2000/svg", "");
        assert!(!found.contains(word), "{word}");
    }
    assert!(html.len() < 400_000, "{} bytes", html.len());
}

#[test]
fn the_form_of_the_data_set_does_not_matter() {
    let (one, other) = (Folder::new(), Folder::new());
    let of = |folder: &Folder, form| {
        let html = read(&page(folder, form));
        let html = html.replace(&folder.path("batch"), "DIR");
        undated(&html.replace(&folder.path("press.hyde"), "FILE"))
    };
    assert_eq!(of(&one, "parquet"), of(&other, "csv"));
}

#[test]
fn a_folder_without_a_finished_batch_is_refused() {
    let folder = Folder::new();
    folder.file("out/results.csv", "t [s],x\n0,1\n");
    let output = hyde(&["report", &folder.path("out")]);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("contains no batch"),
        "{}",
        errors(&output)
    );
    let page = page(&folder, "parquet");
    let batch = Path::new(&page).parent().unwrap();
    std::fs::remove_file(batch.join("cases.parquet")).unwrap();
    let output = hyde(&["report", &batch.to_string_lossy()]);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("is not finished"),
        "{}",
        errors(&output)
    );
}

/// Browsers that render a page without a screen.
const BROWSERS: [&str; 3] = ["chromium", "chromium-browser", "google-chrome"];

/// One of them that is here.
pub(crate) fn browser() -> Option<&'static str> {
    BROWSERS.into_iter().find(|browser| {
        let version = Command::new(browser).arg("--version").output();
        version.is_ok_and(|output| output.status.success())
    })
}

/// The same; that there is none is told.
pub(crate) fn browser_or_say() -> Option<&'static str> {
    let found = browser();
    if found.is_none() {
        let mut log = std::io::stderr();
        writeln!(
            log,
            "skipped: no browser is here; `./dev setup` installs one"
        )
        .unwrap();
    }
    found
}

/// A browser's answer about a page; none where it is not there.
pub(crate) fn browsed(
    browser: &str,
    profile: &str,
    options: &[&str],
    page: &str,
) -> Option<Vec<u8>> {
    let output = Command::new(browser)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--hide-scrollbars",
        ])
        .arg(format!("--user-data-dir={profile}"))
        // No network: every name fails.
        .arg("--host-resolver-rules=MAP * ~NOTFOUND")
        .args(options)
        .arg(format!("file://{page}"))
        .output();
    match output {
        Ok(output) => {
            assert!(
                output.status.success(),
                "{}",
                String::from_utf8_lossy(&output.stderr)
            );
            Some(output.stdout)
        }
        Err(_) => None,
    }
}

#[test]
fn a_browser_shows_the_page() {
    let folder = Folder::new();
    let page = page(&folder, "parquet");
    let profile = folder.path("profile");
    let Some(browser) = browser() else {
        println!("not tested: none of {} is here", BROWSERS.join(", "));
        return;
    };
    let dom = browsed(browser, &profile, &["--dump-dom"], &page).unwrap();
    let dom = String::from_utf8(dom).unwrap();
    // What the parser of a browser made of it has the texts and the figures of the file.
    let html = read(&page);
    assert_eq!(outline(&dom), outline(&html));
    let figures = |text: &str| text.matches("<svg").count();
    assert!(figures(&dom) >= 8, "{} figures", figures(&dom));
    assert_eq!(figures(&dom), figures(&html));
    let picture = folder.path("page.png");
    let shot = format!("--screenshot={picture}");
    browsed(
        browser,
        &profile,
        &[&shot, "--window-size=1280,2000"],
        &page,
    )
    .unwrap();
    let bytes = std::fs::read(&picture).unwrap();
    assert!(bytes.starts_with(b"\x89PNG"));
    assert_eq!(bytes[16..20], 1280_u32.to_be_bytes());
    // An empty page of this size is packed into 12 kB.
    assert!(bytes.len() > 60_000, "{} bytes", bytes.len());
    crate::readable_pages::is_readable(&page);
}
