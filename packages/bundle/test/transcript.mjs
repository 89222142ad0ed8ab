// What this reader says of the set of bundles, in the form of `transcript.rs` of lamplight-bundle.
//
//     node transcript.mjs FOLDER file|directory|range NAME...

import { readFileSync } from "node:fs";
import { createServer } from "node:http";

import { open, openBytes } from "../src/index.js";
import { constantChoices } from "../src/describe.js";

const [folder, form, ...names] = process.argv.slice(2);
const read = (name) => new Uint8Array(readFileSync(`${folder}/${name}`));
const queries = readFileSync(`${folder}/queries.txt`, "utf8").trim().split("\n");
const lines = [];

function fnv(bytes) {
  let hash = 0xcbf29ce484222325n;
  for (const byte of bytes) hash = ((hash ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn;
  return hash.toString(16).padStart(16, "0");
}

function bindingLine({ group, binding, kind, name, size = 0, count = 1, texture }) {
  const { dimension, sample_type = "-", format = "-", access = "-" } = texture ?? {};
  const rest = texture ? ` ${dimension} ${sample_type} ${format} ${access}` : "";
  return `binding ${group} ${binding} ${kind} ${name} ${size} ${count}${rest}`;
}

function memberLines(members, indent) {
  for (const { name, offset, size, stride = 0, shape = {}, members: inner = [] } of members) {
    const { scalar = "-", columns = 0, rows = 0, matrix_stride = 0, count = 0 } = shape;
    const numbers = [columns, rows, matrix_stride, count, stride].join(" ");
    lines.push(`${indent}member ${name} ${offset} ${size} ${scalar} ${numbers}`);
    memberLines(inner, `${indent}  `);
  }
}

function ask(bundle, query) {
  const [program, language, entry, key, target] = query.split(" ");
  const options = language === "-" ? {} : { language };
  return bundle.find(program, entry, key.replaceAll("+", " "), target, options);
}

async function answer(bundle, query) {
  lines.push(`> ${query}`);
  let shader, bytes;
  try {
    shader = ask(bundle, query);
    bytes = await shader.bytes();
  } catch (error) {
    if (!error.code || !error.message) throw error;
    lines.push(`! ${error.code}${error.code === "miss" ? ` ${error.message}` : ""}`);
    return;
  }
  lines.push(`${shader.stage} ${shader.entry} ${bytes.length} ${fnv(bytes)}`);
  for (const { name, type, value, bits, id = -1, symbol = "-" } of constantChoices(shader)) {
    const hex = bits.toString(16).padStart(8, "0");
    lines.push(`constant ${name} ${type} ${value} ${hex} ${id} ${symbol}`);
  }
  for (const binding of shader.reflection.bindings) {
    lines.push(bindingLine(binding));
    const isHere = (slot) => slot.group === binding.group && slot.binding === binding.binding;
    for (const { space = 0, index = 0, name = "-" } of shader.native.slots.filter(isHere)) {
      lines.push(`  slot ${space} ${index} ${name}`);
    }
    memberLines(binding.members ?? [], "  ");
  }
}

async function good(bundle) {
  for (const query of queries) await answer(bundle, query);
  for (const program of ["lit", "write"]) {
    lines.push(`> layout ${program} wesl`);
    for (const entry of bundle.layout(program)) {
      lines.push(`${bindingLine(entry)} ${entry.stages.join(",")}`);
      for (const [axis, values] of Object.entries(entry.when ?? {})) {
        lines.push(`  when ${axis} ${values.join(" ")}`);
      }
    }
  }
}

async function damaged(name) {
  try {
    const bundle = openBytes(read(name));
    for (const query of queries.slice(0, 7)) await ask(bundle, query).bytes();
    lines.push(`${name} is read`);
  } catch (error) {
    if (!error.code || !error.message) throw error;
    lines.push(`${name} ${error.code}`);
  }
}

/** A server of the set that answers range requests, and counts the bytes that it sends. */
async function serve(handle) {
  let sent = 0;
  const server = createServer((request, response) => {
    const bytes = read(request.url);
    const range = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? "");
    const part = range ? bytes.subarray(Number(range[1]), Number(range[2]) + 1) : bytes;
    sent += part.length;
    response.writeHead(range ? 206 : 200).end(part);
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  await handle(`http://127.0.0.1:${server.address().port}`);
  server.close();
  return sent;
}

if (form === "file") await good(openBytes(read("good.lamplight")));
else if (form === "directory") await serve(async (url) => good(await open(`${url}/good/`)));
else await serve(async (url) => good(await open(`${url}/good.lamplight`)));
for (const name of names) await damaged(name);
console.log(lines.join("\n"));
