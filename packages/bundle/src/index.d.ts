/** The version of bundles that this reader reads. */
export const VERSION: number;

export type Language = "wesl" | "glsl";
export type Stage = "vertex" | "fragment" | "compute";
export type BindingKind =
  | "uniform" | "storage" | "texture" | "storage_texture" | "sampler" | "comparison_sampler" | "immediate";
/** A group and a binding. */
export type Place = [group: number, binding: number];

/** A type of numbers; of an array, of one element. */
export interface Shape {
  scalar?: string;
  rows?: number;
  columns?: number;
  matrix_stride?: number;
  count?: number;
}

export interface TextureShape {
  dimension: "1d" | "1d_array" | "2d" | "2d_array" | "3d" | "cube" | "cube_array";
  multisampled?: boolean;
  sample_type?: "float" | "unfilterable_float" | "depth" | "sint" | "uint";
  format?: string;
  access?: "read" | "write" | "read_write";
}

/** A member of a buffer. Offsets, sizes and strides are in bytes. */
export interface Member {
  name: string;
  type: string;
  offset: number;
  size: number;
  stride?: number;
  shape?: Shape;
  members?: Member[];
}

export interface Binding {
  group: number;
  binding: number;
  name: string;
  kind: BindingKind;
  type: string;
  count?: number;
  size?: number;
  writable?: boolean;
  shape?: Shape;
  texture?: TextureShape;
  members?: Member[];
}

/** A binding that some permutations of a program have. */
export interface LayoutBinding extends Binding {
  stages: Stage[];
  /** For each axis that decides about it, the values with which some permutation has it. */
  when?: Record<string, string[]>;
}

export interface Varying {
  name?: string;
  location?: number;
  builtin?: string;
  type: string;
  shape?: Shape;
  interpolation?: string;
  sampling?: string;
  /** Which source for blending an output is, with two sources. */
  blend_src?: number;
}

export interface Override {
  name?: string;
  id?: number;
  type: string;
  default?: string;
}

export interface Reflection {
  stage: Stage;
  workgroup_size?: [number, number, number];
  inputs: Varying[];
  outputs: Varying[];
  bindings: Binding[];
  pairs: { texture: Place; sampler: Place }[];
  overrides: Override[];
}

export interface ClipSpace {
  y: "up" | "down";
  near: number;
  far: number;
  is_converted: boolean;
  viewport: "positive" | "negative";
  rows: "top_first" | "bottom_first";
  front_face: "same" | "reversed";
}

/** Names and numbers of one target. */
export interface Native {
  entry_name: string;
  slots: {
    group: number; binding: number; space?: number; index?: number; register?: string; name?: string;
  }[];
  combined?: { texture: Place; sampler?: Place; name: string }[];
  choices?: { name: string; id?: number; symbol?: string }[];
  semantics?: { location: number; name: string; index: number }[];
  sampler_heaps?: unknown[];
  buffer_sizes?: { index: number; buffers: Place[] };
  first_instance?: string;
  clip?: ClipSpace;
  optimiser?: string;
}

/** The value of an override that a key chooses. */
export interface Constant {
  name: string;
  type: "bool" | "i32" | "u32" | "f32";
  value: string;
  /** The value as the 32 bits of its type. */
  bits: number;
}

export interface ConstantChoice extends Constant {
  id?: number;
  symbol?: string;
}

/** Why a bundle, or a part of it, cannot be used. */
export class BundleError extends Error {
  readonly code: "corrupt" | "format" | "not_found" | "bad_key" | "miss" | "read";
  /** The nearest key that there is, of a miss. */
  readonly nearest?: string;
}

/** One permutation of an entry point, for one target. */
export class Shader {
  private constructor();
  /** Equal numbers are equal shaders, in every target. */
  readonly unit: number;
  readonly target: string;
  /** The name of the entry point in the output. */
  readonly entry: string;
  readonly stage: Stage;
  readonly size: number;
  /** Of the bytes, as hexadecimal digits: equal hashes are equal outputs. */
  readonly hash: string;
  readonly reflection: Reflection;
  readonly native: Native;
  readonly constants: Constant[];
  /** The bytes of the output, checked. They belong to the bundle: do not change them. */
  bytes(): Promise<Uint8Array>;
  /** The output as text. */
  text(): Promise<string>;
}

/** An open bundle. */
export class Bundle {
  private constructor();
  /** The names of the programs, sorted. */
  readonly programs: string[];
  /** What all permutations of a program in one language bind together. */
  layout(program: string, language?: Language): LayoutBinding[];
  /** Every key of an entry point, sorted. */
  keys(program: string, entry: string, options?: { language?: Language }): string[];
  /**
   * The shader of a key for a target. Axes may be in any order, and defaults may be written out. If
   * two languages have an entry point of that name, it is the one in WESL.
   */
  find(
    program: string, entry: string, key: string, target: string,
    options?: { language?: Language },
  ): Shader;
}

/** A bundle that is in memory: a single file, or the `index.bin` of a directory with `file`. */
export function openBytes(
  bytes: ArrayBuffer | Uint8Array,
  options?: { file?: (name: string) => Promise<Uint8Array> },
): Bundle;

/**
 * Opens a bundle by its address. A single file is read by range requests, if the server answers
 * them. An address that ends in `/` is that of a directory.
 */
export function open(url: string | URL): Promise<Bundle>;

/** The constants that the key chooses, each with the `id` or the `symbol` that the target has. */
export function constantChoices(shader: Shader): ConstantChoice[];

/** The value of a constant as a number: 0 and 1 for truth values. */
export function constantNumber(constant: Constant): number;

export type BlockValue = number | ArrayLike<number> | BlockRecord | BlockRecord[];
export type BlockRecord = { [member: string]: BlockValue | undefined };

/**
 * The bytes of a uniform buffer. `binding` is one of a layout or a reflection; `values` has a number
 * or a list of numbers for each member, a record for a struct, and a list of records for an array of
 * structs. Matrices are lists of columns without padding. What is left out is 0.
 */
export function packBlock(binding: Binding, values: BlockRecord): ArrayBuffer;
