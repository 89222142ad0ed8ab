import type { ShaderResult } from "@lamplight/toolchain";
import { code, h } from "./dom";

/** What came of a shader: its text in a target, entry point by entry point, with the reflection. */
export function output(made: ShaderResult, target: string): HTMLElement[] {
    if (target === "composed") return made.text === undefined ? [] : [code(made.text, "composed text")];
    return made.entries.flatMap((entry) => {
        const found = entry.outputs[0];
        const words = () => {
            const view = new DataView(found.bytes.buffer, found.bytes.byteOffset, found.bytes.byteLength);
            const count = Math.floor(found.bytes.length / 4);
            return Array.from({ length: count }, (_, index) =>
                view.getUint32(4 * index, true).toString(16).padStart(8, "0") + (index % 8 === 7 ? "\n" : " ")).join("");
        };
        return [
            h("h2", {}, `${entry.name} (${entry.stage})`),
            code(found ? found.text ?? words() : "", `${entry.name} in ${target}`),
            h("details", {}, h("summary", {}, "Reflection"), code(JSON.stringify(entry.reflection, null, 2), "reflection")),
        ];
    });
}
