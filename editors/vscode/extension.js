// Starts `hyde lsp` for model files. The lenses over experiments are commands of the server.
"use strict";

const { commands, Uri, ViewColumn, window, workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

function path() {
  return workspace.getConfiguration("hyde").get("path", "hyde");
}

// The views of the pages of results, by the page.
const views = new Map();

// The page of a result is shown in a view beside the text, in the one that has it already if there is one. It has its styles
// and pictures inside, and no scripts.
async function showPage(params, next) {
  const uri = Uri.parse(params.uri);
  if (uri.scheme !== "file" || !uri.path.endsWith(".html")) return next(params);
  const html = new TextDecoder().decode(await workspace.fs.readFile(uri));
  const title = /<title>([^<]*)<\/title>/.exec(html)?.[1] ?? "Hyde";
  const known = views.get(params.uri);
  const place = { viewColumn: ViewColumn.Beside, preserveFocus: true };
  const view = known ?? window.createWebviewPanel("hyde.page", title, place, { enableFindWidget: true });
  if (known) known.reveal(undefined, true);
  else view.onDidDispose(() => views.delete(params.uri));
  views.set(params.uri, view);
  view.title = title;
  view.webview.html = html;
  return { success: true };
}

async function start() {
  const run = { command: path(), args: ["lsp"] };
  client = new LanguageClient("hyde", "Hyde", { run, debug: run }, {
    documentSelector: [{ language: "hyde" }],
    middleware: { window: { showDocument: showPage } },
    synchronize: { fileEvents: workspace.createFileSystemWatcher("**/*.{hyde,csv,toml}") },
  });
  try {
    await client.start();
  } catch (reason) {
    window.showErrorMessage(`\`${path()} lsp\` cannot be started: set \`hyde.path\` to the command. ${reason}`);
  }
}

async function stop() {
  const old = client;
  client = undefined;
  if (old?.isRunning()) await old.stop();
}

// An experiment of a text: it is asked for where the text has several.
async function experiment(document) {
  const names = [...document.getText().matchAll(/^experiment\s+(\w+)/gm)].map((found) => found[1]);
  return names.length > 1 ? window.showQuickPick(names, { title: "Experiment" }) : names[0];
}

// The instant of the values that hovers show of the last run.
async function instant() {
  const editor = window.activeTextEditor;
  if (editor?.document.languageId !== "hyde") return;
  const name = await experiment(editor.document);
  if (!name) return;
  const isTime = (text) => text.trim() === "" || Number.isFinite(Number(text));
  const text = await window.showInputBox({
    title: "Values at an instant of the last run",
    prompt: "Time in s; nothing for the end of the run",
    validateInput: (text) => (isTime(text) ? undefined : "This is not a number."),
  });
  if (text === undefined) return;
  const time = text.trim() === "" ? null : Number(text);
  await commands.executeCommand("hyde.at", editor.document.uri.toString(), name, time);
}

async function live() {
  const editor = window.activeTextEditor;
  if (editor?.document.languageId !== "hyde") return;
  await editor.document.save();
  const name = await experiment(editor.document);
  if (!name) return;
  const terminal = window.createTerminal({
    name: `hyde live ${name}`,
    shellPath: path(),
    shellArgs: ["live", editor.document.uri.fsPath, name],
  });
  terminal.show();
}

exports.activate = async (context) => {
  const restart = async () => {
    await stop();
    await start();
  };
  context.subscriptions.push(
    commands.registerCommand("hyde.restart", restart),
    commands.registerCommand("hyde.instant", instant),
    commands.registerCommand("hyde.live", live),
    workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("hyde.path")) restart();
    }),
  );
  await start();
};

exports.deactivate = stop;
