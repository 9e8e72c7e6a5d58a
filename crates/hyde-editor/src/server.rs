//! Messages in and out: the texts follow the editor, syntax errors are shown at every change, and a full check runs after a
//! pause. A change that comes before drops the check.

use crate::analysis::Analysis;
use crate::answer::answer;
use crate::capabilities::{capabilities, encoding, folders, refreshes_lenses, shows_documents};
use crate::check::{Checked, Job, check};
use crate::documents::Documents;
use crate::lens::{Action, Instant, Order};
use crate::outcome::Outcome;
use crate::position::Encoding;
use crate::publish::published;
use crate::runs::{OF_RUN, Ran, Runs, marked};
use crate::uri;
use crossbeam_channel::{Receiver, Sender, after, bounded, never, select, unbounded};
use hyde_diag::{Code, Diagnostics, Sources};
use hyde_study::world::{World, read_text};
use hyde_syntax::ast::File;
use lsp_server::{Connection, ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::notification as tell;
use lsp_types::notification::Notification as _;
use lsp_types::request::{CodeLensRefresh, Request as _, ShowDocument, Shutdown};
use lsp_types::{
    InitializeParams, MessageType, NumberOrString, Position, PublishDiagnosticsParams,
    ShowDocumentParams, ShowMessageParams,
};
use serde_json::{Value, json};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

/// The pause after the last change before a full check.
pub const PAUSE: Duration = Duration::from_millis(250);

/// What the server asks of the program that it is part of.
pub trait Host {
    /// The file of a package of the library, written if it is not there: an editor opens files. `name` is that of the source
    /// text, `Drives/Screws.hyde`.
    fn library_file(&self, name: &str, text: &str) -> Option<PathBuf>;

    /// What a code means, as Markdown.
    fn explanation(&self, code: Code) -> String;

    /// Starts a command and comes back at once; `done` is told how it ended.
    fn start(&self, order: Order, done: Box<dyn FnOnce(Outcome) + Send>);
}

/// The state of a session.
pub(crate) struct Server {
    pub(crate) documents: Documents,
    pub(crate) encoding: Encoding,
    /// The folders that the editor works in.
    pub(crate) folders: Vec<PathBuf>,
    pub(crate) host: Box<dyn Host>,
    /// What was published for each text.
    published: BTreeMap<PathBuf, Vec<lsp_types::Diagnostic>>,
    /// The last run of each file.
    pub(crate) runs: RefCell<Runs>,
    /// What ended the last run of a file, with the text that was run.
    failed: BTreeMap<PathBuf, (String, Vec<lsp_types::Diagnostic>)>,
    /// Whether the editor can show a page, and asks for lenses again.
    shows_documents: bool,
    refreshes_lenses: bool,
    /// Where commands tell that they are done.
    told: Sender<Told>,
    /// The analyses of the present revision.
    analyses: RefCell<(u64, BTreeMap<PathBuf, Rc<Analysis>>)>,
}

/// What comes from elsewhere than the editor.
enum Told {
    /// A command ended: what was asked for, the text that it read, and how it ended.
    Ended(Order, String, Outcome),
    /// Another instant was chosen.
    Instant,
}

/// How a session ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// By `exit` after `shutdown`.
    ShutDown,
    /// By `exit` alone.
    Exit,
    /// The editor is gone.
    Gone,
}

/// Serves an editor until it ends the session.
///
/// # Errors
/// The editor does not keep to the protocol.
pub fn serve(
    connection: &Connection,
    disk: Arc<dyn World>,
    host: Box<dyn Host>,
) -> Result<Ended, String> {
    let (id, params) = connection
        .initialize_start()
        .map_err(|error| error.to_string())?;
    let params: InitializeParams =
        serde_json::from_value(params).map_err(|error| error.to_string())?;
    let encoding = encoding(&params);
    let answer = json!({
        "capabilities": capabilities(encoding),
        "serverInfo": { "name": "hyde", "version": env!("CARGO_PKG_VERSION") },
    });
    connection
        .initialize_finish(id, answer)
        .map_err(|error| error.to_string())?;
    let (told, heard) = unbounded();
    let server = Server {
        runs: RefCell::default(),
        failed: BTreeMap::new(),
        shows_documents: shows_documents(&params),
        refreshes_lenses: refreshes_lenses(&params),
        told,
        documents: Documents::over(disk),
        encoding,
        folders: folders(&params),
        host,
        published: BTreeMap::new(),
        analyses: RefCell::default(),
    };
    let (jobs, to_do) = bounded::<Job>(1);
    let (done, results) = unbounded::<Checked>();
    std::thread::scope(|scope| {
        scope.spawn(move || work(&to_do, &done));
        Ok(server.run(connection, jobs, (&results, &heard)))
    })
}

