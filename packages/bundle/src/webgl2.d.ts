import type { Shader } from "./index.js";

export { packBlock } from "./index.js";

export interface LinkedProgram {
  program: WebGLProgram;
  /** The binding point of each uniform block, by the author's name. */
  blocks: Record<string, number>;
  /** The texture units, each with the names of its texture and its sampler. */
  units: { unit: number; texture: string; sampler?: string }[];
  frontFace: "same" | "reversed";
  /** Whether the first row of a frame that was drawn is the top of the picture. */
  topFirst: boolean;
}

/** A program of two shaders. Without a fragment shader it writes depths alone. */
export function linkProgram(
  gl: WebGL2RenderingContext, vertex: Shader, fragment?: Shader,
): Promise<LinkedProgram>;

/** Binds a buffer to the block that the author calls so; nothing where the shader has none. */
export function bindBlock(
  gl: WebGL2RenderingContext, program: LinkedProgram, name: string, buffer: WebGLBuffer,
): void;

/** Binds a texture, and a sampler object if there is one, wherever the shader samples the texture. */
export function bindTexture(
  gl: WebGL2RenderingContext, program: LinkedProgram, name: string, target: number,
  texture: WebGLTexture, sampler?: WebGLSampler | null,
): void;

/** Sets which triangles are fronts: those that are counter-clockwise in the picture. */
export function setFrontFace(gl: WebGL2RenderingContext, program: LinkedProgram): void;
