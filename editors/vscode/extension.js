// Starts `hyde lsp` for model files. The lenses over experiments are commands of the server.
"use strict";

const { commands, window, workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

function path() {
  return workspace.getConfiguration("hyde").get("path", "hyde");
}

async function start() {
  const run = { command: path(), args: ["lsp"] };
  client = new LanguageClient("hyde", "Hyde", { run, debug: run }, {
    documentSelector: [{ language: "hyde" }],
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

// The live page needs the name of an experiment where the file has several.
async function live() {
  const editor = window.activeTextEditor;
  if (editor?.document.languageId !== "hyde") return;
  await editor.document.save();
  const names = [...editor.document.getText().matchAll(/^experiment\s+(\w+)/gm)].map((found) => found[1]);
  const name = names.length > 1 ? await window.showQuickPick(names, { title: "Experiment" }) : names[0];
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
    commands.registerCommand("hyde.live", live),
    workspace.onDidChangeConfiguration((change) => {
      if (change.affectsConfiguration("hyde.path")) restart();
    }),
  );
  await start();
};

exports.deactivate = stop;
