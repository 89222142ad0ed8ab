// Kernels and frames with WebGPU.
"use strict";

const lamplight = (() => {
  const TRIANGLE = `@vertex fn triangle(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2u((index << 1u) & 2u, index & 2u);
    return vec4f(vec2f(corner) * 2.0 - 1.0, 0.0, 1.0);
  }`;
  // Depth cannot be copied into a texture, only drawn.
  const DEPTH = `@group(0) @binding(0) var stored: texture_2d<u32>;
  @fragment fn depth(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    return bitcast<f32>(textureLoad(stored, vec2u(position.xy), 0).x);
  }`;
  const { RENDER_ATTACHMENT, TEXTURE_BINDING, COPY_DST, COPY_SRC } = GPUTextureUsage;
  const FILTERS = "float32-filterable";

  let device, triangle, depths, lost;
  const kernels = new Map();

  async function open() {
    const adapter = await navigator.gpu?.requestAdapter();
    if (!adapter) throw new Error("there is no adapter of WebGPU");
    // Stages that tell what they are given have many targets.
    const limits = ["maxColorAttachmentBytesPerSample", "maxInterStageShaderVariables"];
    device = await adapter.requestDevice({
      requiredFeatures: adapter.features.has(FILTERS) ? [FILTERS] : [],
      requiredLimits: Object.fromEntries(limits.map((name) => [name, adapter.limits[name]])),
    });
    device.lost.then(({ message }) => (lost = message || "the device is lost"));
    triangle = device.createShaderModule({ code: TRIANGLE });
    const { vendor, architecture, description } = adapter.info;
    return [vendor, architecture, description].filter(Boolean).join(" ");
  }

  // What the device gives; it breaks such promises only when it is gone, sometimes before it says so.
  const given = (promise) => promise.catch(({ message }) => {
    throw new Reason("lost", lost ?? message);
  });

  // Makes something of the device; the errors of making it are thrown.
  async function checked(make) {
    const kinds = ["validation", "internal", "out-of-memory"];
    kinds.forEach((kind) => device.pushErrorScope(kind));
    let made, thrown;
    try {
      made = make();
    } catch (error) {
      thrown = error;
    }
    const errors = kinds.map(() => device.popErrorScope());
    const [caught] = (await given(Promise.all(errors))).filter(Boolean);
    if (lost) throw new Reason("lost", lost);
    if (caught) throw new Error(caught.message);
    if (thrown) throw thrown;
    return made;
  }

  function texture(format, width, height, usage, depthOrArrayLayers = 1) {
    return device.createTexture({ format, size: { width, height, depthOrArrayLayers }, usage });
  }

  function filled(format, [width, height, layers], bytes) {
    const made = texture(format, width, height, TEXTURE_BINDING | COPY_DST, layers);
    const layout = { bytesPerRow: bytes.byteLength / (height * layers), rowsPerImage: height };
    device.queue.writeTexture({ texture: made }, bytes, layout, [width, height, layers]);
    return made;
  }

  // Draws a triangle over everything.
  function covered(encoder, pipeline, group, attachments) {
    const pass = encoder.beginRenderPass({ colorAttachments: [], ...attachments });
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, group);
    pass.draw(3);
    pass.end();
  }

  function depthTexture({ width, height, layers, texels }) {
    const vertex = { module: triangle };
    depths ??= device.createRenderPipeline({
      layout: "auto",
      vertex,
      fragment: { module: device.createShaderModule({ code: DEPTH }), targets: [] },
      depthStencil: { format: "depth32float", depthWriteEnabled: true, depthCompare: "always" },
    });
    const made = texture("depth32float", width, height, TEXTURE_BINDING | RENDER_ATTACHMENT, layers);
    const encoder = device.createCommandEncoder();
    const bytes = bytesOf(texels);
    const size = bytes.byteLength / layers;
    for (let layer = 0; layer < layers; layer += 1) {
      const part = bytes.subarray(layer * size, (layer + 1) * size);
      const stored = filled("r32uint", [width, height, 1], part).createView();
      const view = made.createView({ dimension: "2d", baseArrayLayer: layer, arrayLayerCount: 1 });
      const group = device.createBindGroup({
        layout: depths.getBindGroupLayout(0),
        entries: [{ binding: 0, resource: stored }],
      });
      covered(encoder, depths, group, {
        depthStencilAttachment: {
          view, depthClearValue: 0, depthLoadOp: "clear", depthStoreOp: "store",
        },
      });
    }
    device.queue.submit([encoder.finish()]);
    return made;
  }

  // In 32 bits, or in 16 where those say the same and the device filters no others.
  function colorTexture({ width, height, layers, texels }) {
    const floats = floatsOf(texels);
    if (!device.features.has(FILTERS)) {
      const halves = new Float16Array(floats);
      if (floats.every((float, index) => Object.is(float, halves[index]))) {
        return filled("rgba16float", [width, height, layers], halves);
      }
    }
    return filled("rgba32float", [width, height, layers], floats);
  }

  // The texture or the sampler of a fixture.
  function resource({ texture, sampler }) {
    if (texture) {
      const made = texture.depth ? depthTexture(texture) : colorTexture(texture);
      return made.createView({ dimension: texture.layers === 6 ? "cube" : "2d" });
    }
    const { address, filter, compare } = sampler;
    return device.createSampler({
      addressModeU: address, addressModeV: address, addressModeW: address,
      magFilter: filter, minFilter: filter,
      ...(compare ? { compare } : {}),
    });
  }

  const resources = (fixtures) =>
    new Map(fixtures.map((fixture) => [fixture.place, resource(fixture)]));

  async function kept({ id, code, entry, layout, fixtures }) {
    const made = await checked(() => {
      const group = device.createBindGroupLayout({ entries: layout });
      const pipeline = device.createRenderPipelineAsync({
        layout: device.createPipelineLayout({ bindGroupLayouts: [group] }),
        vertex: { module: triangle },
        fragment: {
          module: device.createShaderModule({ code }),
          entryPoint: entry,
          targets: [{ format: "rgba32uint" }],
        },
      });
      // An error of the shader's is thrown before anybody waits for this one.
      pipeline.catch(() => {});
      return { group, pipeline, resources: resources(fixtures) };
    });
    kernels.set(id, { ...made, pipeline: await made.pipeline });
  }

  const prepare = (list) => Promise.all(list.map((kernel) => answered(() => kept(kernel))));

  // A buffer with all pixels of a target, 16 bytes each.
  function copied(encoder, from, width, height) {
    const bytesPerRow = Math.ceil(width / 16) * 256;
    const { MAP_READ, COPY_DST } = GPUBufferUsage;
    const buffer = device.createBuffer({ size: bytesPerRow * height, usage: MAP_READ | COPY_DST });
    encoder.copyTextureToBuffer({ texture: from }, { buffer, bytesPerRow }, [width, height]);
    return { buffer, bytesPerRow, width, height };
  }

  async function read({ buffer, bytesPerRow, width, height }) {
    await given(buffer.mapAsync(GPUMapMode.READ));
    const all = new Uint8Array(buffer.getMappedRange());
    const row = width * 16;
    const pixels = new Uint8Array(row * height);
    for (let y = 0; y < height; y += 1) {
      pixels.set(all.subarray(y * bytesPerRow, y * bytesPerRow + row), y * row);
    }
    buffer.destroy();
    return textOf(pixels);
  }

  async function run({ id, rows, texels }) {
    const kernel = kernels.get(id);
    const bytes = bytesOf(texels);
    const made = await checked(() => {
      const height = bytes.byteLength / (INPUT_WIDTH * 16);
      const inputs = filled("rgba32uint", [INPUT_WIDTH, height, 1], bytes);
      const target = texture("rgba32uint", TARGET_WIDTH, rows, RENDER_ATTACHMENT | COPY_SRC);
      const rest = [...kernel.resources].map(([place, resource]) => (
        { binding: Number(place.split("/")[1]), resource }
      ));
      const entries = [{ binding: 0, resource: inputs.createView() }, ...rest];
      const group = device.createBindGroup({ layout: kernel.group, entries });
      const encoder = device.createCommandEncoder();
      covered(encoder, kernel.pipeline, group, { colorAttachments: [attachment(target, false)] });
      const pending = copied(encoder, target, TARGET_WIDTH, rows);
      device.queue.submit([encoder.finish()]);
      return { inputs, target, pending };
    });
    const words = await read(made.pending);
    made.inputs.destroy();
    made.target.destroy();
    return words;
  }

  function attachment(target, isFloat) {
    const one = isFloat ? SENTINEL_FLOAT : SENTINEL;
    const clearValue = [one, one, one, one];
    return { view: target.createView(), clearValue, loadOp: "clear", storeOp: "store" };
  }

  function buffer(bytes, usage) {
    const size = Math.ceil(bytes.byteLength / 4) * 4;
    const made = device.createBuffer({ size, usage: usage | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(made, 0, bytes);
    return made;
  }

  // The meshes on the device.
  function uploaded({ words, indices, count }) {
    const { VERTEX, INDEX } = GPUBufferUsage;
    const made = (text, usage) => (text ? buffer(bytesOf(text), usage) : null);
    return { vertices: made(words, VERTEX), indices: made(indices, INDEX), count };
  }

  function pipelineOf({ vertex, fragment, formats, meshes, tested }, groups) {
    const [{ stride, attributes }] = meshes;
    const module = ({ code }) => device.createShaderModule({ code });
    const layouts = attributes.map(({ shaderLocation, offset, format }) => (
      { shaderLocation, offset, format }
    ));
    return device.createRenderPipeline({
      layout: device.createPipelineLayout({ bindGroupLayouts: groups }),
      vertex: {
        module: module(vertex),
        entryPoint: vertex.entry,
        buffers: layouts.length ? [{ arrayStride: stride, attributes: layouts }] : [],
      },
      fragment: {
        module: module(fragment),
        entryPoint: fragment.entry,
        targets: formats.map((isFloat) => ({ format: isFloat ? "rgba32float" : "rgba32uint" })),
      },
      depthStencil: tested
        ? { format: "depth32float", depthWriteEnabled: true, depthCompare: "less" }
        : undefined,
    });
  }

  // The bind groups of one item in one view.
  function bound(layout, groups, kept, buffers) {
    return layout.map((entries, group) => {
      const one = ({ binding }) => {
        const place = `${group}/${binding}`;
        const uniform = GPUBufferUsage.UNIFORM;
        const found = kept.get(place) ?? { buffer: buffer(bytesOf(buffers[place]), uniform) };
        return { binding, resource: found };
      };
      return device.createBindGroup({ layout: groups[group], entries: entries.map(one) });
    });
  }

  function drawn(encoder, question, { pipeline, groups, kept, meshes }, view) {
    const { size: [width, height], formats, layout, tested } = question;
    const targets = formats.map((isFloat) => (
      texture(isFloat ? "rgba32float" : "rgba32uint", width, height, RENDER_ATTACHMENT | COPY_SRC)
    ));
    const colorAttachments = targets.map((target, index) => attachment(target, formats[index]));
    const depthStencilAttachment = tested
      ? {
        view: texture("depth32float", width, height, RENDER_ATTACHMENT).createView(),
        depthClearValue: 1,
        depthLoadOp: "clear",
        depthStoreOp: "discard",
      }
      : undefined;
    const pass = encoder.beginRenderPass({ colorAttachments, depthStencilAttachment });
    pass.setPipeline(pipeline);
    meshes.forEach(({ vertices, indices, count }, item) => {
      bound(layout, groups, kept, view[item]).forEach((one, index) => pass.setBindGroup(index, one));
      if (vertices) pass.setVertexBuffer(0, vertices);
      if (indices) {
        pass.setIndexBuffer(indices, "uint32");
        pass.drawIndexed(count);
      } else {
        pass.draw(count);
      }
    });
    pass.end();
    return targets.map((target) => copied(encoder, target, width, height));
  }

  async function frames(question) {
    const pending = await checked(() => {
      const groups = question.layout.map((entries) => device.createBindGroupLayout({ entries }));
      const ready = {
        groups,
        pipeline: pipelineOf(question, groups),
        kept: resources(question.fixtures),
        meshes: question.meshes.map(uploaded),
      };
      const encoder = device.createCommandEncoder();
      const views = question.views.map((view) => drawn(encoder, question, ready, view));
      device.queue.submit([encoder.finish()]);
      return views;
    });
    return Promise.all(pending.map((targets) => Promise.all(targets.map(read))));
  }

  // Waiting for a device that is lost fails in words of its own.
  const unlessLost = (make) => answered(async () => {
    if (lost) throw new Reason("lost", lost);
    try {
      return await make();
    } catch (error) {
      throw lost ? new Reason("lost", lost) : error;
    }
  });

  return {
    open,
    prepare: (list) => unlessLost(() => prepare(list)),
    run: (question) => unlessLost(() => run(question)),
    frames: (question) => unlessLost(() => frames(question)),
  };
})();
