// The types of a manifest's module, for TypeScript's option `allowArbitraryExtensions`.

import { readFile, writeFile } from "node:fs/promises";

const START = "// Written by @lamplight/vite; do not edit.";

const capital = (name) =>
  name.split(/[^A-Za-z0-9]+/).map((part) => part.charAt(0).toUpperCase() + part.slice(1)).join("");

const NUMBER = /^-?\d+(\.\d+)?$/;

/** The type of an axis: truth values, numbers or words. */
function valueType({ values }) {
  if (values.every((value) => value === "true" || value === "false")) return "boolean";
  if (values.every((value) => NUMBER.test(value))) return values.join(" | ");
  return values.map((value) => JSON.stringify(value)).join(" | ");
}

/** A name that no other has. */
function unique(name, taken) {
  let found = name;
  for (let number = 2; taken.has(found); number++) found = name + number;
  taken.add(found);
  return found;
}

function keyInterface(name, type, axes) {
  const fields = axes.filter(({ mode }) => mode !== "dynamic").map((axis) => {
    const preset = `  /** ${axis.default} where it is left out. */\n`;
    return `${preset}  ${JSON.stringify(axis.name)}?: ${valueType(axis)};\n`;
  });
  return `/** A permutation of program \`${name}\`. */\nexport interface ${type} {\n${fields.join("")}}\n`;
}

const union = (names) => [...new Set(names)].map((name) => JSON.stringify(name)).join(" | ") || "never";

/** The text of the declarations. */
export function typesText(bundle) {
  const taken = new Set(["Program"]);
  const targets = union(bundle.meta.targets.map(({ name }) => name));
  const keys = [], members = [];
  for (const name of bundle.programs) {
    const { axes, entries } = bundle.program(name);
    const type = unique(`${capital(name)}Key`, taken);
    keys.push(keyInterface(name, type, axes));
    const entry = union(entries.map(({ name: entry }) => entry));
    members.push(`  ${JSON.stringify(name)}: Program<${type}, ${entry}, ${targets}>;\n`);
  }
  const own = `declare const programs: {\n${members.join("")}};\nexport default programs;\n`;
  return [START, 'import type { Program } from "@lamplight/vite/client";\n', ...keys, own].join("\n");
}

/** Writes `NAME.d.toml.ts` beside `NAME.toml`, where it differs. Other people's files stay. */
export async function writeTypes(manifest, bundle) {
  const file = manifest.replace(/\.toml$/, ".d.toml.ts");
  const text = typesText(bundle);
  const old = await readFile(file, "utf8").catch(() => undefined);
  if (old === text) return;
  if (old !== undefined && !old.startsWith(START)) {
    throw new Error(`${file} is not a file that @lamplight/vite wrote: move it, or set \`types: false\``);
  }
  await writeFile(file, text);
}
