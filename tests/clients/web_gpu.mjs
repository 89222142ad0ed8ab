// Draws the scene with WebGPU.

import { open } from "/bundle/index.js"; // lamplight
import { packBlock, pipelineLayout, stage, vertexBuffer } from "/bundle/webgpu.js"; // lamplight
import { CAMERA, HEIGHT, IMAGE, KEYS, LAMPS, NEAR, VERTICES, WIDTH } from "./scene.mjs";

const FORMAT = "rgba8unorm";

function makeBuffer(device, usage, bytes) {
  const buffer = device.createBuffer({ size: bytes.byteLength, usage: usage | GPUBufferUsage.COPY_DST });
  device.queue.writeBuffer(buffer, 0, bytes);
  return buffer;
}

function makeTexture(device, format, width, height, texelBytes, bytes) {
  const usage = GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST;
  const texture = device.createTexture({ size: [width, height], format, usage });
  const layout = { bytesPerRow: width * texelBytes };
  device.queue.writeTexture({ texture }, bytes, layout, [width, height]);
  return texture.createView();
}

/** The resource of each binding, by the author's name. */
function makeResources(device, layout) {
  const block = (name, values) => {
    const binding = layout.find((known) => known.name === name);
    return { buffer: makeBuffer(device, GPUBufferUsage.UNIFORM, packBlock(binding, values)) }; // lamplight
  };
  const depths = Uint16Array.from(NEAR, (isNear) => (isNear ? 0 : 65535));
  return {
    camera: block("camera", CAMERA),
    lamps: block("lamps", LAMPS),
    image: makeTexture(device, FORMAT, 4, 3, 4, IMAGE),
    image_sampler: device.createSampler(),
    shadow_map: makeTexture(device, "depth16unorm", 8, 8, 2, depths),
    shadow_sampler: device.createSampler({ compare: "less-equal" }),
  };
}

async function readPicture(device, texture) {
  const usage = GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ;
  const buffer = device.createBuffer({ size: 256 * HEIGHT, usage });
  const encoder = device.createCommandEncoder();
  encoder.copyTextureToBuffer({ texture }, { buffer, bytesPerRow: 256 }, [WIDTH, HEIGHT]);
  device.queue.submit([encoder.finish()]);
  await buffer.mapAsync(GPUMapMode.READ);
  const bytes = new Uint8Array(buffer.getMappedRange());
  const row = (_, y) => [...bytes.subarray(256 * y, 256 * y + 4 * WIDTH)];
  return Array.from({ length: HEIGHT }, row).flat();
}

function draw(device, pipeline, groups, vertices, target) {
  const encoder = device.createCommandEncoder();
  const attachment = { view: target.createView(), loadOp: "clear", storeOp: "store" };
  attachment.clearValue = [0.2, 0.1, 0.3, 1];
  const pass = encoder.beginRenderPass({ colorAttachments: [attachment] });
  pass.setPipeline(pipeline);
  groups.forEach((group, index) => pass.setBindGroup(index, group));
  pass.setVertexBuffer(0, vertices);
  pass.draw(6);
  pass.end();
  device.queue.submit([encoder.finish()]);
}

/** All pictures, with the numbers of their texels. */
export async function pictures() {
  const device = await (await navigator.gpu.requestAdapter()).requestDevice();
  const errors = [];
  device.onuncapturederror = ({ error }) => errors.push(error.message);
  // lamplight
  const bundle = await open("/lit.lamplight");
  const program = bundle.layout("lit");
  const { layout, groups } = pipelineLayout(device, bundle, "lit");
  // lamplight end
  const resources = makeResources(device, program);
  const bound = groups.map((group, index) => {
    const own = program.filter((known) => known.group === index);
    const entries = own.map(({ binding, name }) => ({ binding, resource: resources[name] }));
    return device.createBindGroup({ layout: group, entries });
  });
  const vertices = makeBuffer(device, GPUBufferUsage.VERTEX, VERTICES);
  const usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC;
  const target = device.createTexture({ size: [WIDTH, HEIGHT], format: FORMAT, usage });
  const all = [];
  for (const key of KEYS) {
    // lamplight
    const vs = bundle.find("lit", "vs_main", key, "wgsl");
    const fs = bundle.find("lit", "fs_main", key, "wgsl");
    const vertex = { ...(await stage(device, vs)), buffers: [vertexBuffer(vs)] };
    const fragment = { ...(await stage(device, fs)), targets: [{ format: FORMAT }] };
    // lamplight end
    const primitive = { cullMode: "back" };
    const pipeline = device.createRenderPipeline({ layout, vertex, fragment, primitive });
    draw(device, pipeline, bound, vertices, target);
    all.push(await readPicture(device, target));
  }
  if (errors.length) throw new Error(errors.join("\n"));
  return all;
}
