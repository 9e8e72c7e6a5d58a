//! Each request with its answer.

use crate::analysis::Analysis;
use crate::complete::complete;
use crate::describe;
use crate::fixes::fixes;
use crate::inlay;
use crate::lens;
use crate::outline;
use crate::position::Encoding;
use crate::rename::{self, Uses};
use crate::runs;
use crate::scope::Definition;
use crate::server::Server;
use crate::signature;
use crate::tokens;
use crate::uri;
use crate::values;
use hyde_diag::Code;
use hyde_syntax::ast::File;
use lsp_server::ErrorCode;
use lsp_types::request as ask;
use lsp_types::{
    CodeActionOrCommand, DocumentHighlight, DocumentSymbolResponse, GotoDefinitionResponse, Hover,
    HoverContents, Location, MarkupContent, MarkupKind, Position, PrepareRenameResponse,
    SemanticTokens, SymbolInformation, TextEdit, Uri, WorkspaceSymbolResponse,
};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Why a request has no answer.
pub(crate) type Refusal = (ErrorCode, String);

/// The answer to a request.
pub(crate) fn answer(server: &Server, method: &str, params: Value) -> Result<Value, Refusal> {
    macro_rules! dispatch {
        ($($request:ty => $handler:expr;)*) => {
            match method {
                $(<$request as ask::Request>::METHOD => {
                    let params = serde_json::from_value(params)
                        .map_err(|error| (ErrorCode::InvalidParams, error.to_string()))?;
                    let found: <$request as ask::Request>::Result = $handler(server, params)?;
                    serde_json::to_value(found)
                        .map_err(|error| (ErrorCode::InternalError, error.to_string()))
                })*
                _ => Err((ErrorCode::MethodNotFound, format!("`{method}` is not known"))),
            }
        };
    }
    dispatch! {
        ask::Formatting => formatting;
        ask::DocumentSymbolRequest => symbols;
        ask::FoldingRangeRequest => folds;
        ask::SelectionRangeRequest => selections;
        ask::HoverRequest => hover;
        ask::GotoDefinition => definition;
        ask::References => references;
        ask::DocumentHighlightRequest => highlights;
        ask::PrepareRenameRequest => prepare_rename;
        ask::Rename => renamed;
        ask::Completion => completion;
        ask::SignatureHelpRequest => signatures;
        ask::InlayHintRequest => hints;
        ask::CodeLensRequest => lenses;
        ask::ExecuteCommand => execute;
        ask::CodeActionRequest => actions;
        ask::SemanticTokensFullRequest => semantic;
        ask::WorkspaceSymbolRequest => workspace_symbols;
    }
}

/// A text with its address, encoding and analysis.
struct Asked {
    path: PathBuf,
    analysis: Rc<Analysis>,
    encoding: Encoding,
}

impl Asked {
    fn of(server: &Server, uri: &Uri) -> Option<Self> {
        let path = uri::path(uri)?;
        Some(Self {
            analysis: server.analysis(&path)?,
            path,
            encoding: server.encoding,
        })
    }

    fn byte(&self, position: Position) -> usize {
        self.encoding.byte(self.analysis.text(), position)
    }

    fn range(&self, bytes: std::ops::Range<usize>) -> lsp_types::Range {
        self.encoding.range(self.analysis.text(), bytes)
    }
}

fn formatting(
    server: &Server,
    params: lsp_types::DocumentFormattingParams,
) -> Result<Option<Vec<TextEdit>>, Refusal> {
    let Some(path) = uri::path(&params.text_document.uri) else {
        return Ok(None);
    };
    let Some(text) = server.text(&path) else {
        return Ok(None);
    };
    let formatted = hyde_format::format(&path.to_string_lossy(), &text);
    let Ok(formatted) = formatted else {
        let reason = "formatting would change the meaning; this is a defect of Hyde".to_owned();
        return Err((ErrorCode::RequestFailed, reason));
    };
    if formatted.text == text {
        return Ok(Some(Vec::new()));
    }
    // The cursor stays where it is if what is equal is not replaced.
    let old: Vec<&str> = text.split_inclusive('\n').collect();
    let new: Vec<&str> = formatted.text.split_inclusive('\n').collect();
    let same = |pair: &(&&str, &&str)| pair.0 == pair.1;
    let head = old.iter().zip(&new).take_while(same).count();
    let (old_rest, new_rest) = (&old[head..], &new[head..]);
    let tail = old_rest
        .iter()
        .rev()
        .zip(new_rest.iter().rev())
        .take_while(same)
        .count();
    let start: usize = old[..head].iter().map(|line| line.len()).sum();
    let middle = &old_rest[..old_rest.len() - tail];
    let end = start + middle.iter().map(|line| line.len()).sum::<usize>();
    Ok(Some(vec![TextEdit {
        range: server.encoding.range(&text, start..end),
        new_text: new_rest[..new_rest.len() - tail].concat(),
    }]))
}

