// What a page gets of a manifest.

import { open } from "@lamplight/bundle";

/** A key as text. What is undefined is at its default. */
export function keyText(key = {}) {
  const chosen = Object.entries(key).filter(([, value]) => value !== undefined);
  return chosen.map(([axis, value]) => `${axis}=${value}`).join(",");
}

/** The bundle of a manifest, which is opened when it is first asked for. */
class Source {
  constructor(url) {
    this.replace(url);
  }

  replace(url) {
    if (this.url !== url) this.opened = undefined;
    this.url = url;
  }

  bundle() {
    this.opened ??= open(new URL(this.url, globalThis.location?.href)).catch((error) => {
      this.opened = undefined;
      throw error;
    });
    return this.opened;
  }
}

/** A program of a manifest. */
export class Program {
  #asked = new WeakMap();

  constructor(name, source) {
    this.name = name;
    this.source = source;
  }

  bundle() {
    return this.source.bundle();
  }

  async find(entry, key, target) {
    const bundle = await this.bundle();
    const shader = bundle.find(this.name, entry, keyText(key), target);
    this.#asked.set(shader, [entry, key, target]);
    return shader;
  }

  async layout() {
    return (await this.bundle()).layout(this.name);
  }

  async keys(entry) {
    return (await this.bundle()).keys(this.name, entry);
  }

  async changed(shader) {
    const asked = this.#asked.get(shader);
    if (!asked) throw new TypeError(`this shader was not found in \`${this.name}\``);
    const now = await this.find(...asked);
    const parts = ["hash", "reflection", "native", "constants"];
    return parts.some((part) => JSON.stringify(now[part]) !== JSON.stringify(shader[part]));
  }
}

/** The programs of a manifest. After an edit, they are the same objects with the new bundle. */
export function programsOf(hot, url, names) {
  const { source, programs } = hot?.data.lamplight ?? { source: new Source(url), programs: {} };
  source.replace(url);
  for (const name of Object.keys(programs)) if (!names.includes(name)) delete programs[name];
  for (const name of names) programs[name] ??= new Program(name, source);
  if (hot) hot.data.lamplight = { source, programs };
  return programs;
}
