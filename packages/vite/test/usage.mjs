// What is found in the code of pages, and in the rules of `lamplight gen --depfile`.

import assert from "node:assert/strict";

import { parseAst } from "vite";

import { filesOfRule } from "../src/manifest.js";
import { importsOf, usageOf } from "../src/usage.js";

const START = 'import lit from "./lamplight.toml";\n';

function used(code, isBuild = true) {
  const { calls, isAll } = usageOf(parseAst(START + code), "lit", isBuild);
  const asked = calls.map(({ program, layout, entry, key, target }) =>
    layout ? [program] : [program, entry, key, target]);
  return [asked, isAll];
}

const call = (key) => `lit.a.find("fs", ${key}, "wgsl")`;
const one = (key) => [["a", "fs", key, "wgsl"]];

assert.deepEqual(used(`await ${call('{ lamp: "spot", on: true, "steps": -2 }')}`),
  [one({ lamp: "spot", on: true, steps: -2 }), true]);
assert.deepEqual(used('lit["a"].find(`fs`, {}, "wgsl")'), [one({}), true]);
assert.deepEqual(used("const { length } = await lit.a.layout();"), [[["a"]], true]);
assert.deepEqual(used(`f(${call("{}")}, ${call("{ on }")})`), [one({}), false]);
assert.deepEqual(used(`${call("{ ...rest }")}; lit.b.keys("fs")`), [[], false]);
assert.deepEqual(used('lit?.a.find("fs", {}, "wgsl")'), [[], false]);
assert.deepEqual(used("export { lit }; ({ lit: other.lit })"), [[], false]);
assert.deepEqual(used("({ lit: other.lit })"), [[], true]);
// Another thing of the same name.
assert.deepEqual(used(`(lit) => ${call("{}")}`), [[], false]);
assert.deepEqual(used(`function f() { const lit = g(); return ${call("{}")}; }`), [[], false]);
assert.deepEqual(used(`function f({ lit }) { return ${call("{}")}; }`), [[], false]);
assert.deepEqual(used(`try { f() } catch (lit) { ${call("{}")} }`), [[], false]);
// Code for hot updates.
for (const hot of ["if (import.meta.hot) { g(lit) }", "import.meta.hot?.accept(() => g(lit))",
  "import.meta.hot && g(lit)", "if (undefined) g(lit)", "(void 0)?.accept(() => g(lit))"]) {
  assert.deepEqual(used(`${call("{}")}; ${hot}`), [one({}), true], hot);
  assert.deepEqual(used(`${call("{}")}; ${hot}`, false), [one({}), false], hot);
}
const declared = importsOf(parseAst(`${START}import { default as b } from "b"; import * as c from "c"; import d, { e } from "d";`));
assert.deepEqual(declared.map(({ source, local }) => [source, local]),
  [["./lamplight.toml", "lit"], ["b", "b"], ["c", undefined], ["d", undefined]]);

assert.deepEqual(filesOfRule("out/x.lamplight: \\\n  a.wesl \\\n  my\\ file.wesl \\\n  c$$d.wesl\n"),
  ["a.wesl", "my file.wesl", "c$d.wesl"]);
assert.deepEqual(filesOfRule("C:/out/x: C:/a.wesl\n"), ["C:/a.wesl"]);
