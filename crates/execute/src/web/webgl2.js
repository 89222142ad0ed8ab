// Kernels and frames with WebGL2.
"use strict";

const lamplight = (() => {
  const TRIANGLE = `#version 300 es
void main() {
    vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}`;

  let gl;
  const kernels = new Map();

  function open() {
    gl = document.createElement("canvas").getContext("webgl2", { antialias: false });
    if (!gl) throw new Error("there is no WebGL2");
    // Targets of floats, and filtered textures of floats, where they are there.
    gl.getExtension("EXT_color_buffer_float");
    gl.getExtension("OES_texture_float_linear");
    const named = gl.getExtension("WEBGL_debug_renderer_info");
    return gl.getParameter(named ? named.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  }

  const lost = () => new Reason("lost", "the context of WebGL2 is lost");

  function check() {
    const error = gl.getError();
    if (gl.isContextLost() || error === gl.CONTEXT_LOST_WEBGL) throw lost();
    if (error) throw new Error(`WebGL2 reports error 0x${error.toString(16).padStart(4, "0")}`);
  }

  // A context that is lost answers wrongly for a moment before it says so.
  const unlessLost = (make) => answered(async () => {
    try {
      return await make();
    } catch (error) {
      await new Promise((done) => setTimeout(done, 100));
      throw gl.isContextLost() ? lost() : error;
    }
  });

  // Turns on what a text requires.
  function extended(code) {
    for (const [, name] of code.matchAll(/^#extension GL_(\w+) : require$/gm)) {
      if (!gl.getExtension(name)) {
        throw new Reason("lacks", `WebGL2 has no ${name}, which the emitted text requires`);
      }
    }
  }

  function shader(kind, code) {
    extended(code);
    const made = gl.createShader(kind);
    gl.shaderSource(made, code);
    gl.compileShader(made);
    return made;
  }

  // Compiles and links without waiting for either.
  function begun(vertex, fragment) {
    const program = gl.createProgram();
    const shaders = [shader(gl.VERTEX_SHADER, vertex), shader(gl.FRAGMENT_SHADER, fragment)];
    shaders.forEach((one) => gl.attachShader(program, one));
    gl.linkProgram(program);
    return { program, shaders };
  }

  function linked({ program, shaders }) {
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      check();
      const refused = shaders.find((one) => !gl.getShaderParameter(one, gl.COMPILE_STATUS));
      throw new Error(refused
        ? `the browser rejects the emitted text: ${gl.getShaderInfoLog(refused)}`
        : `the browser does not link the emitted texts: ${gl.getProgramInfoLog(program)}`);
    }
    shaders.forEach((one) => gl.deleteShader(one));
    return program;
  }

  // What a texture needs to be complete with one level, where no sampler says otherwise.
  function nearest(target) {
    gl.texParameteri(target, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texParameteri(target, gl.TEXTURE_MAX_LEVEL, 0);
  }

  function uploaded({ width, height, layers, depth, texels }) {
    const target = layers === 6 ? gl.TEXTURE_CUBE_MAP : gl.TEXTURE_2D;
    const [internal, format] =
      depth ? [gl.DEPTH_COMPONENT32F, gl.DEPTH_COMPONENT] : [gl.RGBA32F, gl.RGBA];
    const floats = floatsOf(texels);
    const texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(target, texture);
    for (let layer = 0; layer < layers; layer += 1) {
      const size = floats.length / layers;
      const part = floats.subarray(layer * size, (layer + 1) * size);
      const face = layers === 6 ? gl.TEXTURE_CUBE_MAP_POSITIVE_X + layer : target;
      gl.texImage2D(face, 0, internal, width, height, 0, format, gl.FLOAT, part);
    }
    nearest(target);
    return { target, texture };
  }

  function samplerOf({ address, filter, compare }) {
    const made = gl.createSampler();
    const wrap = {
      "clamp-to-edge": gl.CLAMP_TO_EDGE, repeat: gl.REPEAT, "mirror-repeat": gl.MIRRORED_REPEAT,
    }[address];
    const how = filter === "linear" ? gl.LINEAR : gl.NEAREST;
    gl.samplerParameteri(made, gl.TEXTURE_MIN_FILTER, how);
    gl.samplerParameteri(made, gl.TEXTURE_MAG_FILTER, how);
    for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) {
      gl.samplerParameteri(made, axis, wrap);
    }
    if (compare) {
      const comparison = {
        less: gl.LESS, "less-equal": gl.LEQUAL, greater: gl.GREATER, "greater-equal": gl.GEQUAL,
      }[compare];
      gl.samplerParameteri(made, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
      gl.samplerParameteri(made, gl.TEXTURE_COMPARE_FUNC, comparison);
    }
    return made;
  }

  // Textures and samplers on their units, one for each combined sampler. The inputs of a kernel
  // have no fixture.
  function placed(program, units, fixtures) {
    const known = new Map(fixtures.map((fixture) => [fixture.place, fixture]));
    gl.useProgram(program);
    return units.map(({ name, texture, sampler }, index) => {
      gl.uniform1i(gl.getUniformLocation(program, name), index);
      const fixture = known.get(texture);
      if (!fixture) return { target: gl.TEXTURE_2D, texture: null, sampler: null };
      const settings = sampler && known.get(sampler).sampler;
      return { ...uploaded(fixture.texture), sampler: settings ? samplerOf(settings) : null };
    });
  }

  function bind(units, inputs) {
    units.forEach(({ target, texture, sampler }, index) => {
      gl.activeTexture(gl.TEXTURE0 + index);
      gl.bindTexture(target, texture ?? inputs);
      gl.bindSampler(index, sampler);
    });
  }

  function forgotten(units) {
    for (const { texture, sampler } of units) {
      gl.deleteTexture(texture);
      gl.deleteSampler(sampler);
    }
  }

  function prepare(list) {
    // All are begun before anybody waits for one: the browser compiles them side by side.
    const all = list.map((kernel) => ({ kernel, begun: answered(() => begun(TRIANGLE, kernel.code)) }));
    return Promise.all(all.map(async ({ kernel, begun }) => {
      const found = await begun;
      if (!found.value) return found;
      return unlessLost(() => {
        const program = linked(found.value);
        const units = placed(program, kernel.units, kernel.fixtures);
        check();
        kernels.set(kernel.id, { program, units });
      });
    }));
  }

  function made([width, height], [internal, format, type], texels) {
    const texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, internal, width, height, 0, format, type, texels);
    nearest(gl.TEXTURE_2D);
    return texture;
  }

  const words = (size, texels) =>
    made(size, [gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT], texels);
  const floats = (size) => made(size, [gl.RGBA32F, gl.RGBA, gl.FLOAT], null);

  // Binds a framebuffer with cleared targets.
  function framebuffer(size, formats) {
    const textures = formats.map((isFloat) => (isFloat ? floats(size) : words(size, null)));
    const points = formats.map((_, index) => gl.COLOR_ATTACHMENT0 + index);
    const made = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, made);
    points.forEach((point, index) => {
      gl.framebufferTexture2D(gl.FRAMEBUFFER, point, gl.TEXTURE_2D, textures[index], 0);
    });
    gl.drawBuffers(points);
    if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE) {
      check();
      throw new Error("WebGL2 draws into no such targets");
    }
    gl.viewport(0, 0, ...size);
    formats.forEach((isFloat, index) => {
      if (isFloat) {
        gl.clearBufferfv(gl.COLOR, index, new Float32Array(4).fill(SENTINEL_FLOAT));
      } else {
        gl.clearBufferuiv(gl.COLOR, index, new Uint32Array(4).fill(SENTINEL));
      }
    });
    return { made, textures };
  }

  function read([width, height], isFloat, index) {
    const pixels = new Uint32Array(width * height * 4);
    gl.readBuffer(gl.COLOR_ATTACHMENT0 + index);
    if (isFloat) {
      const floats = new Float32Array(pixels.buffer);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, floats);
    } else {
      gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, pixels);
    }
    return textOf(new Uint8Array(pixels.buffer));
  }

  // Depths for the bound framebuffer, all at the far plane.
  function attachDepths([width, height]) {
    const made = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, made);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT32F, width, height);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, made);
    gl.enable(gl.DEPTH_TEST);
    gl.clearBufferfv(gl.DEPTH, 0, [1]);
    return made;
  }

  function deleted({ made, textures }) {
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.deleteFramebuffer(made);
    textures.forEach((texture) => gl.deleteTexture(texture));
  }

  function run({ id, rows, texels }) {
    const { program, units } = kernels.get(id);
    const given = new Uint32Array(bytesOf(texels).buffer);
    const size = [TARGET_WIDTH, rows];
    const target = framebuffer(size, [false]);
    const inputs = words([INPUT_WIDTH, given.length / (INPUT_WIDTH * 4)], given);
    gl.frontFace(gl.CCW);
    gl.useProgram(program);
    bind(units, inputs);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const found = read(size, false, 0);
    deleted(target);
    gl.deleteTexture(inputs);
    check();
    return found;
  }

  function buffer(target, bytes) {
    const made = gl.createBuffer();
    gl.bindBuffer(target, made);
    gl.bufferData(target, bytes, gl.STATIC_DRAW);
    return made;
  }

  // std140 rounds the size of a block up to 16 bytes, and WebGL draws nothing from a buffer that is
  // smaller.
  function padded(bytes) {
    const whole = new Uint8Array(Math.ceil(bytes.length / 16) * 16);
    whole.set(bytes);
    return whole;
  }

  function attributes({ stride, attributes, words }) {
    if (!attributes.length) return [];
    const vertices = buffer(gl.ARRAY_BUFFER, bytesOf(words));
    for (const { shaderLocation, offset, format, words } of attributes) {
      gl.enableVertexAttribArray(shaderLocation);
      if (format.startsWith("uint")) {
        gl.vertexAttribIPointer(shaderLocation, words, gl.UNSIGNED_INT, stride, offset);
      } else {
        gl.vertexAttribPointer(shaderLocation, words, gl.FLOAT, false, stride, offset);
      }
    }
    return [vertices];
  }

  function drawItem(mesh, blocks, buffers) {
    const used = new Map(blocks.map(({ place, number }) => [place, number]));
    const kept = [...used].map(([place, number]) => {
      const made = buffer(gl.UNIFORM_BUFFER, padded(bytesOf(buffers[place])));
      gl.bindBufferBase(gl.UNIFORM_BUFFER, number, made);
      return made;
    });
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    kept.push(...attributes(mesh));
    if (mesh.indices) {
      kept.push(buffer(gl.ELEMENT_ARRAY_BUFFER, bytesOf(mesh.indices)));
      gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
    } else {
      gl.drawArrays(gl.TRIANGLES, 0, mesh.count);
    }
    gl.bindVertexArray(null);
    gl.deleteVertexArray(array);
    kept.forEach((one) => gl.deleteBuffer(one));
  }

  function frames(question) {
    const { size, tested, formats, vertex, fragment, units, fixtures } = question;
    const { blocks, reversed, meshes, views } = question;
    const program = linked(begun(vertex.code, fragment.code));
    for (const { name, number } of blocks) {
      const index = gl.getUniformBlockIndex(program, name);
      // One that the browser dropped needs none.
      if (index !== gl.INVALID_INDEX) gl.uniformBlockBinding(program, index, number);
    }
    const ready = placed(program, units, fixtures);
    gl.frontFace(reversed ? gl.CW : gl.CCW);
    const found = views.map((view) => {
      const target = framebuffer(size, formats);
      const depths = tested ? attachDepths(size) : null;
      gl.useProgram(program);
      bind(ready, null);
      meshes.forEach((mesh, item) => drawItem(mesh, blocks, view[item]));
      const targets = formats.map((isFloat, index) => read(size, isFloat, index));
      gl.disable(gl.DEPTH_TEST);
      deleted(target);
      gl.deleteRenderbuffer(depths);
      return targets;
    });
    forgotten(ready);
    gl.deleteProgram(program);
    check();
    return found;
  }

  return {
    open,
    prepare: (list) => unlessLost(() => prepare(list)),
    run: (question) => unlessLost(() => run(question)),
    frames: (question) => unlessLost(() => frames(question)),
  };
})();
