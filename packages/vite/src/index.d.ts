import type { Plugin } from "vite";

export interface Options {
  /** The command to run; else that of the variable `LAMPLIGHT`, else `lamplight` of the path. */
  command?: string;
  /** The targets to compile for, such as `["wgsl", "essl300"]`; else those of the manifest. */
  targets?: string[];
  /** Whether to write the types of each manifest beside it; `true` where it is left out. */
  types?: boolean;
}

/** The plugins that import manifests of Lamplight. */
export default function lamplight(options?: Options): Plugin[];
