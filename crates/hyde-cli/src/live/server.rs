//! The page and its requests, over HTTP on the loopback interface alone. Whoever does not know the random name in the address
//! gets nothing, nor does a page of another site: its browser says another host.

use super::session::{Moved, Session};
use super::updates::Updates;
use super::worker::{Wish, Worker};
use serde_json::Value;
use std::io::{Cursor, Read as _};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use tiny_http::{Header, Method, Request, Response, Server, StatusCode};

const PAGE: &str = include_str!("page/page.html");
const SCRIPT: &str = include_str!("page/page.js");
const STYLE: &str = include_str!("page/style.css");

/// Bytes of a request at most.
const MOST: usize = 1 << 20;

/// The page may load what this server has and nothing else.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; \
                      img-src 'self' data:; font-src data:; connect-src 'self'; base-uri 'none'; \
                      form-action 'none'; frame-ancestors 'none'";

/// Serves the page of a session until the process ends. `ready` is told the address.
///
/// # Errors
/// The port is taken, or the system gives no random numbers.
pub(crate) fn serve(session: Session, port: u16, ready: impl FnOnce(&str)) -> Result<(), String> {
    let at = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    let server = Server::http(at).map_err(|error| format!("port {port}: {error}"))?;
    let port = server.server_addr().to_ip().map_or(port, |own| own.port());
    let site = Site {
        secret: secret()?,
        hosts: [format!("127.0.0.1:{port}"), format!("localhost:{port}")],
        updates: Arc::default(),
    };
    let worker = Worker::start(session, Arc::clone(&site.updates));
    ready(&format!("http://127.0.0.1:{port}/{}/", site.secret));
    for request in server.incoming_requests() {
        site.answer(request, &worker);
    }
    Ok(())
}

/// A random name of 128 bits.
fn secret() -> Result<String, String> {
    let mut bytes = [0_u8; 16];
    getrandom::fill(&mut bytes).map_err(|error| error.to_string())?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

struct Site {
    secret: String,
    /// What a browser may call this server.
    hosts: [String; 2],
    updates: Arc<Updates>,
}

impl Site {
    fn answer(&self, mut request: Request, worker: &Worker) {
        if request.body_length().is_some_and(|length| length > MOST) {
            return refuse_body(request);
        }
        let path = request.url().to_owned();
        let own = path
            .strip_prefix('/')
            .and_then(|path| path.strip_prefix(self.secret.as_str()));
        let (Some(own), true) = (own, self.is_meant(&request)) else {
            return send(request, 404, "text/plain", "not found");
        };
        let is_json = header(&request, "Content-Type").as_deref() == Some("application/json");
        match (request.method(), own) {
            (Method::Get, "/") => send(request, 200, "text/html", PAGE),
            (Method::Get, "/page.js") => send(request, 200, "text/javascript", SCRIPT),
            (Method::Get, "/style.css") => {
                let style = format!("{}{STYLE}", hyde_report::STYLE);
                send(request, 200, "text/css", &style);
            }
            (Method::Get, "/state") => worker.ask(Wish::State, answered(request)),
            (Method::Get, "/events") => {
                let updates = Arc::clone(&self.updates);
                let writer = request.into_writer();
                std::thread::spawn(move || updates.follow(writer));
            }
            (Method::Post, "/run" | "/begin" | "/frequencies" | "/write") if is_json => {
                let mut body = String::new();
                let read = request
                    .as_reader()
                    .take(MOST as u64)
                    .read_to_string(&mut body);
                let moved = read
                    .ok()
                    .and_then(|_| serde_json::from_str::<Moved>(&body).ok());
                let wish = moved.map(|moved| match own {
                    "/run" => Wish::Run(moved),
                    "/begin" => Wish::Begin(moved),
                    "/frequencies" => Wish::Frequencies(moved),
                    _ => Wish::Write(moved),
                });
                match wish {
                    Some(wish) => worker.ask(wish, answered(request)),
                    None => send(request, 400, "text/plain", "not a list of values"),
                }
            }
            _ => send(request, 404, "text/plain", "not found"),
        }
    }

    /// Whether the browser means this server: a page of another site that has a name for this address does not.
    fn is_meant(&self, request: &Request) -> bool {
        let host = header(request, "Host");
        let origin = header(request, "Origin");
        let same = |origin: &String| {
            let mut own = self.hosts.iter();
            own.any(|host| *origin == format!("http://{host}"))
        };
        host.is_some_and(|host| self.hosts.contains(&host)) && origin.as_ref().is_none_or(same)
    }
}

fn header(request: &Request, name: &'static str) -> Option<String> {
    let all = request.headers().iter();
    let mut own = all.filter(|header| header.field.equiv(name));
    own.next().map(|header| header.value.as_str().to_owned())
}

/// An answer as JSON to a request that is kept until then.
fn answered(request: Request) -> Box<dyn FnOnce(Value) + Send> {
    Box::new(move |value: Value| send(request, 200, "application/json", &value.to_string()))
}

/// Answers a request whose body is too long without reading it. The stream is left open on purpose: where the library closes
/// it, it first makes room for as many bytes as the request announces.
fn refuse_body(request: Request) {
    let response = Response::from_string("the body is too long").with_status_code(413);
    std::mem::forget(request.upgrade("none", response));
}

/// Sends a text. A browser that is gone gets none.
fn send(request: Request, status: u16, kind: &str, text: &str) {
    let kind = format!("{kind}; charset=utf-8");
    let heads = [
        ("Content-Type", kind.as_str()),
        ("Content-Security-Policy", POLICY),
        ("Cache-Control", "no-store"),
        ("Referrer-Policy", "no-referrer"),
        ("X-Content-Type-Options", "nosniff"),
    ];
    let heads = heads
        .iter()
        .filter_map(|(name, value)| Header::from_bytes(name.as_bytes(), value.as_bytes()).ok());
    let body = text.as_bytes().to_vec();
    let length = body.len();
    let response = Response::new(
        StatusCode(status),
        heads.collect(),
        Cursor::new(body),
        Some(length),
        None,
    );
    // In one piece: its length is known.
    drop(request.respond(response.with_chunked_threshold(usize::MAX)));
}