fn symbols(
    server: &Server,
    params: lsp_types::DocumentSymbolParams,
) -> Result<Option<DocumentSymbolResponse>, Refusal> {
    let Some(asked) = Asked::of(server, &params.text_document.uri) else {
        return Ok(None);
    };
    let list = asked
        .analysis
        .files()
        .file(0)
        .map(|tree| outline::symbols(tree, asked.analysis.text(), asked.encoding));
    Ok(list.map(DocumentSymbolResponse::Nested))
}

fn folds(
    server: &Server,
    params: lsp_types::FoldingRangeParams,
) -> Result<Option<Vec<lsp_types::FoldingRange>>, Refusal> {
    let path = uri::path(&params.text_document.uri);
    let text = path.and_then(|path| server.text(&path));
    Ok(text.map(|text| outline::folds(&text, &outline::written(&text))))
}

fn selections(
    server: &Server,
    params: lsp_types::SelectionRangeParams,
) -> Result<Option<Vec<lsp_types::SelectionRange>>, Refusal> {
    let path = uri::path(&params.text_document.uri);
    let Some(text) = path.and_then(|path| server.text(&path)) else {
        return Ok(None);
    };
    let written = outline::written(&text);
    let list = params.positions.into_iter().map(|position| {
        let byte = server.encoding.byte(&text, position);
        outline::selection(&text, &written, byte, server.encoding)
    });
    Ok(Some(list.collect()))
}

fn hover(server: &Server, params: lsp_types::HoverParams) -> Result<Option<Hover>, Refusal> {
    let at = params.text_document_position_params;
    let Some(asked) = Asked::of(server, &at.text_document.uri) else {
        return Ok(None);
    };
    let byte = asked.byte(at.position);
    let found = asked.analysis.occurrence_at(byte);
    // An operator behind a name is what the mouse is on, not the name.
    let next = asked.analysis.text().get(byte..).unwrap_or_default();
    let operator = next.starts_with(|c: char| !c.is_whitespace() && !";,)]}".contains(c));
    let found = found.filter(|own| byte < own.span.end as usize || !operator);
    let mut parts = Vec::new();
    let mut range = None;
    if let Some(found) = found
        && let Some(meaning) = &found.meaning
    {
        let mut text = describe::hover(&asked.analysis, meaning);
        let ran = runs::of_name(server, &asked.analysis, &found);
        for line in values::of_name(&asked.analysis, &found)
            .into_iter()
            .chain(ran)
        {
            let between = if text.ends_with("```") {
                "\n\n"
            } else {
                "  \n"
            };
            text.push_str(&format!("{between}{line}"));
        }
        parts.push(text);
        range = Some(asked.range(found.span.start as usize..found.span.end as usize));
    } else if let Some((bytes, text)) = values::of_expression(&asked.analysis, byte) {
        parts.push(text);
        range = Some(asked.range(bytes));
    }
    for code in server.codes_at(&asked.path, at.position) {
        if let Some(code) = Code::ALL.iter().find(|own| own.as_str() == code) {
            parts.push(server.host.explanation(*code));
        }
    }
    Ok((!parts.is_empty()).then(|| Hover {
        contents: HoverContents::Markup(MarkupContent {
            kind: MarkupKind::Markdown,
            value: parts.join("\n\n---\n\n"),
        }),
        range,
    }))
}

fn definition(
    server: &Server,
    params: lsp_types::GotoDefinitionParams,
) -> Result<Option<GotoDefinitionResponse>, Refusal> {
    let at = params.text_document_position_params;
    let Some(asked) = Asked::of(server, &at.text_document.uri) else {
        return Ok(None);
    };
    let found = asked.analysis.occurrence_at(asked.byte(at.position));
    let location = found
        .and_then(|found| found.meaning)
        .and_then(|meaning| location(server, &asked.analysis, &meaning));
    Ok(location.map(GotoDefinitionResponse::Scalar))
}

