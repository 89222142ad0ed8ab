// Draws a triangle over the whole canvas with WebGL 2, and draws it again when a shader was edited.

import { bindBlock, linkProgram, packBlock } from "@lamplight/bundle/webgl2"; // lamplight
import programs from "./lamplight.toml"; // lamplight

const canvas = document.querySelector("canvas")!;
const gl = canvas.getContext("webgl2", { preserveDrawingBuffer: true })!;

async function draw(): Promise<void> {
  // lamplight
  const vertex = await programs.ball.find("vs_main", {}, "essl300");
  const fragment = await programs.ball.find("fs_main", { tint: "warm", bright: true }, "essl300");
  const [lamp] = await programs.ball.layout();
  const ball = await linkProgram(gl, vertex, fragment);
  const bytes = packBlock(lamp!, { color: [1, 1, 1], strength: 0.5 });
  // lamplight end
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.UNIFORM_BUFFER, buffer);
  gl.bufferData(gl.UNIFORM_BUFFER, bytes, gl.STATIC_DRAW);
  bindBlock(gl, ball, "lamp", buffer); // lamplight
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const pixel = new Uint8Array(4);
  gl.readPixels(4, 4, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  document.title = `drawn ${pixel.join(" ")}`;
}

await draw();
import.meta.hot?.accept("./lamplight.toml", draw); // lamplight
