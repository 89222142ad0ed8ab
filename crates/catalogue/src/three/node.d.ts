import type { Node } from "three/webgpu";

/** A node of three.js, or a value that it makes one of. */
export type Argument = Node | number | boolean;

type Arguments<Types extends unknown[]> = { [Index in keyof Types]: Argument };

/** A function of TSL. The names and types of its parameters are those in shaders. */
export type NodeFunction<Types extends unknown[], Result extends string> = ((
  ...parameters: Arguments<Types>
) => Node) & { readonly result?: Result };