/// Where something is declared, on the disk. The library is part of the command: the host lays it down as files.
fn location(server: &Server, analysis: &Analysis, definition: &Definition<'_>) -> Option<Location> {
    let span = definition.name.span;
    let source = analysis.loaded.sources.get(span.file);
    let range = server
        .encoding
        .range(&source.text, span.start as usize..span.end as usize);
    let path = match Path::new(&source.name).is_absolute() {
        true => PathBuf::from(&source.name),
        false => server.host.library_file(&source.name, &source.text)?,
    };
    Some(Location::new(uri::of(&path)?, range))
}

/// The uses of the name at a place; in the file itself alone, or in all files.
fn uses_at(
    server: &Server,
    asked: &Asked,
    position: Position,
    everywhere: bool,
) -> Option<(String, Uses)> {
    let found = asked.analysis.occurrence_at(asked.byte(position))?;
    let identity = asked.analysis.identity(&found.meaning?);
    let mut all = Uses::default();
    if everywhere {
        let world = server.documents.world();
        let open = server.documents.paths().cloned();
        let files = rename::candidates(&world, &server.folders, open.chain([asked.path.clone()]));
        all = rename::uses(&world, &files, &identity, found.text);
    } else {
        rename::in_file(&asked.analysis, &identity, found.text, &mut all);
    }
    Some((found.text.to_owned(), all))
}

fn references(
    server: &Server,
    params: lsp_types::ReferenceParams,
) -> Result<Option<Vec<Location>>, Refusal> {
    let at = params.text_document_position;
    let Some(asked) = Asked::of(server, &at.text_document.uri) else {
        return Ok(None);
    };
    let found = uses_at(server, &asked, at.position, true);
    let declarations = params.context.include_declaration;
    Ok(found.map(|(_, uses)| uses.locations(server.encoding, declarations)))
}

fn highlights(
    server: &Server,
    params: lsp_types::DocumentHighlightParams,
) -> Result<Option<Vec<DocumentHighlight>>, Refusal> {
    let at = params.text_document_position_params;
    let Some(asked) = Asked::of(server, &at.text_document.uri) else {
        return Ok(None);
    };
    let found = uses_at(server, &asked, at.position, false);
    Ok(found.map(|(_, uses)| {
        let list = uses.locations(server.encoding, true).into_iter();
        list.map(|own| DocumentHighlight {
            range: own.range,
            kind: None,
        })
        .collect()
    }))
}

fn prepare_rename(
    server: &Server,
    at: lsp_types::TextDocumentPositionParams,
) -> Result<Option<PrepareRenameResponse>, Refusal> {
    let Some(asked) = Asked::of(server, &at.text_document.uri) else {
        return Ok(None);
    };
    let Some(found) = asked.analysis.occurrence_at(asked.byte(at.position)) else {
        return Ok(None);
    };
    renamable(&asked, at.position)?;
    let bytes = found.span.start as usize..found.span.end as usize;
    Ok(Some(PrepareRenameResponse::Range(asked.range(bytes))))
}

/// Whether the name at a place can be another one.
fn renamable(asked: &Asked, position: Position) -> Result<(), Refusal> {
    let refuse = |reason: String| Err((ErrorCode::RequestFailed, reason));
    let found = asked.analysis.occurrence_at(asked.byte(position));
    let Some((found, meaning)) = found.and_then(|own| Some((own, own.meaning?))) else {
        return refuse("the meaning of this name is not known".to_owned());
    };
    let source = asked.analysis.identity(&meaning).source;
    match rename::fixed(&asked.analysis, meaning.thing, &source) {
        Some(reason) => refuse(format!("`{}` cannot be renamed: {reason}", found.text)),
        None => Ok(()),
    }
}

fn renamed(
    server: &Server,
    params: lsp_types::RenameParams,
) -> Result<Option<lsp_types::WorkspaceEdit>, Refusal> {
    let at = params.text_document_position;
    let Some(asked) = Asked::of(server, &at.text_document.uri) else {
        return Ok(None);
    };
    renamable(&asked, at.position)?;
    let Some((old, uses)) = uses_at(server, &asked, at.position, true) else {
        return Ok(None);
    };
    let world = server.documents.world();
    let edit = uses.renamed(&world, server.encoding, (&old, &params.new_name));
    edit.map(Some)
        .map_err(|reason| (ErrorCode::RequestFailed, reason))
}

fn completion(
    server: &Server,
    params: lsp_types::CompletionParams,
) -> Result<Option<lsp_types::CompletionResponse>, Refusal> {
    let at = params.text_document_position;
    let Some(asked) = Asked::of(server, &at.text_document.uri) else {
        return Ok(None);
    };
    let list = complete(&asked.analysis, asked.byte(at.position));
    Ok(Some(lsp_types::CompletionResponse::Array(list)))
}

