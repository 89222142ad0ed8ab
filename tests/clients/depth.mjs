// Draws a depth map with WebGL 2, by the library's program `depth`, and shows it.

import { open } from "/bundle/index.js";
import { bindBlock, linkProgram, packBlock } from "/bundle/webgl2.js";

const SIDE = 8;
const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

const WHOLE = `#version 300 es
void main() {
  vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}`;
const SHOWN = `#version 300 es
precision highp float;
uniform highp sampler2D depths;
out vec4 color;
void main() {
  color = vec4(texelFetch(depths, ivec2(gl_FragCoord.xy), 0).x);
}`;

function shownProgram(gl) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, WHOLE], [gl.FRAGMENT_SHADER, SHOWN]]) {
    const made = gl.createShader(kind);
    gl.shaderSource(made, text);
    gl.compileShader(made);
    gl.attachShader(program, made);
  }
  gl.linkProgram(program);
  return program;
}

function frame(gl, attachment, inner, format, type) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, inner, SIDE, SIDE, 0, format, type, null);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  const made = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, made);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, attachment, gl.TEXTURE_2D, texture, 0);
  return { made, texture };
}

function block(gl, binding, values) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.UNIFORM_BUFFER, buffer);
  gl.bufferData(gl.UNIFORM_BUFFER, packBlock(binding, values), gl.STATIC_DRAW);
  return buffer;
}

/** The red bytes of the map as each program draws it: with the fragment stage, and without. */
export async function pictures() {
  const gl = new OffscreenCanvas(SIDE, SIDE).getContext("webgl2");
  const bundle = await open("/depth.lamplight");
  const [cameraBinding, objectBinding] = bundle.layout("depth");
  const camera = block(gl, cameraBinding, { clip_from_world: IDENTITY });
  const object = block(gl, objectBinding, { world_from_object: IDENTITY });
  const [vertex, fragment] = ["vs_main", "fs_main"].map((entry) => bundle.find("depth", entry, "default", "essl300"));
  // The left half, at the depth 0.5 of 0 to 1.
  const corners = Float32Array.of(-1, -1, 0.5, 0, -1, 0.5, 0, 1, 0.5, -1, -1, 0.5, 0, 1, 0.5, -1, 1, 0.5);
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, corners, gl.STATIC_DRAW);
  gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 12, 0);
  gl.viewport(0, 0, SIDE, SIDE);
  const shown = shownProgram(gl);
  const all = [];
  for (const stages of [[vertex, fragment], [vertex]]) {
    const map = frame(gl, gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT32F, gl.DEPTH_COMPONENT, gl.FLOAT);
    const depth = await linkProgram(gl, ...stages);
    bindBlock(gl, depth, "camera", camera);
    bindBlock(gl, depth, "object", object);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enableVertexAttribArray(0);
    gl.drawArrays(gl.TRIANGLES, 0, 6);
    gl.disable(gl.DEPTH_TEST);
    gl.disableVertexAttribArray(0);
    frame(gl, gl.COLOR_ATTACHMENT0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE);
    gl.bindTexture(gl.TEXTURE_2D, map.texture);
    gl.useProgram(shown);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const bytes = new Uint8Array(4 * SIDE * SIDE);
    gl.readPixels(0, 0, SIDE, SIDE, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    all.push([...bytes].filter((_, index) => index % 4 === 0));
  }
  if (gl.getError()) throw new Error("WebGL 2 reports an error");
  return all;
}
