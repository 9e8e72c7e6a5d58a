//! `live_slider_ms`: from a slider of the Y axis to the answer with the first curves, over HTTP as the page asks. The rest of a
//! long run follows.

use super::clock::now;
use super::promise::{Figure, Measured, Promise};
use crate::root;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::process::{Command, Stdio};

pub(super) const SLIDER: Figure = Figure {
    name: "live_slider_ms",
    unit: "ms",
    promise: Promise::AtMost(100.0),
    measure: |_| median().map(Measured::Value),
};

/// How often the slider is moved.
const ROUNDS: u32 = 11;

fn median() -> Result<f64, String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let file = root().join("examples/y_axis/axis.hyde");
    let mut child = Command::new(own)
        .arg("live")
        .arg(file)
        .arg("positioning")
        .stdout(Stdio::piped())
        .spawn()
        .map_err(|error| error.to_string())?;
    let mut line = String::new();
    let output = child.stdout.take();
    let read = output.map(|output| BufReader::new(output).read_line(&mut line));
    let times = match read {
        Some(Ok(_)) => times(line.trim()),
        _ => Err("the command says no address".to_owned()),
    };
    drop(child.kill());
    drop(child.wait());
    let mut times = times?;
    times.sort_by(f64::total_cmp);
    Ok(times[times.len() / 2])
}

fn times(address: &str) -> Result<Vec<f64>, String> {
    let mut times = Vec::new();
    for round in 0..ROUNDS {
        let start = now();
        let mass = 250.0 + f64::from(round);
        let answer = run(address, &format!("{{\"saddle.M\":{mass}}}"));
        let answer = answer.map_err(|error| error.to_string())?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
        if !answer.contains("\"ok\":true") || !answer.contains("<svg") {
            return Err(format!(
                "no curve: {}",
                answer.get(..200).unwrap_or(&answer)
            ));
        }
    }
    Ok(times)
}

/// The answer to values of sliders.
fn run(address: &str, values: &str) -> std::io::Result<String> {
    let rest = address.trim_start_matches("http://");
    let (host, path) = rest.split_at(rest.find('/').unwrap_or(rest.len()));
    let mut stream = TcpStream::connect(host)?;
    let length = values.len();
    let text = format!(
        "POST {path}begin HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\n\
         Content-Length: {length}\r\nConnection: close\r\n\r\n{values}"
    );
    stream.write_all(text.as_bytes())?;
    let mut answer = String::new();
    stream.read_to_string(&mut answer)?;
    Ok(answer)
}