fn signatures(
    server: &Server,
    params: lsp_types::SignatureHelpParams,
) -> Result<Option<lsp_types::SignatureHelp>, Refusal> {
    let at = params.text_document_position_params;
    let Some(asked) = Asked::of(server, &at.text_document.uri) else {
        return Ok(None);
    };
    Ok(signature::signature(
        &asked.analysis,
        asked.byte(at.position),
    ))
}

fn hints(
    server: &Server,
    params: lsp_types::InlayHintParams,
) -> Result<Option<Vec<lsp_types::InlayHint>>, Refusal> {
    let Some(asked) = Asked::of(server, &params.text_document.uri) else {
        return Ok(None);
    };
    let bytes = asked.byte(params.range.start)..asked.byte(params.range.end) + 1;
    Ok(Some(inlay::hints(&asked.analysis, &bytes, asked.encoding)))
}

fn lenses(
    server: &Server,
    params: lsp_types::CodeLensParams,
) -> Result<Option<Vec<lsp_types::CodeLens>>, Refusal> {
    let uri = &params.text_document.uri;
    let Some(path) = uri::path(uri) else {
        return Ok(None);
    };
    let runs = server.runs.borrow();
    let ran = |experiment: &str| runs.lenses(&path, experiment);
    let of = |(tree, text): (File, String)| {
        lens::lenses(&tree, &text, uri.as_str(), server.encoding, &ran)
    };
    Ok(server.tree(&path).map(of))
}

/// Starts what a lens asks for; its page is shown when it is there.
fn execute(
    server: &Server,
    params: lsp_types::ExecuteCommandParams,
) -> Result<Option<Value>, Refusal> {
    let refuse = |reason: String| Err((ErrorCode::RequestFailed, reason));
    if let Some(instant) = lens::instant(&params.command, &params.arguments) {
        return match server.choose(&instant) {
            true => Ok(None),
            false => refuse(format!("`{}` was not run", instant.experiment)),
        };
    }
    let Some(order) = lens::order(&params.command, &params.arguments) else {
        return refuse(format!(
            "`{}` is not a command of this server",
            params.command
        ));
    };
    if server.is_unsaved(&order.file) {
        return refuse("save the file first: the command reads it from the disk".to_owned());
    }
    server.start(order);
    Ok(None)
}

fn actions(
    server: &Server,
    params: lsp_types::CodeActionParams,
) -> Result<Option<Vec<CodeActionOrCommand>>, Refusal> {
    let uri = &params.text_document.uri;
    let Some(text) = uri::path(uri).and_then(|path| server.text(&path)) else {
        return Ok(None);
    };
    let known = params.context.diagnostics.iter();
    let list = known.flat_map(|own| fixes(own, &text, uri, server.encoding));
    Ok(Some(list.map(CodeActionOrCommand::CodeAction).collect()))
}

fn semantic(
    server: &Server,
    params: lsp_types::SemanticTokensParams,
) -> Result<Option<lsp_types::SemanticTokensResult>, Refusal> {
    let Some(asked) = Asked::of(server, &params.text_document.uri) else {
        return Ok(None);
    };
    let data = tokens::tokens(&asked.analysis, asked.encoding);
    Ok(Some(lsp_types::SemanticTokensResult::Tokens(
        SemanticTokens {
            result_id: None,
            data,
        },
    )))
}

#[allow(deprecated, reason = "the field must be given a value")]
fn workspace_symbols(
    server: &Server,
    params: lsp_types::WorkspaceSymbolParams,
) -> Result<Option<WorkspaceSymbolResponse>, Refusal> {
    let query = params.query.to_lowercase();
    let world = server.documents.world();
    let open = server.documents.paths().cloned();
    let mut list = Vec::new();
    for path in rename::candidates(&world, &server.folders, open) {
        let Some(uri) = uri::of(&path) else {
            continue;
        };
        let Some((tree, text)) = server.tree(&path) else {
            continue;
        };
        for symbol in outline::symbols(&tree, &text, server.encoding) {
            if symbol.name.to_lowercase().contains(&query) {
                list.push(SymbolInformation {
                    name: symbol.name,
                    kind: symbol.kind,
                    tags: None,
                    deprecated: None,
                    location: Location::new(uri.clone(), symbol.selection_range),
                    container_name: None,
                });
            }
        }
    }
    Ok(Some(WorkspaceSymbolResponse::Flat(list)))
}
