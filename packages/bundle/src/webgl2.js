// Programs for WebGL 2.

import { constantChoices, packBlock } from "./describe.js";

export { packBlock };

/** The text of a shader, with a macro for each constant that the key chooses. */
function withMacros(text, shader) {
  const macros = constantChoices(shader).filter(({ symbol }) => symbol);
  const lines = macros.map(({ symbol, value }) => `#define ${symbol} ${value}\n`).join("");
  const end = text.indexOf("\n") + 1;
  return text.slice(0, end) + lines + text.slice(end);
}

async function compile(gl, shader) {
  const made = gl.createShader(shader.stage === "vertex" ? gl.VERTEX_SHADER : gl.FRAGMENT_SHADER);
  gl.shaderSource(made, withMacros(await shader.text(), shader));
  gl.compileShader(made);
  return made;
}

function link(gl, stages) {
  const program = gl.createProgram();
  for (const made of stages) gl.attachShader(program, made);
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    const logs = [...stages.map((made) => gl.getShaderInfoLog(made)), gl.getProgramInfoLog(program)];
    throw new Error(`the program does not link:\n${logs.filter(Boolean).join("\n")}`);
  }
  for (const made of stages) gl.deleteShader(made);
  return program;
}

const nameAt = (shader, [group, binding]) =>
  shader.reflection.bindings.find((known) => known.group === group && known.binding === binding)
    ?.name;

/** Gives each uniform block its number, which is the same in both stages. */
function numberBlocks(gl, program, shader, blocks) {
  for (const { group, binding, name: author } of shader.reflection.bindings) {
    const isHere = (slot) => slot.group === group && slot.binding === binding;
    const { name } = shader.native.slots.find(isHere) ?? {};
    const index = name ? gl.getUniformBlockIndex(program, name) : gl.INVALID_INDEX;
    if (index === gl.INVALID_INDEX) continue;
    blocks[author] ??= Object.keys(blocks).length;
    gl.uniformBlockBinding(program, index, blocks[author]);
  }
}

/** Gives each combined texture and sampler a texture unit. */
function numberUnits(gl, program, shader, units) {
  for (const { texture, sampler, name } of shader.native.combined ?? []) {
    const place = gl.getUniformLocation(program, name);
    if (!place) continue;
    const unit = units.length;
    gl.uniform1i(place, unit);
    units.push({ unit, texture: nameAt(shader, texture), sampler: sampler && nameAt(shader, sampler) });
  }
}

/** The fragment shader of a pass that writes depths alone. */
const NOTHING = "#version 300 es\nvoid main() {}\n";

function compileNothing(gl) {
  const made = gl.createShader(gl.FRAGMENT_SHADER);
  gl.shaderSource(made, NOTHING);
  gl.compileShader(made);
  return made;
}

/**
 * A program of two shaders. Without a fragment shader it writes depths alone. `blocks` has the
 * binding point of each uniform block by the author's name, and `units` the texture units, each with
 * the names of its texture and its sampler.
 */
export async function linkProgram(gl, vertex, fragment) {
  const shaders = fragment ? [vertex, fragment] : [vertex];
  const stages = await Promise.all(shaders.map((shader) => compile(gl, shader)));
  if (!fragment) stages.push(compileNothing(gl));
  const program = link(gl, stages);
  const blocks = Object.create(null), units = [];
  gl.useProgram(program);
  for (const shader of shaders) {
    numberBlocks(gl, program, shader, blocks);
    numberUnits(gl, program, shader, units);
  }
  const { front_face: frontFace = "same", rows = "top_first" } = vertex.native.clip ?? {};
  return { program, blocks, units, frontFace, topFirst: rows === "top_first" };
}

/** Binds a buffer to the block that the author calls so; nothing where the shader has none. */
export function bindBlock(gl, { blocks }, name, buffer) {
  if (name in blocks) gl.bindBufferBase(gl.UNIFORM_BUFFER, blocks[name], buffer);
}

/** Binds a texture, and a sampler object if there is one, wherever the shader samples the texture. */
export function bindTexture(gl, { units }, name, target, texture, sampler = null) {
  for (const { unit } of units.filter((known) => known.texture === name)) {
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(target, texture);
    gl.bindSampler(unit, sampler);
  }
}

/** Sets which triangles are fronts: those that are counter-clockwise in the picture. */
export function setFrontFace(gl, { frontFace }) {
  gl.frontFace(frontFace === "reversed" ? gl.CW : gl.CCW);
}
