// Draws a ball with the two materials of the guide.

import * as classic from "three";
import * as THREE from "three/webgpu";

import { lampShader } from "./chunks.js";
import { lampMaterial } from "./material.js";

/** Rows of 256 bytes, which both backends read as they are. */
const SIZE = 64;

function makeScene(three, material) {
  const scene = new three.Scene();
  scene.add(new three.Mesh(new three.SphereGeometry(1, 64, 48), material));
  const camera = new three.PerspectiveCamera(40, 1, 0.1, 10);
  camera.position.set(0.6, 0.9, 3);
  camera.lookAt(0, 0, 0);
  return [scene, camera];
}

const color = (three) => new three.Vector3(1, 0.5, 0.3);
const lamp = (three) => new three.Vector3(1.2, 1.4, 1.6);

/** The first row is the top one. */
async function pixelsOf(canvas) {
  const image = await createImageBitmap(canvas);
  const flat = new OffscreenCanvas(SIZE, SIZE).getContext("2d");
  flat.drawImage(image, 0, 0);
  return [...flat.getImageData(0, 0, SIZE, SIZE).data];
}

function makeCanvas() {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [SIZE, SIZE];
  document.body.append(canvas);
  return canvas;
}

function prepare(renderer) {
  renderer.setSize(SIZE, SIZE, false);
  renderer.setClearColor(0x203040, 1);
}

/** A picture by nodes, with a backend. */
export async function nodes(backend) {
  const canvas = makeCanvas();
  const renderer = new THREE.WebGPURenderer({ canvas, forceWebGL: backend === "webgl" });
  await renderer.init();
  const found = renderer.backend.isWebGPUBackend ? "webgpu" : "webgl";
  if (found !== backend) throw new Error(`three.js took ${found}`);
  prepare(renderer);
  renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
  // A target, since headless Chromium does not show canvases of WebGPU on every machine.
  const target = new THREE.RenderTarget(SIZE, SIZE);
  renderer.setRenderTarget(target);
  renderer.render(...makeScene(THREE, lampMaterial(color(THREE), lamp(THREE))));
  const pixels = [...(await renderer.readRenderTargetPixelsAsync(target, 0, 0, SIZE, SIZE))];
  return backend === "webgl" ? topFirst(pixels) : pixels;
}

function topFirst(pixels) {
  const row = (_, y) => pixels.slice(4 * SIZE * (SIZE - 1 - y), 4 * SIZE * (SIZE - y));
  return Array.from({ length: SIZE }, row).flat();
}

/** A picture by chunks. */
export async function chunks() {
  const canvas = makeCanvas();
  const renderer = new classic.WebGLRenderer({ canvas });
  prepare(renderer);
  renderer.outputColorSpace = classic.LinearSRGBColorSpace;
  renderer.render(...makeScene(classic, lampShader(color(classic), lamp(classic))));
  return pixelsOf(canvas);
}
