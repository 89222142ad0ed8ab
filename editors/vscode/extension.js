// Starts `lamplight lsp` and `lamplight dap`, and adds the choice of a permutation and pictures.
const vscode = require('vscode');
const { LanguageClient } = require('vscode-languageclient/node');
const { showPicture } = require('./picture');

let client;

const languages = ['wesl', 'wgsl', 'glsl'];

/** The address of the document that is edited, or nothing. */
function here() {
  const document = vscode.window.activeTextEditor?.document;
  return document && languages.includes(document.languageId) ? document.uri.toString() : undefined;
}

async function choose() {
  const uri = here();
  if (!uri) return;
  const found = await client.sendRequest('lamplight/permutation', { uri });
  const chosen = { ...found.values };
  for (;;) {
    const rows = Object.entries(found.axes).map(([name, axis]) => ({
      label: name, description: chosen[name], detail: axis.doc ?? undefined, values: axis.values,
    }));
    const row = await vscode.window.showQuickPick(rows, { title: found.permutation });
    if (!row) return;
    const value = await vscode.window.showQuickPick(row.values, { title: row.label });
    if (value === undefined) continue;
    chosen[row.label] = value;
    const set = Object.entries(chosen).map(([name, value]) => `${name}=${value}`).join(',');
    Object.assign(found, await client.sendRequest('lamplight/permutation', { uri, set }));
  }
}

async function show(uri = here()) {
  if (!uri) return;
  const request = { command: 'lamplight.composed', arguments: [uri] };
  const content = await client.sendRequest('workspace/executeCommand', request);
  const document = await vscode.workspace.openTextDocument({ content, language: 'wgsl' });
  await vscode.window.showTextDocument(document, vscode.ViewColumn.Beside);
}

async function picture(command) {
  const uri = here();
  if (uri) await showPicture(command, vscode.Uri.parse(uri).fsPath);
}

exports.activate = async (context) => {
  const command = vscode.workspace.getConfiguration('lamplight').get('command');
  const documentSelector = [
    ...languages.map((language) => ({ scheme: 'file', language })),
    { scheme: 'file', pattern: '**/{wesl,lamplight}.toml' },
  ];
  client = new LanguageClient('lamplight', 'Lamplight', { command, args: ['lsp'] }, {
    documentSelector,
    middleware: {
      // The lens above an entry point shows what its command answers.
      executeCommand: (name, parameters, next) =>
        name === 'lamplight.composed' ? show(parameters[0]) : next(name, parameters),
    },
  });
  context.subscriptions.push(
    vscode.commands.registerCommand('lamplight.choose', choose),
    vscode.commands.registerCommand('lamplight.show', () => show()),
    vscode.commands.registerCommand('lamplight.picture', () => picture(command)),
    vscode.debug.registerDebugAdapterDescriptorFactory('lamplight', {
      createDebugAdapterDescriptor: () => new vscode.DebugAdapterExecutable(command, ['dap']),
    }),
  );
  await client.start();
};

exports.deactivate = () => client?.stop();
