import type { Bundle, Language, LayoutBinding, Shader } from "./index.js";

export { packBlock } from "./index.js";

/**
 * The entries of each group of a program's layout, by the number of the group. Throws where
 * permutations bind different things in one place.
 */
export function layoutEntries(layout: LayoutBinding[]): GPUBindGroupLayoutEntry[][];

/**
 * One pipeline layout for all permutations of a program, and its bind group layouts. What the
 * permutations bind is that of a bundle, or a list.
 */
export function pipelineLayout(
  device: GPUDevice, bundle: Bundle | LayoutBinding[], program: string, options?: { language?: Language },
): { layout: GPUPipelineLayout; groups: GPUBindGroupLayout[] };

/** A stage of a pipeline: its module, its entry point, and the constants that the key chooses. */
export function stage(
  device: GPUDevice, shader: Shader,
): Promise<{ module: GPUShaderModule; entryPoint: string; constants: Record<string, number> }>;

/**
 * One vertex buffer with all attributes of a vertex stage, one after the other without padding.
 * Built-in inputs, and inputs of types other than `f32`, `i32` and `u32`, are left out.
 */
export function vertexBuffer(shader: Shader): GPUVertexBufferLayout;
