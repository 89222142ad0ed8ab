// The picture of a shader, in which a click debugs the fragment of a pixel.
const vscode = require('vscode');
const { execFile } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');

/** What a launch may say, as the editor's settings describe it: the one table of its options. */
const { properties } = require('./package.json').contributes.debuggers[0].configurationAttributes.launch;

/** What `lamplight render` has under another name, or not. */
const OF_DEBUG = ['program', 'pixel', 'lost', 'stopOnEntry', 'cwd', 'args'];

const OPTIONS = Object.keys(properties).filter((name) => !OF_DEBUG.includes(name));

/** The values of an option. A list of numbers is one value; others, and objects, have several. */
function valuesOf(name, value) {
  const text = (one) => (Array.isArray(one) ? one.join(name === 'size' ? 'x' : ',') : String(one));
  if (Array.isArray(value)) {
    return value.every((one) => typeof one === 'number') ? [text(value)] : value.map(text);
  }
  if (value && typeof value === 'object') {
    return Object.entries(value).map(([key, one]) => `${key}=${text(one)}`);
  }
  return value === undefined || value === null ? [] : [text(value)];
}

/** The arguments of `lamplight render` for a launch. */
function renderArguments(launch, out) {
  const options = OPTIONS.flatMap((name) => {
    const value = launch[name] ?? (name === 'size' ? [512, 512] : undefined);
    return valuesOf(name, value).map((one) => `--${name}=${one}`);
  });
  return ['render', launch.program, '--out', out, '--force', '--samples', '1', ...options,
    ...(launch.args ?? [])];
}

/** The pixel of a picture that a click in its element means. */
function clickedPixel(x, y, shownWidth, shownHeight, width, height) {
  const pixel = (at, shown, count) => Math.min(count - 1, Math.max(0, Math.floor((at / shown) * count)));
  return [pixel(x, shownWidth, width), pixel(y, shownHeight, height)];
}

/** The page: the picture, and what a click in it sends. */
function page(png, title) {
  const nonce = [...Array(24)].map(() => Math.floor(Math.random() * 36).toString(36)).join('');
  const words = title.replace(/[&<>"]/g, (sign) => `&#${sign.charCodeAt(0)};`);
  return `<!DOCTYPE html>
<html><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy"
  content="default-src 'none'; img-src data:; style-src 'nonce-${nonce}'; script-src 'nonce-${nonce}'">
<style nonce="${nonce}">img { max-width: 100%; cursor: crosshair; image-rendering: pixelated }</style>
</head><body><p>${words}: click a pixel to debug it.</p>
<img id="picture" alt="${words}" src="data:image/png;base64,${png.toString('base64')}">
<script nonce="${nonce}">
const api = acquireVsCodeApi();
const clickedPixel = ${clickedPixel};
const picture = document.getElementById('picture');
picture.addEventListener('click', (event) => {
  const box = picture.getBoundingClientRect();
  api.postMessage({ pixel: clickedPixel(event.clientX - box.left, event.clientY - box.top,
    box.width, box.height, picture.naturalWidth, picture.naturalHeight) });
});
</script></body></html>`;
}

/** Draws a launch, and gives the bytes of the picture. */
function drawn(command, launch) {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'lamplight-'));
  const out = path.join(folder, 'picture.png');
  const options = { cwd: launch.cwd };
  return new Promise((resolve, reject) => {
    execFile(command, renderArguments(launch, out), options, (error, _, words) => {
      try {
        if (error) reject(new Error(words || error.message));
        else resolve(fs.readFileSync(out));
      } finally {
        fs.rmSync(folder, { recursive: true, force: true });
      }
    });
  });
}

/** A launch in which variables such as `${workspaceFolder}` have their values, as the editor has them. */
function resolved(value, file, folder) {
  if (Array.isArray(value)) return value.map((one) => resolved(one, file, folder));
  if (value && typeof value === 'object') {
    const entries = Object.entries(value).map(([key, one]) => [key, resolved(one, file, folder)]);
    return Object.fromEntries(entries);
  }
  if (typeof value !== 'string') return value;
  const { base, name, ext, dir } = path.parse(file);
  const known = {
    file, fileBasename: base, fileBasenameNoExtension: name, fileExtname: ext, fileDirname: dir,
    relativeFile: path.relative(folder, file), workspaceFolder: folder,
    workspaceFolderBasename: path.basename(folder), userHome: os.homedir(), pathSeparator: path.sep,
  };
  return value.replace(/\$\{(env:)?([^}]*)\}/g, (all, env, word) =>
    (env ? process.env[word] ?? '' : known[word] ?? all));
}

/** The launch of a file: what a configuration for it says, or none. */
function launchOf(file, scope) {
  const folder = scope?.uri.fsPath ?? path.dirname(file);
  const all = vscode.workspace.getConfiguration('launch', scope?.uri).get('configurations') ?? [];
  const own = all.filter((one) => one.type === 'lamplight').map((one) => resolved(one, file, folder));
  const isOwn = (one) =>
    one.program && path.resolve(one.cwd ?? folder, one.program) === path.resolve(file);
  const { pixel: _, ...known } = own.find(isOwn) ?? {};
  return {
    type: 'lamplight', request: 'launch', name: path.basename(file), stopOnEntry: true, cwd: folder,
    ...known, program: file,
  };
}

/** Shows the picture of the shader that is edited. A click starts a session for its pixel. */
async function showPicture(command, file) {
  const scope = vscode.workspace.getWorkspaceFolder(vscode.Uri.file(file));
  const panel = vscode.window.createWebviewPanel(
    'lamplight.picture', path.basename(file), vscode.ViewColumn.Beside, { enableScripts: true },
  );
  const draw = async () => {
    try {
      panel.webview.html = page(await drawn(command, launchOf(file, scope)), path.basename(file));
    } catch (error) {
      vscode.window.showErrorMessage(`Lamplight: ${error.message}`);
    }
  };
  const saved = vscode.workspace.onDidSaveTextDocument(draw);
  panel.onDidDispose(() => saved.dispose());
  panel.webview.onDidReceiveMessage(({ pixel }) =>
    vscode.debug.startDebugging(scope, { ...launchOf(file, scope), pixel }));
  await draw();
}

module.exports = { clickedPixel, page, renderArguments, showPicture };
