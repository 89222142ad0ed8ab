// Uniform blocks, and layouts and stages for WebGPU, of the set of bundles.
//
//     node describe.mjs FOLDER

import { deepStrictEqual as same, throws } from "node:assert";
import { readFileSync } from "node:fs";

import { openBytes, packBlock } from "../src/index.js";
import { layoutEntries, stage, vertexBuffer } from "../src/webgpu.js";

const bundle = openBytes(readFileSync(`${process.argv[2]}/good.lamplight`));

// The offsets of the set: a matrix of three columns has 16 bytes for each of them.
const vertex = bundle.find("lit", "vs_main", "default", "wgsl");
const [camera] = vertex.reflection.bindings;
const floats = new Float32Array(packBlock(camera, { normal: [1, 2, 3, 4, 5, 6, 7, 8, 9] }));
same([...floats.slice(16)], [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0]);
throws(() => packBlock(camera, { normal: [1, 2] }), /`camera.normal` needs 9 numbers, not 2/);
throws(() => packBlock(camera, { norml: [1] }), /no member `norml`; it has: clip_from_world, normal/);

const [lamps] = bundle.find("lit", "fs_main", "fog", "wgsl").reflection.bindings;
const rest = { name: "rest", offset: 0, stride: 4, shape: { scalar: "u32", count: 0 } };
throws(() => packBlock({ name: "b", size: 16, members: [rest] }, { rest: [1] }), /needs 0 numbers/);
const packed = packBlock(lamps, { all: [{}, { color: [1, 2, 3], kind: 7 }] });
same([...new Float32Array(packed, 16, 3), new Uint32Array(packed)[7]], [1, 2, 3, 7]);
throws(() => packBlock(lamps, { all: Array(6).fill({}) }), /`lamps.all` has 5 elements/);

same(layoutEntries(bundle.layout("lit")), [
  [
    { binding: 0, visibility: 1, buffer: { type: "uniform", minBindingSize: 112 } },
    { binding: 1, visibility: 2, buffer: { type: "uniform", minBindingSize: 80 } },
  ],
  [
    {
      binding: 0,
      visibility: 2,
      texture: { sampleType: "float", viewDimension: "2d", multisampled: false },
    },
    { binding: 1, visibility: 2, sampler: { type: "filtering" } },
    {
      binding: 2,
      visibility: 2,
      texture: { sampleType: "depth", viewDimension: "2d", multisampled: false },
    },
    { binding: 3, visibility: 2, sampler: { type: "comparison" } },
  ],
]);
const far = { ...bundle.layout("lit")[0], group: 0xffff_ffff };
throws(() => layoutEntries([far]), /no device has a group 4294967295, which `camera` is in/);
same(layoutEntries(bundle.layout("write"))[0][0], {
  binding: 0,
  visibility: 4,
  storageTexture: { access: "write-only", format: "rgba8unorm", viewDimension: "2d-array" },
});

const device = { createShaderModule: ({ code }) => code.split("\n")[0] };
same(await stage(device, bundle.find("lit", "fs_main", "shadow=hard,taps=-4", "wgsl")), {
  module: "// fragment true false for wgsl",
  entryPoint: "entry",
  constants: { 7: -4 },
});
const half = { location: 1, type: "vec2<f16>", shape: { scalar: "f16", rows: 2 } };
const inputs = [{ builtin: "vertex_index", type: "u32" }, half, ...vertex.reflection.inputs];
same(vertexBuffer({ reflection: { inputs } }), {
  arrayStride: 12,
  attributes: [{ shaderLocation: 0, offset: 0, format: "float32x3" }],
});
