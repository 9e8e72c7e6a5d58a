//! Requests over HTTP, as plain as they are.

use std::io::{Read as _, Write as _};
use std::net::TcpStream;

/// Status and body of a page.
pub(crate) fn ask(url: &str) -> (u16, String) {
    let (host, _) = parts(url);
    request(url, "GET", host, "")
}

/// Status and body of the answer to some JSON.
pub(crate) fn post(url: &str, body: &str) -> (u16, String) {
    let (host, _) = parts(url);
    request(url, "POST", host, body)
}

/// A request with the name of a host.
pub(crate) fn request(url: &str, method: &str, host: &str, body: &str) -> (u16, String) {
    let (at, path) = parts(url);
    let mut stream = TcpStream::connect(at).unwrap();
    let length = body.len();
    let head = format!(
        "{method} {path} HTTP/1.1\r\nHost: {host}\r\nContent-Type: application/json\r\n\
         Content-Length: {length}\r\nConnection: close\r\n\r\n{body}"
    );
    stream.write_all(head.as_bytes()).unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    let status = answer.split(' ').nth(1).unwrap().parse().unwrap();
    let (_, body) = answer.split_once("\r\n\r\n").unwrap();
    (status, body.to_owned())
}

fn parts(url: &str) -> (&str, &str) {
    let rest = url.strip_prefix("http://").unwrap();
    rest.split_at(rest.find('/').unwrap())
}
