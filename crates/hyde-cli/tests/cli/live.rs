//! `hyde live`: its page in a browser without a screen; a slider, the file saved, values written back. Without a browser the
//! test says so and drives the server alone.

pub(crate) mod browser;
mod http;

use crate::command::{Folder, LAG, command, errors, hyde, status};
use browser::Browser;
use http::{ask, post};
use serde_json::{Value, json};
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Child, Stdio};

/// The command, ended with the test.
struct Live {
    child: Child,
    address: String,
}

impl Live {
    fn start(arguments: &[&str]) -> Self {
        let mut all = vec!["live"];
        all.extend(arguments);
        let mut child = command(&all).stdout(Stdio::piped()).spawn().unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let address = lines.next().unwrap().unwrap();
        assert!(address.starts_with("http://127.0.0.1:"), "{address}");
        Self { child, address }
    }

    fn at(&self, path: &str) -> String {
        format!("{}{path}", self.address)
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}

/// The lag, with a time constant that is uncertain and a comment.
fn model() -> String {
    LAG.replace("T = 10 [ms];", "T = 10 [ms] ~ ±20%; // of the filter")
}

#[test]
fn a_browser_moves_a_slider_and_writes_the_value_back() {
    let Some(name) = crate::report::browser_or_say() else {
        return;
    };
    let folder = Folder::new();
    let file = folder.file("lag.hyde", &model());
    let live = Live::start(&[&file]);
    let mut browser = Browser::open(name, &folder, &live.address);
    browser.wait("document.querySelectorAll('#result svg').length > 0");
    assert_eq!(
        browser.value("document.getElementById('title').textContent"),
        json!("step of Lag")
    );
    let curve = "document.querySelector('#result svg').innerHTML.length + ':' + \
                 Array.from(document.querySelectorAll('#result svg path')).map(p => p.getAttribute('d')).join('')";
    let before = browser.value(curve);
    // By the keyboard: ten steps to the right.
    browser.value("document.getElementById('p-T').focus(); document.body.dataset.runs = '0'; 0");
    browser.key("ArrowRight", true);
    browser.wait("Number(document.body.dataset.runs) > 0");
    let moved = browser.value("document.querySelector('.moved input[type=number]').value");
    assert_eq!(moved, json!("10.8"), "ten of 200 steps of 16 ms");
    let after = browser.value(curve);
    assert_ne!(before, after, "another curve");
    browser.value("document.getElementById('write').click(); 0");
    browser.wait("document.getElementById('told').textContent.startsWith('written')");
    let text = std::fs::read_to_string(&file).unwrap();
    assert_eq!(text, model().replace("T = 10 [ms]", "T = 10.8 [ms]"));
    // The page follows the file: nothing is moved any more.
    browser.wait("document.querySelectorAll('.moved').length === 0");
    // An error is shown as the console shows it, and goes when it is repaired.
    std::fs::write(&file, text.replace("u - x", "u - y")).unwrap();
    browser.wait("!document.getElementById('error').hidden");
    let shown = browser.value("document.getElementById('error').textContent");
    assert!(
        shown.as_str().unwrap().contains("error[E0201]")
            || shown.as_str().unwrap().contains("there is no `y`"),
        "{shown}"
    );
    std::fs::write(&file, &text).unwrap();
    browser.wait("document.getElementById('error').hidden");
    // Nothing was fetched from elsewhere.
    let foreign = "performance.getEntriesByType('resource').filter(e => !e.name.startsWith(location.origin)).length";
    assert_eq!(browser.value(foreign), json!(0));
}

/// A mass on a spring of 1.5 kN/m, pushed as in a record and held back by a loop of 0.5 kN/m; another experiment asks for its
/// frequency response and the margins of the loop.
const PUSHED: &str = r#"package pushed "a mass on a spring";
import SI.*;
import Translational.*;

model Pushed "a mass on a spring"
  input Force F;
  Force back = 500 [N/m]*body.s "of the loop";
  Drive push(F = F - back);
  Mass body(M = 2 [kg] ~ ±50%);
  SpringDamper spring(c = 1.5e3 [N/m], d = 4 [N.s/m]);
  Fixed wall;
equation
  connect(push.a, body.a, spring.a);
  connect(spring.b, wall.a);
end Pushed;

experiment shove(record log = "log.csv") of Pushed "pushed at once"
  stimulus F = log.F;
  measured log.s = body.s ~ 0.1 [mm];
  stop log.end every 1 [ms];
end shove;

experiment swept of Pushed "its response"
  bode from F to body.s over 1 [Hz] .. 20 [Hz];
  margins of back;
  stop 1 [s];
end swept;
"#;

#[test]
fn everything_follows_a_slider_that_the_keyboard_moves() {
    let Some(name) = crate::report::browser_or_say() else {
        return;
    };
    let folder = Folder::new();
    let file = folder.file("pushed.hyde", PUSHED);
    // A mass of 2.3 kg: s'' = (F - c s - d s')/M.
    let (mass, c, d, force) = (2.3_f64, 2e3, 4.0, 10.0);
    let (decay, frequency) = (d / (2.0 * mass), c / mass);
    let turning = (frequency - decay * decay).sqrt();
    let mut log = String::from("time [s],F [N],s [m]\n");
    for k in 0..=500 {
        let t = f64::from(k) * 1e-3;
        let ring = (turning * t).cos() + decay / turning * (turning * t).sin();
        let s = force / c * (1.0 - (-decay * t).exp() * ring);
        log.push_str(&format!("{t},{force},{s:.7}\n"));
    }
    folder.file("log.csv", &log);
    let live = Live::start(&[&file, "shove"]);
    let mut browser = Browser::open(name, &folder, &live.address);
    browser.wait("document.body?.dataset.runs === '1'");
    let paths = |id: &str| {
        format!(
            "Array.from(document.querySelectorAll('#{id} svg path')).map(p => p.getAttribute('d')).join('')"
        )
    };
    let row = |id: &str, heading: &str, column: u32| {
        format!(
            "[...document.querySelectorAll('#{id} section')].find(s => s.querySelector('h2').textContent \
             .startsWith('{heading}')).querySelectorAll('tbody td')[{column}].textContent"
        )
    };
    let seen = |browser: &mut Browser| {
        [
            paths("result"),
            paths("frequencies"),
            row("result", "Measured", 2),
            row("frequencies", "Natural", 0),
        ]
        .map(|expression| browser.value(&expression))
    };
    let before = seen(&mut browser);
    let number = |value: &Value| value.as_str().unwrap().trim().parse::<f64>().unwrap();
    // 2 kg on 2 kN/m, with the loop.
    assert!((number(&before[3]) - 5.033).abs() < 1e-3, "{}", before[3]);
    let text = browser.value("document.getElementById('frequencies').textContent");
    for told in ["experiment swept", "Frequency responses", "Margins at back"] {
        assert!(text.as_str().unwrap().contains(told), "{told}: {text}");
    }
    // From the top of the page: the first slider, by ten of 200 steps of 6 kg to the mass of the record.
    browser.key("Tab", false);
    browser.key("ArrowRight", true);
    browser.wait("document.body.dataset.runs === '2'");
    let moved = browser.value("document.querySelector('.moved input[type=number]').value");
    assert_eq!(moved, json!("2.3"));
    let after = seen(&mut browser);
    for (before, after) in before.iter().zip(&after) {
        assert_ne!(before, after);
    }
    let error = [&before[2], &after[2]].map(number);
    assert!(
        error[1] < 0.02 * error[0],
        "the mass of the record: {error:?}"
    );
    let expected = 5.033 * (2.0_f64 / 2.3).sqrt();
    assert!((number(&after[3]) - expected).abs() < 2e-3, "{}", after[3]);
    crate::readable_pages::shows_well(&mut browser, "hyde live");
    // Back to the button, and the value is in the file.
    browser.show(1280, "screen", "light");
    browser.key("Tab", true);
    browser.key("Enter", false);
    browser.wait("document.getElementById('told').textContent.startsWith('written')");
    let text = std::fs::read_to_string(&file).unwrap();
    assert_eq!(text, PUSHED.replace("M = 2 [kg]", "M = 2.3 [kg]"));
}

#[test]
fn a_run_with_other_values_has_another_curve_and_nothing_else_gets_an_answer() {
    let folder = Folder::new();
    let file = folder.file("lag.hyde", &model());
    let live = Live::start(&[&file, "step"]);
    let state: Value = serde_json::from_str(&ask(&live.at("state")).1).unwrap();
    assert_eq!(state["sliders"][0]["name"], "T", "{state}");
    assert_eq!(state["sliders"][0]["unit"], "ms");
    let run = |values: Value| -> Value {
        let (status, body) = post(&live.at("run"), &values.to_string());
        assert_eq!(status, 200, "{body}");
        serde_json::from_str(&body).unwrap()
    };
    let (first, slow) = (run(json!({})), run(json!({ "T": 20.0 })));
    assert_eq!(first["ok"], true, "{first}");
    assert!(first["body"].as_str().unwrap().contains("<svg"));
    assert_ne!(first["body"], slow["body"]);
    let refused = run(json!({ "tau": 1.0 }));
    assert!(
        refused["error"]
            .as_str()
            .unwrap()
            .contains("no parameter `tau`"),
        "{refused}"
    );
    let (_, begun) = post(&live.at("begin"), "{}");
    assert!(begun.contains("<svg"), "{begun}");
    let (status, body) = post(&live.at("frequencies"), "{}");
    assert!(
        status == 200 && body.contains("Natural frequencies"),
        "{body}"
    );
    // Another address, another name of the host, another way: nothing.
    let (at, _) = live.address.trim_end_matches('/').rsplit_once('/').unwrap();
    assert_eq!(ask(&format!("{at}/")).0, 404);
    assert_eq!(
        ask(&format!("{at}/0123456789abcdef0123456789abcdef/state")).0,
        404
    );
    assert_eq!(
        http::request(&live.at("state"), "GET", "evil.example", "").0,
        404
    );
    // No room is made for a body that is announced too long.
    let mut stream = TcpStream::connect(at.trim_start_matches("http://")).unwrap();
    let request = "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 99999999999999\r\n\r\n{}";
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = [0; 12];
    stream.read_exact(&mut answer).unwrap();
    assert_eq!(&answer, b"HTTP/1.1 413");
    assert_eq!(ask(&live.at("state")).0, 200);
    // A value that is written goes into the experiment where the file has no number for it.
    let text = model().replace("T = 10 [ms]", "T(min = 1 [ms]) = 2*(5 [ms])");
    std::fs::write(&file, &text).unwrap();
    let mut written = String::new();
    for _ in 0..100 {
        std::thread::sleep(std::time::Duration::from_millis(50));
        (_, written) = post(&live.at("write"), &json!({ "T": 0.0125 }).to_string());
        if written.contains("\"ok\":true") {
            break;
        }
    }
    assert!(written.contains("\"ok\":true"), "{written}");
    // The written file is loaded again first.
    let mut refused = String::new();
    for _ in 0..100 {
        (_, refused) = post(&live.at("write"), &json!({ "T": 0.0005 }).to_string());
        if !refused.contains("has changed since it was loaded") {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(50));
    }
    assert!(refused.contains("its `min` is 0.001 s"), "{refused}");
    let new = std::fs::read_to_string(&file).unwrap();
    assert_eq!(
        new,
        text.replace("step of Lag", "step of Lag(T = 0.0125 [s])")
    );
}

#[test]
fn what_cannot_be_shown_is_told_before_a_page_is_there() {
    let folder = Folder::new();
    let output = hyde(&["live", &folder.path("none.hyde")]);
    assert_eq!(status(&output), 2);
    assert!(errors(&output).contains("none.hyde"), "{}", errors(&output));
    let model = folder.file("lag.hyde", LAG.split("experiment").next().unwrap());
    let output = hyde(&["live", &model]);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("no experiment"),
        "{}",
        errors(&output)
    );
}
