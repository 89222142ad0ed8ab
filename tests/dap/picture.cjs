// Runs the extension's picture panel against a window that does nothing, and prints what it did.
const Module = require('module');
const path = require('path');

const [program, folder, extension] = process.argv.slice(2);
const did = { errors: [] };
let clicked;

const vscode = {
  Uri: { file: (name) => ({ fsPath: name }) },
  ViewColumn: { Beside: -2 },
  workspace: {
    getWorkspaceFolder: () => ({ uri: { fsPath: folder } }),
    getConfiguration: () => ({
      get: () => [
        { type: 'node', program: '${file}' },
        { type: 'lamplight', program: '${workspaceFolder}/half.wesl', size: [32, 32] },
        // The root is found from the parent of the folder alone.
        {
          type: 'lamplight', program: '${workspaceFolder}/main.wesl', size: [64, 48], pixel: [1, 2],
          uniform: { power: 2 }, cwd: '${fileDirname}/..', root: '${workspaceFolderBasename}',
        },
      ],
    }),
    onDidSaveTextDocument: () => ({ dispose() {} }),
  },
  window: {
    createWebviewPanel: () => ({
      onDidDispose() {},
      webview: {
        set html(page) { did.page = page; },
        onDidReceiveMessage(listener) { clicked = listener; },
      },
    }),
    showErrorMessage: (words) => did.errors.push(words),
  },
  debug: { startDebugging: (_, launch) => { did.launch = launch; } },
};

const load = Module._load;
Module._load = (name, ...rest) => (name === 'vscode' ? vscode : load(name, ...rest));
const { clickedPixel, renderArguments, showPicture } = require(path.join(extension, 'picture.js'));

showPicture(program, path.join(folder, 'main.wesl'))
  .then(() => {
    // The middle of the third pixel from the left and the last from above, in a picture shown twice
    // as large; and a click on the edge.
    did.pixels = [clickedPixel(5, 95, 128, 96, 64, 48), clickedPixel(128, 96, 128, 96, 64, 48)];
    clicked({ pixel: did.pixels[0] });
    did.arguments = renderArguments({
      program: 'a.frag', camera: [0, 1, 2], define: { A: 1, B: 2 }, entry: ['vs', 'fs'], time: 0.5, lost: 3,
      constant: 'N=4u', texture: { image: 'checker' }, uniform: { tint: [1, 0, 0.5] }, args: ['--cascades=2'],
    }, 'a.png');
    did.size = Buffer.from(did.page.match(/base64,([^"]+)"/)[1], 'base64').subarray(16, 24)
      .toString('hex');
    did.page = did.page.includes("default-src 'none'") && did.page.includes('function clickedPixel');
    return showPicture(program, path.join(folder, 'half.wesl'));
  })
  .then(() => console.log(JSON.stringify(did)));