/// Checks one text after the other.
fn work(jobs: &Receiver<Job>, done: &Sender<Checked>) {
    for job in jobs {
        if done.send(check(&job)).is_err() {
            return;
        }
    }
}

impl Server {
    /// Follows the editor until it says `exit`, or is gone.
    fn run(
        mut self,
        connection: &Connection,
        jobs: Sender<Job>,
        (results, heard): (&Receiver<Checked>, &Receiver<Told>),
    ) -> Ended {
        let mut asked = 0;
        let mut shut_down = false;
        // The texts to check once the pause is over.
        let mut due: BTreeSet<PathBuf> = BTreeSet::new();
        let mut pause = never();
        let (mut quiet, mut busy) = (true, false);
        loop {
            if quiet
                && !busy
                && let Some(path) = due.pop_first()
            {
                busy = jobs.send(self.job(path)).is_ok();
            }
            select! {
                recv(connection.receiver) -> message => {
                    let Ok(message) = message else {
                        return if shut_down { Ended::ShutDown } else { Ended::Gone };
                    };
                    match message {
                        Message::Request(request) if shut_down => {
                            let reason = "the session was shut down".to_owned();
                            let code = ErrorCode::InvalidRequest as i32;
                            let refused = Response::new_err(request.id, code, reason);
                            send(connection, Message::Response(refused));
                        }
                        Message::Request(request) if request.method == Shutdown::METHOD => {
                            shut_down = true;
                            let done = Response::new_ok(request.id, ());
                            send(connection, Message::Response(done));
                        }
                        Message::Notification(told) if told.method == tell::Exit::METHOD => {
                            return if shut_down { Ended::ShutDown } else { Ended::Exit };
                        }
                        Message::Request(request) => {
                            send(connection, Message::Response(self.respond(request)));
                        }
                        Message::Notification(told) => {
                            let paths = self.follow(connection, told);
                            if !paths.is_empty() {
                                due.extend(paths);
                                quiet = false;
                                pause = after(PAUSE);
                            }
                        }
                        Message::Response(_) => {}
                    }
                }
                recv(results) -> checked => {
                    busy = false;
                    if let Ok(checked) = checked {
                        self.checked(connection, checked);
                    }
                }
                recv(heard) -> told => {
                    asked += 1;
                    if let Ok(Told::Ended(order, text, outcome)) = told {
                        let page = outcome.page.clone();
                        self.ended(connection, &order, text, outcome);
                        self.show(connection, page, asked);
                    }
                    if self.refreshes_lenses {
                        let id = RequestId::from(format!("lenses-{asked}"));
                        let method = CodeLensRefresh::METHOD.to_owned();
                        send(connection, Request::new(id, method, Value::Null).into());
                    }
                }
                recv(pause) -> _ => {
                    quiet = true;
                    pause = never();
                }
            }
        }
    }

    /// Has the editor show a page that a command wrote, or the reason why there is none.
    fn show(&self, connection: &Connection, page: Result<PathBuf, String>, number: i32) {
        let say = |typ: MessageType, message: String| {
            let params = ShowMessageParams { typ, message };
            let method = tell::ShowMessage::METHOD.to_owned();
            send(connection, Notification::new(method, params).into());
        };
        match page {
            Err(reason) => say(MessageType::ERROR, reason),
            Ok(page) => match uri::of(&page).filter(|_| self.shows_documents) {
                None => say(MessageType::INFO, format!("the page is {}", page.display())),
                Some(uri) => {
                    let params = ShowDocumentParams {
                        uri,
                        external: Some(true),
                        take_focus: Some(true),
                        selection: None,
                    };
                    let method = ShowDocument::METHOD.to_owned();
                    let id = RequestId::from(format!("page-{number}"));
                    send(connection, Request::new(id, method, params).into());
                }
            },
        }
    }

    /// Starts what a lens asks for.
    pub(crate) fn start(&self, order: Order) {
        let told = self.told.clone();
        let text = self.text(&order.file).unwrap_or_default();
        let asked = order.clone();
        let done = move |outcome| drop(told.send(Told::Ended(order, text, outcome)));
        self.host.start(asked, Box::new(done));
    }

