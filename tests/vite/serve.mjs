// Serves the app of a folder, until standard input ends: `node serve.mjs dev|preview`.

import * as vite from "vite";

const options = { root: process.cwd(), logLevel: "silent", clearScreen: false };
const place = { port: 0, host: "127.0.0.1" };
let server;
if (process.argv[2] === "dev") {
  server = await vite.createServer({ ...options, server: place });
  await server.listen();
} else {
  server = await vite.preview({ ...options, preview: place });
}
const { port } = server.httpServer.address();
console.log(`http://127.0.0.1:${port}/`);
process.stdin.resume().on("end", () => process.exit());
