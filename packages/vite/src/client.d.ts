import type { Bundle, LayoutBinding, Shader } from "@lamplight/bundle";

/** A program of a manifest, with the types of its keys, entry points and targets. */
export interface Program<Key, Entry extends string, Target extends string> {
  readonly name: string;
  /** The shader of a permutation. What the key leaves out is at its default. */
  find(entry: Entry, key: Key, target: Target): Promise<Shader>;
  /** What all permutations of the program bind together. */
  layout(): Promise<LayoutBinding[]>;
  /** Every key of an entry point, as text, sorted. */
  keys(entry: Entry): Promise<string[]>;
  /** Whether a shader that was found is another one since the last edit. */
  changed(shader: Shader): Promise<boolean>;
  /** The whole bundle. */
  bundle(): Promise<Bundle>;
}
