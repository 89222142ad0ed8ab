// Answers the requests of the test `toolchain::same_bytes` with the npm package and writes each
// answer after its length: `node answer.mjs PACKAGE REQUESTS ANSWERS`.
import { readFileSync, writeFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const [folder, requests, answers] = process.argv.slice(2);
const { load, Stopped } = await import(pathToFileURL(`${folder}/index.js`));
const lamplight = await load();
const asked = JSON.parse(readFileSync(requests, "utf8"));

const parts = [];
const text = (value) => bytes(Buffer.from(value, "utf8"));
const bytes = (value) => {
    const length = Buffer.alloc(4);
    length.writeUInt32LE(value.length);
    parts.push(length, value);
};

for (const request of asked.shaders) {
    const made = lamplight.compile(request);
    if (!made.ok) throw new Error(`${request.root}: ${made.diagnostics[0].text}`);
    text(made.text);
    for (const entry of made.entries) {
        text(entry.name);
        text(JSON.stringify(entry.reflection));
        for (const output of entry.outputs) {
            bytes(output.bytes);
            text(JSON.stringify(output.native));
        }
    }
}
for (const expression of asked.expressions) {
    const { value, diagnostics } = lamplight.evaluate(expression);
    if (value === undefined) throw new Error(`${expression.expression}: ${diagnostics[0].text}`);
    text(value);
}
for (const { files, root } of asked.mistakes) {
    text(lamplight.compile({ files, root, targets: ["wgsl"] }).diagnostics.map((one) => one.text).join(""));
}
for (const [path, ...words] of asked.references) {
    text(Array.from(lamplight.reference(path, words)).map(String).join(" "));
}
// A hostile text is refused, or it stops the toolchain with an error of the class `Stopped`. The next
// call must be answered nevertheless.
for (const files of asked.hostile) {
    try {
        const made = lamplight.compile({ files, root: "a.wesl", targets: ["wgsl"] });
        if (made.ok) throw new Error(`a hostile text compiled: ${files["a.wesl"].slice(0, 80)}`);
    } catch (error) {
        if (!(error instanceof Stopped)) throw error;
    }
    text(lamplight.evaluate({ expression: "1.0 + 2.0" }).value);
}
writeFileSync(answers, Buffer.concat(parts));
