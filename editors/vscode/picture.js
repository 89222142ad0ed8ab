// The picture of a shader, in which a click debugs the fragment of a pixel.
const vscode = require('vscode');
const { execFile } = require('node:child_process');
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');

/** The options of a launch that a picture has too, as `lamplight render` takes them. */
const OPTIONS = ['model', 'scene', 'camera', 'environment', 'set', 'uniform', 'texture', 'entry', 'time'];

/** The arguments of `lamplight render` for a launch. */
function renderArguments(launch, out) {
  const joined = (value) => (Array.isArray(value) ? value.join(',') : String(value));
  const row = ['render', launch.program, '--out', out, '--force', '--samples', '1'];
  const size = launch.size ?? [512, 512];
  row.push('--size', Array.isArray(size) ? size.join('x') : size);
  for (const name of OPTIONS) {
    const value = launch[name];
    if (value === undefined) continue;
    const isList = Array.isArray(value) && name !== 'camera';
    if (isList) {
      value.forEach((one) => row.push(`--${name}=${one}`));
    } else if (typeof value === 'object' && !Array.isArray(value)) {
      Object.entries(value).forEach(([key, one]) => row.push(`--${name}=${key}=${joined(one)}`));
    } else {
      row.push(`--${name}=${joined(value)}`);
    }
  }
  return row.concat(launch.args ?? []);
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
  const options = { cwd: launch.cwd ?? path.dirname(launch.program) };
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

/** Shows the picture of the shader that is edited. A click starts a session for its pixel. */
async function showPicture(command, file) {
  // A configuration for this file says what it is drawn with.
  const scope = vscode.workspace.getWorkspaceFolder(vscode.Uri.file(file));
  const all = vscode.workspace.getConfiguration('launch', scope?.uri).get('configurations') ?? [];
  const isOwn = (one) => one.type === 'lamplight' && [file, '${file}'].includes(one.program);
  const cwd = scope?.uri.fsPath ?? path.dirname(file);
  const { pixel: _, ...known } = all.find(isOwn) ?? {};
  const launch = {
    type: 'lamplight', request: 'launch', name: path.basename(file), stopOnEntry: true, ...known,
    program: file, cwd,
  };
  const panel = vscode.window.createWebviewPanel(
    'lamplight.picture', path.basename(file), vscode.ViewColumn.Beside, { enableScripts: true },
  );
  const draw = async () => {
    try {
      panel.webview.html = page(await drawn(command, launch), path.basename(file));
    } catch (error) {
      vscode.window.showErrorMessage(`Lamplight: ${error.message}`);
    }
  };
  const saved = vscode.workspace.onDidSaveTextDocument(draw);
  panel.onDidDispose(() => saved.dispose());
  panel.webview.onDidReceiveMessage(({ pixel }) =>
    vscode.debug.startDebugging(scope, { ...launch, pixel }));
  await draw();
}

module.exports = { clickedPixel, page, renderArguments, showPicture };
