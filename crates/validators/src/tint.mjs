// Validates WGSL: one path of a file for each line of standard input. Writes a line of JSON for each
// text that is refused, with its first mistake, and one that says how many were validated. Each has a
// mark, since Dawn writes warnings to the same output.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const folder = process.argv[process.argv.length - 1];
const found = createRequire(folder + "/").resolve("webgpu");
const { create } = await import(pathToFileURL(found).href);

// No device is needed to validate a text. It must live as long as its objects do.
const gpu = create(["backend=null"]);
const adapter = await gpu.requestAdapter();
// With all that the version knows, such as `f16`.
const device = await adapter.requestDevice({ requiredFeatures: [...(adapter.features ?? [])] });

const files = readFileSync(0, "utf8").split("\n");
const lines = [];
for (const [index, file] of files.entries()) {
  device.pushErrorScope("validation");
  const code = readFileSync(file, "utf8");
  const module = device.createShaderModule({ code });
  const { messages } = await module.getCompilationInfo();
  const error = await device.popErrorScope();
  const first = messages.find((message) => message.type === "error");
  if (first) {
    const { lineNum: line, linePos: column, message } = first;
    lines.push({ index, line, column, message });
  } else if (error) {
    lines.push({ index, line: 1, column: 1, message: error.message });
  }
}
lines.push({ validated: files.length });
process.stdout.write(lines.map((line) => `tint: ${JSON.stringify(line)}\n`).join(""), () => process.exit(0));
