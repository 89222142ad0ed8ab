// Writes the programs that the shader validation tests of gpuweb's CTS compile:
//   node cts.mjs CTS OUT LIMIT
// The tests run against a fixture that keeps each text with what the test expects of it. Of a test
// with more than LIMIT subcases, LIMIT at equal distances are taken.
import fs from 'node:fs';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import * as esbuild from 'esbuild';

const [root, out] = process.argv.slice(2, 4).map((argument) => path.resolve(argument));
const limit = Number(process.argv[4]);
const base = path.join(root, 'src/webgpu/shader/validation');
const specs = fs.readdirSync(base, { recursive: true }).filter((file) => file.endsWith('.spec.ts'));
specs.sort();

const imports = specs.map((file, at) => {
  return `import { g as g${at} } from ${JSON.stringify(path.join(base, file))};`;
});
const list = specs.map((file, at) => `[${JSON.stringify(file.replace('.spec.ts', ''))}, g${at}]`);
const contents = `${imports.join('\n')}\nexport const specs = [${list.join(', ')}];`;
const bundle = path.join(out, 'tests.mjs');
await esbuild.build({
  stdin: { contents, resolveDir: root, loader: 'ts' },
  bundle: true,
  platform: 'node',
  format: 'esm',
  outfile: bundle,
  logLevel: 'error',
});

// The language features that every browser has.
const features = new Set([
  'packed_4x8_integer_dot_product',
  'pointer_composite_access',
  'readonly_and_readwrite_storage_textures',
  'unrestricted_pointer_parameters',
]);
const gpu = { wgslLanguageFeatures: features };
Object.defineProperty(globalThis, 'navigator', { value: { gpu }, configurable: true });
const limits = new Proxy({}, { get: () => 1 << 20 });
const device = { features: { has: () => true }, limits, adapterInfo: {} };

class Skipped extends Error {}

function fixture(one, params, keep) {
  const skipIf = (skips) => {
    if (skips) throw new Skipped();
  };
  const test = Object.create(one.fixture.prototype);
  const values = { params, device, rec: {}, isCompatibility: false };
  for (const [name, value] of Object.entries(values)) Object.defineProperty(test, name, { value });
  const nothing = () => {};
  return Object.assign(test, {
    _params: params,
    expectCompileResult: (expected, code) => keep(expected === true, code),
    expectCompileWarning: (_, code) => keep(true, code),
    expectPipelineResult: nothing,
    hasLanguageFeature: (feature) => features.has(feature),
    skip: () => skipIf(true),
    skipIf: (skips) => skipIf(typeof skips === 'function' ? skips() : skips),
    skipIfLanguageFeatureNotSupported: (feature) => skipIf(!features.has(feature)),
    skipIfLanguageFeatureSupported: (feature) => skipIf(features.has(feature)),
    skipIfDeviceDoesNotHaveFeature: nothing,
    skipIfTextureFormatNotSupported: nothing,
    skipIfTextureFormatNotUsableWithStorageAccessMode: nothing,
    skipIfTextureLoadNotSupportedForTextureType: nothing,
  });
}

const seen = new Set();
const failures = [];
const lines = [];
const loaded = (await import(pathToFileURL(bundle))).specs;
for (const [file, group] of loaded) {
  for (const test of group.iterate()) {
    const subcases = [];
    for (const one of test.iterate(null)) {
      for (const subcase of one.subcases ?? [{}]) subcases.push([one, subcase]);
    }
    const count = Math.min(limit, subcases.length);
    for (let at = 0; at < count; at += 1) {
      const [one, subcase] = subcases[Math.floor((at * subcases.length) / count)];
      const name = `${file}:${one.id.test.join(',')}`;
      const keep = (expected, code) => {
        if (seen.has(code)) return;
        seen.add(code);
        lines.push(JSON.stringify({ test: name, expected, code }));
      };
      try {
        await one.fn(fixture(one, { ...one.params, ...subcase }, keep));
      } catch (error) {
        if (!(error instanceof Skipped)) failures.push(`${name}: ${error.message}`);
      }
    }
  }
}
fs.writeFileSync(path.join(out, 'programs.jsonl'), `${lines.join('\n')}\n`);
for (const failure of failures) console.error(failure);
process.exit(failures.length > 0 ? 1 : 0);
