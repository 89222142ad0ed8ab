// Vite plugins: a manifest of Lamplight is a module.

import path from "node:path";
import { fileURLToPath } from "node:url";

import { BundleError } from "@lamplight/bundle";
import MagicString from "magic-string";

import { keyText } from "./client.js";
import { Manifest } from "./manifest.js";
import { importsOf, usageOf } from "./usage.js";

const NAME = "lamplight";
const OWN = path.dirname(fileURLToPath(import.meta.url));
/** Where the reader of bundles is, which may be a linked package outside of the page's folder. */
const READER = path.dirname(fileURLToPath(import.meta.resolve("@lamplight/bundle")));

/** The start of the names of modules that have one thing of a bundle. */
const PART = "\0lamplight:";

const slashed = (file) => file.replaceAll("\\", "/");
const own = (name) => JSON.stringify(slashed(path.join(OWN, name)));

/** A manifest is the file `lamplight.toml`, or any file in TOML with the query `?lamplight`. */
function manifestOf(id) {
  const [file, query = ""] = id.split("?");
  if (!file.endsWith(".toml") || id.startsWith("\0")) return undefined;
  const isMeant = path.basename(file) === "lamplight.toml" || query.split("&").includes("lamplight");
  return isMeant ? path.normalize(file) : undefined;
}

/** What the plugins of one configuration share. */
class Shared {
  constructor(options) {
    this.options = { types: true, ...options };
    this.manifests = new Map();
  }

  configure(config) {
    this.isBuild = config.command === "build";
    this.logger = config.logger;
    this.cache = path.join(config.cacheDir, "lamplight");
    config.server.fs.allow.push(this.cache, OWN, READER);
  }

  manifest(file) {
    let known = this.manifests.get(file);
    if (!known) {
      known = new Manifest(file, { ...this.options, cache: this.cache });
      this.manifests.set(file, known);
    }
    return known;
  }
}

/** The module of a manifest. Its bundle is an asset. */
function moduleText({ bundle, url }) {
  return [
    `import { programsOf } from ${own("client.js")};`,
    `import url from ${JSON.stringify(`${slashed(url)}?url&no-inline`)};`,
    `export default programsOf(import.meta.hot, url, ${JSON.stringify(bundle.programs)});`,
  ].join("\n");
}

const literalOf = (value) => `JSON.parse(${JSON.stringify(JSON.stringify(value))})`;

/** A module that has one shader, or one layout. */
async function partText(bundle, { program, layout, entry, key, target }) {
  if (layout) return `export default ${literalOf(bundle.layout(program))};`;
  const shader = bundle.find(program, entry, keyText(key), target);
  const { unit, hash, stage, size, reflection, native, constants } = shader;
  const rest = { unit, target, hash, entry: shader.entry, stage, size, reflection, native, constants };
  const parts = literalOf({ ...rest, text: await shader.text() });
  return `import { inlined } from ${own("inlined.js")};\nexport default /*@__PURE__*/ inlined(${parts});`;
}

const isBinary = ({ target }) => target === "spirv";

/** Refuses a call that the bundle cannot answer, at its place. */
function checkCall(context, bundle, call) {
  try {
    if (call.layout) bundle.program(call.program);
    else bundle.find(call.program, call.entry, keyText(call.key), call.target);
  } catch (error) {
    if (!(error instanceof BundleError)) throw error;
    context.error(error.message, call.start);
  }
}

/** Puts modules with one shader each into the place of calls, and drops an import without a use. */
function inlineCalls(text, declared, { calls, isAll }, file) {
  const imports = new Map();
  const known = calls.filter((call) => !isBinary(call));
  for (const { start, end, ...asked } of known) {
    const id = PART + encodeURIComponent(JSON.stringify({ file, ...asked }));
    if (!imports.has(id)) imports.set(id, `__lamplight_${declared.start}_${imports.size}`);
    text.overwrite(start, end, `Promise.resolve(${imports.get(id)})`);
  }
  const lines = [...imports].map(([id, name]) => `import ${name} from ${JSON.stringify(id)};`);
  const isUnused = isAll && known.length === calls.length;
  if (isUnused) text.overwrite(declared.start, declared.end, lines.join(" ") || ";");
  else text.appendLeft(declared.end, ` ${lines.join(" ")}`);
}

/** Looks at what a module asks of manifests. In a build, what is known goes into the code. */
async function transformModule(shared, context, code, id) {
  if (!code.includes(".toml") || id.includes("\0")) return undefined;
  const root = context.parse(code);
  const text = new MagicString(code);
  for (const declared of importsOf(root)) {
    if (!declared.local || !declared.source.includes(".toml")) continue;
    const resolved = await context.resolve(declared.source, id);
    const file = resolved && manifestOf(resolved.id);
    const made = file && (await shared.manifest(file).build().catch(() => undefined));
    // Where there is no bundle, the module of the manifest says why.
    if (!made) continue;
    const usage = usageOf(root, declared.local, shared.isBuild);
    for (const call of usage.calls) checkCall(context, made.bundle, call);
    if (shared.isBuild) inlineCalls(text, declared, usage, file);
  }
  return text.hasChanged() ? { code: text.toString(), map: text.generateMap({ hires: true }) } : undefined;
}

/** The module of a manifest, or of a part of one. */
async function loadModule(shared, context, id) {
  const js = (code) => ({ code, moduleType: "js", moduleSideEffects: false, map: null });
  if (id.startsWith(PART)) {
    const { file, ...asked } = JSON.parse(decodeURIComponent(id.slice(PART.length)));
    const { bundle } = await shared.manifest(file).build();
    return js(await partText(bundle, asked));
  }
  const file = manifestOf(id);
  if (!file) return undefined;
  const manifest = shared.manifest(file);
  try {
    const made = await manifest.build();
    for (const warning of made.warnings.splice(0)) shared.logger.warn(warning);
    return js(moduleText(made));
  } finally {
    for (const read of manifest.files) context.addWatchFile(read);
  }
}

/** The modules that an edit of a file replaces. */
function replacedModules(shared, graph, file, modules) {
  const replaced = new Set(modules);
  for (const manifest of shared.manifests.values()) {
    if (!manifest.concerns(path.normalize(file))) continue;
    manifest.touch();
    for (const module of graph.getModulesByFile(slashed(manifest.file)) ?? []) replaced.add(module);
  }
  return [...replaced];
}

/** The plugins that import manifests of Lamplight. */
export default function lamplight(options = {}) {
  const shared = new Shared(options);
  const modules = {
    name: NAME,
    enforce: "pre",
    config: () => ({ optimizeDeps: { exclude: ["@lamplight/bundle", "@lamplight/vite"] } }),
    configResolved: (config) => shared.configure(config),
    watchChange(file) {
      for (const manifest of shared.manifests.values()) {
        if (manifest.concerns(path.normalize(file))) manifest.touch();
      }
    },
    resolveId: (id) => (id.startsWith(PART) ? id : undefined),
    load(id) {
      return loadModule(shared, this, id);
    },
    hotUpdate({ file, modules }) {
      return replacedModules(shared, this.environment.moduleGraph, file, modules);
    },
  };
  const calls = {
    name: `${NAME}:calls`,
    enforce: "post",
    transform(code, id) {
      return transformModule(shared, this, code, id);
    },
  };
  return [modules, calls];
}
