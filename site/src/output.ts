import type { ShaderResult } from "@lamplight/toolchain";
import { code, h } from "./dom";
import { languageOf } from "./highlight";

/** The text of an entry point in a target: of a binary target, its words. */
function written(entry: ShaderResult["entries"][number]): string {
    const found = entry.outputs[0];
    if (!found) return "";
    if (found.text !== undefined) return found.text;
    const view = new DataView(found.bytes.buffer, found.bytes.byteOffset, found.bytes.byteLength);
    const count = Math.floor(found.bytes.length / 4);
    return Array.from({ length: count }, (_, index) =>
        view.getUint32(4 * index, true).toString(16).padStart(8, "0") + (index % 8 === 7 ? "\n" : " ")).join("");
}

/** The texts of a shader in a target, entry point by entry point. */
export function texts(made: ShaderResult, target: string): { title: string; text: string }[] {
    if (target === "composed") return made.text === undefined ? [] : [{ title: "composed text", text: made.text }];
    return made.entries.map((entry) => ({ title: `${entry.name} (${entry.stage})`, text: written(entry) }));
}

/** What came of a shader: its texts in a target, and the reflection. */
export function output(made: ShaderResult, target: string): HTMLElement[] {
    if (target === "composed") return texts(made, target).map(({ title, text }) => code(text, title, "wgsl"));
    return made.entries.flatMap((entry) => [
        h("h2", {}, `${entry.name} (${entry.stage})`),
        code(written(entry), `${entry.name} in ${target}`, languageOf(target)),
        h("details", {}, h("summary", {}, "Reflection"), code(JSON.stringify(entry.reflection, null, 2), "reflection", "json")),
    ]);
}
