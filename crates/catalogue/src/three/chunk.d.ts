/** A function, a constant or a structure in two languages. */
export interface Part {
  /** Its name in shaders. */
  readonly name: string;
  readonly isFunction: boolean;
  readonly wgsl: string;
  /** Empty where GLSL ES 3.00 does not have it. */
  readonly glsl: string;
  needs(): Part[];
}

/** The text in GLSL ES 3.00 of some parts, with all that they need, each once. */
export function chunk(...parts: Part[]): string;
