// Layouts and stages for WebGPU.

import { constantChoices, constantNumber, packBlock } from "./describe.js";

export { packBlock };

const STAGES = { vertex: 1, fragment: 2, compute: 4 };

/** More than any device has. */
const MOST_GROUPS = 64;

const dashed = (name) => name.replaceAll("_", "-");

/** What a layout says of a resource. */
function resourceOf({ kind, size, writable, texture }) {
  const viewDimension = texture && dashed(texture.dimension);
  switch (kind) {
    case "uniform":
      return { buffer: { type: "uniform", minBindingSize: size } };
    case "storage":
      return { buffer: { type: writable ? "storage" : "read-only-storage", minBindingSize: size } };
    case "sampler":
      return { sampler: { type: "filtering" } };
    case "comparison_sampler":
      return { sampler: { type: "comparison" } };
    case "storage_texture": {
      const access = `${dashed(texture.access)}${texture.access === "read_write" ? "" : "-only"}`;
      return { storageTexture: { access, format: texture.format, viewDimension } };
    }
    default: {
      const sampleType = dashed(texture.sample_type);
      return { texture: { sampleType, viewDimension, multisampled: texture.multisampled ?? false } };
    }
  }
}

/** The entries of each group of a program's layout. Throws where permutations bind different things. */
export function layoutEntries(layout) {
  const groups = [];
  for (const binding of layout) {
    if (binding.kind === "immediate") continue;
    if (!(binding.group < MOST_GROUPS)) {
      throw new TypeError(`no device has a group ${binding.group}, which \`${binding.name}\` is in`);
    }
    const entries = (groups[binding.group] ??= []);
    if (entries.some((known) => known.binding === binding.binding)) {
      const place = `group ${binding.group} binding ${binding.binding}`;
      throw new TypeError(`${place}: permutations bind different things there`);
    }
    const visibility = binding.stages.reduce((all, stage) => all | STAGES[stage], 0);
    entries.push({ binding: binding.binding, visibility, ...resourceOf(binding) });
  }
  return Array.from(groups, (entries) => entries ?? []);
}

/** One pipeline layout for all permutations of a program, and its bind group layouts. */
export function pipelineLayout(device, bundle, program, { language } = {}) {
  const all = bundle.layout?.(program, language) ?? bundle;
  const groups = layoutEntries(all).map((entries, group) =>
    device.createBindGroupLayout({ label: `${program} group ${group}`, entries }),
  );
  const layout = device.createPipelineLayout({
    label: program,
    bindGroupLayouts: groups,
    immediateSize: all.find((binding) => binding.kind === "immediate")?.size,
  });
  return { layout, groups };
}

/** A stage of a pipeline: its module, its entry point, and the constants that the key chooses. */
export async function stage(device, shader) {
  const constants = {};
  for (const constant of constantChoices(shader)) {
    const name = constant.id ?? constant.symbol ?? constant.name;
    constants[name] = constantNumber(constant);
  }
  const module = device.createShaderModule({ code: await shader.text(), label: shader.entry });
  return { module, entryPoint: shader.entry, constants };
}

const FORMATS = { f32: "float32", i32: "sint32", u32: "uint32" };

/**
 * One vertex buffer with all attributes of a vertex stage, one after the other without padding:
 * `arrayStride` and `attributes`. Built-in inputs, and inputs of types other than `f32`, `i32` and
 * `u32`, are left out.
 */
export function vertexBuffer(shader) {
  let arrayStride = 0;
  const located = shader.reflection.inputs.filter(
    ({ location, shape }) => location !== undefined && shape && Object.hasOwn(FORMATS, shape.scalar),
  );
  const attributes = located.map(({ location, shape: { scalar, rows = 1 } }) => {
    const attribute = {
      shaderLocation: location,
      offset: arrayStride,
      format: rows === 1 ? FORMATS[scalar] : `${FORMATS[scalar]}x${rows}`,
    };
    arrayStride += 4 * rows;
    return attribute;
  });
  return { arrayStride, attributes };
}