    /// Chooses the instant of the values in hovers; false if there is no such run.
    pub(crate) fn choose(&self, instant: &Instant) -> bool {
        let known = self.runs.borrow_mut().choose(instant);
        if known {
            drop(self.told.send(Told::Instant));
        }
        known
    }

    /// Keeps what a run came to, and marks the equations at which it failed.
    fn ended(&mut self, connection: &Connection, order: &Order, text: String, outcome: Outcome) {
        if order.action != Action::Run {
            return;
        }
        let (path, experiment) = (&order.file, &order.name);
        let failed = outcome.failures.iter();
        let failed = failed.map(|own| marked(own, (path, &text), experiment, self.encoding));
        let failed: Vec<lsp_types::Diagnostic> = failed.collect();
        match outcome.courses {
            Some(courses) => {
                let ran = Ran {
                    experiment: experiment.clone(),
                    text: text.clone(),
                    courses,
                    failed: !failed.is_empty(),
                    instant: None,
                };
                self.runs.borrow_mut().put(path, ran);
            }
            None => self.runs.borrow_mut().forget(path),
        }
        self.failed.insert(path.clone(), (text, failed));
        if self.documents.get(path).is_some() {
            let known = self.published.get(path).cloned().unwrap_or_default();
            let known = known.into_iter().filter(|own| !is_of_run(own));
            self.publish(connection, path, known.collect());
        }
    }

    /// Whether a text is open and is not what the file on the disk has.
    pub(crate) fn is_unsaved(&self, path: &Path) -> bool {
        let open = self.documents.get(path).map(|own| &own.text);
        open.is_some_and(|text| self.documents.saved(path).as_ref() != Some(text))
    }

