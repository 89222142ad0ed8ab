import * as raw from "./toolchain.js";

const NAMES = [
    "version", "targets", "library", "search", "written", "files", "file", "programs", "point",
    "compose", "compile", "lint", "evaluate", "curves", "reference", "studio", "pictureStart",
    "pictureFrames", "pictureControls", "sketchStart",
    "sketchControls", "costs", "sketchPixel", "picturePixel", "markKinds", "sketchMarks",
    "pictureMarks", "marksStep", "keepImage", "editor",
];

export class Stopped extends Error {
    name = "Stopped";
}

let loading;

/** Loads the toolchain once; later calls are given the same one. */
export function load(source) {
    loading ??= start(source).catch((error) => {
        loading = undefined;
        throw error;
    });
    return loading;
}

async function start(source) {
    raw.initSync({ module: await compiled(source ?? new URL("./toolchain_bg.wasm", import.meta.url)) });
    return Object.fromEntries(NAMES.map((name) => [name, guarded(name, raw[name])]));
}

async function compiled(source) {
    if (source instanceof WebAssembly.Module) return source;
    if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return WebAssembly.compile(source);
    const url = new URL(source, import.meta.url);
    if (url.protocol === "file:") {
        const { readFile } = await import("node:fs/promises");
        return WebAssembly.compile(await readFile(url));
    }
    const answer = await fetch(url);
    if (!answer.ok) throw new Error(`${url}: ${answer.status} ${answer.statusText}`);
    return WebAssembly.compile(await answer.arrayBuffer());
}

// Memory may be half written where a call was cut off (a deep nesting, an error of naga's): the
// toolchain is started anew, and the caller gets an error.
function guarded(name, call) {
    return (...inputs) => {
        try {
            return call(...inputs);
        } catch (error) {
            const isCut = error instanceof WebAssembly.RuntimeError || error instanceof RangeError;
            if (!isCut) throw error;
            raw.__wbg_reset_state();
            throw new Stopped(`the toolchain stopped in ${name}: ${error.message}`, { cause: error });
        }
    };
}
