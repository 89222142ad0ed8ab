// Computes functions of the package by materials of three.js, with either backend.

import * as THREE from "three/webgpu";
import * as TSL from "three/tsl";

/** The most calls of one drawing. */
const MOST = 4096;

const BITS = { float: (word) => TSL.uintBitsToFloat(word), uint: (word) => word, int: (word) => TSL.int(word),
  bool: (word) => word.notEqual(TSL.uint(0)) };

/** The component type and the number of components of a type, and of its columns. */
function shapeOf(type) {
  const [, prefix, size] = /^([biu]?)(?:vec|mat)(\d)$/.exec(type) ?? [];
  const scalar = size ? { b: "bool", i: "int", u: "uint", "": "float" }[prefix] : type;
  const columns = type.startsWith("mat") ? Number(size) : 1;
  return { scalar, rows: Number(size ?? 1), columns };
}

const wordsOf = (type) => shapeOf(type).rows * shapeOf(type).columns;

let renderer;

/** Opens a backend: `webgpu` or `webgl`. */
export async function open(backend) {
  const canvas = document.createElement("canvas");
  renderer = new THREE.WebGPURenderer({ canvas, forceWebGL: backend === "webgl" });
  await renderer.init();
  const found = renderer.backend.isWebGPUBackend ? "webgpu" : "webgl";
  if (found !== backend) throw new Error(`three.js took ${found}`);
  return THREE.REVISION;
}

/** The words of each call, four in a texel: a column of texels for each call. */
function inputTexture(words, count, perCall) {
  const height = Math.max(1, Math.ceil(perCall / 4));
  const data = new Uint32Array(count * height * 4);
  for (let call = 0; call < count; call++) {
    for (let at = 0; at < perCall; at++) {
      data[4 * ((at >> 2) * count + call) + (at & 3)] = words[call * perCall + at];
    }
  }
  const texture = new THREE.DataTexture(data, count, height, THREE.RGBAIntegerFormat, THREE.UnsignedIntType);
  texture.magFilter = texture.minFilter = THREE.NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** The arguments of the call of this fragment. */
function argumentsOf(texture, parameters) {
  const x = TSL.int(TSL.screenCoordinate.x);
  let at = 0;
  const word = () => {
    const texel = TSL.textureLoad(texture, TSL.ivec2(x, TSL.int(at >> 2)));
    return texel["xyzw"[at++ & 3]];
  };
  return parameters.map((type) => {
    const { scalar } = shapeOf(type);
    const parts = Array.from({ length: wordsOf(type) }, () => BITS[scalar](word()));
    return parts.length === 1 ? parts[0] : TSL[type](...parts);
  });
}

/** What passes write of a result, as colours, and how their numbers become words. */
function passesOf(result) {
  const { scalar, rows, columns } = shapeOf(result);
  const padded = (value) => (rows === 1 ? TSL.vec4(value, 0, 0, 0) : TSL.vec4(value, ...Array(4 - rows).fill(0)));
  const vector = (prefix) => TSL[rows === 1 ? { "": "float", u: "uint" }[prefix] : `${prefix}vec${rows}`];
  if (columns > 1) return Array.from({ length: columns }, (_, at) => (value) => padded(value.element(TSL.int(at))));
  if (scalar === "float") return [padded];
  const bits = (value) => vector("u")(value);
  const part = (shift) => (value) => {
    const half = bits(value).shiftRight(TSL.uint(shift)).bitAnd(TSL.uint(0xffff));
    return padded(vector("")(half));
  };
  return [part(0), part(16)];
}

async function drawn(node, count) {
  const target = new THREE.RenderTarget(count, 1, { type: THREE.FloatType, depthBuffer: false });
  const material = new THREE.NodeMaterial();
  material.fragmentNode = node;
  const quad = new THREE.QuadMesh(material);
  renderer.setRenderTarget(target);
  quad.render(renderer);
  const pixels = await renderer.readRenderTargetPixelsAsync(target, 0, 0, count, 1);
  renderer.setRenderTarget(null);
  material.dispose();
  target.dispose();
  return pixels;
}

function wordsOfPasses(result, passes, count) {
  const { scalar, rows } = shapeOf(result);
  const words = [];
  for (let call = 0; call < count; call++) {
    if (scalar === "float") {
      for (const pass of passes) {
        words.push(...new Uint32Array(pass.slice(4 * call, 4 * call + rows).buffer));
      }
    } else {
      for (let at = 0; at < rows; at++) {
        words.push((passes[0][4 * call + at] + 65536 * passes[1][4 * call + at]) >>> 0);
      }
    }
  }
  return words;
}

/** Calls a function for each row of words; gives the words of the results. */
export async function run(path, name, parameters, result, words) {
  const module = await import(`lamplight-three/tsl/${path}.js`);
  const perCall = parameters.reduce((sum, type) => sum + wordsOf(type), 0);
  const calls = perCall ? words.length / perCall : 1;
  const all = [];
  for (let first = 0; first < calls; first += MOST) {
    const count = Math.min(MOST, calls - first);
    const texture = inputTexture(words.slice(first * perCall), count, perCall);
    const value = module[name](...argumentsOf(texture, parameters));
    const passes = [];
    for (const pass of passesOf(result)) passes.push(await drawn(pass(value), count));
    texture.dispose();
    all.push(...wordsOfPasses(result, passes, count));
  }
  return all;
}