    fn respond(&self, request: Request) -> Response {
        let (id, method) = (request.id, request.method);
        // A defect in an answer must not end the session.
        let found = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            answer(self, &method, request.params)
        }));
        match found {
            Ok(Ok(value)) => Response::new_ok(id, value),
            Ok(Err((code, reason))) => Response::new_err(id, code as i32, reason),
            Err(_) => {
                let reason = format!("`{method}` failed; this is a defect of Hyde");
                Response::new_err(id, ErrorCode::InternalError as i32, reason)
            }
        }
    }

    /// Follows a notification; the texts that must be checked again.
    fn follow(&mut self, connection: &Connection, told: Notification) -> Vec<PathBuf> {
        let changed = match told.method.as_str() {
            tell::DidOpenTextDocument::METHOD => self.opened(told.params),
            tell::DidChangeTextDocument::METHOD => self.changed(told.params),
            tell::DidCloseTextDocument::METHOD => {
                self.closed(connection, told.params);
                None
            }
            tell::DidSaveTextDocument::METHOD | tell::DidChangeWatchedFiles::METHOD => {
                self.documents.disk_changed();
                return self.documents.paths().cloned().collect();
            }
            _ => return Vec::new(),
        };
        let Some(path) = changed else {
            return Vec::new();
        };
        let syntax = self.syntax(&path);
        self.publish(connection, &path, syntax);
        // The others may import it.
        self.documents.paths().cloned().collect()
    }

    fn opened(&mut self, params: Value) -> Option<PathBuf> {
        let params: lsp_types::DidOpenTextDocumentParams = serde_json::from_value(params).ok()?;
        let path = uri::path(&params.text_document.uri)?;
        let document = params.text_document;
        self.documents
            .open(path.clone(), document.text, document.version);
        Some(path)
    }

    fn changed(&mut self, params: Value) -> Option<PathBuf> {
        let params: lsp_types::DidChangeTextDocumentParams = serde_json::from_value(params).ok()?;
        let path = uri::path(&params.text_document.uri)?;
        let version = params.text_document.version;
        self.documents
            .change(&path, version, params.content_changes, self.encoding);
        Some(path)
    }

    fn closed(&mut self, connection: &Connection, params: Value) {
        let params = serde_json::from_value::<lsp_types::DidCloseTextDocumentParams>(params);
        let path = params
            .ok()
            .and_then(|own| uri::path(&own.text_document.uri));
        if let Some(path) = path {
            self.documents.close(&path);
            self.failed.remove(&path);
            self.publish(connection, &path, Vec::new());
            self.published.remove(&path);
        }
    }

    /// The syntax errors of a text.
    fn syntax(&self, path: &Path) -> Vec<lsp_types::Diagnostic> {
        let Some(document) = self.documents.get(path) else {
            return Vec::new();
        };
        let mut sources = Sources::new();
        let file = sources.add(path.to_string_lossy(), document.text.as_str());
        let mut diagnostics = Diagnostics::new();
        hyde_syntax::parse(&sources, file, &mut diagnostics);
        let found = diagnostics.iter();
        found
            .map(|own| published(own, &sources, Some(file), self.encoding))
            .collect()
    }

    fn job(&self, path: PathBuf) -> Job {
        Job {
            version: self.documents.get(&path).map(|own| own.version),
            world: self.documents.world(),
            revision: self.documents.revision,
            encoding: self.encoding,
            newest: Arc::clone(&self.documents.newest),
            path,
        }
    }

    /// Shows what a check found, unless a file has changed since: then another check is due.
    fn checked(&mut self, connection: &Connection, checked: Checked) {
        let current = self.documents.get(&checked.path).map(|own| own.version);
        if checked.revision == self.documents.revision && current == checked.version {
            self.publish(connection, &checked.path, checked.diagnostics);
        }
    }

    fn publish(
        &mut self,
        connection: &Connection,
        path: &Path,
        diagnostics: Vec<lsp_types::Diagnostic>,
    ) {
        let Some(uri) = uri::of(path) else {
            return;
        };
        // A failure of the text as it is; what the check says too is said once.
        let mut diagnostics = diagnostics;
        let text = self.documents.get(path).map(|own| &own.text);
        if let Some((_, failed)) = self.failed.get(path).filter(|own| Some(&own.0) == text) {
            let said = |own: &lsp_types::Diagnostic| {
                let mut known = diagnostics.iter();
                known.any(|other| other.code == own.code && other.range == own.range)
            };
            let new: Vec<_> = failed.iter().filter(|own| !said(own)).cloned().collect();
            diagnostics.extend(new);
        }
        let version = self.documents.get(path).map(|own| own.version);
        self.published
            .insert(path.to_path_buf(), diagnostics.clone());
        let params = PublishDiagnosticsParams::new(uri, diagnostics, version);
        let method = tell::PublishDiagnostics::METHOD.to_owned();
        send(
            connection,
            Message::Notification(Notification::new(method, params)),
        );
    }

    /// The codes of the diagnostics that are shown at a place.
    pub(crate) fn codes_at(&self, path: &Path, position: Position) -> Vec<String> {
        let shown = self.published.get(path).into_iter().flatten();
        let here = shown.filter(|own| own.range.start <= position && position <= own.range.end);
        let mut codes: Vec<String> = here
            .filter_map(|own| match &own.code {
                Some(NumberOrString::String(code)) => Some(code.clone()),
                Some(NumberOrString::Number(_)) | None => None,
            })
            .collect();
        codes.dedup();
        codes
    }

    /// The text of a file as the editor shows it.
    pub(crate) fn text(&self, path: &Path) -> Option<String> {
        match self.documents.get(path) {
            Some(document) => Some(document.text.clone()),
            None => read_text(self.documents.world().as_ref(), path).ok(),
        }
    }

    /// The tree of a file alone, and its text.
    pub(crate) fn tree(&self, path: &Path) -> Option<(File, String)> {
        let text = self.text(path)?;
        let mut sources = Sources::new();
        let file = sources.add("", text.as_str());
        let tree = hyde_syntax::parse(&sources, file, &mut Diagnostics::new());
        Some((tree, text))
    }

    /// The analysis of a file, made once for each state of the files.
    pub(crate) fn analysis(&self, path: &Path) -> Option<Rc<Analysis>> {
        let mut known = self.analyses.borrow_mut();
        let revision = self.documents.revision;
        if known.0 != revision {
            *known = (revision, BTreeMap::new());
        }
        if let Some(analysis) = known.1.get(path) {
            return Some(Rc::clone(analysis));
        }
        let analysis = Rc::new(Analysis::of(&self.documents.world(), path)?);
        known.1.insert(path.to_path_buf(), Rc::clone(&analysis));
        Some(analysis)
    }
}

/// Whether a diagnostic is what ended a run.
fn is_of_run(own: &lsp_types::Diagnostic) -> bool {
    let source = own.source.as_deref().unwrap_or_default();
    source.starts_with(OF_RUN)
}

/// A message to the editor; one that is gone gets none.
fn send(connection: &Connection, message: Message) {
    drop(connection.sender.send(message));
}
