//! A browser without a screen, steered by the protocol of its developer tools over two pipes.

use crate::command::Folder;
use serde_json::{Value, json};
use std::fs::{File, OpenOptions};
use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// How long something may take on a busy machine.
const LONGEST: Duration = Duration::from_secs(60);

pub(crate) struct Browser {
    child: Child,
    input: File,
    output: BufReader<File>,
    last: u64,
    session: Value,
}

impl Browser {
    /// A browser that shows a page.
    pub(crate) fn open(name: &str, folder: &Folder, url: &str) -> Self {
        let [to, from] = ["to", "from"].map(|own| folder.path(own));
        let made = Command::new("mkfifo").args([&to, &from]).status().unwrap();
        assert!(made.success());
        // The browser reads from descriptor 3 and writes to descriptor 4.
        let child = Command::new("sh")
            .args(["-c", "exec \"$0\" \"$@\" 3<\"$TO\" 4>\"$FROM\"", name])
            .args(["--headless", "--no-sandbox", "--disable-gpu"])
            .arg(format!("--user-data-dir={}", folder.path("profile")))
            .args(["--remote-debugging-pipe", "about:blank"])
            .envs([("TO", &to), ("FROM", &from)])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let input = OpenOptions::new().write(true).open(&to).unwrap();
        let output = BufReader::new(File::open(&from).unwrap());
        let mut browser = Self {
            child,
            input,
            output,
            last: 0,
            session: Value::Null,
        };
        let target = browser.call("Target.createTarget", json!({ "url": url }));
        let target = target["targetId"].clone();
        let attach = json!({ "targetId": target, "flatten": true });
        browser.session = browser.call("Target.attachToTarget", attach)["sessionId"].clone();
        browser
    }

    /// Shows the page so many px wide, as on a `screen` or for `print`, with light or dark colours.
    pub(crate) fn show(&mut self, width: u32, media: &str, colours: &str) {
        let size =
            json!({ "width": width, "height": 844, "deviceScaleFactor": 1, "mobile": width < 500 });
        self.call("Emulation.setDeviceMetricsOverride", size);
        let feature = json!({ "name": "prefers-color-scheme", "value": colours });
        let media = json!({ "media": media, "features": [feature] });
        self.call("Emulation.setEmulatedMedia", media);
    }

    /// The value of an expression in the page.
    pub(crate) fn value(&mut self, expression: &str) -> Value {
        let params = json!({ "expression": expression, "returnByValue": true });
        let found = self.call("Runtime.evaluate", params);
        assert!(
            found.get("exceptionDetails").is_none(),
            "{expression}: {found}"
        );
        found["result"]["value"].clone()
    }

    /// Waits until a condition holds in the page.
    pub(crate) fn wait(&mut self, condition: &str) {
        let start = Instant::now();
        while self.value(condition) != json!(true) {
            if start.elapsed() > LONGEST {
                let page = self.value("document.body.innerText");
                panic!("{condition} does not hold: {page}");
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Presses a key, with Shift or without.
    pub(crate) fn key(&mut self, key: &str, shift: bool) {
        let code = json!({ "ArrowRight": 39, "Tab": 9, "Enter": 13 })[key].clone();
        for kind in ["keyDown", "keyUp"] {
            let mut params = json!({ "type": kind, "key": key, "code": key,
                "windowsVirtualKeyCode": code, "modifiers": if shift { 8 } else { 0 } });
            // A button is pressed by the character.
            if key == "Enter" && kind == "keyDown" {
                params["text"] = json!("\r");
            }
            self.call("Input.dispatchKeyEvent", params);
        }
    }

    fn call(&mut self, method: &str, params: Value) -> Value {
        self.last += 1;
        let mut message = json!({ "id": self.last, "method": method, "params": params });
        if !self.session.is_null() {
            message["sessionId"] = self.session.clone();
        }
        self.input
            .write_all(message.to_string().as_bytes())
            .unwrap();
        self.input.write_all(&[0]).unwrap();
        loop {
            let mut answer = Vec::new();
            self.output.read_until(0, &mut answer).unwrap();
            assert_eq!(answer.pop(), Some(0), "the browser is gone");
            let answer: Value = serde_json::from_slice(&answer).unwrap();
            if answer["id"] == json!(self.last) {
                assert!(answer.get("error").is_none(), "{method}: {answer}");
                return answer["result"].clone();
            }
        }
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}
