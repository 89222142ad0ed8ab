// Draws the scene with WebGL 2.

import { open } from "/bundle/index.js"; // lamplight
import { bindBlock, bindTexture, linkProgram, packBlock, setFrontFace } from "/bundle/webgl2.js"; // lamplight
import { CAMERA, HEIGHT, IMAGE, KEYS, LAMPS, NEAR, VERTICES, WIDTH } from "./scene.mjs";

function makeBuffer(gl, kind, bytes) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(kind, buffer);
  gl.bufferData(kind, bytes, gl.STATIC_DRAW);
  return buffer;
}

function makeTexture(gl, inner, width, height, format, type, bytes) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texImage2D(gl.TEXTURE_2D, 0, inner, width, height, 0, format, type, bytes);
  return texture;
}

function makeSampler(gl, compares) {
  const sampler = gl.createSampler();
  gl.samplerParameteri(sampler, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.samplerParameteri(sampler, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.samplerParameteri(sampler, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.samplerParameteri(sampler, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  if (compares) {
    gl.samplerParameteri(sampler, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
    gl.samplerParameteri(sampler, gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL);
  }
  return sampler;
}

function openVertices(gl) {
  makeBuffer(gl, gl.ARRAY_BUFFER, VERTICES);
  gl.enableVertexAttribArray(0);
  gl.enableVertexAttribArray(1);
  gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 20, 0);
  gl.vertexAttribPointer(1, 2, gl.FLOAT, false, 20, 12);
}

function openFrame(gl) {
  const color = makeTexture(gl, gl.RGBA8, WIDTH, HEIGHT, gl.RGBA, gl.UNSIGNED_BYTE, null);
  gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, color, 0);
  gl.viewport(0, 0, WIDTH, HEIGHT);
  gl.enable(gl.CULL_FACE);
  gl.clearColor(0.2, 0.1, 0.3, 1);
}

function readPicture(gl, topFirst) {
  const bytes = new Uint8Array(WIDTH * HEIGHT * 4);
  gl.readPixels(0, 0, WIDTH, HEIGHT, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
  const row = (_, y) => {
    const at = 4 * WIDTH * (topFirst ? y : HEIGHT - 1 - y);
    return [...bytes.subarray(at, at + 4 * WIDTH)];
  };
  return Array.from({ length: HEIGHT }, row).flat();
}

/** All pictures, with the numbers of their texels. */
export async function pictures() {
  const gl = new OffscreenCanvas(WIDTH, HEIGHT).getContext("webgl2");
  openFrame(gl);
  openVertices(gl);
  const depths = Float32Array.from(NEAR, (isNear) => (isNear ? 0 : 1));
  const depth = [gl.DEPTH_COMPONENT32F, 8, 8, gl.DEPTH_COMPONENT, gl.FLOAT, depths];
  const image = makeTexture(gl, gl.RGBA8, 4, 3, gl.RGBA, gl.UNSIGNED_BYTE, IMAGE);
  const shadow = makeTexture(gl, ...depth);
  const [plain, compare] = [makeSampler(gl, false), makeSampler(gl, true)];
  // lamplight
  const bundle = await open("/lit.lamplight");
  const [cameraBinding, lampsBinding] = bundle.layout("lit");
  const camera = makeBuffer(gl, gl.UNIFORM_BUFFER, packBlock(cameraBinding, CAMERA));
  const lamps = makeBuffer(gl, gl.UNIFORM_BUFFER, packBlock(lampsBinding, LAMPS));
  // lamplight end
  const all = [];
  for (const key of KEYS) {
    gl.clear(gl.COLOR_BUFFER_BIT);
    // lamplight
    const vertex = bundle.find("lit", "vs_main", key, "essl300");
    const fragment = bundle.find("lit", "fs_main", key, "essl300");
    const lit = await linkProgram(gl, vertex, fragment);
    bindBlock(gl, lit, "camera", camera);
    bindBlock(gl, lit, "lamps", lamps);
    bindTexture(gl, lit, "image", gl.TEXTURE_2D, image, plain);
    bindTexture(gl, lit, "shadow_map", gl.TEXTURE_2D, shadow, compare);
    setFrontFace(gl, lit);
    // lamplight end
    gl.drawArrays(gl.TRIANGLES, 0, 6);
    all.push(readPicture(gl, lit.topFirst)); // lamplight
  }
  if (gl.getError()) throw new Error("WebGL 2 reports an error");
  return all;
}
