// Nodes of TSL for functions that are there in WGSL and in GLSL.

import { CodeNode, FunctionNode } from "three/webgpu";
import { nodeObject } from "three/tsl";

/** The language of the shader that is being built. */
const languageOf = (builder) => (builder.renderer.backend.isWebGPUBackend ? "wgsl" : "glsl");

function textOf(part, builder) {
  const language = languageOf(builder);
  if (part[language]) return part[language];
  throw new Error(`\`${part.name}\` is not there in ${language.toUpperCase()}`);
}

/** One node for each part, so that a shader has each of them once. */
const nodes = new WeakMap();

function sharedNode(part) {
  let known = nodes.get(part);
  if (!known) {
    known = part.isFunction ? new PartFunction(part) : new PartCode(part);
    nodes.set(part, known);
  }
  return known;
}

const includesOf = (part, builder) =>
  part.needs().filter((needed) => needed[languageOf(builder)]).map(sharedNode);

/** A constant or a structure. */
class PartCode extends CodeNode {
  constructor(part) {
    super();
    this.part = part;
  }

  getIncludes(builder) {
    return includesOf(this.part, builder);
  }

  generate(builder) {
    this.code = `${textOf(this.part, builder)}\n`;
    return super.generate(builder);
  }
}

class PartFunction extends FunctionNode {
  constructor(part) {
    super();
    this.part = part;
  }

  getIncludes(builder) {
    return includesOf(this.part, builder);
  }

  getNodeFunction(builder) {
    this.code = textOf(this.part, builder);
    return super.getNodeFunction(builder);
  }
}

const isParameters = (value) =>
  value !== null && typeof value === "object" && !value.isNode && Object.getPrototypeOf(value) === Object.prototype;

/** A function of TSL: it takes its parameters in their order, or by their names. */
export function node(part) {
  return (...values) => {
    const [first] = values;
    const given = values.length === 1 && isParameters(first) ? [first] : values.map((value) => nodeObject(value));
    return sharedNode(part).call(...given);
  };
}
