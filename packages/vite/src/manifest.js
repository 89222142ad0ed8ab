// One manifest: its bundle, and the files that were read for it.

import { createHash } from "node:crypto";
import { copyFile, mkdir, readFile, readdir, rm, stat } from "node:fs/promises";
import path from "node:path";

import { openBytes } from "@lamplight/bundle";

import { errorOf, runCommand, warningsOf } from "./command.js";
import { writeTypes } from "./types.js";

/** How many older bundles stay, for pages that still read them. */
const KEPT = 4;

/** What a shader may be made of. */
const SOURCES = /\.(wesl|wgsl|glsl|vert|frag|comp|toml)$/;

/** The files of a rule for make: what follows the colon, with `\ ` for blanks and `$$` for `$`. */
export function filesOfRule(text) {
  const after = text.slice(text.search(/:\s/) + 1).replace(/\\\r?\n/g, " ");
  const words = after.match(/(?:\\[ #:\\]|[^\s])+/g) ?? [];
  return words.map((word) => word.replace(/\\([ #:\\])/g, "$1").replaceAll("$$", "$"));
}

/** The name of a bundle: that of its manifest, or of what every manifest is about. */
const nameOf = (file) => {
  const stem = path.basename(file, ".toml");
  return stem === "lamplight" ? "shaders" : stem;
};

export class Manifest {
  /** `cache` is a folder for bundles. */
  constructor(file, { command, targets, types, cache }) {
    this.file = file;
    this.folder = path.dirname(file);
    this.options = { command, targets, types };
    const own = createHash("sha256").update(`${file}\n${targets}`).digest("hex").slice(0, 12);
    this.place = path.join(cache, own);
    /** Every file that was read. */
    this.files = new Set([file]);
    this.edits = 0;
  }

  /** Whether an edit of a file may change the bundle. After an error, any source may mend it. */
  concerns(file) {
    const isBelow = !path.relative(this.folder, file).startsWith("..");
    return this.files.has(file) || (!this.made && isBelow && SOURCES.test(file));
  }

  /** Says that a file has changed. */
  touch() {
    this.edits++;
    this.running = undefined;
  }

  /** The bundle as the files are now. Runs that nothing has changed since are shared. */
  build() {
    this.running ??= this.run().catch((error) => {
      this.running = undefined;
      throw error;
    });
    return this.running;
  }

  async run() {
    const edits = this.edits;
    const made = await this.generate();
    return edits === this.edits ? made : this.build();
  }

  async generate() {
    const { command, targets, types } = this.options;
    await mkdir(this.place, { recursive: true });
    const [output, rule] = ["bundle.lamplight", "bundle.d"].map((name) => path.join(this.place, name));
    const words = ["gen", "--manifest", this.file, "-o", output, "--depfile", rule, "--diagnostics", "json"];
    if (targets) words.push("--target", targets.join(","));
    const ran = await runCommand(command, this.folder, words);
    if (ran.code !== 0) {
      const error = errorOf(ran, this.folder);
      for (const file of error.files) this.files.add(file);
      this.made = undefined;
      throw error;
    }
    const named = filesOfRule(await readFile(rule, "utf8"));
    this.files = new Set([this.file, ...named.map((name) => path.resolve(this.folder, name))]);
    const bytes = await readFile(output);
    const bundle = openBytes(bytes);
    if (types) await writeTypes(this.file, bundle);
    this.made = { bundle, url: await this.keep(output, bytes), warnings: warningsOf(ran, this.folder) };
    return this.made;
  }

  /** A copy that no later run replaces: a page may be reading it by parts. */
  async keep(output, bytes) {
    const hash = createHash("sha256").update(bytes).digest("hex").slice(0, 12);
    const folder = path.join(this.place, "kept", hash);
    const copy = path.join(folder, `${nameOf(this.file)}.lamplight`);
    await mkdir(folder, { recursive: true });
    await copyFile(output, copy);
    await this.forget(hash);
    return copy;
  }

  async forget(hash) {
    const kept = path.join(this.place, "kept");
    const others = (await readdir(kept)).filter((name) => name !== hash);
    const dated = await Promise.all(
      others.map(async (name) => [(await stat(path.join(kept, name))).mtimeMs, name]),
    );
    const old = dated.sort(([a], [b]) => b - a).slice(KEPT);
    await Promise.all(old.map(([, name]) => rm(path.join(kept, name), { recursive: true })));
  }
}
